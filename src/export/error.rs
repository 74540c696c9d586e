//! Why something could not be exported.

use std::io;
use std::path::PathBuf;

use crate::image::FormatError;

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

/// The end of what another program said, which tells why it failed.
pub fn last_lines(said: &[u8]) -> String {
    let said = String::from_utf8_lossy(said);
    let lines: Vec<&str> = said.lines().collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}
