//! Waiting for other programs.

use std::io;
use std::process::{Child, ExitStatus};
use std::thread::sleep;
use std::time::Duration;

/// Time between checks whether a program has ended or is no longer wanted.
const TICK: Duration = Duration::from_millis(5);

/// Waits until a program ends. If `is_wanted` returns false before, the program is killed, and the result is `None`.
pub fn wait_for_exit(
    program: &mut Child,
    mut is_wanted: impl FnMut() -> bool,
) -> io::Result<Option<ExitStatus>> {
    let ended = loop {
        match program.try_wait() {
            Ok(None) if is_wanted() => sleep(TICK),
            ended => break ended,
        }
    };
    if !matches!(ended, Ok(Some(_))) {
        let _ = program.kill();
        let _ = program.wait();
    }
    ended
}
