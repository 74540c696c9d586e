//! File names of frames: `rayTrace%d`, `shot.%05d`.

use crate::files::UNFINISHED;

/// A file name with a placeholder for the frame number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    /// Least number of digits; shorter numbers are padded with zeros.
    digits: usize,
    after: String,
}

/// A text that is not a valid pattern.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{why}, for example rayTrace%d or shot.%05d; found {found:?}")]
pub struct PatternError {
    why: String,
    found: String,
}

impl Pattern {
    /// Parses a pattern with one `%d`, or `%05d` for at least five digits. The width does not depend on the number of
    /// frames, so that names stay the same when frames are added.
    ///
    /// # Errors
    /// [`PatternError`]: what was expected.
    pub fn parse(text: &str) -> Result<Self, PatternError> {
        let wrong = |why: &str| {
            Err(PatternError {
                why: why.to_owned(),
                found: text.to_owned(),
            })
        };
        let Some((before, rest)) = text.split_once('%') else {
            return wrong("the name needs %d where the number goes");
        };
        let Some((digits, after)) = rest.split_once('d') else {
            return wrong("% must be followed by d, or by the number of digits and d");
        };
        let Some(digits) = digits_of(digits) else {
            return wrong("% must be followed by d, or by the number of digits (at most 12) and d");
        };
        if after.contains('%') {
            return wrong("the name can have only one %");
        }
        if text.starts_with(UNFINISHED) {
            return wrong("the name would be mistaken for that of an unfinished file");
        }
        if text.contains(['/', '\\']) {
            return wrong("the name must not contain folders");
        }
        if text.chars().any(char::is_control) {
            return wrong("the name must not contain control characters");
        }
        Ok(Self {
            before: before.to_owned(),
            digits,
            after: after.to_owned(),
        })
    }

    /// The file name of a frame, without extension.
    pub fn name(&self, frame: u64) -> String {
        let Self {
            before,
            digits,
            after,
        } = self;
        format!("{before}{frame:0digits$}{after}")
    }

    /// The pattern as text.
    pub fn text(&self) -> String {
        let digits = match self.digits {
            0 => String::new(),
            digits => format!("0{digits}"),
        };
        format!("{}%{digits}d{}", self.before, self.after)
    }
}

/// Parses the number of digits: `05` or `5` or nothing.
fn digits_of(text: &str) -> Option<usize> {
    if text.is_empty() {
        return Some(0);
    }
    let digits = text.parse::<usize>().ok()?;
    (digits <= 12 && text.chars().all(|c| c.is_ascii_digit())).then_some(digits)
}

impl Default for Pattern {
    /// The names of the original program.
    fn default() -> Self {
        Self {
            before: "rayTrace".to_owned(),
            digits: 0,
            after: String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_where_the_pattern_says() {
        let name = |text, frame| Pattern::parse(text).expect("a pattern").name(frame);
        assert_eq!(name("rayTrace%d", 7), "rayTrace7");
        assert_eq!(name("shot.%05d.x", 7), "shot.00007.x");
        assert_eq!(name("%3d", 1234), "1234");
        for wrong in ["frame", "%s", "%d%d", "a/%d", "%xd", "%099d", "%"] {
            assert!(Pattern::parse(wrong).is_err(), "{wrong}");
        }
        assert_eq!(
            Pattern::parse("a%05db").expect("a pattern").text(),
            "a%05db"
        );
        assert_eq!(Pattern::default().text(), "rayTrace%d");
    }
}
