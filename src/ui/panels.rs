//! Layout of the window's panels, with the picture between them.

use egui::containers::panel::PanelState;
use egui::{
    Align2, AsIdSalt, CentralPanel, Frame, IdSalt, Margin, Panel, Stroke, StrokeKind, TextStyle,
    Ui, UiBuilder, Vec2,
};

use super::app::App;
use super::commands::Command;
use super::histogram::beside_histogram;
use super::layout::Below;
use super::requests::UiRequests;
use super::theme::{GRID, INSPECTOR, LAB, OUTLINER, ROW, TIMELINE, TRACKS, WIDE_WINDOW, palette};
use super::timeline::clock;
use super::tools::label;
use super::viewport::{Place, badge, describe, fit};
use super::{inspector, legend, menu, status};
use crate::editor::Mode;
use crate::scene::Aspect;

/// Width of the frame around the picture during a recording, in points.
const RECORDING_FRAME: f32 = 3.0;

impl App {
    /// Shows the panels in the order of the Tab key: outliner, picture, inspector, timeline.
    pub(super) fn show_panels(
        &mut self,
        ui: &mut Ui,
        out: &mut UiRequests,
    ) -> (Place, egui::Response) {
        if self.layout.is_alone {
            return self.show_middle(ui, out);
        }
        Panel::top("menu").show(ui, |ui| {
            let files = (self.files.recent.as_slice(), &mut self.examples);
            menu::show(ui, &self.editor, files, &mut self.layout, out);
        });
        // The panels below are shown last, so their height is that of the last frame.
        let mut upper = ui.available_rect_before_wrap();
        upper.max.y -= self.height_below(ui);
        // A child takes no room from the panels below, which are laid out in `ui` itself.
        let mut above = ui.new_child(UiBuilder::new().max_rect(upper));
        let picture = self.show_upper(&mut above, out);
        self.show_below(ui, out);
        picture
    }

    /// Shows the outliner, the picture and the inspector.
    fn show_upper(&mut self, ui: &mut Ui, out: &mut UiRequests) -> (Place, egui::Response) {
        if self.layout.outliner {
            Panel::left(("outliner", is_narrow(ui)))
                .frame(side_frame(ui))
                .default_size(default_width(ui, OUTLINER))
                .size_range(OUTLINER.0..=420.0)
                .show(ui, |ui| {
                    let keys_are_free = !self.keys_are_taken;
                    self.outliner.show(ui, &self.editor, keys_are_free, out);
                });
        }
        let mut middle = ui.available_rect_before_wrap();
        if self.layout.inspector {
            let default_width = default_width(ui, INSPECTOR);
            let size = last_size(ui, ("inspector", is_narrow(ui)));
            middle.max.x -= size.map_or(default_width, |size| size.x);
        }
        let mut between = ui.new_child(UiBuilder::new().max_rect(middle));
        let picture = self.show_middle(&mut between, out);
        if self.layout.inspector {
            Panel::right(("inspector", is_narrow(ui)))
                .frame(side_frame(ui))
                .default_size(default_width(ui, INSPECTOR))
                .size_range(INSPECTOR.0..=480.0)
                .show(ui, |ui| {
                    inspector::show(ui, &self.editor, &mut self.quality, out);
                });
        }
        picture
    }

    fn show_middle(&mut self, ui: &mut Ui, out: &mut UiRequests) -> (Place, egui::Response) {
        let background = Frame::new().fill(palette(ui.ctx()).window);
        CentralPanel::no_frame()
            .frame(background)
            .show(ui, |ui| self.show_picture(ui, out))
            .inner
    }

