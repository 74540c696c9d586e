//! Progress of an export.

use egui::{Button, ProgressBar, RichText, Ui};

use super::fields::FIELDS;
use super::video_maker::{VideoMaker, VideoState};
use crate::ui::hint::Hinted as _;
use crate::ui::pictures::Pictures;
use crate::ui::status::time_in_words;
use crate::ui::theme::palette;
use crate::words::counted;
use crate::worker::ExportState;

/// Estimated seconds until an export is done; `None` before its first frame is written and while it is paused.
pub fn seconds_left(state: &ExportState) -> Option<f64> {
    let done = state.done.so_far();
    let per_frame = state.busy.as_secs_f64() / state.done.written.max(1) as f64;
    let is_known = state.done.written > 0 && !state.is_paused;
    is_known.then_some((state.done.total - done) as f64 * per_frame)
}

/// Completed fraction of an export, from 0 to 1, and its description in words.
fn progress(state: &ExportState, video: Option<&VideoMaker>) -> (f64, String) {
    let total = state.done.total;
    let done = state.done.so_far();
    let share = done as f64 / total.max(1) as f64;
    let busy = state.busy.as_secs_f64();
    let text = match (&state.ended, video) {
        (Some(Ok(())), Some(video)) => return video_progress(video),
        (Some(Ok(())), None) if state.done.written == 0 => {
            format!("{}, all already there", counted(done, "frame"))
        }
        (Some(Ok(())), None) => format!("{}, {busy:.1} s", counted(done, "frame")),
        (Some(Err(_)), _) => format!("{done} of {total}, failed"),
        (None, _) if state.is_paused => format!("{done} of {total}, paused"),
        (None, _) => match seconds_left(state).map(time_in_words) {
            None => format!("{done} of {total}"),
            Some(left) => {
                let rate = state.done.written as f64 / busy.max(1e-3);
                let decimals = usize::from(rate < 10.0);
                format!("{done} of {total} · {rate:.decimals$} frames/s · {left} left")
            }
        },
    };
    (share, text)
}

/// The same for the video, once its frames are written.
fn video_progress(video: &VideoMaker) -> (f64, String) {
    let total = video.frames();
    let name = video.path.file_name().unwrap_or_default().to_string_lossy();
    match &video.state {
        VideoState::Waiting => (0.0, counted(total, "frame")),
        VideoState::Making(done) => {
            let share = *done as f64 / total.max(1) as f64;
            let left = video.seconds_left().map(time_in_words);
            let left = left.map_or(String::new(), |left| format!(" · {left} left"));
            (share, format!("{name}: {done} of {total}{left}"))
        }
        VideoState::Made => (1.0, format!("{} and {name}", counted(total, "frame"))),
        VideoState::Stopped => (1.0, format!("{}, video cancelled", counted(total, "frame"))),
        VideoState::Failed(_) => (1.0, format!("{}, but no video", counted(total, "frame"))),
    }
}

/// Draws an export's progress bar and buttons. Time spent paused does not count in the estimate. Returns whether
/// the user asked to open the folder.
pub fn show_state(
    ui: &mut Ui,
    name: &str,
    state: &ExportState,
    video: Option<&VideoMaker>,
    pictures: &Pictures,
) -> bool {
    let output_path = video.map_or(&state.folder, |video| &video.path);
    ui.label(name).hint(output_path.display().to_string());
    let row = ui.horizontal(|ui| {
        let (share, text) = progress(state, video);
        let has_frames = matches!(state.ended, Some(Ok(())));
        let is_making = |video: &&VideoMaker| match video.state {
            VideoState::Making(_) => true,
            VideoState::Waiting => has_frames,
            _ => false,
        };
        let making = video.filter(is_making);
        let is_over = state.ended.is_some() && making.is_none();
        let buttons_width = if is_over { 150.0 } else { 120.0 };
        let bar = ProgressBar::new(share as f32).desired_width(FIELDS - buttons_width);
        ui.add(bar.text(RichText::new(text).small().color(palette(ui.ctx()).text)));
        if let Some(video) = making {
            // Same layout as while the frames were made, so that a click meant for one button does not hit another.
            ui.add_enabled(false, Button::new("Pause"))
                .hint("A video cannot be paused");
            if ui.button("Cancel").hint("Its frames are kept").clicked() {
                video.stop();
            }
            return false;
        }
        if is_over {
            if ui.button("Remove").clicked() {
                pictures.worker().forget_export(state.id);
            }
            return ui.button("Open folder").clicked();
        }
        let word = if state.is_paused { "Resume" } else { "Pause" };
        if ui.button(word).clicked() {
            pictures.worker().pause_export(state.id, !state.is_paused);
        }
        let cancel = ui
            .button("Cancel")
            .hint("Finished frames are kept; exporting again continues from there");
        if cancel.clicked() {
            pictures.worker().forget_export(state.id);
        }
        false
    });
    row.inner
}
