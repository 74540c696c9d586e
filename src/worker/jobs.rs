//! What is asked of the render threads, and what they tell.

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

/// The kinds of work, the most urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum JobKind {
    /// The live view.
    Live,
    /// A question to the scene.
    Query,
    /// A small picture for the side.
    Thumbnail,
    /// A question that is answered by measuring, for seconds.
    Quality,
    /// A still picture to look at.
    Still,
    /// A still picture to be written.
    Save,
    /// A frame of an export.
    Export,
    /// A piece of the lab's study.
    Lab,
}

/// The threads that share the work. Nobody who edits waits for a picture that takes long: it is paused meanwhile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crew {
    /// For what the window shows next.
    Prompt,
    /// For what was asked for and may take long; begins and goes on while the other rests.
    Patient,
}

impl Crew {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Prompt, Self::Patient];

    /// What its thread is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Prompt => "glint-prompt",
            Self::Patient => "glint-patient",
        }
    }
}

impl JobKind {
    /// Which thread does it.
    pub fn crew(self) -> Crew {
        if self < Self::Still {
            Crew::Prompt
        } else {
            Crew::Patient
        }
    }

    /// Whether a new job of this kind stops one that runs, which begins anew: if it is more urgent for the same thread,
    /// or takes its place. Small pictures are done before anything could be gained by stopping them, and stop no
    /// measuring; a picture that is written is stopped by nothing. What measures time cannot be paused.
    pub fn preempts(self, running: Self) -> bool {
        let is_same = self.crew() == running.crew() || running == Self::Lab;
        let replaces = self == running && self.is_replaced();
        let waits = matches!(running, Self::Thumbnail | Self::Save)
            || (self, running) == (Self::Thumbnail, Self::Quality);
        is_same && !waits && (self < running || replaces)
    }

    /// Whether a new job of this kind lets one that runs wait.
    pub fn pauses(self, running: Self) -> bool {
        self.crew() == Crew::Prompt && running.crew() == Crew::Patient
    }

    /// Whether a new job of this kind takes the place of the one before.
    pub fn is_replaced(self) -> bool {
        matches!(self, Self::Live | Self::Quality | Self::Still | Self::Lab)
    }
}

/// What the live view shall show.
#[derive(Clone, Debug)]
pub struct LiveJob {
    /// Number of the scene's state; only ever grows.
    pub revision: u64,
    /// The scene at that revision.
    pub scene: Arc<Scene>,
    /// The picture, at its full resolution.
    pub request: RenderRequest,
    /// Whether coarse pictures may come first, to keep up with the hand that edits.
    pub pace: Pace,
}

/// A question to a scene that takes rays to answer.
#[derive(Clone, Debug)]
pub struct QueryJob {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What is asked; an older question of the same sort is dropped.
    pub question: Question,
}

/// What can be asked.
#[derive(Clone, Debug)]
pub enum Question {
    /// What every sample of a recorded flight sees, and what is known of that.
    Survey(Arc<Take>, Vec<Vec<Landmark>>),
    /// Which points the camera sees; the number is the asker's.
    Visible(u64, Box<Camera>, Vec<DVec3>),
    /// Which object is seen at each pixel of a picture, as if these were not there; the number is the
    /// asker's.
    Objects(u64, Box<RenderRequest>, Vec<Thing>),
    /// Which sampling the still picture needs.
    Quality(Goal),
}

/// The answer to a [`Question`].
#[derive(Clone, Debug)]
pub enum Answer {
    /// What the samples of this take see, see [`crate::trace::survey`].
    Survey(Arc<Take>, Vec<Vec<Landmark>>),
    /// For the question of this number: whether nothing stands before each point.
    Visible(u64, Vec<(DVec3, bool)>),
    /// For the question of this number: what is seen at each pixel without these.
    Objects(u64, ObjectMap, Vec<Thing>),
    /// What was measured and chosen for this; `None` if the tracer has failed.
    Quality(Goal, Option<Choice>),
}

/// A small picture for the side: traced when no live view waits, never stopped, one sample per pixel.
#[derive(Clone, Debug)]
pub struct ThumbnailJob {
    /// What the asker calls it.
    pub name: u64,
    /// What it shows.
    pub scene: Arc<Scene>,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// How a live picture is approached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// A coarse picture within this time, then finer ones.
    Within(Duration),
    /// The full picture at once.
    Whole,
}

/// A picture at full quality, on request.
#[derive(Clone, Debug)]
pub struct StillJob {
    /// Number of the scene's state.
    pub revision: u64,
    /// The scene at that revision.
    pub scene: Arc<Scene>,
    /// The picture.
    pub request: RenderRequest,
    /// The picture itself, if it is on screen: formats of 8 bits are written without tracing it again.
    pub traced: Option<Arc<Image>>,
    /// Where to write it. A picture that is to be written outlives edits: it goes on when the live view is done.
    pub save_to: Option<PathBuf>,
}

/// A picture to look at.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The scene's state that it shows.
    pub revision: u64,
    /// The pixels that are traced so far: every `step`-th of the full picture.
    pub image: Arc<Image>,
    /// Full width and height in pixels.
    pub full_size: (usize, usize),
    /// 1 in a finished picture.
    pub step: usize,
    /// How its edges are smoothed.
    pub sampling: Sampling,
    /// Whether this is the still picture and not the live view.
    pub is_still: bool,
    /// The part that is traced, if not all of it is.
    pub region: Option<Region>,
    /// What it cost so far.
    pub cost: RenderCost,
}

/// What the render thread is doing.
#[derive(Clone, Debug, PartialEq)]
pub enum Activity {
    /// Nothing that anybody waits for; perhaps measuring.
    Idle,
    /// Tracing the live view of a revision.
    Live {
        /// The revision.
        revision: u64,
        /// Time since it was started.
        elapsed: Duration,
    },
    /// Tracing a still picture.
    Still {
        /// Pixels traced, of [`Self::Still::total`].
        done: u64,
        /// Pixels of the picture.
        total: u64,
        /// Time since it was started.
        elapsed: Duration,
    },
}

/// An export, as far as it is.
#[derive(Clone, Debug)]
pub struct ExportState {
    /// What it is called by the worker.
    pub id: u64,
    /// Where the frames go.
    pub folder: PathBuf,
    /// How many frames are done.
    pub done: Exported,
    /// Time that the render thread has spent on it; what it waited does not count.
    pub busy: Duration,
    /// Whether it waits until it is told to go on.
    pub is_paused: bool,
    /// A small picture of the frame that was traced last.
    pub last: Option<Arc<Image>>,
    /// How it ended, if it has: the error in words for the user.
    pub ended: Option<Result<(), String>>,
}

/// What happened on the render thread that the user should know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A still picture was written to this file.
    Saved(PathBuf),
    /// A picture was not written, and why.
    Failed(String),
    /// The tracer itself failed, in words for the user.
    Fault(String),
}
