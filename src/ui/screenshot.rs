//! A picture of the window itself, made by the window: what the README shows.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::{ColorImage, Context};

use crate::export::{ExportError, save_image};
use crate::image::{Film, Image};

/// Frames to wait for once the traced picture is there, so that the panels have their final size.
const CALM_FRAMES: u32 = 8;

/// A picture that was asked for on the command line.
#[derive(Debug)]
pub struct Screenshot {
    path: PathBuf,
    /// Told how it went.
    outcome: Sender<Result<(), ExportError>>,
    calm: u32,
    pixels: Option<Receiver<Arc<ColorImage>>>,
}

impl Screenshot {
    /// A screenshot of the window as it is when its traced picture is complete. How writing it went arrives in
    /// the channel.
    pub fn new(path: PathBuf) -> (Self, Receiver<Result<(), ExportError>>) {
        let (outcome, told) = channel();
        (
            Self {
                path,
                outcome,
                calm: 0,
                pixels: None,
            },
            told,
        )
    }

    /// Once a frame: asks for the pixels when all is calm, writes them when they come. True when
    /// it is done.
    pub fn tick(&mut self, ctx: &Context, is_settled: bool) -> bool {
        ctx.request_repaint();
        self.calm = if is_settled { self.calm + 1 } else { 0 };
        if self.pixels.is_none() && self.calm > CALM_FRAMES {
            let (sender, receiver) = channel();
            self.pixels = Some(receiver);
            ctx.request_screenshot(move |image| {
                // The window may be gone by now, and with it the wish.
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
        // Whoever asked waits for the window to end before it looks.
        let _ = self.outcome.send(written);
        true
    }
}
