//! Keeping unsaved work safe while the program runs, and taking it up after one that crashed.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;

use crate::editor::Editor;
use crate::scene::Recovery;
use crate::worker::Background;

/// Time between two autosaves.
const INTERVAL: Duration = Duration::from_secs(5);

/// Time between two looks at whether it is written.
const POLL: Duration = Duration::from_millis(100);

/// The state of autosaving.
#[derive(Default)]
pub struct Autosave {
    recovery: Option<Arc<Recovery>>,
    /// What is kept: revision, and since when.
    kept: Option<(u64, Instant)>,
    /// What is being written: the revision, or why it could not be.
    writing: Background<Result<u64, String>>,
    tried: Option<Instant>,
    /// The document that was looked for work of that a crashed program left, see [`Editor::documents`].
    looked_for: u64,
}

impl Autosave {
    /// Takes a place in `folder`, and hands what a crashed program left there to the editor.
    pub fn start(folder: Option<&Path>, editor: &mut Editor) -> Self {
        let recovery = folder.and_then(|folder| Recovery::new(folder).ok().map(Arc::new));
        let mut autosave = Self {
            recovery,
            ..Self::default()
        };
        autosave.take_up(editor);
        autosave
    }

    /// Hands the work to the editor that a crashed program left of its document; of any, if that has no file.
    fn take_up(&mut self, editor: &mut Editor) {
        let recovery = self.recovery.as_ref();
        let leftover = recovery.and_then(|recovery| recovery.take_leftover(editor.path()));
        if let Some(leftover) = leftover {
            let path = leftover.path.as_ref();
            let name = path.map_or("a new scene".to_owned(), |path| path.display().to_string());
            editor.recover(leftover);
            self.kept = Some((editor.revision(), Instant::now()));
            editor.notify(format!(
                "Glint ended with unsaved changes to {name}; here they are. Save them, or open the file again to discard them."
            ));
        }
        self.looked_for = editor.documents();
    }

    /// Since when the unsaved work is safe, if there is any.
    pub fn kept_since(&self) -> Option<Instant> {
        self.kept.map(|(_, since)| since)
    }

    /// Keeps unsaved work on disk, every few seconds while there is new work. A large scene takes longer
    /// to write than a frame: a thread of its own does it.
    pub fn tick(&mut self, ctx: &Context, editor: &mut Editor) {
        let Some(recovery) = self.recovery.clone() else {
            return;
        };
        // What is still written may be of the document before, whose file it would take up.
        if self.looked_for != editor.documents() && !self.writing.is_awaited() {
            self.looked_for = editor.documents();
            // What is edited already is not replaced.
            if editor.path().is_some() && !editor.is_dirty() {
                self.take_up(editor);
            }
        }
        self.take_written(editor);
        if self.writing.is_awaited() {
            ctx.request_repaint_after(POLL);
            return;
        }
        if !editor.is_dirty() {
            if self.kept.take().is_some() {
                recovery.clear();
            }
            return;
        }
        let revision = editor.revision();
        if self.kept.is_some_and(|(kept, _)| kept == revision) {
            return;
        }
        if let Some(wait) = self.tried.and_then(|at| INTERVAL.checked_sub(at.elapsed())) {
            ctx.request_repaint_after(wait);
            return;
        }
        self.tried = Some(Instant::now());
        let document = editor.document_to_keep();
        let (path, stamp) = (editor.path().map(Path::to_owned), editor.stamp().cloned());
        self.writing = Background::start("glint-autosave", move || {
            let text = document.to_text().map_err(|error| error.to_string())?;
            let kept = recovery.keep(&text, path.as_deref(), stamp.as_ref());
            kept.map_err(|error| error.to_string())?;
            Ok(revision)
        });
        ctx.request_repaint_after(POLL);
    }

    /// Takes up what has been written since.
    fn take_written(&mut self, editor: &mut Editor) {
        let Some(written) = self.writing.take() else {
            return;
        };
        match written.unwrap_or_else(|no_answer| Err(no_answer.to_string())) {
            Ok(revision) => self.kept = Some((revision, Instant::now())),
            Err(error) => editor.report_error(format!(
                "Unsaved changes cannot be kept safe: {error}. Save your work and make room on the disk."
            )),
        }
    }

    /// The program ends as the user wished: there is nothing to recover.
    pub fn end(&mut self) {
        // What is still being written must not be there afterwards.
        std::mem::take(&mut self.writing).finish();
        if let Some(recovery) = &self.recovery {
            recovery.clear();
        }
    }
}
