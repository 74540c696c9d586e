//! Where the triangles of a mesh come from.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::files::{Marks, stays_inside, with_separators};
use crate::mesh::{Triangles, marks_of_mesh, read_triangles};

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
        /// Those of the file just before it was read.
        marks: Option<Marks>,
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

/// Files that the meshes of one scene refer to, and what was read of them, by their paths.
pub type MeshFiles = HashMap<String, Result<Arc<Triangles>, String>>;

impl MeshSource {
    /// Reads the triangles of a file that it refers to, which lies in `folder` or a folder in it; nothing
    /// is read outside, because a scene may come from a stranger. What is wrong is kept with the reference.
    /// What is in `files` is not read again, and what is read is added to it.
    pub fn load(&mut self, folder: Option<&Path>, files: &mut MeshFiles) {
        let Self::File {
            path,
            folder: own_folder,
            triangles,
            problem,
            marks,
        } = self
        else {
            return;
        };
        if let Some(folder) = folder {
            *path = with_separators(folder, path);
        }
        // What is not read is not looked at either.
        let allowed = folder.filter(|folder| stays_inside(folder, Path::new(path)));
        *own_folder = allowed.map(Path::to_owned);
        *marks = allowed.and_then(|folder| marks_of_mesh(&folder.join(&path)));
        let read = match folder {
            None => Err(format!(
                "cannot read {path}: the scene has no folder until it is saved"
            )),
            Some(_) if allowed.is_none() => Err(format!(
                "{path} is not read: a mesh file must be in the folder of the scene, or below it"
            )),
            Some(folder) => {
                let read = || match read_triangles(&folder.join(&path)) {
                    Ok(triangles) => Ok(Arc::new(triangles)),
                    Err(error) => Err(error.to_string()),
                };
                files.entry(path.clone()).or_insert_with(read).clone()
            }
        };
        match read {
            Ok(new) => (*triangles, *problem) = (new, None),
            Err(sentence) => (*triangles, *problem) = (Arc::default(), Some(sentence)),
        }
    }

    /// Why the file that it refers to could not be read.
    pub fn problem(&self) -> Option<&str> {
        match self {
            Self::Inline(_) => None,
            Self::File { problem, .. } => problem.as_deref(),
        }
    }

    /// The folder and the path in it of a file that was read.
    pub fn file(&self) -> Option<(&Path, &str)> {
        self.reference().filter(|_| self.problem().is_none())
    }

    /// The folder and the path in it of the file that it refers to, whether that could be read or not; `None` as well
    /// where it may not be.
    pub fn reference(&self) -> Option<(&Path, &str)> {
        match self {
            Self::File {
                path,
                folder: Some(folder),
                ..
            } => Some((folder, path)),
            _ => None,
        }
    }

    /// Those of its file, just before that was read.
    pub fn marks(&self) -> Option<Marks> {
        match self {
            Self::Inline(_) => None,
            Self::File { marks, .. } => *marks,
        }
    }

    /// A file that is not read yet.
    pub fn unread(path: String) -> Self {
        Self::File {
            path,
            folder: None,
            triangles: Arc::default(),
            problem: None,
            marks: None,
        }
    }

    /// What a file holds by now.
    pub fn read_anew(folder: &Path, path: String) -> Self {
        let mut source = Self::unread(path);
        source.load(Some(folder), &mut MeshFiles::new());
        source
    }

    /// The same with its triangles; `None` where it has them itself, or they could not be read.
    pub fn taken_in(&self) -> Option<Self> {
        match self {
            Self::File {
                triangles,
                problem: None,
                ..
            } if !triangles.faces().is_empty() => Some(Self::Inline(Arc::clone(triangles))),
            _ => None,
        }
    }

    /// A stand-in that is written in few words and is another one for other triangles.
    pub fn abridged(&self) -> Self {
        Self::unread(self.triangles().fingerprint().to_string())
    }

    /// The triangles; none where a file could not be read.
    pub fn triangles(&self) -> &Arc<Triangles> {
        match self {
            Self::Inline(triangles) | Self::File { triangles, .. } => triangles,
        }
    }
}
