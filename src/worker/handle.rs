//! The handle to the render threads.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use super::jobs::{
    Activity, Answer, Crew, Event, Frame, JobKind, LiveJob, QueryJob, StillJob, ThumbnailJob,
};
use super::mailbox::Job;
use super::render_thread;
use super::shared::Shared;
use super::task::spawn;
use crate::image::Image;
use crate::lab::Study;
use crate::trace::{PoolError, RenderControl, Threads};

/// The render threads could not be started.
#[derive(Debug, thiserror::Error)]
pub enum RenderThreadError {
    /// The threads that trace could not be started.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// One of the render threads, which distribute the work, could not be started.
    #[error("cannot start a render thread: {0}")]
    Thread(#[source] std::io::Error),
}

/// The handle to the render threads. Dropping it ends them.
#[derive(Debug)]
pub struct Worker {
    pub(super) shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl Worker {
    /// Starts the render threads, each with `threads` tracing threads of its own: of the two crews, only one traces
    /// at a time. They call `wake` after every frame and event.
    ///
    /// # Errors
    /// [`RenderThreadError`], if the system refuses a thread.
    pub fn new(
        threads: Option<usize>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, RenderThreadError> {
        let shared = Arc::new(Shared {
            mailbox: Mutex::default(),
            wakeup: Condvar::new(),
            outbox: Mutex::default(),
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

    /// Requests a live picture, replacing any that waits; finer passes over an older one end within a few
    /// milliseconds. A still picture of an older revision is given up, unless it is to be saved.
    pub fn submit(&self, job: LiveJob) {
        self.put(Job::Live(job));
    }

    /// Requests a still picture. One to look at replaces any other such; one to be saved waits its turn and is not
    /// replaced.
    pub fn request_still(&self, job: StillJob) {
        self.put(Job::Still(job));
    }

    /// Requests thumbnails, in this order, before those that wait, and replacing those of the same names.
    pub fn request_thumbnails(&self, jobs: Vec<ThumbnailJob>) {
        for job in jobs.into_iter().rev() {
            self.put(Job::Thumbnail(job));
        }
    }

    /// Takes the thumbnails finished since the last call, by name.
    pub fn take_thumbnails(&self) -> Vec<(u64, Image)> {
        std::mem::take(&mut self.shared.outbox().thumbnails)
    }

    /// Asks a question, replacing an older one of the same sort.
    pub fn ask(&self, job: QueryJob) {
        self.put(Job::Query(job));
    }

    /// Whether a question is not answered yet.
    pub fn is_asked(&self) -> bool {
        let mailbox = self.shared.mailbox();
        mailbox.has(JobKind::Query) || mailbox.has(JobKind::Quality)
    }

    /// Takes the answers since the last call.
    pub fn take_answers(&self) -> Vec<Answer> {
        std::mem::take(&mut self.shared.outbox().answers)
    }

    /// Gives up the still picture to look at; those to be saved go on.
    pub fn leave_still(&self) {
        self.shared.mailbox().give_up(JobKind::Still);
    }

    /// Gives up every still picture, waiting or running. Those that were to be saved are reported as events; one that
    /// is traced already is still written.
    pub fn cancel_still(&self) {
        let mut mailbox = self.shared.mailbox();
        mailbox.give_up(JobKind::Still);
        let waiting = mailbox.give_up(JobKind::Save).into_iter();
        let waiting = waiting.filter_map(|job| match job {
            Job::Still(still) => still.save_to,
            _ => None,
        });
        drop(mailbox);
        waiting.for_each(|path| self.shared.report_unwritten(&path));
    }

    /// Measures a study, replacing any other, while there is nothing more urgent.
    pub fn measure(&self, study: Study) {
        self.stop_measuring();
        self.put(Job::Lab(Box::new(study)));
    }

    /// Gives up the study.
    pub fn stop_measuring(&self) {
        self.shared.mailbox().give_up(JobKind::Lab);
        self.shared.outbox().study = None;
    }

    /// Whether a study is being measured or waits to be. Once this is false, its last results can be taken.
    pub fn is_measuring(&self) -> bool {
        self.shared.mailbox().has(JobKind::Lab)
    }

    /// Takes the study with the results so far, if there are new ones since the last call.
    pub fn take_study(&self) -> Option<Study> {
        self.shared.outbox().study.take()
    }

    /// Whether a still picture is being traced or waits to be.
    pub fn is_tracing_still(&self) -> bool {
        let mailbox = self.shared.mailbox();
        mailbox.has(JobKind::Still) || mailbox.has(JobKind::Save)
    }

    /// Whether a picture to be saved is being traced or written, or waits to be.
    pub fn is_saving(&self) -> bool {
        self.shared.mailbox().has(JobKind::Save)
    }

    /// Takes the newest live picture, or else the newest still one, if not taken yet.
    pub fn take_frame(&self) -> Option<Frame> {
        let mut outbox = self.shared.outbox();
        outbox.live.take().or_else(|| outbox.still.take())
    }

    /// Takes the events since the last call, in order.
    pub fn take_events(&self) -> Vec<Event> {
        std::mem::take(&mut self.shared.outbox().events)
    }

    /// What the render threads are doing, or will do next.
    pub fn activity(&self) -> Activity {
        let mailbox = self.shared.mailbox();
        let live = mailbox.running(Crew::Prompt);
        let is_live = |kind| matches!(kind, JobKind::Live | JobKind::Smooth);
        if let Some(running) = live.filter(|running| is_live(running.kind)) {
            return Activity::Live {
                revision: running.revision,
                elapsed: running.spent(),
            };
        }
        let waiting = mailbox.waiting(JobKind::Live);
        let waiting = waiting.or_else(|| mailbox.waiting(JobKind::Smooth));
        if let Some(Job::Live(live) | Job::Smooth(live)) = waiting {
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
