//! Where rounding may decide whether a triangle is hit.

use super::packed::PackedTriangle;
use super::watertight::{Shear, edges_of};
use crate::primitive::blur::Blur;
use crate::primitive::ray::Ray;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Largest change of an edge function when the ray is displaced, as a multiple of the displacement, the longest
/// edge and the factor by which the shear stretches areas (one over the direction's component along its axis): 1 if
/// all corners move together, and half as much again because corners are rounded separately, by at most half of
/// that blur.
const STEEPNESS: f64 = 1.5;

/// The watertight test, with the distance from which on its result is undecided: where some edge function may have
/// either sign and the others do not rule out a hit, and where the triangle is hit at the very start. Returns
/// `None` if no wanted ray hits it.
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
    // Rays to a light converge there, so they are farther off where the triangle begins.
    let width = blur.around((a[2] * shear.z).abs(), longest);
    let bound = width * longest * shear.z.abs() * u.like_f64(STEEPNESS);
    let (low, high) = (u.min(v).min(w), u.max(v).max(w));
    let is_surely_missed = low.less(-bound) & bound.less(high);
    let (zero, infinity) = (u.like(L::Real::ZERO), u.like(L::Real::INFINITY));
    if !(wanted & !is_surely_missed).any() {
        return None;
    }
    let is_surely_hit = bound.less(low) | high.less(-bound);
    // By the plane: weights of corners far apart, as a narrow triangle has them, amplify the rounding of its edges.
    let normal = ray.origin.like(triangle.normal);
    let height = normal.dot(ray.origin.like(triangle.corners[0]) - ray.origin);
    let t = height / normal.dot(ray.direction);
    let inside = zero.at_most(low) | high.at_most(zero);
    let distance = L::select(inside & zero.less(t), t, infinity);
    // For rays that run along the triangle, a small height is decisive over a long distance.
    let starts_on_it = is_surely_hit & height.abs().at_most(blur.at(longest));
    let start_doubt = L::select(starts_on_it, zero, infinity);
    let passes_edge = wanted & !is_surely_missed & !is_surely_hit;
    if !passes_edge.any() {
        return Some((distance, start_doubt));
    }
    // The edges of a narrow triangle are uncertain far beyond its corners: only rays through a box count that a tree
    // has for it, so that what is in doubt does not depend on the boxes that other rays meet.
    let entry = triangle.slicing.entry(&triangle.corners, ray, width);
    Some((
        distance,
        L::select(passes_edge, entry.min(start_doubt), start_doubt),
    ))
}
