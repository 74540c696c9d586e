//! Words for people.

use std::fmt::Display;

/// A number and what it counts: `1 frame`, `3 frames`.
pub fn counted<N: Copy + Display + PartialEq + From<u8>>(number: N, one: &str) -> String {
    let s = if number == N::from(1) { "" } else { "s" };
    format!("{number} {one}{s}")
}
