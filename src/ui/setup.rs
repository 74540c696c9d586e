//! What the program gives the window.

use std::path::PathBuf;

use super::dialogs::{Dialogs, Native};
use super::screenshot::Screenshot;
use super::start::StartWatch;

/// The name under which the system keeps the window's settings.
pub const APP_ID: &str = "glint";

/// What the program gives the window.
pub struct Setup {
    /// The scene to open; the demo if there is none.
    pub scene: Option<PathBuf>,
    /// How paths are asked for.
    pub dialogs: Box<dyn Dialogs>,
    /// Where unsaved work is kept; `None` keeps none.
    pub data_folder: Option<PathBuf>,
    /// A picture to be made of the window, which then closes.
    pub screenshot: Option<Screenshot>,
    /// Watches how long the start takes; the window then closes.
    pub start: Option<StartWatch>,
    /// Whether the window of exports is open at first.
    pub exports: bool,
    /// The names of objects and lights that are selected at first.
    pub select: Vec<String>,
}

impl Setup {
    /// The desktop's dialogs and data folder.
    pub fn native(scene: Option<PathBuf>) -> Self {
        Self {
            scene,
            dialogs: Box::new(Native),
            data_folder: eframe::storage_dir(APP_ID),
            screenshot: None,
            start: None,
            exports: false,
            select: Vec::new(),
        }
    }
}
