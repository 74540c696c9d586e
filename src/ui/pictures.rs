//! Between the editor and the lane: which pictures are asked for, and which one is on screen.

use std::path::PathBuf;

use egui::Context;

use super::lab::Wish;
use super::viewport::{Screen, low_res};
use crate::editor::{Editor, Mode};
use crate::lab::Study;
use crate::plan::{Picture, Sampling};
use crate::worker::{Activity, Event, Frame, LaneError, LiveJob, Pace, StillJob, Worker};

/// The lane and its pictures.
pub struct Pictures {
    worker: Worker,
    /// The pictures on the graphics card.
    pub screen: Screen,
    submitted: Option<(u64, (u32, u32), Pace)>,
    still_requested: Option<(u64, (u32, u32))>,
}

impl Pictures {
    /// Starts the lane; it wakes the window.
    ///
    /// # Errors
    /// [`LaneError`] when the system starts no threads.
    pub fn new(ctx: &Context) -> Result<Self, LaneError> {
        let wake = ctx.clone();
        let worker = Worker::new(None, move || wake.request_repaint())?;
        Ok(Self {
            worker,
            screen: Screen::default(),
            submitted: None,
            still_requested: None,
        })
    }

    /// Takes up what the lane has finished.
    pub fn poll(&mut self, ctx: &Context, editor: &mut Editor) {
        while let Some(frame) = self.worker.take_frame() {
            self.screen.take(ctx, frame);
        }
        for event in self.worker.take_events() {
            match event {
                Event::Saved(path) => editor.inform(format!("Saved {}", path.display())),
                Event::Failed(reason) => editor.complain(reason),
            }
        }
    }

    /// Passes a wish of the lab on to the lane.
    pub fn fulfil(&self, wish: Wish) {
        match wish {
            Wish::Measure(study) => self.worker.measure(*study),
            Wish::Stop => self.worker.stop_measuring(),
        }
    }

    /// Whether the lane is measuring, or will be.
    pub fn is_measuring(&self) -> bool {
        self.worker.is_measuring()
    }

    /// What the lane has measured since the last call.
    pub fn take_study(&self) -> Option<Study> {
        self.worker.take_study()
    }

    /// What the lane is doing.
    pub fn activity(&self) -> Activity {
        self.worker.activity()
    }

    /// Whether a picture is being written.
    pub fn is_saving(&self) -> bool {
        self.worker.is_saving()
    }

    /// The picture on screen.
    pub fn shown(&self, editor: &Editor) -> Option<&Frame> {
        self.shown_still(editor).or(self.screen.live())
    }

    /// The still picture, if it is wanted and there.
    pub fn shown_still(&self, editor: &Editor) -> Option<&Frame> {
        match editor.mode {
            Mode::HighRes => self.screen.still(editor.revision(), still_size(editor)),
            Mode::Live | Mode::LowRes => None,
        }
    }

    /// Whether the picture on screen is the finished one of the newest scene.
    pub fn is_settled(&self, editor: &Editor) -> bool {
        let is_finished = |frame: &Frame| frame.revision == editor.revision() && frame.step == 1;
        let is_shown = match editor.mode {
            Mode::HighRes => self.shown_still(editor).is_some(),
            Mode::Live | Mode::LowRes => self.screen.live().is_some_and(is_finished),
        };
        is_shown && self.worker.activity() == Activity::Idle
    }

    /// Asks for the still picture, and for a file of it.
    pub fn request_still(&mut self, editor: &Editor, save_to: Option<PathBuf>) {
        // What is written is also looked at.
        self.still_requested = Some((editor.revision(), still_size(editor)));
        self.worker.request_still(StillJob {
            revision: editor.revision(),
            scene: editor.scene().clone(),
            picture: Picture::still(editor.scene()),
            save_to,
        });
    }

    /// Gives the still picture up.
    pub fn cancel_still(&mut self) {
        self.still_requested = None;
        self.worker.cancel_still();
    }

    /// Asks for what the picture area, `pixels` large, needs and does not have.
    pub fn submit(&mut self, editor: &Editor, pixels: (u32, u32)) {
        let revision = editor.revision();
        if editor.mode == Mode::HighRes {
            let wanted = (revision, still_size(editor));
            if self.shown_still(editor).is_none() && self.still_requested != Some(wanted) {
                self.request_still(editor, None);
            }
            return;
        }
        self.still_requested = None;
        let (size, pace) = match editor.mode {
            Mode::LowRes => (low_res(pixels), Pace::Whole),
            Mode::Live | Mode::HighRes => (pixels, Pace::Progressive),
        };
        if self.submitted == Some((revision, size, pace)) {
            return;
        }
        self.submitted = Some((revision, size, pace));
        self.worker.submit(LiveJob {
            revision,
            scene: editor.scene().clone(),
            picture: Picture {
                sampling: match pace {
                    Pace::Whole => Sampling::Centres,
                    Pace::Progressive => editor.scene().render.antialias,
                },
                ..Picture::of(editor.scene(), size.0, size.1)
            },
            pace,
        });
    }
}

fn still_size(editor: &Editor) -> (u32, u32) {
    let render = &editor.scene().render;
    (render.width, render.height)
}
