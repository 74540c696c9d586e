//! Files that commands write.

use std::path::Path;

use super::error::CliError;
use crate::export::check_place;
use crate::image::Format;

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

/// Whether a text can be written, if it is to be.
///
/// # Errors
/// [`CliError`], for a place where nothing can be written.
pub fn check_text(path: Option<&Path>) -> Result<(), CliError> {
    Ok(path.map_or(Ok(()), check_place)?)
}
