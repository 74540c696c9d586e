//! Scenes that commands read.

use std::path::Path;

use super::error::{CliError, report_warning};
use crate::scene::{Document, Scene};

/// Reads a scene. What is missing in it is said on stderr, once, and the rest is there.
///
/// # Errors
/// [`CliError::Usage`], for a file that is no scene.
pub fn read_scene(path: &Path) -> Result<Scene, CliError> {
    let scene = Document::load(path)?.scene;
    for problem in missing_meshes(path, &scene) {
        report_warning(&problem);
    }
    Ok(scene)
}

/// Reads a scene of which frames are made: a farm would take those without a mesh for good ones.
///
/// # Errors
/// [`CliError::Usage`], for a file that is no scene; [`CliError::Failed`], if a mesh of it could not be read.
pub fn read_whole_document(path: &Path) -> Result<Document, CliError> {
    let document = Document::load(path)?;
    match missing_meshes(path, &document.scene).first() {
        None => Ok(document),
        Some(problem) => {
            let sentence = format!("{problem}; no frame is made without it");
            Err(CliError::failed(sentence))
        }
    }
}

/// A line for each object whose mesh could not be read.
pub fn missing_meshes(path: &Path, scene: &Scene) -> Vec<String> {
    let said = |(index, why): (usize, &str)| {
        let name = &scene.objects[index].name;
        format!("{}: {name:?} cannot be shown: {why}", path.display())
    };
    scene.mesh_problems().map(said).collect()
}
