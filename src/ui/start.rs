//! Measures how long it takes from the start of the program until its first traced picture is on the screen.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

use egui::Context;
use serde::Serialize;

use crate::machine::resident_bytes;
use crate::words::milliseconds;

/// The cost of a start.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StartStats {
    /// Milliseconds until the window was first drawn.
    pub window_ms: f64,
    /// Milliseconds until it was drawn with a traced picture.
    pub picture_ms: f64,
    /// Memory of the program at that time, in MiB, if the system reports it.
    pub resident_mib: Option<f64>,
}

/// Measures a start; the window closes afterwards.
#[derive(Debug)]
pub struct StartWatch {
    since: Instant,
    sender: Sender<StartStats>,
    /// Milliseconds until the first frame was drawn.
    window_ms: Option<f64>,
    /// Whether the last frame had a picture; `None` before the first frame.
    had_picture: Option<bool>,
}

impl StartWatch {
    /// Creates a watch for a start that began at this time. The result arrives in the channel.
    pub fn new(since: Instant) -> (Self, Receiver<StartStats>) {
        let (sender, stats) = channel();
        let watch = Self {
            since,
            sender,
            window_ms: None,
            had_picture: None,
        };
        (watch, stats)
    }

    /// Called once a frame; `has_picture` says whether it shows a traced picture. Returns true in the frame after the
    /// first one with a picture, which is on the screen by then.
    pub fn tick(&mut self, ctx: &Context, has_picture: bool) -> bool {
        ctx.request_repaint();
        let ms = milliseconds(self.since.elapsed());
        let Some(had_picture) = self.had_picture.replace(has_picture) else {
            // The first frame is still being made; the next one knows when it was drawn.
            return false;
        };
        let window_ms = *self.window_ms.get_or_insert(ms);
        if had_picture {
            // The receiver is read after the window has closed.
            let _ = self.sender.send(StartStats {
                window_ms,
                picture_ms: ms,
                resident_mib: resident_bytes().map(|bytes| bytes as f64 / f64::from(1 << 20)),
            });
        }
        had_picture
    }
}
