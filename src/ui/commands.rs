//! What the user can command, and the one table of keys that both drives the window and fills
//! Help → Shortcuts.

use std::path::PathBuf;

use egui::{Event, Key, KeyboardShortcut, Modifiers, Ui};

use crate::editor::{Editor, Motion};

/// Something the user asks of the window as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Command {
    /// Start an empty document.
    New,
    /// Open the demo scene.
    OpenDemo,
    /// Choose a file and open it.
    Open,
    /// Open this file.
    OpenRecent(PathBuf),
    /// Choose a mesh file and add it to the scene.
    ImportMesh,
    /// Write the document to its file.
    Save,
    /// Choose a file and write the document to it.
    SaveAs,
    /// Choose a file and write the still picture to it.
    SaveImage,
    /// Leave, asking about unsaved changes.
    Quit,
    /// Take the last step back.
    Undo,
    /// Bring the step taken back again.
    Redo,
    /// Copy the selected item.
    Duplicate,
    /// Delete the selected item.
    Delete,
    /// Edit the name of the selected item.
    Rename,
    /// Move the selected item up in its list.
    MoveUp,
    /// Move the selected item down in its list.
    MoveDown,
    /// The live view.
    Live,
    /// The live view at 64 pixels.
    LowRes,
    /// The still picture.
    HighRes,
    /// Give the still picture up.
    CancelStill,
    /// Perspective projection.
    Perspective,
    /// Orthographic projection.
    Orthographic,
    /// Show the markers of lights.
    MarkersOn,
    /// Hide the markers of lights.
    MarkersOff,
    /// Leave the current mode; in none, quit.
    Escape,
    /// Play or pause.
    Play,
    /// The playhead to the first frame.
    FirstFrame,
    /// The playhead to the last frame.
    LastFrame,
    /// The playhead one frame back.
    FrameBack,
    /// The playhead one frame on.
    FrameOn,
    /// The playhead to the key before it.
    PreviousKey,
    /// The playhead to the key after it.
    NextKey,
    /// Start to record the flight.
    Record,
    /// Stop recording and make keys.
    StopRecording,
    /// Set a key at the playhead.
    AddKey,
    /// Select all keys of the camera.
    SelectKeys,
    /// Look through the shot camera, or at it.
    LookThrough,
    /// Open the window of exports.
    Export,
    /// Choose a file and write a job for a render farm to it.
    ExportJob,
    /// Choose the folder of an export.
    ExportFolder,
    /// Choose a file and take keys from it.
    ImportPath,
    /// Choose a file and write the keys to it.
    ExportPath,
    /// Show or hide the timeline.
    Timeline,
    /// Show or hide the lab.
    Lab,
    /// Show or hide the list of shortcuts.
    Shortcuts,
}

/// A key, what it does and in which words.
#[derive(Clone, Debug)]
pub struct Shortcut {
    /// What it does.
    pub command: Command,
    /// The key, and a second one for some.
    pub keys: &'static [KeyboardShortcut],
    /// What Help says about it.
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
    ($($command:ident [$($key:expr),+] $what:literal,)*) => {
        &[$(Shortcut { command: Command::$command, keys: &[$($key),+], what: $what }),*]
    };
}

/// Every command key. Of two keys that differ in a modifier, the one with more comes first.
pub const SHORTCUTS: &[Shortcut] = keys! {
    HighRes [plain(Key::H)] "High-res picture",
    Lab [ctrl(Key::L)] "Show or hide the lab",
    LowRes [plain(Key::L)] "Low-res live view (64 pixels)",
    Orthographic [plain(Key::O), plain(Key::Num0)] "Orthographic projection",
    Perspective [plain(Key::P)] "Perspective projection",
    MarkersOff [plain(Key::U)] "Hide light markers",
    MarkersOn [plain(Key::I), plain(Key::Num1)] "Show light markers",
    Escape [plain(Key::Escape)] "Leave the current mode; then quit",
    New [ctrl(Key::N)] "New scene",
    Open [ctrl(Key::O)] "Open a scene",
    SaveAs [ctrl_shift(Key::S)] "Save under another name",
    Save [ctrl(Key::S)] "Save the scene",
    Export [ctrl_shift(Key::E)] "Export the animation",
    SaveImage [ctrl(Key::E)] "Save the high-res picture",
    Quit [ctrl(Key::Q)] "Quit",
    Redo [ctrl_shift(Key::Z), ctrl(Key::Y)] "Redo",
    Undo [ctrl(Key::Z)] "Undo",
    Duplicate [ctrl(Key::D)] "Duplicate the selected item",
    Delete [plain(Key::Delete)] "Delete the selected item",
    Rename [plain(Key::F2)] "Rename the selected item",
    MoveUp [alt(Key::ArrowUp)] "Move the selected item up",
    MoveDown [alt(Key::ArrowDown)] "Move the selected item down",
    Record [plain(Key::R)] "Record the flight",
    Timeline [ctrl(Key::T)] "Show or hide the timeline",
    StopRecording [plain(Key::T)] "Stop recording and make keys",
    Play [plain(Key::G)] "Play or pause",
    AddKey [plain(Key::K)] "Set a key at the playhead",
    SelectKeys [ctrl(Key::A)] "Select all keys",
    LookThrough [plain(Key::C)] "Look through the shot camera, or at it",
    PreviousKey [plain(Key::OpenBracket)] "Previous key",
    NextKey [plain(Key::CloseBracket)] "Next key",
    FrameBack [plain(Key::Comma)] "One frame back",
    FrameOn [plain(Key::Period)] "One frame on",
    FirstFrame [plain(Key::Home)] "First frame",
    LastFrame [plain(Key::End)] "Last frame",
    Shortcuts [plain(Key::F1)] "Show these shortcuts",
};

