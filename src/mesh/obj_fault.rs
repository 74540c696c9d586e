//! Locates the error in an OBJ file that `tobj` has refused: `tobj` says what is wrong, but not where.

use super::error::{Fault, excerpt};
use super::obj_lines::Kind;
use super::triangles::FARTHEST;

/// Most characters of a word that an error message quotes.
const EXCERPT: usize = 24;

/// Finds the first faulty line. If there is none, the fault repeats `said`, the message of `tobj`.
pub(super) fn find_fault(text: &str, said: &str) -> Fault {
    let is_point = |line: &&str| line.split_ascii_whitespace().next() == Some("v");
    let total = text.lines().filter(is_point).count();
    let mut before = 0;
    let mut going_on = None;
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        let begun = going_on.take();
        let keyword = if begun.is_some() {
            Some("")
        } else {
            words.next()
        };
        let kind = begun.unwrap_or_else(|| Kind::of(line));
        let goes_on = kind.can_go_on() && line.trim_ascii_end().ends_with('\\');
        going_on = goes_on.then_some(kind);
        let why = match keyword {
            Some("v") => {
                before += 1;
                // Coordinates on a continuation line are not checked.
                if goes_on { None } else { wrong_point(words) }
            }
            Some("f") => words
                .take_while(|word| !word.starts_with('#'))
                .filter(|&word| word != "\\")
                .find_map(|word| wrong_corner(word, before, total)),
            _ => None,
        };
        if let Some(why) = why {
            return Fault::in_line(index + 1, why);
        }
    }
    Fault::new(format!("not a valid OBJ file: {said}"))
}

fn wrong_point<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<String> {
    for _ in 0..3 {
        let Some(word) = words.next() else {
            return Some("a point needs three coordinates".to_owned());
        };
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let Some(number) = number else {
            return Some(format!(
                "the coordinate {:?} is not a finite number",
                excerpt(word, EXCERPT)
            ));
        };
        if number.abs() > FARTHEST {
            return Some(format!("the coordinate {number:e} is beyond {FARTHEST:e}"));
        }
    }
    None
}

fn wrong_corner(word: &str, before: usize, total: usize) -> Option<String> {
    let is_number = |text: &str| text.is_empty() || text.parse::<isize>().is_ok();
    let mut numbers = word.split('/');
    let Some(point) = numbers.next().and_then(|text| text.parse::<isize>().ok()) else {
        return Some(format!(
            "the corner {:?} of this face is not the number of a point",
            excerpt(word, EXCERPT)
        ));
    };
    if numbers.clone().count() > 2 || !numbers.all(is_number) {
        return Some(format!(
            "the corner {:?} of this face is not written like 1, 1/2, 1//3 or 1/2/3",
            excerpt(word, EXCERPT)
        ));
    }
    // A negative number counts backwards from the last point before the face.
    let (is_there, count) = match point {
        ..0 => (point.unsigned_abs() <= before, before),
        0 => return Some("this face names point 0; points are counted from 1".to_owned()),
        1.. => (point.unsigned_abs() <= total, total),
    };
    let before = if point < 0 { " before it" } else { "" };
    (!is_there)
        .then(|| format!("this face names point {point}, but there are only {count}{before}"))
}
