//! Tests of the program as a whole: real files, the real binary, a real window, a real peer.

#![allow(clippy::expect_used, reason = "a test that cannot go on has failed")]

use std::time::Duration;

mod antialias;
mod architecture;
mod aspects;
mod bytes;
mod cli;
mod contacts;
mod copies;
mod dependencies;
mod export;
mod extremes;
mod faults;
mod filter;
mod fuzz;
mod harness;
mod image_model;
mod kept;
mod mesh_contacts;
mod meshes;
mod needs;
mod numerics;
mod pictures;
mod povray;
mod program;
mod random;
mod readme;
mod scalar;
mod scene_format;
mod scenes;
mod timeline;
mod ui;
mod window;
mod worker;

/// How long a test waits for something to happen. On a slow machine that is busy with other tests, this may take
/// minutes; only what hangs is to fail.
const PATIENCE: Duration = Duration::from_mins(10);
