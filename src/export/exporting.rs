//! An export on its way: frames are traced by one thread pool while the one before is written.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::time::Duration;

use super::error::ExportError;
use super::manifest::{Hash, Manifest};
use super::sequence::{Sequence, fingerprint};
use crate::image::{Film, Image};
use crate::plan::Planner;
use crate::trace::RenderControl;

/// Pictures that may wait to be written: memory stays bounded, however long the sequence is.
const WAITING: usize = 2;

/// Height of the small picture of a frame, in pixels.
const SMALL: usize = 64;

/// What has been done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exported {
    /// Frames in all.
    pub total: usize,
    /// Frames that were there already.
    pub kept: usize,
    /// Frames that were written.
    pub written: usize,
}

/// How a step ended.
#[derive(Debug)]
pub enum ExportStep {
    /// There is more to do.
    Going,
    /// Every frame is on its way; [`Exporting::finish`] waits for the last.
    Done,
    /// It was stopped in a frame, which is the next again.
    Stopped,
    /// A frame could not be written.
    Failed(ExportError),
}

/// A picture on its way to the disk.
struct WriteJob {
    frame: u64,
    film: Film,
    fingerprint: Hash,
    time: Duration,
}

/// What came of it, and the memory back.
struct WriteResult {
    written: Result<(), ExportError>,
    film: Film,
}

/// A sequence that is being exported.
pub struct Exporting {
    sequence: Arc<Sequence>,
    manifest: Manifest,
    left: VecDeque<u64>,
    jobs: Option<SyncSender<WriteJob>>,
    results: Receiver<WriteResult>,
    spare: Vec<Film>,
    planner: Planner,
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
    /// Opens the folder and starts the thread that writes.
    ///
    /// # Errors
    /// [`ExportError`], if the folder cannot be made or read.
    pub fn new(sequence: Sequence) -> Result<Self, ExportError> {
        sequence.prepare()?;
        let manifest = sequence.manifest()?;
        let sequence = Arc::new(sequence);
        let (jobs, to_write) = sync_channel::<WriteJob>(WAITING);
        let (to_return, results) = channel();
        let writer = std::thread::Builder::new()
            .name("glint-writer".to_owned())
            .spawn({
                let sequence = Arc::clone(&sequence);
                move || write_all(&sequence, &to_write, &to_return)
            });
        writer.map_err(|source| ExportError::Disk {
            path: sequence.folder.clone(),
            source,
        })?;
        Ok(Self {
            manifest,
            left: sequence.frames.iter().collect(),
            done: Exported {
                total: sequence.frames.count(),
                ..Exported::default()
            },
            sequence,
            jobs: Some(jobs),
            results,
            spare: Vec::new(),
            planner: Planner::default(),
            last: None,
        })
    }

    /// What is exported.
    pub fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    /// What has been done so far.
    pub fn done(&self) -> Exported {
        self.done
    }

    /// A small picture of the frame that was traced last.
    pub fn last(&self) -> Option<&Arc<Image>> {
        self.last.as_ref()
    }

    /// Looks at the next frame and traces it, if it is not there as it should be.
    pub fn step(&mut self, control: &RenderControl) -> ExportStep {
        while let Ok(result) = self.results.try_recv() {
            if let Err(error) = self.take(result) {
                return ExportStep::Failed(error);
            }
        }
        let Some(frame) = self.left.pop_front() else {
            return ExportStep::Done;
        };
        let shown = self.sequence.shown(frame);
        let fingerprint = match fingerprint(&shown, self.sequence.format) {
            Ok(fingerprint) => fingerprint,
            Err(error) => return ExportStep::Failed(error),
        };
        if self
            .manifest
            .is_valid(&self.sequence.file(frame), &fingerprint)
        {
            self.done.kept += 1;
            return ExportStep::Going;
        }
        let spare = self.spare.pop();
        let mut film = spare.unwrap_or_else(|| Film::new(self.sequence.format));
        let request = self.sequence.request(&shown);
        let Some(cost) = film.expose(&mut self.planner, &shown, &request, control) else {
            self.spare.push(film);
            self.left.push_front(frame);
            return ExportStep::Stopped;
        };
        let step = film.size().1.div_ceil(SMALL).max(1);
        self.last = Some(Arc::new(film.decimated(step)));
        let job = WriteJob {
            frame,
            film,
            fingerprint,
            time: cost.time,
        };
        // It hangs up only after a frame that failed, whose result tells why.
        if let Some(jobs) = &self.jobs
            && jobs.send(job).is_err()
        {
            return self
                .finish()
                .map_or_else(ExportStep::Failed, |_| ExportStep::Done);
        }
        ExportStep::Going
    }

    /// Waits until the last frame is on the disk.
    ///
    /// # Errors
    /// [`ExportError`] of the first frame that was not written.
    pub fn finish(&mut self) -> Result<Exported, ExportError> {
        self.jobs = None;
        while let Ok(result) = self.results.recv() {
            self.take(result)?;
        }
        Ok(self.done)
    }

    fn take(&mut self, result: WriteResult) -> Result<(), ExportError> {
        self.spare.push(result.film);
        result.written?;
        self.done.written += 1;
        Ok(())
    }
}

/// Writes what arrives, in order; hangs up after the first that fails.
fn write_all(sequence: &Sequence, jobs: &Receiver<WriteJob>, results: &Sender<WriteResult>) {
    for job in jobs {
        let WriteJob {
            frame,
            film,
            fingerprint,
            time,
        } = job;
        let written = sequence.write(frame, &film, &fingerprint, time);
        let is_over = written.is_err();
        if results.send(WriteResult { written, film }).is_err() || is_over {
            return;
        }
    }
}
