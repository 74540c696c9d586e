//! What is probably not meant in the scene, with a way to it and, where there is one, a way out.

use std::sync::Arc;

use egui::{Popup, RichText, ScrollArea, Ui};

use super::hint::Hinted as _;
use super::icons;
use super::requests::UiRequests;
use super::theme::{GRID, ROW, palette};
use crate::editor::{Edit, Editor, Item, Selection};
use crate::scene::{About, Hint, Scene, camera_hints, thing_hints};
use crate::words::counted;

/// Width of the list in points.
const WIDTH: f32 = 420.0;
/// Most rows that are seen at once.
const MOST_ROWS: f32 = 12.0;

/// What was found in a state of the scene.
#[derive(Default)]
pub struct SceneCheck {
    of: Option<u64>,
    /// What was found of other things than the camera, and in which scene.
    things: Option<(Arc<Scene>, Vec<Hint>)>,
    hints: Vec<Hint>,
    /// Whether too much of the picture is as bright as can be.
    is_clipped: bool,
}

/// Share of the picture from which on it is told that it clips.
const CLIPPED: f64 = 0.05;

impl SceneCheck {
    /// Looks at the scene again, if it has changed; not while something is dragged.
    pub fn update(&mut self, editor: &Editor, is_busy: bool) {
        if self.of != Some(editor.revision()) && !is_busy {
            self.of = Some(editor.revision());
            let scene = editor.scene();
            let known = self.things.take();
            // To look at surfaces in one place takes long, and needs no camera.
            let known = known.filter(|(of, _)| of.has_same_things(scene));
            let found = known.map_or_else(|| thing_hints(scene), |(_, found)| found);
            self.hints = camera_hints(scene);
            self.hints.extend_from_slice(&found);
            self.things = Some((Arc::clone(scene), found));
            self.is_clipped = false;
        }
    }

    /// Takes up how much of the finished picture of the scene is as bright as can be, 0–1.
    pub fn take_clipped(&mut self, clipped: f64) {
        if clipped <= CLIPPED || self.is_clipped {
            return;
        }
        self.is_clipped = true;
        self.hints.push(Hint {
            words: format!(
                "{:.0} % of the picture is at full brightness: less light shows more",
                clipped * 100.0
            ),
            about: About::World,
            is_twice: false,
        });
    }

    /// A button that counts the hints, and the list of them.
    pub fn show(&self, ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
        let count = self.hints.len();
        if count == 0 {
            return;
        }
        let words = counted(count, "hint");
        let color = palette(ui.ctx()).accent;
        let button = egui::Button::new((
            icons::text(icons::INFO).color(color),
            RichText::new(&words).small().color(color),
        ));
        let button = ui.add(button.frame_when_inactive(false));
        let button = button
            .accessible_name(words)
            .hint("Probable mistakes in the scene");
        Popup::menu(&button).width(WIDTH).show(|ui| {
            let area = ScrollArea::vertical().max_height(MOST_ROWS * ROW);
            area.show_rows(ui, ROW, count, |ui, rows| {
                for hint in &self.hints[rows] {
                    ui.horizontal(|ui| {
                        ui.label(&hint.words);
                        ui.add_space(GRID);
                        if ui.button("Select").clicked() {
                            out.select(selection(hint.about));
                        }
                        if let Some((word, edit)) = way_out(scene, hint)
                            && ui.button(word).clicked()
                        {
                            out.edit(edit);
                        }
                    });
                }
            });
        });
    }
}

fn selection(about: About) -> Selection {
    match about {
        About::Camera => Selection::Camera,
        About::World => Selection::World,
        About::Light(index) => Selection::from(Item::light(index)),
        About::Object(index) => Selection::from(Item::object(index)),
        About::Pack(index) => Selection::from(Item::pack(index)),
    }
}

/// What would mend it: packs that nothing wears can go, and what is there twice can be hidden.
fn way_out(scene: &Scene, hint: &Hint) -> Option<(&'static str, Edit)> {
    match hint.about {
        About::Pack(index) => Some(("Delete", Edit::Delete(vec![Item::pack(index)]))),
        About::Object(index) if hint.is_twice => {
            Some(("Hide", Edit::visible(scene, Item::object(index), false)?))
        }
        _ => None,
    }
}
