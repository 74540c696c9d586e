//! Marks of logarithmic axes, and their labels.

use std::ops::RangeInclusive;

use egui::Rangef;
use egui_plot::{GridInput, GridMark};

/// Axes that span more decades than this have no marks, as these would be less than a pixel apart.
pub const MAX_DECADES: f64 = 40.0;
/// Distances in points at which grid lines appear and are as bright as text: they stay fainter than what is measured.
pub const GRID_FADE: Rangef = Rangef {
    min: 8.0,
    max: 1200.0,
};

fn marks_at(input: &GridInput, digits: &[u32]) -> Vec<GridMark> {
    let (low, high) = (input.bounds.0.floor() as i32, input.bounds.1.ceil() as i32);
    if f64::from(high - low) > MAX_DECADES {
        return Vec::new();
    }
    let decade = |exponent: i32| {
        digits.iter().map(move |&digit| GridMark {
            value: f64::from(exponent) + f64::from(digit).log10(),
            step_size: 1.0,
        })
    };
    let is_visible = |mark: &GridMark| (input.bounds.0..=input.bounds.1).contains(&mark.value);
    (low..=high).flat_map(decade).filter(is_visible).collect()
}

/// Marks at the powers of ten, and at 2 and 5 times these on axes that span few decades.
pub fn decades(input: &GridInput) -> Vec<GridMark> {
    let is_narrow = input.bounds.1 - input.bounds.0 < 1.5;
    marks_at(input, if is_narrow { &[1, 2, 5] } else { &[1] })
}

/// Marks at the powers of ten.
pub fn powers(input: &GridInput) -> Vec<GridMark> {
    marks_at(input, &[1])
}

/// The value at a mark as plain decimals; as a power of ten if it is very large or small.
pub fn plain(mark: GridMark, _: &RangeInclusive<f64>) -> String {
    let value = 10.0_f64.powf(mark.value);
    if (1e-3..1e6).contains(&value) {
        let text = format!("{value:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        superscript(mark.value.round() as i32)
    }
}

/// The value at a mark as a power of ten.
pub fn power_of_ten(mark: GridMark, _: &RangeInclusive<f64>) -> String {
    superscript(mark.value.round() as i32)
}

/// The value at a mark in decibels.
pub fn decibels(mark: GridMark, _: &RangeInclusive<f64>) -> String {
    format!("{:.0}", (-20.0 * mark.value).round() + 0.0)
}

fn superscript(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|digit| match digit {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹']
            [digit.to_digit(10).unwrap_or(0) as usize],
    });
    std::iter::once("10".to_owned())
        .chain(raised.map(String::from))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_written_alike() {
        let mark = |value: f64| GridMark {
            value,
            step_size: 1.0,
        };
        let all = 0.0..=1.0;
        assert_eq!(power_of_ten(mark(-3.0), &all), "10⁻³");
        assert_eq!(power_of_ten(mark(12.0), &all), "10¹²");
        assert_eq!(plain(mark(-1.0), &all), "0.1");
        assert_eq!(plain(mark(2.0), &all), "100");
        assert_eq!(
            (decibels(mark(-3.0), &all), decibels(mark(0.0), &all)),
            ("60".to_owned(), "0".to_owned())
        );
    }
}
