//! What rows of the outliner do with what is dragged onto them.

use std::collections::HashSet;

use egui::{DragAndDrop, Rect, Response, StrokeKind, Ui};

use super::lines::Group;
use crate::editor::{Arrangement, Edit, Editor, Item, ItemKind, Selection};
use crate::ui::pack_drag::dressed;
use crate::ui::requests::UiRequests;
use crate::ui::theme::palette;

/// The share of the row of a group, from the top, where what is dropped stands above it.
const EDGE: f32 = 0.3;

/// A group whose row is dragged: the places of its members.
#[derive(Clone, Debug)]
struct DraggedGroup(Vec<usize>);

/// What shows where something would be dropped.
enum DropMark {
    /// A frame around the row, which takes it in.
    Frame,
    /// A line above the row, or below it.
    Line(bool),
}

/// Drag a row to the upper half of another to put it above that, or to the lower half to put it below; a pack onto an
/// object or a light, to be worn by it.
pub fn take_dropped(
    ui: &Ui,
    editor: &Editor,
    response: &Response,
    (item, is_filtered): (Item, bool),
    out: &mut UiRequests,
) {
    response.dnd_set_drag_payload(item);
    let Some(share) = share_of_row(ui, response) else {
        return;
    };
    let is_after = share > 0.5;
    let to = (item, is_after);
    let dragged = response.dnd_hover_payload::<Item>();
    let group = response.dnd_hover_payload::<DraggedGroup>();
    let is_worn = |dragged: &Item| dragged.kind == ItemKind::Pack && item.kind != ItemKind::Pack;
    let is_worn = dragged.as_ref().is_some_and(|dragged| is_worn(dragged));
    let edit = match dragged {
        Some(dragged) if is_worn => dressed(editor, *dragged, item),
        // Where groups are not listed, nothing leaves its own or enters another.
        Some(dragged) if is_filtered && !are_in_one_group(editor, *dragged, item) => None,
        Some(dragged) => put_beside(editor, *dragged, to),
        None => group.and_then(|group| put_group_beside(editor, &group, to)),
    };
    let mark = if is_worn {
        DropMark::Frame
    } else {
        DropMark::Line(is_after)
    };
    drop_or_mark(ui, response.rect, (edit, mark), out);
}

/// Objects that are dropped on a group are members of it, or stand above it where they are dropped on its upper edge;
/// another group stands above it. Where its members are not listed, both may stand below it.
pub fn take_dropped_on_group(
    ui: &Ui,
    editor: &Editor,
    response: &Response,
    (group, is_folded): (&Group, bool),
    out: &mut UiRequests,
) {
    if response.dragged() {
        response.dnd_set_drag_payload(DraggedGroup(group.members.clone()));
    }
    let Some(share) = share_of_row(ui, response) else {
        return;
    };
    let beside = |objects: Vec<usize>, is_after: bool, to: Option<String>| {
        let moved: HashSet<&usize> = objects.iter().collect();
        let mut others = group.members.iter().filter(|it| !moved.contains(it));
        let anchor = if is_after {
            others.next_back()
        } else {
            others.next()
        };
        let anchor = *anchor?;
        Some(arranged(objects, (anchor, is_after), to))
    };
    let of_item = |item: Item| {
        let objects = dragged_objects(editor, item);
        let alone = Some(String::new());
        match item.kind {
            ItemKind::Object if share < EDGE => {
                (beside(objects, false, alone), DropMark::Line(false))
            }
            ItemKind::Object if is_folded && share > 1.0 - EDGE => {
                (beside(objects, true, alone), DropMark::Line(true))
            }
            ItemKind::Object => {
                let members: HashSet<&usize> = group.members.iter().collect();
                let is_new = !objects.iter().all(|object| members.contains(object));
                let joins = is_new.then(|| Edit::Group(objects, group.name.clone()));
                (joins, DropMark::Frame)
            }
            ItemKind::Light | ItemKind::Pack => (None, DropMark::Frame),
        }
    };
    let of_group = |DraggedGroup(objects): &DraggedGroup| {
        let is_after = share > 0.5;
        let has_place = is_folded || !is_after;
        let edit = has_place.then(|| beside(objects.clone(), is_after, None));
        (edit.flatten(), DropMark::Line(is_after))
    };
    let item = response.dnd_hover_payload::<Item>();
    let other = response.dnd_hover_payload::<DraggedGroup>();
    let dropped = item.map(|item| of_item(*item));
    if let Some(dropped) = dropped.or_else(|| Some(of_group(&*other?))) {
        drop_or_mark(ui, response.rect, dropped, out);
    }
}

