//! Locates the error in an OBJ file that `tobj` has refused: `tobj` says what is wrong, but not where.

use super::error::{Fault, MAX_WORD_CHARS, excerpt};
use super::obj_lines::LineKind;
use super::triangles::MAX_COORDINATE;

/// Finds the first faulty line. If there is none, the fault repeats `message`, that of `tobj`.
pub(super) fn find_fault(text: &str, message: &str) -> Fault {
    let is_point = |line: &&str| line.split_ascii_whitespace().next() == Some("v");
    let total = text.lines().filter(is_point).count();
    let mut points_before = 0;
    let mut continued_kind = None;
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        let begun_kind = continued_kind.take();
        let keyword = if begun_kind.is_some() {
            Some("")
        } else {
            words.next()
        };
        let kind = begun_kind.unwrap_or_else(|| LineKind::of(line));
        let continues = kind.can_continue() && line.trim_ascii_end().ends_with('\\');
        continued_kind = continues.then_some(kind);
        let why = match keyword {
            Some("v") => {
                points_before += 1;
                // Coordinates on a continuation line are not checked.
                if continues { None } else { point_error(words) }
            }
            Some("f") => {
                let corners = line.split('#').next().unwrap_or_default();
                let corners = corners.split_ascii_whitespace().skip(1);
                corners
                    .filter(|&word| word != "\\")
                    .find_map(|word| corner_error(word, points_before, total))
            }
            _ => None,
        };
        if let Some(why) = why {
            return Fault::in_line(index + 1, why);
        }
    }
    Fault::new(format!("not a valid OBJ file: {message}"))
}

fn point_error<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<String> {
    for _ in 0..3 {
        let Some(word) = words.next() else {
            return Some("a point needs three coordinates".to_owned());
        };
        let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
        let Some(number) = number else {
            return Some(format!(
                "the coordinate {:?} is not a finite number",
                excerpt(word, MAX_WORD_CHARS)
            ));
        };
        if number.abs() > MAX_COORDINATE {
            return Some(format!(
                "the coordinate {number:e} is beyond {MAX_COORDINATE:e}"
            ));
        }
    }
    None
}

fn corner_error(word: &str, before: usize, total: usize) -> Option<String> {
    let is_number = |text: &str| text.is_empty() || text.parse::<isize>().is_ok();
    let mut numbers = word.split('/');
    let Some(point) = numbers.next().and_then(|text| text.parse::<isize>().ok()) else {
        return Some(format!(
            "the corner {:?} of this face is not the number of a point",
            excerpt(word, MAX_WORD_CHARS)
        ));
    };
    if numbers.clone().count() > 2 || !numbers.all(is_number) {
        return Some(format!(
            "the corner {:?} of this face is not written like 1, 1/2, 1//3 or 1/2/3",
            excerpt(word, MAX_WORD_CHARS)
        ));
    }
    // A negative number counts backwards from the last point before the face.
    let (exists, count) = match point {
        ..0 => (point.unsigned_abs() <= before, before),
        0 => return Some("this face names point 0; points are counted from 1".to_owned()),
        1.. => (point.unsigned_abs() <= total, total),
    };
    let before = if point < 0 { " before it" } else { "" };
    (!exists).then(|| format!("this face names point {point}, but there are only {count}{before}"))
}
