//! The background lane: one named thread that owns the tracer. The editor drops a job into a slot
//! and goes on; the newest job wins; finished pictures wait in another slot. Nothing here knows
//! about windows: `wake` is called whenever there is something to look at.

mod budget;
mod exporting;
mod exports;
mod frame_pool;
mod jobs;
mod render_thread;
mod task;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

pub use budget::BUDGET;
pub use exporting::{ExportStep, Exported, Exporting};
pub use jobs::{Activity, Event, ExportState, Frame, LiveJob, Pace, StillJob, ThumbnailJob};
pub use task::{panic_text, run_in_background};

use crate::image::Image;
use crate::lab::Study;
use crate::plan::RenderRequest;
use crate::trace::{PoolError, RenderControl, Threads};

/// The system started no threads for the lane.
#[derive(Debug, thiserror::Error)]
pub enum RenderThreadError {
    /// Not those that trace.
    #[error(transparent)]
    Pool(#[from] PoolError),
    /// Not the lane itself.
    #[error("cannot start the background lane: {0}")]
    Thread(std::io::Error),
}

/// The handle on the lane. Dropping it ends the thread.
#[derive(Debug)]
pub struct Worker {
    shared: Arc<Shared>,
    lane: Option<JoinHandle<()>>,
}

struct Shared {
    mailbox: Mutex<Mailbox>,
    wakeup: Condvar,
    news: Mutex<Outbox>,
    /// Of first passes, which only quitting stops.
    first_pass: RenderControl,
    wake: Box<dyn Fn() + Send + Sync>,
}

#[derive(Debug, Default)]
struct Mailbox {
    live: Option<LiveJob>,
    thumbnails: VecDeque<ThumbnailJob>,
    still: Option<StillJob>,
    /// Pictures that are to be written, in order.
    saves: VecDeque<StillJob>,
    /// Exports, in order.
    exports: VecDeque<(u64, Exporting)>,
    /// How many exports there were: the name of the newest.
    export_count: u64,
    /// The study that is being measured when there is nothing else to do.
    study: Option<Study>,
    running: Option<Running>,
    quit: bool,
}

#[derive(Debug)]
struct Running {
    job: RunningJob,
    control: Arc<RenderControl>,
    started: Instant,
}

#[derive(Debug)]
enum RunningJob {
    Live {
        revision: u64,
    },
    Still(StillJob),
    ThumbnailJob,
    /// A frame of the export of this name.
    Export(u64),
    /// A piece of the study.
    Lab,
    /// A piece of a study that was given up.
    GivenUp,
}

#[derive(Debug, Default)]
struct Outbox {
    live: Option<Frame>,
    still: Option<Frame>,
    thumbnails: Vec<(u64, Image)>,
    exports: Vec<ExportState>,
    study: Option<Study>,
    events: Vec<Event>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl Worker {
    /// Starts the lane with `threads` tracing threads. `wake` is called from the lane after every
    /// frame and event.
    ///
    /// # Errors
    /// [`RenderThreadError`] when the system starts no threads.
    pub fn new(
        threads: Option<usize>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Result<Self, RenderThreadError> {
        let threads = Threads::new(threads)?;
        let shared = Arc::new(Shared {
            mailbox: Mutex::default(),
            wakeup: Condvar::new(),
            news: Mutex::default(),
            first_pass: RenderControl::default(),
            wake: Box::new(wake),
        });
        let lane = task::spawn("glint-lane", {
            let shared = Arc::clone(&shared);
            move || render_thread::run(&shared, &threads)
        });
        let lane = Some(lane.map_err(RenderThreadError::Thread)?);
        Ok(Self { shared, lane })
    }

    /// Asks for a live picture in place of any that waits; finer passes over an older one end
    /// within a few milliseconds. A still picture of an older revision is given up, unless it is
    /// to be written.
    pub fn submit(&self, job: LiveJob) {
        let mut mailbox = lock(&self.shared.mailbox);
        mailbox.still.take_if(|still| still.revision < job.revision);
        mailbox.stop_running();
        mailbox.live = Some(job);
        drop(mailbox);
        self.shared.wakeup.notify_one();
    }

    /// Asks for a still picture. One to look at takes the place of any other such; one to be
    /// written waits its turn and is never given up.
    pub fn request_still(&self, job: StillJob) {
        let mut mailbox = lock(&self.shared.mailbox);
        if let Some(Running {
            job: RunningJob::Lab | RunningJob::Export(_),
            ..
        }) = mailbox.running
        {
            mailbox.stop_running();
        }
        if job.save_to.is_some() {
            mailbox.saves.push_back(job);
        } else {
            if matches!(
                &mailbox.running,
                Some(Running {
                    job: RunningJob::Still(_),
                    ..
                })
            ) {
                mailbox.stop_running();
            }
            mailbox.still = Some(job);
        }
        drop(mailbox);
        self.shared.wakeup.notify_one();
    }

    /// Asks for small pictures, in this order, before others that wait and in place of those of the
    /// same names.
    pub fn request_sketches(&self, thumbnails: Vec<ThumbnailJob>) {
        let mut mailbox = lock(&self.shared.mailbox);
        let waiting = std::mem::take(&mut mailbox.thumbnails);
        mailbox.thumbnails = thumbnails.into();
        let is_new = |old: &ThumbnailJob| mailbox.thumbnails.iter().any(|new| new.name == old.name);
        let kept: Vec<ThumbnailJob> = waiting.into_iter().filter(|old| !is_new(old)).collect();
        mailbox.thumbnails.extend(kept);
        if let Some(Running {
            job: RunningJob::Lab,
            ..
        }) = mailbox.running
        {
            mailbox.stop_running();
        }
        drop(mailbox);
        self.shared.wakeup.notify_one();
    }

    /// The small pictures that were finished since the last call, by name.
    pub fn take_sketches(&self) -> Vec<(u64, Image)> {
        std::mem::take(&mut lock(&self.shared.news).thumbnails)
    }

    /// Gives up every still picture, waiting or running. Those that were to be written are told of
    /// as events.
    pub fn cancel_still(&self) {
        let mut mailbox = lock(&self.shared.mailbox);
        mailbox.still = None;
        let mut given_up: Vec<PathBuf> = mailbox
            .saves
            .drain(..)
            .filter_map(|job| job.save_to)
            .collect();
        if let Some(Running {
            job: RunningJob::Still(still),
            control,
            ..
        }) = &mut mailbox.running
        {
            control.stop.store(true, Ordering::Relaxed);
            given_up.extend(still.save_to.take());
        }
        drop(mailbox);
        for path in given_up {
            self.shared
                .tell(Event::Failed(format!("{} was not written", path.display())));
        }
    }

    /// Measures a study, in place of any other, whenever there is nothing more urgent.
    pub fn measure(&self, study: Study) {
        self.replace_study(Some(study));
        self.shared.wakeup.notify_one();
    }

    /// Gives the study up.
    pub fn stop_measuring(&self) {
        self.replace_study(None);
    }

    fn replace_study(&self, study: Option<Study>) {
        let mut mailbox = lock(&self.shared.mailbox);
        mailbox.study = study;
        if let Some(Running {
            job: job @ RunningJob::Lab,
            control,
            ..
        }) = &mut mailbox.running
        {
            control.stop.store(true, Ordering::Relaxed);
            // What comes back from it is not wanted any more.
            *job = RunningJob::GivenUp;
        }
        lock(&self.shared.news).study = None;
    }

    /// Whether a study is being measured, or waits for that. What it has found by the time this is
    /// false can be taken.
    pub fn is_measuring(&self) -> bool {
        let mailbox = lock(&self.shared.mailbox);
        let running = mailbox.running.as_ref().map(|running| &running.job);
        mailbox.study.is_some() || matches!(running, Some(RunningJob::Lab))
    }

    /// The study as far as it is measured, if it has got on since the last call.
    pub fn take_study(&self) -> Option<Study> {
        lock(&self.shared.news).study.take()
    }

    /// Whether a picture is being written, or waits for that.
    pub fn is_saving(&self) -> bool {
        let mailbox = lock(&self.shared.mailbox);
        let running = mailbox.running.as_ref().map(|running| &running.job);
        let is_running = matches!(
            running,
            Some(RunningJob::Still(StillJob {
                save_to: Some(_),
                ..
            }))
        );
        is_running || !mailbox.saves.is_empty()
    }

    /// The newest live picture, then the newest still one, if there are any that were not taken yet.
    pub fn take_frame(&self) -> Option<Frame> {
        let mut news = lock(&self.shared.news);
        news.live.take().or_else(|| news.still.take())
    }

    /// What happened since the last call, in order.
    pub fn take_events(&self) -> Vec<Event> {
        std::mem::take(&mut lock(&self.shared.news).events)
    }

    /// What the lane is doing, or is about to.
    pub fn activity(&self) -> Activity {
        let mailbox = lock(&self.shared.mailbox);
        let still = mailbox.still.as_ref().or(mailbox.saves.front());
        let running = mailbox.running.as_ref();
        match (running.map(|running| &running.job), &mailbox.live, still) {
            (Some(RunningJob::Live { revision }), ..) => Activity::Live {
                revision: *revision,
            },
            (Some(RunningJob::Still(_)), ..) => {
                running.map_or(Activity::Idle, Running::still_activity)
            }
            (_, Some(live), _) => Activity::Live {
                revision: live.revision,
            },
            (_, None, Some(still)) => Activity::Still {
                done: 0,
                total: pixels(&still.request),
                elapsed: Duration::ZERO,
            },
            (_, None, None) => Activity::Idle,
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        let mut mailbox = lock(&self.shared.mailbox);
        mailbox.quit = true;
        self.shared.first_pass.stop.store(true, Ordering::Relaxed);
        mailbox.stop_running();
        drop(mailbox);
        self.shared.wakeup.notify_one();
        if let Some(lane) = self.lane.take() {
            // A panic on the lane was already shown as an event.
            let _ = lane.join();
        }
    }
}

impl Mailbox {
    fn stop_running(&self) {
        if let Some(running) = &self.running {
            running.control.stop.store(true, Ordering::Relaxed);
        }
    }
}

impl Running {
    fn still_activity(&self) -> Activity {
        let total = match &self.job {
            RunningJob::Still(still) => pixels(&still.request),
            RunningJob::Live { .. }
            | RunningJob::ThumbnailJob
            | RunningJob::Export(_)
            | RunningJob::Lab
            | RunningJob::GivenUp => 0,
        };
        let done = self.control.pixels.load(Ordering::Relaxed);
        Activity::Still {
            done,
            total,
            elapsed: self.started.elapsed(),
        }
    }
}

fn pixels(request: &RenderRequest) -> u64 {
    u64::from(request.width) * u64::from(request.height)
}

/// A panic while the lock was held left plain data behind: it is used as it is.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
