//! What `glint [SCENE]` does if no window can be opened: explains why, and traces a picture instead.

use std::path::{Path, PathBuf};

use super::error::{CliError, report, say};
use super::scene::read_scene;
use crate::export::save_image;
use crate::image::{Film, render};
use crate::plan::RenderRequest;
use crate::scene::Scene;
use crate::trace::{RenderControl, Threads};

/// Packages that a Debian or Ubuntu system needs to show a window.
const PACKAGES: &str = "libgl1 libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 (or, on Wayland, libwayland-client0 libwayland-egl1 libxkbcommon0 libegl1)";

/// Explains in two lines why there is no window, then traces the scene to `SCENE.png` in the current folder
/// (`SCENE-2.png` if that exists).
///
/// # Errors
/// [`CliError`], if the scene is invalid, or the picture cannot be traced or written.
pub fn picture_instead_of_window(scene: Option<&Path>, reason: &str) -> Result<(), CliError> {
    let (scene, name) = match scene {
        None => (Scene::demo(), PathBuf::from("demo.png")),
        Some(path) => {
            let stem = path.file_stem().unwrap_or(path.as_os_str());
            // `with_extension` would cut off what follows a dot within the stem.
            let mut name = stem.to_owned();
            name.push(".png");
            (read_scene(path)?, PathBuf::from(name))
        }
    };
    report(&format!(
        "glint: no window: {reason}. A window needs a display (DISPLAY or WAYLAND_DISPLAY) and the packages {PACKAGES}.\n\
         glint: commands such as `glint render` and `glint export` work without them; tracing the scene to a picture instead."
    ));
    let request = RenderRequest::still(&scene);
    let threads = Threads::new(None)?;
    let traced = threads.run(|| render(&scene, &request, &RenderControl::default()));
    let (image, _) = traced.ok_or_else(CliError::no_picture)?;
    let path = free_path(name);
    let (width, height) = (image.width, image.height);
    save_image(&Film::Levels(image), &path)?;
    say(&format!("{}: {width}×{height}", path.display()));
    Ok(())
}

/// The name of the picture, or the first of `NAME-2.png`, `NAME-3.png`, … that does not exist yet.
fn free_path(wanted: PathBuf) -> PathBuf {
    let stem = wanted.file_stem().unwrap_or_default().to_owned();
    let mut path = wanted;
    let mut number = 2_u32;
    while path.exists() {
        let mut name = stem.clone();
        name.push(format!("-{number}.png"));
        path.set_file_name(name);
        number += 1;
    }
    path
}
