//! Tests of oriented boxes: most rays through the axis-aligned box of a rod are far from the rod.

use crate::plan::OrientedBox;
use crate::primitive::{Ray, inverse, roundings};
use crate::simd::{Real, SimdFloat, Vec3};

/// Roundings of a change of axes, up to the far end of a box, in units of those of a primitive's test; fewer than this.
const ROUNDINGS_OF_AXES: f64 = 4.0;
/// How much wider a margin along every axis is along other axes, rounded up from √3.
const WIDER_ALONG_OTHERS: f64 = 2.0;

/// Returns which rays may meet an oriented box, or pass within `width` of it; `margin` is that of their origins, see
/// [`super::bundle::Bundle::margin`]. Slabs as in [`super::bundle::Bundle::lanes_meeting_box`], along other axes.
#[inline(always)]
pub fn lanes_meeting_oriented_box<L: SimdFloat>(
    rays: &Ray<L>,
    margin: L,
    oriented: &OrientedBox<L::Real>,
    width: L,
) -> L::Mask {
    let [a, b, c] = oriented.axes;
    let direction = rays.direction;
    let along = Vec3::new(
        direction.dot(direction.like(a)),
        direction.dot(direction.like(b)),
        direction.dot(direction.like(c)),
    );
    let inverse = inverse(along).to_array();
    let origin = rays.origin - rays.origin.like(oriented.centre);
    let reach = oriented.centre.length() + oriented.half[0];
    let size = rays.origin.max_abs() + margin.like(reach);
    let roundings_of_axes = roundings::<L::Real>() * L::Real::from_f64(ROUNDINGS_OF_AXES);
    let slack =
        margin * margin.like_f64(WIDER_ALONG_OTHERS) + size * margin.like(roundings_of_axes);
    let mut near = margin.like(L::Real::ZERO);
    let mut far = margin.like(L::Real::INFINITY);
    for ((axis, half), inverse) in oriented.axes.iter().zip(oriented.half).zip(inverse) {
        let start = origin.dot(origin.like(*axis));
        let half = slack + margin.like(half) + width;
        let (low, high) = ((-half - start) * inverse, (half - start) * inverse);
        near = near.max(low.min(high));
        far = far.min(low.max(high));
    }
    near.at_most(far * margin.like(L::Real::ONE + roundings::<L::Real>()))
}
