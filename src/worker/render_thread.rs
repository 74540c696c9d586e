//! The render threads: each takes the most urgent job of its crew, traces it and publishes the result.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, PoisonError, Weak};
use std::time::{Duration, Instant};

use super::budget::Budget;
use super::frame_pool::FramePool;
use super::jobs::{
    Answer, Crew, Event, Frame, LiveJob, QueryJob, Question, StillJob, ThumbnailJob,
};
use super::live::Live;
use super::mailbox::Job;
use super::shared::Shared;
use super::task::panic_text;
use crate::export::{ExportError, ExportStep, Exporting, save_image};
use crate::image::{Film, Format, Image, ObjectMapper, render_into};
use crate::lab::{Study, choose};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Sampling;
use crate::trace::{CachedQuery, RenderControl, Threads, Tracer, survey, visible};

/// Least time between two reports of a study.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Idle time after which paused work resumes: during a drag or playback, the next picture is requested sooner.
const RESUME_DELAY: Duration = Duration::from_millis(100);

/// How a job ended.
enum JobOutcome {
    /// There is nothing more to do for it.
    Ended,
    /// It was stopped, or has more to do.
    Unfinished,
    /// A step of an export has ended.
    Export(ExportStep),
}

/// State that a thread keeps between jobs.
struct KeptState {
    budget: Budget,
    frame_pool: FramePool,
    mapper: ObjectMapper,
    query: CachedQuery,
    /// The planner of still pictures.
    planner: Planner,
    /// The last whole still picture while it is shown, and its revision: it is not traced again to be written in 8 bits.
    still: (u64, Weak<Image>),
}

/// Runs jobs until told to quit. A panic in a job becomes an event, and the thread continues.
pub fn run(shared: &Shared, crew: Crew, threads: &Threads) {
    let mut kept = KeptState {
        budget: Budget::new(),
        frame_pool: FramePool::default(),
        mapper: ObjectMapper::default(),
        query: CachedQuery::default(),
        planner: Planner::default(),
        still: (0, Weak::new()),
    };
    let mut last_wake = Instant::now();
    while let Some((mut job, control)) = next_job(shared, crew) {
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            threads.run(|| run_job(shared, &mut job, &mut kept, &control))
        }));
        match outcome {
            Ok(outcome) => {
                let is_study_going_on = finish(shared, job, Some(outcome));
                // Waking the window to redraw would disturb the time measurements.
                if is_study_going_on && last_wake.elapsed() < REPORT_INTERVAL {
                    continue;
                }
            }
            Err(panic) => {
                match &job {
                    Job::Query(job) => answer_after_panic(shared, job),
                    Job::Still(StillJob {
                        save_to: Some(path),
                        ..
                    }) => shared.report_unwritten(path),
                    _ => {}
                }
                finish(shared, job, None);
                shared.report(Event::Fault(format!(
                    "The tracer stopped because of an internal error: {}. Your scene is unchanged; edit it or undo the last step to continue.",
                    panic_text(panic.as_ref())
                )));
            }
        }
        last_wake = Instant::now();
        // The other crew may be waiting until this one is idle.
        shared.wakeup.notify_all();
        (shared.wake)();
    }
}

/// Does a job, or a part of it.
fn run_job(
    shared: &Shared,
    job: &mut Job,
    kept: &mut KeptState,
    control: &RenderControl,
) -> JobOutcome {
    match job {
        Job::Live(live) => {
            let start = Instant::now();
            let traced = plan_live(shared, live, &mut kept.frame_pool).trace_centres(
                control,
                &mut kept.budget,
                start,
            );
            if traced.is_none() || live.request.sampling == Sampling::Centres {
                return JobOutcome::Ended;
            }
            *job = Job::Smooth(live.clone());
            JobOutcome::Unfinished
        }
        Job::Smooth(live) => {
            let start = Instant::now();
            let traced = plan_live(shared, live, &mut kept.frame_pool).smooth(control, start);
            traced.map_or(JobOutcome::Unfinished, |()| JobOutcome::Ended)
        }
        Job::Query(job) => answer(shared, job, kept, control),
        Job::Thumbnail(job) => thumbnail(shared, job),
        Job::Still(job) => still(shared, job, kept, control),
        Job::Export(_, exporting) => JobOutcome::Export(exporting.step(control)),
        Job::Lab(study) => {
            if study.step(control) {
                JobOutcome::Unfinished
            } else {
                JobOutcome::Ended
            }
        }
    }
}

