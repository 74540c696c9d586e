//! One-off work off the caller's thread.

use std::any::Any;
use std::io;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// Work on a thread of its own, or none; its result is polled for and can be taken once.
#[derive(Debug)]
pub struct Background<T>(Option<Receiver<T>>);

/// The thread of the work could not be started, or it panicked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("its thread could not be started, or stopped because of an internal error")]
pub struct NoAnswer;

impl<T> Default for Background<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T> From<Receiver<T>> for Background<T> {
    /// Work that runs elsewhere and sends its result.
    fn from(receiver: Receiver<T>) -> Self {
        Self(Some(receiver))
    }
}

impl<T: Send + 'static> Background<T> {
    /// Starts work on a thread of this name.
    pub fn start(name: &str, work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, receiver) = channel();
        // If no thread can be started, the sender is dropped with the closure: the receiver sees the closed channel,
        // as it does after a panic.
        let _ = spawn(name, move || {
            let _ = sender.send(work());
        });
        receiver.into()
    }
}

impl Background<()> {
    /// Polls `is_ready` at intervals of `interval` on a thread of this name until it is true, and calls `wake` then.
    pub fn poll_until(
        name: &str,
        interval: Duration,
        is_ready: impl Fn() -> bool + Send + 'static,
        wake: impl FnOnce() + Send + 'static,
    ) -> Self {
        let (sender, receiver) = channel();
        let _ = spawn(name, move || {
            loop {
                std::thread::sleep(interval);
                if is_ready() {
                    let _ = sender.send(());
                    return wake();
                }
            }
        });
        receiver.into()
    }
}

impl<T> Background<T> {
    /// Whether there is work whose result was not taken yet.
    pub fn is_awaited(&self) -> bool {
        self.0.is_some()
    }

    /// Takes the result; `None` if it has not arrived, was taken, or no work was started.
    ///
    /// # Errors
    /// [`NoAnswer`] once, if it will never arrive.
    pub fn take(&mut self) -> Option<Result<T, NoAnswer>> {
        self.take_within(Duration::ZERO)
    }

    /// Like [`Self::take`], but waits up to `timeout` for the result.
    ///
    /// # Errors
    /// [`NoAnswer`] once, if it will never arrive.
    pub fn take_within(&mut self, timeout: Duration) -> Option<Result<T, NoAnswer>> {
        let answer = match self.0.as_ref()?.recv_timeout(timeout) {
            Ok(answer) => Ok(answer),
            Err(RecvTimeoutError::Disconnected) => Err(NoAnswer),
            Err(RecvTimeoutError::Timeout) => return None,
        };
        self.0 = None;
        Some(answer)
    }

    /// Waits until the work, if any, is over, and discards its result.
    pub fn finish(self) {
        if let Some(receiver) = self.0 {
            let _ = receiver.recv();
        }
    }
}

/// Starts a thread with a name, for debuggers and process lists.
pub(super) fn spawn(
    name: &str,
    work: impl FnOnce() + Send + 'static,
) -> io::Result<JoinHandle<()>> {
    std::thread::Builder::new()
        .name(name.to_owned())
        .spawn(work)
}

/// The message of a caught panic.
pub fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no reason given")
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use super::*;

    #[test]
    fn poll_until_wakes_once_it_is_ready() {
        let looks = AtomicU32::new(0);
        let (sender, woken) = channel();
        let is_ready = move || looks.fetch_add(1, Ordering::Relaxed) == 3;
        let wake = move || sender.send(()).expect("somebody waits");
        let mut guard = Background::poll_until("guard", Duration::from_millis(1), is_ready, wake);
        assert_eq!(woken.recv(), Ok(()));
        assert_eq!((guard.take(), guard.is_awaited()), (Some(Ok(())), false));
    }

    #[test]
    fn an_answer_is_taken_once_and_one_that_never_comes_is_told() {
        let long = Duration::from_mins(1);
        let mut none = Background::<i32>::default();
        assert!(!none.is_awaited());
        assert_eq!((none.take(), none.take_within(long)), (None, None));
        let mut seven = Background::start("seven", || 7);
        assert_eq!(seven.take_within(long), Some(Ok(7)));
        assert_eq!((seven.take(), seven.is_awaited()), (None, false));
        let (sender, receiver) = channel();
        let mut later = Background::from(receiver);
        assert_eq!((later.take(), later.is_awaited()), (None, true));
        assert_eq!(later.take_within(Duration::ZERO), None);
        sender.send(3).expect("it waits");
        assert_eq!((later.take(), later.is_awaited()), (Some(Ok(3)), false));
        let mut lost = Background::<i32>::start("lost", || panic!("on purpose"));
        assert_eq!(lost.take_within(long), Some(Err(NoAnswer)));
        assert_eq!((lost.take(), lost.is_awaited()), (None, false));
    }
}
