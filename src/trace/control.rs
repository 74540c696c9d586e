//! How a trace is watched, stopped, and made to wait.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// What a running trace and its caller tell each other.
#[derive(Debug, Default)]
pub struct RenderControl {
    /// Whether the trace is to end within a part of a tile.
    pub(super) stop: AtomicBool,
    /// Pixels traced so far.
    pub pixels: AtomicU64,
    /// Whether it is to wait: looked at for every piece, by every thread.
    is_paused: AtomicBool,
    pause: Mutex<Pause>,
    gone_on: Condvar,
}

/// How long a trace has waited.
#[derive(Debug, Default)]
struct Pause {
    /// Before this time.
    before: Duration,
    /// Since when it waits, if it does.
    since: Option<Instant>,
}

impl RenderControl {
    /// Ends the trace within a part of a tile, also one that waits.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
        self.go_on();
    }

    /// Whether what is traced is not wanted any more.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Lets the trace wait before its next piece, until [`Self::go_on`].
    pub fn pause(&self) {
        let mut pause = self.lock();
        pause.since.get_or_insert_with(Instant::now);
        self.is_paused.store(true, Ordering::Relaxed);
    }

    /// Ends a pause, if there is one.
    pub fn go_on(&self) {
        let mut pause = self.lock();
        if let Some(since) = pause.since.take() {
            pause.before += since.elapsed();
        }
        self.is_paused.store(false, Ordering::Relaxed);
        drop(pause);
        self.gone_on.notify_all();
    }

    /// Whether the trace is to wait.
    pub fn is_paused(&self) -> bool {
        self.is_paused.load(Ordering::Relaxed)
    }

    /// How long the trace has waited so far.
    pub fn paused(&self) -> Duration {
        let pause = self.lock();
        pause.before + pause.since.map_or(Duration::ZERO, |since| since.elapsed())
    }

    /// Begins to measure what takes time, without the pauses.
    pub fn stopwatch(&self) -> Stopwatch<'_> {
        Stopwatch {
            control: self,
            start: Instant::now(),
            paused: self.paused(),
        }
    }

    /// Returns once there is no pause, or the trace is stopped.
    pub(super) fn wait(&self) {
        if !self.is_paused() {
            return;
        }
        let mut pause = self.lock();
        while pause.since.is_some() && !self.is_stopped() {
            let woken = self.gone_on.wait(pause);
            pause = woken.unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Pause> {
        self.pause.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Measures time without the pauses of a trace.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch<'a> {
    control: &'a RenderControl,
    start: Instant,
    paused: Duration,
}

impl Stopwatch<'_> {
    /// Time since it was begun in which there was no pause.
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
        control.wait();
        control.pause();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| control.wait());
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
            scope.spawn(|| control.wait());
            std::thread::sleep(SHORT);
            control.stop();
        });
        control.pause();
        control.wait();
        assert!(control.is_stopped());
    }
}
