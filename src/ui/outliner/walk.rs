//! Moving through the list with the arrow keys, from row to row instead of from widget to widget.

use egui::{Event, EventFilter, Key, Modifiers, Response, Ui};

use super::lines::{FIXED_ROWS, Group, Line, Lines};
use crate::editor::{Action, Editor, Item, ItemKind, Selection};
use crate::scene::Scene;

/// The state of keyboard navigation.
#[derive(Debug, Default)]
pub struct Walk {
    /// The last frame in which the pointer was over the list while no widget had the focus.
    hovered_in_frame: u64,
    /// Whether the key that is held was first pressed for the list.
    is_held: bool,
    /// The row that has the focus.
    focused: Option<usize>,
    /// The row moved to last: a group with one member and that member are different rows, but the same selection.
    last: Option<usize>,
    /// The row that is to get the focus.
    goal: Option<usize>,
}

/// The rows of the list, with the data needed to interpret them.
#[derive(Clone, Copy)]
pub struct Listed<'a> {
    /// The lines.
    pub lines: &'a Lines<'a>,
    /// The groups, by index.
    pub groups: &'a [Group],
    /// Whether each object is selected, by index.
    pub marks: &'a [bool],
}

impl Walk {
    /// Returns whether arrow keys held in this frame are meant for the list.
    pub fn has_keys(&self, ui: &Ui) -> bool {
        let is_down = |key: Key| ui.input(|input| input.key_down(key));
        self.hovered_in_frame == ui.ctx().cumulative_frame_nr()
            && (is_down(Key::ArrowUp) || is_down(Key::ArrowDown))
    }

    /// The row that a key press moves to in this frame, and the action that selects it.
    pub fn step(
        &mut self,
        ui: &Ui,
        (editor, listed): (&Editor, Listed),
        keys_are_free: bool,
    ) -> Option<(usize, Action)> {
        let is_unfocused = ui.memory(|memory| memory.focused().is_none());
        let is_over = is_unfocused && ui.rect_contains_pointer(ui.max_rect());
        let focused = self.focused.take();
        self.goal = None;
        if !keys_are_free || !is_over && focused.is_none() {
            return None;
        }
        if is_over {
            self.hovered_in_frame = ui.ctx().cumulative_frame_nr();
        }
        let is_down = self.pressed(ui)?;
        let last = self.last.filter(|row| listed.is_selected(editor, *row));
        let from = focused.or(last).or_else(|| listed.row_of(editor));
        let count = listed.lines.len();
        let selectable = |row| Some((row, listed.selection_of(row)?));
        let (row, selected) = if is_down {
            (from.map_or(0, |row| row + 1)..count).find_map(selectable)
        } else {
            (0..from.unwrap_or(count)).rev().find_map(selectable)
        }?;
        self.last = Some(row);
        self.goal = focused.map(|_| row);
        Some((row, Action::Select(selected)))
    }

    /// Returns `true` if Down was pressed, `false` if Up was. Repeats count if the key was first pressed for the
    /// list.
    fn pressed(&mut self, ui: &Ui) -> Option<bool> {
        let mut pressed = None;
        ui.input(|input| {
            for event in &input.events {
                if let Event::Key {
                    key: key @ (Key::ArrowUp | Key::ArrowDown),
                    pressed: true,
                    repeat,
                    modifiers: Modifiers::NONE,
                    ..
                } = event
                {
                    self.is_held |= !repeat;
                    pressed = self.is_held.then_some(*key == Key::ArrowDown);
                }
            }
            self.is_held &= input.key_down(Key::ArrowUp) || input.key_down(Key::ArrowDown);
        });
        pressed
    }

    /// Notes whether a row has the focus, and passes the focus to the row that was moved to.
    pub fn track_focus(&mut self, ui: &Ui, row: usize, response: &Response) {
        if self.goal == Some(row) {
            response.request_focus();
        }
        if response.has_focus() {
            self.focused = Some(row);
            let filter = EventFilter {
                vertical_arrows: true,
                ..EventFilter::default()
            };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        }
    }
}

