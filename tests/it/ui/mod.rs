//! Headless tests of the window: its widgets are found by their accessible names.

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
