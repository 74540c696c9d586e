//! Where the triangles of a mesh come from.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::mesh::Triangles;

/// Where the triangles of a mesh come from.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// The scene file.
    Inline(Arc<Triangles>),
    /// A file of their own.
    File {
        /// Its path from the folder of the scene file.
        path: String,
        /// That folder, once it is known.
        folder: Option<PathBuf>,
        /// What was read.
        triangles: Arc<Triangles>,
        /// Why nothing was read, as a sentence without its full stop.
        problem: Option<String>,
    },
}

impl PartialEq for MeshSource {
    fn eq(&self, other: &Self) -> bool {
        let is_same = || {
            let (ours, theirs) = (self.triangles(), other.triangles());
            Arc::ptr_eq(ours, theirs) || ours == theirs
        };
        match (self, other) {
            (Self::Inline(_), Self::Inline(_)) => is_same(),
            (
                Self::File { path, problem, .. },
                Self::File {
                    path: their_path,
                    problem: their_problem,
                    ..
                },
            ) => path == their_path && problem == their_problem && is_same(),
            _ => false,
        }
    }
}

impl MeshSource {
    /// Why the file that it refers to could not be read.
    pub fn problem(&self) -> Option<&str> {
        match self {
            Self::Inline(_) => None,
            Self::File { problem, .. } => problem.as_deref(),
        }
    }

    /// The same in a scene file of this folder: triangles that were read from elsewhere are taken in.
    pub fn taken_to(&self, folder: &Path) -> Self {
        match self {
            Self::File { folder: own, .. } if own.as_deref() != Some(folder) => self.taken_in(),
            _ => self.clone(),
        }
    }

    /// The same with its triangles, wherever they were read.
    pub fn taken_in(&self) -> Self {
        match self {
            Self::File {
                triangles,
                problem: None,
                ..
            } if !triangles.faces().is_empty() => Self::Inline(Arc::clone(triangles)),
            _ => self.clone(),
        }
    }

    /// A stand-in that is written in few words and is another one for other triangles.
    pub fn abridged(&self) -> Self {
        Self::File {
            path: self.triangles().fingerprint().to_string(),
            folder: None,
            triangles: Arc::default(),
            problem: None,
        }
    }

    /// The triangles; none where a file could not be read.
    pub fn triangles(&self) -> &Arc<Triangles> {
        match self {
            Self::Inline(triangles) | Self::File { triangles, .. } => triangles,
        }
    }
}
