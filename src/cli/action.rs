//! What is left to do when the arguments are read.

use std::path::PathBuf;
use std::process::ExitCode;

use crate::lab::stability::Map;
use crate::lab::{Growth, PictureLook, SharedPicture, Study};

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
    /// Draw the charts of studies into this file.
    Chart {
        /// The studies, each with the name of its scene.
        studies: Vec<(String, Study)>,
        /// What was measured on.
        machine: String,
        /// How the picture looks.
        look: PictureLook,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Draw how cost grows into this file.
    Growth {
        /// What was measured.
        growth: Growth,
        /// How the picture looks.
        look: PictureLook,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Draw how pictures would be shared between cores into this file.
    Scaling {
        /// What was simulated.
        pictures: Vec<SharedPicture>,
        /// How the picture looks.
        look: PictureLook,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Draw these maps into this file.
    Stability {
        /// The maps.
        maps: Vec<Map>,
        /// The picture file; its ending is known to be good.
        path: PathBuf,
    },
    /// Nothing more: the command ran and ends with this code.
    Done(ExitCode),
}
