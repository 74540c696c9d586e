//! Questions over the window: about unsaved changes, about quitting, and for a path if the desktop offers no dialog.

use std::ops::Range;
use std::path::{Path, PathBuf};

use egui::text::{CCursor, CCursorRange};
use egui::{
    Button, Context, Event, Frame, Id, InputState, Key, Modal, Response, RichText, TextEdit, Ui,
};

use super::commands::Next;
use super::dialogs::Ask;
use super::theme::{GRID, palette};
use crate::files::make_folder;
use crate::words::shortened;

/// Characters of a path that a message has room for.
const MAX_PATH: usize = 200;

/// The answer of the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reply {
    /// No answer yet.
    Open,
    /// The primary button.
    Yes,
    /// The other way to proceed.
    No,
    /// A third way to proceed.
    Other,
    /// Not to proceed.
    Cancel,
}

/// Asks whether to save unsaved changes before what comes next; `exports` describes exports that quitting would
/// interrupt.
pub fn ask_about_changes(ctx: &Context, title: &str, next: &Next, exports: Option<&str>) -> Reply {
    let next = match next {
        Next::New | Next::Example(_) => "starting another scene",
        Next::Choose | Next::Open(_) => "opening another scene",
        Next::Quit | Next::QuitAnyway => "quitting",
    };
    let dialog = ("unsaved changes", 380.0, Reply::Yes);
    question(ctx, dialog, |ui, answer| {
        ui.heading(format!("Save changes to {title} before {next}?"));
        ui.add_space(GRID);
        ui.label("Without saving, the changes since the last save are lost.");
        show_running_exports(ui, exports);
        ui.add_space(2.0 * GRID);
        ui.horizontal(|ui| {
            reply_on(&primary_button(ui, "Save changes"), Reply::Yes, answer);
            reply_on(&ui.button("Don't save"), Reply::No, answer);
            reply_on(&ui.button("Keep editing"), Reply::Cancel, answer);
        });
    })
}

/// Asks whether to quit; `exports` describes exports that are still running.
pub fn ask_to_quit(ctx: &Context, exports: Option<&str>) -> Reply {
    let (width, heading) = match exports {
        Some(_) => (380.0, "Quit while exporting?"),
        None => (160.0, "Quit Glint?"),
    };
    // Esc, which is often pressed in passing, leads here too, so Enter must not end the session.
    question(ctx, ("quit", width, Reply::Cancel), |ui, answer| {
        ui.heading(heading);
        show_running_exports(ui, exports);
        ui.add_space(2.0 * GRID);
        ui.horizontal(|ui| {
            reply_on(&primary_button(ui, "Stay"), Reply::Cancel, answer);
            reply_on(&ui.button("Quit now"), Reply::Yes, answer);
        });
    })
}

fn show_running_exports(ui: &mut Ui, exports: Option<&str>) {
    if let Some(exports) = exports {
        ui.add_space(GRID);
        ui.label(format!(
            "Not finished: {exports}. Finished frames are kept; Export animation can resume it next time."
        ));
    }
}

/// Returns the path that a user typed, in which `~` is the home folder.
pub fn typed_path(text: &str) -> PathBuf {
    let text = text.trim();
    match (text.strip_prefix('~'), std::env::home_dir()) {
        (Some(""), Some(home)) => home,
        (Some(rest), Some(home)) if rest.starts_with('/') => {
            home.join(rest.trim_start_matches('/'))
        }
        _ => PathBuf::from(text),
    }
}

/// A prompt for a path.
pub struct PathPrompt {
    ask: Ask,
    label: &'static str,
    text: String,
    needs_focus: bool,
    /// File about whose replacement the user was asked.
    asked_file: Option<PathBuf>,
    /// Why a folder could not be created.
    problem: Option<String>,
    /// Why the operation failed with this path.
    refused: Option<String>,
}

impl PathPrompt {
    /// Creates a prompt with a suggested path and a label above the field.
    pub fn new(ask: Ask, suggested: &Path, label: &'static str) -> Self {
        Self {
            ask,
            label,
            text: suggested.display().to_string(),
            needs_focus: true,
            asked_file: None,
            problem: None,
            refused: None,
        }
    }

    /// Notes why the operation failed with the typed path, and lets the user type its name again.
    pub fn refuse(&mut self, why: String) {
        (self.refused, self.needs_focus) = (Some(why), true);
    }

    /// The typed path, with `~` expanded and a missing ending added.
    pub fn path(&self) -> PathBuf {
        self.ask.with_ending(self.typed())
    }

    /// The typed path without an ending added.
    fn typed(&self) -> PathBuf {
        typed_path(&self.text)
    }

