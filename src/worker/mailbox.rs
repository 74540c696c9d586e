//! The mailbox: waiting and running jobs.

use std::mem::{Discriminant, discriminant};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::jobs::{
    Crew, ExportState, JobKind, LiveJob, QueryJob, Question, StillJob, ThumbnailJob,
};
use crate::export::Exporting;
use crate::lab::Study;
use crate::trace::RenderControl;

type QuestionSort = Discriminant<Question>;

/// A job.
#[derive(Debug)]
pub enum Job {
    Live(LiveJob),
    /// A live picture whose pixels have one sample each so far.
    Smooth(LiveJob),
    Query(QueryJob),
    Thumbnail(ThumbnailJob),
    /// To look at, or to be saved.
    Still(StillJob),
    /// The export of this id.
    Export(u64, Box<Exporting>),
    Lab(Box<Study>),
}

impl Job {
    /// The kind of the job, which determines its urgency.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Live(_) => JobKind::Live,
            Self::Smooth(_) => JobKind::Smooth,
            Self::Query(QueryJob {
                question: Question::Quality(_),
                ..
            }) => JobKind::Quality,
            Self::Query(_) => JobKind::Query,
            Self::Thumbnail(_) => JobKind::Thumbnail,
            Self::Still(StillJob { save_to: None, .. }) => JobKind::Still,
            Self::Still(StillJob {
                save_to: Some(_), ..
            }) => JobKind::Save,
            Self::Export(..) => JobKind::Export,
            Self::Lab(_) => JobKind::Lab,
        }
    }

    /// Whether `newer` makes this job pointless.
    fn is_replaced_by(&self, newer: &Self) -> bool {
        match (self, newer) {
            (Self::Thumbnail(old), Self::Thumbnail(new)) => old.name == new.name,
            _ => newer.replaces(self.kind(), self.revision(), self.question()),
        }
    }

    /// Whether it makes an older job pointless that has this kind, revision and sort of question.
    fn replaces(&self, kind: JobKind, revision: u64, question: Option<QuestionSort>) -> bool {
        // A still picture to look at is outdated once the scene has changed.
        let is_live = self.kind() == JobKind::Live;
        let is_outdated = is_live && kind == JobKind::Still && revision < self.revision()
            || is_live && kind == JobKind::Smooth;
        let is_same = kind == self.kind() && kind.is_replaced();
        let is_asked_anew = question.is_some() && question == self.question();
        is_outdated || is_same || is_asked_anew
    }

    /// Revision of the scene, for live and still pictures; 0 for others.
    fn revision(&self) -> u64 {
        match self {
            Self::Live(live) | Self::Smooth(live) => live.revision,
            Self::Still(still) => still.revision,
            _ => 0,
        }
    }

    /// The sort of question it asks, if it is a question.
    fn question(&self) -> Option<QuestionSort> {
        match self {
            Self::Query(query) => Some(discriminant(&query.question)),
            _ => None,
        }
    }

    fn export(&self) -> Option<u64> {
        match self {
            Self::Export(id, _) => Some(*id),
            _ => None,
        }
    }
}

/// A running job.
#[derive(Debug)]
pub struct Running {
    /// The kind of the job, which determines its urgency.
    pub kind: JobKind,
    /// Revision of the scene, for live and still pictures; 0 for others.
    pub revision: u64,
    /// Number of pixels of a still picture; 0 for others.
    pub pixels: u64,
    /// Where a still picture is to be written, if it is.
    pub save_to: Option<PathBuf>,
    /// Id of the export, if it is one.
    export: Option<u64>,
    /// The sort of question, if it is one.
    question: Option<QuestionSort>,
    /// Stops it.
    pub control: Arc<RenderControl>,
    /// When it was started.
    started: Instant,
    /// Whether it is no longer wanted: once stopped, it does not return to the queue.
    pub is_given_up: bool,
}

impl Running {
    fn new(job: &Job, control: &Arc<RenderControl>) -> Self {
        let (pixels, save_to) = match job {
            Job::Still(still) => (still.request.pixels(), still.save_to.clone()),
            _ => (0, None),
        };
        Self {
            kind: job.kind(),
            revision: job.revision(),
            pixels,
            save_to,
            export: job.export(),
            question: job.question(),
            control: Arc::clone(control),
            started: Instant::now(),
            is_given_up: false,
        }
    }

    /// Stops it for good.
    pub fn give_up(&mut self) {
        self.is_given_up = true;
        self.control.stop();
    }

    /// Time since it was started, without pauses.
    pub fn spent(&self) -> Duration {
        let spent = self.started.elapsed();
        spent.saturating_sub(self.control.paused())
    }
}

/// The queue of waiting jobs, and the running ones.
#[derive(Debug, Default)]
pub struct Mailbox {
    /// In order of arrival, except for thumbnails, which go first.
    waiting: Vec<Job>,
    /// The running job of each crew.
    running: [Option<Running>; 2],
    /// Number of exports so far: the id of the newest.
    pub export_count: u64,
    /// Whether the threads are to end.
    pub quit: bool,
}

