//! Files that commands write.

use std::path::Path;

use super::error::CliError;
use crate::export::check_place;
use crate::files::has_ending;
use crate::image::Format;
use crate::mesh::is_mesh_file;

/// The format of a picture that is to be written, known before the first ray, as is whether it can be.
///
/// # Errors
/// [`CliError`], for an ending of no format and a place where nothing can be written.
pub fn picture_format(path: Option<&Path>) -> Result<Option<Format>, CliError> {
    let Some(path) = path else {
        return Ok(None);
    };
    let format = Format::of_path(path)?;
    check_place(path)?;
    Ok(Some(format))
}

/// Whether figures can be written as a table, if they are to be.
///
/// # Errors
/// [`CliError`], for a place where nothing can be written, and the ending of a scene, a mesh or a picture.
pub fn check_table(path: Option<&Path>) -> Result<(), CliError> {
    let Some(path) = path else {
        return Ok(());
    };
    if has_ending(path, "ron") || is_mesh_file(path) || Format::of_path(path).is_ok() {
        let path = path.display();
        let sentence = format!(
            "{path}: measurements are written as a table, not as a scene, mesh or picture; use a name ending in .csv"
        );
        return Err(CliError::usage(sentence));
    }
    Ok(check_place(path)?)
}
