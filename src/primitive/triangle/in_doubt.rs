//! Where rounding may decide whether a triangle is met.

use super::packed::PackedTriangle;
use super::watertight::{Shear, edges_of};
use crate::primitive::blur::Blur;
use crate::primitive::bounding_box::BoundingBox;
use crate::primitive::ray::Ray;
use crate::simd::{Mask as _, Real, SimdFloat};

/// How much an edge function changes at most where the ray is moved aside, as a multiple of how far, of the longest edge
/// and of how much the shear stretches areas, which is one over the direction along its axis: once where its corners move
/// as one, and half as much again since they are rounded one by one, by no more than half of that blur.
const STEEPNESS: f64 = 1.5;

/// The watertight test, and from where on its answer is undecided: where some edge function may have either sign and
/// the others do not say that the triangle is missed, and where it is met at the very start. `None` if no ray that is
/// wanted meets it.
#[inline(always)]
pub fn watertight_in_doubt<L: SimdFloat>(
    ray: &Ray<L>,
    shear: &Shear<L>,
    triangle: &PackedTriangle<L::Real>,
    (blur, wanted): (&Blur<L>, L::Mask),
) -> Option<(L, L)> {
    let (corners, edges) = edges_of(ray, shear, triangle);
    let ([a, ..], [u, v, w]) = (corners, edges);
    let longest = u.like(triangle.longest);
    // Rays to a light come together there: they are farther off where the triangle begins.
    let width = blur.around((a[2] * shear.z).abs(), longest);
    let bound = width * longest * shear.z.abs() * u.like_f64(STEEPNESS);
    let (low, high) = (u.min(v).min(w), u.max(v).max(w));
    let is_missed = low.less(-bound) & bound.less(high);
    let (zero, infinity) = (u.like(L::Real::ZERO), u.like(L::Real::INFINITY));
    if !(wanted & !is_missed).any() {
        return None;
    }
    let is_met = bound.less(low) | high.less(-bound);
    let t = shear.distance(corners, edges);
    let inside = zero.at_most(low) | high.at_most(zero);
    let distance = L::select(inside & zero.less(t), t, infinity);
    // Of rays that run along it, a little height decides over a long way.
    let normal = ray.origin.like(triangle.normal);
    let height = t * normal.dot(ray.direction);
    let starts_on_it = is_met & height.abs().at_most(blur.at(longest));
    let from = L::select(starts_on_it, zero, infinity);
    let passes_edge = wanted & !is_missed & !is_met;
    if !passes_edge.any() {
        return Some((distance, from));
    }
    // A narrow one's edges are uncertain far beyond its corners: only rays count that pass the box around it.
    let around = BoundingBox::around(&triangle.corners);
    let entry = around.entry(ray, width);
    Some((distance, L::select(passes_edge, entry.min(from), from)))
}
