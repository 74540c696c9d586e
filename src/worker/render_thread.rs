//! The thread itself: takes the most urgent job, traces, publishes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use super::budget::Budget;
use super::frame_pool::FramePool;
use super::task::panic_text;
use super::{
    Event, ExportState, ExportStep, Exporting, Frame, LiveJob, Pace, Running, RunningJob, Shared,
    StillJob, ThumbnailJob, lock,
};
use crate::export::save_image;
use crate::image::{Image, RenderCost, render};
use crate::lab::Study;
use crate::plan::{RenderRequest, Sampling};
use crate::trace::{Grid, Pass, Rays, RenderControl, Threads, Tracer};

/// Time between two reports of a study.
const NEWS: Duration = Duration::from_millis(250);

enum Job {
    Live(LiveJob),
    ThumbnailJob(ThumbnailJob),
    Still(StillJob),
    Export(u64, Box<Exporting>),
    Lab(Box<Study>),
}

/// How a job ended.
enum JobOutcome {
    /// There is nothing more to do for it.
    Ended,
    /// It was stopped on the way.
    Stopped,
    /// A frame of an export, or what came in its way.
    Export(ExportStep),
}

/// Works until told to quit. A panic in a job becomes an event, and the lane lives on.
pub(super) fn run(shared: &Shared, threads: &Threads) {
    let mut budget = Budget::new();
    let mut frame_pool = FramePool::default();
    let mut woken = Instant::now();
    while let Some((mut job, control)) = next_job(shared) {
        let mut outcome = catch_unwind(AssertUnwindSafe(|| {
            threads.run(|| match &mut job {
                Job::Live(job) => {
                    let start = Instant::now();
                    let mut live = Live {
                        shared,
                        job,
                        tracer: Tracer::new(&job.scene, &job.request),
                        frame_pool: &mut frame_pool,
                    };
                    live.run(&control, &mut budget, start);
                    JobOutcome::Ended
                }
                Job::ThumbnailJob(job) => {
                    sketch(shared, job);
                    JobOutcome::Ended
                }
                Job::Still(job) => still(shared, job, &control),
                Job::Export(_, exporting) => JobOutcome::Export(exporting.step(&control)),
                Job::Lab(study) => {
                    if study.step(&control) {
                        JobOutcome::Stopped
                    } else {
                        JobOutcome::Ended
                    }
                }
            })
        }));
        match job {
            Job::Lab(study) => {
                let is_done = finish_piece(shared, *study, outcome.as_ref().ok());
                // Drawing the window would disturb what is being timed.
                if !is_done && woken.elapsed() < NEWS {
                    continue;
                }
                woken = Instant::now();
            }
            Job::Export(id, exporting) => {
                let step = match &mut outcome {
                    Ok(JobOutcome::Export(step)) => {
                        Some(std::mem::replace(step, ExportStep::Going))
                    }
                    _ => None,
                };
                finish_frame(shared, id, *exporting, step);
            }
            Job::Live(_) | Job::ThumbnailJob(_) | Job::Still(_) => {
                finish(shared, matches!(outcome, Ok(JobOutcome::Stopped)));
            }
        }
        if let Err(panic) = outcome {
            shared.tell(Event::Failed(format!(
                "The tracer stopped with a fault of its own: {}. Your scene is untouched; change it or undo the last step to go on.",
                panic_text(panic.as_ref())
            )));
        }
        (shared.wake)();
    }
}

