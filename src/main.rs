//! Glint's program: the command line, or else the window.

use std::process::ExitCode;

use glint::cli::{Asked, picture_instead_of_window, run};

fn main() -> ExitCode {
    match run(std::env::args_os()) {
        Asked::Done(code) => code,
        Asked::Editor(scene) => picture_instead_of_window(scene.as_deref(), "none yet"),
    }
}
