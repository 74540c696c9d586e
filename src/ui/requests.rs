//! What panels ask for.

use super::commands::Command;
use crate::editor::{Action, Edit, Selection, Time};
use crate::worker::Question;

/// What panels ask for while they are drawn; done when all of them are.
#[derive(Debug, Default)]
pub struct UiRequests {
    /// Changes of the document.
    pub actions: Vec<Action>,
    /// What keys and menus do.
    pub commands: Vec<Command>,
    /// What takes rays to answer.
    pub questions: Vec<Question>,
}

impl UiRequests {
    /// Asks for a change of the scene.
    pub fn edit(&mut self, edit: Edit) {
        self.actions.push(Action::Edit(edit));
    }

    /// Asks something of the timeline.
    pub fn time(&mut self, time: Time) {
        self.actions.push(Action::Time(time));
    }

    /// Asks for something to be shown in the inspector.
    pub fn select(&mut self, selection: impl Into<Selection>) {
        self.actions.push(Action::Select(selection.into()));
    }
}
