//! The tab of the stability maps: where formulas fail, and where the open scene is on these maps.

use egui::{Button, Rect, RichText, ScrollArea, Sense, TextStyle, Ui, vec2};

use super::{heat, ramp};
use crate::lab::stability::{Map, maps};
use crate::plan::{RenderRequest, is_double};
use crate::scene::Scene;
use crate::ui::hint::Hinted as _;
use crate::ui::theme::{GRID, ROW, palette};
use crate::worker::Background;

/// Number of tries as a multiple of those for a quick look; computing them takes a second.
const EFFORT: u32 = 4;
/// Width of the list of methods.
const LIST_WIDTH: f32 = 440.0;
/// Width of the colour scale.
const BAR_WIDTH: f32 = 160.0;
/// Space for the label to its right.
const LABEL_WIDTH: f32 = 40.0;

/// The state of the tab.
#[derive(Default)]
pub struct Stability {
    maps: Vec<Map>,
    pending: Background<Vec<Map>>,
    chosen: usize,
    /// Whether the background task that computes the maps has failed.
    has_failed: bool,
}

impl Stability {
    /// Shows the tab; the maps are computed when it is first opened.
    pub fn show(&mut self, ui: &mut Ui, scene: &Scene) {
        if self.maps.is_empty() {
            return self.fetch(ui);
        }
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(LIST_WIDTH);
                let list = ScrollArea::vertical().auto_shrink(false);
                list.show(ui, |ui| self.show_list(ui, scene));
            });
            ui.vertical(|ui| {
                let map = &self.maps[self.chosen];
                let position = map.subject.scene_position(scene);
                ui.label(headline(map));
                ui.weak(map.sentence());
                let warning = position.filter(|&position| heat::is_near_failing(map, position));
                let is_double = || is_double(scene, &RenderRequest::still(scene));
                match (warning, self.is_used(scene, map)) {
                    _ if position.is_none() => {
                        ui.weak("Where your scene is on this map cannot be determined.");
                    }
                    (Some(_), true) if map.subject.is_of_single_precision() && is_double() => {
                        ui.weak("Your scene uses this close to where it fails in single precision, and is traced in double.");
                    }
                    (Some(_), true) => {
                        let text = "Your scene uses this within a factor of 10 of where it fails.";
                        ui.colored_label(palette(ui.ctx()).error, text);
                    }
                    (Some(_), false) => {
                        ui.weak("Your scene is within a factor of 10 of where this would fail.");
                    }
                    _ => {
                        ui.weak("The frame marks where your scene is.");
                    }
                }
                let used = map.subject.method_in_use(scene);
                if let Some(used) = used.filter(|used| *used != map.method)
                    && self.is_used(scene, map)
                {
                    ui.weak(format!("This is {}; your scene uses {used}.", map.method));
                }
                let size = ui.available_size() - vec2(GRID, GRID + ROW);
                let size = size.min(vec2(720.0, 600.0));
                heat::show(ui, map, size, position);
                show_scale(ui, size.x);
            });
        });
    }

    fn fetch(&mut self, ui: &mut Ui) {
        match self.pending.take() {
            Some(Ok(maps)) => {
                // The first shows what a failure looks like.
                let failing = maps.iter().position(|map| map.total().failures > 0);
                self.chosen = failing.unwrap_or_default();
                self.maps = maps;
            }
            Some(Err(_)) => self.has_failed = true,
            None if !self.pending.is_awaited() && !self.has_failed => {
                self.pending = Background::start("glint-stability", || maps(EFFORT));
            }
            None => {}
        }
        if self.has_failed {
            ui.centered_and_justified(|ui| {
                ui.weak("Testing the formulas stopped because of an internal error.")
            });
            return;
        }
        ui.centered_and_justified(|ui| ui.weak("Testing every formula…"));
        ui.request_repaint_after(std::time::Duration::from_millis(100));
    }

    /// Returns whether the scene uses this method. If its parameter has a value that was not tested, maps of the
    /// same method with another value count.
    fn is_used(&self, scene: &Scene, map: &Map) -> bool {
        let Some(used_method) = map.subject.method_in_use(scene) else {
            return map.is_default;
        };
        let mut same_subject = self
            .maps
            .iter()
            .filter(|other| other.subject == map.subject);
        let is_tested = same_subject.any(|other| other.method == used_method);
        let kind = |method: &str| method.split(':').next().map(str::to_owned);
        // Every scene is rebased.
        let is_possible = !map.method.ends_with("(not rebased)");
        let is_of_kind = || kind(&used_method) == kind(&map.method);
        used_method == map.method || !is_tested && is_possible && is_of_kind()
    }

    fn show_list(&mut self, ui: &mut Ui, scene: &Scene) {
        for (index, map) in self.maps.iter().enumerate() {
            let used = if self.is_used(scene, map) { "●" } else { " " };
            let text = format!("{used} {}: {}", map.subject.name(), map.method);
            let share = format!("{:.3} %", map.total().rate() * 100.0);
            // The "●" exists only in the monospace font.
            let words = RichText::new(&text).monospace();
            let row = Button::selectable(index == self.chosen, words)
                .truncate()
                .right_text(RichText::new(&share).monospace())
                .min_size(vec2(ui.available_width(), ROW));
            let row = ui.add(row).accessible_name(format!("{text} {share}"));
            if row.hint(headline(map)).clicked() {
                self.chosen = index;
            }
        }
    }
}

/// Shows the colour scale.
fn show_scale(ui: &mut Ui, width: f32) {
    let (row, _) = ui.allocate_exact_size(vec2(width, ROW), Sense::hover());
    let small = TextStyle::Small.resolve(ui.style());
    let color = palette(ui.ctx()).muted;
    let room = width - BAR_WIDTH - 2.0 * LABEL_WIDTH;
    for words in ["Share of trials that fail", "Failing"] {
        let galley = ui
            .painter()
            .layout_no_wrap(words.to_owned(), small.clone(), color);
        if galley.size().x <= room {
            let at = row.left_center() - vec2(0.0, galley.size().y / 2.0);
            ui.painter().galley(at, galley, color);
            break;
        }
    }
    let size = vec2(BAR_WIDTH, GRID);
    let middle = row.right_center() - vec2(BAR_WIDTH / 2.0 + LABEL_WIDTH, 0.0);
    ramp::show_bar(ui, Rect::from_center_size(middle, size));
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
