//! Opening and saving, from the wish to the file. A wish may have to wait for an answer; what
//! follows it ([`Next`]) waits with it and is forgotten with it.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::{Duration, Instant};

use egui::{Context, Ui};

use super::dialogs::{Ask, Dialogs};
use super::prompts::{Answer, PathPrompt, ask_about_changes, ask_to_quit};
use crate::animate::{from_table, from_text, to_table, to_text};
use crate::editor::{Action, Edit, Editor};
use crate::export::{Pattern, Sequence, job_template, write_text};
use crate::image::Format;
use crate::mesh::read_parts;
use crate::scene::{Animation, read_text};

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
pub enum FileOutcome {
    /// The window may close.
    Quit,
    /// The still picture is to be traced and written here.
    SaveImage(PathBuf),
    /// Frames are to be written here.
    ExportFolder(PathBuf),
}

/// The wishes in progress.
pub struct Files {
    dialogs: Box<dyn Dialogs>,
    waiting: Option<Waiting>,
    question: Option<Question>,
    /// Files that were opened or saved, newest first.
    pub recent: Vec<PathBuf>,
}

/// A desktop dialog that is open.
struct Waiting {
    wish: PathRequest,
    answer: Receiver<Option<PathBuf>>,
    since: Instant,
}

/// A path that is wanted, and what follows when it is there.
#[derive(Clone)]
struct PathRequest {
    ask: Ask,
    then: Option<Next>,
}

/// A question over the window.
enum Question {
    Unsaved(Next),
    /// The answer was to save: as soon as a recorded flight has become keys.
    Saving(Next),
    Quit,
    Path(PathRequest, PathPrompt),
}

impl Files {
    /// Nothing in progress.
    pub fn new(dialogs: Box<dyn Dialogs>, recent: Vec<PathBuf>) -> Self {
        Self {
            dialogs,
            waiting: None,
            question: None,
            recent,
        }
    }

    /// Whether something is asked of the user that keys must not talk over.
    pub fn is_asking(&self) -> bool {
        self.question.is_some()
    }