/// Waits for work: the live view, then small pictures, then the still picture to look at, then those
/// to be written.
fn next_job(shared: &Shared) -> Option<(Job, Arc<RenderControl>)> {
    let mut mailbox = lock(&shared.mailbox);
    loop {
        if mailbox.quit {
            return None;
        }
        let live = mailbox.live.take().map(Job::Live);
        let job = live
            .or_else(|| mailbox.thumbnails.pop_front().map(Job::ThumbnailJob))
            .or_else(|| mailbox.still.take().map(Job::Still))
            .or_else(|| mailbox.saves.pop_front().map(Job::Still))
            .or_else(|| mailbox.next_export(&lock(&shared.news).exports))
            .or_else(|| mailbox.study.take().map(|study| Job::Lab(Box::new(study))));
        if let Some(job) = job {
            let control = Arc::new(RenderControl::default());
            mailbox.running = Some(Running {
                job: match &job {
                    Job::Live(live) => RunningJob::Live {
                        revision: live.revision,
                    },
                    Job::ThumbnailJob(_) => RunningJob::ThumbnailJob,
                    Job::Still(still) => RunningJob::Still(still.clone()),
                    Job::Export(id, _) => RunningJob::Export(*id),
                    Job::Lab(_) => RunningJob::Lab,
                },
                control: Arc::clone(&control),
                started: Instant::now(),
            });
            return Some((job, control));
        }
        mailbox = shared
            .wakeup
            .wait(mailbox)
            .unwrap_or_else(PoisonError::into_inner);
    }
}

/// Clears the running job. A still picture that is to be written, and was stopped for the sake of
/// the live view, is the next again.
fn finish(shared: &Shared, was_stopped: bool) {
    let mut mailbox = lock(&shared.mailbox);
    if let Some(Running {
        job: RunningJob::Still(still),
        ..
    }) = mailbox.running.take()
        && was_stopped
        && still.save_to.is_some()
    {
        mailbox.saves.push_front(still);
    }
}

impl super::Mailbox {
    /// The first export that does not wait.
    fn next_export(&mut self, states: &[ExportState]) -> Option<Job> {
        let is_waiting = |id: u64| states.iter().any(|state| state.id == id && state.is_paused);
        let place = self.exports.iter().position(|(id, _)| !is_waiting(*id))?;
        let (id, exporting) = self.exports.remove(place)?;
        Some(Job::Export(id, Box::new(exporting)))
    }
}

/// Puts an export back for its next frame, or says how it ended; `None` is a fault of the tracer. One
/// that is not wanted any more is dropped.
fn finish_frame(shared: &Shared, id: u64, mut exporting: Exporting, step: Option<ExportStep>) {
    let is_going = matches!(step, Some(ExportStep::Going | ExportStep::Stopped));
    let ended = match step {
        Some(ExportStep::Going | ExportStep::Stopped) => None,
        Some(ExportStep::Done) => Some(exporting.finish().map(|_| ()).map_err(|e| e.to_string())),
        Some(ExportStep::Failed(error)) => Some(Err(error.to_string())),
        None => Some(Err("the tracer stopped with a fault of its own".to_owned())),
    };
    let mut mailbox = lock(&shared.mailbox);
    let spent = mailbox
        .running
        .take()
        .map_or(Duration::ZERO, |running| running.started.elapsed());
    let mut news = lock(&shared.news);
    let Some(state) = news.exports.iter_mut().find(|state| state.id == id) else {
        return;
    };
    state.done = exporting.done();
    state.busy += spent;
    state.last = exporting.last().cloned();
    state.ended = ended;
    if is_going {
        mailbox.exports.push_front((id, exporting));
    }
}

/// Publishes what a piece of a study has found, and puts the study back if there is more of it to do.
/// One whose piece failed is given up, and so is one that is not wanted any more. Whether there is
/// nothing left to do.
fn finish_piece(shared: &Shared, study: Study, outcome: Option<&JobOutcome>) -> bool {
    let mut mailbox = lock(&shared.mailbox);
    let is_wanted = matches!(
        mailbox.running.take(),
        Some(Running {
            job: RunningJob::Lab,
            ..
        })
    );
    let Some(outcome) = outcome.filter(|_| is_wanted) else {
        return true;
    };
    lock(&shared.news).study = Some(study.clone());
    let is_done = matches!(outcome, JobOutcome::Ended);
    if !is_done {
        mailbox.study = Some(study);
    }
    is_done
}

/// A live picture on its way: a coarse pass that always completes, so that there is always
/// something new to show; then finer ones until a newer job comes, and clean edges last.
struct Live<'a> {
    shared: &'a Shared,
    job: &'a LiveJob,
    tracer: Tracer,
    frame_pool: &'a mut FramePool,
}

