//! The arrow keys in the list: from row to row, and not from button to button.

use egui::{Event, EventFilter, Key, Modifiers, Response, Ui};

use super::lines::{Group, Line, Lines, SINGLES};
use crate::editor::{Action, Editor, Item, ItemKind, Selection};
use crate::scene::Scene;

/// What has the arrow keys.
#[derive(Debug, Default)]
pub struct Walk {
    /// The frame in which the pointer was over the list last, and nothing else had the keys.
    over_in: u64,
    /// Whether the key that is held was pressed for the list.
    is_held: bool,
    /// The row that has the focus.
    focused: Option<usize>,
    /// The row that was walked to last: a group of one thing is another row than that.
    last: Option<usize>,
    /// The row that gets the focus.
    goal: Option<usize>,
}

/// The list, and the groups in it.
#[derive(Clone, Copy)]
pub struct Listed<'a> {
    /// Its lines.
    pub lines: &'a Lines<'a>,
    /// The groups, by their places.
    pub groups: &'a [Group],
    /// For each object whether it is selected.
    pub marks: &'a [bool],
}

impl Walk {
    /// Whether the keys that are held in this frame are meant for the list.
    pub fn has_keys(&self, ui: &Ui) -> bool {
        let is_down = |key: Key| ui.input(|input| input.key_down(key));
        self.over_in == ui.ctx().cumulative_frame_nr()
            && (is_down(Key::ArrowUp) || is_down(Key::ArrowDown))
    }

    /// The row that a key walks to in this frame, and what selects what is in it.
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
            self.over_in = ui.ctx().cumulative_frame_nr();
        }
        let is_down = self.pressed(ui)?;
        let last = self.last.filter(|row| listed.is_selected(editor, *row));
        let from = focused.or(last).or_else(|| listed.row_of(editor));
        let count = listed.lines.len();
        let mut row = from;
        let (row, selected) = loop {
            let next = match (row, is_down) {
                (None, true) => 0,
                (None, false) => count - 1,
                (Some(row), true) => row + 1,
                (Some(row), false) => row.checked_sub(1)?,
            };
            if let Some(selected) = listed.selects(next) {
                break (next, selected);
            }
            row = (next < count).then_some(Some(next))?;
        };
        self.last = Some(row);
        self.goal = focused.map(|_| row);
        Some((row, Action::Select(selected)))
    }

    /// Whether Down was pressed, or Up; also again and again, if that began here.
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

    /// Notes of a row whether it has the focus, and gives it to the one that was walked to.
    pub fn attend(&mut self, ui: &Ui, row: usize, response: &Response) {
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
    /// Whether an item is selected.
    pub fn is_marked(&self, editor: &Editor, item: Item) -> bool {
        match item.kind {
            ItemKind::Object => self.marks.get(item.index) == Some(&true),
            ItemKind::Light | ItemKind::Pack => editor.selection().has(item),
        }
    }

    /// The row of what is selected, if it is listed: that of its group, if all of that is, or if the group is folded.
    pub fn row_of(&self, editor: &Editor) -> Option<usize> {
        let Some(item) = editor.selection().item() else {
            let mut singles = SINGLES.iter();
            return singles.position(|(single, ..)| single == editor.selection());
        };
        match editor.selection().group(editor.scene()) {
            Some(group) => self.row_of_group(group),
            None => self.row_of_item(editor.scene(), item),
        }
    }

    /// The row of an item, or of its group, if that is folded.
    fn row_of_item(&self, scene: &Scene, item: Item) -> Option<usize> {
        self.lines.row_of(item).or_else(|| {
            let object = scene.objects.get(item.index)?;
            self.row_of_group(&object.group)
        })
    }

    /// What is listed between two entries of a list, and they; of groups that are folded, all members.
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

    /// What selects what is in a row, if anything is.
    fn selects(&self, row: usize) -> Option<Selection> {
        Some(match self.lines.get(row)? {
            Line::Single(selection, ..) => selection.clone(),
            Line::Entry(item, _) => Selection::all([item]),
            Line::Group(index) => Selection::all(self.groups[index].items()),
            Line::Title(..) => return None,
        })
    }

    /// Whether what is in a row is what is selected.
    fn is_selected(&self, editor: &Editor, row: usize) -> bool {
        self.selects(row).as_ref() == Some(editor.selection())
    }
}
