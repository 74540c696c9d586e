//! The threads that encode and write frames while others are traced.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::error::ExportError;
use super::manifest::Hash;
use super::save::disk_error;
use super::sequence::Sequence;
use crate::image::Film;

/// A traced frame to be written.
pub struct WriteJob {
    /// The frame.
    pub frame: u64,
    /// Its pixels.
    pub film: Film,
    /// The fingerprint of what it shows.
    pub fingerprint: Hash,
    /// How long it took to trace.
    pub time: Duration,
}

/// The outcome for a frame, with its memory to be reused.
pub struct WriteResult {
    /// The error if it could not be written.
    pub written: Result<(), ExportError>,
    /// The memory of the frame.
    pub film: Film,
}

/// Handle to the writer threads. They end when it is dropped and all jobs are written.
pub struct Writers {
    jobs: SyncSender<WriteJob>,
    results: Receiver<WriteResult>,
}

impl Writers {
    /// Starts `count` threads.
    ///
    /// # Errors
    /// [`ExportError::Disk`], if the system refuses a thread.
    pub fn start(sequence: &Arc<Sequence>, count: usize) -> Result<Self, ExportError> {
        let (jobs, to_write) = sync_channel::<WriteJob>(1);
        let (to_return, results) = channel();
        let to_write = Arc::new(Mutex::new(to_write));
        for index in 0..count {
            let (sequence, to_write) = (Arc::clone(sequence), Arc::clone(&to_write));
            let (to_return, folder) = (to_return.clone(), sequence.folder.clone());
            std::thread::Builder::new()
                .name(format!("glint-writer-{index}"))
                .spawn(move || write_all(&sequence, &to_write, &to_return))
                .map_err(|source| disk_error(&folder, source))?;
        }
        Ok(Self { jobs, results })
    }

    /// Hands a job to the threads, waiting for room; `false` if none of them is left.
    pub fn write(&self, job: WriteJob) -> bool {
        self.jobs.send(job).is_ok()
    }

    /// The next result, if one has arrived.
    pub fn result(&self) -> Option<WriteResult> {
        self.results.try_recv().ok()
    }

    /// The results of all remaining jobs, waiting for each.
    pub fn finish(self) -> impl Iterator<Item = WriteResult> {
        drop(self.jobs);
        self.results.into_iter()
    }
}

/// Writes the jobs that arrive; ends after a picture that could not be written.
fn write_all(sequence: &Sequence, jobs: &Mutex<Receiver<WriteJob>>, results: &Sender<WriteResult>) {
    let next = || {
        let jobs = jobs.lock().unwrap_or_else(PoisonError::into_inner);
        jobs.recv().ok()
    };
    while let Some(job) = next() {
        let written = sequence.write(job.frame, &job.fingerprint, |file| {
            job.film.encode(sequence.format, file).map(|()| job.time)
        });
        let is_over = written.is_err();
        let film = job.film;
        if results.send(WriteResult { written, film }).is_err() || is_over {
            return;
        }
    }
}
