//! Opens the window, or reports why that is impossible.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use eframe::NativeOptions;
use egui::{IconData, ViewportBuilder};

use super::app::App;
use super::screenshot::Screenshot;
use super::setup::{APP_ID, Setup};
use super::start::{StartStats, StartWatch};
use crate::export::ExportError;
use crate::worker::panic_text;

/// Size of the window when it is first opened, in points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// Least size of the window, below which the panels leave no room for the picture.
const MIN_SIZE: [f32; 2] = [760.0, 480.0];
/// The icon, traced by Glint from `assets/icon.ron`.
const ICON: &[u8] = include_bytes!("../../assets/icon.png");

/// The reason why the window could not do what it was opened for.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    /// No window could be opened, for this reason.
    #[error("{0}")]
    Unavailable(String),
    /// The screenshot could not be written.
    #[error(transparent)]
    Screenshot(ExportError),
    /// It was closed before the screenshot could be taken.
    #[error("the window was closed before its picture was complete: there is no screenshot")]
    Closed,
}

/// Opens the window on a scene file (or the demo) until it is closed, or until a screenshot of it is written to
/// `screenshot`. For a screenshot, `exports` opens the window of exports, and `select` names objects and lights to
/// be selected.
///
/// # Errors
/// [`WindowError::Unavailable`] if there is no display, no OpenGL, or a system library is missing. The libraries used
/// here report some of these by a panic, which is caught and explained; a panic after the window was opened is passed
/// on.
pub fn run(
    scene: Option<PathBuf>,
    screenshot: Option<PathBuf>,
    (exports, select): (bool, Vec<String>),
) -> Result<(), WindowError> {
    let (screenshot, outcome) = screenshot.map(Screenshot::new).unzip();
    let persist_window = screenshot.is_none();
    let setup = match screenshot {
        None => Setup::native(scene),
        Some(screenshot) => Setup {
            exports,
            select,
            data_folder: None,
            screenshot: Some(screenshot),
            ..Setup::native(scene)
        },
    };
    open(setup, persist_window)?;
    match outcome.map(|outcome| outcome.try_recv()) {
        None | Some(Ok(Ok(()))) => Ok(()),
        Some(Ok(Err(error))) => Err(WindowError::Screenshot(error)),
        Some(Err(_)) => Err(WindowError::Closed),
    }
}

/// Opens the window on a scene file (or the demo), closes it once its first traced picture is shown, and returns what
/// that has cost since the given time; `None` if it was closed before.
///
/// # Errors
/// [`WindowError::Unavailable`] as from [`run`].
pub fn time_start(
    scene: Option<PathBuf>,
    since: Instant,
) -> Result<Option<StartStats>, WindowError> {
    let (start, stats) = StartWatch::new(since);
    let setup = Setup {
        data_folder: None,
        start: Some(start),
        ..Setup::native(scene)
    };
    open(setup, false)?;
    Ok(stats.try_recv().ok())
}

fn open(setup: Setup, persist_window: bool) -> Result<(), WindowError> {
    let is_open = Arc::new(AtomicBool::new(false));
    let silenced_panics = SilencedPanics::until(Arc::clone(&is_open));
    let result = catch_unwind(AssertUnwindSafe(|| {
        let is_open = Arc::clone(&is_open);
        eframe::run_native(
            APP_ID,
            options(persist_window),
            Box::new(move |cc| {
                is_open.store(true, Ordering::Relaxed);
                Ok(Box::new(App::new(cc, setup)?))
            }),
        )
    }));
    drop(silenced_panics);
    match result {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(WindowError::Unavailable(readable_reason(
            &error.to_string(),
        ))),
        Err(panic) if is_open.load(Ordering::Relaxed) => std::panic::resume_unwind(panic),
        Err(panic) => Err(WindowError::Unavailable(readable_reason(panic_text(
            panic.as_ref(),
        )))),
    }
}

fn options(persist_window: bool) -> NativeOptions {
    let mut viewport = ViewportBuilder::default()
        .with_title("Glint")
        .with_app_id(APP_ID)
        .with_inner_size(SIZE)
        .with_min_inner_size(MIN_SIZE)
        .with_drag_and_drop(true);
    if let Ok(icon) = image::load_from_memory(ICON) {
        let icon = icon.to_rgba8();
        let (width, height) = icon.dimensions();
        viewport = viewport.with_icon(IconData {
            rgba: icon.into_raw(),
            width,
            height,
        });
    }
    NativeOptions {
        viewport,
        persist_window,
        ..NativeOptions::default()
    }
}

type PanicHook = Box<dyn Fn(&std::panic::PanicHookInfo<'_>) + Send + Sync>;

/// Silences panics until the window is open: they are explained in words instead.
struct SilencedPanics(Arc<PanicHook>);

impl SilencedPanics {
    fn until(is_open: Arc<AtomicBool>) -> Self {
        let previous_hook = Arc::new(std::panic::take_hook());
        let hook = Arc::clone(&previous_hook);
        std::panic::set_hook(Box::new(move |info| {
            if is_open.load(Ordering::Relaxed) {
                hook(info);
            }
        }));
        Self(previous_hook)
    }
}

impl Drop for SilencedPanics {
    fn drop(&mut self) {
        let previous_hook = Arc::clone(&self.0);
        std::panic::set_hook(Box::new(move |info| previous_hook(info)));
    }
}

/// Returns an error message of the window library for people: one line, without positions in its source.
fn readable_reason(text: &str) -> String {
    if text.contains("WAYLAND_DISPLAY nor") {
        return "there is no display".to_owned();
    }
    if text.contains("glutin") {
        return "no OpenGL driver was found".to_owned();
    }
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let line = line.rsplit(".rs:").next().unwrap_or_default();
    line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':' || c == ' ')
        .trim_end_matches('.')
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::readable_reason;

    #[test]
    fn reasons_are_readable() {
        let x11 = "winit EventLoopError: os error at /a/b/winit/mod.rs:788: Failed to load one of xlib's shared libraries";
        assert_eq!(
            readable_reason(x11),
            "Failed to load one of xlib's shared libraries"
        );
        assert_eq!(
            readable_reason("Library libxkbcommon-x11.so could\n not be loaded."),
            "Library libxkbcommon-x11.so could not be loaded"
        );
        assert_eq!(
            readable_reason("Found no glutin configs matching the template: …"),
            "no OpenGL driver was found"
        );
    }
}
