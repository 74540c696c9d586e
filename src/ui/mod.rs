//! The window: egui panels that read the editor's state and push actions. One file per panel;
//! `theme.rs` has every colour and spacing, `commands.rs` every key.

mod app;
mod autosave;
mod commands;
mod dialogs;
mod exports;
mod files;
mod flying;
mod help;
mod icons;
mod inspector;
mod lab;
mod menu;
mod outliner;
mod pictures;
mod prompts;
mod raster;
mod rows;
mod run;
mod screenshot;
mod status;
mod theme;
mod timeline;
mod toasts;
mod upload;
mod viewport;
mod window;

pub use app::{App, Setup};
pub use commands::{Command, FLIGHT, SHORTCUTS};
pub use dialogs::{Ask, Dialogs};
pub use lab::{chart_picture, stability_picture};
pub use window::{NoWindow, run};

use crate::editor::{Action, Edit, Selection, Time};
use crate::worker::Question;

/// What panels ask for while they are drawn; done when all of them are.
#[derive(Debug, Default)]
struct UiRequests {
    actions: Vec<Action>,
    commands: Vec<commands::Command>,
    /// What takes rays to answer.
    questions: Vec<Question>,
}

impl UiRequests {
    fn edit(&mut self, edit: Edit) {
        self.actions.push(Action::Edit(edit));
    }

    fn time(&mut self, time: Time) {
        self.actions.push(Action::Time(time));
    }

    fn select(&mut self, selection: Selection) {
        self.actions.push(Action::Select(selection));
    }
}
