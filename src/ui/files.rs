//! Opening and saving, from the wish to the file: dialogs, the prompt for a path, and the question
//! about unsaved changes.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::{Duration, Instant};

use egui::{Button, Context, Id, Key, Modal, RichText, TextEdit, Ui};

use super::dialogs::{Ask, Dialogs};
use super::theme::{GRID, palette};
use crate::editor::Editor;

/// A dialog that comes back empty sooner than a hand can cancel it was never shown.
const NO_DIALOG: Duration = Duration::from_millis(400);
/// Files that "Open recent" remembers.
const RECENT: usize = 10;

/// What is done once unsaved changes are out of the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Start an empty document.
    New,
    /// Start from the demo.
    Demo,
    /// Choose a file and open it.
    Choose,
    /// Open this file.
    Open(PathBuf),
    /// Close the window.
    Quit,
}

/// What became of the wishes, for the window to act on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The window may close.
    Quit,
    /// The still picture is to be traced and written here.
    SaveImage(PathBuf),
}

/// The wishes in progress.
pub struct Files {
    dialogs: Box<dyn Dialogs>,
    waiting: Option<Waiting>,
    prompt: Option<Prompt>,
    unsaved: Option<Next>,
    /// Whether the user is asked if quitting is meant.
    quitting: bool,
    /// What follows when the running "save" is done.
    after_save: Option<Next>,
    /// Files that were opened or saved, newest first.
    pub recent: Vec<PathBuf>,
}

struct Waiting {
    ask: Ask,
    answer: Receiver<Option<PathBuf>>,
    since: Instant,
}

struct Prompt {
    ask: Ask,
    text: String,
}

impl Files {
    /// Nothing in progress.
    pub fn new(dialogs: Box<dyn Dialogs>, recent: Vec<PathBuf>) -> Self {
        Self {
            dialogs,
            waiting: None,
            prompt: None,
            unsaved: None,
            quitting: false,
            after_save: None,
            recent,
        }
    }

    /// Whether something is asked of the user that keys must not talk over.
    pub fn is_asking(&self) -> bool {
        self.prompt.is_some() || self.unsaved.is_some() || self.quitting
    }

