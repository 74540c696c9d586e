//! The thread itself: takes the most urgent job, traces, publishes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

use super::budget::Budget;
use super::errand::panic_text;
use super::{Event, Frame, LiveJob, Pace, Running, RunningJob, Shared, StillJob, lock};
use crate::export::save_image;
use crate::image::{Cost, Image, render};
use crate::plan::Sampling;
use crate::trace::{Grid, Pass, Rays, Threads, Tracer, Watch};

enum Job {
    Live(LiveJob),
    Still(StillJob),
}

/// How a job ended.
enum Outcome {
    /// There is nothing more to do for it.
    Ended,
    /// It was stopped on the way.
    Stopped,
}

/// Works until told to quit. A panic in a job becomes an event, and the lane lives on.
pub(super) fn run(shared: &Shared, threads: &Threads) {
    let mut budget = Budget::new();
    while let Some((job, watch)) = next_job(shared) {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            threads.run(|| match &job {
                Job::Live(job) => {
                    live(shared, job, &watch, &mut budget);
                    Outcome::Ended
                }
                Job::Still(job) => still(shared, job, &watch),
            })
        }));
        finish(shared, matches!(outcome, Ok(Outcome::Stopped)));
        if let Err(panic) = outcome {
            shared.tell(Event::Failed(format!(
                "The tracer stopped with a fault of its own: {}. Your scene is untouched; change it or undo the last step to go on.",
                panic_text(panic.as_ref())
            )));
        }
        (shared.wake)();
    }
}

/// Waits for work: the live view, then the still picture to look at, then those to be written.
fn next_job(shared: &Shared) -> Option<(Job, Arc<Watch>)> {
    let mut mailbox = lock(&shared.mailbox);
    loop {
        if mailbox.quit {
            return None;
        }
        let live = mailbox.live.take().map(Job::Live);
        let job = live
            .or_else(|| mailbox.still.take().map(Job::Still))
            .or_else(|| mailbox.saves.pop_front().map(Job::Still));
        if let Some(job) = job {
            let watch = Arc::new(Watch::default());
            mailbox.running = Some(Running {
                job: match &job {
                    Job::Live(live) => RunningJob::Live {
                        revision: live.revision,
                    },
                    Job::Still(still) => RunningJob::Still(still.clone()),
                },
                watch: Arc::clone(&watch),
                started: Instant::now(),
            });
            return Some((job, watch));
        }
        mailbox = shared
            .bell
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

/// A coarse pass that always completes, so that there is always something new to show; then finer
/// ones until a newer job comes, and clean edges last. Every pixel's centre is traced once. When
/// clean edges fit into the frame budget, they come at once.
fn live(shared: &Shared, job: &LiveJob, watch: &Watch, budget: &mut Budget) {
    let start = Instant::now();
    let tracer = Tracer::new(&job.scene, &job.picture);
    let mut image = Image::new(tracer.width(), tracer.height());
    let first = match job.pace {
        Pace::Progressive => budget.choose(image.width, image.height),
        Pace::Whole => 1,
    };
    let mut rays = Rays::default();
    let publish = |image: Image, step: usize, rays: Rays, sampling: Sampling, time: Duration| {
        shared.publish(Frame {
            revision: job.revision,
            image: Arc::new(image),
            full_size: (tracer.width(), tracer.height()),
            step,
            sampling,
            is_still: false,
            cost: Cost {
                time,
                rays,
                lanes: tracer.lanes(),
            },
        });
    };
    let sampling = job.picture.sampling;
    if first == 1 && sampling != Sampling::Centres && budget.affords_smooth(image.pixels.len()) {
        let Some(rays) = image.trace(&tracer, Pass::Whole, watch) else {
            // The scene has become too heavy, or the hand too fast, for clean edges at once.
            return budget.forget_smooth();
        };
        let time = start.elapsed();
        budget.learn_smooth(image.pixels.len(), time);
        return publish(image, 1, rays, sampling, time);
    }
    let mut grid = Grid {
        step: first,
        coarser: None,
    };
    loop {
        let watch = if grid.step == first {
            &shared.first_pass
        } else {
            watch
        };
        let Some(new) = image.trace(&tracer, Pass::Centres(grid), watch) else {
            return;
        };
        rays += new;
        if grid.step == first {
            budget.learn(new.camera, start.elapsed());
        }
        if grid.step == 1 {
            break;
        }
        let thin = image.thinned(grid.step);
        publish(thin, grid.step, rays, Sampling::Centres, start.elapsed());
        grid = Grid {
            step: grid.step / 2,
            coarser: Some(grid.step),
        };
    }
    let size = (image.width, image.height);
    publish(image, 1, rays, Sampling::Centres, start.elapsed());
    if sampling == Sampling::Centres {
        return;
    }
    let begin = Instant::now();
    let mut image = Image::new(size.0, size.1);
    if let Some(new) = image.trace(&tracer, Pass::Whole, watch) {
        let time = begin.elapsed();
        budget.learn_smooth(image.pixels.len(), time);
        publish(image, 1, new, sampling, time);
    }
}

fn still(shared: &Shared, job: &StillJob, watch: &Watch) -> Outcome {
    let Some((image, cost)) = render(&job.scene, &job.picture, watch) else {
        return Outcome::Stopped;
    };
    let image = Arc::new(image);
    shared.publish(Frame {
        revision: job.revision,
        full_size: (image.width, image.height),
        image: Arc::clone(&image),
        step: 1,
        sampling: job.picture.sampling,
        is_still: true,
        cost,
    });
    if let Some(path) = &job.save_to {
        shared.tell(match save_image(&image, path) {
            Ok(()) => Event::Saved(path.clone()),
            Err(error) => Event::Failed(error.to_string()),
        });
    }
    Outcome::Ended
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
