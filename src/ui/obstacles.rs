//! The reasons why a command would do nothing now.

use super::commands::Command;
use super::dialogs::Ask;
use crate::editor::{Editor, Item, ItemKind, Selection};
use crate::scene::{Object, Scene, Shape};

/// Returns why the command would do nothing now; `None` if it would do something.
pub fn obstacle(command: &Command, editor: &Editor) -> Option<&'static str> {
    let nothing = "nothing is selected";
    match command {
        Command::Undo => editor.undo_label().is_none().then_some("nothing to undo"),
        Command::Redo => editor.redo_label().is_none().then_some("nothing to redo"),
        Command::Delete => {
            let has = matches!(editor.selection(), Selection::Items(_) | Selection::Keys(_));
            (!has).then_some(nothing)
        }
        Command::Duplicate if !editor.selection().keys().is_empty() => None,
        Command::Duplicate | Command::Copy | Command::Cut | Command::SelectSamePack => {
            let has = editor.selection().item().is_some();
            (!has).then_some(nothing)
        }
        Command::ToggleVisible => {
            let mut items = editor.selection().items().iter();
            let has = items.any(|item| item.is_visible(editor.shown()).is_some());
            (!has).then_some("nothing that can be hidden is selected")
        }
        Command::Join => joining_obstacle(editor),
        Command::Separate => {
            let (scene, items) = (editor.scene(), editor.selection().items());
            let shape = match items {
                [item] => shape_of(scene, *item),
                _ => None,
            };
            let can = matches!(shape, Some(Shape::Mesh(mesh)) if mesh.is_separable());
            (!can).then_some("select one mesh with few enough triangles")
        }
        Command::Retime(_) => {
            let has = editor.scene().animation.keys.len() > 1;
            (!has).then_some("the camera has fewer than two keys")
        }
        Command::Group if editor.selection().is_group(editor.scene()) => {
            Some("it is already a group")
        }
        Command::Group | Command::PutDown => {
            let items = editor.selection().items().iter();
            let objects = items.filter(|item| item.kind == ItemKind::Object);
            let objects = objects.filter_map(|item| editor.scene().objects.get(item.index));
            let mut objects = objects.peekable();
            let is_endless = |object: &Object| object.shape.endless_plane().is_some();
            match command {
                _ if objects.peek().is_none() => Some("no object is selected"),
                Command::PutDown if objects.all(is_endless) => Some("planes go on forever"),
                _ => None,
            }
        }
        Command::Ungroup => {
            let mut items = editor.selection().items().iter();
            let has = items.any(|item| item.group(editor.scene()).is_some());
            (!has).then_some("nothing in a group is selected")
        }
        Command::MergePacks => {
            let has = editor.scene().has_equal_packs();
            (!has).then_some("no two color packs are equal")
        }
        Command::Rename | Command::MoveUp | Command::MoveDown
            if editor.selection().group(editor.scene()).is_some() =>
        {
            None
        }
        Command::Rename | Command::MoveUp | Command::MoveDown => match editor.selection().items() {
            [] => Some(nothing),
            [_] => None,
            _ => Some("several items are selected"),
        },
        Command::Play if editor.scene().animation.duration() == 0.0 => {
            Some("nothing is animated yet")
        }
        Command::FirstFrame | Command::LastFrame | Command::FrameBack | Command::FrameOn
            if editor.scene().animation.is_still() =>
        {
            Some("nothing is animated yet")
        }
        Command::SelectKeys | Command::PreviousKey | Command::NextKey => {
            let is_still = editor.scene().animation.is_still();
            is_still.then_some("there are no keys yet")
        }
        Command::LookThrough if editor.timeline().recorded().is_some() => {
            Some("a flight is being recorded")
        }
        Command::LookThrough | Command::Ask(Ask::ExportPath) => {
            let has = !editor.scene().animation.keys.is_empty();
            (!has).then_some("the camera has no keys yet")
        }
        Command::Record if editor.timeline().recorded().is_some() => {
            Some("a flight is already being recorded")
        }
        Command::StopRecording if editor.timeline().recorded().is_none() => {
            Some("no flight is being recorded")
        }
        _ => None,
    }
}

/// Returns why the selected objects cannot be joined into a mesh; selected lights are ignored.
fn joining_obstacle(editor: &Editor) -> Option<&'static str> {
    let scene = editor.scene();
    let items = editor.selection().of_kind(ItemKind::Object);
    let mut shapes = items.iter().map(|item| shape_of(scene, *item));
    let can = match items.len() {
        1 => matches!(shapes.next(), Some(Some(Shape::Triangle(_)))),
        _ => shapes.all(|shape| matches!(shape, Some(Shape::Triangle(_) | Shape::Mesh(_)))),
    };
    let is_unread = |item: &Item| {
        let shape = shape_of(scene, *item);
        matches!(shape, Some(Shape::Mesh(mesh)) if mesh.source.problem().is_some())
    };
    if items.iter().any(is_unread) {
        return Some("the file of a selected mesh could not be read");
    }
    (!can || items.is_empty()).then_some("select triangles or several meshes")
}

fn shape_of(scene: &Scene, item: Item) -> Option<&Shape> {
    let object = match item.kind {
        ItemKind::Object => scene.objects.get(item.index)?,
        ItemKind::Light | ItemKind::Pack => return None,
    };
    Some(&object.shape)
}
