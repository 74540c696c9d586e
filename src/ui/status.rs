//! The status line at the bottom: facts about the picture on screen, and what the tracer is doing.

use std::time::{Duration, Instant};

use egui::{Align, Label, Layout, ProgressBar, RichText, Ui};

use super::commands::Command;
use super::hint::Hinted as _;
use super::requests::UiRequests;
use super::scene_check::SceneCheck;
use super::theme::palette;
use crate::scene::Scene;
use crate::worker::Activity;

/// Time after which the progress of a still picture is shown.
const PROGRESS_DELAY: Duration = Duration::from_millis(100);
/// Time after which the remaining time is shown.
const REMAINING_DELAY: Duration = Duration::from_secs(1);

/// Time after which a picture that does not appear must have a scene that takes long to prepare.
const PREPARING_DELAY: Duration = Duration::from_millis(500);

/// Greatest share of the line for what the tracer is doing.
const MAX_SHARE: f32 = 0.6;
/// Height of widgets in the line: less than that of the line, which must not change.
const WIDGET_HEIGHT: f32 = 16.0;

/// Shows the line. The picture on screen is given by its description and its revision.
pub fn show(
    ui: &mut Ui,
    (picture, shown_revision): (&str, Option<u64>),
    activity: &Activity,
    note: Option<String>,
    (check, scene): (&SceneCheck, &Scene),
    out: &mut UiRequests,
) {
    // The height must be the same with and without hints.
    ui.set_min_height(ui.available_height());
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.spacing_mut().interact_size.y = WIDGET_HEIGHT;
        ui.spacing_mut().button_padding.y = 0.0;
        // At the edge, where it stays in place while the activity changes.
        check.show(ui, scene, out);
        let max_width = ui.available_width() * MAX_SHARE;
        ui.scope(|ui| {
            ui.set_max_width(max_width);
            show_activity(ui, activity, shown_revision, note, out);
        });
        // The description is truncated if there is not enough room.
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let words = RichText::new(picture).monospace().weak();
            ui.add(Label::new(words).truncate());
        });
    });
}

/// Shows what the tracer is doing, or `note` if it is idle.
fn show_activity(
    ui: &mut Ui,
    activity: &Activity,
    shown_revision: Option<u64>,
    note: Option<String>,
    out: &mut UiRequests,
) {
    match activity {
        Activity::Still {
            done,
            total,
            elapsed,
        } if *elapsed >= PROGRESS_DELAY => {
            progress(ui, *done, *total, *elapsed, out);
        }
        Activity::Live { revision, elapsed }
            if *elapsed >= PREPARING_DELAY && shown_revision != Some(*revision) =>
        {
            ui.weak(format!(
                "preparing the scene for tracing, {:.1} s",
                elapsed.as_secs_f64()
            ));
            ui.request_repaint_after(Duration::from_millis(100));
        }
        Activity::Idle => {
            if let Some(note) = note {
                ui.add(Label::new(RichText::new(note).weak()).truncate());
            }
        }
        Activity::Live { .. } | Activity::Still { .. } => {
            ui.weak("tracing");
        }
    }
}

fn progress(ui: &mut Ui, done: u64, total: u64, elapsed: Duration, out: &mut UiRequests) {
    let share = done as f64 / total.max(1) as f64;
    let cancel = egui::Button::new(RichText::new("Cancel").small());
    if ui
        .add(cancel)
        .hint("Cancel the high-res picture; it is not saved")
        .clicked()
    {
        out.commands.push(Command::CancelStill);
    }
    let remaining = if elapsed >= REMAINING_DELAY && share > 0.0 {
        let seconds = elapsed.as_secs_f64() * (1.0 - share) / share;
        format!(" · {} left", time_in_words(seconds))
    } else {
        String::new()
    };
    // Rounded down, and never 100 % before it is done.
    let text = format!(
        "High-res {:.0} %{remaining}",
        (share * 100.0).floor().min(99.0)
    );
    let text = RichText::new(text).small().color(palette(ui.ctx()).text);
    let bar = ProgressBar::new(share as f32)
        .desired_width(180.0)
        .desired_height(WIDGET_HEIGHT);
    ui.add(bar.text(text));
    ui.request_repaint_after(Duration::from_millis(50));
}

/// Formats a duration in seconds, minutes or hours, rounded up.
pub fn time_in_words(seconds: f64) -> String {
    let (length, unit) = match seconds {
        ..90.0 => (seconds, "s"),
        ..7200.0 => (seconds / 60.0, "min"),
        _ => (seconds / 3600.0, "h"),
    };
    format!("{:.0}\u{a0}{unit}", length.ceil())
}

/// Describes when the work was last autosaved.
pub fn autosaved(at: Instant) -> String {
    format!("autosaved {}", ago(at.elapsed()))
}

fn ago(time: Duration) -> String {
    match time.as_secs() {
        0..=2 => "just now".to_owned(),
        seconds @ 3..=89 => format!("{seconds} s ago"),
        seconds => format!("{} min ago", seconds / 60),
    }
}
