//! What `glint [SCENE]` does where no window can be opened: says why, and traces a picture instead.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::{fail, refuse, say};
use crate::export::{free_path, save_image};
use crate::image::render;
use crate::plan::RenderRequest;
use crate::scene::{Document, Scene};
use crate::trace::{RenderControl, Threads};

/// What a Debian or Ubuntu system needs to show a window.
const PACKAGES: &str = "libgl1 libx11-6 libx11-xcb1 libxcursor1 libxi6 libxkbcommon-x11-0 (or, on Wayland, libwayland-client0 libwayland-egl1 libxkbcommon0 libegl1)";

/// Explains in two lines why there is no window, then traces the scene to `SCENE.png` in the
/// current folder (`SCENE-2.png` if there is one already).
pub fn picture_instead_of_window(scene: Option<&Path>, reason: &str) -> ExitCode {
    let (scene, name) = match scene.map(|path| (Document::load(path), path)) {
        None => (Scene::demo(), PathBuf::from("demo.png")),
        Some((Ok(document), path)) => {
            let stem = path.file_stem().unwrap_or(path.as_os_str());
            (document.scene, Path::new(stem).with_extension("png"))
        }
        Some((Err(error), _)) => return refuse(&error.to_string()),
    };
    {
        use std::io::Write as _;
        let _ = writeln!(
            std::io::stderr(),
            "glint: no window: {reason}. A window needs a display (DISPLAY or WAYLAND_DISPLAY) and the packages {PACKAGES}.\n\
             glint: `glint render` and `glint check` need none of these; tracing the scene to a picture instead."
        );
    }
    let traced = Threads::new(None).map(|threads| {
        threads.run(|| {
            render(
                &scene,
                &RenderRequest::still(&scene),
                &RenderControl::default(),
            )
        })
    });
    let image = match traced {
        Ok(Some((image, _))) => image,
        Ok(None) => return fail("the trace ended without a picture"),
        Err(error) => return fail(&error.to_string()),
    };
    let path = free_path(&name);
    match save_image(&image, &path) {
        Ok(()) => {
            say(&format!(
                "{}: {}×{}",
                path.display(),
                image.width,
                image.height
            ));
            ExitCode::SUCCESS
        }
        Err(error) => fail(&error.to_string()),
    }
}