    /// Returns the name and the usual height of the timeline's panel: low if nothing is animated, to leave the room to
    /// the picture; higher if there are tracks.
    fn timeline_panel(&self) -> (&'static str, f32) {
        let animation = &self.editor.scene().animation;
        if animation.is_still() {
            let rows = if animation.take.is_some() { 4.5 } else { 3.0 };
            ("timeline without keys", rows * ROW)
        } else if animation.keys.is_empty() && animation.take.is_none() {
            // Without a flight, there is no speed graph and there are no thumbnails.
            ("timeline without flight", 3.0 * ROW + TRACKS)
        } else if animation.tracks.is_empty() {
            ("timeline", TIMELINE)
        } else {
            ("timeline with tracks", TIMELINE + TRACKS)
        }
    }

    /// Returns the height in the last frame of the status line with the timeline or the lab.
    fn height_below(&self, ui: &Ui) -> f32 {
        let height =
            |size: Option<Vec2>, default_height| size.map_or(default_height, |size| size.y);
        let below = match self.layout.below {
            Below::Nothing => 0.0,
            Below::Timeline => {
                let (name, default_height) = self.timeline_panel();
                height(last_size(ui, name), default_height)
            }
            Below::Lab => height(last_size(ui, "lab"), LAB),
        };
        height(last_size(ui, "status"), ROW) + below
    }

    /// Shows the status line, the lab and the timeline, from bottom to top.
    fn show_below(&mut self, ui: &mut Ui, out: &mut UiRequests) {
        Panel::bottom("status").exact_size(ROW).show(ui, |ui| {
            let frame = self.pictures.shown(&self.editor);
            let live = frame.map_or(String::new(), |frame| describe(frame, self.editor.shown()));
            let text = self.lab.describe().unwrap_or(live);
            let picture = (&*text, frame.map(|frame| frame.revision));
            let saved_at = self.autosave.saved_since();
            let reading = self.files.describe_reading();
            let note = reading.or_else(|| self.exports.describe(&self.pictures));
            let note = note.or_else(|| saved_at.map(status::autosaved));
            let check = (&self.check, &**self.editor.shown());
            status::show(
                ui,
                picture,
                &self.pictures.worker().activity(),
                note,
                check,
                out,
            );
        });
        if self.layout.below == Below::Lab {
            let panel = Panel::bottom("lab").frame(side_frame(ui)).resizable(true);
            let shown = panel
                .default_size(LAB)
                .size_range(160.0..=600.0)
                .show(ui, |ui| self.lab.show(ui, &self.editor, out));
            if let Some(request) = shown.inner {
                self.pictures.handle_lab_request(request);
            }
        }
        if self.layout.below == Below::Timeline {
            let per_second = self.pictures.per_second();
            let (name, default_height) = self.timeline_panel();
            let panel = Panel::bottom(name);
            let panel = if self.editor.scene().animation.is_still() {
                panel.exact_size(default_height)
            } else {
                let panel = panel.resizable(true);
                panel.default_size(default_height).size_range(64.0..=600.0)
            };
            panel.frame(side_frame(ui)).show(ui, |ui| {
                self.timeline
                    .show(ui, &self.editor, &self.thumbs, per_second, out);
            });
        }
    }

