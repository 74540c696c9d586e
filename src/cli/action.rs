//! What is left to do when the arguments are read.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::lab::Figure;

/// What the command line asked for.
#[derive(Debug)]
pub enum CliAction {
    /// Open the editor.
    Editor {
        /// The scene file; the demo if there is none.
        scene: Option<PathBuf>,
        /// Where to write a picture of the window, which then closes.
        screenshot: Option<PathBuf>,
        /// Whether the window of exports is opened first.
        exports: bool,
        /// The names of what is selected first.
        select: Vec<String>,
    },
    /// Open the editor until its first traced picture is there, and say how long that took.
    TimeStart {
        /// The scene file; the demo if there is none.
        scene: Option<PathBuf>,
    },
    /// Draw what was measured into this file.
    Draw {
        /// What was measured.
        figure: Figure,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Nothing more: the command ran and ends with this code.
    Done(ExitCode),
}