    /// Does `next`, after asking about unsaved changes.
    pub fn start(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<FileOutcome> {
        if editor.is_dirty() {
            self.question = Some(Question::Unsaved(next));
            return None;
        }
        self.go_on(ctx, editor, next)
    }

    /// Quits, after asking whether that is meant.
    pub fn ask_to_quit(&mut self, editor: &Editor) {
        let is_dirty = editor.is_dirty();
        self.question = Some(if is_dirty {
            Question::Unsaved(Next::Quit)
        } else {
            Question::Quit
        });
    }

    /// Writes the document to its file, or asks for one.
    pub fn save(&mut self, ctx: &Context, editor: &mut Editor) -> Option<FileOutcome> {
        self.save_then(ctx, editor, None)
    }

    fn save_then(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        then: Option<Next>,
    ) -> Option<FileOutcome> {
        let wish = PathRequest {
            ask: Ask::SaveScene,
            then,
        };
        if let Some(path) = editor.path().map(Path::to_owned) {
            self.answered(ctx, editor, wish, path)
        } else {
            self.wish(ctx, editor, wish);
            None
        }
    }

    /// Asks for a path.
    pub fn ask(&mut self, ctx: &Context, editor: &Editor, ask: Ask) {
        self.wish(ctx, editor, PathRequest { ask, then: None });
    }

    /// One dialog at a time: while one is open, further wishes are not heard.
    fn wish(&mut self, ctx: &Context, editor: &Editor, wish: PathRequest) {
        if self.waiting.is_none() {
            let answer = self
                .dialogs
                .ask(ctx, &wish.ask, suggestion(editor, &wish.ask));
            self.waiting = Some(Waiting {
                wish,
                answer,
                since: Instant::now(),
            });
        }
    }

    /// Takes answers up as they come.
    pub fn poll(&mut self, ctx: &Context, editor: &mut Editor) -> Option<FileOutcome> {
        let Waiting {
            wish,
            answer,
            since,
        } = self.waiting.take()?;
        match answer.try_recv() {
            Ok(Some(path)) => {
                let full = wish.ask.with_ending(path.clone());
                if wish.ask.writes() && full != path && full.exists() {
                    // The desktop asked about another name than the one that would be replaced.
                    self.prompt(wish, &full);
                    return None;
                }
                return self.answered(ctx, editor, wish, full);
            }
            Err(TryRecvError::Empty) => {
                self.waiting = Some(Waiting {
                    wish,
                    answer,
                    since,
                });
            }
            Ok(None) | Err(TryRecvError::Disconnected) if since.elapsed() < NO_DIALOG => {
                let suggested = suggestion(editor, &wish.ask);
                self.prompt(wish, &suggested);
            }
            Ok(None) | Err(TryRecvError::Disconnected) => {}
        }
        None
    }

    fn prompt(&mut self, wish: PathRequest, suggested: &Path) {
        let prompt = PathPrompt::new(wish.ask.clone(), suggested);
        self.question = Some(Question::Path(wish, prompt));
    }

    /// Draws what is being asked.
    pub fn show(&mut self, ui: &Ui, editor: &mut Editor) -> Option<FileOutcome> {
        let ctx = ui.ctx().clone();
        let answer = match self.question.as_mut()? {
            Question::Unsaved(_) => ask_about_changes(&ctx, &editor.title()),
            Question::Saving(_) if editor.is_making_keys() => Answer::Open,
            Question::Saving(_) => Answer::Yes,
            Question::Quit => ask_to_quit(&ctx),
            Question::Path(_, prompt) => prompt.show(&ctx),
        };
        if answer == Answer::Open {
            return None;
        }
        let question = self.question.take()?;
        match (question, answer) {
            (Question::Unsaved(next), Answer::Yes) if editor.is_making_keys() => {
                self.question = Some(Question::Saving(next));
                None
            }
            (Question::Unsaved(next) | Question::Saving(next), Answer::Yes) => {
                self.save_then(&ctx, editor, Some(next))
            }
            (Question::Unsaved(next), Answer::No) => self.go_on(&ctx, editor, next),
            (Question::Quit, Answer::Yes) => Some(FileOutcome::Quit),
            (Question::Path(wish, prompt), Answer::Yes) => {
                self.answered(&ctx, editor, wish, prompt.path())
            }
            _ => None,
        }
    }

    fn answered(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        wish: PathRequest,
        path: PathBuf,
    ) -> Option<FileOutcome> {
        match wish.ask {
            Ask::OpenScene => self.open(editor, &path),
            Ask::ImportMesh => import_mesh(editor, &path),
            Ask::SaveImage => return Some(FileOutcome::SaveImage(path)),
            Ask::ExportFolder => return Some(FileOutcome::ExportFolder(path)),
            Ask::ImportPath => import_path(editor, &path),
            Ask::ExportPath => export_path(editor, &path),
            Ask::ExportJob => export_job(editor, &path),
            Ask::SaveScene => match editor.save(&path) {
                Ok(()) => {
                    self.remember(editor);
                    return self.go_on(ctx, editor, wish.then?);
                }
                Err(error) => editor.report_error(error.to_string()),
            },
        }
        None
    }

    fn go_on(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<FileOutcome> {
        match next {
            Next::New => editor.start_new(),
            Next::Demo => editor.start_demo(),
            Next::Choose => self.ask(ctx, editor, Ask::OpenScene),
            Next::Open(path) => self.open(editor, &path),
            Next::Quit => return Some(FileOutcome::Quit),
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
                editor.report_error(error.to_string());
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
    let stem = title.strip_suffix(".ron").unwrap_or(&title);
    match ask {
        Ask::OpenScene | Ask::ImportMesh | Ask::ImportPath | Ask::ExportFolder => folder.join(""),
        Ask::ExportPath => folder.join(format!("{stem} path.csv")),
        Ask::ExportJob => folder.join(format!("{stem} job.yaml")),
        Ask::SaveScene | Ask::SaveImage => folder.join(format!("{stem}.{}", ask.endings()[0])),
    }
}

/// The parts of a mesh file become objects.
pub fn import_mesh(editor: &mut Editor, path: &Path) {
    match read_parts(path) {
        Ok(parts) => {
            let count: usize = parts.iter().map(|part| part.triangles.faces().len()).sum();
            editor.apply(Action::Edit(Edit::Import(parts)));
            editor.notify(format!("{count} triangles from {}", path.display()));
        }
        Err(error) => editor.report_error(error.to_string()),
    }
}

/// The keys of a file take the place of the camera's.
fn import_path(editor: &mut Editor, path: &Path) {
    let text = match read_text(path) {
        Ok(text) => text,
        Err(error) => return editor.report_error(error.to_string()),
    };
    let keys = if is_table(path) {
        from_table(&text, &editor.shown().camera)
    } else {
        from_text(&text)
    };
    match keys {
        Ok(keys) => {
            let count = keys.len();
            let animation = Animation {
                keys,
                take: None,
                ..Animation::clone(&editor.scene().animation)
            };
            editor.apply(Action::Edit(Edit::animation(animation, "Import path")));
            editor.notify(format!("{count} keys from {}", path.display()));
        }
        Err(error) => editor.report_error(format!("{}: {error}", path.display())),
    }
}

fn export_path(editor: &mut Editor, path: &Path) {
    let is_text = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
    if !is_table(path) && !is_text {
        return editor.report_error(format!("{}: end it in .csv or .ron", path.display()));
    }
    let keys = &editor.scene().animation.keys;
    let text = if is_table(path) {
        Ok(to_table(keys.iter().map(|key| (key.time, &key.value))))
    } else {
        to_text(keys).map_err(Box::<dyn Error>::from)
    };
    match text.and_then(|text| Ok(write_text(path, &text)?)) {
        Ok(()) => editor.notify(format!("Saved {}", path.display())),
        Err(error) => editor.report_error(error.to_string()),
    }
}

/// The template, and the scene as it is now beside it.
fn export_job(editor: &mut Editor, path: &Path) {
    let scene = path.with_extension("ron");
    match write_job(editor, path, &scene) {
        Ok(()) => editor.notify(format!("Saved {} and {}", path.display(), scene.display())),
        Err(error) => editor.report_error(error.to_string()),
    }
}

fn write_job(editor: &Editor, path: &Path, scene: &Path) -> Result<(), Box<dyn Error>> {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let file = scene.file_name().unwrap_or_default().to_string_lossy();
    let (pattern, folder) = (Pattern::default(), PathBuf::from("frames"));
    let sequence = Sequence::new(editor.scene().clone(), None, pattern, Format::Ppm, folder)?;
    write_text(path, &job_template(&sequence, &name, &file))?;
    editor.document().save(scene)?;
    Ok(())
}

fn is_table(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
}
