//! Connects the editor and the render thread: requests pictures, and selects the one on screen.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;

use super::dialogs::Ask;
use super::lab::LabRequest;
use super::viewport::{Display, low_res};
use crate::editor::{Editor, Mode};
use crate::plan::{Region, RenderRequest};
use crate::scene::{Aspect, Sampling, Scene, Take};
use crate::worker::{
    Activity, BUDGET, Event, Frame, LiveJob, Pace, QueryJob, Question, RenderThreadError, StillJob,
    Worker,
};

/// Time over which pictures per second are counted.
const RATE_PERIOD: Duration = Duration::from_secs(1);

/// The times at which pictures of new revisions came on the screen.
#[derive(Debug, Default)]
struct FrameRate {
    shown: VecDeque<(Instant, u64)>,
}

impl FrameRate {
    /// Notes a picture; only the first one of each revision counts.
    fn note(&mut self, revision: u64, now: Instant) {
        if self.shown.back().is_none_or(|(_, last)| *last != revision) {
            self.shown.push_back((now, revision));
        }
        if self.shown.len() > 256 {
            self.shown.pop_front();
        }
    }

    /// Pictures per second over the last second.
    fn per_second(&self, now: Instant) -> f64 {
        let recent = self.shown.iter().filter(|(at, _)| now - *at <= RATE_PERIOD);
        let times: Vec<Instant> = recent.map(|(at, _)| *at).collect();
        match times[..] {
            [first, .., last] if last > first => {
                (times.len() - 1) as f64 / (last - first).as_secs_f64()
            }
            _ => 0.0,
        }
    }
}

/// Revision, size and part of a still picture.
type StillKey = (u64, (u32, u32), Option<Region>);

/// The render thread and its pictures.
pub struct Pictures {
    worker: Worker,
    /// The pictures on the graphics card.
    pub screen: Display,
    frame_rate: FrameRate,
    submitted: Option<(u64, (u32, u32), Pace, Aspect)>,
    /// Aspect and scene of the last picture in an aspect, and the scene that was derived from it.
    aspect: Option<(Aspect, Arc<Scene>, Arc<Scene>)>,
    still_requested: Option<StillKey>,
    /// Part of the still picture to be traced; `None` for all of it.
    pub region: Option<Region>,
    /// Document and still picture size that `region` belongs to.
    region_owner: (u64, (u32, u32)),
    /// Take for which a survey was requested.
    surveyed: Option<Arc<Take>>,
}

impl Pictures {
    /// Starts the render thread; it wakes the window.
    ///
    /// # Errors
    /// [`RenderThreadError`] when the system starts no threads.
    pub fn new(ctx: &Context) -> Result<Self, RenderThreadError> {
        let wake = ctx.clone();
        let worker = Worker::new(None, move || wake.request_repaint())?;
        Ok(Self {
            worker,
            screen: Display::default(),
            frame_rate: FrameRate::default(),
            submitted: None,
            aspect: None,
            still_requested: None,
            region: None,
            region_owner: (0, (0, 0)),
            surveyed: None,
        })
    }

    /// Handles what the render thread has finished. Returns whether something has failed.
    pub fn poll(&mut self, ctx: &Context, editor: &mut Editor) -> bool {
        while let Some(frame) = self.worker.take_frame() {
            if !frame.is_still {
                self.frame_rate.note(frame.revision, Instant::now());
            }
            self.screen.take(ctx, frame);
        }
        let mut has_failed = false;
        for event in self.worker.take_events() {
            match event {
                Event::Saved(path) => editor.notify(format!("Saved {}", path.display())),
                Event::Failed(reason) => {
                    editor.report_error_in(Ask::SaveImage.title(), reason);
                    has_failed = true;
                }
                Event::Fault(reason) => {
                    editor.report_error(reason);
                    has_failed = true;
                }
            }
        }
        has_failed
    }

    /// The worker that traces the pictures.
    pub fn worker(&self) -> &Worker {
        &self.worker
    }

    /// Number of different pictures shown per second, over the last second.
    pub fn per_second(&self) -> f64 {
        self.frame_rate.per_second(Instant::now())
    }

    /// Asks the questions of panels that take rays to answer, and what a recorded flight has seen.
    pub fn ask(&mut self, editor: &Editor, questions: Vec<Question>) {
        for question in questions {
            let scene = Arc::clone(editor.shown());
            self.worker.ask(QueryJob { scene, question });
        }
        let wanted = editor.wanted_survey();
        if wanted.map(Arc::as_ptr) == self.surveyed.as_ref().map(Arc::as_ptr) {
            return;
        }
        self.surveyed = wanted.cloned();
        if let Some(take) = wanted {
            let scene = Arc::clone(editor.scene());
            let question = Question::Survey(Arc::clone(take), Vec::new());
            self.worker.ask(QueryJob { scene, question });
        }
    }

    /// Returns the picture on screen if it is finished, has no missing part and shows all of the light.
    pub fn complete_frame(&self, editor: &Editor) -> Option<&Frame> {
        let is_whole = |frame: &&Frame| frame.step == 1 && frame.region.is_none();
        let submitted = self.submitted.as_ref();
        let is_part = submitted.is_some_and(|(.., aspect)| *aspect != Aspect::All);
        let frame = self.shown(editor).filter(is_whole);
        frame.filter(|frame| frame.is_still || !is_part)
    }

    /// Passes a request of the lab on to the render thread.
    pub fn handle_lab_request(&self, request: LabRequest) {
        match request {
            LabRequest::Measure(study) => self.worker.measure(*study),
            LabRequest::Stop => self.worker.stop_measuring(),
        }
    }

