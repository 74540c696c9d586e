//! Formatting of numbers, names and quotations in messages.

use std::borrow::Cow;
use std::fmt::Display;
use std::time::Duration;

/// A number with the name of what it counts: `1 frame`, `3 frames`.
pub fn counted<N: Copy + Display + PartialEq + From<u8>>(number: N, singular: &str) -> String {
    let s = if number == N::from(1) { "" } else { "s" };
    format!("{number} {singular}{s}")
}

/// A word with its first letter in upper case.
pub fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// A time in milliseconds.
pub fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// A number with one decimal, or with two significant digits if it is between 0 and 1.
pub fn short_number(value: f64) -> String {
    let digits = if value > 0.0 && value < 1.0 {
        (1.0 - value.log10().floor()).clamp(1.0, 9.0) as usize
    } else {
        1
    };
    format!("{value:.digits$}")
}

/// Most names that a message lists.
const MAX_NAMES: usize = 3;

/// The first few names, and how many more there are; `None` if there are none.
pub fn listed(mut names: impl Iterator<Item = String>) -> Option<String> {
    let first: Vec<String> = names.by_ref().take(MAX_NAMES).collect();
    let more = match names.count() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    (!first.is_empty()).then(|| format!("{}{more}", first.join(", ")))
}

/// Most characters of a text that a message quotes.
const MAX_QUOTED: usize = 40;

/// A text in quotation marks, shortened if it is long.
pub fn quoted(text: &str) -> String {
    format!("“{}”", shortened(text, MAX_QUOTED))
}

/// A word quoted for a shell. Only words with a zero byte cannot be quoted, and no path contains one.
pub fn for_shell(word: &str) -> String {
    shlex::try_quote(word).map_or_else(|_| word.to_owned(), Cow::into_owned)
}

/// The first line of a text, cut to at most `max_chars` characters; `…` marks what is left out.
pub fn shortened(text: &str, max_chars: usize) -> String {
    let text = text.trim();
    let line = text.lines().next().unwrap_or_default();
    let short: String = line.chars().take(max_chars).collect();
    let ellipsis = if short.len() < text.len() { "…" } else { "" };
    format!("{}{ellipsis}", short.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_have_two_digits() {
        for (value, words) in [
            (12.34, "12.3"),
            (1.0, "1.0"),
            (0.0444, "0.044"),
            (0.99, "0.99"),
            (0.0, "0.0"),
        ] {
            assert_eq!(short_number(value), words);
        }
    }

    #[test]
    fn long_texts_are_quoted_by_their_beginning() {
        assert_eq!(quoted(" abc "), "“abc”");
        assert_eq!(quoted("Scene(\n  version: 1"), "“Scene(…”");
        assert_eq!(quoted(&"é".repeat(41)), format!("“{}…”", "é".repeat(40)));
        assert_eq!(quoted(""), "“”");
    }
}
