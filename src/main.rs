//! The `glint` binary: runs the command line, or else opens the window.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use glint::cli::{CliAction, CliError, picture_instead_of_window};
use glint::export::save_image;
use glint::image::{Film, Image};
use glint::scene::Document;
use glint::ui::WindowError;
use glint::{cli, ui};

fn main() -> ExitCode {
    let since = Instant::now();
    let result = match cli::run(std::env::args_os()) {
        CliAction::Done(code) => return code,
        CliAction::Draw { figure, path } => save(ui::drawn(&figure), &path),
        CliAction::TimeStart { scene } => time_start(scene, since),
        CliAction::Editor {
            scene,
            screenshot,
            exports,
            select,
        } => open_editor(scene.as_deref(), screenshot, (exports, select)),
    };
    cli::finish(result.map_or_else(|error| error.report(), |()| ExitCode::SUCCESS))
}

/// Opens the window until its first picture is there, and prints the time and the memory that took.
fn time_start(scene: Option<PathBuf>, since: Instant) -> Result<(), CliError> {
    let scene_path = scene.clone();
    let stats = ui::time_start(scene, since).map_err(CliError::failed)?;
    // Messages about the file were lost with the window. Reading it earlier would have taken time.
    if let Some(path) = scene_path {
        Document::load(&path)?;
    }
    let stats = stats
        .ok_or_else(|| CliError::failed("the window was closed before it showed a picture"))?;
    cli::say(&serde_json::to_string(&stats)?);
    Ok(())
}

fn save(image: Image, path: &Path) -> Result<(), CliError> {
    save_image(&Film::Levels(image), path).map_err(CliError::from)
}

/// Opens the window. If there is none, explains why and traces a picture instead.
fn open_editor(
    scene: Option<&Path>,
    screenshot: Option<PathBuf>,
    (exports, select): (bool, Vec<String>),
) -> Result<(), CliError> {
    let is_screenshot = screenshot.is_some();
    match ui::run(scene.map(Path::to_owned), screenshot, (exports, select)) {
        Ok(()) => Ok(()),
        Err(WindowError::Unavailable(reason)) if is_screenshot => {
            Err(CliError::failed(format!("no window: {reason}")))
        }
        Err(WindowError::Unavailable(reason)) => picture_instead_of_window(scene, &reason),
        Err(error) => Err(CliError::failed(error)),
    }
}