/// A key that flies the camera for as long as it is held.
#[derive(Clone, Copy, Debug)]
pub struct FlightKey {
    /// The key; `None` is the control key by itself.
    pub key: Option<Key>,
    /// Direction: 1 is the flying speed, or the turning speed.
    pub motion: Motion,
    /// What Help says about it.
    pub what: &'static str,
}

const STILL: Motion = Motion {
    forward: 0.0,
    right: 0.0,
    up: 0.0,
    yaw: 0.0,
    pitch: 0.0,
};

/// Every flight key.
pub const FLIGHT: &[FlightKey] = &[
    FlightKey {
        key: Some(Key::W),
        motion: Motion {
            forward: 1.0,
            ..STILL
        },
        what: "Fly forward",
    },
    FlightKey {
        key: Some(Key::S),
        motion: Motion {
            forward: -1.0,
            ..STILL
        },
        what: "Fly back",
    },
    FlightKey {
        key: Some(Key::A),
        motion: Motion {
            right: -1.0,
            ..STILL
        },
        what: "Fly left",
    },
    FlightKey {
        key: Some(Key::D),
        motion: Motion {
            right: 1.0,
            ..STILL
        },
        what: "Fly right",
    },
    FlightKey {
        key: Some(Key::Space),
        motion: Motion { up: 1.0, ..STILL },
        what: "Fly up",
    },
    FlightKey {
        key: None,
        motion: Motion { up: -1.0, ..STILL },
        what: "Fly down",
    },
    FlightKey {
        key: Some(Key::ArrowLeft),
        motion: Motion { yaw: -1.0, ..STILL },
        what: "Turn left",
    },
    FlightKey {
        key: Some(Key::ArrowRight),
        motion: Motion { yaw: 1.0, ..STILL },
        what: "Turn right",
    },
    FlightKey {
        key: Some(Key::ArrowUp),
        motion: Motion {
            pitch: 1.0,
            ..STILL
        },
        what: "Look up",
    },
    FlightKey {
        key: Some(Key::ArrowDown),
        motion: Motion {
            pitch: -1.0,
            ..STILL
        },
        what: "Look down",
    },
];

/// What the mouse does in the picture.
pub const MOUSE: &[(&str, &str)] = &[
    ("Right button, drag", "Look around"),
    ("Wheel", "Fly forward and back"),
    ("Shift, held", "Fly four times as fast"),
    ("Left button, on a key", "Move the key"),
];

impl FlightKey {
    /// The key in words.
    pub fn name(&self) -> &'static str {
        self.key.map_or("Left Ctrl", Key::name)
    }
}

/// The commands whose keys were pressed in this frame. A key that repeats because it is held
/// commands nothing more, but undo and redo; while keys fly the camera, none with Ctrl counts. Keys
/// of commands that are not heard stay for others.
pub fn pressed(ui: &Ui, is_flying: bool, is_heard: impl Fn(&Command) -> bool) -> Vec<Command> {
    let mut pressed = Vec::new();
    ui.input_mut(|input| {
        input.events.retain(|event| {
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
            let is_meant = |keys: &KeyboardShortcut| {
                keys.logical_key == *key
                    && modifiers.matches_logically(keys.modifiers)
                    && !(is_flying && keys.modifiers.command)
            };
            let Some(shortcut) = SHORTCUTS
                .iter()
                .find(|shortcut| shortcut.keys.iter().any(is_meant))
                .filter(|shortcut| is_heard(&shortcut.command))
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

/// The first key of a command, as menus show it.
pub fn key_of(ui: &Ui, command: &Command) -> Option<String> {
    let shortcut = SHORTCUTS
        .iter()
        .find(|shortcut| shortcut.command == *command)?;
    Some(name_of(ui, shortcut.keys[0]))
}

/// Whether the command is heard while a text is edited, which then ends.
pub fn is_about_files(command: &Command) -> bool {
    use Command::{New, Open, Quit, Save, SaveAs, SaveImage};
    matches!(command, New | Open | Quit | Save | SaveAs | SaveImage)
}

/// A key as it is printed on it.
pub fn name_of(ui: &Ui, keys: KeyboardShortcut) -> String {
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

/// Whether the command would do anything now.
pub fn is_enabled(command: &Command, editor: &Editor) -> bool {
    use crate::editor::Selection;
    match command {
        Command::Undo => editor.undo_label().is_some(),
        Command::Redo => editor.redo_label().is_some(),
        Command::Delete => matches!(editor.selection, Selection::Item(_) | Selection::Keys),
        Command::Duplicate | Command::Rename | Command::MoveUp | Command::MoveDown => {
            matches!(editor.selection, Selection::Item(_))
        }
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
