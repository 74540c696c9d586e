//! Opening and saving, from the request to the file. A request may have to wait for an answer; what follows it
//! ([`Next`]) waits with it and is dropped with it.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Context, Ui};

use super::commands::Next;
use super::dialogs::{Ask, Dialogs};
use super::file_requests::{DialogState, FileOutcome, OpenDialog, PathRequest, Prompt};
use super::folders::Folders;
use super::interchange::{export_job, export_path, export_povray, import_parts, import_path};
use super::outside::{ExternalVersion, LoadedScene, OUTSIDE, Watch, clear_lost, report_lost};
use super::prompts::{PathPrompt, Reply, ask_about_changes, ask_to_quit};
use super::reading::{ReadOutcome, Reading};
use crate::editor::{Action, Editor, OwnFile, Time};
use crate::scene::{Document, EXAMPLES, SceneError};

/// Longest time for which reading a file may block the window, so that small files open at once.
const MAX_BLOCKING: Duration = Duration::from_millis(30);
/// Number of files that "Open recent" remembers.
const MAX_RECENT: usize = 10;

/// File operations in progress.
pub struct Files {
    dialogs: Box<dyn Dialogs>,
    dialog: Option<OpenDialog>,
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
            dialog: None,
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
        self.proceed(ctx, editor, next)
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

    /// Writes the document to its file, or asks for a path if it has none; `then` follows.
    pub fn save(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        then: Option<Next>,
    ) -> Option<FileOutcome> {
        let request = PathRequest::new(editor, Ask::SaveScene, then);
        if let Some(path) = editor.path().map(Path::to_owned) {
            self.handle_path(ctx, editor, request, path)
        } else {
            self.open_dialog(ctx, editor, request);
            None
        }
    }

    /// Asks for a path.
    pub fn ask(&mut self, ctx: &Context, editor: &mut Editor, ask: Ask) {
        self.open_dialog(ctx, editor, PathRequest::new(editor, ask, None));
    }

    fn open_dialog(&mut self, ctx: &Context, editor: &mut Editor, request: PathRequest) {
        if self.dialog.is_some() {
            return editor.notify("Another file dialog is open: close it first".to_owned());
        }
        let suggested = self.folders.suggest(editor, &request.ask);
        let answer = self.dialogs.ask(ctx, &request.ask, suggested);
        self.dialog = Some(OpenDialog::new(request, answer));
    }

