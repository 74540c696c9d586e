//! File operations that the user requested, and their outcomes.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::commands::Next;
use super::dialogs::Ask;
use super::outside::ExternalVersion;
use super::prompts::PathPrompt;
use crate::editor::Editor;
use crate::worker::Background;

/// A dialog that returns nothing sooner than a user could cancel it was never shown.
const MIN_DIALOG_TIME: Duration = Duration::from_millis(400);

/// The outcome of a file operation, for the window to act on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileOutcome {
    /// The window may close as far as the document is concerned.
    AskToQuit,
    /// The window may close, whatever else is running.
    Quit,
    /// The still picture is to be traced and written to this path.
    SaveImage(PathBuf),
    /// Frames are to be exported to this folder.
    ExportFolder(PathBuf),
}

/// A path that is wanted, and what follows once it is known.
#[derive(Clone)]
pub struct PathRequest {
    /// The purpose of the path.
    pub ask: Ask,
    /// What follows.
    pub then: Option<Next>,
    /// The document it was requested for, see [`Editor::documents`].
    pub document: u64,
    /// The document's revision at that time.
    pub revision: u64,
}

impl PathRequest {
    /// Creates a request for the document in its current state.
    pub fn new(editor: &Editor, ask: Ask, then: Option<Next>) -> Self {
        Self {
            ask,
            then,
            document: editor.documents(),
            revision: editor.revision(),
        }
    }
}

/// A question shown over the window.
pub enum Prompt {
    /// Whether to save unsaved changes.
    Unsaved(Next),
    /// The answer was to save, which waits until a recorded flight has become keys.
    Saving(Next),
    /// Whether to quit.
    Quit,
    /// Which file, if the desktop offers no dialog.
    Path(PathRequest, PathPrompt),
    /// What to do about a file that another program has changed; with the request to save that revealed it, if any.
    Outside(Box<ExternalVersion>, Option<PathRequest>),
}

/// A desktop dialog that is open.
pub struct OpenDialog {
    /// The request it is for.
    pub request: PathRequest,
    answer: Background<Option<PathBuf>>,
    since: Instant,
}

/// The state of a desktop dialog.
pub enum DialogState {
    /// No answer yet.
    NotYet,
    /// A path was chosen.
    Path(PathBuf),
    /// The user cancelled it.
    Cancelled,
    /// It never opened: this desktop has no dialogs.
    NoDialog,
}

impl OpenDialog {
    /// Wraps a dialog that has just been opened.
    pub fn new(request: PathRequest, answer: Background<Option<PathBuf>>) -> Self {
        let since = Instant::now();
        Self {
            request,
            answer,
            since,
        }
    }

    /// Returns the answer of the dialog, if there is one.
    pub fn poll(&mut self) -> DialogState {
        match self.answer.take() {
            None => DialogState::NotYet,
            Some(Ok(Some(path))) => DialogState::Path(path),
            Some(_) if self.since.elapsed() < MIN_DIALOG_TIME => DialogState::NoDialog,
            Some(_) => DialogState::Cancelled,
        }
    }
}
