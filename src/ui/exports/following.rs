//! A video that is made when its frames are there.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError};

use super::order::Order;
use crate::export::{Sequence, Video, VideoError};
use crate::worker::run_in_background;

/// A video that follows its frames.
pub struct Following {
    /// The export of the frames.
    pub id: u64,
    /// Where it goes.
    pub path: PathBuf,
    /// What it was ordered with, once its frames are there.
    pub order: Option<Order>,
    sequence: Sequence,
    video: Video,
    making: Option<Receiver<Result<(), VideoError>>>,
}

impl Following {
    /// A video of a sequence that is being exported.
    pub fn new(id: u64, sequence: Sequence, path: PathBuf, video: Video) -> Self {
        Self {
            id,
            path,
            order: None,
            sequence,
            video,
            making: None,
        }
    }

    /// Makes it, on a thread of its own.
    pub fn make(&mut self) {
        let (kind, sequence, path) = (self.video, self.sequence.clone(), self.path.clone());
        let make = move || kind.make(&sequence, &path, |_| ());
        self.making = Some(run_in_background("glint-video", make));
    }

    /// Whether it is being made.
    pub fn is_making(&self) -> bool {
        self.making.is_some()
    }

    /// What has become of it; `None` before it has.
    pub fn made(&self) -> Option<Result<(), String>> {
        match self.making.as_ref()?.try_recv() {
            Ok(made) => Some(made.map_err(|error| error.to_string())),
            Err(TryRecvError::Disconnected) => Some(Err("the video was not made".to_owned())),
            Err(TryRecvError::Empty) => None,
        }
    }
}