fn plan_live<'a>(shared: &'a Shared, job: &'a LiveJob, frame_pool: &'a mut FramePool) -> Live<'a> {
    Live {
        shared,
        job,
        tracer: Tracer::planned(&job.scene, &job.request, &mut shared.planner()),
        frame_pool,
    }
}

/// Waits for the next job; `None` means to quit.
fn next_job(shared: &Shared, crew: Crew) -> Option<(Job, Arc<RenderControl>)> {
    let mut mailbox = shared.mailbox();
    loop {
        if mailbox.quit {
            return None;
        }
        let next = mailbox.next(crew, &shared.outbox().exports);
        if next.is_some() {
            return next;
        }
        mailbox = if crew == Crew::Prompt && mailbox.is_paused() {
            let waited = shared.wakeup.wait_timeout(mailbox, RESUME_DELAY);
            let (mailbox, waited) = waited.unwrap_or_else(PoisonError::into_inner);
            if waited.timed_out() {
                mailbox.resume();
            }
            mailbox
        } else {
            let woken = shared.wakeup.wait(mailbox);
            woken.unwrap_or_else(PoisonError::into_inner)
        };
    }
}

/// Reports how a job ended; the outcome `None` is a fault of the tracer. Returns whether the job is a study that is
/// still wanted and has more to do.
fn finish(shared: &Shared, job: Job, outcome: Option<JobOutcome>) -> bool {
    match (job, outcome) {
        (Job::Export(id, exporting), outcome) => {
            let step = match outcome {
                Some(JobOutcome::Export(step)) => Some(step),
                _ => None,
            };
            finish_frame(shared, id, exporting, step);
        }
        (Job::Lab(study), Some(outcome)) => return finish_study_step(shared, study, &outcome),
        (job, Some(JobOutcome::Unfinished)) => {
            let running = shared.mailbox().finish(job.kind().crew(), Some(job));
            let given_up = running.filter(|running| running.is_given_up);
            if let Some(path) = given_up.and_then(|running| running.save_to) {
                shared.report_unwritten(&path);
            }
        }
        (job, _) => drop(shared.mailbox().finish(job.kind().crew(), None)),
    }
    false
}

/// Puts an export back into the queue for its next frame, or notes how it ended. An export that is no longer wanted
/// is dropped.
fn finish_frame(shared: &Shared, id: u64, mut exporting: Box<Exporting>, step: Option<ExportStep>) {
    let ended = match step {
        Some(ExportStep::Going | ExportStep::Stopped) => None,
        Some(ExportStep::Done) => Some(exporting.finish().map(|_| ()).map_err(|e| e.to_string())),
        Some(ExportStep::Failed(error)) => Some(Err(error.to_string())),
        None => Some(Err(
            "the tracer stopped because of an internal error".to_owned()
        )),
    };
    let (done, last) = (exporting.done(), exporting.last().cloned());
    let mut mailbox = shared.mailbox();
    let mut outbox = shared.outbox();
    let state = outbox.exports.iter_mut().find(|state| state.id == id);
    let job = Job::Export(id, exporting);
    let stopped = Some(job).filter(|_| ended.is_none() && state.is_some());
    let running = mailbox.finish(Crew::Patient, stopped);
    let spent = running.map_or(Duration::ZERO, |running| running.spent());
    if let Some(state) = state {
        state.done = done;
        state.busy += spent;
        state.last = last;
        state.ended = ended;
    }
}

/// Publishes the results of a study so far, and puts it back into the queue if there is more to do. Returns whether
/// there is.
fn finish_study_step(shared: &Shared, study: Box<Study>, outcome: &JobOutcome) -> bool {
    let mut mailbox = shared.mailbox();
    let results = Study::clone(&study);
    let has_more = matches!(outcome, JobOutcome::Unfinished);
    let running = mailbox.finish(Crew::Patient, has_more.then_some(Job::Lab(study)));
    let is_wanted = running.is_some_and(|running| !running.is_given_up);
    if is_wanted {
        shared.outbox().study = Some(results);
    }
    has_more && is_wanted
}

