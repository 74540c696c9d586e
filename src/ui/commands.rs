//! The commands that the user can give, and the single table of keys that both drives the window and fills
//! Help → Shortcuts.

use std::path::PathBuf;

use egui::text_selection::LabelSelectionState;
use egui::{Context, Event, Key, KeyboardShortcut, Modifiers, Theme, Ui};
use glam::DVec3;

use super::dialogs::Ask;
use super::layout::WindowPart;
use crate::animate::{Preset, Retime};
use crate::scene::{Aspect, Projection};

/// Something the user asks of the window as a whole.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// Leave the document after asking about unsaved changes, then do this.
    Leave(Next),
    /// Ask for a file or a folder for this purpose.
    Ask(Ask),
    /// Write the document to its file.
    Save,
    /// Undo the last step.
    Undo,
    /// Redo the step undone last.
    Redo,
    /// Copy the selected items to the clipboard, as text.
    Copy,
    /// Copy the selected items to the clipboard and delete them.
    Cut,
    /// Ask the desktop for the contents of the clipboard.
    RequestPaste,
    /// Add what this text from the clipboard describes.
    Paste(String),
    /// Select all objects and lights, or all keys if the pointer is over the timeline.
    SelectAll,
    /// Select all objects with the same color pack as the selected one.
    SelectSamePack,
    /// Make a group of the selected objects.
    Group,
    /// Take the selected objects out of their groups.
    Ungroup,
    /// Keep only one of any color packs that are equal.
    MergePacks,
    /// Save this view as a bookmark.
    AddBookmark,
    /// Go to the bookmark at this index.
    GoToBookmark(usize),
    /// Copy what is selected, next to the original.
    Duplicate,
    /// Delete what is selected: items or keys.
    Delete,
    /// Edit the name of the selected item or group.
    Rename,
    /// Move the selected item up in its list.
    MoveUp,
    /// Move the selected item down in its list.
    MoveDown,
    /// Show the live view.
    Live,
    /// Show the live view at 64 pixels.
    LowRes,
    /// Show the still picture.
    HighRes,
    /// Show the still picture with one screen pixel for each of its pixels, or all of it again.
    ActualSize,
    /// Abort the still picture.
    CancelStill,
    /// Switch to this projection.
    Projection(Projection),
    /// Show the markers of lights if true, else hide them.
    Markers(bool),
    /// Leave the innermost mode or window, or deselect; with nothing left to leave, pressing it twice asks to quit.
    Escape,
    /// Play or pause.
    Play,
    /// Move the playhead to the first frame.
    FirstFrame,
    /// Move the playhead to the last frame.
    LastFrame,
    /// Move the playhead one frame back.
    FrameBack,
    /// Move the playhead one frame on.
    FrameOn,
    /// Move the playhead to the previous key.
    PreviousKey,
    /// Move the playhead to the next key.
    NextKey,
    /// Start to record a flight.
    Record,
    /// Stop recording and turn the flight into keys.
    StopRecording,
    /// Set a key at the playhead.
    AddKey,
    /// Select all keys, of the camera and of values.
    SelectKeys,
    /// Look through the shot camera, or at it.
    LookThrough,
    /// Put what is selected down on what is below it.
    PutDown,
    /// Join the selected triangles and meshes, or a triangle and all connected to it by shared corners, to one mesh.
    Join,
    /// Replace the selected mesh by separate triangles.
    Separate,
    /// Replace the keys of the camera by a ready-made flight around or towards what is selected.
    Preset(Preset),
    /// Change the timing of the flight.
    Retime(Retime),
    /// Open or close the window of exports.
    Export,
    /// Move the camera so that everything that is selected is in the picture.
    FrameSelected,
    /// Move the camera so that everything is in the picture.
    FrameAll,
    /// Look along -z.
    ViewFront,
    /// Look along -x.
    ViewRight,
    /// Look down.
    ViewTop,
    /// Choose which part of the light the live view shows.
    Aspect(Aspect),
    /// Show or hide this part of the window.
    Part(WindowPart),
    /// Show or hide the timeline.
    Timeline,
    /// Show or hide the lab.
    Lab,
    /// Hide all panels, or show them again.
    PictureAlone,
    /// Switch to the dark or the light theme.
    Theme(Theme),
    /// Make letters and buttons larger or smaller.
    Zoom(Zoom),
    /// Explain the colour that a ray sees: its origin and its direction.
    Why(DVec3, DVec3),
    /// Hide or show what is selected.
    ToggleVisible,
    /// Find a command or a thing by its name.
    Find,
    /// Show or hide the list of shortcuts.
    Shortcuts,
}

