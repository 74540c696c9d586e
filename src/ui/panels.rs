//! The panels of the window, and the picture between them.

use egui::{Align2, CentralPanel, Frame, Margin, Panel, TextStyle, Ui};

use super::app::App;
use super::commands::Command;
use super::reading::Reading;
use super::requests::UiRequests;
use super::theme::{GRID, INSPECTOR, LAB, OUTLINER, ROW, TIMELINE, palette};
use super::viewport::{Place, badge, describe, fit};
use super::{inspector, menu, status};
use crate::editor::Mode;
use crate::scene::Aspect;

impl App {
    pub(super) fn show_panels(
        &mut self,
        ui: &mut Ui,
        out: &mut UiRequests,
    ) -> Option<(Place, egui::Response)> {
        if !self.is_alone {
            self.show_sides(ui, out);
        }
        let behind = Frame::new().fill(palette(ui.ctx()).window);
        CentralPanel::no_frame()
            .frame(behind)
            .show(ui, |ui| self.show_picture(ui, out))
            .inner
    }

    /// Everything around the picture.
    fn show_sides(&mut self, ui: &mut Ui, out: &mut UiRequests) {
        let side = Frame::side_top_panel(ui.style()).inner_margin(Margin::symmetric(GRID as i8, 0));
        Panel::top("menu").show(ui, |ui| {
            let files = (self.files.recent.as_slice(), &mut self.examples);
            menu::show(ui, &self.editor, files, &mut self.layout, out);
        });
        Panel::bottom("status").exact_size(ROW).show(ui, |ui| {
            let frame = self.pictures.shown(&self.editor);
            let live = frame.map_or(String::new(), |frame| describe(frame, self.editor.shown()));
            let text = self.lab.describe().unwrap_or(live);
            let kept = self.autosave.kept_since();
            let reading = self.files.reading().map(Reading::describe);
            let note = reading.or_else(|| self.exports.describe(&self.pictures));
            let note = note.or_else(|| kept.map(status::autosaved));
            let check = (&self.check, &**self.editor.scene());
            status::show(ui, &text, &self.pictures.activity(), note, check, out);
        });
        if self.lab.is_open {
            let panel = Panel::bottom("lab").frame(side).resizable(true);
            let shown = panel
                .default_size(LAB)
                .size_range(160.0..=600.0)
                .show(ui, |ui| self.lab.show(ui, &self.editor, out));
            if let Some(wish) = shown.inner {
                self.pictures.fulfil(wish);
            }
        }
        if self.timeline.is_open {
            let per_second = self.pictures.per_second();
            // Where nothing moves, the room is the picture's.
            let panel = if self.editor.scene().animation.is_still() {
                Panel::bottom("timeline without keys").exact_size(3.0 * ROW)
            } else {
                let panel = Panel::bottom("timeline").resizable(true);
                panel.default_size(TIMELINE).size_range(64.0..=600.0)
            };
            panel.frame(side).show(ui, |ui| {
                self.timeline
                    .show(ui, &self.editor, &self.thumbs, per_second, out);
            });
        }
        if self.layout.outliner {
            Panel::left("outliner")
                .frame(side)
                .default_size(OUTLINER)
                .size_range(160.0..=420.0)
                .show(ui, |ui| {
                    self.outliner.show(ui, &self.editor, out);
                });
        }
        if self.layout.inspector {
            Panel::right("inspector")
                .frame(side)
                .default_size(INSPECTOR)
                .size_range(INSPECTOR..=480.0)
                .show(ui, |ui| {
                    inspector::show(ui, &self.editor, out);
                });
        }
    }

    fn show_picture(
        &mut self,
        ui: &mut Ui,
        out: &mut UiRequests,
    ) -> Option<(Place, egui::Response)> {
        let area = ui.max_rect();
        let place = fit(
            area.shrink(GRID),
            self.editor.scene(),
            ui.pixels_per_point(),
        );
        if let Some(response) = self.lab.show_picture(ui, place) {
            self.tools.rest();
            if badge(ui, place, &self.lab.name()) {
                self.lab.leave();
            }
            return Some((place, response));
        }
        let is_still = self.pictures.shown_still(&self.editor).is_some();
        let response = if is_still && self.layout.actual_size {
            self.pictures.screen.show_still_at_actual_size(ui)?
        } else {
            self.pictures.screen.show(ui, place, is_still)
        };
        if self.editor.scene().objects.is_empty() {
            hint_at_beginning(ui, place);
        }
        if !is_still && self.layout.flight {
            self.overlay.show(ui, &self.editor, place.rect, out);
        }
        if !is_still && self.layout.shot {
            self.thumbs.show_shot(ui, &self.editor, place.rect);
        }
        let aspect = self.layout.aspect;
        if !is_still && aspect != Aspect::All && badge(ui, place, aspect.name()) {
            self.layout.aspect = Aspect::All;
        }
        if is_still && badge(ui, place, "High-res picture") {
            out.commands.push(Command::Live);
        }
        if is_still || self.editor.mode == Mode::HighRes {
            self.tools.rest();
        } else {
            let wheel = self.flying.wheel(ui, &response);
            let is_busy = ui.input(|input| input.pointer.any_down())
                || self.flying.is_gesture(ui.ctx())
                || self.editor.timeline().is_playing;
            let picture = (place, &response);
            self.tools
                .show(ui, &self.editor, picture, (wheel, is_busy), out);
        }
        Some((place, response))
    }
}

/// What an empty scene is begun with.
fn hint_at_beginning(ui: &Ui, place: Place) {
    let words = "Nothing is here yet.\n\nAdd a shape with Add in the menu, drop a mesh or a scene file here,\nor begin with Open example in the File menu.";
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
