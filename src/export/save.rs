//! Single pictures on disk.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use image::ImageError;

use super::error::ExportError;
use crate::files::{NewFile, remove_leftovers, write_atomic};
use crate::image::{Film, Format};

/// Size of the write buffer, in bytes.
const BUFFER: usize = 1 << 18;

/// Writes a picture in the format of the file's extension, completely or not at all.
///
/// # Errors
/// [`ExportError`]; an existing file at `path` is then untouched.
pub fn save_image(film: &Film, path: &Path) -> Result<(), ExportError> {
    save_picture(path, |format, file| film.encode(format, file))
}

/// Writes the output of `encode` for the format of the file's extension, completely or not at all.
///
/// # Errors
/// [`ExportError`]; an existing file at `path` is then untouched.
pub fn save_picture(
    path: &Path,
    encode: impl FnOnce(Format, &mut BufWriter<&File>) -> Result<(), ImageError>,
) -> Result<(), ExportError> {
    let format = Format::of_path(path)?;
    let new_file = write_beside(path, |file| encode(format, file))?;
    new_file
        .place_durably()
        .map_err(|source| disk_error(path, source))
}

/// Writes the output of `encode` to a new file beside `path`, to be moved there.
///
/// # Errors
/// [`ExportError`].
pub fn write_beside(
    path: &Path,
    encode: impl FnOnce(&mut BufWriter<&File>) -> Result<(), ImageError>,
) -> Result<NewFile, ExportError> {
    let new_file = NewFile::beside(path).map_err(|source| disk_error(path, source))?;
    let mut file = BufWriter::with_capacity(BUFFER, new_file.as_file());
    encode(&mut file).map_err(|error| match error {
        ImageError::IoError(source) => disk_error(path, source),
        source => ExportError::Encode {
            path: path.to_owned(),
            source,
        },
    })?;
    file.flush().map_err(|source| disk_error(path, source))?;
    drop(file);
    Ok(new_file)
}

/// Checks that a file can be written at `path`, before its contents are computed. Unfinished files that killed
/// programs have left beside it are removed.
///
/// # Errors
/// [`ExportError::Disk`].
pub fn check_writable(path: &Path) -> Result<(), ExportError> {
    let new_file = NewFile::beside(path).map_err(|source| disk_error(path, source))?;
    if let Some(folder) = new_file.path().parent() {
        remove_leftovers(folder);
    }
    Ok(())
}

/// Writes a text file, completely or not at all.
///
/// # Errors
/// [`ExportError::Disk`]; an existing file at `path` is then untouched.
pub fn write_text(path: &Path, text: &str) -> Result<(), ExportError> {
    write_atomic(path, text.as_bytes()).map_err(|source| disk_error(path, source))
}

/// The error for a failed write.
pub fn disk_error(path: &Path, source: io::Error) -> ExportError {
    ExportError::Disk {
        path: path.to_owned(),
        source,
    }
}
