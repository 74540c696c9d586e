//! Arguments that several commands share.

use clap::Args;

use super::error::CliError;
use crate::scene::MAX_SIDE;
use crate::trace::{PoolError, Threads};

/// Most threads: more than any machine has cores, so that a larger number is a mistake.
const MAX_THREADS: u32 = 4096;

/// Most repetitions: more than anyone would wait for.
pub const MAX_TIMES: u32 = 1_000_000;

/// How large a picture is to be.
#[derive(Clone, Copy, Debug, Args)]
pub struct SizeArgs {
    /// Width in pixels; without --height, the aspect ratio of the scene is kept
    #[arg(long, value_parser = whole_number::<1, MAX_SIDE>, allow_negative_numbers = true)]
    width: Option<u32>,
    /// Height in pixels; without --width, the aspect ratio of the scene is kept
    #[arg(long, value_parser = whole_number::<1, MAX_SIDE>, allow_negative_numbers = true)]
    height: Option<u32>,
}

/// How many threads trace.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct ThreadsArgs {
    /// Tracing threads [default: one per core]
    #[arg(long, value_parser = whole_number::<1, MAX_THREADS>, allow_negative_numbers = true)]
    threads: Option<u32>,
}

impl SizeArgs {
    /// Width and height; if only one side is given, the aspect ratio of `scene_size`, the scene's size, is kept.
    ///
    /// # Errors
    /// [`CliError::Usage`], if the other side would be longer than a picture can be.
    pub fn of(self, scene_size: (u32, u32)) -> Result<(u32, u32), CliError> {
        Ok(match (self.width, self.height) {
            (None, None) => scene_size,
            (Some(width), Some(height)) => (width, height),
            (Some(width), None) => (
                width,
                proportional_side("height", width, (scene_size.1, scene_size.0))?,
            ),
            (None, Some(height)) => (proportional_side("width", height, scene_size)?, height),
        })
    }
}

impl ThreadsArgs {
    /// Starts the threads.
    ///
    /// # Errors
    /// [`PoolError`], if the system cannot start them.
    pub fn start(self) -> Result<Threads, PoolError> {
        Threads::new(self.threads.map(|threads| threads as usize))
    }
}

/// Parses an integer from `MIN` to `MAX`.
///
/// # Errors
/// A message that gives the range, for any other word.
pub fn whole_number<const MIN: u32, const MAX: u32>(word: &str) -> Result<u32, String> {
    let number = word.parse().ok();
    number
        .filter(|number| (MIN..=MAX).contains(number))
        .ok_or_else(|| format!("expected a whole number from {MIN} to {MAX}"))
}

/// The side called `name`: `given · numerator / denominator`, rounded.
fn proportional_side(
    name: &str,
    given: u32,
    (numerator, denominator): (u32, u32),
) -> Result<u32, CliError> {
    let exact = (u64::from(given) * u64::from(numerator) + u64::from(denominator) / 2)
        / u64::from(denominator);
    let side = u32::try_from(exact).ok().filter(|side| *side <= MAX_SIDE);
    side.map(|side| side.max(1)).ok_or_else(|| {
        CliError::usage(format!(
            "at the scene's aspect ratio, the {name} would be {exact} pixels, and the limit is {MAX_SIDE}: give both width and height"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_side_keeps_the_aspect_or_is_refused() {
        let size = |width, height| SizeArgs { width, height }.of((1024, 2048)).ok();
        assert_eq!(size(None, None), Some((1024, 2048)));
        assert_eq!(size(Some(100), None), Some((100, 200)));
        assert_eq!(size(None, Some(1)), Some((1, 1)));
        assert_eq!(size(Some(MAX_SIDE), Some(9)), Some((MAX_SIDE, 9)));
        assert_eq!(size(Some(MAX_SIDE), None), None);
        let refused = SizeArgs {
            width: Some(MAX_SIDE),
            height: None,
        }
        .of((1024, 2048));
        let said = refused.expect_err("too high").to_string();
        assert!(said.contains("the height would be 32768 pixels"), "{said}");
    }

    #[test]
    fn numbers_are_whole_and_within_what_there_is() {
        assert_eq!(whole_number::<1, 256>("256"), Ok(256));
        for wrong in ["", "0", "257", "1e1", "1.0", "-1", " 2", "99999999999"] {
            let said = whole_number::<1, 256>(wrong).expect_err(wrong);
            assert_eq!(said, "expected a whole number from 1 to 256");
        }
    }
}
