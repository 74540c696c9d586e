//! Requests that panels make.

use super::commands::Command;
use crate::editor::{Action, Edit, Selection, Time};
use crate::worker::Question;

/// Requests made while the panels are drawn, and carried out once all of them are.
#[derive(Debug, Default)]
pub struct UiRequests {
    /// Actions of the editor.
    pub actions: Vec<Action>,
    /// Commands from keys and menus.
    pub commands: Vec<Command>,
    /// Questions that take rays to answer.
    pub questions: Vec<Question>,
}

impl UiRequests {
    /// Requests a change of the scene.
    pub fn edit(&mut self, edit: Edit) {
        self.actions.push(Action::Edit(edit));
    }

    /// Requests an action of the timeline.
    pub fn time(&mut self, time: Time) {
        self.actions.push(Action::Time(time));
    }

    /// Requests a selection, which the inspector then shows.
    pub fn select(&mut self, selection: impl Into<Selection>) {
        self.actions.push(Action::Select(selection.into()));
    }
}
