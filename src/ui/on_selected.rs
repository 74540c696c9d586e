//! Commands that act on everything that is selected.

use std::collections::HashSet;

use crate::editor::{Action, Arrangement, Edit, Editor, Item, ItemKind, Selection, excerpt};
use crate::scene::Scene;
use crate::words::counted;

/// Returns the edit that hides everything that is selected, or shows it if all of it is hidden.
pub fn toggle_visible(editor: &Editor) -> Edit {
    let scene = editor.shown();
    let items = editor.selection().items();
    let mut visible = items.iter().filter_map(|item| item.is_visible(scene));
    let visible = !visible.any(|visible| visible);
    let verb = if visible { "Show" } else { "Hide" };
    let edits = items.iter();
    let edits = edits.filter_map(|item| Edit::visible(scene, *item, visible));
    let edits: Vec<Edit> = edits.collect();
    let name = match items {
        [item] => item.name(scene).unwrap_or_default().to_owned(),
        _ => counted(edits.len(), "item"),
    };
    Edit::Each(edits, format!("{verb} {name}"))
}

/// Returns the selected objects or, if only a triangle is selected, all triangles connected to it by shared corners.
pub fn objects_to_join(editor: &Editor) -> Vec<usize> {
    let selected = editor.selection().indices(ItemKind::Object);
    match selected[..] {
        [triangle] => editor.scene().connected_triangles(triangle),
        _ => selected,
    }
}

/// Adds to the selection everything with the color pack of the last selected item, which may be that pack itself.
pub fn with_same_pack(scene: &Scene, selected: &Selection) -> Selection {
    let pack = selected.item().and_then(|item| item.color_pack(scene));
    let wearing = pack
        .into_iter()
        .flat_map(|pack| Item::users_of_pack(scene, pack));
    let own: HashSet<Item> = selected.items().iter().copied().collect();
    let others = wearing.filter(|other| !own.contains(other));
    // The previous selection comes last, so that the inspector keeps showing its last item.
    Selection::all(others.chain(selected.items().iter().copied()))
}

/// Returns the edit that deletes everything that is selected.
pub fn delete(editor: &Editor) -> Option<Edit> {
    match editor.selection() {
        Selection::Keys(keys) => Some(Edit::delete_keys(&editor.scene().animation, keys)),
        Selection::Items(items) => Some(Edit::Delete(items.clone())),
        Selection::Camera | Selection::World | Selection::Render => None,
    }
}

/// Duplicates each of several selected items.
pub fn duplicate_all(editor: &mut Editor) {
    let mut items = editor.selection().items().to_vec();
    if items.iter().any(|item| item.kind != ItemKind::Pack) {
        let part = excerpt(editor.scene(), editor.selection());
        let paste = Edit::Paste(Box::new(part), "Duplicate");
        return editor.apply(Action::Edit(paste));
    }
    let label = format!("Duplicate {} items", items.len());
    items.sort_unstable();
    // In descending order, since a copy moves only the items after it.
    let edits = items.iter().rev().map(|item| Edit::Duplicate(*item));
    if editor.changes(Action::Edit(Edit::Each(edits.collect(), label))) {
        // Each copy follows its original, so that those after it have moved on by one more.
        let copies = items.iter().zip(1..);
        let copies = copies.map(|(item, offset)| Item::pack(item.index + offset));
        editor.apply(Action::Select(Selection::all(copies)));
    }
}

/// Returns the edit that moves the selected item, or the selected items as a group, one step in its list.
pub fn move_step(editor: &Editor, is_down: bool) -> Option<Edit> {
    let (scene, selection) = (editor.scene(), editor.selection());
    let item = selection.item()?;
    match item.kind {
        ItemKind::Object => {
            let moved = selection.indices(ItemKind::Object);
            Arrangement::step(&scene.objects, &moved, is_down).map(Edit::Arrange)
        }
        kind => {
            let items = selection.of_kind(kind);
            let indices = || items.iter().map(|item| item.index);
            // Places to move to are counted without the moved items.
            let target = if is_down {
                let last = indices()
                    .max()
                    .filter(|last| last + 1 < kind.count(scene))?;
                last + 2 - items.len()
            } else {
                indices().min()?.checked_sub(1)?
            };
            Some(Edit::Move(items, target))
        }
    }
}
