//! How long it takes from the start of the program until its first traced picture is on the screen.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

use egui::Context;
use serde::Serialize;

use crate::machine::resident_bytes;

/// What a start has cost.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StartStats {
    /// Milliseconds until the window was drawn first.
    pub window_ms: f64,
    /// Milliseconds until it was drawn with a traced picture.
    pub picture_ms: f64,
    /// Memory of the program then, in MiB, where the system tells.
    pub resident_mib: Option<f64>,
}

/// Watches a start, after which the window closes.
#[derive(Debug)]
pub struct StartWatch {
    since: Instant,
    told: Sender<StartStats>,
    /// When the first frame was drawn, and whether the last one had a picture.
    drawn: Option<(f64, bool)>,
}

impl StartWatch {
    /// Watches a start that began at this time. What it has cost arrives in the channel.
    pub fn new(since: Instant) -> (Self, Receiver<StartStats>) {
        let (told, stats) = channel();
        let drawn = None;
        (Self { since, told, drawn }, stats)
    }

    /// Once a frame, of which is given whether it has a traced picture. True when all is known: a frame after the one
    /// with the picture, which is on the screen then.
    pub fn tick(&mut self, ctx: &Context, has_picture: bool) -> bool {
        ctx.request_repaint();
        let ms = self.since.elapsed().as_secs_f64() * 1e3;
        let Some((window_ms, had_picture)) = self.drawn else {
            // The first frame is being made: the next one knows when it was drawn.
            self.drawn = Some((f64::NAN, has_picture));
            return false;
        };
        let window_ms = if window_ms.is_nan() { ms } else { window_ms };
        self.drawn = Some((window_ms, has_picture));
        if had_picture {
            // Whoever asked waits for the window to end before it looks.
            let _ = self.told.send(StartStats {
                window_ms,
                picture_ms: ms,
                resident_mib: resident_bytes().map(|bytes| bytes as f64 / f64::from(1 << 20)),
            });
        }
        had_picture
    }
}
