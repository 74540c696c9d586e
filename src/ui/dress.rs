//! Color packs that are dragged onto what shall wear them.

use egui::Response;

use crate::editor::{Edit, Editor, Item, Kind};

/// The pack that was dropped on a widget.
pub fn dropped_pack(response: &Response) -> Option<Item> {
    let dropped = response.dnd_release_payload::<Item>();
    dropped
        .map(|item| *item)
        .filter(|item| item.kind == Kind::Pack)
}

/// The change that makes an object or the marker of a light wear a pack; all that is selected, if it is among it.
pub fn dressed(editor: &Editor, pack: Item, item: Item) -> Option<Edit> {
    let scene = editor.shown();
    let name = pack.name(scene)?;
    let selected = editor.selection();
    let one = [item];
    let items = if selected.has(item) {
        selected.items()
    } else {
        &one
    };
    let edits = items.iter().filter_map(|item| match item.kind {
        Kind::Object => {
            let mut object = scene.objects.get(item.index)?.clone();
            name.clone_into(&mut object.color_pack);
            Some(Edit::object(item.index, object, "color pack"))
        }
        Kind::Light => {
            let mut light = scene.lights.get(item.index)?.clone();
            name.clone_into(&mut light.marker.as_mut()?.color_pack);
            Some(Edit::Light(item.index, light, "color pack"))
        }
        Kind::Pack => None,
    });
    let edits: Vec<Edit> = edits.collect();
    (!edits.is_empty()).then(|| Edit::Each(edits, format!("Wear {name}")))
}
