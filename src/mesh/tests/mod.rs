//! Tests with real files of every format, good and broken.

mod broken;
mod mutated;
mod obj_files;
mod other_files;
mod round_trip;
mod solid;

use std::path::PathBuf;

use tempfile::TempDir;

use super::*;

/// A file in a temporary folder of its own, which is deleted with it.
struct Sample {
    folder: TempDir,
    path: PathBuf,
}

impl Sample {
    fn new(name: &str, bytes: impl AsRef<[u8]>) -> Self {
        let folder = TempDir::new().expect("a folder");
        let path = folder.path().join(name);
        let sample = Self { folder, path };
        sample.beside(name, bytes);
        sample
    }

    /// Writes another file into the same folder.
    fn beside(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.folder.path().join(name), bytes).expect("written");
    }

    fn parts(&self) -> Vec<Part> {
        read_mesh_file(&self.path).expect("a mesh").parts
    }

    fn notes(&self) -> Vec<String> {
        read_mesh_file(&self.path).expect("a mesh").notes
    }

    fn triangles(&self) -> Triangles {
        read_triangles(&self.path).expect("a mesh")
    }

    /// The error message, with the file name instead of the whole path.
    fn error(&self) -> String {
        let error = read_mesh_file(&self.path)
            .expect_err("an error")
            .to_string();
        let folder = format!("{}/", self.folder.path().display());
        assert!(error.contains(&folder), "{error}");
        error.replace(&folder, "")
    }
}

/// The error message for a file with this name and content.
fn error_of(name: &str, bytes: impl AsRef<[u8]>) -> String {
    Sample::new(name, bytes).error()
}
