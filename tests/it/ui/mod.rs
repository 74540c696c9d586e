//! The window, headless: its widgets are driven by the names that screen readers hear.

mod files;
mod inspector;
mod keys;
mod lab;
mod monkey;
mod outliner;
mod shortcuts;
mod sides;
mod soak;
mod tools;
mod viewport;
