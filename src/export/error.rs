//! Errors of exports.

use std::io;
use std::path::{Path, PathBuf};

use crate::image::FormatError;
use crate::trace::PoolError;

/// Any error.
type Source = Box<dyn std::error::Error + Send + Sync>;

/// The reason why a picture could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The extension of the file name is not that of a known format.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// The picture could not be encoded.
    #[error("cannot encode {path}: {source}", path = .path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Error of the encoder.
        source: image::ImageError,
    },
    /// The scene cannot be serialized, which its fingerprint requires.
    #[error("the scene cannot be written: {0}")]
    Unwritable(#[from] ron::Error),
    /// A file exists but cannot be read.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The file could not be written.
    #[error("cannot write {path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// A frame file was replaced by another export.
    #[error(
        "{path} is no longer the frame that was made: another export has replaced it; give each export its own folder",
        path = .path.display()
    )]
    Changed {
        /// The file of the frame.
        path: PathBuf,
    },
}

/// The reason why a video could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The extension is not that of a known video format.
    #[error("{0:?} does not end in a known video format; use .mp4, .mov, .mkv, .gif or .apng")]
    Unknown(String),
    /// Making the video was cancelled.
    #[error("the video was stopped and is not written; its frames are")]
    Stopped,
    /// No threads could be started to make it.
    #[error(transparent)]
    Threads(#[from] PoolError),
    /// ffmpeg was not found.
    #[error(
        "ffmpeg is not installed, or not on the PATH; the frames are complete, and {how}\n.gif and .apng do not need ffmpeg"
    )]
    NoFfmpeg {
        /// How to make the video of the frames.
        how: String,
    },
    /// ffmpeg ended with an error.
    #[error("ffmpeg failed:\n{output}")]
    Ffmpeg {
        /// The end of its output.
        output: String,
    },
    /// The video format cannot hold such frames.
    #[error("{why}")]
    Unfit {
        /// What the format can hold, and which alternatives there are.
        why: String,
    },
    /// A frame file was replaced by one of another size.
    #[error(
        "{path} is now {width}×{height} pixels: another export has replaced it; give each export its own folder",
        path = .path.display(), width = .size.0, height = .size.1
    )]
    Replaced {
        /// The file of the frame.
        path: PathBuf,
        /// Its width and height in pixels.
        size: (u32, u32),
    },
    /// A file cannot be read or written, or a frame file was replaced by one of the same size.
    #[error(transparent)]
    Export(#[from] ExportError),
}

/// Most bytes of another program's output that are reported.
const MAX_OUTPUT_BYTES: usize = 4000;

impl VideoError {
    /// The error for a video that could not be written, by the error of the system or of the encoder.
    pub fn disk(path: &Path, source: impl Into<Source>) -> Self {
        let (path, source) = (path.to_owned(), io::Error::other(source));
        ExportError::Disk { path, source }.into()
    }

    /// The error for a frame that could not be read, by the error of the decoder.
    pub fn unreadable(path: &Path, source: image::ImageError) -> Self {
        let (path, source) = (path.to_owned(), io::Error::other(source));
        ExportError::Unreadable { path, source }.into()
    }
}

/// Returns the end of another program's output, which tells why it failed. Control characters, which could move a
/// terminal's cursor, become spaces.
pub fn last_lines(output: &[u8]) -> String {
    let end = &output[output.len().saturating_sub(MAX_OUTPUT_BYTES)..];
    let output = String::from_utf8_lossy(end);
    let lines: Vec<String> = output
        .lines()
        .map(|line| line.replace(char::is_control, " "))
        .collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}
