//! Encoding of a video once its frames are exported.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use crate::export::{Sequence, Video, VideoError};
use crate::trace::Threads;
use crate::worker::Background;

/// Number of threads that encode a video: half of all, as the viewport is still being traced.
pub fn video_threads() -> usize {
    (Threads::available() / 2).max(1)
}

/// The progress of a video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VideoState {
    /// Its frames are still being exported.
    Waiting,
    /// It is being encoded and has this many frames so far.
    Making(usize),
    /// It is finished.
    Made,
    /// It was cancelled.
    Stopped,
    /// It failed, with the reason.
    Failed(String),
}

/// Encodes a video once its frames are exported.
pub struct VideoMaker {
    /// Path of the video.
    pub path: PathBuf,
    /// Its progress.
    pub state: VideoState,
    sequence: Sequence,
    video: Video,
    encoding: Background<Result<(), VideoError>>,
    /// When encoding began, and how long it had taken when `done` last grew.
    timing: Option<(Instant, Duration)>,
    /// Number of frames encoded so far.
    done: Arc<AtomicUsize>,
    /// Whether the user has cancelled it.
    is_cancelled: Arc<AtomicBool>,
}

impl VideoMaker {
    /// Creates a maker for the video of a sequence that is being exported.
    pub fn new(sequence: Sequence, path: PathBuf, video: Video) -> Self {
        Self {
            path,
            state: VideoState::Waiting,
            sequence,
            video,
            encoding: Background::default(),
            timing: None,
            done: Arc::default(),
            is_cancelled: Arc::default(),
        }
    }

    /// The number of frames of the video.
    pub fn frames(&self) -> usize {
        self.sequence.frames.count()
    }

    /// Estimated seconds left, extrapolated from the frames encoded so far.
    pub fn seconds_left(&self) -> Option<f64> {
        let (VideoState::Making(done @ 1..), Some((_, taken))) = (&self.state, self.timing) else {
            return None;
        };
        let left = self.frames().saturating_sub(*done);
        Some(taken.as_secs_f64() / *done as f64 * left as f64)
    }

    /// Starts encoding in the background, on separate threads.
    pub fn make(&mut self) {
        let (kind, sequence, path) = (self.video, self.sequence.clone(), self.path.clone());
        let (done, is_cancelled) = (Arc::clone(&self.done), Arc::clone(&self.is_cancelled));
        let on_progress = move |frames| {
            done.store(frames, Ordering::Relaxed);
            !is_cancelled.load(Ordering::Relaxed)
        };
        let make = move || {
            let threads = Threads::new(Some(video_threads()))?;
            threads.run(|| kind.make(&sequence, &path, on_progress))
        };
        self.timing = Some((Instant::now(), Duration::ZERO));
        self.encoding = Background::start("glint-video", make);
        self.state = VideoState::Making(0);
    }

    /// Asks the encoder to stop, which may take a moment.
    pub fn stop(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    /// Updates the progress from the background task.
    pub fn update(&mut self) -> &VideoState {
        match self.encoding.take() {
            Some(Ok(Ok(()))) => self.state = VideoState::Made,
            Some(Ok(Err(VideoError::Stopped))) => self.state = VideoState::Stopped,
            Some(Ok(Err(error))) => self.state = VideoState::Failed(error.to_string()),
            Some(Err(no_answer)) => {
                self.state = VideoState::Failed(format!("No video: {no_answer}"));
            }
            None if self.encoding.is_awaited() => {
                let state = VideoState::Making(self.done.load(Ordering::Relaxed));
                // The count grows by several frames at once, so the time is taken only when it changes.
                if let Some((since, taken)) = self.timing.as_mut().filter(|_| state != self.state) {
                    *taken = since.elapsed();
                }
                self.state = state;
            }
            None => {}
        }
        &self.state
    }
}

#[cfg(test)]
mod tests {
    use std::thread::sleep;
    use std::time::Duration;

    use super::*;
    use crate::export::{ExportStep, Exporting, Pattern};
    use crate::image::Format;
    use crate::scene::Scene;
    use crate::trace::RenderControl;

    #[test]
    fn a_video_is_made_unless_it_is_given_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut scene = Scene::demo();
        (scene.render.width, scene.render.height) = (8, 8);
        let place = folder.path().to_owned();
        let sequence = Sequence::new(scene.into(), None, Pattern::default(), Format::Ppm, place);
        let sequence = sequence.expect("frames");
        let mut exporting = Exporting::new(sequence.clone()).expect("a folder");
        while matches!(exporting.step(&RenderControl::default()), ExportStep::Going) {}
        exporting.finish().expect("written");
        for (name, is_given_up, expected) in [
            ("a.gif", true, VideoState::Stopped),
            ("b.gif", false, VideoState::Made),
        ] {
            let path = folder.path().join(name);
            let mut maker = VideoMaker::new(sequence.clone(), path.clone(), Video::Gif);
            if is_given_up {
                maker.stop();
            }
            maker.make();
            while matches!(maker.update(), VideoState::Making(_)) {
                sleep(Duration::from_millis(1));
            }
            assert_eq!(maker.state, expected);
            assert_eq!(path.exists(), !is_given_up);
        }
    }
}
