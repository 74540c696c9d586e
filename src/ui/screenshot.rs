//! A screenshot of the window, taken by the window itself, as shown in the README.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::{ColorImage, Context};

use crate::export::{ExportError, save_image};
use crate::image::{Film, Image};

/// Frames to wait after the traced picture is finished, so that the panels have their final size.
const SETTLED_FRAMES: u32 = 8;

/// A screenshot requested on the command line.
#[derive(Debug)]
pub struct Screenshot {
    path: PathBuf,
    /// Receives the outcome.
    outcome: Sender<Result<(), ExportError>>,
    settled_frames: u32,
    pixels: Option<Receiver<Arc<ColorImage>>>,
}

impl Screenshot {
    /// Creates a screenshot of the window, taken when its traced picture is complete. The outcome of writing it arrives
    /// in the channel.
    pub fn new(path: PathBuf) -> (Self, Receiver<Result<(), ExportError>>) {
        let (outcome, outcome_receiver) = channel();
        (
            Self {
                path,
                outcome,
                settled_frames: 0,
                pixels: None,
            },
            outcome_receiver,
        )
    }

    /// Called once a frame: requests the pixels once the window has settled, and writes them when they arrive. Returns
    /// whether it is done.
    pub fn tick(&mut self, ctx: &Context, is_settled: bool) -> bool {
        ctx.request_repaint();
        self.settled_frames = if is_settled {
            self.settled_frames + 1
        } else {
            0
        };
        if self.pixels.is_none() && self.settled_frames > SETTLED_FRAMES {
            let (sender, receiver) = channel();
            self.pixels = Some(receiver);
            ctx.request_screenshot(move |image| {
                // The window may be closed by now, so that nobody receives the pixels.
                let _ = sender.send(image);
            });
        }
        let Some(image) = self
            .pixels
            .as_ref()
            .and_then(|pixels| pixels.try_recv().ok())
        else {
            return false;
        };
        let [width, height] = image.size;
        let pixels = image
            .pixels
            .iter()
            .map(egui::Color32::to_srgba_unmultiplied)
            .collect();
        let written = save_image(
            &Film::Levels(Image {
                width,
                height,
                pixels,
            }),
            &self.path,
        );
        // The receiver is read after the window has closed, if at all.
        let _ = self.outcome.send(written);
        true
    }
}
