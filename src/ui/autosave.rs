//! Keeps unsaved work safe while the program runs, and recovers it after a crash.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;

use crate::editor::Editor;
use crate::scene::Recovery;
use crate::worker::Background;

/// Time between two autosaves.
const INTERVAL: Duration = Duration::from_secs(5);

/// Time between two checks whether a write has finished.
const POLL: Duration = Duration::from_millis(100);

/// Subject of the messages about failed autosaves.
const AUTOSAVE: &str = "Autosave";

/// The state of autosaving.
#[derive(Default)]
pub struct Autosave {
    /// Folder for unsaved work; `None` disables autosaving.
    folder: Option<PathBuf>,
    /// This program's own recovery file in it, once there is one.
    recovery: Option<Arc<Recovery>>,
    /// Revision that is on disk, and since when.
    kept: Option<(u64, Instant)>,
    /// Write in progress: yields the revision, or why it failed.
    writing: Background<Result<u64, String>>,
    tried: Option<Instant>,
    /// Why nothing could be kept, as last reported.
    why: Option<String>,
    /// Document for which work left by a crash was last looked for, see [`Editor::documents`].
    looked_for: u64,
}

impl Autosave {
    /// Creates a recovery file in `folder`, and hands work left there by a crashed program to the editor.
    pub fn start(folder: Option<&Path>, editor: &mut Editor) -> Self {
        let recovery = folder.and_then(|folder| Recovery::new(folder).ok().map(Arc::new));
        let mut autosave = Self {
            folder: folder.map(Path::to_owned),
            recovery,
            ..Self::default()
        };
        autosave.take_up(editor);
        autosave
    }

    /// Hands the editor the work that a crash left for its document, or for any if its document has no file.
    fn take_up(&mut self, editor: &mut Editor) {
        let recovery = self.recovery.as_ref();
        let leftover = recovery.and_then(|recovery| recovery.take_leftover(editor.path()));
        if let Some(leftover) = leftover {
            let path = leftover.path.as_ref();
            let name = path.map_or("a new scene".to_owned(), |path| path.display().to_string());
            let discard = path.map_or(
                "choose New in the File menu to discard them",
                |_| "open the file again to discard them",
            );
            editor.recover(leftover);
            self.kept = Some((editor.revision(), Instant::now()));
            editor.notify(format!(
                "Glint ended with unsaved changes to {name}; they are restored here. Save them, or {discard}."
            ));
        }
        self.looked_for = editor.documents();
    }

    /// Time since which the unsaved work is safe, if there is any.
    pub fn kept_since(&self) -> Option<Instant> {
        self.kept.map(|(_, since)| since)
    }

    /// Keeps unsaved work on disk, every few seconds while it changes. Writing a large scene takes longer than a frame,
    /// so it happens on a separate thread.
    pub fn tick(&mut self, ctx: &Context, editor: &mut Editor) {
        let Some(recovery) = self.recovery.clone() else {
            return self.take_place(ctx, editor);
        };
        // A pending write may be of the previous document, and would overwrite the recovered work.
        if self.looked_for != editor.documents() && !self.writing.is_awaited() {
            self.looked_for = editor.documents();
            // A document that has been edited already is not replaced.
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
            return self.tell(editor, None);
        }
        let revision = editor.revision();
        if self.kept.is_some_and(|(kept, _)| kept == revision) {
            return;
        }
        if !self.may_try(ctx) {
            return;
        }
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

    /// Handles a write that has finished.
    fn take_written(&mut self, editor: &mut Editor) {
        let Some(written) = self.writing.take() else {
            return;
        };
        match written.unwrap_or_else(|no_answer| Err(no_answer.to_string())) {
            Ok(revision) => {
                self.kept = Some((revision, Instant::now()));
                self.tell(editor, None);
            }
            Err(error) => self.tell(editor, Some(error)),
        }
    }

    /// Tries once more to create the recovery file if that failed when the program began.
    fn take_place(&mut self, ctx: &Context, editor: &mut Editor) {
        let Some(folder) = self.folder.clone() else {
            return;
        };
        if !editor.is_dirty() {
            return self.tell(editor, None);
        }
        if !self.may_try(ctx) {
            return;
        }
        match Recovery::new(&folder) {
            Ok(place) => {
                (self.recovery, self.tried) = (Some(Arc::new(place)), None);
                self.tell(editor, None);
                ctx.request_repaint();
            }
            Err(error) => self.tell(editor, Some(error.to_string())),
        }
    }

    /// Returns whether the last attempt is long enough ago for another one, which counts from now on.
    fn may_try(&mut self, ctx: &Context) -> bool {
        if let Some(wait) = self.tried.and_then(|at| INTERVAL.checked_sub(at.elapsed())) {
            ctx.request_repaint_after(wait);
            return false;
        }
        self.tried = Some(Instant::now());
        true
    }

    /// Reports why work cannot be kept, once for each reason, and clears the report once it can.
    fn tell(&mut self, editor: &mut Editor, why: Option<String>) {
        if self.why == why {
            return;
        }
        editor.begin(AUTOSAVE);
        if let Some(why) = &why {
            editor.report_error_in(
                AUTOSAVE,
                format!("Unsaved changes cannot be autosaved: {why}. Save your work."),
            );
        }
        self.why = why;
    }

    /// Removes the recovery file: the program ends normally, so there is nothing to recover.
    pub fn end(&mut self) {
        // A pending write must not create it again afterwards.
        std::mem::take(&mut self.writing).finish();
        if let Some(recovery) = &self.recovery {
            recovery.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::{Action, Edit};

    #[test]
    fn that_there_is_no_place_is_told_as_long_as_that_is_so() {
        let (ctx, folder) = (Context::default(), tempfile::tempdir().expect("a folder"));
        let place = folder.path().join("data");
        std::fs::write(&place, "no folder").expect("written");
        let mut editor = Editor::demo();
        let mut autosave = Autosave::start(Some(&place), &mut editor);
        autosave.tick(&ctx, &mut editor);
        assert_eq!(
            editor.take_error(AUTOSAVE),
            None,
            "there is nothing to keep"
        );
        editor.apply(Action::Edit(Edit::Ambient(0.1)));
        autosave.tick(&ctx, &mut editor);
        assert!(editor.take_error(AUTOSAVE).is_some());
        editor.apply(Action::Undo);
        autosave.tick(&ctx, &mut editor);
        assert_eq!(autosave.why, None);
        editor.apply(Action::Redo);
        std::fs::remove_file(&place).expect("removed");
        autosave.tried = None;
        autosave.tick(&ctx, &mut editor);
        assert!(autosave.recovery.is_some() && autosave.why.is_none());
    }
}
