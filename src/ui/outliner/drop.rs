//! Drag and drop onto rows of the outliner.

use std::collections::HashSet;

use egui::{DragAndDrop, PointerButton, Rect, Response, StrokeKind, Ui};

use super::lines::Group;
use crate::editor::{Arrangement, Edit, Editor, Item, ItemKind, Selection};
use crate::ui::pack_drag::assign_pack_edit;
use crate::ui::requests::UiRequests;
use crate::ui::theme::palette;

/// Height of the zone at the upper edge of a group's row, as a fraction of the row, where a drop places things
/// above the group; if the group is folded, also at the lower edge, for below.
const EDGE_SHARE: f32 = 0.3;

/// Drag payload of a group's row: the indices of its members.
#[derive(Clone, Debug)]
struct DraggedGroup(Vec<usize>);

/// How the drop target is marked.
enum DropMark {
    /// A frame around the row, which receives what is dropped.
    Frame,
    /// A line below the row if true, else above it.
    Line(bool),
}

/// Makes the row of an item draggable and lets it take drops: another row is placed above it (upper half) or below
/// it (lower half); a color pack on an object or a light is assigned to it.
pub fn accept_drop(
    ui: &Ui,
    editor: &Editor,
    response: &Response,
    (item, is_filtered): (Item, bool),
    out: &mut UiRequests,
) {
    if response.drag_started_by(PointerButton::Primary) {
        DragAndDrop::set_payload(ui.ctx(), item);
    }
    let Some(share) = share_of_row(ui, response) else {
        return;
    };
    let is_after = share > 0.5;
    let to = (item, is_after);
    let dragged = response.dnd_hover_payload::<Item>();
    let group = response.dnd_hover_payload::<DraggedGroup>();
    let is_pack = |item: &Item| item.kind == ItemKind::Pack;
    let assigns_pack = dragged.as_deref().is_some_and(is_pack) && !is_pack(&item);
    let edit = match dragged {
        Some(dragged) if assigns_pack => assign_pack_edit(editor, *dragged, item),
        // While filtering, groups are not listed, so nothing leaves its group or enters another.
        Some(dragged) if is_filtered && !are_in_one_group(editor, *dragged, item) => None,
        Some(dragged) => put_beside(editor, *dragged, to),
        None => group.and_then(|group| put_group_beside(editor, &group, to)),
    };
    let mark = if assigns_pack {
        DropMark::Frame
    } else {
        DropMark::Line(is_after)
    };
    drop_or_mark(ui, response.rect, (edit, mark), out);
}