    /// Returns the picture on screen.
    pub fn shown(&self, editor: &Editor) -> Option<&Frame> {
        self.shown_still(editor).or(self.screen.live())
    }

    /// Returns the still picture if it is to be shown and has been traced.
    pub fn shown_still(&self, editor: &Editor) -> Option<&Frame> {
        match editor.mode {
            Mode::HighRes => self
                .screen
                .still(editor.shown_revision(), still_size(editor))
                .filter(|frame| frame.region.is_none() || frame.region == self.region),
            Mode::Live | Mode::LowRes => None,
        }
    }

    /// Whether the picture on screen is finished and shows the newest scene.
    pub fn is_settled(&self, editor: &Editor) -> bool {
        let is_finished =
            |frame: &Frame| frame.revision == editor.shown_revision() && frame.step == 1;
        let is_shown = match editor.mode {
            Mode::HighRes => self.shown_still(editor).is_some(),
            Mode::Live | Mode::LowRes => self.screen.live().is_some_and(is_finished),
        };
        is_shown && self.worker.activity() == Activity::Idle && !self.worker.is_asked()
    }

    /// Requests the still picture, and a file of it if `save_to` is given.
    pub fn request_still(&mut self, editor: &Editor, save_to: Option<PathBuf>) {
        // A file gets the whole picture, which is then shown as well.
        let region = self.region.filter(|_| save_to.is_none());
        self.still_requested = Some((editor.shown_revision(), still_size(editor), region));
        self.worker.request_still(StillJob {
            revision: editor.shown_revision(),
            scene: editor.shown().clone(),
            request: RenderRequest {
                region,
                ..RenderRequest::still(editor.shown())
            },
            save_to,
        });
    }

    /// Gives up the still picture that was only to be shown.
    pub fn leave_still(&mut self) {
        self.still_requested = None;
        self.worker.leave_still();
    }

    /// Gives up every still picture, even one that is to be written to a file.
    pub fn cancel_still(&mut self) {
        self.still_requested = None;
        self.worker.cancel_still();
    }

    /// Returns the scene whose picture shows an aspect of `scene`. If only the camera has moved, it shares its lists
    /// with the one before, so that nothing is planned again.
    fn scene_in_aspect(&mut self, aspect: Aspect, scene: &Arc<Scene>) -> Arc<Scene> {
        if aspect == Aspect::All {
            return Arc::clone(scene);
        }
        let cached = self
            .aspect
            .take()
            .filter(|(of, from, _)| *of == aspect && from.shares_contents_with(scene));
        let shown = match cached {
            Some((.., before)) => Arc::new(Scene {
                camera: scene.camera.clone(),
                light_visualization: scene.light_visualization,
                render: scene.render.clone(),
                animation: Arc::clone(&scene.animation),
                ..Scene::clone(&before)
            }),
            None => Arc::new(aspect.of(scene)),
        };
        self.aspect = Some((aspect, Arc::clone(scene), Arc::clone(&shown)));
        shown
    }

    /// Requests what the picture area, `pixels` large, needs and does not have yet. The live view shows `aspect` of
    /// the light.
    pub fn submit(&mut self, editor: &Editor, pixels: (u32, u32), aspect: Aspect) {
        let revision = editor.shown_revision();
        let region_owner = (editor.documents(), still_size(editor));
        if self.region_owner != region_owner {
            (self.region, self.region_owner) = (None, region_owner);
        }
        if editor.mode == Mode::HighRes {
            let wanted = (revision, still_size(editor), self.region);
            if self.shown_still(editor).is_none() && self.still_requested != Some(wanted) {
                self.request_still(editor, None);
            }
            return;
        }
        if !self.worker.is_tracing_still() {
            // A picture that is being traced is not requested again, but one that failed is.
            self.still_requested = None;
        }
        let (size, pace) = match editor.mode {
            Mode::LowRes => (low_res(pixels), Pace::Whole),
            // A frame of the animation may take as long as it is shown, and no longer.
            Mode::Live | Mode::HighRes if editor.timeline().is_playing => {
                let frame = 1.0 / editor.shown().animation.frames_per_second;
                let frame = Duration::from_secs_f64(frame / editor.timeline().speed);
                (pixels, Pace::Within(frame.min(BUDGET)))
            }
            Mode::Live | Mode::HighRes => (pixels, Pace::Within(BUDGET)),
        };
        if self.submitted == Some((revision, size, pace, aspect)) {
            return;
        }
        self.submitted = Some((revision, size, pace, aspect));
        let scene = self.scene_in_aspect(aspect, editor.shown());
        self.worker.submit(LiveJob {
            revision,
            scene,
            request: RenderRequest {
                sampling: match pace {
                    Pace::Whole => Sampling::Centres,
                    Pace::Within(_) => editor.shown().render.antialias,
                },
                aspect,
                ..RenderRequest::of(editor.shown(), size.0, size.1)
            },
            pace,
        });
    }
}

fn still_size(editor: &Editor) -> (u32, u32) {
    let render = &editor.shown().render;
    (render.width, render.height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rhythm_counts_each_revision_once() {
        let (mut frame_rate, start) = (FrameRate::default(), Instant::now());
        let at = |millis: u64| start + Duration::from_millis(millis);
        for n in 0..30_u64 {
            frame_rate.note(n, at(n * 50));
            frame_rate.note(n, at(n * 50 + 20));
        }
        assert!((frame_rate.per_second(at(1450)) - 20.0).abs() < 1e-9);
        assert_eq!(frame_rate.per_second(at(9000)), 0.0);
    }
}
