//! A running export: frames are traced by one thread pool while earlier ones are encoded and written.

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

use super::error::ExportError;
use super::fingerprint::fingerprint;
use super::manifest::{Hash, Manifest};
use super::save::disk_error;
use super::sequence::Sequence;
use super::writers::{WriteJob, WriteResult, Writers};
use crate::image::{Film, Format, Image, RenderCost};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::{RenderControl, Threads};

/// Threads per frame if several frames are traced side by side: the more threads trace one picture, the longer they
/// wait for its last pieces.
const THREADS_PER_FRAME: usize = 8;

/// Most pixels of a frame that is traced as a whole; larger frames are traced strip by strip while they are written.
const MAX_WHOLE_PIXELS: u64 = 1 << 24;

/// Most rows of the small picture of a frame.
const SMALL_ROWS: u32 = 64;

/// Progress of an export.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exported {
    /// Frames in all.
    pub total: usize,
    /// Frames that existed and were up to date.
    pub kept: usize,
    /// Frames that were written.
    pub written: usize,
}

impl Exported {
    /// Frames that are finished so far.
    pub fn so_far(&self) -> usize {
        self.kept + self.written
    }
}

/// The outcome of a step.
#[derive(Debug)]
pub enum ExportStep {
    /// There is more to do.
    Going,
    /// Every frame is traced, and may still be being written; [`Exporting::finish`] waits for the last.
    Done,
    /// Stopped within a frame, which is traced again next.
    Stopped,
    /// A frame could not be written.
    Failed(ExportError),
}

/// A frame that is missing or outdated, and what is needed to trace it.
struct PendingFrame {
    frame: u64,
    shown: Arc<Scene>,
    fingerprint: Hash,
    film: Film,
    planner: Planner,
}

/// Traces a small version of a large picture.
fn small_picture(planner: &mut Planner, shown: &Scene, request: &RenderRequest) -> Option<Image> {
    let step = request.height.div_ceil(SMALL_ROWS).max(1);
    let small = RenderRequest {
        width: request.width.div_ceil(step),
        height: request.height.div_ceil(step),
        ..*request
    };
    let mut film = Film::new(Format::Ppm);
    film.expose(planner, shown, &small, &RenderControl::default())?;
    Some(film.into_levels())
}

/// A sequence that is being exported.
pub struct Exporting {
    sequence: Arc<Sequence>,
    manifest: Manifest,
    remaining: VecDeque<u64>,
    /// Fingerprints of the frames that were looked at.
    checked: Vec<(u64, Hash)>,
    /// Started with the first frame that is to be written.
    writers: Option<Writers>,
    /// Frames given to the writers whose results have not arrived.
    in_flight: usize,
    spare_films: Vec<Film>,
    planner: Planner,
    is_side_by_side: bool,
    done: Exported,
    last: Option<Arc<Image>>,
}

impl std::fmt::Debug for Exporting {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Exporting")
            .field("done", &self.done)
            .finish_non_exhaustive()
    }
}

impl Exporting {
    /// Creates the folder if needed, and reads its manifest.
    ///
    /// # Errors
    /// [`ExportError`], if the folder cannot be made or read.
    pub fn new(sequence: Sequence) -> Result<Self, ExportError> {
        sequence.prepare()?;
        Ok(Self {
            manifest: sequence.manifest()?,
            remaining: sequence.frames.iter().collect(),
            checked: Vec::new(),
            writers: None,
            in_flight: 0,
            spare_films: Vec::new(),
            planner: Planner::default(),
            is_side_by_side: false,
            done: Exported {
                total: sequence.frames.count(),
                ..Exported::default()
            },
            last: None,
            sequence: Arc::new(sequence),
        })
    }

    /// Traces several frames side by side if there are many threads. Only for programs that do nothing else: if a
    /// step is stopped, all frames begun in it are lost.
    #[must_use]
    pub fn side_by_side(self) -> Self {
        Self {
            is_side_by_side: true,
            ..self
        }
    }

    /// The progress so far.
    pub fn done(&self) -> Exported {
        self.done
    }

    /// A small picture of the frame that was traced last.
    pub fn last(&self) -> Option<&Arc<Image>> {
        self.last.as_ref()
    }

    /// Checks the next frame, or several if there are many threads, and traces what is missing or outdated on the
    /// threads of the current rayon pool.
    pub fn step(&mut self, control: &RenderControl) -> ExportStep {
        self.try_step(control).unwrap_or_else(|error| {
            // Frames on their way are written completely, or removed, before the program can end.
            let _ = self.finish();
            ExportStep::Failed(error)
        })
    }

    fn try_step(&mut self, control: &RenderControl) -> Result<ExportStep, ExportError> {
        while let Some(result) = self.writers.as_ref().and_then(Writers::result) {
            self.accept_result(result)?;
        }
        if self.remaining.is_empty() {
            return Ok(ExportStep::Done);
        }
        let pending = self.next_pending()?;
        if self.is_large() {
            return match pending.into_iter().next() {
                Some(pending) => self.trace_large(pending, control),
                None => Ok(ExportStep::Going),
            };
        }
        let trace = |mut pending: PendingFrame| {
            let request = RenderRequest::still(&pending.shown);
            let cost = pending
                .film
                .expose(&mut pending.planner, &pending.shown, &request, control);
            (pending, cost)
        };
        let traced: Vec<(PendingFrame, Option<RenderCost>)> =
            pending.into_par_iter().map(trace).collect();
        let mut stopped = Vec::new();
        for (pending, cost) in traced {
            match cost {
                Some(cost) => self.write(pending, &cost)?,
                None => stopped.push(pending),
            }
        }
        if stopped.is_empty() {
            return Ok(ExportStep::Going);
        }
        for pending in stopped.into_iter().rev() {
            self.remaining.push_front(pending.frame);
            self.spare_films.push(pending.film);
            self.planner = pending.planner;
        }
        Ok(ExportStep::Stopped)
    }

