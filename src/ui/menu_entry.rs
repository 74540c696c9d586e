//! Widgets that request a command: menu entries, those that several menus share, and others.

use egui::{Button, Color32, Response, Role, Ui, WidgetInfo};

use super::commands::{Command, first_key, with_key};
use super::hint::Hinted as _;
use super::icons;
use super::obstacles::obstacle;
use super::requests::UiRequests;
use crate::editor::Editor;
use crate::words::capitalised;

/// The commands for selected items, with their names.
pub const ITEM_COMMANDS: [(&str, Command); 14] = [
    ("Cut", Command::Cut),
    ("Copy", Command::Copy),
    ("Hide or show", Command::ToggleVisible),
    ("Rename", Command::Rename),
    ("Select all with this pack", Command::SelectSamePack),
    ("Group", Command::Group),
    ("Ungroup", Command::Ungroup),
    ("Duplicate", Command::Duplicate),
    ("Put down", Command::PutDown),
    ("Join", Command::Join),
    ("Separate", Command::Separate),
    ("Move up in the list", Command::MoveUp),
    ("Move down in the list", Command::MoveDown),
    ("Delete", Command::Delete),
];

/// Adds a menu entry with its key.
pub fn entry(ui: &mut Ui, text: &str, command: Command, out: &mut UiRequests) {
    add(ui, (text, None), command, out);
}

/// Adds a menu entry that is enabled only if the command would do something now.
pub fn offer(ui: &mut Ui, editor: &Editor, text: &str, command: Command, out: &mut UiRequests) {
    let obstacle = obstacle(&command, editor);
    add(ui, (text, obstacle), command, out);
}

fn add(
    ui: &mut Ui,
    (text, obstacle): (&str, Option<&str>),
    command: Command,
    out: &mut UiRequests,
) {
    let key = first_key(ui, &command).unwrap_or_default();
    let button = Button::new(text).shortcut_text(key);
    let entry = ui.add_enabled(obstacle.is_none(), button);
    let entry = entry.accessible_name(text);
    let entry = match obstacle {
        Some(why) => entry.on_disabled_hover_text(capitalised(why)),
        None => entry,
    };
    if entry.clicked() {
        out.commands.push(command);
    }
}

/// Explains a widget with these words and the key of a command, which a click on the widget requests.
pub fn on_click(
    ui: &Ui,
    widget: Response,
    (words, command): (&str, Command),
    out: &mut UiRequests,
) {
    if widget.hint(with_key(ui, words, &command)).clicked() {
        out.commands.push(command);
    }
}

/// Adds a menu entry with its key that can be on or off, with a tick in front if it is on.
pub fn ticked(ui: &mut Ui, is_on: bool, text: &str, command: Command, out: &mut UiRequests) {
    let key = first_key(ui, &command).unwrap_or_default();
    let tick = icons::text(icons::CHECK);
    let tick = if is_on {
        tick
    } else {
        tick.color(Color32::TRANSPARENT)
    };
    let button = Button::new((tick, text)).shortcut_text(key);
    let entry = ui.add(button).accessible_name(text);
    let role = Role::CheckBox;
    entry.widget_info(|| WidgetInfo::selected(role, true, is_on, text));
    if entry.clicked() {
        out.commands.push(command);
    }
}