    fn show_picture(&mut self, ui: &mut Ui, out: &mut UiRequests) -> (Place, egui::Response) {
        let area = ui.max_rect();
        let place = fit(
            area.shrink(GRID),
            self.editor.scene(),
            ui.pixels_per_point(),
        );
        if let Some(response) = self.lab.show_picture(ui, place) {
            self.tools.rest();
            if badge(ui, place, &self.lab.name(ui)) {
                self.lab.leave();
            }
            return (place, response);
        }
        let still = self.pictures.shown_still(&self.editor);
        let still = still.map(|frame| frame.full_size);
        let is_still = still.is_some();
        let response = match still {
            Some(size) => self.still.show(ui, place, &mut self.pictures, size),
            None => self.pictures.screen.show(ui, place),
        };
        if self.editor.mode != Mode::HighRes {
            self.still.leave();
        }
        if self.layout.histogram {
            self.levels.show(ui, place.rect);
        }
        let scene = self.editor.scene();
        if scene.objects.is_empty() && scene.animation.is_still() {
            show_empty_scene_hint(ui, place);
        }
        if !is_still && self.layout.flight {
            self.overlay.show(ui, &self.editor, place.rect, out);
        }
        let aspect = self.layout.aspect;
        if !is_still && aspect != Aspect::All {
            if badge(ui, place, aspect.name()) {
                self.layout.aspect = Aspect::All;
            }
            let free = if self.layout.histogram {
                beside_histogram(place.rect)
            } else {
                place.rect
            };
            if aspect == Aspect::Cost {
                legend::show(ui, free);
            } else {
                legend::show_words(ui, free, aspect.meaning());
            }
        }
        if let Some((_, seconds)) = self.editor.timeline().recorded() {
            show_recording(ui, place, seconds);
        }
        if is_still && badge(ui, place, &self.still.name(self.pictures.region.is_some())) {
            self.leave_still(out);
        }
        if is_still || self.editor.mode == Mode::HighRes {
            self.tools.rest();
        } else {
            let speed = &mut self.layout.fly_speed;
            let wheel = self.flying.wheel(ui, &response, speed);
            if self.flying.is_speed_shown(ui.ctx()) {
                let painter = ui.painter().with_clip_rect(place.rect);
                let at = ui.input(|input| input.pointer.latest_pos());
                let words = format!("Flying speed {:.2}×", self.layout.fly_speed);
                label(&painter, at.unwrap_or(place.rect.min), &words);
            }
            let is_busy = self.is_gesture(ui.ctx()) || self.editor.timeline().is_playing;
            let picture = (place, &response);
            self.tools
                .show(ui, &self.editor, picture, (wheel, is_busy), out);
        }
        // In other aspects, the legend takes its place.
        if !is_still && self.layout.shot && aspect == Aspect::All {
            self.thumbs.show_shot(ui, &self.editor, place.rect, out);
        }
        (place, response)
    }

    /// Returns from a part of the still picture to all of it, and from that to the live view.
    fn leave_still(&mut self, out: &mut UiRequests) {
        if self.pictures.region.take().is_none() {
            out.commands.push(Command::Live);
        }
    }
}

/// Whether the window is narrow. Panels at the sides have separate widths then, which are remembered separately.
fn is_narrow(ui: &Ui) -> bool {
    ui.content_rect().width() < WIDE_WINDOW
}

/// Returns the width of a panel when first shown: in a narrow window, the least one.
fn default_width(ui: &Ui, (least, wide): (f32, f32)) -> f32 {
    if is_narrow(ui) { least } else { wide }
}

/// Returns the frame of the panels at the sides.
fn side_frame(ui: &Ui) -> Frame {
    Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(GRID as i8, 0))
}

/// Returns the size of a panel in the last frame.
fn last_size(ui: &Ui, panel: impl AsIdSalt) -> Option<Vec2> {
    let state = PanelState::load(ui.ctx(), ui.scope_id().with_salt(IdSalt::new(panel)));
    state.map(|state| state.size())
}

/// Draws a frame around the picture during a recording, with its duration.
fn show_recording(ui: &Ui, place: Place, seconds: f64) {
    let colors = palette(ui.ctx());
    let painter = ui.painter().with_clip_rect(place.rect.expand(GRID));
    let frame = Stroke::new(RECORDING_FRAME, colors.accent);
    painter.rect_stroke(place.rect, 0, frame, StrokeKind::Outside);
    label(
        &painter,
        place.rect.min,
        &format!("Recording {}", clock(seconds)),
    );
}

/// Shows how to begin in an empty scene.
fn show_empty_scene_hint(ui: &Ui, place: Place) {
    let words = "The scene is empty.\n\nAdd a shape from the Add menu, drop a mesh or a scene file here,\nor start with Open example in the File menu.";
    let font = TextStyle::Body.resolve(ui.style());
    let color = palette(ui.ctx()).on_picture;
    let painter = ui.painter().with_clip_rect(place.rect);
    painter.text(
        place.rect.center(),
        Align2::CENTER_CENTER,
        words,
        font,
        color,
    );
}
