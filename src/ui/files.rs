//! Opening and saving, from the request to the file. A request may have to wait for an answer; what follows it
//! ([`Next`]) waits with it and is dropped with it.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Context, Ui};

use super::commands::Next;
use super::dialogs::{Ask, Dialogs};
use super::file_requests::{Answered, FileOutcome, PathRequest, Prompt, Waiting};
use super::folders::Folders;
use super::interchange::{export_job, export_path, export_povray, import_path, imported};
use super::outside::{OUTSIDE, Theirs, Watch, forget_lost, tell_lost};
use super::prompts::{PathPrompt, Reply, ask_about_changes, ask_to_quit};
use super::reading::{Read, Reading};
use crate::editor::{Action, Editor, OwnFile, Time};
use crate::files::Stamp;
use crate::scene::{Document, EXAMPLES, SceneError};

/// Longest time for which reading a file may block the window, so that small files open at once.
const AT_ONCE: Duration = Duration::from_millis(30);
/// Number of files that "Open recent" remembers.
const RECENT: usize = 10;

/// File operations in progress.
pub struct Files {
    dialogs: Box<dyn Dialogs>,
    waiting: Option<Waiting>,
    prompt: Option<Prompt>,
    /// Files being read, first in first out.
    reading: VecDeque<Reading>,
    watch: Watch,
    /// Files that were opened or saved, newest first.
    pub recent: Vec<PathBuf>,
    /// The folders in which paths were chosen before.
    pub folders: Folders,
}

impl Files {
    /// Creates the state with no operation in progress.
    pub fn new(dialogs: Box<dyn Dialogs>, recent: Vec<PathBuf>, folders: Folders) -> Self {
        Self {
            dialogs,
            waiting: None,
            prompt: None,
            reading: VecDeque::new(),
            watch: Watch::default(),
            recent,
            folders,
        }
    }

    /// Whether a question is open, during which keys must not trigger anything else.
    pub fn is_asking(&self) -> bool {
        self.prompt.is_some()
    }

