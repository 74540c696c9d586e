//! Pictures on disk: single ones, and sequences that can be taken up where they were left.

mod frames;
mod job;
mod manifest;
mod pattern;
mod sequence;
mod video;

use std::io;
use std::path::{Path, PathBuf};

pub use frames::Frames;
pub use job::job_template;
pub use manifest::{Hash, MANIFEST, Manifest};
pub use pattern::Pattern;
pub use sequence::Sequence;
pub use video::{Video, VideoError};

use crate::files::write_atomic;
use crate::image::{Format, FormatError, Image};

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The file name says no known format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The picture could not be encoded.
    #[error("cannot encode {path}: {source}", path = .path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        source: image::ImageError,
    },
    /// The scene cannot be put into words, which its fingerprint is made of.
    #[error("the scene cannot be written: {0}")]
    Unwritable(#[from] ron::Error),
    /// The disk said no.
    #[error("cannot write {path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },
}

/// Writes a picture in the format of the file's ending, whole or not at all.
///
/// # Errors
/// [`ExportError`]; a file that was at `path` is then untouched.
pub fn save_image(image: &Image, path: &Path) -> Result<(), ExportError> {
    let format = Format::of_path(path)?;
    let bytes = image.encode(format).map_err(|source| ExportError::Encode {
        path: path.to_owned(),
        source,
    })?;
    write_atomic(path, &bytes).map_err(|source| ExportError::Disk {
        path: path.to_owned(),
        source,
    })
}

/// `wanted`, or the first of `NAME-2`, `NAME-3`, … that no file has yet.
pub fn free_path(wanted: &Path) -> PathBuf {
    let stem = wanted
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let ending = wanted
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let mut path = wanted.to_owned();
    let mut number = 2_u32;
    while path.exists() {
        path = wanted.with_file_name(format!("{stem}-{number}.{ending}"));
        number += 1;
    }
    path
}
