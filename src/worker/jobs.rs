//! Requests to the render threads, and their answers.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use glam::DVec3;

use crate::animate::Landmark;
use crate::export::Exported;
use crate::image::{Image, ObjectMap, RenderCost, Thing};
use crate::lab::{Choice, Goal};
use crate::plan::{Region, RenderRequest};
use crate::scene::{Camera, Sampling, Scene, Take};

/// The kinds of jobs, most urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum JobKind {
    /// The live view.
    Live,
    /// A question about a scene.
    Query,
    /// The smooth edges of the live view.
    Smooth,
    /// A thumbnail.
    Thumbnail,
    /// A question that takes seconds of measuring to answer.
    Quality,
    /// A still picture to look at.
    Still,
    /// A still picture to be saved.
    Save,
    /// A frame of an export.
    Export,
    /// A part of a study of the lab.
    Lab,
}

/// The two render threads. Long jobs are paused while the window needs pictures, so that editing never waits for
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crew {
    /// For what the window shows next.
    Prompt,
    /// For jobs that may take long; they start and resume while the other crew is idle.
    Patient,
}

impl Crew {
    /// Both crews.
    pub const ALL: [Self; 2] = [Self::Prompt, Self::Patient];

    /// The name of its thread.
    pub fn name(self) -> &'static str {
        match self {
            Self::Prompt => "glint-prompt",
            Self::Patient => "glint-patient",
        }
    }
}

impl JobKind {
    /// The crew that does it.
    pub fn crew(self) -> Crew {
        if self < Self::Still {
            Crew::Prompt
        } else {
            Crew::Patient
        }
    }

    /// Returns whether a new job of this kind stops a running one, which starts over later: if it is for the same
    /// thread and more urgent, or replaces it. A running thumbnail is not stopped, as it would be done before
    /// anything was gained; a thumbnail stops no quality measurement; no new job stops a picture that is being saved.
    /// A study of the lab is stopped by jobs of either crew: what measures time cannot be paused.
    pub fn preempts(self, running: Self) -> bool {
        let is_same = self.crew() == running.crew() || running == Self::Lab;
        let replaces = self == running && self.is_replaced();
        let waits = matches!(running, Self::Thumbnail | Self::Save)
            || (self, running) == (Self::Thumbnail, Self::Quality);
        is_same && !waits && (self < running || replaces)
    }

    /// Returns whether a new job of this kind pauses a running one.
    pub fn pauses(self, running: Self) -> bool {
        self.crew() == Crew::Prompt && running.crew() == Crew::Patient
    }

    /// Whether a new job of this kind replaces the previous one.
    pub fn is_replaced(self) -> bool {
        matches!(self, Self::Live | Self::Quality | Self::Still | Self::Lab)
    }
}

/// A request for the live view.
#[derive(Clone, Debug)]
pub struct LiveJob {
    /// Revision of the scene; only ever grows.
    pub revision: u64,
    /// The scene at that revision.
    pub scene: Arc<Scene>,
    /// The picture, at its full resolution.
    pub request: RenderRequest,
    /// Whether coarse pictures may come first, to keep up with a drag.
    pub pace: Pace,
}

/// A question about a scene whose answer requires tracing rays.
#[derive(Clone, Debug)]
pub struct QueryJob {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The question; an older one of the same sort is dropped.
    pub question: Question,
}

/// The sorts of questions.
#[derive(Clone, Debug)]
pub enum Question {
    /// What does every sample of a recorded flight see? With what is known of that so far.
    Survey(Arc<Take>, Vec<Vec<Landmark>>),
    /// Which of these points does the camera see? The number identifies the question to the caller.
    Visible(u64, Box<Camera>, Vec<DVec3>),
    /// Which object is visible at each pixel of a picture, with these things left out? The number identifies the
    /// question to the caller.
    Objects(u64, Box<RenderRequest>, Vec<Thing>),
    /// Which sampling does the still picture need?
    Quality(Goal),
}

/// The answer to a [`Question`].
#[derive(Clone, Debug)]
pub enum Answer {
    /// What the samples of this take see, see [`crate::trace::survey`].
    Survey(Arc<Take>, Vec<Vec<Landmark>>),
    /// For the question of this number: whether each point is unobstructed.
    Visible(u64, Vec<(DVec3, bool)>),
    /// For the question of this number: what is visible at each pixel, with these things left out.
    Objects(u64, ObjectMap, Vec<Thing>),
    /// The goal, and the sampling chosen for it by measuring; `None` if the tracer has failed.
    Quality(Goal, Option<Choice>),
}

/// A request for a thumbnail: traced while no live view waits, never stopped, one sample per pixel.
#[derive(Clone, Debug)]
pub struct ThumbnailJob {
    /// The caller's name for it.
    pub name: u64,
    /// The scene that it shows.
    pub scene: Arc<Scene>,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// How a live picture is refined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// A coarse picture within this time, then finer ones.
    Within(Duration),
    /// The full picture at once.
    Whole,
}

/// A request for a picture of full quality.
#[derive(Clone, Debug)]
pub struct StillJob {
    /// Revision of the scene.
    pub revision: u64,
    /// The scene at that revision.
    pub scene: Arc<Scene>,
    /// The picture.
    pub request: RenderRequest,
    /// Where to write it. A picture to be saved outlives edits: it resumes when the live view is done.
    pub save_to: Option<PathBuf>,
}

/// A picture to look at.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Revision of the scene that it shows.
    pub revision: u64,
    /// The pixels traced so far: every `step`-th of every `step`-th row of the full picture.
    pub image: Arc<Image>,
    /// Full width and height in pixels.
    pub full_size: (usize, usize),
    /// Distance between traced pixels; 1 in a finished picture.
    pub step: usize,
    /// Its sampling, which determines how edges are smoothed.
    pub sampling: Sampling,
    /// Whether it is a still picture rather than the live view.
    pub is_still: bool,
    /// The part of the picture that is traced, if not all of it.
    pub region: Option<Region>,
    /// The cost so far.
    pub cost: RenderCost,
}

/// What the render threads are doing.
#[derive(Clone, Debug, PartialEq)]
pub enum Activity {
    /// Nothing that the user waits for; possibly measuring.
    Idle,
    /// Tracing the live view of a revision.
    Live {
        /// The revision.
        revision: u64,
        /// Time since the start, without pauses.
        elapsed: Duration,
    },
    /// Tracing a still picture.
    Still {
        /// Pixels traced, of [`Self::Still::total`].
        done: u64,
        /// Pixels of the picture.
        total: u64,
        /// Time since the start, without pauses.
        elapsed: Duration,
    },
}

/// The state of an export.
#[derive(Clone, Debug)]
pub struct ExportState {
    /// Id assigned by the worker.
    pub id: u64,
    /// Folder of the frames.
    pub folder: PathBuf,
    /// Frames done so far.
    pub done: Exported,
    /// Time spent on tracing and writing it, without pauses.
    pub busy: Duration,
    /// Whether it is paused until it is told to resume.
    pub is_paused: bool,
    /// A small picture of the frame that was traced last.
    pub last: Option<Arc<Image>>,
    /// How it ended, if it has; an error is in words for the user.
    pub ended: Option<Result<(), String>>,
}

/// Something that happened on a render thread and that the user should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A still picture was written to this file.
    Saved(PathBuf),
    /// A picture was not written, with the reason.
    Failed(String),
    /// The tracer itself failed; described in words for the user.
    Fault(String),
}
