//! Other programs that are waited for.

use std::io;
use std::process::{Child, ExitStatus};
use std::thread::sleep;
use std::time::Duration;

/// How often it is asked whether a program is still wanted.
const TICK: Duration = Duration::from_millis(5);

/// Waits until a program ends. `None` where nobody wants that any more: it is killed.
pub fn end_of(
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
