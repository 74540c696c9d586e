//! The arrow keys in the list: from row to row, and not from button to button.

use egui::{EventFilter, Key, Response, Ui};

use super::lines::{Group, Line, Lines, SINGLES};
use crate::editor::{Action, Editor, Item, Selected, Selection};
use crate::ui::requests::UiRequests;

/// What has the arrow keys.
#[derive(Debug, Default)]
pub struct Walk {
    /// Whether they are meant for the list: the pointer is over it, and nothing else has the focus.
    is_over: bool,
    /// The row that has the focus.
    focused: Option<usize>,
    /// The row that was walked to, and what was selected there.
    at: Option<(usize, Selection)>,
    /// The row that the focus goes to.
    goal: Option<usize>,
}

impl Walk {
    /// Whether they are meant for the list, and for nothing else.
    pub fn has_keys(&self, ui: &Ui) -> bool {
        let is_down = |key: Key| ui.input(|input| input.key_down(key));
        self.is_over && (is_down(Key::ArrowUp) || is_down(Key::ArrowDown))
    }

    /// Selects what is in the next row above or below, if a key says so.
    pub fn step(
        &mut self,
        ui: &Ui,
        editor: &Editor,
        (lines, groups): (&Lines, &[Group]),
        out: &mut UiRequests,
    ) {
        let is_free = ui.memory(|memory| memory.focused().is_none());
        self.is_over = is_free && ui.rect_contains_pointer(ui.max_rect());
        self.goal = None;
        let focused = self.focused.take();
        if !self.is_over && focused.is_none() {
            return;
        }
        let is_pressed =
            |key: Key| ui.input(|input| input.modifiers.is_none() && input.key_pressed(key));
        let is_down = is_pressed(Key::ArrowDown);
        if !is_down && !is_pressed(Key::ArrowUp) {
            return;
        }
        let selection = editor.selection;
        let walked = self.at.filter(|(_, selected)| *selected == selection);
        let walked = walked.map(|(row, _)| row);
        let from = focused.or(walked).or_else(|| row_of(selection, lines));
        let mut rows: Box<dyn Iterator<Item = usize>> = match (from, is_down) {
            (None, _) => Box::new(0..lines.len()),
            (Some(row), true) => Box::new(row + 1..lines.len()),
            (Some(row), false) => Box::new((0..row).rev()),
        };
        let next = rows.find_map(|row| Some((row, action(&lines.get(row)?, groups)?)));
        if let Some((row, action)) = next {
            let selection = match &action {
                Action::Select(selection) => *selection,
                Action::SelectItems(items) => items
                    .items()
                    .last()
                    .map_or(selection, |item| Selection::Item(*item)),
                _ => selection,
            };
            self.at = Some((row, selection));
            self.goal = focused.map(|_| row);
            out.actions.push(action);
        }
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

/// The row of what is selected, if it is listed.
fn row_of(selection: Selection, lines: &Lines) -> Option<usize> {
    match selection {
        Selection::Item(item) => lines.row_of(item),
        other => SINGLES.iter().position(|(single, ..)| *single == other),
    }
}

/// What selects what is in a line, if anything is.
fn action(line: &Line, groups: &[Group]) -> Option<Action> {
    Some(match line {
        Line::Single(selection, ..) => Action::Select(*selection),
        Line::Entry(item, _) => Action::SelectItems(Selected::all([*item])),
        Line::Group(place) => {
            let members = groups[*place].members.iter();
            Action::SelectItems(Selected::all(members.map(|index| Item::object(*index))))
        }
        Line::Kind(..) => return None,
    })
}
