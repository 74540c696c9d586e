//! Watching, stopping and pausing a trace.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What a running trace and its caller share.
#[derive(Debug, Default)]
pub struct RenderControl {
    /// Whether the trace shall stop, within a part of a tile.
    stop: AtomicBool,
    /// Pixels traced so far.
    pub pixels: AtomicU64,
    /// Whether the trace shall pause: every thread checks it before every piece.
    is_paused: AtomicBool,
    pause: Mutex<Pause>,
    resumed: Condvar,
}

/// How long a trace has been paused.
#[derive(Debug, Default)]
struct Pause {
    /// Total of the pauses that have ended.
    completed: Duration,
    /// Start of the current pause, if there is one.
    since: Option<Instant>,
}

impl RenderControl {
    /// Stops the trace within a part of a tile, even if it is paused.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
        self.go_on();
    }

    /// Returns whether the trace shall stop.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Pauses the trace before its next piece, until [`Self::go_on`].
    pub fn pause(&self) {
        let mut pause = self.lock();
        pause.since.get_or_insert_with(Instant::now);
        self.is_paused.store(true, Ordering::Relaxed);
    }

    /// Ends a pause, if there is one.
    pub fn go_on(&self) {
        let mut pause = self.lock();
        if let Some(since) = pause.since.take() {
            pause.completed += since.elapsed();
        }
        self.is_paused.store(false, Ordering::Relaxed);
        drop(pause);
        self.resumed.notify_all();
    }

    /// Returns whether the trace shall pause.
    pub fn is_paused(&self) -> bool {
        self.is_paused.load(Ordering::Relaxed)
    }

    /// Returns how long the trace has been paused so far.
    pub fn paused(&self) -> Duration {
        let pause = self.lock();
        pause.completed + pause.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// Starts a stopwatch that does not count pauses.
    pub fn stopwatch(&self) -> Stopwatch<'_> {
        Stopwatch {
            control: self,
            start: Instant::now(),
            paused: self.paused(),
        }
    }

    /// Blocks until there is no pause, or the trace is stopped.
    pub(super) fn wait_while_paused(&self) {
        if !self.is_paused() {
            return;
        }
        let mut pause = self.lock();
        while pause.since.is_some() && !self.is_stopped() {
            let woken = self.resumed.wait(pause);
            pause = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Pause> {
        self.pause.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Measures time, without the pauses of a trace.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch<'a> {
    control: &'a RenderControl,
    start: Instant,
    paused: Duration,
}

impl Stopwatch<'_> {
    /// Returns the time since its start, without pauses.
    pub fn elapsed(&self) -> Duration {
        let paused = self.control.paused().saturating_sub(self.paused);
        self.start.elapsed().saturating_sub(paused)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Duration = Duration::from_millis(30);

    #[test]
    fn what_is_paused_waits_until_it_goes_on_and_the_time_does_not_count() {
        let control = RenderControl::default();
        let watch = control.stopwatch();
        control.wait_while_paused();
        control.pause();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| control.wait_while_paused());
            std::thread::sleep(SHORT);
            assert!(!waiting.is_finished() && control.is_paused());
            control.go_on();
        });
        assert!(control.paused() >= SHORT && !control.is_paused());
        let counted = watch.elapsed();
        assert!(counted + SHORT <= watch.start.elapsed());
    }

    #[test]
    fn what_is_stopped_does_not_wait() {
        let control = RenderControl::default();
        control.pause();
        std::thread::scope(|scope| {
            scope.spawn(|| control.wait_while_paused());
            std::thread::sleep(SHORT);
            control.stop();
        });
        control.pause();
        control.wait_while_paused();
        assert!(control.is_stopped());
    }
}