    /// Whether no question or dialog is open. While one is, no other document may replace the one it is about.
    fn is_free(&self) -> bool {
        self.prompt.is_none() && self.dialog.is_none()
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
            ctx.request_repaint_after(MAX_BLOCKING);
            self.take_finished_read(ctx, editor, Duration::ZERO);
        } else if is_free && self.watch.is_due(ctx, editor) {
            self.check_external_change(ctx, editor);
            let changed = self.watch.changed_meshes(editor);
            self.reading.extend(Reading::reload_meshes(editor, changed));
        }
        // One question at a time.
        let mut dialog = self.dialog.take_if(|_| self.prompt.is_none())?;
        match dialog.poll() {
            DialogState::NotYet => self.dialog = Some(dialog),
            DialogState::Path(path) => {
                let request = dialog.request;
                let full = request.ask.with_ending(path.clone());
                let needs_confirmation = request.ask.writes() && full != path && full.exists();
                if needs_confirmation || !request.ask.accepts(&full) {
                    // The desktop did not ask about replacing the file of this name, or does not know the endings.
                    self.ask_for_path(request, &full, "Path");
                    return None;
                }
                return self.handle_path(ctx, editor, request, full);
            }
            DialogState::NoDialog => {
                let suggested = self.folders.suggest(editor, &dialog.request.ask);
                let label = "Path (this desktop offers no file dialog)";
                self.ask_for_path(dialog.request, &suggested, label);
            }
            DialogState::Cancelled => {}
        }
        None
    }

    fn ask_for_path(&mut self, request: PathRequest, suggested: &Path, label: &'static str) {
        let prompt = PathPrompt::new(request.ask.clone(), suggested, label);
        self.prompt = Some(Prompt::Path(request, prompt));
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
                let running = exports.filter(|_| matches!(next, Next::Quit | Next::QuitAnyway));
                if running.is_some() {
                    *next = Next::QuitAnyway;
                }
                ask_about_changes(&ctx, &editor.title(), next, running)
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
                self.save(&ctx, editor, Some(next))
            }
            (Prompt::Unsaved(next), Reply::No) => self.proceed(&ctx, editor, next),
            (Prompt::Quit, Reply::Yes) => Some(FileOutcome::Quit),
            (Prompt::Path(request, mut prompt), Reply::Yes) => {
                let outcome = self.handle_path(&ctx, editor, request.clone(), prompt.path());
                if request.document == editor.documents()
                    && let Some(why) = editor.take_error(request.ask.title())
                {
                    prompt.refuse(why);
                    self.prompt = Some(Prompt::Path(request, prompt));
                }
                outcome
            }
            (Prompt::Outside(theirs, request), answer) => {
                self.apply_external_answer(&ctx, editor, (*theirs, answer), request)
            }
            _ => None,
        }
    }

    fn handle_path(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        request: PathRequest,
        path: PathBuf,
    ) -> Option<FileOutcome> {
        editor.begin(request.ask.title());
        self.folders.note(&request.ask, &path);
        // The desktop's dialog leaves the window usable: nobody asked about what was edited there in the meantime.
        let is_same_document = request.document == editor.documents();
        let is_unchanged = is_same_document && request.revision == editor.revision();
        match request.ask {
            Ask::OpenScene if !is_unchanged => return self.start(ctx, editor, Next::Open(path)),
            Ask::OpenScene => self.open(ctx, editor, &path),
            ask if !is_same_document => {
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
                self.watch.is_changed(&path);
                let (theirs, then) = (Document::load_stamped(&path), request.then.clone());
                if self.resolve_external_change(editor, theirs, Some(request)) {
                    return self.proceed(ctx, editor, then?);
                }
            }
            Ask::SaveScene => match editor.save(&path) {
                Ok(()) => {
                    self.add_to_recent(editor);
                    return self.proceed(ctx, editor, request.then?);
                }
                Err(error) => editor.report_error_in(request.ask.title(), error.to_string()),
            },
        }
        None
    }

    /// Starts to read the document's file again if another program has written it.
    fn check_external_change(&mut self, ctx: &Context, editor: &mut Editor) {
        let Some(path) = editor.path().map(Path::to_owned) else {
            return;
        };
        let is_gone = self.watch.note_gone(editor, &path);
        let (is_changed, broken) = (self.watch.is_changed(&path), self.watch.broken.take());
        if let Some(why) = broken.filter(|_| !is_changed) {
            report_lost(editor, OwnFile::Broken, why);
        }
        if !is_changed || is_gone {
            return;
        }
        if !editor.is_changed_outside() {
            return clear_lost(editor);
        }
        self.reading
            .push_back(Reading::external_version(editor, &path));
        self.take_finished_read(ctx, editor, MAX_BLOCKING);
    }

    /// Reloads what another program has written; asks if the document was changed too. An unreadable file may be
    /// half written: the next check, or the next save, will tell.
    fn finish_external_change(&mut self, editor: &mut Editor, theirs: LoadedScene) {
        match theirs {
            Ok(_) => {
                self.resolve_external_change(editor, theirs, None);
            }
            Err(SceneError::Disk { .. }) => self.watch.forget_modified(),
            Err(error) => self.watch.broken = Some(error.to_string()),
        }
    }

    /// Takes what another program has written if that loses nothing, otherwise asks. Returns whether it was taken.
    fn resolve_external_change(
        &mut self,
        editor: &mut Editor,
        theirs: LoadedScene,
        request: Option<PathRequest>,
    ) -> bool {
        if theirs.is_ok() {
            clear_lost(editor);
        }
        match theirs {
            Ok(theirs) if !editor.is_dirty() || theirs.0.scene == **editor.scene() => {
                editor.take_theirs(theirs);
                return true;
            }
            theirs => {
                let theirs = Box::new(ExternalVersion::new(editor, theirs));
                self.prompt = Some(Prompt::Outside(theirs, request));
            }
        }
        false
    }

    fn apply_external_answer(
        &mut self,
        ctx: &Context,
        editor: &mut Editor,
        (theirs, answer): (ExternalVersion, Reply),
        request: Option<PathRequest>,
    ) -> Option<FileOutcome> {
        let then = request.as_ref().and_then(|request| request.then.clone());
        match answer {
            Reply::Yes => {
                theirs.reject(editor);
                return request.and_then(|_| self.save(ctx, editor, then));
            }
            Reply::No => {
                theirs.accept(editor);
                return then.and_then(|next| self.proceed(ctx, editor, next));
            }
            Reply::Other => {
                self.open_dialog(ctx, editor, PathRequest::new(editor, Ask::SaveScene, then));
            }
            _ => {}
        }
        None
    }

    fn proceed(&mut self, ctx: &Context, editor: &mut Editor, next: Next) -> Option<FileOutcome> {
        // A problem with another file no longer matters.
        editor.begin(Ask::OpenScene.title());
        if matches!(next, Next::New | Next::Example(_)) {
            editor.begin(OUTSIDE);
            // A scene that is still being read is no longer wanted.
            self.reading.retain(|reading| !reading.is_scene);
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
        self.reading.retain(|reading| !reading.is_scene);
        self.reading.push_front(Reading::scene(editor, path));
        self.take_finished_read(ctx, editor, MAX_BLOCKING);
    }

    /// Opens a file before there is a window.
    pub fn open_now(&mut self, editor: &mut Editor, path: &Path) {
        self.finish_opening(editor, path, Document::load_stamped(path));
    }

    /// Imports the parts of a mesh file as objects.
    pub fn import_mesh(&mut self, ctx: &Context, editor: &mut Editor, path: &Path) {
        self.reading.push_back(Reading::parts(editor, path));
        self.take_finished_read(ctx, editor, MAX_BLOCKING);
    }

    fn take_finished_read(&mut self, ctx: &Context, editor: &mut Editor, wait: Duration) {
        let is_free = self.is_free() && !editor.is_recording();
        let first = self.reading.front_mut().filter(|_| is_free);
        let Some(read) = first.and_then(|reading| reading.wait(wait)) else {
            return;
        };
        let Some(reading) = self.reading.pop_front() else {
            return;
        };
        match read {
            ReadOutcome::Scene(_) if reading.is_outdated(editor) => {
                self.start(ctx, editor, Next::Open(reading.path));
            }
            ReadOutcome::Scene(document) => self.finish_opening(editor, &reading.path, *document),
            ReadOutcome::External(theirs) if reading.is_external_version(editor) => {
                self.finish_external_change(editor, *theirs);
            }
            ReadOutcome::Mesh(Ok(file)) if !reading.is_for_other_document(editor) => {
                import_parts(editor, &reading.path, file);
            }
            ReadOutcome::Mesh(read) => {
                let why = read.map_or_else(|error| error.to_string(), |_| reading.describe_late());
                editor.report_error_in(Ask::ImportMesh.title(), why);
            }
            ReadOutcome::ReloadedMeshes(sources) if !reading.is_for_other_document(editor) => {
                editor.take_meshes(sources);
            }
            ReadOutcome::External(_) | ReadOutcome::ReloadedMeshes(_) => {}
            ReadOutcome::Nothing => editor.report_error(reading.describe_fault()),
        }
    }

    fn finish_opening(&mut self, editor: &mut Editor, path: &Path, document: LoadedScene) {
        match document {
            Ok(document) => {
                editor.begin(Ask::OpenScene.title());
                editor.begin(OUTSIDE);
                editor.open(document, path);
                self.add_to_recent(editor);
            }
            Err(error) => {
                self.recent
                    .retain(|recent| recent != path || recent.exists());
                editor.report_error_in(Ask::OpenScene.title(), error.to_string());
            }
        }
    }

    fn add_to_recent(&mut self, editor: &Editor) {
        let Some(path) = editor.path() else { return };
        self.recent.retain(|recent| recent != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(MAX_RECENT);
    }
}
