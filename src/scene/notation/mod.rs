//! Representation of values in the scene file.

pub mod number;

pub mod vector;

pub mod method;

use glam::DVec3;

/// Returns whether a value is the default, and so need not be written.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Numbers of at least this size, or smaller than its reciprocal, are written with an exponent.
const MAX_DIGITS: f64 = 1e17;

/// Returns the shortest text that parses to `value`, without `.0` on whole numbers.
pub fn format_number(value: f64) -> String {
    let size = value.abs();
    if size >= MAX_DIGITS || (size > 0.0 && size < MAX_DIGITS.recip()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// Parses `1, 2, 3`, `(1, 2, 3)` or `1 2 3`; `None` if the text is not three finite numbers.
pub fn parse_vec3(text: &str) -> Option<DVec3> {
    let inner = text
        .trim()
        .trim_start_matches(['(', '['])
        .trim_end_matches([')', ']']);
    let numbers: Option<Vec<f64>> = inner
        .split([',', ' ', ';', '\t'])
        .filter(|part| !part.is_empty())
        .map(|part| part.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    <[f64; 3]>::try_from(numbers?).ok().map(DVec3::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_pasted_in_many_ways() {
        for text in ["1, 2, -3.5", "(1,2,-3.5)", " 1 2 -3.5 ", "[1; 2; -3.5]"] {
            assert_eq!(parse_vec3(text), Some(DVec3::new(1.0, 2.0, -3.5)), "{text}");
        }
        for text in ["", "1, 2", "1, 2, 3, 4", "1, x, 3", "1, inf, 3"] {
            assert_eq!(parse_vec3(text), None, "{text}");
        }
    }
}
