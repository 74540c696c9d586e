//! What commands do to everything that is selected.

use super::commands::Command;
use crate::editor::{Action, Edit, Editor, Item, Kind, Selected, excerpt};
use crate::scene::Scene;

/// Hides everything that is selected, or shows it if all of it is hidden.
pub fn toggle_visible(editor: &mut Editor) {
    let scene = editor.shown();
    let items = editor.selected().items();
    let mut visible = items.iter().filter_map(|item| item.is_visible(scene));
    let visible = !visible.any(|visible| visible);
    let field = if visible { "show" } else { "hide" };
    let edits = items.iter();
    let edits = edits.filter_map(|item| Edit::visible(scene, *item, visible));
    let edits: Vec<Edit> = edits.collect();
    let label = format!("{field} {} items", edits.len());
    editor.apply(Action::Edit(Edit::Each(edits, label)));
}

/// The selected objects, or a triangle and all that share corners with it.
pub fn joined(editor: &Editor) -> Vec<usize> {
    let selected = editor.selected().places(Kind::Object);
    match selected[..] {
        [triangle] => editor.scene().connected_triangles(triangle),
        _ => selected,
    }
}

/// Every object that wears the pack of an object, or the pack that is the item.
pub fn with_same_pack(scene: &Scene, item: Item) -> Selected {
    let pack = match item.kind {
        Kind::Object => scene
            .objects
            .get(item.index)
            .map(|object| &object.color_pack),
        Kind::Pack => scene
            .color_packs
            .get_index(item.index)
            .map(|(name, _)| name),
        Kind::Light => {
            let light = scene.lights.get(item.index);
            let marker = light.and_then(|light| light.marker.as_ref());
            marker.map(|marker| &marker.color_pack)
        }
    };
    let objects = scene.objects.iter().enumerate();
    let wearing = objects.filter(|(_, object)| Some(&object.color_pack) == pack);
    let others = wearing
        .map(|(index, _)| Item::object(index))
        .filter(|other| *other != item);
    // What was selected stays so, and is what the inspector shows.
    let own = Some(item);
    Selected::all(others.chain(own))
}

/// Adds everything of a scene, and selects it.
pub fn add(editor: &mut Editor, part: Scene, word: &'static str) {
    let before = editor.revision();
    let (lights, objects) = (part.lights.len(), part.objects.len());
    editor.apply(Action::Edit(Edit::Paste(Box::new(part), word)));
    if editor.revision() != before {
        let scene = editor.scene();
        let (all_lights, all_objects) = (scene.lights.len(), scene.objects.len());
        let new = (all_lights - lights..all_lights).map(Item::light);
        let new = new.chain((all_objects - objects..all_objects).map(Item::object));
        editor.apply(Action::Select(Selected::all(new)));
    }
}

/// Does to everything that is selected what can be done to more than one thing.
pub fn on_many(editor: &mut Editor, command: &Command) {
    let items = editor.selected().items().to_vec();
    let before = editor.revision();
    match command {
        Command::Delete => {
            editor.apply(Action::Edit(Edit::Delete(items)));
            if editor.revision() != before {
                editor.apply(Action::Select(Selected::Camera));
            }
        }
        Command::Duplicate => {
            if items.iter().all(|item| item.kind == Kind::Pack) {
                let label = format!("Duplicate {} items", items.len());
                let mut items = items;
                items.sort_unstable();
                // From the last on: a copy does not move those before it.
                let edits = items.iter().rev().map(|item| Edit::Duplicate(*item));
                let edit = Edit::Each(edits.collect(), label);
                return editor.apply(Action::Edit(edit));
            }
            let part = excerpt(editor.scene(), editor.selected());
            add(editor, part, "Duplicate");
        }
        _ => {}
    }
}
