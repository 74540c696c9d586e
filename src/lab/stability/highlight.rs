//! Highlights of increasing sharpness.

use super::map::{Axis, Map, Tries, normal_and_perpendicular, scattered};
use super::subject::MapSubject;
use crate::plan::exponent;
use crate::scene::HighlightMethod;
use crate::simd::Vec3;

const EXPONENTS: [f64; 7] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
/// Tries per cell for a first look.
const TRIES: u64 = 400;
/// Allowed error of a highlight, whose maximum is 1: half a level of 255.
const HALF_LEVEL: f64 = 0.5 / 255.0;

/// One map per method. A failure is an error of more than half a level.
pub fn maps(effort: u32) -> Vec<Map> {
    Map::of_methods(
        (
            MapSubject::Highlight,
            "off by more than half a level of 255",
        ),
        (Axis::new("exponent", &EXPONENTS), Axis::one("highlight")),
        |method, p, _| {
            let tries = (0..TRIES * u64::from(effort)).filter_map(|n| fails(method, n, p));
            Tries::count(tries)
        },
    )
}

fn fails(method: HighlightMethod, number: u64, p: f64) -> Option<bool> {
    let exponent = exponent(method, p);
    let (normal, perpendicular) = normal_and_perpendicular(number)?;
    // Within the highlight: where it has fallen to no less than e^-3.
    let offset = (6.0 / p).sqrt().min(1.0) * scattered(number, 6);
    let half = normal + perpendicular * offset;
    let (normal, half) = (
        Vec3::<f32>::from_dvec3(normal),
        Vec3::<f32>::from_dvec3(half),
    );
    let found = f64::from(exponent.highlight(normal, half));
    // The true value for the rounded vectors, normalised exactly.
    let (n, h) = (
        normal.to_dvec3().try_normalize()?,
        half.to_dvec3().try_normalize()?,
    );
    let w = (n - h).dot(n - h) / 2.0;
    let truth = if n.dot(h) > 0.0 {
        (p * (-w).ln_1p()).exp()
    } else {
        0.0
    };
    Some((found - truth).abs() > HALF_LEVEL)
}
