//! Glint's program: the command line, or else the window.

use std::process::ExitCode;

use glint::cli::{Asked, picture_instead_of_window};
use glint::{cli, ui};

fn main() -> ExitCode {
    match cli::run(std::env::args_os()) {
        Asked::Done(code) => code,
        Asked::Editor(scene) => match ui::run(scene.clone()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(no_window) => picture_instead_of_window(scene.as_deref(), &no_window.to_string()),
        },
    }
}
