//! Reading of scenes for commands.

use std::path::Path;

use super::error::{CliError, report_warning};
use crate::scene::{Document, Scene};

/// Reads a scene. Objects whose meshes are missing are reported on stderr; the rest is kept.
///
/// # Errors
/// [`CliError::Usage`], if the file is not a valid scene.
pub fn read_scene(path: &Path) -> Result<Scene, CliError> {
    let scene = Document::load(path)?.scene;
    for problem in missing_meshes(path, &scene) {
        report_warning(&problem);
    }
    Ok(scene)
}

/// Reads a scene for tracing frames. Missing meshes are an error, because a render farm would take frames without
/// them for good ones.
///
/// # Errors
/// [`CliError::Usage`], if the file is not a valid scene; [`CliError::Failed`], if one of its meshes could not be
/// read.
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

/// A message for each object whose mesh could not be read.
pub fn missing_meshes(path: &Path, scene: &Scene) -> Vec<String> {
    let message = |(index, why): (usize, &str)| {
        let name = &scene.objects[index].name;
        format!("{}: {name:?} cannot be shown: {why}", path.display())
    };
    scene.mesh_problems().map(message).collect()
}
