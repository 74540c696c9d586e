//! An entry of a menu, and those that several menus have.

use egui::{Button, Ui};

use super::commands::{Command, key_of};
use super::requests::UiRequests;

/// What can be done to the selected item.
pub const ITEM_COMMANDS: [(&str, Command); 9] = [
    ("Cut", Command::Cut),
    ("Copy", Command::Copy),
    ("Hide or show", Command::ToggleVisible),
    ("Rename", Command::Rename),
    ("Select all with this pack", Command::SelectSamePack),
    ("Duplicate", Command::Duplicate),
    ("Move up", Command::MoveUp),
    ("Move down", Command::MoveDown),
    ("Delete", Command::Delete),
];

/// A menu entry with its key.
pub fn entry(ui: &mut Ui, text: &str, command: Command, enabled: bool, out: &mut UiRequests) {
    let key = key_of(ui, &command).unwrap_or_default();
    let button = Button::new(text).shortcut_text(key);
    if ui
        .add_enabled(enabled, button)
        .accessible_name(text)
        .clicked()
    {
        out.commands.push(command);
    }
}
