//! Summarises a map in a sentence.

use super::map::{Axis, Map, Tries};
use crate::words::short_number;

/// Axes whose name is put before the number; it follows the number for all others.
const NAMES: [&str; 3] = ["scale", "exponent", "longest to shortest segment"];

impl Map {
    /// Describes where the method fails, and how often there.
    pub fn sentence(&self) -> String {
        let total = self.total();
        if total.failures == 0 {
            let (tries, bound) = (grouped(total.tries), percent(total.bound()));
            return format!("none of {tries} (< {bound})");
        }
        let columns = self.sums_along(|column, _| column, self.across.values.len());
        let rows = self.sums_along(|_, row| row, self.up.values.len());
        let part = failing_part(&self.across, &columns).or_else(|| failing_part(&self.up, &rows));
        match part {
            Some((words, tries)) => format!("{} {words}", percent(tries.rate())),
            None => self.share_of_cells(),
        }
    }

    /// Describes failures that are in no part of an axis.
    fn share_of_cells(&self) -> String {
        let tried = self.cells.iter().filter(|cell| cell.tries > 0);
        let failing = tried.clone().filter(|cell| cell.failures > 0);
        let rate = percent(failing.clone().copied().sum::<Tries>().rate());
        match (failing.count(), tried.count()) {
            (failing, tried) if failing == tried => format!("{rate} wherever it was tested"),
            (failing, tried) => format!("{rate} in {failing} of {tried} cells"),
        }
    }

    /// The tries at each value of one axis, summed over all values of the other.
    fn sums_along(&self, mark: impl Fn(usize, usize) -> usize, count: usize) -> Vec<Tries> {
        let width = self.across.values.len();
        let mut sums = vec![Tries::default(); count];
        for (index, cell) in self.cells.iter().enumerate() {
            let sum = &mut sums[mark(index % width, index / width)];
            *sum = [*sum, *cell].into_iter().sum();
        }
        sums
    }
}

/// The part of an axis that contains all failures, in words, with its tries; `None` if that is the whole axis, or if
/// there are none.
fn failing_part(axis: &Axis, sums: &[Tries]) -> Option<(String, Tries)> {
    let fails = |at: &usize| sums[*at].failures > 0;
    let first = (0..sums.len()).find(fails)?;
    let last = (0..sums.len()).rev().find(fails)?;
    let at = |mark: usize| {
        let (name, value) = (axis.name, number(axis.values[mark]));
        // `scale 0.1`, but `10 radii`.
        if NAMES.contains(&name) {
            format!("{name} {value}")
        } else {
            format!("{value} {name}")
        }
    };
    let words = match (first == 0, last + 1 == sums.len()) {
        (true, true) => return None,
        (false, true) => format!("from {} on", at(first)),
        (true, false) => format!("up to {}", at(last)),
        (false, false) if first == last => format!("at {}", at(first)),
        (false, false) => format!("from {} to {}", at(first), at(last)),
    };
    Some((words, sums[first..=last].iter().copied().sum()))
}

/// A number as it is shown on an axis.
pub fn number(value: f64) -> String {
    if value == 0.0 || (1e-2..1e3).contains(&value) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn percent(rate: f64) -> String {
    let percent = rate * 100.0;
    match percent {
        _ if percent >= 99.95 => "100 %".to_owned(),
        _ if percent >= 10.0 => format!("{percent:.0} %"),
        _ => format!("{} %", short_number(percent)),
    }
}

/// A number with its thousands separated.
fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stability::MapSubject;

    fn map(failures: [u64; 4]) -> Map {
        Map {
            subject: MapSubject::Sphere,
            method: String::new(),
            is_default: false,
            failure: "",
            across: Axis {
                name: "radii",
                values: vec![10.0, 1e4],
            },
            up: Axis {
                name: "scale",
                values: vec![0.1, 1.0],
            },
            cells: failures
                .map(|failures| Tries {
                    tries: 1000,
                    failures,
                })
                .to_vec(),
        }
    }

    #[test]
    fn a_map_says_where_it_fails_and_how_often_there() {
        assert_eq!(map([0; 4]).sentence(), "none of 4,000 (< 0.075 %)");
        assert_eq!(map([0, 500, 0, 460]).sentence(), "48 % from 1e4 radii on");
        assert_eq!(map([30, 0, 12, 0]).sentence(), "2.1 % up to 10 radii");
        assert_eq!(map([1, 2, 0, 0]).sentence(), "0.15 % up to scale 0.1");
        assert_eq!(map([1000; 4]).sentence(), "100 % wherever it was tested");
        assert_eq!(map([100, 0, 0, 300]).sentence(), "20 % in 2 of 4 cells");
    }
}
