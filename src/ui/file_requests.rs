//! What is wished of files, and what comes of it.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use super::commands::Next;
use super::dialogs::Ask;
use super::outside::Theirs;
use super::prompts::PathPrompt;
use crate::editor::Editor;
use crate::worker::Background;

/// A dialog that comes back empty sooner than a hand can cancel it was never shown.
const NO_DIALOG: Duration = Duration::from_millis(400);

/// What became of the wishes, for the window to act on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileOutcome {
    /// The window may close, as far as the document goes.
    AskToQuit,
    /// The window may close, whatever is going on.
    Quit,
    /// The still picture is to be traced and written here.
    SaveImage(PathBuf),
    /// Frames are to be written here.
    ExportFolder(PathBuf),
}

/// A path that is wanted, and what follows when it is there.
#[derive(Clone)]
pub struct PathRequest {
    /// What for.
    pub ask: Ask,
    /// What follows.
    pub then: Option<Next>,
    /// The document that was asked about.
    pub document: u64,
    /// Its state then.
    pub revision: u64,
}

impl PathRequest {
    /// About a document as it is now.
    pub fn new(editor: &Editor, ask: Ask, then: Option<Next>) -> Self {
        Self {
            ask,
            then,
            document: editor.documents(),
            revision: editor.revision(),
        }
    }
}

/// A question over the window.
pub enum Prompt {
    /// What becomes of unsaved changes.
    Unsaved(Next),
    /// The answer was to save: as soon as a recorded flight has become keys.
    Saving(Next),
    /// Whether quitting is meant.
    Quit,
    /// Which file, where the desktop has no dialog for that.
    Path(PathRequest, PathPrompt),
    /// Another program has written the file; the wish is to save, if it is one.
    Outside(Box<Theirs>, Option<PathRequest>),
}

/// A desktop dialog that is open.
pub struct Waiting {
    /// What it asks for.
    pub wish: PathRequest,
    answer: Background<Option<PathBuf>>,
    since: Instant,
}

/// What a desktop dialog has answered.
pub enum Answered {
    /// Nothing yet.
    NotYet,
    /// A path.
    Path(PathBuf),
    /// That there is none.
    Cancelled,
    /// Nothing: this desktop has no dialogs.
    NoDialog,
}

impl Waiting {
    /// One that has just been opened.
    pub fn new(wish: PathRequest, answer: Background<Option<PathBuf>>) -> Self {
        let since = Instant::now();
        Self {
            wish,
            answer,
            since,
        }
    }

    /// What it has answered.
    pub fn answered(&mut self) -> Answered {
        match self.answer.take() {
            None => Answered::NotYet,
            Some(Ok(Some(path))) => Answered::Path(path),
            Some(_) if self.since.elapsed() < NO_DIALOG => Answered::NoDialog,
            Some(_) => Answered::Cancelled,
        }
    }
}
