//! A video that is made when its frames are there.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError};

use crate::export::{Sequence, Video, VideoError};
use crate::worker::run_in_background;

/// What has become of a video.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VideoState {
    /// Its frames are not there yet.
    Waiting,
    /// So many of its frames are in it.
    Making(usize),
    /// It is there.
    Made,
    /// It was given up.
    Stopped,
    /// It is not, and why.
    Failed(String),
}

/// Makes a video of frames when they are there.
pub struct VideoMaker {
    /// Where it goes.
    pub path: PathBuf,
    /// How far it is.
    pub state: VideoState,
    sequence: Sequence,
    video: Video,
    making: Option<Receiver<Result<(), VideoError>>>,
    /// Frames that are in it.
    done: Arc<AtomicUsize>,
    /// Whether it is not wanted any more.
    is_stopped: Arc<AtomicBool>,
}

impl VideoMaker {
    /// For a sequence that is being exported.
    pub fn new(sequence: Sequence, path: PathBuf, video: Video) -> Self {
        Self {
            path,
            state: VideoState::Waiting,
            sequence,
            video,
            making: None,
            done: Arc::default(),
            is_stopped: Arc::default(),
        }
    }

    /// How many frames it is made of.
    pub fn frames(&self) -> usize {
        self.sequence.frames.count()
    }

    /// Makes it, on a thread of its own.
    pub fn make(&mut self) {
        let (kind, sequence, path) = (self.video, self.sequence.clone(), self.path.clone());
        let (done, is_stopped) = (Arc::clone(&self.done), Arc::clone(&self.is_stopped));
        let go_on = move |frames| {
            done.store(frames, Ordering::Relaxed);
            !is_stopped.load(Ordering::Relaxed)
        };
        let make = move || kind.make(&sequence, &path, go_on);
        self.making = Some(run_in_background("glint-video", make));
        self.state = VideoState::Making(0);
    }

    /// Gives it up, soon.
    pub fn stop(&self) {
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    /// Looks how far it is.
    pub fn update(&mut self) -> &VideoState {
        if let Some(made) = &self.making {
            self.state = match made.try_recv() {
                Ok(Ok(())) => VideoState::Made,
                Ok(Err(VideoError::Stopped)) => VideoState::Stopped,
                Ok(Err(error)) => VideoState::Failed(error.to_string()),
                Err(TryRecvError::Disconnected) => {
                    VideoState::Failed("the video was not made".to_owned())
                }
                Err(TryRecvError::Empty) => VideoState::Making(self.done.load(Ordering::Relaxed)),
            };
            if !matches!(self.state, VideoState::Making(_)) {
                self.making = None;
            }
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
