//! One-off work off the caller's thread.

use std::any::Any;
use std::io;
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;

/// Runs `work` on a thread of that name; what it returns arrives in the channel, which is closed
/// without it if the thread cannot start or panics.
pub fn run_in_background<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> Receiver<T> {
    let (sender, receiver) = channel();
    // Where no thread can be had, the sender is dropped with the closure: the receiver sees the
    // closed channel, which is the failure that it has to handle anyway.
    let _ = spawn(name, move || {
        let _ = sender.send(work());
    });
    receiver
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

/// What a caught panic said.
pub fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no reason given")
}