/// What is dragged with one: all of its kind that are selected, if it is among them. All of a group are dragged by its own
/// row.
fn dragged_items(editor: &Editor, item: Item) -> Vec<Item> {
    let selected = editor.selection();
    if selected.has(item) && selected.group(editor.scene()).is_none() {
        selected.of_kind(item.kind)
    } else {
        vec![item]
    }
}

/// The same of an object.
fn dragged_objects(editor: &Editor, item: Item) -> Vec<usize> {
    Selection::Items(dragged_items(editor, item)).places(item.kind)
}

/// Whether what is dragged with one item and another one are in the same group, or in none.
fn are_in_one_group(editor: &Editor, dragged: Item, item: Item) -> bool {
    let group = |index: usize| Some(&editor.scene().objects.get(index)?.group);
    item.kind != ItemKind::Object
        || dragged_objects(editor, dragged)
            .into_iter()
            .all(|object| group(object) == group(item.index))
}

/// What comes of an item that is dropped on the upper or the lower half of a row.
fn put_beside(editor: &Editor, dragged: Item, (item, is_after): (Item, bool)) -> Option<Edit> {
    if dragged.kind != item.kind || dragged.index == item.index {
        return None;
    }
    if item.kind != ItemKind::Object {
        let items = dragged_items(editor, dragged);
        // Counted without them.
        let before = items
            .iter()
            .filter(|other| other.index < item.index)
            .count();
        let to = item.index + usize::from(is_after) - before;
        return (!items.contains(&item)).then_some(Edit::Move(items, to));
    }
    let objects = dragged_objects(editor, dragged);
    let group = editor.scene().objects.get(item.index)?.group.clone();
    let is_beside = !objects.contains(&item.index);
    is_beside.then(|| arranged(objects, (item.index, is_after), Some(group)))
}

fn arranged(objects: Vec<usize>, (anchor, is_after): (usize, bool), group: Option<String>) -> Edit {
    Edit::Arrange(Arrangement {
        objects,
        anchor,
        is_after,
        group,
    })
}

/// What comes of a group that is dropped there: no group is in another.
fn put_group_beside(
    editor: &Editor,
    DraggedGroup(objects): &DraggedGroup,
    (item, is_after): (Item, bool),
) -> Option<Edit> {
    let object = editor.scene().objects.get(item.index)?;
    let has_place = item.kind == ItemKind::Object && object.group.is_empty();
    has_place.then(|| arranged(objects.clone(), (item.index, is_after), None))
}

/// How far down in a row the pointer is, from 0 to less than 1, if it is there: two rows share a border.
fn share_of_row(ui: &Ui, response: &Response) -> Option<f32> {
    let at = ui.input(|input| input.pointer.interact_pos())?;
    let rect = response.rect;
    let share = (at.y - rect.top()) / rect.height();
    (response.contains_pointer() && share < 1.0).then_some(share)
}

/// Objects and groups that are dropped on the title below their list come last in it.
/// Where groups are not listed, nothing is.
pub fn take_dropped_at_end(
    ui: &Ui,
    editor: &Editor,
    (response, is_filtered): (&Response, bool),
    out: &mut UiRequests,
) {
    if is_filtered || share_of_row(ui, response).is_none_or(|share| share > 0.5) {
        return;
    }
    let item = response.dnd_hover_payload::<Item>();
    let item = item.filter(|item| item.kind == ItemKind::Object);
    let group = response.dnd_hover_payload::<DraggedGroup>();
    let (objects, to) = match (item, group) {
        (Some(item), _) => (dragged_objects(editor, *item), Some(String::new())),
        (None, Some(group)) => (group.0.clone(), None),
        (None, None) => return,
    };
    let at_end = Arrangement::at_end(&editor.scene().objects, &objects, to.clone());
    let edit = at_end.map(Edit::Arrange);
    // Where nothing else is, they leave their groups where they are.
    let edit = edit.or_else(|| to.map(|none| Edit::Group(objects, none)));
    drop_or_mark(ui, response.rect, (edit, DropMark::Line(false)), out);
}

/// Makes the change that comes of what is dragged over a row where it is dropped now, or else shows that it would.
fn drop_or_mark(ui: &Ui, rect: Rect, (edit, mark): (Option<Edit>, DropMark), out: &mut UiRequests) {
    let Some(edit) = edit else { return };
    let accent = palette(ui.ctx()).accent;
    if ui.input(|input| input.pointer.any_released()) {
        // Two rows share a border: one of them takes it.
        DragAndDrop::clear_payload(ui.ctx());
        out.edit(edit);
        return;
    }
    match mark {
        DropMark::Frame => {
            let stroke = (1.0, accent);
            ui.painter()
                .rect_stroke(rect, 2, stroke, StrokeKind::Inside);
        }
        DropMark::Line(is_below) => {
            let y = if is_below { rect.bottom() } else { rect.top() };
            ui.painter().hline(rect.x_range(), y, (2.0, accent));
        }
    }
}
