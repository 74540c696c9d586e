//! The timeline panel: playback, recording, the keys along a time axis, and a graph of the resulting speed.

mod scale;

mod strip;

mod overlay;

mod ruler;

mod key_menu;

mod key_rows;

mod graph;

mod thumbs;

mod length;

mod transport;

mod playback;

use std::sync::Arc;

use egui::{Rect, ScrollArea, Ui};

use self::graph::Graph;
use self::key_rows::KeyRows;
pub use self::overlay::Overlay;
pub use self::playback::{advance_playback, pause_for_typing};
use self::scale::Scale;
pub use self::thumbs::Thumbs;
pub use self::transport::{actions, clock};
use super::commands::{Command, take_escape};
use super::menu_entry::on_click;
use super::requests::UiRequests;
use super::theme::{GRID, TRACK_LABEL};
use crate::animate::paused_seconds;
use crate::editor::Editor;
use crate::scene::Animation;

/// Minimum length of the time axis, in seconds.
const MIN_SECONDS: f64 = 4.0;
/// Space after the last key, as a fraction of the time before it.
const MARGIN_SHARE: f64 = 0.08;
/// Maximum length when zoomed out, as a multiple of the default, to leave room for further keys.
const MAX_ZOOM_OUT: f64 = 4.0;
/// Width of the track labels, as a fraction of the panel's.
const LABEL_SHARE: f32 = 0.14;

/// The state of the panel.
pub struct TimelinePanel {
    /// Whether the graph of speed and turn rate is shown below the keys.
    shows_graph: bool,
    /// First and last time shown; fixed while something is dragged.
    span: (f64, f64),
    /// The section that the user zoomed to, if not everything is shown.
    zoomed: Option<(f64, f64)>,
    /// The UI frame in which the pointer was last over the panel.
    hovered_in: u64,
    rows: KeyRows,
    graph: Graph,
    /// Cached duration of the pauses, with the animation it was computed for.
    paused: Option<(Arc<Animation>, f64)>,
}

impl Default for TimelinePanel {
    fn default() -> Self {
        Self {
            shows_graph: true,
            span: (0.0, MIN_SECONDS),
            zoomed: None,
            hovered_in: 0,
            rows: KeyRows::default(),
            graph: Graph::default(),
            paused: None,
        }
    }
}

impl TimelinePanel {
    /// Shows the panel. `shown_fps` is the number of pictures shown per second.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        thumbs: &Thumbs,
        shown_fps: f64,
        out: &mut UiRequests,
    ) {
        ui.add_space(GRID / 2.0);
        ui.horizontal(|ui| {
            let _ = ui.selectable_label(true, "Timeline");
            let lab = ui.selectable_label(false, "Lab");
            on_click(ui, lab, ("Speed against accuracy", Command::Lab), out);
            ui.separator();
            transport::show(ui, editor, shown_fps, &mut self.shows_graph, out);
        });
        let animation = &editor.scene().animation;
        if animation.take.is_some() {
            let paused = self.paused(animation);
            ui.horizontal_wrapped(|ui| transport::show_take(ui, editor, paused, out));
        }
        if animation.is_still() {
            ui.centered_and_justified(|ui| {
                ui.weak(match editor.timeline().recorded() {
                    Some(_) => "Recording: fly with W A S D, the arrows and the mouse; T stops",
                    None => "No keys yet – press R and fly, or K to set a key here",
                })
            });
            return;
        }
        let end = shown_end(animation, editor.shown_time());
        self.zoomed = self.zoomed.filter(|(_, last)| *last <= end * MAX_ZOOM_OUT);
        if self.zoomed.is_some() || !ui.input(|input| input.pointer.any_down()) {
            self.span = self.zoomed.unwrap_or((0.0, end));
        }
        let area = ui.max_rect();
        let (min_width, max_width) = TRACK_LABEL;
        let left = area.left() + (area.width() * LABEL_SHARE).clamp(min_width, max_width);
        let scale = Scale {
            left,
            width: area.right() - 2.0 * GRID - left,
            start: self.span.0,
            end: self.span.1,
        };
        self.zoom(ui, (&scale, area), end);
        if self.rows.is_busy() && take_escape(ui) {
            self.rows.cancel(editor, out);
        }
        // The ruler stays visible when many rows are scrolled.
        ruler::show(ui, &scale, editor, out);
        let shown = ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            if !animation.keys.is_empty() {
                thumbs.show(ui, &scale, animation);
            }
            self.rows.show(ui, &scale, editor, out);
            if self.shows_graph && animation.keys.len() > 1 {
                self.graph.show(ui, &scale, editor);
            }
            self.rows.show_space_below(ui, editor, out);
        });
        ruler::playhead(ui, &scale, shown.inner_rect, editor);
    }

    /// Resets the zoom to show everything.
    pub fn fit(&mut self) {
        self.zoomed = None;
    }

    /// Seconds of pauses. Cached, as counting them in every UI frame is slow with many keys.
    fn paused(&mut self, animation: &Arc<Animation>) -> f64 {
        let cached = self.paused.take();
        let cached = cached.filter(|(of, _)| Arc::ptr_eq(of, animation));
        let count = || (Arc::clone(animation), paused_seconds(&animation.keys));
        self.paused.insert(cached.unwrap_or_else(count)).1
    }

    /// Returns whether keys are being dragged or a marquee is being drawn.
    pub fn is_dragging(&self) -> bool {
        self.rows.is_busy()
    }

    /// Returns whether the pointer is over the panel in this UI frame.
    pub fn is_hovered(&self, frame: u64) -> bool {
        self.hovered_in == frame
    }

    /// Zooms with Ctrl and the wheel, and pans with the middle button.
    fn zoom(&mut self, ui: &Ui, (scale, area): (&Scale, Rect), end: f64) {
        let at = ui.input(|input| input.pointer.hover_pos());
        let at = at.filter(|_| ui.rect_contains_pointer(area));
        let Some(at) = at else { return };
        self.hovered_in = ui.cumulative_frame_nr();
        let (factor, moved, is_middle) = ui.input(|input| {
            let pointer = &input.pointer;
            (input.zoom_delta(), pointer.delta().x, pointer.middle_down())
        });
        let (start, last) = self.span;
        let shift = if is_middle {
            scale.time(at.x) - scale.time(at.x + moved)
        } else {
            0.0
        };
        if factor == 1.0 && shift == 0.0 {
            return;
        }
        let time_at_pointer = scale.time(at.x);
        let max_seconds = end * MAX_ZOOM_OUT;
        let seconds = ((last - start) / f64::from(factor)).clamp(MIN_SECONDS / 20.0, max_seconds);
        // The time under the pointer stays in place.
        let start = time_at_pointer - (time_at_pointer - start) * seconds / (last - start) + shift;
        let start = start.clamp(0.0, (max_seconds - seconds).max(0.0));
        let is_all = start == 0.0 && seconds == end;
        self.zoomed = (!is_all).then_some((start, start + seconds));
    }
}

/// The end of the time axis in seconds: some way after the last key and the playhead.
fn shown_end(animation: &Animation, playhead: f64) -> f64 {
    (animation.duration().max(playhead) * (1.0 + MARGIN_SHARE)).max(MIN_SECONDS)
}
