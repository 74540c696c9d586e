//! What the render threads and their handle share.

use std::path::Path;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::jobs::{Answer, Event, ExportState, Frame};
use super::mailbox::Mailbox;
use crate::image::Image;
use crate::lab::Study;
use crate::plan::Planner;
use crate::trace::RenderControl;

/// The mailbox, the outbox, and how each side wakes the other.
pub struct Shared {
    /// What is to be done.
    pub mailbox: Mutex<Mailbox>,
    /// Rung when there is something in the mailbox.
    pub wakeup: Condvar,
    /// What was done.
    pub outbox: Mutex<Outbox>,
    /// What was planned for the window; what is written shares its meshes.
    pub planner: Mutex<Planner>,
    /// Controls what only quitting stops: first passes and small pictures.
    pub until_quit: RenderControl,
    /// Called when there is something in the outbox.
    pub wake: Box<dyn Fn() + Send + Sync>,
}

/// What was done and not taken yet.
#[derive(Debug, Default)]
pub struct Outbox {
    pub live: Option<Frame>,
    pub still: Option<Frame>,
    pub thumbnails: Vec<(u64, Image)>,
    pub answers: Vec<Answer>,
    /// Every export, those that have ended too.
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
    /// The mailbox. Where both are needed, it is locked before the outbox.
    pub fn mailbox(&self) -> MutexGuard<'_, Mailbox> {
        lock(&self.mailbox)
    }

    /// The outbox.
    pub fn outbox(&self) -> MutexGuard<'_, Outbox> {
        lock(&self.outbox)
    }

    /// What was planned for the window.
    pub fn planner(&self) -> MutexGuard<'_, Planner> {
        lock(&self.planner)
    }

    /// Puts a picture into the slot of its kind, in place of one that was not taken yet.
    pub fn publish(&self, frame: Frame) {
        let mut outbox = self.outbox();
        let slot = if frame.is_still {
            &mut outbox.still
        } else {
            &mut outbox.live
        };
        *slot = Some(frame);
        drop(outbox);
        (self.wake)();
    }

    /// Tells the user that a picture was given up.
    pub fn tell_unwritten(&self, path: &Path) {
        let path = path.display();
        self.tell(Event::Failed(format!("{path} was not written")));
    }

    /// Tells the user something.
    pub fn tell(&self, event: Event) {
        self.outbox().events.push(event);
        (self.wake)();
    }
}

/// A panic while the lock was held left plain data behind: it is used as it is.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
