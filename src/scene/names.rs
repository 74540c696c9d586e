//! What new things are called.

use std::collections::{HashMap, HashSet};

/// Most characters of a name.
pub const MAX_NAME: usize = 200;
/// Those that a number may take up.
const NUMBER: usize = 20;

/// Names that are taken.
#[derive(Debug)]
pub struct Names {
    taken: HashSet<String>,
    /// For names without their numbers the number to go on with.
    next: HashMap<String, u64>,
}

impl Names {
    /// These are taken.
    pub fn new<'a>(taken: impl Iterator<Item = &'a str>) -> Self {
        Self {
            taken: taken.map(str::to_owned).collect(),
            next: HashMap::new(),
        }
    }

    /// The name that is wanted, or the first of `BASE 2`, `BASE 3`, … that is free, where BASE is that name
    /// without its number. It is then taken.
    pub fn take(&mut self, wanted: &str) -> String {
        if self.taken.insert(wanted.to_owned()) {
            return wanted.to_owned();
        }
        // With its number, it is no longer than a name may be.
        let base: String = without_number(wanted)
            .chars()
            .take(MAX_NAME - NUMBER)
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

/// A name without the number that is a word of its own.
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
