//! What is wished of files, and what comes of it.

use std::path::PathBuf;

use super::dialogs::Ask;
use crate::editor::Editor;

/// What is done once unsaved changes are out of the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Start an empty document.
    New,
    /// Start from the example in this place.
    Example(usize),
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
    /// The window may close, as far as files go.
    Quit,
    /// The window may close, whatever is going on.
    Leave,
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