/// A change of the size of letters and buttons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zoom {
    /// A tenth larger.
    In,
    /// A tenth smaller.
    Out,
    /// The desktop's size.
    Default,
}

/// What follows once unsaved changes are saved or discarded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Start an empty document.
    New,
    /// Start from the example at this index of [`crate::scene::EXAMPLES`].
    Example(usize),
    /// Choose a file and open it.
    Choose,
    /// Open this file.
    Open(PathBuf),
    /// Close the window, after asking about running exports.
    Quit,
    /// Close the window, even if exports are running.
    QuitAnyway,
}

/// A command, its keys and its description.
#[derive(Clone, Debug)]
pub struct Shortcut {
    /// The command.
    pub command: Command,
    /// Its key, and for some commands a second one.
    pub keys: &'static [KeyboardShortcut],
    /// Description in Help.
    pub what: &'static str,
}

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

const fn alt(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::ALT, key)
}

macro_rules! keys {
    ($($command:ident $(($with:expr))? [$($key:expr),+] $what:literal,)*) => {
        &[$(Shortcut { command: Command::$command $(($with))?, keys: &[$($key),+], what: $what }),*]
    };
}

/// All keys of commands. Of two keys that differ only in modifiers, the one with more modifiers comes first.
pub const SHORTCUTS: &[Shortcut] = keys! {
    HighRes [plain(Key::H)] "High-res picture",
    Lab [ctrl(Key::L)] "Show or hide the lab",
    LowRes [plain(Key::L)] "Low-res live view (64 pixels)",
    Projection(Projection::Orthographic) [plain(Key::O), plain(Key::Num0)] "Orthographic projection",
    Projection(Projection::Perspective) [plain(Key::P)] "Perspective projection",
    Markers(false) [plain(Key::U)] "Hide light markers",
    Markers(true) [plain(Key::I), plain(Key::Num1)] "Show light markers",
    FrameSelected [plain(Key::F)] "Frame selection",
    FrameAll [plain(Key::Home)] "Frame everything",
    ViewFront [ctrl(Key::Num1)] "View from the front",
    ViewRight [ctrl(Key::Num3)] "View from the right",
    ViewTop [ctrl(Key::Num7)] "View from above",
    Escape [plain(Key::Escape)] "Cancel, deselect, back to live, quit",
    Leave(Next::New) [ctrl(Key::N)] "New scene",
    Leave(Next::Choose) [ctrl(Key::O)] "Open a scene",
    Ask(Ask::SaveScene) [ctrl_shift(Key::S)] "Save under another name",
    Save [ctrl(Key::S)] "Save the scene",
    Export [ctrl_shift(Key::E)] "Export the animation",
    Ask(Ask::SaveImage) [ctrl(Key::E)] "Save the high-res picture",
    Leave(Next::Quit) [ctrl(Key::Q)] "Quit",
    Redo [ctrl_shift(Key::Z), ctrl(Key::Y)] "Redo",
    Undo [ctrl(Key::Z)] "Undo",
    Copy [ctrl(Key::C)] "Copy the selection as text",
    Cut [ctrl(Key::X)] "Cut the selection",
    RequestPaste [ctrl(Key::V)] "Paste objects and lights, also text written by hand",
    Ungroup [ctrl_shift(Key::G)] "Take the selection out of its group",
    Group [ctrl(Key::G)] "Group the selected objects",
    AddBookmark [ctrl(Key::B)] "Bookmark this view",
    Duplicate [ctrl(Key::D)] "Duplicate the selection",
    ToggleVisible [ctrl(Key::H)] "Hide or show the selection",
    Delete [plain(Key::Delete)] "Delete the selection",
    Rename [plain(Key::F2)] "Rename the selected item",
    MoveUp [alt(Key::ArrowUp)] "Move the selected item up",
    MoveDown [alt(Key::ArrowDown)] "Move the selected item down",
    Record [plain(Key::R)] "Record the flight",
    Timeline [ctrl(Key::T)] "Show or hide the timeline",
    StopRecording [plain(Key::T)] "Stop recording and make keys",
    Play [plain(Key::G)] "Play or pause",
    AddKey [plain(Key::K)] "Set a camera key at the playhead",
    SelectAll [ctrl(Key::A)] "Select all objects and lights; over the timeline, all keys",
    LookThrough [plain(Key::C)] "Enter or leave the shot camera",
    PreviousKey [plain(Key::OpenBracket)] "Previous key",
    NextKey [plain(Key::CloseBracket)] "Next key",
    FrameBack [plain(Key::Comma)] "One frame back",
    FrameOn [plain(Key::Period)] "One frame forward",
    FirstFrame [ctrl(Key::Home)] "First frame",
    LastFrame [ctrl(Key::End), plain(Key::End)] "Last frame",
    PictureAlone [plain(Key::F11)] "Hide or show everything but the picture",
    Zoom(Zoom::In) [ctrl(Key::Plus)] "Larger text and buttons",
    Zoom(Zoom::Out) [ctrl(Key::Minus)] "Smaller text and buttons",
    Zoom(Zoom::Default) [ctrl(Key::Num0)] "Default size of text and buttons",
    Find [ctrl(Key::K)] "Find a command or object by name",
    Shortcuts [plain(Key::F1)] "Show these shortcuts",
};

