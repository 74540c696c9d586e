//! The threads that pack frames and write them, while others are traced.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use super::error::ExportError;
use super::manifest::Hash;
use super::save::disk;
use super::sequence::Sequence;
use crate::image::Film;

/// A picture on its way to the disk.
pub struct WriteJob {
    /// The frame.
    pub frame: u64,
    /// What it shows.
    pub film: Film,
    /// What decides that.
    pub fingerprint: Hash,
    /// How long it took to trace.
    pub time: Duration,
}

/// What came of it, and the memory back.
pub struct WriteResult {
    /// Why it is not on the disk, if it is not.
    pub written: Result<(), ExportError>,
    /// The memory.
    pub film: Film,
}

/// The threads. They end when this is dropped and what they were given is written.
pub struct Writers {
    jobs: SyncSender<WriteJob>,
    results: Receiver<WriteResult>,
}

impl Writers {
    /// Starts so many.
    ///
    /// # Errors
    /// [`ExportError::Disk`] when the system refuses a thread.
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
                .map_err(|source| disk(&folder, source))?;
        }
        Ok(Self { jobs, results })
    }

    /// Gives them a picture, once there is room for it; `false` if none of them is left.
    pub fn write(&self, job: WriteJob) -> bool {
        self.jobs.send(job).is_ok()
    }

    /// What came of a picture, if one of them has told.
    pub fn result(&self) -> Option<WriteResult> {
        self.results.try_recv().ok()
    }

    /// Waits for all that they were given.
    pub fn finish(self) -> impl Iterator<Item = WriteResult> {
        drop(self.jobs);
        self.results.into_iter()
    }
}

/// Writes what arrives; hangs up after a picture that could not be written.
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
