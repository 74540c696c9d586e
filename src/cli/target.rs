//! Checks of the files that commands are to write.

use std::path::Path;

use super::error::CliError;
use crate::export::check_writable;
use crate::files::has_ending;
use crate::image::Format;
use crate::mesh::is_mesh_file;

/// Returns the format of a picture, and checks that it can be written, before anything is traced.
///
/// # Errors
/// [`CliError`], if the extension is of no known format, or if nothing can be written there.
pub fn picture_format(path: Option<&Path>) -> Result<Option<Format>, CliError> {
    let Some(path) = path else {
        return Ok(None);
    };
    let format = Format::of_path(path)?;
    check_writable(path)?;
    Ok(Some(format))
}

/// Checks that measurements can be written to this file, if there is one.
///
/// # Errors
/// [`CliError`], if nothing can be written there, or if the extension is that of a scene, a mesh or a picture.
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
    Ok(check_writable(path)?)
}
