//! Decides what to do with files that are dropped onto the window together.

use std::path::PathBuf;

use crate::files::has_ending;
use crate::mesh::is_mesh_file;

/// What to do with dropped files.
#[derive(Debug, PartialEq, Eq)]
pub enum Dropped {
    /// Open this one; meshes dropped with it are those that it refers to.
    Scene(PathBuf),
    /// Import these meshes and this flight. Files dropped with them, such as materials and textures, are read along.
    Parts {
        /// Mesh files.
        meshes: Vec<PathBuf>,
        /// Keys of a camera.
        path: Option<PathBuf>,
    },
    /// None of them can be read; this is the first.
    Unknown(PathBuf),
}

impl Dropped {
    /// Decides what to do with these files; `None` if there are none.
    pub fn of(files: &[PathBuf]) -> Option<Self> {
        let first_with = |ending: &str| {
            let mut files = files.iter();
            files.find(|file| has_ending(file, ending)).cloned()
        };
        let meshes = files.iter().filter(|file| is_mesh_file(file));
        let meshes: Vec<_> = meshes.cloned().collect();
        let (scene, path) = (first_with("ron"), first_with("csv"));
        match (scene, path) {
            (Some(scene), _) => Some(Self::Scene(scene)),
            (None, None) if meshes.is_empty() => files.first().cloned().map(Self::Unknown),
            (None, path) => Some(Self::Parts { meshes, path }),
        }
    }

    /// Returns the number of scenes and tables among the files that are not used. Other files are read along with the
    /// used ones or concern other programs.
    pub fn unused_count(&self, files: &[PathBuf]) -> usize {
        let is_wanted = |file: &&PathBuf| has_ending(file, "ron") || has_ending(file, "csv");
        let wanted = files.iter().filter(is_wanted).count();
        let used = match self {
            Self::Scene(scene) => is_wanted(&scene),
            Self::Parts { path, .. } => path.is_some(),
            Self::Unknown(_) => false,
        };
        wanted - usize::from(used)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_of_a_model_is_its_mesh_and_that_of_a_scene_the_scene() {
        let dropped = |names: &[&str]| {
            let files: Vec<_> = names.iter().map(PathBuf::from).collect();
            Dropped::of(&files)
        };
        let parts = |meshes: &[&str], path: Option<&str>| {
            let meshes = meshes.iter().map(PathBuf::from).collect();
            let path = path.map(PathBuf::from);
            Some(Dropped::Parts { meshes, path })
        };
        let scene = |name: &str| Some(Dropped::Scene(name.into()));
        assert_eq!(dropped(&[]), None);
        assert_eq!(
            dropped(&["a.mtl", "a.OBJ", "a.png"]),
            parts(&["a.OBJ"], None)
        );
        assert_eq!(
            dropped(&["a.ply", "b.stl", "c.CSV"]),
            parts(&["a.ply", "b.stl"], Some("c.CSV"))
        );
        assert_eq!(dropped(&["a.ply", "s.ron"]), scene("s.ron"));
        let unknown = Dropped::Unknown("a.txt".into());
        assert_eq!(dropped(&["a.txt", "b.txt"]), Some(unknown));
        let left = |names: &[&str]| {
            let files: Vec<_> = names.iter().map(PathBuf::from).collect();
            Dropped::of(&files).map(|dropped| dropped.unused_count(&files))
        };
        assert_eq!(left(&["a.obj", "a.mtl", "a.png", "p.csv"]), Some(0));
        assert_eq!(left(&["a.ron", "b.ron", "p.csv", "a.ply"]), Some(2));
        assert_eq!(left(&["a.csv", "b.csv"]), Some(1));
        assert_eq!(left(&["a.txt"]), Some(0));
    }
}
