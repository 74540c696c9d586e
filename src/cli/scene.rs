//! Reading of scenes for commands.

use std::collections::BTreeMap;
use std::path::Path;

use super::error::{CliError, report_warning};
use crate::scene::{Document, PathStep, Scene, message_at};
use crate::words::counted;

/// Reads a scene. Objects whose meshes are missing are reported on stderr; the rest is kept.
///
/// # Errors
/// [`CliError::Usage`], if the file is not a valid scene.
pub fn read_scene(path: &Path) -> Result<Scene, CliError> {
    let scene = Document::load(path)?.scene;
    for problem in missing_meshes(path, &scene, "") {
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
    let consequence = ", and no frame is made without it";
    let problems = missing_meshes(path, &document.scene, consequence);
    match problems.into_iter().next() {
        None => Ok(document),
        Some(problem) => Err(CliError::failed(problem)),
    }
}

/// A message for each mesh file that could not be read, at the place of the first object that needs it; `consequence`
/// is added to what is said of that.
pub fn missing_meshes(path: &Path, scene: &Scene, consequence: &str) -> Vec<String> {
    let mut files: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, why) in scene.mesh_problems() {
        files.entry(why).or_default().push(index);
    }
    let message = |(why, objects): (&str, Vec<usize>)| {
        let first = objects[0];
        let name = &scene.objects[first].name;
        let names = match objects.len() - 1 {
            0 => format!("{name:?}"),
            more => format!("{name:?} and {}", counted(more, "more object")),
        };
        let part = [PathStep::Field("objects"), PathStep::Index(first)];
        let sentence = format!("{names} cannot be shown{consequence}: {why}");
        message_at(path, &part, sentence)
    };
    files.into_iter().map(message).collect()
}