    /// Draws the prompt.
    pub fn show(&mut self, ctx: &Context) -> Reply {
        question(ctx, ("path prompt", 480.0, Reply::Open), |ui, answer| {
            ui.heading(self.ask.title());
            ui.add_space(GRID);
            let label = ui.weak(self.label);
            let field = TextEdit::singleline(&mut self.text)
                .desired_width(f32::INFINITY)
                .align(egui::Align2::LEFT_CENTER);
            let field = ui.add(field).labelled_by(label.id);
            if field.changed() {
                (self.problem, self.refused) = (None, None);
            }
            if self.needs_focus {
                field.request_focus();
                select_letters(ui, field.id, stem(&self.text));
                self.needs_focus = false;
            }
            let warning = self.warning();
            let is_possible = warning.as_ref().is_none_or(|warning| warning.is_possible);
            let words = warning.map_or(String::new(), |warning| warning.words);
            // The caret below a quoted line must keep its column.
            let (sentence, excerpt) = words.split_once('\n').unwrap_or((&words, ""));
            let accent = palette(ui.ctx()).accent;
            ui.colored_label(accent, sentence);
            if !excerpt.is_empty() {
                ui.label(RichText::new(excerpt).monospace().color(accent));
            }
            ui.add_space(GRID);
            ui.horizontal(|ui| {
                let entered = field.lost_focus() && ui.input(is_entered);
                let can_accept = is_possible && !self.text.trim().is_empty();
                let button = ui
                    .add_enabled_ui(can_accept, |ui| primary_button(ui, self.button_text()))
                    .inner;
                let is_accepted = can_accept && (button.clicked() || entered);
                if is_accepted && (!self.would_replace() || self.is_asked()) {
                    *answer = Reply::Yes;
                } else if is_accepted {
                    // A fast typist has not read yet that such a file exists.
                    self.asked_file = Some(self.path());
                }
                if *answer == Reply::Open && entered {
                    // The field keeps the focus, so that the text can be corrected.
                    field.request_focus();
                }
                if let Some(folder) = self.missing_folder()
                    && ui.button("Create folder").clicked()
                {
                    let made = make_folder(&folder);
                    self.problem = made
                        .err()
                        .map(|error| format!("{}: {error}", folder.display()));
                }
                reply_on(&ui.button("Cancel"), Reply::Cancel, answer);
            });
        })
    }

    /// Returns the text of the primary button.
    fn button_text(&self) -> &'static str {
        if self.ask == Ask::ExportFolder {
            "Use folder"
        } else if !self.ask.writes() {
            "Open file"
        } else if self.is_asked() {
            "Replace it"
        } else {
            "Save file"
        }
    }

    /// Whether an existing file would be replaced.
    fn would_replace(&self) -> bool {
        self.ask.writes() && self.path().is_file()
    }

    /// Whether the user was asked about replacing this file.
    fn is_asked(&self) -> bool {
        self.asked_file.as_ref() == Some(&self.path())
    }

    /// Returns the folder of a file to be written, if it does not exist and can be created.
    fn missing_folder(&self) -> Option<PathBuf> {
        let path = self.path();
        let folder = path.parent().filter(|_| self.ask.writes())?;
        let exists = folder.as_os_str().is_empty() || folder.is_dir();
        (!exists && self.file_in_the_way().is_none()).then(|| folder.to_owned())
    }

    /// Returns a file that is in the place of a folder of the path.
    fn file_in_the_way(&self) -> Option<PathBuf> {
        let path = self.path();
        let folders = path.ancestors().skip(1);
        let existing = folders
            .filter(|_| self.ask.writes())
            .find(|folder| folder.exists())?;
        (!existing.is_dir()).then(|| existing.to_owned())
    }

    fn warning(&self) -> Option<Warning> {
        let path = self.path();
        let warning = |words, is_possible| Some(Warning { words, is_possible });
        let impossible = |words: String| warning(words, false);
        if let Some(words) = self.problem.clone() {
            return impossible(words);
        }
        if let Some(words) = self.refused.clone() {
            // The operation may succeed now.
            return warning(words, true);
        }
        if let Some(file) = self.file_in_the_way() {
            return impossible(format!("{} is a file, not a folder", file.display()));
        }
        if let Some(folder) = self.missing_folder() {
            return impossible(format!("There is no folder {}", folder.display()));
        }
        if !self.ask.accepts(&path) {
            let endings = self.ask.endings().join(", .");
            return impossible(format!(
                "The file name must end in one of these: .{endings}"
            ));
        }
        let takes_folder = self.ask == Ask::ExportFolder;
        let ends_with_separator = self.text.trim().ends_with(std::path::is_separator);
        if !takes_folder && (ends_with_separator || self.typed().is_dir() || path.is_dir()) {
            // The file name may not be typed yet.
            let words = if ends_with_separator {
                ""
            } else {
                "This is a folder"
            };
            return impossible(words.to_owned());
        }
        if self.would_replace() {
            let words = if self.is_asked() {
                format!("{} already exists. Replace it?", path.display())
            } else {
                format!("Replaces {}", path.display())
            };
            return warning(words, true);
        }
        if !self.ask.writes() && !takes_folder && !path.is_file() {
            let path = shortened(&path.to_string_lossy(), MAX_PATH);
            return impossible(format!("There is no file {path}"));
        }
        None
    }
}

