//! The handle's side of exports: a queue under the live view.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use super::{ExportState, Exporting, Running, RunningJob, Worker, lock};
use crate::export::{ExportError, Sequence};

impl Worker {
    /// Puts a sequence at the end of the queue; the name that it has from now on. The sequence keeps
    /// the scene as it is now, whatever is edited meanwhile.
    ///
    /// # Errors
    /// [`ExportError`], if its folder cannot be made or read.
    pub fn export(&self, sequence: Sequence) -> Result<u64, ExportError> {
        let folder: PathBuf = sequence.folder.clone();
        let exporting = Exporting::new(sequence)?;
        let mut mailbox = lock(&self.shared.mailbox);
        let mut news = lock(&self.shared.news);
        mailbox.export_count += 1;
        let id = mailbox.export_count;
        news.exports.push(ExportState {
            id,
            folder,
            done: exporting.done(),
            busy: Duration::ZERO,
            is_paused: false,
            last: None,
            ended: None,
        });
        mailbox.exports.push_back((id, exporting));
        if let Some(Running {
            job: RunningJob::Lab,
            ..
        }) = mailbox.running
        {
            mailbox.stop_running();
        }
        drop((mailbox, news));
        self.shared.wakeup.notify_one();
        Ok(id)
    }

    /// All exports, those that have ended too.
    pub fn exports(&self) -> Vec<ExportState> {
        lock(&self.shared.news).exports.clone()
    }

    /// Whether an export is going on or waits for its turn.
    pub fn is_exporting(&self) -> bool {
        let news = lock(&self.shared.news);
        news.exports.iter().any(|state| state.ended.is_none())
    }

    /// Lets an export wait, or go on.
    pub fn pause_export(&self, id: u64, is_paused: bool) {
        let mailbox = lock(&self.shared.mailbox);
        let mut news = lock(&self.shared.news);
        let state = news.exports.iter_mut().find(|state| state.id == id);
        if let Some(state) = state {
            state.is_paused = is_paused;
        }
        if is_paused {
            mailbox.stop_export(id);
        }
        drop((mailbox, news));
        self.shared.wakeup.notify_one();
    }

    /// Gives an export up, or takes one that has ended out of the list. Frames that are written stay.
    pub fn forget_export(&self, id: u64) {
        let mut mailbox = lock(&self.shared.mailbox);
        mailbox.stop_export(id);
        // Dropped outside of the lock: its writer is waited for by nobody.
        let place = mailbox.exports.iter().position(|(other, _)| *other == id);
        let gone = place.and_then(|place| mailbox.exports.remove(place));
        lock(&self.shared.news)
            .exports
            .retain(|state| state.id != id);
        drop(mailbox);
        drop(gone);
    }
}

impl super::Mailbox {
    fn stop_export(&self, id: u64) {
        if let Some(Running {
            job: RunningJob::Export(running),
            control,
            ..
        }) = &self.running
            && *running == id
        {
            control.stop.store(true, Ordering::Relaxed);
        }
    }
}
