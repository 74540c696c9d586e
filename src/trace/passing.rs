//! Which rays pass a box closely by themselves.

use super::bundle::Bundle;
use super::thin_margin::ThinMargin;
use crate::plan::Node;
use crate::primitive::BoundingBox;
use crate::simd::{Real, SimdFloat};

/// Returns which rays by themselves pass the box at `index` of a node closely enough for something thin in it to
/// count, whatever other rays are in the packet.
#[inline(always)]
pub fn lanes_passing_box<L: SimdFloat>(
    bundle: &Bundle<L>,
    (node, index): (&Node, usize),
    reach: L,
    margin: &ThinMargin<L>,
) -> L::Mask {
    let bounds = node.bounds(index);
    let width = own_width_around(bundle, &bounds, margin);
    let mut near = reach.like(L::Real::ZERO);
    let mut far = reach + width * (margin.max_thickness + reach.like(L::Real::ONE));
    let inverse = bundle.inverse.to_array();
    for ([low, high, below, above], inverse) in along_axes(bundle, &bounds).into_iter().zip(inverse)
    {
        let (low, high) = (low - width, high + width);
        let (low, high) = ((low - above) * inverse, (high - below) * inverse);
        near = near.max(low.min(high));
        far = far.min(low.max(high));
    }
    let thickness = reach.like(L::Real::from_single(node.thickness[index]));
    let is_thin = thickness.less(width * margin.max_thickness);
    is_thin & near.at_most(far) & bundle.active
}

/// Returns upper bounds of the width of a pixel of each ray at a box.
#[inline(always)]
pub fn own_width_around<L: SimdFloat>(
    bundle: &Bundle<L>,
    bounds: &BoundingBox<L::Real>,
    margin: &ThinMargin<L>,
) -> L {
    let zero = bundle.inverse.x.like(L::Real::ZERO);
    let (mut farthest, mut nearest) = (zero, zero);
    for [low, high, below, above] in along_axes(bundle, bounds) {
        farthest = farthest + (high - below).max(above - low).max(zero);
        nearest = nearest.max((low - above).max(below - high));
    }
    margin.own_width(farthest, nearest)
}

/// For each axis, the two planes of a box and the intervals in which the rays start.
#[inline(always)]
fn along_axes<L: SimdFloat>(bundle: &Bundle<L>, bounds: &BoundingBox<L::Real>) -> [[L; 4]; 3] {
    let [below, above] = bundle.origins;
    let (low, high) = (below.like(bounds.low), below.like(bounds.high));
    [
        [low.x, high.x, below.x, above.x],
        [low.y, high.y, below.y, above.y],
        [low.z, high.z, below.z, above.z],
    ]
}