impl Live<'_> {
    fn run(&mut self, control: &RenderControl, budget: &mut Budget, start: Instant) {
        if self.trace_centres(control, budget, start).is_some()
            && self.job.request.sampling != Sampling::Centres
        {
            self.smooth(control);
        }
    }

    /// Traces every pixel's centre once; `None` if it was stopped.
    fn trace_centres(
        &mut self,
        control: &RenderControl,
        budget: &mut Budget,
        start: Instant,
    ) -> Option<()> {
        let mut image = self.canvas();
        let first = match self.job.pace {
            Pace::Within(time) => budget.choose(image.width, image.height, time),
            Pace::Whole => 1,
        };
        let mut rays = Rays::default();
        let mut grid = Grid {
            step: first,
            coarser: None,
        };
        loop {
            let is_first = grid.step == first;
            let control = if is_first {
                &self.shared.first_pass
            } else {
                control
            };
            let new = image.trace(&self.tracer, Pass::Centres(grid), control)?;
            rays += new;
            if is_first {
                budget.learn(new.camera, start.elapsed());
            }
            if grid.step == 1 {
                break;
            }
            let thin = image.decimated(grid.step);
            self.publish(thin, grid.step, rays, Sampling::Centres, start);
            grid = Grid {
                step: grid.step / 2,
                coarser: Some(grid.step),
            };
        }
        self.publish(image, 1, rays, Sampling::Centres, start);
        Some(())
    }

    fn smooth(&mut self, control: &RenderControl) {
        let start = Instant::now();
        let mut image = self.canvas();
        if let Some(rays) = image.trace(&self.tracer, Pass::Whole, control) {
            self.publish(image, 1, rays, self.job.request.sampling, start);
        }
    }

    fn canvas(&mut self) -> Image {
        self.frame_pool
            .canvas(self.tracer.width(), self.tracer.height())
    }

    fn publish(
        &mut self,
        image: Image,
        step: usize,
        rays: Rays,
        sampling: Sampling,
        start: Instant,
    ) {
        let time = start.elapsed();
        self.shared.publish(Frame {
            revision: self.job.revision,
            image: self.frame_pool.hand_out(image),
            full_size: (self.tracer.width(), self.tracer.height()),
            step,
            sampling,
            is_still: false,
            cost: RenderCost {
                time,
                rays,
                lanes: self.tracer.lanes(),
            },
        });
    }
}

/// Small pictures are stopped by nothing but quitting.
fn sketch(shared: &Shared, job: &ThumbnailJob) {
    let request = RenderRequest {
        sampling: Sampling::Centres,
        ..RenderRequest::of(&job.scene, job.size.0, job.size.1)
    };
    if let Some((image, _)) = render(&job.scene, &request, &shared.first_pass) {
        lock(&shared.news).thumbnails.push((job.name, image));
    }
}

fn still(shared: &Shared, job: &StillJob, control: &RenderControl) -> JobOutcome {
    let Some((image, cost)) = render(&job.scene, &job.request, control) else {
        return JobOutcome::Stopped;
    };
    let image = Arc::new(image);
    shared.publish(Frame {
        revision: job.revision,
        full_size: (image.width, image.height),
        image: Arc::clone(&image),
        step: 1,
        sampling: job.request.sampling,
        is_still: true,
        cost,
    });
    if let Some(path) = &job.save_to {
        shared.tell(match save_image(&image, path) {
            Ok(()) => Event::Saved(path.clone()),
            Err(error) => Event::Failed(error.to_string()),
        });
    }
    JobOutcome::Ended
}

impl Shared {
    /// Puts a picture into the slot of its kind, in place of one that was not taken yet.
    fn publish(&self, frame: Frame) {
        let mut news = lock(&self.news);
        let slot = if frame.is_still {
            &mut news.still
        } else {
            &mut news.live
        };
        *slot = Some(frame);
        drop(news);
        (self.wake)();
    }

    pub(super) fn tell(&self, event: Event) {
        lock(&self.news).events.push(event);
        (self.wake)();
    }
}
