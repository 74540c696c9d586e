//! What waits to be done, and what is being done.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::jobs::{ExportState, JobKind, LiveJob, QueryJob, Question, StillJob, ThumbnailJob};
use crate::export::Exporting;
use crate::lab::Study;
use crate::trace::RenderControl;

/// Something to be done.
#[derive(Debug)]
pub enum Job {
    Live(LiveJob),
    Query(QueryJob),
    Thumbnail(ThumbnailJob),
    /// To look at, or to be written.
    Still(StillJob),
    /// The export of this name.
    Export(u64, Box<Exporting>),
    Lab(Box<Study>),
}

impl Job {
    /// How urgent it is.
    pub fn kind(&self) -> JobKind {
        match self {
            Self::Live(_) => JobKind::Live,
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
            (Self::Query(old), Self::Query(new)) => matches!(
                (&old.question, &new.question),
                (Question::Survey(..), Question::Survey(..))
                    | (Question::Visible(..), Question::Visible(..))
                    | (Question::Objects(..), Question::Objects(..))
                    | (Question::Quality(..), Question::Quality(..))
            ),
            (Self::Thumbnail(old), Self::Thumbnail(new)) => old.name == new.name,
            // A still picture to look at is of the past once the scene has changed.
            (Self::Still(old), Self::Live(new)) => {
                old.save_to.is_none() && old.revision < new.revision
            }
            _ => self.kind() == newer.kind() && newer.kind().is_replaced(),
        }
    }

    fn export(&self) -> Option<u64> {
        match self {
            Self::Export(id, _) => Some(*id),
            _ => None,
        }
    }
}

/// What is being done.
#[derive(Debug)]
pub struct Running {
    /// How urgent it is.
    pub kind: JobKind,
    /// The scene's state, of live and still pictures.
    pub revision: u64,
    /// Pixels of a still picture.
    pub pixels: u64,
    /// Where a still picture is to be written.
    pub save_to: Option<PathBuf>,
    /// The name of an export.
    pub export: Option<u64>,
    /// Stops it.
    pub control: Arc<RenderControl>,
    /// When it was begun.
    pub started: Instant,
    /// Whether it is not wanted any more: stopped, it does not come back.
    pub is_given_up: bool,
}

impl Running {
    fn new(job: &Job, control: &Arc<RenderControl>) -> Self {
        let (revision, pixels, save_to) = match job {
            Job::Live(live) => (live.revision, 0, None),
            Job::Still(still) => (
                still.revision,
                still.request.pixels(),
                still.save_to.clone(),
            ),
            _ => (0, 0, None),
        };
        Self {
            kind: job.kind(),
            revision,
            pixels,
            save_to,
            export: job.export(),
            control: Arc::clone(control),
            started: Instant::now(),
            is_given_up: false,
        }
    }

    fn stop(&self) {
        self.control.stop.store(true, Ordering::Relaxed);
    }

    /// Stops it for good.
    pub fn give_up(&mut self) {
        self.is_given_up = true;
        self.stop();
    }
}

/// The list of what waits, and what is being done.
#[derive(Debug, Default)]
pub struct Mailbox {
    /// In order of arrival, but for small pictures.
    waiting: Vec<Job>,
    /// What is being done.
    pub running: Option<Running>,
    /// How many exports there were: the name of the newest.
    pub export_count: u64,
    /// Whether the thread is to end.
    pub quit: bool,
}

impl Mailbox {
    /// Takes a job in: it takes the place of those that it makes pointless, and stops the running one
    /// if it is more urgent.
    pub fn put(&mut self, job: Job) {
        self.waiting.retain(|old| !old.is_replaced_by(&job));
        if let Some(running) = &mut self.running {
            if job.kind().preempts(running.kind) {
                running.stop();
            }
            let is_outdated = running.kind == JobKind::Still
                && matches!(&job, Job::Live(live) if running.revision < live.revision);
            let is_replaced = running.kind == job.kind() && job.kind().is_replaced();
            running.is_given_up |= is_outdated || is_replaced;
        }
        // The newest small pictures are those that are looked for.
        let index = match job {
            Job::Thumbnail(_) => 0,
            _ => self.waiting.len(),
        };
        self.waiting.insert(index, job);
    }

    /// Takes the most urgent job out, the first of those. An export that is paused waits.
    pub fn next(&mut self, exports: &[ExportState]) -> Option<(Job, Arc<RenderControl>)> {
        let is_paused = |job: &Job| {
            let id = job.export();
            let mut states = exports.iter();
            id.is_some_and(|id| states.any(|state| state.id == id && state.is_paused))
        };
        let ready = self.waiting.iter().enumerate();
        let ready = ready.filter(|(_, job)| !is_paused(job));
        let (index, _) = ready.min_by_key(|(_, job)| job.kind())?;
        let job = self.waiting.remove(index);
        let control = Arc::new(RenderControl::default());
        self.running = Some(Running::new(&job, &control));
        Some((job, control))
    }

    /// Nothing is running any more. A job that was stopped for a more urgent one is the next of its
    /// kind, unless it was given up. What was running.
    pub fn finish(&mut self, stopped: Option<Job>) -> Option<Running> {
        let running = self.running.take();
        let is_wanted = running.as_ref().is_some_and(|running| !running.is_given_up);
        if let Some(job) = stopped.filter(|_| is_wanted) {
            self.waiting.insert(0, job);
        }
        running
    }

