//! Hints about probable mistakes in the scene, with a button to select what is affected and, for some, one to fix it.

use std::sync::Arc;

use egui::{Popup, RichText, ScrollArea, Ui};

use super::hint::Hinted as _;
use super::icons;
use super::requests::UiRequests;
use super::theme::{GRID, ROW, palette};
use crate::editor::{Edit, Editor, Item, Selection};
use crate::scene::{About, Hint, Scene, camera_hints, scene_hints};
use crate::words::counted;

/// Width of the list in points.
const WIDTH: f32 = 420.0;
/// Greatest number of visible rows.
const MAX_ROWS: f32 = 12.0;

/// The hints about a state of the scene.
#[derive(Default)]
pub struct SceneCheck {
    revision: Option<u64>,
    /// Hints that do not depend on the camera, and the scene they are about.
    scene_hints: Option<(Arc<Scene>, Vec<Hint>)>,
    hints: Vec<Hint>,
    /// The hint about clipping in the last finished picture.
    clipping_hint: Option<Hint>,
}

/// Share of clipped pixels in the picture above which a hint is given.
const MAX_CLIPPED_SHARE: f64 = 0.05;

impl SceneCheck {
    /// Checks the scene again if it has changed, unless something is being dragged.
    pub fn update(&mut self, editor: &Editor, is_busy: bool) {
        if self.revision != Some(editor.revision()) && !is_busy {
            self.revision = Some(editor.revision());
            let scene = editor.scene();
            let cached = self.scene_hints.take();
            // Finding coincident surfaces takes long, and does not depend on the camera.
            let cached = cached.filter(|(of, _)| of.shares_contents_with(scene));
            let found = cached.map_or_else(|| scene_hints(scene), |(_, found)| found);
            self.hints = camera_hints(scene);
            self.hints.extend_from_slice(&found);
            self.scene_hints = Some((Arc::clone(scene), found));
        }
    }

    /// Takes the share of a finished picture that is at full brightness, 0–1.
    pub fn take_clipped(&mut self, clipped: f64) {
        self.clipping_hint = (MAX_CLIPPED_SHARE < clipped).then(|| Hint {
            words: format!(
                "{:.0} % of the picture is at full brightness: less light shows more",
                clipped * 100.0
            ),
            about: About::World,
            is_duplicate: false,
        });
    }

    /// Shows a button with the number of hints, which opens their list.
    pub fn show(&self, ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
        let hints = || self.hints.iter().chain(&self.clipping_hint);
        let count = self.hints.len() + usize::from(self.clipping_hint.is_some());
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
            let area = ScrollArea::vertical().max_height(MAX_ROWS * ROW);
            area.show_rows(ui, ROW, count, |ui, rows| {
                for hint in hints().skip(rows.start).take(rows.len()) {
                    ui.horizontal(|ui| {
                        ui.label(&hint.words);
                        ui.add_space(GRID);
                        if ui.button("Select").clicked() {
                            out.select(selection_of(hint.about));
                        }
                        if let Some((word, edit)) = fix_for(scene, hint)
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

fn selection_of(about: About) -> Selection {
    match about {
        About::Camera => Selection::Camera,
        About::World => Selection::World,
        About::Light(index) => Selection::from(Item::light(index)),
        About::Object(index) => Selection::from(Item::object(index)),
        About::Pack(index) => Selection::from(Item::pack(index)),
    }
}

/// Returns a fix for a hint: unused color packs can be deleted, and duplicates can be hidden.
fn fix_for(scene: &Scene, hint: &Hint) -> Option<(&'static str, Edit)> {
    match hint.about {
        About::Pack(index) => Some(("Delete", Edit::Delete(vec![Item::pack(index)]))),
        About::Object(index) if hint.is_duplicate => {
            Some(("Hide", Edit::visible(scene, Item::object(index), false)?))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Action;

    #[test]
    fn the_hint_about_brightness_follows_the_picture_and_outlives_edits() {
        let mut check = SceneCheck::default();
        let mut editor = Editor::demo();
        check.update(&editor, false);
        let words = |check: &SceneCheck| check.clipping_hint.as_ref().map(|it| it.words.clone());
        for (clipped, expected) in [(0.3, Some("30 %")), (0.07, Some("7 %")), (0.01, None)] {
            check.take_clipped(clipped);
            let hint = words(&check);
            assert_eq!(hint.is_some(), expected.is_some(), "{clipped}");
            assert!(hint.is_none_or(|hint| expected.is_some_and(|it| hint.starts_with(it))));
        }
        check.take_clipped(0.3);
        editor.apply(Action::Edit(Edit::AddPack));
        check.update(&editor, false);
        assert!(words(&check).is_some(), "the picture has not changed");
    }
}
