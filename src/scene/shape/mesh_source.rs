//! Where the triangles of a mesh come from.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::files::stays_inside;
use crate::mesh::{Triangles, read_triangles};

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
        } = self
        else {
            return;
        };
        *own_folder = folder.map(Path::to_owned);
        let read = match folder {
            None => Err(format!(
                "cannot read {path}: the scene has no folder before it is saved"
            )),
            Some(folder) if !stays_inside(folder, Path::new(path)) => Err(format!(
                "{path} is not read: a mesh file must lie in the folder of the scene, or in one within it"
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

    /// The same in a scene file of this folder: triangles that were read from elsewhere are taken in.
    pub fn taken_to(&self, folder: &Path) -> Self {
        match self {
            Self::File { folder: own, .. } if own.as_deref() != Some(folder) => self.taken_in(),
            _ => self.clone(),
        }
    }

    /// The folder and the path in it of a file that was read.
    pub fn file(&self) -> Option<(&Path, &str)> {
        self.reference().filter(|_| self.problem().is_none())
    }

    /// The folder and the path in it of the file that it refers to, whether that could be read or not.
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

    /// What a file holds by now.
    pub fn read_anew(folder: &Path, path: &str) -> Self {
        let mut source = Self::File {
            path: path.to_owned(),
            folder: None,
            triangles: Arc::default(),
            problem: None,
        };
        source.load(Some(folder), &mut MeshFiles::new());
        source
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