/// The commands without a key, with their descriptions.
pub const KEYLESS: &[(Command, &str)] = &[
    (Command::Live, "Live view"),
    (Command::SelectKeys, "Select all keys"),
    (Command::ActualSize, "High-res picture at actual size"),
    (Command::Ask(Ask::ImportMesh), "Import a mesh"),
    (
        Command::Ask(Ask::ExportJob),
        "Export a job for a render farm",
    ),
    (
        Command::Ask(Ask::ExportPovray),
        "Export the scene for POV-Ray",
    ),
    (Command::Ask(Ask::ImportPath), "Import a camera path"),
    (Command::Ask(Ask::ExportPath), "Export the camera path"),
    (
        Command::SelectSamePack,
        "Select all objects with the same color pack",
    ),
    (Command::MergePacks, "Merge equal color packs"),
    (Command::PutDown, "Drop the selection onto what is below it"),
    (Command::Join, "Join triangles into a mesh"),
    (Command::Separate, "Separate a mesh into triangles"),
    (Command::Theme(Theme::Dark), "Dark theme"),
    (Command::Theme(Theme::Light), "Light theme"),
];

/// Yields every command that needs no further choice, with its description and its first key.
pub fn all() -> impl Iterator<Item = (&'static Command, &'static str, Option<KeyboardShortcut>)> {
    let keyed = SHORTCUTS.iter();
    let keyed = keyed.map(|keyed| (&keyed.command, keyed.what, keyed.keys.first().copied()));
    let keyless = KEYLESS.iter();
    keyed.chain(keyless.map(|(command, what)| (command, *what, None)))
}

/// Returns the description of a command.
pub fn description_of(command: &Command) -> Option<&'static str> {
    all().find_map(|(other, what, _)| (other == command).then_some(what))
}

/// Returns whether text of a message is selected.
pub fn has_selected_text(ctx: &Context) -> bool {
    let selected = ctx.plugin_opt::<LabelSelectionState>();
    selected.is_some_and(|selected| selected.lock().has_selection())
}