    /// Does `next`, after asking about unsaved changes.
    pub fn start(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<Outcome> {
        if editor.is_dirty() {
            self.unsaved = Some(next);
            return None;
        }
        self.go_on(ctx, editor, next)
    }

    /// Quits, after asking whether that is meant.
    pub fn ask_to_quit(&mut self, ctx: &Context, editor: &mut Editor) -> Option<Outcome> {
        if editor.is_dirty() {
            return self.start(ctx, editor, Next::Quit);
        }
        self.quitting = true;
        None
    }

    /// Writes the document to its file, or asks for one.
    pub fn save(&mut self, ctx: &Context, editor: &mut Editor) -> Option<Outcome> {
        if let Some(path) = editor.path().map(Path::to_owned) {
            self.answered(ctx, editor, &Ask::SaveScene, path)
        } else {
            self.ask(ctx, editor, Ask::SaveScene);
            None
        }
    }

    /// Asks for a path.
    pub fn ask(&mut self, ctx: &Context, editor: &Editor, ask: Ask) {
        let answer = self.dialogs.ask(ctx, &ask, suggestion(editor, &ask));
        self.waiting = Some(Waiting {
            ask,
            answer,
            since: Instant::now(),
        });
    }

    /// Takes answers up as they come.
    pub fn poll(&mut self, ctx: &Context, editor: &mut Editor) -> Option<Outcome> {
        let Waiting { ask, answer, since } = self.waiting.take()?;
        match answer.try_recv() {
            Ok(Some(path)) => self.answered(ctx, editor, &ask, path),
            Err(TryRecvError::Empty) => {
                self.waiting = Some(Waiting { ask, answer, since });
                None
            }
            Ok(None) | Err(TryRecvError::Disconnected) => {
                if since.elapsed() < NO_DIALOG {
                    let text = suggestion(editor, &ask).display().to_string();
                    self.prompt = Some(Prompt { ask, text });
                } else {
                    self.after_save = None;
                }
                None
            }
        }
    }

    /// Draws what is being asked.
    pub fn show(&mut self, ui: &Ui, editor: &mut Editor) -> Option<Outcome> {
        let ctx = ui.ctx().clone();
        if let Some(next) = self.unsaved.clone() {
            return self.show_unsaved(&ctx, editor, next);
        }
        if self.quitting {
            return self.show_quitting(&ctx);
        }
        self.show_prompt(&ctx, editor)
    }

    fn show_quitting(&mut self, ctx: &Context) -> Option<Outcome> {
        let mut is_meant = false;
        let modal = Modal::new(Id::unique("quit")).show(ctx, |ui| {
            ui.set_width(240.0);
            ui.heading("Quit Glint?");
            ui.add_space(2.0 * GRID);
            ui.horizontal(|ui| {
                is_meant = primary(ui, "Quit now").clicked()
                    || ui.input(|input| input.key_pressed(Key::Enter));
                if ui.button("Stay").clicked() {
                    ui.close();
                }
            });
        });
        self.quitting = !is_meant && !modal.should_close();
        is_meant.then_some(Outcome::Quit)
    }

    fn show_unsaved(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<Outcome> {
        let mut choice = None;
        let modal = Modal::new(Id::unique("unsaved changes")).show(ctx, |ui| {
            ui.set_width(380.0);
            ui.heading(format!("Save changes to {}?", editor.title()));
            ui.add_space(GRID);
            ui.label("Without saving, the changes since the last save are lost.");
            ui.add_space(2.0 * GRID);
            ui.horizontal(|ui| {
                if primary(ui, "Save changes").clicked() {
                    choice = Some(true);
                }
                if ui.button("Don't save").clicked() {
                    choice = Some(false);
                }
                if ui.button("Keep editing").clicked() {
                    ui.close();
                }
            });
        });
        match choice {
            Some(true) => {
                self.unsaved = None;
                self.after_save = Some(next);
                self.save(ctx, editor)
            }
            Some(false) => {
                self.unsaved = None;
                editor.forget_changes();
                self.go_on(ctx, editor, next)
            }
            None => {
                if modal.should_close() {
                    self.unsaved = None;
                }
                None
            }
        }
    }

    fn show_prompt(&mut self, ctx: &Context, editor: &mut Editor) -> Option<Outcome> {
        let prompt = self.prompt.as_mut()?;
        let mut is_done = false;
        let modal = Modal::new(Id::unique("path prompt")).show(ctx, |ui| {
            ui.set_width(480.0);
            ui.heading(prompt.ask.title());
            ui.add_space(GRID);
            let label = ui.weak("Path (this desktop offers no file dialog)");
            let field = TextEdit::singleline(&mut prompt.text).desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(label.id);
            if !field.has_focus() && !field.lost_focus() {
                field.request_focus();
            }
            let path = prompt.path();
            if let Some(warning) = prompt.warning(&path) {
                ui.colored_label(palette(ui.ctx()).accent, warning);
            }
            ui.add_space(GRID);
            ui.horizontal(|ui| {
                let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                let word = if prompt.ask.writes() {
                    "Save file"
                } else {
                    "Open file"
                };
                is_done = primary(ui, word).clicked() || entered;
                if ui.button("Cancel").clicked() {
                    ui.close();
                }
            });
        });
        if is_done && !prompt.text.trim().is_empty() {
            let Prompt { ask, text } = self.prompt.take()?;
            let path = Prompt {
                ask: ask.clone(),
                text,
            }
            .path();
            return self.answered(ctx, editor, &ask, path);
        }
        if modal.should_close() {
            self.prompt = None;
            self.after_save = None;
        }
        None
    }

    fn answered(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        ask: &Ask,
        path: PathBuf,
    ) -> Option<Outcome> {
        match ask {
            Ask::OpenScene => {
                self.open(editor, &path);
                None
            }
            Ask::SaveImage => Some(Outcome::SaveImage(with_ending(path, ask))),
            Ask::SaveScene => {
                let path = with_ending(path, ask);
                match editor.save(&path) {
                    Ok(()) => {
                        self.remember(editor);
                        let next = self.after_save.take()?;
                        self.go_on(ctx, editor, next)
                    }
                    Err(error) => {
                        self.after_save = None;
                        editor.complain(error.to_string());
                        None
                    }
                }
            }
        }
    }

    fn go_on(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<Outcome> {
        match next {
            Next::New => editor.start_new(),
            Next::Demo => editor.start_demo(),
            Next::Choose => self.ask(ctx, editor, Ask::OpenScene),
            Next::Open(path) => self.open(editor, &path),
            Next::Quit => return Some(Outcome::Quit),
        }
        None
    }

    /// Opens a file; if it is refused, the document stays and the user is told why.
    pub fn open(&mut self, editor: &mut Editor, path: &Path) {
        match editor.open(path) {
            Ok(()) => self.remember(editor),
            Err(error) => {
                self.recent
                    .retain(|recent| recent != path || recent.exists());
                editor.complain(error.to_string());
            }
        }
    }

    fn remember(&mut self, editor: &Editor) {
        let Some(path) = editor.path() else { return };
        self.recent.retain(|recent| recent != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(RECENT);
    }
}

impl Prompt {
    /// The path that was typed, with `~` for the home folder and the ending that files have.
    fn path(&self) -> PathBuf {
        let text = self.text.trim();
        let home = std::env::home_dir();
        let path = match (text.strip_prefix("~/"), home) {
            (Some(rest), Some(home)) => home.join(rest),
            _ => PathBuf::from(text),
        };
        with_ending(path, &self.ask)
    }

    fn warning(&self, path: &Path) -> Option<String> {
        match (self.ask.writes(), path.exists()) {
            (true, true) => Some(format!("Replaces {}", path.display())),
            (false, false) => Some(format!("There is no {}", path.display())),
            _ => None,
        }
    }
}

/// The button that Enter would press.
fn primary(ui: &mut Ui, text: &str) -> egui::Response {
    let colors = palette(ui.ctx());
    ui.add(Button::new(RichText::new(text).color(colors.on_accent)).fill(colors.accent))
}

fn with_ending(path: PathBuf, ask: &Ask) -> PathBuf {
    match path.extension() {
        Some(_) => path,
        None => path.with_extension(ask.endings()[0]),
    }
}

/// Beside the document, under its name.
fn suggestion(editor: &Editor, ask: &Ask) -> PathBuf {
    let folder = editor
        .path()
        .and_then(Path::parent)
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder
        .map(Path::to_owned)
        .or_else(|| std::env::current_dir().ok())
        .unwrap_or_default();
    let title = editor.title();
    let stem = Path::new(&title).file_stem().unwrap_or_default();
    match ask {
        Ask::OpenScene => folder.join(""),
        Ask::SaveScene | Ask::SaveImage => folder.join(stem).with_extension(ask.endings()[0]),
    }
}
