//! Color packs that are dragged onto what shall wear them.

use egui::Response;

use crate::editor::{Edit, Editor, Item, Kind};
use crate::scene::Object;

/// The pack that was dropped on a widget.
pub fn dropped_pack(response: &Response) -> Option<Item> {
    let dropped = response.dnd_release_payload::<Item>();
    dropped
        .map(|item| *item)
        .filter(|item| item.kind == Kind::Pack)
}

/// The change that makes an object wear a pack; all that is selected, if the object is among it.
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
    let objects = items.iter().filter(|item| item.kind == Kind::Object);
    let edits = objects.filter_map(|item| {
        let object = scene.objects.get(item.index)?.clone();
        let color_pack = name.to_owned();
        let object = Object {
            color_pack,
            ..object
        };
        Some(Edit::object(item.index, object, "color pack"))
    });
    let edits: Vec<Edit> = edits.collect();
    (!edits.is_empty()).then(|| Edit::Each(edits, format!("Wear {name}")))
}