/// Lets the row of a group take drops: objects become members, or are placed above the group if dropped on the
/// row's upper edge; another group is placed above it. If the group is folded, both can also be placed below.
pub fn accept_drop_on_group(
    ui: &Ui,
    editor: &Editor,
    response: &Response,
    (group, is_folded): (&Group, bool),
    out: &mut UiRequests,
) {
    if response.drag_started_by(PointerButton::Primary) {
        DragAndDrop::set_payload(ui.ctx(), DraggedGroup(group.members.clone()));
    }
    let Some(share) = share_of_row(ui, response) else {
        return;
    };
    let arranged_beside = |objects: Vec<usize>, is_after: bool, to: Option<String>| {
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
    let item_drop = |item: Item| {
        let objects = dragged_objects(editor, item);
        let no_group = Some(String::new());
        match item.kind {
            ItemKind::Object if share < EDGE_SHARE => (
                arranged_beside(objects, false, no_group),
                DropMark::Line(false),
            ),
            ItemKind::Object if is_folded && share > 1.0 - EDGE_SHARE => (
                arranged_beside(objects, true, no_group),
                DropMark::Line(true),
            ),
            ItemKind::Object => {
                let members: HashSet<&usize> = group.members.iter().collect();
                let is_new = !objects.iter().all(|object| members.contains(object));
                let joins = is_new.then(|| Edit::Group(objects, group.name.clone()));
                (joins, DropMark::Frame)
            }
            ItemKind::Light | ItemKind::Pack => (None, DropMark::Frame),
        }
    };
    let group_drop = |DraggedGroup(objects): &DraggedGroup| {
        let is_after = share > 0.5;
        let is_allowed = is_folded || !is_after;
        let edit = is_allowed.then(|| arranged_beside(objects.clone(), is_after, None));
        (edit.flatten(), DropMark::Line(is_after))
    };
    let item = response.dnd_hover_payload::<Item>();
    let other = response.dnd_hover_payload::<DraggedGroup>();
    let dropped = item.map(|item| item_drop(*item));
    if let Some(dropped) = dropped.or_else(|| Some(group_drop(&*other?))) {
        drop_or_mark(ui, response.rect, dropped, out);
    }
}

/// The items that are dragged along with one: the selected ones of its kind, if it is selected. An entire group is
/// dragged by its own row only.
fn dragged_items(editor: &Editor, item: Item) -> Vec<Item> {
    let selected = editor.selection();
    if selected.has(item) && selected.group(editor.scene()).is_none() {
        selected.of_kind(item.kind)
    } else {
        vec![item]
    }
}

/// The same for an object, as indices.
fn dragged_objects(editor: &Editor, item: Item) -> Vec<usize> {
    Selection::Items(dragged_items(editor, item)).indices(item.kind)
}

/// Returns whether all objects dragged with one item are in the same group as another item, or in none like it.
fn are_in_one_group(editor: &Editor, dragged: Item, item: Item) -> bool {
    let group = |index: usize| Some(&editor.scene().objects.get(index)?.group);
    item.kind != ItemKind::Object
        || dragged_objects(editor, dragged)
            .into_iter()
            .all(|object| group(object) == group(item.index))
}

/// The edit when an item is dropped on the upper or the lower half of a row.
fn put_beside(editor: &Editor, dragged: Item, (item, is_after): (Item, bool)) -> Option<Edit> {
    if dragged.kind != item.kind || dragged.index == item.index {
        return None;
    }
    if item.kind != ItemKind::Object {
        let items = dragged_items(editor, dragged);
        // The target index does not count the moved items.
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

/// The edit when a group is dropped on an object's row; groups cannot be nested.
fn put_group_beside(
    editor: &Editor,
    DraggedGroup(objects): &DraggedGroup,
    (item, is_after): (Item, bool),
) -> Option<Edit> {
    let object = editor.scene().objects.get(item.index)?;
    let is_allowed = item.kind == ItemKind::Object && object.group.is_empty();
    is_allowed.then(|| arranged(objects.clone(), (item.index, is_after), None))
}

/// Vertical position of the pointer within a row, from 0 to less than 1 (adjacent rows share a border); `None` if
/// it is elsewhere.
fn share_of_row(ui: &Ui, response: &Response) -> Option<f32> {
    let at = ui.input(|input| input.pointer.interact_pos())?;
    let rect = response.rect;
    let share = (at.y - rect.top()) / rect.height();
    (response.contains_pointer() && share < 1.0).then_some(share)
}

/// Objects and groups dropped on the title below their list are moved to its end. While filtering, groups are not
/// listed, and nothing is moved.
pub fn accept_drop_at_end(
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
    // If the list has no other objects, these just leave their groups.
    let edit = edit.or_else(|| to.map(|none| Edit::Group(objects, none)));
    drop_or_mark(ui, response.rect, (edit, DropMark::Line(false)), out);
}

/// Applies the edit if the drag is released now; otherwise marks the drop target.
fn drop_or_mark(ui: &Ui, rect: Rect, (edit, mark): (Option<Edit>, DropMark), out: &mut UiRequests) {
    let Some(edit) = edit else { return };
    let accent = palette(ui.ctx()).accent;
    if ui.input(|input| input.pointer.any_released()) {
        // Adjacent rows share a border: only one of them may take the drop.
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
