//! What new things are called.

use std::collections::{HashMap, HashSet};

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
        let base = base(wanted);
        let next = self.next.entry(base.to_owned()).or_insert(2);
        loop {
            let name = format!("{base} {next}");
            *next += 1;
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// A name without its number.
fn base(name: &str) -> &str {
    let base = name
        .trim_end_matches(|c: char| c.is_ascii_digit())
        .trim_end();
    if base.is_empty() { name } else { base }
}
