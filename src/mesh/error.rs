//! Errors of reading mesh files.

use std::io;
use std::path::{Path, PathBuf};

/// Error of reading a mesh file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file name has no known extension.
    #[error("{path}: not a mesh file; their names end in .obj, .stl, .ply, .gltf or .glb", path = .path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The file could not be read from disk.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
    /// The file is larger than the limit.
    #[error("{path}: a mesh file may have at most {limit} bytes; this one has more", path = .path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The limit in bytes.
        limit: u64,
    },
    /// The file has more elements of some kind than the limit.
    #[error("{path}: a mesh may have at most {limit} {what}; this one has more", path = .path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
        /// The kind of element, in the plural.
        what: &'static str,
        /// The limit.
        limit: usize,
    },
    /// The file has no triangle with an area.
    #[error("{path}: this file has no faces with an area", path = .path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is not in the format of its extension, or is broken.
    #[error("{path}{place}: {why}", path = .path.display(), place = .line.map(|line| format!(":{line}")).unwrap_or_default())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Line of a text file, counted from 1.
        line: Option<usize>,
        /// What is wrong and what was expected, without a full stop.
        why: String,
    },
}

/// What is wrong with the contents of a file; it becomes a [`MeshError`] together with the file's path.
#[derive(Debug)]
pub(super) enum Fault {
    TooMany { what: &'static str, limit: usize },
    Refused { line: Option<usize>, why: String },
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::TooMany { what, limit } => write!(f, "a mesh may have at most {limit} {what}"),
            Self::Refused { why, .. } => f.write_str(why),
        }
    }
}

impl Fault {
    /// A fault without a line.
    pub(super) fn new(why: impl Into<String>) -> Self {
        let (line, why) = (None, why.into());
        Self::Refused { line, why }
    }

    /// A fault in a line, counted from 1.
    pub(super) fn in_line(line: usize, why: impl Into<String>) -> Self {
        let (line, why) = (Some(line), why.into());
        Self::Refused { line, why }
    }

    /// Adds the path of the file.
    pub(super) fn with_path(self, path: &Path) -> MeshError {
        let path = path.to_owned();
        match self {
            Self::TooMany { what, limit } => MeshError::TooMany { path, what, limit },
            Self::Refused { line, why } => {
                // Names quoted from a file may be of any length and hold any character.
                let why = excerpt(&why, MAX_MESSAGE_CHARS);
                MeshError::Refused { path, line, why }
            }
        }
    }
}

/// Most characters of an error message.
const MAX_MESSAGE_CHARS: usize = 240;
/// Most characters of a word that a message quotes.
pub(super) const MAX_WORD_CHARS: usize = 24;
/// Most characters of a file name in a message.
pub(super) const MAX_NAME_CHARS: usize = 80;

/// Returns at most `max_chars` characters of a text, with control characters replaced by spaces; `…` marks a cut.
pub(super) fn excerpt(text: &str, max_chars: usize) -> String {
    let mut characters = text.chars();
    let mut shown: String = characters
        .by_ref()
        .take(max_chars)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if characters.next().is_some() {
        shown.push('…');
    }
    shown
}