fn answer(
    shared: &Shared,
    job: &mut QueryJob,
    KeptState { mapper, query, .. }: &mut KeptState,
    control: &RenderControl,
) -> JobOutcome {
    let scene = &job.scene;
    let answer = match &mut job.question {
        Question::Survey(take, seen) => {
            let query = query.of(scene, &shared.planner());
            survey(take, query, scene.render.aspect_ratio(), seen, control)
                .then(|| Answer::Survey(Arc::clone(take), std::mem::take(seen)))
        }
        Question::Visible(name, camera, points) => {
            let query = query.of(scene, &shared.planner());
            visible(query, camera, points, control).map(|seen| Answer::Visible(*name, seen))
        }
        Question::Objects(name, request, without) => mapper
            .map(&job.scene, request, without, (&shared.planner(), control))
            .map(|map| Answer::Objects(*name, map, std::mem::take(without))),
        Question::Quality(goal) => {
            let mut planner = shared.planner().clone();
            let request = RenderRequest::still(scene);
            choose(scene, &request, *goal, &mut planner, control)
                .map(|choice| Answer::Quality(*goal, Some(choice)))
        }
    };
    match answer {
        Some(answer) => {
            shared.outbox().answers.push(answer);
            JobOutcome::Ended
        }
        None => JobOutcome::Unfinished,
    }
}

/// Answers a question whose job has panicked, if someone waits for it: a recorded flight is kept even without its
/// survey, and a request for a quality must end.
fn answer_after_panic(shared: &Shared, job: &QueryJob) {
    let answer = match &job.question {
        Question::Survey(take, _) => {
            let seen = vec![Vec::new(); take.samples.len()];
            Answer::Survey(Arc::clone(take), seen)
        }
        Question::Quality(goal) => Answer::Quality(*goal, None),
        Question::Visible(..) | Question::Objects(..) => return,
    };
    shared.outbox().answers.push(answer);
}

fn thumbnail(shared: &Shared, job: &ThumbnailJob) -> JobOutcome {
    let request = RenderRequest {
        sampling: Sampling::Centres,
        ..RenderRequest::of(&job.scene, job.size.0, job.size.1)
    };
    let mut image = Image::default();
    let control = &shared.until_quit;
    let planner = &mut shared.planner();
    if render_into(&mut image, planner, &job.scene, &request, control).is_some() {
        shared.outbox().thumbnails.push((job.name, image));
    }
    JobOutcome::Ended
}

fn still(
    shared: &Shared,
    job: &StillJob,
    kept: &mut KeptState,
    control: &RenderControl,
) -> JobOutcome {
    let path = job.save_to.as_deref();
    let format = path.and_then(|path| Format::of_path(path).ok());
    let mut film = Film::new(format.unwrap_or(Format::Png));
    let (revision, last) = (kept.still.0, kept.still.1.upgrade());
    let size = (job.request.width as usize, job.request.height as usize);
    let last = last.filter(|last| revision == job.revision && (last.width, last.height) == size);
    if let (Some(path), Some(last), Film::Levels(image)) = (path, last, &mut film) {
        image.clone_from(&last);
        report_written(shared, path, save_image(&film, path));
        return JobOutcome::Ended;
    }
    kept.planner.share_meshes(&shared.planner());
    let Some(cost) = film.expose(&mut kept.planner, &job.scene, &job.request, control) else {
        return JobOutcome::Unfinished;
    };
    let written = path.map(|path| (path, save_image(&film, path)));
    let image = Arc::new(film.into_levels());
    if job.request.region.is_none() {
        kept.still = (job.revision, Arc::downgrade(&image));
    }
    shared.publish(Frame {
        revision: job.revision,
        full_size: (image.width, image.height),
        image: Arc::clone(&image),
        step: 1,
        sampling: job.request.sampling,
        is_still: true,
        region: job.request.region,
        cost,
    });
    if let Some((path, written)) = written {
        report_written(shared, path, written);
    }
    JobOutcome::Ended
}

fn report_written(shared: &Shared, path: &Path, written: Result<(), ExportError>) {
    shared.report(match written {
        Ok(()) => Event::Saved(path.to_owned()),
        Err(error) => Event::Failed(error.to_string()),
    });
}
