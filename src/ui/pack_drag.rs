//! Dragging color packs onto objects and markers.

use egui::Response;

use crate::editor::{Edit, Editor, Item, ItemKind};
use crate::scene::{Light, Object};

/// Returns the color pack that was dropped on a widget.
pub fn dropped_pack(response: &Response) -> Option<Item> {
    let dropped = response.dnd_release_payload::<Item>();
    dropped
        .map(|item| *item)
        .filter(|item| item.kind == ItemKind::Pack)
}

/// Returns the edit that gives a color pack to an object or a light's marker; to the whole selection if it is in it.
pub fn assign_pack_edit(editor: &Editor, pack: Item, item: Item) -> Option<Edit> {
    let scene = editor.shown();
    let name = pack.name(scene)?;
    let selected = editor.selection();
    let items = if selected.has(item) {
        selected.items()
    } else {
        std::slice::from_ref(&item)
    };
    let wearers = items.iter().filter(|item| item.color_pack(scene).is_some());
    let edits = wearers.filter_map(|item| {
        let to_object = |object: &mut Object| name.clone_into(&mut object.color_pack);
        let to_light = |light: &mut Light| {
            if let Some(marker) = &mut light.marker {
                name.clone_into(&mut marker.color_pack);
            }
        };
        Edit::of_item(scene, *item, "color pack", (to_object, to_light))
    });
    let edits: Vec<Edit> = edits.collect();
    (!edits.is_empty()).then(|| Edit::Each(edits, format!("Assign {name}")))
}
