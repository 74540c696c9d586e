//! The maps of where formulas break, and where the open scene stands on them.

use egui::{Button, RichText, ScrollArea, Ui, vec2};

use super::super::theme::{GRID, ROW, palette};
use super::heat;
use crate::lab::stability::{Map, maps};
use crate::scene::Scene;
use crate::ui::hint::Hinted as _;
use crate::worker::Background;

/// How many times more tries than for a first look: a second of computing.
const EFFORT: u32 = 4;
/// Width of the list of methods.
const LIST: f32 = 440.0;

/// The tab's state.
#[derive(Default)]
pub struct Stability {
    maps: Vec<Map>,
    coming: Background<Vec<Map>>,
    chosen: usize,
    /// Whether computing them ended with a fault.
    has_failed: bool,
}

impl Stability {
    /// Shows the tab; the maps are computed when it is first seen.
    pub fn show(&mut self, ui: &mut Ui, scene: &Scene) {
        if self.maps.is_empty() {
            return self.fetch(ui);
        }
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(LIST);
                let list = ScrollArea::vertical().auto_shrink(false);
                list.show(ui, |ui| self.show_list(ui, scene));
            });
            ui.vertical(|ui| {
                let map = &self.maps[self.chosen];
                let stand = map.subject.standing(scene);
                ui.label(headline(map));
                ui.weak(map.sentence());
                let warning = stand.filter(|&stand| heat::is_near_failing(map, stand));
                match (warning, is_used(scene, map)) {
                    (Some(_), true) => {
                        let text = "Your scene uses this, within a decade of where it fails.";
                        ui.colored_label(palette(ui.ctx()).error, text);
                    }
                    (Some(_), false) => {
                        ui.weak("Here this would fail your scene, within a decade.");
                    }
                    _ => {
                        ui.weak("The frame is where your scene stands.");
                    }
                }
                let size = ui.available_size() - vec2(GRID, GRID);
                heat::show(ui, map, size.min(vec2(720.0, 600.0)), stand);
            });
        });
    }

    fn fetch(&mut self, ui: &mut Ui) {
        match self.coming.take() {
            Some(Ok(maps)) => self.maps = maps,
            Some(Err(_)) => self.has_failed = true,
            None if !self.coming.is_awaited() && !self.has_failed => {
                self.coming = Background::start("glint-stability", || maps(EFFORT));
            }
            None => {}
        }
        if self.has_failed {
            ui.centered_and_justified(|ui| {
                ui.weak("The trying of the formulas has stopped with a fault of its own.")
            });
            return;
        }
        ui.centered_and_justified(|ui| ui.weak("Trying every formula…"));
        ui.request_repaint_after(std::time::Duration::from_millis(100));
    }

    fn show_list(&mut self, ui: &mut Ui, scene: &Scene) {
        for (place, map) in self.maps.iter().enumerate() {
            let used = if is_used(scene, map) { "●" } else { " " };
            let text = format!("{used} {}: {}", map.subject.name(), map.method);
            let share = format!("{:.3} %", map.total().rate() * 100.0);
            // The sign of what is used is in no other font.
            let words = RichText::new(&text).monospace();
            let row = Button::selectable(place == self.chosen, words)
                .truncate()
                .right_text(RichText::new(&share).monospace())
                .min_size(vec2(ui.available_width(), ROW));
            let row = ui.add(row).accessible_name(format!("{text} {share}"));
            if row.hint(headline(map)).clicked() {
                self.chosen = place;
            }
        }
    }
}

fn headline(map: &Map) -> String {
    let default = if map.is_default { " (the default)" } else { "" };
    format!(
        "{} {}{default}: {}",
        map.subject.name(),
        map.method,
        map.failure
    )
}

/// Whether the scene asks for this method.
fn is_used(scene: &Scene, map: &Map) -> bool {
    let asked = map.subject.method_in_use(&scene.render);
    asked.map_or(map.is_default, |asked| asked == map.method)
}
