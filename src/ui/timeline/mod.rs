//! The timeline: playing, recording, keys on a line of time, and what they do to speed.

mod overlay;

mod tracks_area;

mod graph;

mod thumbs;

mod transport;

use egui::{ScrollArea, Ui};

use self::graph::Graph;
pub use self::overlay::Overlay;
pub use self::thumbs::Thumbs;
use self::tracks_area::{Drag, Scale};
pub use self::transport::actions;
use super::commands::Command;
use super::requests::UiRequests;
use super::theme::{GRID, TRACK_LABEL};
use crate::editor::Editor;
use crate::scene::Animation;

/// Least time that the line shows, in seconds.
const LEAST: f64 = 4.0;
/// Room behind the last key, as a share of the time before it.
const BEHIND: f64 = 0.08;

/// What the panel remembers.
pub struct TimelinePanel {
    /// Whether it is shown.
    pub is_open: bool,
    /// Whether speed and turns are shown below the keys.
    shows_graph: bool,
    /// Last time that the line shows; it stays while something is dragged on it.
    end: f64,
    drag: Option<Drag>,
    graph: Graph,
}

impl Default for TimelinePanel {
    fn default() -> Self {
        Self {
            is_open: true,
            shows_graph: true,
            end: LEAST,
            drag: None,
            graph: Graph::default(),
        }
    }
}

impl TimelinePanel {
    /// Shows the panel. `per_second` is how many pictures a second have been on screen.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        editor: &Editor,
        thumbs: &Thumbs,
        per_second: f64,
        out: &mut UiRequests,
    ) {
        ui.add_space(GRID / 2.0);
        ui.horizontal(|ui| {
            let _ = ui.selectable_label(true, "Timeline");
            let lab = ui.selectable_label(false, "Lab");
            if lab
                .on_hover_text("Speed against accuracy (Ctrl+L)")
                .clicked()
            {
                out.commands.push(Command::Lab);
            }
            ui.separator();
            transport::show(ui, editor, per_second, &mut self.shows_graph, out);
        });
        let animation = &editor.scene().animation;
        if animation.take.is_some() {
            ui.horizontal(|ui| transport::show_take(ui, editor, out));
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
        if !ui.input(|input| input.pointer.any_down()) {
            self.end = shown_end(animation);
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let left = ui.max_rect().left() + TRACK_LABEL;
            let scale = Scale {
                left,
                width: ui.max_rect().right() - 2.0 * GRID - left,
                end: self.end,
            };
            tracks_area::ruler(ui, &scale, editor, out);
            if !animation.keys.is_empty() {
                thumbs.show(ui, &scale, animation);
                tracks_area::keys(ui, &scale, editor, &mut self.drag, out);
            }
            tracks_area::tracks(ui, &scale, editor, &mut self.drag, out);
            if self.shows_graph && animation.keys.len() > 1 {
                self.graph.show(ui, &scale, editor);
            }
        });
    }
}

/// Where the line of time ends on screen, in seconds.
fn shown_end(animation: &Animation) -> f64 {
    (animation.duration() * (1.0 + BEHIND)).max(LEAST)
}
