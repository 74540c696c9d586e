//! The example scenes embedded in the program.

use std::sync::Arc;

use super::file::{DEMO_TEXT, Document};
use super::whole::Scene;
use crate::mesh::read_ply;

/// An example scene.
#[derive(Debug)]
pub struct Example {
    /// File name without its extension.
    pub name: &'static str,
    text: &'static str,
    /// Contents of its mesh file, if it refers to one.
    mesh: Option<&'static [u8]>,
}

macro_rules! example {
    ($name:literal) => {
        Example {
            name: $name,
            text: include_str!(concat!("../../scenes/", $name, ".ron")),
            mesh: None,
        }
    };
}

/// All examples, the demo first.
pub const EXAMPLES: [Example; 7] = [
    Example {
        name: "demo",
        text: DEMO_TEXT,
        mesh: None,
    },
    Example {
        mesh: Some(include_bytes!("../../scenes/knot.ply")),
        ..example!("knot")
    },
    example!("mirrors"),
    example!("sunflower"),
    example!("discs"),
    example!("orthographic"),
    example!("flight"),
];

impl Example {
    /// Returns the example as a document; an empty scene if its text is invalid, which a test rules out.
    pub fn document(&self) -> Document {
        let mut document =
            Document::from_text(self.text).unwrap_or_else(|_| Document::of(Scene::empty()));
        let triangles = self
            .mesh
            .and_then(|bytes| read_ply(bytes).ok())
            .map(Arc::new);
        if let Some(triangles) = triangles {
            document.scene.change_meshes(|mesh| {
                let mut read = mesh.clone();
                read.source.set_read(Ok(Arc::clone(&triangles)));
                Some(read)
            });
        }
        document
    }

    /// Returns a one-sentence description: the first comment line of the text.
    pub fn words(&self) -> &'static str {
        let line = self.text.lines().next().unwrap_or_default();
        line.trim_start_matches("//").trim()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_scene_is_an_example_that_opens() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes");
        let files = std::fs::read_dir(folder).expect("a folder");
        let paths = files.map(|file| file.expect("a file").path());
        let scenes = paths.filter(|path| path.extension().is_some_and(|ending| ending == "ron"));
        let mut count = 0;
        for path in scenes {
            let name = path
                .file_stem()
                .expect("a name")
                .to_string_lossy()
                .into_owned();
            let example = EXAMPLES.iter().find(|example| example.name == name);
            let example = example.unwrap_or_else(|| panic!("{name} is no example"));
            let document = Document::load(&path).expect("valid");
            assert_eq!(example.document().scene, document.scene, "{name}");
            assert!(example.words().len() > 10, "{name}");
            count += 1;
        }
        assert_eq!(count, EXAMPLES.len());
    }

    #[test]
    fn saved_examples_have_their_meshes_in_them() {
        let folder = tempfile::tempdir().expect("a folder");
        for example in &EXAMPLES {
            let (document, path) = (example.document(), folder.path().join("a.ron"));
            document.save(&path).expect("saved");
            let saved = Document::load(&path).expect("valid").scene;
            assert_eq!(saved.mesh_problems().next(), None, "{}", example.name);
            assert_eq!(saved.objects_bounds(), document.scene.objects_bounds());
        }
    }
}
