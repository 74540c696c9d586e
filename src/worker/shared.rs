//! State shared by the render threads and their handle.

use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::jobs::{Answer, Event, ExportState, Frame};
use super::mailbox::Mailbox;
use crate::image::Image;
use crate::lab::Study;
use crate::plan::Planner;
use crate::trace::RenderControl;

/// The mailbox, the outbox, and the means by which each side wakes the other.
pub struct Shared {
    /// The jobs.
    pub mailbox: Mutex<Mailbox>,
    /// Notified when the mailbox has changed.
    pub wakeup: Condvar,
    /// The results.
    pub outbox: Mutex<Outbox>,
    /// The planner of the window's pictures; pictures to be saved share its meshes.
    pub planner: Mutex<Planner>,
    /// Controls what only quitting stops: first passes and thumbnails.
    pub until_quit: RenderControl,
    /// Called when there is something in the outbox.
    pub wake: Box<dyn Fn() + Send + Sync>,
}

/// Results that were not taken yet.
#[derive(Debug, Default)]
pub struct Outbox {
    pub live: Option<Frame>,
    pub still: Option<Frame>,
    /// Finished thumbnails, by the names that the caller gave them.
    pub thumbnails: Vec<(u64, Image)>,
    pub answers: Vec<Answer>,
    /// All exports, including those that have ended.
    pub exports: Vec<ExportState>,
    pub study: Option<Study>,
    pub events: Vec<Event>,
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Shared").finish_non_exhaustive()
    }
}

impl Shared {
    /// Locks the mailbox. Where both are needed, it must be locked before the outbox.
    pub fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        lock(&self.mailbox)
    }

    /// Locks the outbox.
    pub fn outbox(&self) -> MutexGuard<'_, Outbox> {
        lock(&self.outbox)
    }

    /// Locks the planner of the window's pictures.
    pub fn planner(&self) -> MutexGuard<'_, Planner> {
        lock(&self.planner)
    }

    /// Puts a picture into the slot of its kind, replacing one that was not taken yet unless that shows a later
    /// revision: a picture that is to be saved may be finished after a newer one that is only to be shown.
    pub fn publish(&self, frame: Frame) {
        let mut outbox = self.outbox();
        let slot = if frame.is_still {
            &mut outbox.still
        } else {
            &mut outbox.live
        };
        let is_newer = |waiting: &Frame| waiting.revision > frame.revision;
        if !slot.as_ref().is_some_and(is_newer) {
            *slot = Some(frame);
        }
        drop(outbox);
        (self.wake)();
    }

    /// Tells the user that a picture was not written.
    pub fn report_unwritten(&self, path: &Path) {
        let path = path.display();
        self.report(Event::Failed(format!("{path} was not written")));
    }

    /// Tells the user something.
    pub fn report(&self, event: Event) {
        self.outbox().events.push(event);
        (self.wake)();
    }
}

/// Locks a mutex even if it is poisoned: a panic leaves nothing but plain data behind, which is used as it is.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
