//! Which rays pass a box closely by themselves.

use super::bundle::Bundle;
use super::thin_margin::ThinMargin;
use crate::plan::Node;
use crate::simd::{Real, SimdFloat};

/// Returns which rays by themselves pass the box at `index` of a node closely enough for something thin in it to
/// count, whatever other rays are in the packet.
#[inline(always)]
pub fn lanes_passing_box<L: SimdFloat>(
    bundle: &Bundle<L>,
    node: &Node,
    index: usize,
    reach: L,
    margin: &ThinMargin<L>,
) -> L::Mask {
    let zero = reach.like(L::Real::ZERO);
    let [below, above] = &bundle.origins;
    let origins = [
        (below.x, above.x, bundle.inverse.x),
        (below.y, above.y, bundle.inverse.y),
        (below.z, above.z, bundle.inverse.z),
    ];
    let (mut farthest, mut nearest) = (zero, zero);
    for (axis, (below, above, _)) in origins.into_iter().enumerate() {
        let low = reach.like(L::Real::from_single(node.planes[0][axis][index]));
        let high = reach.like(L::Real::from_single(node.planes[1][axis][index]));
        farthest = farthest + (high - below).max(above - low).max(zero);
        nearest = nearest.max((low - above).max(below - high));
    }
    let width = margin.own_width(farthest, nearest);
    let mut near = zero;
    let mut far = reach + width * (margin.max_thickness + reach.like(L::Real::ONE));
    for (axis, (below, above, inverse)) in origins.into_iter().enumerate() {
        let low = reach.like(L::Real::from_single(node.planes[0][axis][index]));
        let high = reach.like(L::Real::from_single(node.planes[1][axis][index]));
        let (low, high) = (low - width, high + width);
        let (low, high) = ((low - above) * inverse, (high - below) * inverse);
        near = near.max(low.min(high));
        far = far.min(low.max(high));
    }
    let thickness = reach.like(L::Real::from_single(node.thickness[index]));
    let is_thin = thickness.less(width * margin.max_thickness);
    is_thin & near.at_most(far) & bundle.active
}
