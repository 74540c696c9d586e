//! The window: egui panels that read the editor's state and push actions. One file or folder for each panel. `theme.rs`
//! defines every colour and spacing, `commands.rs` every key except those that fly (`flight_keys.rs`) or walk through
//! lists.

mod autosave;

mod flight_keys;

mod layout;

mod dialogs;

mod commands;

mod obstacles;

mod folders;

mod flying;

mod requests;

mod screenshot;

mod start;

mod setup;

mod glyphs;

mod theme;

mod help;

mod hint;

mod icons;

mod menu_entry;

mod pack_drag;

mod add;

mod put_down;

mod prompts;

mod outside;

mod dropped;

mod interchange;

mod reading;

mod file_requests;

mod files;

mod upload;

mod examples;

mod raster;

mod arithmetic;

mod step_size;

mod number;

mod rows;

mod inspector;

mod menu;

mod outliner;

mod finder;

mod why;

mod scene_check;

mod status;

mod toasts;

mod histogram;

mod legend;

mod magnifier;

mod viewport;

mod tools;

mod timeline;

mod lab;

mod pictures;

mod still;

mod exports;

mod app;

mod answers;

mod panels;

mod on_selected;

mod run;

mod window;

pub use app::App;
pub use commands::{Command, SHORTCUTS};
pub use dialogs::{Ask, Dialogs};
pub use flight_keys::FLIGHT;
pub use lab::drawn;
pub use setup::Setup;
pub use start::StartStats;
pub use window::{WindowError, run, time_start};