/// Takes the keys of commands out of this frame's events and returns the commands. A key that repeats because it is
/// held counts only for undo and redo. While keys fly the camera, those with Ctrl do not count. Keys of commands that
/// `accepts` rejects stay in the events.
pub fn pressed(ui: &Ui, is_flying: bool, accepts: impl Fn(&Command) -> bool) -> Vec<Command> {
    let mut pressed = Vec::new();
    ui.input_mut(|input| {
        input.events.retain(|event| {
            // The desktop translates its own keys for these into events.
            let from_desktop = match event {
                Event::Copy => Some(Command::Copy),
                Event::Cut => Some(Command::Cut),
                Event::Paste(text) => Some(Command::Paste(text.clone())),
                _ => None,
            };
            let from_desktop = from_desktop.filter(|command| accepts(command) && !is_flying);
            if let Some(command) = from_desktop {
                // The event stays, because selected text of a message can be copied too.
                let is_copy = command == Command::Copy;
                pressed.push(command);
                return is_copy;
            }
            let Event::Key {
                key,
                pressed: true,
                repeat,
                modifiers,
                ..
            } = event
            else {
                return true;
            };
            let is_match = |keys: &KeyboardShortcut| {
                keys.logical_key == *key
                    && modifiers.matches_logically(keys.modifiers)
                    && modifiers.alt == keys.modifiers.alt
                    && !(is_flying && keys.modifiers.command)
            };
            let Some(shortcut) = SHORTCUTS
                .iter()
                .find(|shortcut| shortcut.keys.iter().any(is_match))
                .filter(|shortcut| accepts(&shortcut.command))
            else {
                return true;
            };
            if !repeat || matches!(shortcut.command, Command::Undo | Command::Redo) {
                pressed.push(shortcut.command.clone());
            }
            false
        });
    });
    pressed
}

/// Consumes Escape with any modifiers, so that it only cancels the drag; returns whether it was pressed.
pub fn take_escape(ui: &Ui) -> bool {
    ui.input_mut(|input| input.consume_key(input.modifiers, Key::Escape))
}

/// Returns the first key of a command, as menus show it.
pub fn first_key(ui: &Ui, command: &Command) -> Option<String> {
    let shortcut = SHORTCUTS
        .iter()
        .find(|shortcut| shortcut.command == *command)?;
    Some(key_name(ui, shortcut.keys[0]))
}

/// Returns the text of a button for a command, with its key.
pub fn with_key(ui: &Ui, words: &str, command: &Command) -> String {
    let key = first_key(ui, command);
    key.map_or_else(|| words.to_owned(), |key| format!("{words} ({key})"))
}

/// Whether the command is heard while a popup is open, which then stays open.
pub fn works_during_popups(command: &Command) -> bool {
    matches!(command, Command::Undo | Command::Redo | Command::Save)
}

/// Whether the command is heard while a text is edited, which ends the editing.
pub fn is_about_files(command: &Command) -> bool {
    use Command::{Ask, Export, Leave, Save};
    matches!(command, Ask(_) | Export | Leave(_) | Save)
}

/// Returns the name of a key with its modifiers, as it is printed on the key.
pub fn key_name(ui: &Ui, keys: KeyboardShortcut) -> String {
    let name = ui.format_shortcut(&keys);
    let printed = [
        ("OpenBracket", "["),
        ("CloseBracket", "]"),
        ("Comma", ","),
        ("Period", "."),
    ];
    printed
        .iter()
        .fold(name, |name, (word, sign)| name.replace(word, sign))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::flight_keys::FLIGHT;

    #[test]
    fn no_key_does_two_things() {
        let keys: Vec<KeyboardShortcut> = SHORTCUTS
            .iter()
            .flat_map(|s| s.keys.iter().copied())
            .collect();
        for (index, key) in keys.iter().enumerate() {
            assert!(!keys[..index].contains(key), "{key:?}");
        }
        for flight in FLIGHT.iter().filter_map(|flight| flight.key) {
            assert!(!keys.contains(&plain(flight)), "{flight:?}");
        }
    }

    #[test]
    fn keys_with_more_modifiers_come_first() {
        for (index, shortcut) in SHORTCUTS.iter().enumerate() {
            for earlier in SHORTCUTS[..index].iter().flat_map(|s| s.keys) {
                for key in shortcut
                    .keys
                    .iter()
                    .filter(|key| key.logical_key == earlier.logical_key)
                {
                    assert!(
                        !(key.modifiers.shift
                            && !earlier.modifiers.shift
                            && earlier.modifiers.command),
                        "{earlier:?} would swallow {key:?}"
                    );
                }
            }
        }
    }
}
