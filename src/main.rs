//! Glint's program: the command line, or else the window.

use std::path::Path;
use std::process::ExitCode;

use glint::cli::{CliAction, fail, picture_instead_of_window};
use glint::export::save_image;
use glint::image::Image;
use glint::ui::NoWindow;
use glint::{cli, ui};

fn main() -> ExitCode {
    match cli::run(std::env::args_os()) {
        CliAction::Done(code) => code,
        CliAction::Chart { study, path } => save(&ui::chart_picture(&study), &path),
        CliAction::Stability { maps, path } => save(&ui::stability_picture(&maps), &path),
        CliAction::Editor {
            scene,
            screenshot,
            exports,
        } => {
            let is_screenshot = screenshot.is_some();
            match ui::run(scene.clone(), screenshot, exports) {
                Ok(()) => ExitCode::SUCCESS,
                Err(NoWindow::Unavailable(reason)) if is_screenshot => {
                    fail(&format!("no window: {reason}"))
                }
                Err(NoWindow::Unavailable(reason)) => {
                    picture_instead_of_window(scene.as_deref(), &reason)
                }
                Err(error) => fail(&error.to_string()),
            }
        }
    }
}

fn save(picture: &Image, path: &Path) -> ExitCode {
    match save_image(picture, path) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(&error.to_string()),
    }
}
