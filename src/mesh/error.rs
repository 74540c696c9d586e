//! Why a mesh file could not be read.

use std::io;
use std::path::{Path, PathBuf};

/// Why a mesh file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file name says no known format.
    #[error("{path}: not a mesh file; their names end in .obj, .stl, .ply, .gltf or .glb", path = .path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The disk said no.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },
    /// The file is larger than any that is read.
    #[error("{path}: a mesh file may have at most {limit} bytes; this one has more", path = .path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The most that is read.
        limit: u64,
    },
    /// There is more in the file than is read.
    #[error("{path}: a mesh may have at most {limit} {what}; this one has more", path = .path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
        /// Of what there are too many.
        what: &'static str,
        /// The most that is read.
        limit: usize,
    },
    /// There is no triangle in the file that has an area.
    #[error("{path}: this file has no faces with an area", path = .path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is not what its ending says, or is broken.
    #[error("{path}{place}: {why}", path = .path.display(), place = .line.map(|line| format!(":{line}")).unwrap_or_default())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Line, from 1, of a text file.
        line: Option<usize>,
        /// What is wrong and what was expected, without a full stop.
        why: String,
    },
}

/// What is wrong inside a file, before its name is known.
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
    /// Something is wrong that has no line.
    pub(super) fn new(why: impl Into<String>) -> Self {
        let (line, why) = (None, why.into());
        Self::Refused { line, why }
    }

    /// Something is wrong in a line, counted from 1.
    pub(super) fn in_line(line: usize, why: impl Into<String>) -> Self {
        let (line, why) = (Some(line), why.into());
        Self::Refused { line, why }
    }

    /// The error, now that the file's name is known.
    pub(super) fn of(self, path: &Path) -> MeshError {
        let path = path.to_owned();
        match self {
            Self::TooMany { what, limit } => MeshError::TooMany { path, what, limit },
            Self::Refused { line, why } => {
                // Names in a file may be of any length and hold anything.
                let why = excerpt(&why, LONGEST);
                MeshError::Refused { path, line, why }
            }
        }
    }
}

/// Most characters of a sentence.
const LONGEST: usize = 240;

/// At most so many characters of a text, on one line.
pub(super) fn excerpt(text: &str, most: usize) -> String {
    let mut characters = text.chars();
    let mut shown: String = characters
        .by_ref()
        .take(most)
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if characters.next().is_some() {
        shown.push('…');
    }
    shown
}
