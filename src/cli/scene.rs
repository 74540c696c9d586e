//! Reading of scenes for commands.

use std::collections::BTreeMap;
use std::path::Path;

use super::error::{CliError, report_warning};
use crate::scene::{Document, Scene, messages_about_objects};
use crate::words::counted;

/// Most mesh files that are reported one by one.
const MAX_MESSAGES: usize = 100;

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

/// A message for each mesh file that could not be read, up to 100 of them, at the place of the first object that
/// needs it; `consequence` is added to what is said of that.
pub fn missing_meshes(path: &Path, scene: &Scene, consequence: &str) -> Vec<String> {
    let mut files: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, why) in scene.mesh_problems() {
        files.entry(why).or_default().push(index);
    }
    let more = files.len().saturating_sub(MAX_MESSAGES);
    let sentence = |(why, objects): (&str, Vec<usize>)| {
        let first = objects[0];
        let name = &scene.objects[first].name;
        let names = match objects.len() - 1 {
            0 => format!("{name:?}"),
            more => format!("{name:?} and {}", counted(more, "more object")),
        };
        let sentence = format!("{names} cannot be shown{consequence}: {why}");
        (first, sentence)
    };
    if files.is_empty() {
        return Vec::new();
    }
    let sentences = files.into_iter().take(MAX_MESSAGES).map(sentence);
    let mut messages = messages_about_objects(path, sentences.collect());
    if more > 0 {
        let files = counted(more, "more mesh file");
        messages.push(format!("{}: {files} could not be read", path.display()));
    }
    messages
}
