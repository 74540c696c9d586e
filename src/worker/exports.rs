//! The handle's methods for exports, which are queued below the live view in urgency.

use std::time::Duration;

use super::handle::Worker;
use super::jobs::ExportState;
use super::mailbox::Job;
use crate::export::{ExportError, Exporting, Sequence};

impl Worker {
    /// Appends a sequence to the queue and returns its id. The sequence keeps the scene as it is now, regardless of
    /// later edits.
    ///
    /// # Errors
    /// [`ExportError`], if its folder cannot be made or read.
    pub fn export(&self, sequence: Sequence) -> Result<u64, ExportError> {
        let folder = sequence.folder.clone();
        let exporting = Box::new(Exporting::new(sequence)?);
        let mut mailbox = self.shared.mailbox();
        mailbox.export_count += 1;
        let id = mailbox.export_count;
        self.shared.outbox().exports.push(ExportState {
            id,
            folder,
            done: exporting.done(),
            busy: Duration::ZERO,
            is_paused: false,
            last: None,
            ended: None,
        });
        mailbox.put(Job::Export(id, exporting));
        drop(mailbox);
        self.shared.wakeup.notify_all();
        Ok(id)
    }

    /// All exports, including those that have ended.
    pub fn exports(&self) -> Vec<ExportState> {
        self.shared.outbox().exports.clone()
    }

    /// Whether an export is running or queued.
    pub fn is_exporting(&self) -> bool {
        let outbox = self.shared.outbox();
        outbox.exports.iter().any(|state| state.ended.is_none())
    }

    /// Pauses or resumes an export.
    pub fn pause_export(&self, id: u64, is_paused: bool) {
        let mailbox = self.shared.mailbox();
        let mut outbox = self.shared.outbox();
        let state = outbox.exports.iter_mut().find(|state| state.id == id);
        if let Some(state) = state {
            state.is_paused = is_paused;
        }
        if is_paused {
            mailbox.stop_export(id);
        }
        drop((mailbox, outbox));
        self.shared.wakeup.notify_all();
    }

    /// Cancels an export, or removes one that has ended from the list. Frames that are written stay.
    pub fn forget_export(&self, id: u64) {
        let mut mailbox = self.shared.mailbox();
        mailbox.stop_export(id);
        // Dropped after the lock is released; its writers are not waited for.
        let gone = mailbox.remove_export(id);
        self.shared.outbox().exports.retain(|state| state.id != id);
        drop(mailbox);
        drop(gone);
    }
}
