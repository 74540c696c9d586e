//! Maps of failure rates, and the axes that they are measured over.

use std::iter::Sum;

use glam::DVec3;

use super::subject::MapSubject;
use crate::scene::{Method, MethodInfo};

/// Scale factors for a scene of size one.
const SCALES: [f64; 12] = [
    1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7,
];
/// Distances of a scene from the origin, relative to its size.
const OFFSETS: [f64; 8] = [0.0, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];

/// The unit direction in which scenes are moved away from the origin; it is parallel to no axis.
const OFFSET_DIRECTION: DVec3 = DVec3::new(0.6, -0.64, 0.48);

/// A point of a scene of size one that is moved away from the origin, `away` times its size, and scaled.
pub fn placed(point: DVec3, away: f64, scale: f64) -> DVec3 {
    (point + OFFSET_DIRECTION * away) * scale
}

/// An axis of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it measures, or its unit.
    pub name: &'static str,
    /// The values that are measured.
    pub values: Vec<f64>,
}

impl Axis {
    /// Creates an axis with these values.
    pub fn new(name: &'static str, values: &[f64]) -> Self {
        let values = values.to_vec();
        Self { name, values }
    }

    /// The second axis of a map that has only one: a single value.
    pub fn one(name: &'static str) -> Self {
        let values = vec![1.0];
        Self { name, values }
    }
}

/// A number of tries, and how many of them failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tries {
    /// Number of tries.
    pub tries: u64,
    /// Number of failures.
    pub failures: u64,
}

impl Sum for Tries {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, tries| Self {
            tries: sum.tries + tries.tries,
            failures: sum.failures + tries.failures,
        })
    }
}

impl Tries {
    /// Share of failures; NaN if there were no tries.
    pub fn rate(self) -> f64 {
        self.failures as f64 / self.tries as f64
    }

    /// Upper bound on the true rate with a confidence of 95 %: 3/n if nothing failed (the rule of three), otherwise
    /// Wilson's bound.
    ///
    /// Wilson, "Probable inference", JASA 22, 1927.
    pub fn bound(self) -> f64 {
        let (n, rate) = (self.tries as f64, self.rate());
        if self.failures == 0 {
            return (3.0 / n).min(1.0);
        }
        let z = 1.645_f64;
        let middle = rate + z * z / (2.0 * n);
        let spread = z * (rate * (1.0 - rate) / n + z * z / (4.0 * n * n)).sqrt();
        ((middle + spread) / (1.0 + z * z / n)).min(1.0)
    }

    /// Counts failures among tries.
    pub fn count(tries: impl IntoIterator<Item = bool>) -> Self {
        let mut sum = Self::default();
        for is_failure in tries {
            sum.tries += 1;
            sum.failures += u64::from(is_failure);
        }
        sum
    }
}

/// The failure rate of one method over two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// What is tested.
    pub subject: MapSubject,
    /// The id or name of the method.
    pub method: String,
    /// Whether the method is the default.
    pub is_default: bool,
    /// What counts as a failure.
    pub failure: &'static str,
    /// The axis from left to right.
    pub across: Axis,
    /// The axis from bottom to top.
    pub up: Axis,
    /// One entry per pair of values, row by row from the bottom.
    pub cells: Vec<Tries>,
}

impl Map {
    /// Measures a method in every cell. The arguments are what is tested and what counts as a failure, the method and
    /// whether it is the default, both axes, and the tries for a pair of their values.
    pub fn measure(
        (subject, failure): (MapSubject, &'static str),
        (method, is_default): (String, bool),
        (across, up): (Axis, Axis),
        mut tries_at: impl FnMut(f64, f64) -> Tries,
    ) -> Self {
        let mut cells = Vec::new();
        for &y in &up.values {
            for &x in &across.values {
                cells.push(tries_at(x, y));
            }
        }
        Self {
            subject,
            method,
            is_default,
            failure,
            across,
            up,
            cells,
        }
    }

    /// Measures every method of a setting, as [`Self::measure`] does.
    pub fn of_methods<M: Method + Default>(
        what: (MapSubject, &'static str),
        (across, up): (Axis, Axis),
        tries_at: impl Fn(M, f64, f64) -> Tries,
    ) -> Vec<Self> {
        let measured = M::ALL.iter().map(|MethodInfo { value, id, .. }| {
            let method = ((*id).to_owned(), *value == M::default());
            let axes = (across.clone(), up.clone());
            Self::measure(what, method, axes, |x, y| tries_at(*value, x, y))
        });
        measured.collect()
    }

    /// The sum of all tries.
    pub fn total(&self) -> Tries {
        self.cells.iter().copied().sum()
    }

    /// The cell with the highest failure rate, with its values on both axes.
    pub fn worst(&self) -> Option<(f64, f64, Tries)> {
        let width = self.across.values.len();
        let index = (0..self.cells.len()).max_by(|&a, &b| {
            let rates = (self.cells[a].rate(), self.cells[b].rate());
            // Of equal rates, the first is under the mildest conditions.
            rates.0.total_cmp(&rates.1).then(b.cmp(&a))
        })?;
        Some((
            self.across.values[index % width],
            self.up.values[index / width],
            self.cells[index],
        ))
    }
}

pub fn scale_axis() -> Axis {
    Axis::new("scale", &SCALES)
}

pub fn offset_axis() -> Axis {
    Axis::new("sizes away", &OFFSETS)
}

/// A pseudorandom number from 0 to below 1, the same every time for a number and a stream.
pub fn scattered(number: u64, stream: u64) -> f64 {
    share(mixed(
        (number + 1).wrapping_mul(GOLDEN) ^ stream.wrapping_mul(0xD1B5_4A32_D192_ED03),
    ))
}

/// A pseudorandom direction, and one perpendicular to it; rarely `None`. Uses streams 0 to 5.
pub fn normal_and_perpendicular(number: u64) -> Option<(DVec3, DVec3)> {
    let random = |stream| scattered(number, stream) * 2.0 - 1.0;
    let normal = DVec3::new(random(0), random(1), random(2)).try_normalize()?;
    let other = DVec3::new(random(3), random(4), random(5));
    Some((normal, normal.cross(other).try_normalize()?))
}

/// Increment of the generator's state between two random numbers: 2⁶⁴ divided by the golden ratio.
pub const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Mixes any bits into pseudorandom ones.
///
/// Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
pub fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}

/// A number from 0 to below 1, from pseudorandom bits.
pub fn share(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}