    /// Whether frames are too large to be kept in memory as a whole.
    fn is_large(&self) -> bool {
        let (width, height) = self.sequence.size();
        MAX_WHOLE_PIXELS < u64::from(width) * u64::from(height)
    }

    /// Traces a large frame while it is written.
    fn trace_large(
        &mut self,
        mut pending: PendingFrame,
        control: &RenderControl,
    ) -> Result<ExportStep, ExportError> {
        let sequence = Arc::clone(&self.sequence);
        let request = RenderRequest::still(&pending.shown);
        let written = sequence.write(pending.frame, &pending.fingerprint, |file| {
            let picture = (&*pending.shown, &request);
            let mut drawing = pending.film.draw(&mut pending.planner, picture, control);
            drawing.encode(sequence.format, file)?;
            Ok(drawing.cost().time)
        });
        let step = match written {
            Ok(()) => {
                self.done.written += 1;
                self.last =
                    small_picture(&mut pending.planner, &pending.shown, &request).map(Arc::new);
                ExportStep::Going
            }
            Err(_) if control.is_stopped() => {
                self.remaining.push_front(pending.frame);
                ExportStep::Stopped
            }
            Err(error) => return Err(error),
        };
        self.planner = pending.planner;
        self.spare_films.push(pending.film);
        Ok(step)
    }

    /// Takes the next frames, as many as are traced side by side, and returns those that have to be traced; the
    /// others are up to date.
    fn next_pending(&mut self) -> Result<Vec<PendingFrame>, ExportError> {
        // The first frame is traced alone, as the others share what its planner has prepared.
        let is_first = self.last.is_none();
        let wanted = if self.is_side_by_side && !is_first && !self.is_large() {
            Threads::current() / THREADS_PER_FRAME
        } else {
            1
        };
        let count = self.sequence.at_once(wanted);
        let mut pending: Vec<PendingFrame> = Vec::new();
        for frame in self.remaining.drain(..count.min(self.remaining.len())) {
            let shown = self.sequence.shown(frame);
            let fingerprint = fingerprint(&shown, self.sequence.format)?;
            self.checked.push((frame, fingerprint));
            let file = self.sequence.file(frame);
            if self.manifest.is_valid(&file, &fingerprint) {
                self.done.kept += 1;
                continue;
            }
            let film = self.spare_films.pop();
            pending.push(PendingFrame {
                frame,
                shown,
                fingerprint,
                film: film.unwrap_or_else(|| Film::new(self.sequence.format)),
                planner: match pending.first() {
                    None => std::mem::take(&mut self.planner),
                    Some(first) => first.planner.clone(),
                },
            });
        }
        Ok(pending)
    }

    /// Hands a frame to the writers.
    fn write(&mut self, pending: PendingFrame, cost: &RenderCost) -> Result<(), ExportError> {
        self.planner = pending.planner;
        let step = pending.film.size().1.div_ceil(SMALL_ROWS as usize).max(1);
        self.last = Some(Arc::new(pending.film.decimated(step)));
        let count = self.sequence.at_once(Threads::current());
        let writers = match &mut self.writers {
            Some(writers) => writers,
            none => none.insert(Writers::start(&self.sequence, count)?),
        };
        self.in_flight += 1;
        let is_taken = writers.write(WriteJob {
            frame: pending.frame,
            film: pending.film,
            fingerprint: pending.fingerprint,
            time: cost.time,
        });
        // They stop only after a frame that failed, whose result has the reason.
        if is_taken {
            Ok(())
        } else {
            self.finish().map(|_| ())
        }
    }

    /// Waits until the last frame is written.
    ///
    /// # Errors
    /// [`ExportError`] of a frame that was not written, or was replaced since.
    pub fn finish(&mut self) -> Result<Exported, ExportError> {
        let mut outcome = Ok(());
        for result in self.writers.take().into_iter().flat_map(Writers::finish) {
            let taken = self.accept_result(result);
            outcome = outcome.and(taken);
        }
        outcome?;
        if self.in_flight > 0 {
            let fault = io::Error::other("a writer thread stopped because of an internal error");
            return Err(disk_error(&self.sequence.folder, fault));
        }
        if self.done.so_far() == self.done.total {
            self.check_frames()?;
        }
        Ok(self.done)
    }

    /// Checks that no other export has replaced frames by its own.
    fn check_frames(&self) -> Result<(), ExportError> {
        let manifest = self.sequence.manifest()?;
        let is_replaced = |(frame, fingerprint): &&(u64, Hash)| {
            manifest.has_other_fingerprint(&self.sequence.file(*frame), fingerprint)
        };
        let path = |&(frame, _): &(u64, Hash)| self.sequence.path(frame);
        match self.checked.iter().find(is_replaced).map(path) {
            Some(path) => Err(ExportError::Changed { path }),
            None => Ok(()),
        }
    }

    fn accept_result(&mut self, result: WriteResult) -> Result<(), ExportError> {
        self.in_flight -= 1;
        self.spare_films.push(result.film);
        result.written?;
        self.done.written += 1;
        Ok(())
    }
}
