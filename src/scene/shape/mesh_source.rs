//! Sources of the triangles of meshes.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::files::{Marks, stays_inside, with_separators};
use crate::mesh::{Triangles, marks_of_mesh, read_triangles};

/// The source of the triangles of a mesh.
#[derive(Clone, Debug)]
pub enum MeshSource {
    /// Triangles written in the scene file.
    Inline(Arc<Triangles>),
    /// Triangles in a file of their own.
    File {
        /// Path relative to the folder of the scene file.
        path: String,
        /// The folder of the scene file, once it is known.
        folder: Option<PathBuf>,
        /// The triangles read from the file.
        triangles: Arc<Triangles>,
        /// Why the file could not be read, as a sentence without its full stop.
        problem: Option<String>,
        /// Modification time and length of the file just before it was read.
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

/// Results of reading the mesh files of a scene, by path.
pub type MeshFiles = HashMap<String, Result<Arc<Triangles>, String>>;

impl MeshSource {
    /// Reads the triangles of the file, if the source is one. It must be in `folder` or a folder below: nothing
    /// outside is read, because the scene may come from an untrusted source. On failure, the problem is stored with
    /// the reference. Files in `files` are not read again; what is read is added there.
    pub fn load(&mut self, folder: Option<&Path>, files: &mut MeshFiles) {
        let Self::File {
            path,
            folder: own_folder,
            marks,
            ..
        } = self
        else {
            return;
        };
        if let Some(folder) = folder {
            *path = with_separators(folder, path);
        }
        // The metadata of files outside the folder is not read either.
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
                let read = || read_triangles(&folder.join(&path)).map(Arc::new);
                let read = || read().map_err(|error| error.to_string());
                files.entry(path.clone()).or_insert_with(read).clone()
            }
        };
        self.set_read(read);
    }

    /// Stores the triangles of the file, or why it could not be read, if the source is a file.
    pub fn set_read(&mut self, read: Result<Arc<Triangles>, String>) {
        if let Self::File {
            triangles, problem, ..
        } = self
        {
            (*triangles, *problem) = match read {
                Ok(new) => (new, None),
                Err(sentence) => (Arc::default(), Some(sentence)),
            };
        }
    }

    /// Why the file could not be read, if it could not.
    pub fn problem(&self) -> Option<&str> {
        match self {
            Self::Inline(_) => None,
            Self::File { problem, .. } => problem.as_deref(),
        }
    }

    /// Returns folder and relative path of a file that was read.
    pub fn file(&self) -> Option<(&Path, &str)> {
        self.reference().filter(|_| self.problem().is_none())
    }

    /// Returns folder and relative path of the file, whether it could be read or not; `None` also if it is outside
    /// the folder.
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

    /// Modification time and length of the file just before it was read.
    pub fn marks(&self) -> Option<Marks> {
        match self {
            Self::Inline(_) => None,
            Self::File { marks, .. } => *marks,
        }
    }

    /// Creates a reference to a file that is not read yet.
    pub fn unread(path: String) -> Self {
        Self::File {
            path,
            folder: None,
            triangles: Arc::default(),
            problem: None,
            marks: None,
        }
    }

    /// Reads a file in its current state.
    pub fn read_anew(folder: &Path, path: String) -> Self {
        let mut source = Self::unread(path);
        source.load(Some(folder), &mut MeshFiles::new());
        source
    }

    /// Returns the triangles of a file as an inline source; `None` if the source is inline already, or could not be
    /// read.
    pub fn inlined(&self) -> Option<Self> {
        match self {
            Self::File {
                triangles,
                problem: None,
                ..
            } if !triangles.faces().is_empty() => Some(Self::Inline(Arc::clone(triangles))),
            _ => None,
        }
    }

    /// Returns a short stand-in for comparing scenes: it is different for different triangles.
    pub fn abridged(&self) -> Self {
        Self::unread(self.triangles().fingerprint().to_string())
    }

    /// The triangles; empty if the file could not be read.
    pub fn triangles(&self) -> &Arc<Triangles> {
        match self {
            Self::Inline(triangles) | Self::File { triangles, .. } => triangles,
        }
    }
}

/// Number of bytes of the triangles that are only among the first of these sources.
pub fn unshared_triangle_bytes<'a>(
    own: impl Iterator<Item = &'a MeshSource>,
    others: impl Iterator<Item = &'a MeshSource>,
) -> usize {
    let by_address = |source: &'a MeshSource| {
        let triangles = source.triangles();
        (Arc::as_ptr(triangles), triangles.bytes())
    };
    let mut own: HashMap<_, usize> = own.map(by_address).collect();
    for (address, _) in others.map(by_address) {
        own.remove(&address);
    }
    own.into_values().sum()
}
