//! The settings with which the program opens the window.

use std::path::PathBuf;

use super::dialogs::{Dialogs, NativeDialogs};
use super::screenshot::Screenshot;
use super::start::StartWatch;

/// Name under which the system stores the window's settings.
pub const APP_ID: &str = "glint";

/// The settings with which the program opens the window.
pub struct Setup {
    /// Scene file to open; the demo if there is none.
    pub scene: Option<PathBuf>,
    /// The dialogs that ask for paths.
    pub dialogs: Box<dyn Dialogs>,
    /// Folder for unsaved work and other data; `None` stores none.
    pub data_folder: Option<PathBuf>,
    /// Screenshot to be taken, after which the window closes.
    pub screenshot: Option<Screenshot>,
    /// Measures how long the start takes, after which the window closes.
    pub start: Option<StartWatch>,
    /// Whether the window of exports is open at the beginning.
    pub exports: bool,
    /// Names of objects and lights that are selected at the beginning.
    pub select: Vec<String>,
}

impl Setup {
    /// Uses the desktop's dialogs and data folder.
    pub fn native(scene: Option<PathBuf>) -> Self {
        Self {
            scene,
            dialogs: Box::new(NativeDialogs),
            data_folder: eframe::storage_dir(APP_ID),
            screenshot: None,
            start: None,
            exports: false,
            select: Vec::new(),
        }
    }
}
