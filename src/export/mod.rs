//! Pictures on disk: single ones, and sequences whose export can be resumed.

mod error;

mod save;

mod frames;

mod pattern;

mod manifest;

mod fingerprint;

mod sequence;

mod writers;

mod exporting;

mod job;

mod frame_file;

mod animated;

mod program;

mod ffmpeg;

mod video;

mod povray;

pub use error::{ExportError, VideoError};
pub use exporting::{ExportStep, Exported, Exporting};
pub use fingerprint::fingerprint;
pub use frames::{Frames, FramesError};
pub use job::{JobError, JobFiles, write_job};
pub use manifest::{Hash, Manifest};
pub use pattern::{Pattern, PatternError};
pub use povray::{ByPovray, PovrayError, by_povray, povray_differences, povray_text};
pub use save::{check_writable, save_image, save_picture, write_text};
pub use sequence::{LOOP_HINT, NoSuchFrame, Sequence, SequenceError};
pub use video::Video;
