//! The handle on the render threads.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use super::jobs::{
    Activity, Answer, Crew, Event, Frame, JobKind, LiveJob, QueryJob, StillJob, ThumbnailJob,
};
use super::mailbox::Job;
use super::render_thread;
use super::shared::{Outbox, Shared};
use super::task::spawn;
use crate::image::Image;
use crate::lab::Study;
use crate::trace::{PoolError, RenderControl, Threads};

/// The system started no threads to trace with.
#[derive(Debug, thiserror::Error)]
pub enum RenderThreadError {
    /// Not those that trace.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// Not one of those that share out the work.
    #[error("cannot start a render thread: {0}")]
    Thread(#[source] std::io::Error),
}

/// The handle on the render threads. Dropping it ends them.
#[derive(Debug)]
pub struct Worker {
    pub(super) shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl Worker {
    /// Starts the render threads, each with `threads` tracing threads: of the two crews, one rests or waits. `wake` is
    /// called from them after every frame and event.
    ///
    /// # Errors
    /// [`RenderThreadError`] when the system starts no threads.
    pub fn new(
        threads: Option<usize>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, RenderThreadError> {
        let shared = Arc::new(Shared {
            mailbox: Mutex::default(),
            wakeup: Condvar::new(),
            outbox: Mutex::<Outbox>::default(),
            planner: Mutex::default(),
            until_quit: RenderControl::default(),
            wake: Box::new(wake),
        });
        let mut worker = Self {
            shared,
            threads: Vec::new(),
        };
        for crew in Crew::ALL {
            let pool = Threads::new(threads)?;
            let shared = Arc::clone(&worker.shared);
            let work = move || render_thread::run(&shared, crew, &pool);
            let thread = spawn(crew.name(), work).map_err(RenderThreadError::Thread)?;
            worker.threads.push(thread);
        }
        Ok(worker)
    }

    pub(super) fn put(&self, job: Job) {
        self.shared.mailbox().put(job);
        self.shared.wakeup.notify_all();
    }

    /// Asks for a live picture in place of any that waits; finer passes over an older one end
    /// within a few milliseconds. A still picture of an older revision is given up, unless it is
    /// to be written.
    pub fn submit(&self, job: LiveJob) {
        self.put(Job::Live(job));
    }

    /// Asks for a still picture. One to look at takes the place of any other such; one to be
    /// written waits its turn and is never given up.
    pub fn request_still(&self, job: StillJob) {
        self.put(Job::Still(job));
    }

    /// Asks for small pictures, in this order, before those that wait and in place of those of the same
    /// names.
    pub fn request_thumbnails(&self, jobs: Vec<ThumbnailJob>) {
        for job in jobs.into_iter().rev() {
            self.put(Job::Thumbnail(job));
        }
    }

    /// The small pictures that were finished since the last call, by name.
    pub fn take_thumbnails(&self) -> Vec<(u64, Image)> {
        std::mem::take(&mut self.shared.outbox().thumbnails)
    }

    /// Asks a question, in place of an older one of the same sort.
    pub fn ask(&self, job: QueryJob) {
        self.put(Job::Query(job));
    }

    /// Whether a question waits for its answer.
    pub fn is_asked(&self) -> bool {
        let mailbox = self.shared.mailbox();
        mailbox.has(JobKind::Query) || mailbox.has(JobKind::Quality)
    }

    /// The answers since the last call.
    pub fn take_answers(&self) -> Vec<Answer> {
        std::mem::take(&mut self.shared.outbox().answers)
    }

    /// Gives up the still picture to look at; those that are to be written go on.
    pub fn leave_still(&self) {
        self.shared.mailbox().give_up(JobKind::Still);
    }

    /// Gives up every still picture, waiting or running. Those that were to be written are told of
    /// as events; one that is traced already is written.
    pub fn cancel_still(&self) {
        let mut mailbox = self.shared.mailbox();
        mailbox.give_up(JobKind::Still);
        let waiting = mailbox.give_up(JobKind::Save).into_iter();
        let waiting = waiting.filter_map(|job| match job {
            Job::Still(still) => still.save_to,
            _ => None,
        });
        drop(mailbox);
        waiting.for_each(|path| self.shared.tell_unwritten(&path));
    }

    /// Measures a study, in place of any other, whenever there is nothing more urgent.
    pub fn measure(&self, study: Study) {
        self.stop_measuring();
        self.put(Job::Lab(Box::new(study)));
    }

    /// Gives the study up.
    pub fn stop_measuring(&self) {
        self.shared.mailbox().give_up(JobKind::Lab);
        self.shared.outbox().study = None;
    }

    /// Whether a study is being measured, or waits for that. What it has found by the time this is
    /// false can be taken.
    pub fn is_measuring(&self) -> bool {
        self.shared.mailbox().has(JobKind::Lab)
    }

    /// The study as far as it is measured, if it has got on since the last call.
    pub fn take_study(&self) -> Option<Study> {
        self.shared.outbox().study.take()
    }

    /// Whether a still picture is being traced, or waits for that.
    pub fn is_tracing_still(&self) -> bool {
        let mailbox = self.shared.mailbox();
        mailbox.has(JobKind::Still) || mailbox.has(JobKind::Save)
    }

    /// Whether a picture is being written, or waits for that.
    pub fn is_saving(&self) -> bool {
        self.shared.mailbox().has(JobKind::Save)
    }

    /// The newest live picture, then the newest still one, if there are any that were not taken yet.
    pub fn take_frame(&self) -> Option<Frame> {
        let mut outbox = self.shared.outbox();
        outbox.live.take().or_else(|| outbox.still.take())
    }

    /// What happened since the last call, in order.
    pub fn take_events(&self) -> Vec<Event> {
        std::mem::take(&mut self.shared.outbox().events)
    }

    /// What the render thread is doing, or is about to.
    pub fn activity(&self) -> Activity {
        let mailbox = self.shared.mailbox();
        let live = mailbox.running(Crew::Prompt);
        if let Some(running) = live.filter(|running| running.kind == JobKind::Live) {
            return Activity::Live {
                revision: running.revision,
                elapsed: running.spent(),
            };
        }
        if let Some(Job::Live(live)) = mailbox.waiting(JobKind::Live) {
            return Activity::Live {
                revision: live.revision,
                elapsed: Duration::ZERO,
            };
        }
        let is_still = |kind| matches!(kind, JobKind::Still | JobKind::Save);
        let still = mailbox.running(Crew::Patient);
        if let Some(running) = still.filter(|running| is_still(running.kind)) {
            return Activity::Still {
                done: running.control.pixels.load(Ordering::Relaxed),
                total: running.pixels,
                elapsed: running.spent(),
            };
        }
        let still = mailbox.waiting(JobKind::Still);
        match still.or_else(|| mailbox.waiting(JobKind::Save)) {
            Some(Job::Still(still)) => Activity::Still {
                done: 0,
                total: still.request.pixels(),
                elapsed: Duration::ZERO,
            },
            _ => Activity::Idle,
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        let mut mailbox = self.shared.mailbox();
        mailbox.quit();
        self.shared.until_quit.stop();
        drop(mailbox);
        self.shared.wakeup.notify_all();
        for thread in self.threads.drain(..) {
            // A panic on the thread was already shown as an event.
            let _ = thread.join();
        }
    }
}
