//! Why something could not be exported.

use std::io;
use std::path::{Path, PathBuf};

use crate::image::FormatError;
use crate::trace::PoolError;

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
    /// A file is there that cannot be read.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },
    /// The disk said no.
    #[error("cannot write {path}: {source}", path = .path.display())]
    Disk {
        /// The file.
        path: PathBuf,
        /// What the system answered.
        source: io::Error,
    },
    /// A frame was put in the place of one that was made.
    #[error(
        "{path} is no longer the frame that was made: another export has replaced it; give each export its own folder",
        path = .path.display()
    )]
    Changed {
        /// The file of the frame.
        path: PathBuf,
    },
}

/// Why there is no video.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VideoError {
    /// The ending says no known kind.
    #[error("{0:?} does not end in a known video format; use .mp4, .mov, .mkv, .gif or .apng")]
    Unknown(String),
    /// It was not wanted any more.
    #[error("the video was stopped and is not written; its frames are")]
    Stopped,
    /// No threads could be had to make it.
    #[error(transparent)]
    Threads(#[from] PoolError),
    /// There is no ffmpeg.
    #[error(
        "ffmpeg is not installed, or not on the PATH; the frames are complete, and {how}\n.gif and .apng do not need ffmpeg"
    )]
    NoFfmpeg {
        /// What makes the video of them.
        how: String,
    },
    /// It ended with an error.
    #[error("ffmpeg failed:\n{said}")]
    Ffmpeg {
        /// The end of what it said.
        said: String,
    },
    /// The kind of video holds no such frames.
    #[error("{why}")]
    Unfit {
        /// What it holds, and what would do.
        why: String,
    },
    /// A frame is another one than was made.
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
    /// A frame of the same size, or the notes about all of them cannot be read.
    #[error(transparent)]
    Frames(#[from] ExportError),
    /// A frame could not be read.
    #[error("cannot read {path}: {source}", path = .path.display())]
    Frame {
        /// The frame's file.
        path: PathBuf,
        /// What the decoder said.
        source: image::ImageError,
    },
    /// The video could not be written.
    #[error("cannot write {path}: {why}", path = .path.display())]
    Disk {
        /// The video's file.
        path: PathBuf,
        /// What the system or the encoder answered.
        why: String,
    },
}

/// Most bytes of what another program said that are told.
const MOST_SAID: usize = 4000;

impl VideoError {
    /// The video could not be written, for this reason.
    pub fn disk(path: &Path, why: &dyn std::error::Error) -> Self {
        Self::Disk {
            path: path.to_owned(),
            why: why.to_string(),
        }
    }

    /// A frame could not be read.
    pub fn unreadable(path: &Path, source: image::ImageError) -> Self {
        Self::Frame {
            path: path.to_owned(),
            source,
        }
    }
}

/// The end of what another program said, which tells why it failed. What would move a terminal's cursor is left out.
pub fn last_lines(said: &[u8]) -> String {
    let end = &said[said.len().saturating_sub(MOST_SAID)..];
    let said = String::from_utf8_lossy(end);
    let lines: Vec<String> = said
        .lines()
        .map(|line| line.replace(char::is_control, " "))
        .collect();
    lines[lines.len().saturating_sub(12)..].join("\n")
}