impl Mailbox {
    /// Adds a job: it replaces those that it makes pointless, and stops or pauses running ones if it is more urgent.
    pub fn put(&mut self, job: Job) {
        self.waiting.retain(|old| !old.is_replaced_by(&job));
        for running in self.running.iter_mut().flatten() {
            if job.replaces(running.kind, running.revision, running.question) {
                running.give_up();
            } else if job.kind().preempts(running.kind) {
                running.control.stop();
            } else if job.kind().pauses(running.kind) {
                running.control.pause();
            }
        }
        // The newest thumbnails are the ones wanted now.
        let index = match job {
            Job::Thumbnail(_) => 0,
            _ => self.waiting.len(),
        };
        self.waiting.insert(index, job);
    }

    /// The running job of a crew.
    pub fn running(&self, crew: Crew) -> Option<&Running> {
        self.running[crew as usize].as_ref()
    }

    /// Whether a job for what the window shows next is running or waiting.
    fn has_prompt_work(&self) -> bool {
        let mut waiting = self.waiting.iter();
        self.running(Crew::Prompt).is_some() || waiting.any(|job| job.kind().crew() == Crew::Prompt)
    }

    /// Whether the running job of the patient crew is paused.
    pub fn is_paused(&self) -> bool {
        let running = self.running(Crew::Patient);
        running.is_some_and(|running| running.control.is_paused())
    }

    /// Resumes the paused job, unless another one for the window has arrived in the meantime.
    pub fn resume(&self) {
        let running = self.running(Crew::Patient);
        if let Some(running) = running.filter(|_| !self.has_prompt_work()) {
            running.control.go_on();
        }
    }

    /// Takes out the most urgent job of a crew, the first in the queue of its kind. Paused exports are skipped.
    pub fn next(
        &mut self,
        crew: Crew,
        exports: &[ExportState],
    ) -> Option<(Job, Arc<RenderControl>)> {
        if crew == Crew::Patient && self.has_prompt_work() {
            return None;
        }
        let is_paused = |job: &Job| {
            let id = job.export();
            let mut states = exports.iter();
            id.is_some_and(|id| states.any(|state| state.id == id && state.is_paused))
        };
        let ready = self.waiting.iter().enumerate();
        let ready = ready.filter(|(_, job)| job.kind().crew() == crew && !is_paused(job));
        let (index, _) = ready.min_by_key(|(_, job)| job.kind())?;
        let job = self.waiting.remove(index);
        let control = Arc::new(RenderControl::default());
        self.running[crew as usize] = Some(Running::new(&job, &control));
        Some((job, control))
    }

    /// Notes that a crew has ended its job, and returns what was running. A `stopped` job becomes the next of its
    /// kind, unless it was given up.
    pub fn finish(&mut self, crew: Crew, stopped: Option<Job>) -> Option<Running> {
        let running = self.running[crew as usize].take();
        let is_wanted = running.as_ref().is_some_and(|running| !running.is_given_up);
        if let Some(job) = stopped.filter(|_| is_wanted) {
            self.waiting.insert(0, job);
        }
        running
    }

    /// The first waiting job of a kind.
    pub fn waiting(&self, kind: JobKind) -> Option<&Job> {
        self.waiting.iter().find(|job| job.kind() == kind)
    }

    /// Whether a job of a kind is running or waiting.
    pub fn has(&self, kind: JobKind) -> bool {
        let mut running = self.running.iter().flatten();
        running.any(|running| running.kind == kind && !running.is_given_up)
            || self.waiting(kind).is_some()
    }

    /// Gives up the jobs of a kind, waiting or running. Returns those that were waiting.
    pub fn give_up(&mut self, kind: JobKind) -> Vec<Job> {
        let running = self.running.iter_mut().flatten();
        for running in running.filter(|running| running.kind == kind) {
            running.give_up();
        }
        let (gone, kept) = std::mem::take(&mut self.waiting)
            .into_iter()
            .partition(|job| job.kind() == kind);
        self.waiting = kept;
        gone
    }

    /// Stops an export within the frame being traced, which is traced again next.
    pub fn stop_export(&self, id: u64) {
        let running = self.running(Crew::Patient);
        if let Some(running) = running.filter(|running| running.export == Some(id)) {
            running.control.stop();
        }
    }

    /// Ends the threads and all their jobs.
    pub fn quit(&mut self) {
        self.quit = true;
        for running in self.running.iter_mut().flatten() {
            running.give_up();
        }
    }

    /// Removes a waiting export from the queue.
    pub fn remove_export(&mut self, id: u64) -> Option<Job> {
        let index = self
            .waiting
            .iter()
            .position(|job| job.export() == Some(id))?;
        Some(self.waiting.remove(index))
    }
}

#[cfg(test)]
mod tests;
