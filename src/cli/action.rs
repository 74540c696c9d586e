//! What is left to do after a command has run.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::lab::Figure;

/// What remains to be done for the command line.
#[derive(Debug)]
pub enum CliAction {
    /// Open the editor.
    Editor {
        /// The scene file; the demo if there is none.
        scene: Option<PathBuf>,
        /// File for a screenshot of the window, which then closes.
        screenshot: Option<PathBuf>,
        /// Whether the exports window is opened first.
        exports: bool,
        /// The names of what is selected at the start.
        select: Vec<String>,
    },
    /// Open the editor until its first traced picture is shown, and print how long that took.
    TimeStart {
        /// The scene file; the demo if there is none.
        scene: Option<PathBuf>,
    },
    /// Draw measurements into a picture.
    Draw {
        /// The measurements.
        figure: Figure,
        /// The picture file; its extension has been checked.
        path: PathBuf,
    },
    /// Nothing: the command has run, and the process exits with this code.
    Done(ExitCode),
}

impl CliAction {
    /// Draws measurements, if a picture was requested.
    pub fn drawing(figure: Figure, path: Option<PathBuf>) -> Self {
        path.map_or(Self::Done(ExitCode::SUCCESS), |path| Self::Draw {
            figure,
            path,
        })
    }
}