    /// The first job of a kind that waits.
    pub fn waiting(&self, kind: JobKind) -> Option<&Job> {
        self.waiting.iter().find(|job| job.kind() == kind)
    }

    /// Whether a job of a kind runs or waits.
    pub fn has(&self, kind: JobKind) -> bool {
        let mut running = self.running.iter();
        running.any(|running| running.kind == kind && !running.is_given_up)
            || self.waiting(kind).is_some()
    }

    /// Gives the jobs of a kind up, those that wait and the one that runs. Those that waited.
    pub fn give_up(&mut self, kind: JobKind) -> Vec<Job> {
        if let Some(running) = self.running.as_mut().filter(|running| running.kind == kind) {
            running.give_up();
        }
        let (gone, kept) = std::mem::take(&mut self.waiting)
            .into_iter()
            .partition(|job| job.kind() == kind);
        self.waiting = kept;
        gone
    }

    /// Stops the frame of an export that is being traced; it is the next again.
    pub fn stop_export(&self, id: u64) {
        if let Some(running) = self.running.as_ref().filter(|r| r.export == Some(id)) {
            running.stop();
        }
    }

    /// Takes an export that waits out of the list.
    pub fn remove_export(&mut self, id: u64) -> Option<Job> {
        let index = self
            .waiting
            .iter()
            .position(|job| job.export() == Some(id))?;
        Some(self.waiting.remove(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::Goal;
    use crate::plan::RenderRequest;
    use crate::scene::Scene;
    use crate::worker::jobs::Pace;

    fn live(revision: u64) -> Job {
        Job::Live(LiveJob {
            revision,
            scene: Arc::new(Scene::empty()),
            request: RenderRequest::sized(8, 8),
            pace: Pace::Whole,
        })
    }

    fn still(revision: u64, save_to: Option<&str>) -> Job {
        Job::Still(StillJob {
            revision,
            scene: Arc::new(Scene::empty()),
            request: RenderRequest::sized(8, 8),
            traced: None,
            save_to: save_to.map(PathBuf::from),
        })
    }

    fn lab() -> Job {
        let scene = Arc::new(Scene::empty());
        Job::Lab(Box::new(Study::of_side(scene, 8)))
    }

    fn is_stopped(mailbox: &Mailbox) -> bool {
        let running = mailbox.running.as_ref().expect("running");
        running.control.stop.load(Ordering::Relaxed)
    }

    #[test]
    fn the_most_urgent_runs_first_and_the_newest_live_view_wins() {
        let mut mailbox = Mailbox::default();
        for job in [lab(), still(1, Some("a")), live(1), still(1, None), live(2)] {
            mailbox.put(job);
        }
        let mut kinds = Vec::new();
        while let Some((job, _)) = mailbox.next(&[]) {
            if let Job::Live(live) = &job {
                assert_eq!(live.revision, 2);
            }
            kinds.push(job.kind());
            mailbox.finish(None);
        }
        // The live view of a newer revision has made the still picture to look at pointless.
        assert_eq!(kinds, [JobKind::Live, JobKind::Save, JobKind::Lab]);
    }

    #[test]
    fn one_rule_stops_the_less_urgent_and_brings_it_back() {
        let mut mailbox = Mailbox::default();
        mailbox.put(still(1, Some("a")));
        let (job, _) = mailbox.next(&[]).expect("a job");
        mailbox.put(lab());
        assert!(!is_stopped(&mailbox), "the lab waits");
        mailbox.put(live(2));
        assert!(is_stopped(&mailbox));
        mailbox.finish(Some(job));
        assert_eq!(mailbox.next(&[]).expect("a job").0.kind(), JobKind::Live);
        mailbox.finish(None);
        assert_eq!(mailbox.next(&[]).expect("a job").0.kind(), JobKind::Save);
    }

    #[test]
    fn what_is_replaced_does_not_come_back() {
        let mut mailbox = Mailbox::default();
        mailbox.put(still(1, None));
        let (job, _) = mailbox.next(&[]).expect("a job");
        mailbox.put(live(2));
        mailbox.finish(Some(job));
        assert_eq!(mailbox.next(&[]).expect("a job").0.kind(), JobKind::Live);
        mailbox.finish(None);
        assert!(mailbox.next(&[]).is_none());
    }

    #[test]
    fn a_quality_that_is_asked_for_takes_the_place_of_the_one_before() {
        let quality = |error| {
            Job::Query(QueryJob {
                scene: Arc::new(Scene::empty()),
                question: Question::Quality(Goal::Within(error)),
            })
        };
        let mut mailbox = Mailbox::default();
        mailbox.put(quality(0.1));
        let (job, _) = mailbox.next(&[]).expect("a job");
        mailbox.put(quality(0.2));
        assert!(is_stopped(&mailbox));
        mailbox.finish(Some(job));
        let (job, _) = mailbox.next(&[]).expect("a job");
        assert!(matches!(
            job,
            Job::Query(QueryJob { question: Question::Quality(Goal::Within(error)), .. }) if error == 0.2
        ));
        mailbox.finish(None);
        assert!(mailbox.next(&[]).is_none());
    }

    #[test]
    fn small_pictures_are_not_stopped() {
        let mut mailbox = Mailbox::default();
        mailbox.put(Job::Thumbnail(ThumbnailJob {
            name: 1,
            scene: Arc::new(Scene::empty()),
            size: (8, 8),
        }));
        mailbox.next(&[]).expect("a job");
        mailbox.put(live(1));
        assert!(!is_stopped(&mailbox));
    }
}
