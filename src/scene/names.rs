//! Unique names for new items.

use std::collections::{HashMap, HashSet};

/// Largest number of characters of a name.
pub const MAX_NAME: usize = 200;
/// Characters reserved for a number at the end of a name.
const NUMBER_CHARS: usize = 20;

/// A set of names that are taken.
#[derive(Debug)]
pub struct Names {
    taken: HashSet<String>,
    /// Next number to try, by name without number.
    next: HashMap<String, u64>,
}

impl Names {
    /// Creates a set of taken names.
    pub fn new<'a>(taken: impl Iterator<Item = &'a str>) -> Self {
        Self {
            taken: taken.map(str::to_owned).collect(),
            next: HashMap::new(),
        }
    }

    /// Takes the name `wanted` if it is free, or else the first free one of `BASE 2`, `BASE 3`, …, where BASE is
    /// `wanted` without its number. Returns the name taken.
    pub fn take(&mut self, wanted: &str) -> String {
        if self.taken.insert(wanted.to_owned()) {
            return wanted.to_owned();
        }
        // Leaves room for the number, so that the result is at most `MAX_NAME` characters long.
        let base: String = without_number(wanted)
            .chars()
            .take(MAX_NAME - NUMBER_CHARS)
            .collect();
        let next = self.next.entry(base.clone()).or_insert(2);
        loop {
            let name = format!("{base} {next}");
            *next += 1;
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// Returns the name without a trailing number that is a separate word.
pub fn without_number(name: &str) -> &str {
    let is_number = |word: &str| word.bytes().all(|letter| letter.is_ascii_digit());
    match name.rsplit_once(' ') {
        Some((base, number)) if is_number(number) => base.trim_end(),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_on_counting() {
        let mut names = Names::new(["Ball 1", "left", "Cube.001", "7"].into_iter());
        for (wanted, taken) in [
            ("Ball 1", "Ball 2"),
            ("Ball 1", "Ball 3"),
            ("Ball 9", "Ball 9"),
            ("left", "left 2"),
            ("left 2", "left 3"),
            ("Cube.001", "Cube.001 2"),
            ("7", "7 2"),
            ("new", "new"),
        ] {
            assert_eq!(names.take(wanted), taken, "{wanted}");
        }
        let long = "é".repeat(MAX_NAME);
        assert_eq!(names.take(&long), long);
        assert!(names.take(&long).chars().count() <= MAX_NAME);
    }
}
