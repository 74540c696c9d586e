//! Opening the window, and finding out why that is impossible.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use eframe::NativeOptions;
use egui::{IconData, ViewportBuilder};

use super::app::{App, Setup};

/// Size of the window when it is first opened, in points.
const SIZE: [f32; 2] = [1280.0, 800.0];
/// Below this the panels leave no room for the picture.
const MIN_SIZE: [f32; 2] = [760.0, 480.0];
/// The name under which the system keeps the window's settings.
const APP_ID: &str = "glint";
/// The icon, traced by Glint from `assets/icon.ron`.
const ICON: &[u8] = include_bytes!("../../assets/icon.png");

/// Why no window could be opened, in words for the user.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct NoWindow(String);

/// Opens the window on a scene file (or the demo) and stays until it is closed.
///
/// # Errors
/// [`NoWindow`] if there is no display, no OpenGL, or a system library is missing. The library
/// calls below this report some of that by a panic, which is caught and explained here; a panic
/// once the window is open passes.
pub fn run(scene: Option<PathBuf>) -> Result<(), NoWindow> {
    let is_open = Arc::new(AtomicBool::new(false));
    let quiet = Quiet::until(Arc::clone(&is_open));
    let result = catch_unwind(AssertUnwindSafe(|| {
        let is_open = Arc::clone(&is_open);
        eframe::run_native(
            APP_ID,
            options(),
            Box::new(move |cc| {
                is_open.store(true, Ordering::Relaxed);
                Ok(Box::new(App::new(cc, Setup::native(scene))?))
            }),
        )
    }));
    drop(quiet);
    match result {
        Ok(Ok(())) => Ok(()),
        Ok(Err(error)) => Err(NoWindow(one_line(&error.to_string()))),
        Err(panic) if is_open.load(Ordering::Relaxed) => std::panic::resume_unwind(panic),
        Err(panic) => Err(NoWindow(one_line(&panic_text(panic.as_ref())))),
    }
}

/// The folder in which the system keeps the program's data.
pub fn data_folder() -> Option<PathBuf> {
    eframe::storage_dir(APP_ID)
}

fn options() -> NativeOptions {
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
        ..NativeOptions::default()
    }
}

type PanicHook = Box<dyn Fn(&std::panic::PanicHookInfo<'_>) + Send + Sync>;

/// Keeps panics quiet until the window is open: they are explained in words instead.
struct Quiet(Arc<PanicHook>);

impl Quiet {
    fn until(is_open: Arc<AtomicBool>) -> Self {
        let usual = Arc::new(std::panic::take_hook());
        let hook = Arc::clone(&usual);
        std::panic::set_hook(Box::new(move |info| {
            if is_open.load(Ordering::Relaxed) {
                hook(info);
            }
        }));
        Self(usual)
    }
}

impl Drop for Quiet {
    fn drop(&mut self) {
        let usual = Arc::clone(&self.0);
        std::panic::set_hook(Box::new(move |info| usual(info)));
    }
}

fn panic_text(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "the window system failed".to_owned())
}

fn one_line(text: &str) -> String {
    text.split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
        .trim_end_matches('.')
        .to_owned()
}