/// A remark about a path.
struct Warning {
    words: String,
    /// Whether the path can be used nevertheless.
    is_possible: bool,
}

/// Returns whether Enter was pressed in this frame, not counting repeats of a held key.
fn is_entered(input: &InputState) -> bool {
    let is_enter = |event: &Event| {
        matches!(
            event,
            Event::Key {
                key: Key::Enter,
                pressed: true,
                repeat: false,
                ..
            }
        )
    };
    input.events.iter().any(is_enter)
}

/// Returns the characters of a path that are the file's name without its ending, which typing is to replace.
fn stem(path: &str) -> Range<usize> {
    let name = path.rsplit(std::path::is_separator).next().unwrap_or(path);
    let stem = Path::new(name).file_stem().unwrap_or_default();
    let length = |text: &str| text.chars().count();
    let start = length(path) - length(name);
    start..start + length(&stem.to_string_lossy())
}

/// Selects characters of a text field, whose stored cursor may be from another text.
pub fn select_letters(ui: &Ui, field: Id, characters: Range<usize>) {
    let mut state = TextEdit::load_state(ui.ctx(), field).unwrap_or_default();
    let [start, end] = [characters.start, characters.end].map(CCursor::new);
    let range = CCursorRange::two(start, end);
    state.cursor.set_char_range(Some(range));
    state.store(ui.ctx(), field);
}

/// Shows a question over the window, with a name, a width and the reply that Enter gives. Escape gives
/// [`Reply::Cancel`].
pub fn question(
    ctx: &Context,
    (name, width, on_enter): (&str, f32, Reply),
    add: impl FnOnce(&mut Ui, &mut Reply),
) -> Reply {
    let mut answer = Reply::Open;
    let (id, now) = (Id::unique(name).with("asked"), ctx.cumulative_frame_nr());
    let last_shown = ctx.data_mut(|data| {
        let last = data.get_temp::<u64>(id);
        data.insert_temp(id, now);
        last
    });
    let frame = Frame::popup(&ctx.global_style()).inner_margin(2.0 * GRID);
    let modal = Modal::new(Id::unique(name)).frame(frame).show(ctx, |ui| {
        ui.set_width(width);
        add(ui, &mut answer);
    });
    // An accidental click beside it is no answer: typed text would be lost, and further typing would go elsewhere.
    if answer == Reply::Open && modal.should_close() && !modal.backdrop_response.clicked() {
        answer = Reply::Cancel;
    }
    // The key press that opened the question must not answer it.
    let was_shown = last_shown.is_some_and(|last| last + 1 == now);
    if answer == Reply::Open && was_shown && ctx.input(|input| input.key_pressed(Key::Enter)) {
        answer = on_enter;
    }
    answer
}

/// Gives this reply if a button is clicked.
pub fn reply_on(button: &Response, reply: Reply, answer: &mut Reply) {
    if button.clicked() {
        *answer = reply;
    }
}

/// Shows the primary button.
pub fn primary_button(ui: &mut Ui, text: &str) -> Response {
    let colors = palette(ui.ctx());
    ui.add(Button::new(RichText::new(text).color(colors.on_accent)).fill(colors.accent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilde_is_the_home_folder() {
        let home = std::env::home_dir().expect("a home");
        assert_eq!(typed_path(" ~/frames "), home.join("frames"));
        assert_eq!(typed_path("~"), home);
        assert_eq!(typed_path("~other/a"), PathBuf::from("~other/a"));
    }

    #[test]
    fn the_stem_of_a_path_is_its_name_without_folder_and_ending() {
        let found = |path: &str| -> String {
            let letters = stem(path);
            path.chars()
                .skip(letters.start)
                .take(letters.len())
                .collect()
        };
        for (path, expected) in [
            ("/tmp/scénes/démo.ron", "démo"),
            ("demo.ron", "demo"),
            ("a.b/frames", "frames"),
            ("/tmp/frames/", ""),
            ("", ""),
        ] {
            assert_eq!(found(path), expected, "{path}");
        }
    }
}
