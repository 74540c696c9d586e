//! How far an export is.

use egui::{ProgressBar, RichText, Ui};

use super::fields::FIELDS;
use crate::ui::hint::Hint as _;
use crate::ui::pictures::Pictures;
use crate::ui::status::in_words;
use crate::ui::theme::palette;
use crate::worker::ExportState;

/// How long an export will still take; `None` before its first frame, and while it waits.
pub fn seconds_left(state: &ExportState) -> Option<f64> {
    let done = state.done.kept + state.done.written;
    let per_frame = state.busy.as_secs_f64() / state.done.written.max(1) as f64;
    let is_known = state.done.written > 0 && !state.is_paused;
    is_known.then_some((state.done.total - done) as f64 * per_frame)
}

/// How far an export is; what it waits for does not count as its time. Whether it is given up.
pub fn show_state(ui: &mut Ui, (name, state): (&str, &ExportState), pictures: &Pictures) -> bool {
    let mut is_given_up = false;
    let done = state.done.kept + state.done.written;
    let share = done as f64 / state.done.total.max(1) as f64;
    let busy = state.busy.as_secs_f64();
    let rate = state.done.written as f64 / busy.max(1e-3);
    let text = match &state.ended {
        Some(Ok(())) => format!("{done} frames, {busy:.1} s"),
        Some(Err(_)) => format!("{done} of {}, failed", state.done.total),
        None if state.is_paused => format!("{done} of {}, paused", state.done.total),
        None => match seconds_left(state).map(in_words) {
            None => format!("{done} of {}", state.done.total),
            Some(left) => format!(
                "{done} of {} · {rate:.0} frames/s · {left} left",
                state.done.total
            ),
        },
    };
    ui.label(name).hint(state.folder.display().to_string());
    ui.horizontal(|ui| {
        let bar = ProgressBar::new(share as f32).desired_width(FIELDS - 120.0);
        ui.add(bar.text(RichText::new(text).small().color(palette(ui.ctx()).text)));
        if state.ended.is_some() {
            if ui.button("Remove").clicked() {
                pictures.forget_export(state.id);
            }
            return;
        }
        let word = if state.is_paused { "Resume" } else { "Pause" };
        if ui.button(word).clicked() {
            pictures.pause_export(state.id, !state.is_paused);
        }
        let cancel = ui
            .button("Cancel")
            .hint("What is written stays; exporting again goes on from there");
        is_given_up = cancel.clicked();
        if is_given_up {
            pictures.forget_export(state.id);
        }
    });
    is_given_up
}