impl Listed<'_> {
    /// Returns whether an item is selected.
    pub fn is_marked(&self, editor: &Editor, item: Item) -> bool {
        match item.kind {
            ItemKind::Object => self.marks.get(item.index) == Some(&true),
            ItemKind::Light | ItemKind::Pack => editor.selection().has(item),
        }
    }

    /// The row of the selection, if it is listed: that of the group, if exactly a whole group is selected, or if
    /// the group is folded.
    pub fn row_of(&self, editor: &Editor) -> Option<usize> {
        let Some(item) = editor.selection().item() else {
            let mut fixed_rows = FIXED_ROWS.iter();
            return fixed_rows.position(|(fixed, ..)| fixed == editor.selection());
        };
        match editor.selection().group(editor.scene()) {
            Some(group) => self.row_of_group(group),
            None => self.row_of_item(editor.scene(), item),
        }
    }

    /// The row of an item, or of its group if that is folded.
    fn row_of_item(&self, scene: &Scene, item: Item) -> Option<usize> {
        let row = self.lines.row_of(item);
        row.or_else(|| self.row_of_group(item.group(scene)?))
    }

    /// All items between two entries of a list, inclusive; folded groups contribute all of their members.
    pub fn between(&self, scene: &Scene, one: Item, other: Item) -> Option<Vec<Item>> {
        let (one, other) = (
            self.row_of_item(scene, one)?,
            self.row_of_item(scene, other)?,
        );
        let is_member = |row| matches!(self.lines.get(row), Some(Line::Entry(_, true)));
        let entries = |row| match self.lines.get(row) {
            Some(Line::Entry(item, _)) => vec![item],
            Some(Line::Group(index)) if !is_member(row + 1) => self.groups[index].items().collect(),
            _ => Vec::new(),
        };
        let rows = one.min(other)..=one.max(other);
        Some(rows.flat_map(entries).collect())
    }

    fn row_of_group(&self, name: &str) -> Option<usize> {
        (0..self.lines.len()).find(|row| match self.lines.get(*row) {
            Some(Line::Group(index)) => self.groups[index].name == name,
            _ => false,
        })
    }

    /// The selection of a row; `None` if the row cannot be selected.
    fn selection_of(&self, row: usize) -> Option<Selection> {
        Some(match self.lines.get(row)? {
            Line::Fixed(selection, ..) => selection.clone(),
            Line::Entry(item, _) => Selection::all([item]),
            Line::Group(index) => Selection::all(self.groups[index].items()),
            Line::Title(..) => return None,
        })
    }

    /// Returns whether a row's items are the selection.
    fn is_selected(&self, editor: &Editor, row: usize) -> bool {
        self.selection_of(row).as_ref() == Some(editor.selection())
    }
}

#[cfg(test)]
mod tests {
    use super::super::lines::{Entries, Groups};
    use super::*;

    #[test]
    fn a_light_that_is_not_listed_has_no_row_among_the_objects() {
        let mut scene = Scene::demo();
        scene.objects[0].group = "pair".to_owned();
        let (mut groups, mut folded) = (Groups::default(), vec!["pair".to_owned()]);
        groups.update(&scene.objects, &mut folded);
        let lines = Lines([
            (ItemKind::Light, 2, Entries::All(0)),
            (ItemKind::Object, 9, Entries::Grouped(&groups)),
            (ItemKind::Pack, 5, Entries::All(5)),
        ]);
        let listed = Listed {
            lines: &lines,
            groups: &groups.all,
            marks: &[],
        };
        let group = listed.row_of_group("pair");
        assert!(group.is_some());
        assert_eq!(listed.row_of_item(&scene, Item::object(0)), group);
        assert_eq!(listed.row_of_item(&scene, Item::light(0)), None);
    }
}