    /// Does `next`, after asking about unsaved changes. A flight being recorded becomes keys first, which count as
    /// unsaved changes.
    pub fn start(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<FileOutcome> {
        if !matches!(self.prompt, None | Some(Prompt::Saving(_))) {
            editor.notify("Answer the open question first".to_owned());
            return None;
        }
        editor.apply(Action::Time(Time::Stop));
        if editor.is_dirty() {
            self.prompt = Some(Prompt::Unsaved(next));
            return None;
        }
        self.go_on(ctx, editor, next)
    }

    /// Asks whether to quit, or what to do with unsaved changes before quitting.
    pub fn ask_to_quit(&mut self, editor: &mut Editor) {
        editor.apply(Action::Time(Time::Stop));
        self.prompt = Some(if editor.is_dirty() {
            Prompt::Unsaved(Next::Quit)
        } else {
            Prompt::Quit
        });
    }

    /// Writes the document to its file, or asks for a path if it has none.
    pub fn save(&mut self, ctx: &Context, editor: &mut Editor) -> Option<FileOutcome> {
        self.save_then(ctx, editor, None)
    }

    fn save_then(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        then: Option<Next>,
    ) -> Option<FileOutcome> {
        let wish = PathRequest::new(editor, Ask::SaveScene, then);
        if let Some(path) = editor.path().map(Path::to_owned) {
            self.answered(ctx, editor, wish, path)
        } else {
            self.wish(ctx, editor, wish);
            None
        }
    }

    /// Asks for a path.
    pub fn ask(&mut self, ctx: &Context, editor: &mut Editor, ask: Ask) {
        self.wish(ctx, editor, PathRequest::new(editor, ask, None));
    }

    fn wish(&mut self, ctx: &Context, editor: &mut Editor, wish: PathRequest) {
        if self.waiting.is_some() {
            return editor.notify("Another file dialog is open: close it first".to_owned());
        }
        let suggested = self.folders.suggest(editor, &wish.ask);
        let answer = self.dialogs.ask(ctx, &wish.ask, suggested);
        self.waiting = Some(Waiting::new(wish, answer));
    }

    /// Whether no question or dialog is open. While one is, no other document may replace the one it is about.
    fn is_free(&self) -> bool {
        self.prompt.is_none() && self.waiting.is_none()
    }

    /// The file that is being read.
    pub fn reading(&self) -> Option<&Reading> {
        self.reading.front()
    }

    /// Describes the file that is being read, for the status line.
    pub fn describe_reading(&self) -> Option<String> {
        Some(self.reading()?.describe(self.is_free()))
    }

    /// Handles answers of dialogs and finished reads.
    pub fn poll(&mut self, ctx: &Context, editor: &mut Editor) -> Option<FileOutcome> {
        // Nothing that is being dragged may be replaced in the middle of the drag.
        if ctx.input(|input| input.pointer.any_down()) || editor.is_in_gesture() {
            return None;
        }
        // Nor may a file that was read move the camera of a flight that is being recorded.
        let is_free = self.is_free() && !editor.is_recording();
        if !self.reading.is_empty() && is_free {
            ctx.request_repaint_after(AT_ONCE);
            self.take_read(ctx, editor, Duration::ZERO);
        } else if is_free && self.watch.is_due(ctx, editor) {
            self.look_outside(editor);
            let changed = self.watch.changed_meshes(editor);
            self.reading.extend(Reading::again(editor, changed));
        }
        // One question at a time.
        let mut waiting = self.waiting.take_if(|_| self.prompt.is_none())?;
        match waiting.answered() {
            Answered::NotYet => self.waiting = Some(waiting),
            Answered::Path(path) => {
                let wish = waiting.wish;
                let full = wish.ask.with_ending(path.clone());
                let is_unasked = wish.ask.writes() && full != path && full.exists();
                if is_unasked || !wish.ask.takes(&full) {
                    // The desktop did not ask about replacing the file of this name, or does not know the endings.
                    self.prompt(wish, &full, "Path");
                    return None;
                }
                return self.answered(ctx, editor, wish, full);
            }
            Answered::NoDialog => {
                let suggested = self.folders.suggest(editor, &waiting.wish.ask);
                let label = "Path (this desktop offers no file dialog)";
                self.prompt(waiting.wish, &suggested, label);
            }
            Answered::Cancelled => {}
        }
        None
    }

    fn prompt(&mut self, wish: PathRequest, suggested: &Path, label: &'static str) {
        let prompt = PathPrompt::new(wish.ask.clone(), suggested, label);
        self.prompt = Some(Prompt::Path(wish, prompt));
    }

    /// Shows the open question; `exports` describes exports that are still running.
    pub fn show(
        &mut self,
        ui: &Ui,
        editor: &mut Editor,
        exports: Option<&str>,
    ) -> Option<FileOutcome> {
        let ctx = ui.ctx().clone();
        let answer = match self.prompt.as_mut()? {
            Prompt::Unsaved(next) => {
                let going = exports.filter(|_| matches!(next, Next::Quit | Next::QuitAnyway));
                if going.is_some() {
                    *next = Next::QuitAnyway;
                }
                ask_about_changes(&ctx, &editor.title(), going)
            }
            Prompt::Saving(_) if editor.is_making_keys() => Reply::Open,
            Prompt::Saving(_) => Reply::Yes,
            Prompt::Quit => ask_to_quit(&ctx, exports),
            Prompt::Path(_, prompt) => prompt.show(&ctx),
            Prompt::Outside(theirs, _) => theirs.ask(&ctx, &editor.title()),
        };
        if answer == Reply::Open {
            return None;
        }
        match (self.prompt.take()?, answer) {
            (Prompt::Unsaved(next), Reply::Yes) if editor.is_making_keys() => {
                self.prompt = Some(Prompt::Saving(next));
                None
            }
            (Prompt::Unsaved(next) | Prompt::Saving(next), Reply::Yes) => {
                self.save_then(&ctx, editor, Some(next))
            }
            (Prompt::Unsaved(next), Reply::No) => self.go_on(&ctx, editor, next),
            (Prompt::Quit, Reply::Yes) => Some(FileOutcome::Quit),
            (Prompt::Path(wish, mut prompt), Reply::Yes) => {
                let outcome = self.answered(&ctx, editor, wish.clone(), prompt.path());
                if wish.document == editor.documents()
                    && let Some(why) = editor.take_error(wish.ask.title())
                {
                    prompt.refuse(why);
                    self.prompt = Some(Prompt::Path(wish, prompt));
                }
                outcome
            }
            (Prompt::Outside(theirs, wish), answer) => {
                self.settle_outside(&ctx, editor, (*theirs, answer), wish)
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
        editor.begin(wish.ask.title());
        self.folders.note(&wish.ask, &path);
        // The desktop's dialog leaves the window usable: nobody asked about what was edited there in the meantime.
        let is_same = wish.document == editor.documents();
        let is_as_asked = is_same && wish.revision == editor.revision();
        match wish.ask {
            Ask::OpenScene if !is_as_asked => return self.start(ctx, editor, Next::Open(path)),
            Ask::OpenScene => self.open(ctx, editor, &path),
            ask if !is_same => {
                let why = "The scene this was for is no longer open";
                editor.report_error_in(ask.title(), why.to_owned());
            }
            Ask::ImportMesh => self.import_mesh(ctx, editor, &path),
            Ask::SaveImage => return Some(FileOutcome::SaveImage(path)),
            Ask::ExportFolder => return Some(FileOutcome::ExportFolder(path)),
            Ask::ImportPath => import_path(editor, &path),
            Ask::ExportPath => export_path(editor, &path),
            Ask::ExportJob => export_job(editor, &path),
            Ask::ExportPovray => export_povray(editor, &path),
            Ask::SaveScene if editor.would_lose(&path) => {
                // Marks the current state of the file as seen, whatever the answer will be.
                self.watch.is_news(&path);
                let (theirs, then) = (Document::load_stamped(&path), wish.then.clone());
                if self.meet_theirs(editor, theirs, Some(wish)) {
                    return self.go_on(ctx, editor, then?);
                }
            }
            Ask::SaveScene => match editor.save(&path) {
                Ok(()) => {
                    self.remember(editor);
                    return self.go_on(ctx, editor, wish.then?);
                }
                Err(error) => editor.report_error_in(wish.ask.title(), error.to_string()),
            },
        }
        None
    }

    /// Reloads a file that another program has written; asks if the document was changed too.
    fn look_outside(&mut self, editor: &mut Editor) {
        let Some(path) = editor.path().map(Path::to_owned) else {
            return;
        };
        let is_gone = self.watch.note_gone(editor, &path);
        let (is_news, broken) = (self.watch.is_news(&path), self.watch.take_broken());
        if let Some(why) = broken.filter(|_| !is_news) {
            tell_lost(editor, OwnFile::Broken, why);
        }
        if !is_news || is_gone {
            return;
        }
        if !editor.is_changed_outside() {
            return forget_lost(editor);
        }
        // An unreadable file may be half written; the next check, or the next save, will tell.
        let theirs = match Document::load_stamped(&path) {
            Ok(theirs) => theirs,
            Err(SceneError::Disk { .. }) => return self.watch.look_again(),
            Err(error) => return self.watch.note_broken(error.to_string()),
        };
        self.meet_theirs(editor, Ok(theirs), None);
    }

    /// Takes what another program has written if that loses nothing, otherwise asks. Returns whether it was taken.
    fn meet_theirs(
        &mut self,
        editor: &mut Editor,
        theirs: Result<(Document, Stamp), SceneError>,
        wish: Option<PathRequest>,
    ) -> bool {
        if theirs.is_ok() {
            forget_lost(editor);
        }
        match theirs {
            Ok(theirs) if !editor.is_dirty() || theirs.0.scene == **editor.scene() => {
                editor.take_theirs(theirs);
                return true;
            }
            theirs => {
                let theirs = Box::new(Theirs::new(editor, theirs));
                self.prompt = Some(Prompt::Outside(theirs, wish));
            }
        }
        false
    }

    fn settle_outside(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        (theirs, answer): (Theirs, Reply),
        wish: Option<PathRequest>,
    ) -> Option<FileOutcome> {
        let then = wish.as_ref().and_then(|wish| wish.then.clone());
        match answer {
            Reply::Yes => {
                theirs.leave(editor);
                return wish.and_then(|_| self.save_then(ctx, editor, then));
            }
            Reply::No => {
                theirs.take(editor);
                return then.and_then(|next| self.go_on(ctx, editor, next));
            }
            Reply::Other => {
                self.wish(ctx, editor, PathRequest::new(editor, Ask::SaveScene, then));
            }
            _ => {}
        }
        None
    }

    fn go_on(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<FileOutcome> {
        // A problem with another file no longer matters.
        editor.begin(Ask::OpenScene.title());
        if matches!(next, Next::New | Next::Example(_)) {
            editor.begin(OUTSIDE);
        }
        match next {
            Next::New => editor.start_new(),
            Next::Example(index) => editor.start_example(&EXAMPLES[index]),
            Next::Choose => self.ask(ctx, editor, Ask::OpenScene),
            Next::Open(path) => self.open(ctx, editor, &path),
            Next::Quit => return Some(FileOutcome::AskToQuit),
            Next::QuitAnyway => return Some(FileOutcome::Quit),
        }
        None
    }

    /// Opens a file. If it is refused, the document stays and the user is told why. A large file is read while the
    /// window stays usable.
    pub fn open(&mut self, ctx: &Context, editor: &mut Editor, path: &Path) {
        // A new scene replaces one that is being read; meshes for this document go on if the document does.
        self.reading.retain(|reading| !reading.is_scene());
        self.reading.push_front(Reading::scene(editor, path));
        self.take_read(ctx, editor, AT_ONCE);
    }

    /// Opens a file before there is a window.
    pub fn open_now(&mut self, editor: &mut Editor, path: &Path) {
        self.opened(editor, path, Document::load_stamped(path));
    }

    /// Imports the parts of a mesh file as objects.
    pub fn import_mesh(&mut self, ctx: &Context, editor: &mut Editor, path: &Path) {
        self.reading.push_back(Reading::parts(editor, path));
        self.take_read(ctx, editor, AT_ONCE);
    }

    fn take_read(&mut self, ctx: &Context, editor: &mut Editor, wait: Duration) {
        let first = if self.is_free() {
            self.reading.front_mut()
        } else {
            None
        };
        let Some(read) = first.and_then(|reading| reading.wait(wait)) else {
            return;
        };
        let Some(reading) = self.reading.pop_front() else {
            return;
        };
        match read {
            Read::Scene(_) if reading.is_outrun(editor) => {
                self.start(ctx, editor, Next::Open(reading.path));
            }
            Read::Scene(document) => self.opened(editor, &reading.path, *document),
            Read::Mesh(Ok(file)) if !reading.is_of_another(editor) => {
                imported(editor, &reading.path, file);
            }
            Read::Mesh(read) => {
                let why = read.map_or_else(|error| error.to_string(), |_| reading.describe_late());
                editor.report_error_in(Ask::ImportMesh.title(), why);
            }
            Read::Again(sources) if !reading.is_of_another(editor) => editor.take_meshes(sources),
            Read::Again(_) => {}
            Read::Nothing => editor.report_error(reading.describe_fault()),
        }
    }

    fn opened(
        &mut self,
        editor: &mut Editor,
        path: &Path,
        document: Result<(Document, Stamp), SceneError>,
    ) {
        match document {
            Ok(document) => {
                editor.begin(Ask::OpenScene.title());
                editor.begin(OUTSIDE);
                editor.open(document, path);
                self.remember(editor);
            }
            Err(error) => {
                self.recent
                    .retain(|recent| recent != path || recent.exists());
                editor.report_error_in(Ask::OpenScene.title(), error.to_string());
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
