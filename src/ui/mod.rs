//! The window: egui panels that read the editor's state and push actions. One file per panel;
//! `theme.rs` has every colour and spacing, `commands.rs` every key.

mod autosave;

mod commands;

mod dialogs;

mod flying;

mod requests;

mod menu_entry;

mod screenshot;

mod setup;

mod theme;

mod help;

mod icons;

mod add;

mod prompts;

mod outside;

mod interchange;

mod reading;

mod files;

mod raster;

mod rows;

mod inspector;

mod menu;

mod outliner;

mod status;

mod toasts;

mod upload;

mod timeline;

mod viewport;

mod lab;

mod pictures;

mod exports;

mod app;

mod run;

mod window;

pub use app::App;
pub use commands::{Command, FLIGHT, SHORTCUTS};
pub use dialogs::{Ask, Dialogs};
pub use lab::{chart_picture, growth_picture, stability_picture};
pub use setup::Setup;
pub use window::{NoWindow, run};
