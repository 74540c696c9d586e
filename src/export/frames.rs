//! Sets of frames such as `1-202`, `1,4` and `1-10:3`, in the notation of render farms.

use std::fmt;

/// Most frames of one set.
const MAX_FRAMES: u64 = 1_000_000;

/// Frames in ascending order, each once; counted from 1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Frames(Vec<u64>);

/// A text that is no set of frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FramesError {
    /// The text does not follow the notation.
    #[error("expected frames such as 1-202, 1,4 or 1-10:3, counted from 1; found {0:?}")]
    Syntax(String),
    /// A range ends before it begins.
    #[error("{last} comes before {first} in the frames {text:?}")]
    Backwards {
        /// First frame of the range.
        first: u64,
        /// Last frame of the range.
        last: u64,
        /// The whole text.
        text: String,
    },
    /// There are more frames than can be handled at once.
    #[error(
        "there can be at most {MAX_FRAMES} frames at once: choose some of them, such as 1-{MAX_FRAMES}"
    )]
    TooMany,
}

impl Frames {
    /// All frames from 1 to `last`.
    ///
    /// # Errors
    /// [`FramesError::TooMany`].
    pub fn up_to(last: u64) -> Result<Self, FramesError> {
        if last > MAX_FRAMES {
            return Err(FramesError::TooMany);
        }
        Ok(Self((1..=last).collect()))
    }

    /// Parses a set: numbers and ranges, separated by commas; a range may have a step.
    ///
    /// # Errors
    /// [`FramesError`]: what was expected.
    pub fn parse(text: &str) -> Result<Self, FramesError> {
        let expected = || FramesError::Syntax(text.to_owned());
        let mut frames = Vec::new();
        for part in text.split(',') {
            let (range, step) = part.split_once(':').unwrap_or((part, "1"));
            let (first, last) = range.split_once('-').unwrap_or((range, range));
            let number = |word: &str| word.trim().parse::<u64>().ok().filter(|&number| number > 0);
            let (Some(first), Some(last), Some(step)) = (number(first), number(last), number(step))
            else {
                return Err(expected());
            };
            if last < first {
                return Err(FramesError::Backwards {
                    first,
                    last,
                    text: text.to_owned(),
                });
            }
            if ((last - first) / step).saturating_add(frames.len() as u64) >= MAX_FRAMES {
                return Err(FramesError::TooMany);
            }
            frames.extend((first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX)));
        }
        frames.sort_unstable();
        frames.dedup();
        Ok(Self(frames))
    }

    /// The frames, in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = u64> + '_ {
        self.0.iter().copied()
    }

    /// The frames for which `excludes` is false; there may be none.
    ///
    /// # Errors
    /// The first error of `excludes`.
    pub fn without<E>(&self, excludes: impl Fn(u64) -> Result<bool, E>) -> Result<Self, E> {
        let mut kept = Vec::new();
        for frame in self.iter() {
            if !excludes(frame)? {
                kept.push(frame);
            }
        }
        Ok(Self(kept))
    }

    /// Whether the frames are equally far apart.
    pub fn are_even(&self) -> bool {
        let mut gaps = self.0.windows(2).map(|pair| pair[1] - pair[0]);
        let first = gaps.next();
        gaps.all(|step| Some(step) == first)
    }

    /// The number of frames.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// The last frame.
    pub fn last(&self) -> Option<u64> {
        self.0.last().copied()
    }
}

impl fmt::Display for Frames {
    /// Writes as few ranges as possible; three or more frames that are equally far apart become a range with a step.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut remaining = &self.0[..];
        let mut comma = "";
        while let [first, ..] = remaining {
            let step = remaining.get(1).map_or(1, |second| second - first);
            let equal_gaps = remaining
                .windows(2)
                .take_while(|pair| pair[1] - pair[0] == step);
            let mut run = equal_gaps.count() + 1;
            if step > 1 && run == 2 {
                run = 1;
            }
            let last = remaining[run - 1];
            match (run, step) {
                (1, _) => write!(f, "{comma}{first}")?,
                (_, 1) => write!(f, "{comma}{first}-{last}")?,
                _ => write!(f, "{comma}{first}-{last}:{step}")?,
            }
            comma = ",";
            remaining = &remaining[run..];
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn sets_are_read_as_farms_write_them() {
        let frames = |text| Frames::parse(text).expect("a set").0;
        assert_eq!(frames("1-4"), [1, 2, 3, 4]);
        assert_eq!(frames("1,4"), [1, 4]);
        assert_eq!(frames("1-10:3"), [1, 4, 7, 10]);
        assert_eq!(frames(" 7 - 9 , 1-3, 2"), [1, 2, 3, 7, 8, 9]);
        for set in ["1-4", "1-10:3", "1,4", "1-2,5-20:5,100", "7", "1,3-9"] {
            assert_eq!(Frames::parse(set).expect("a set").to_string(), set);
        }
        for wrong in [
            "",
            "0",
            "1-",
            "-3",
            "a",
            "1-10:0",
            "5-3",
            "1-99999999999",
            "1,2,1-18446744073709551615",
            "1;2",
        ] {
            assert!(Frames::parse(wrong).is_err(), "{wrong}");
        }
    }

    proptest! {
        #[test]
        fn a_set_survives_its_text(frames in prop::collection::btree_set(1..300_u64, 1..60)) {
            let set = Frames(frames.into_iter().collect());
            prop_assert_eq!(Frames::parse(&set.to_string()), Ok(set));
        }
    }
}
