//! Traversal of a tree of boxes by a packet, nearest boxes first.

use super::bundle::Bundle;
use super::passing::lanes_passing_box;
use super::thin_margin::ThinMargin;
use super::thresholds::MERGED_SIZE;
use crate::plan::{Bvh, Child, GROUP, Node};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// A box that waits to be looked into.
#[derive(Clone, Copy, Debug)]
pub struct StackEntry<R> {
    /// The node that it is in, and its index there.
    node: u32,
    slot: u32,
    /// The node that it holds.
    inner: u32,
    /// The rays that have treated a box around it as one thing, bit by bit.
    merged_lanes: u64,
    /// Distance at which the first ray may enter it.
    near: R,
}

/// Boxes that wait, the nearest last; the memory is reused.
pub type Stack<R> = Vec<StackEntry<R>>;

/// Looks for something among the members of a tree.
pub trait TreeVisitor<L: SimdFloat> {
    /// Returns how far each ray still looks; below 0 where it does not.
    fn reach(&self) -> L;
    /// Returns whether nothing is to be found in a child.
    fn is_culled(&self, _child: Child) -> bool {
        false
    }
    /// Visits a member; `width` is the largest width of a pixel there, if things beside the rays are looked for.
    fn visit_member(&mut self, member: u32, width: L::Real, stack: &mut Stack<L::Real>);
    /// Returns whether a member has several boxes in the tree.
    fn is_sliced(&self, _member: u32) -> bool {
        false
    }
    /// Visits a member in one of its boxes for the rays that pass that box closely. The other rays pass it in another
    /// of its boxes, which they may see as one thing with what else is there.
    fn visit_slice(&mut self, _member: u32, _passing: impl FnOnce() -> L::Mask) {}
    /// Visits a box for the rays that see its contents as one thing, given the ball around it and the thickness of
    /// its contents; it counts for those that pass it closely. Returns the first and those that are not active, bit
    /// by bit.
    fn visit_merged_box(
        &mut self,
        _ball: (Vec3<L::Real>, L::Real),
        _thickness: L::Real,
        _passing: impl FnOnce() -> L::Mask,
    ) -> u64 {
        0
    }
    /// The margin of each ray by itself, if things beside the rays are looked for.
    fn own_margin(&self) -> ThinMargin<L>;
    /// Sets the rays, bit by bit, that are excluded from everything that is visited from now on.
    fn exclude_lanes(&mut self, _merged_lanes: u64) {}
}

/// Returns up to how many of the rays of a packet are tested one by one if only these still look into a box: what
/// they have in common with all others meets more boxes. One ray takes no longer than all together; of sixteen, two
/// are the best of 1, 2, 3 and 5 for balls and meshes in their thousands: 0.75 to 0.8 of the time without.
const fn max_single_rays(lanes: usize) -> u32 {
    match lanes {
        1 => 0,
        2..16 => 1,
        _ => 2,
    }
}

/// The number that stands for the node in which a traversal starts, which need not be the root of the tree.
const START_NODE: u32 = u32::MAX;

/// Visits the members that the rays may hit, from a node on.
#[inline(always)]
pub fn walk<L: SimdFloat>(
    (bvh, start): (&Bvh<L::Real>, &Node),
    bundle: &Bundle<L>,
    stack: &mut Stack<L::Real>,
    visitor: &mut impl TreeVisitor<L>,
) {
    let bottom = stack.len();
    let (mut index, mut node) = (START_NODE, start);
    // The rays that hit the box around the node, bit by bit.
    let mut lanes = bundle.active.bits();
    loop {
        let mut nears = [L::Real::ZERO; GROUP];
        let reach = visitor.reach();
        let mut bits = if lanes.count_ones() <= max_single_rays(L::WIDTH) {
            bundle.boxes_met_by_lanes(lanes, node, reach, &mut nears)
        } else {
            let shaft = bundle.shaft();
            shaft.meets::<L>(reach.token(), node, reach.greatest(), &mut nears)
        };
        let first_new = stack.len();
        while bits != 0 {
            let slot = bits.trailing_zeros();
            bits &= bits - 1;
            let child = node.child(slot as usize);
            if visitor.is_culled(child) {
                continue;
            }
            match child {
                Child::Member(member) => visitor.visit_member(member, L::Real::ZERO, stack),
                Child::Node(inner) => {
                    let near = nears[slot as usize];
                    let entry = StackEntry {
                        node: index,
                        slot,
                        inner,
                        merged_lanes: 0,
                        near,
                    };
                    // Sorted by insertion: there are few.
                    let mut at = stack.len();
                    stack.push(entry);
                    while at > first_new && stack[at - 1].near < near {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = entry;
                }
            }
        }
        let reach = visitor.reach();
        let farthest = reach.greatest();
        index = loop {
            if stack.len() == bottom {
                return;
            }
            let Some(next) = stack.pop() else { return };
            let parent = match next.node {
                START_NODE => start,
                inner => &bvh.nodes[inner as usize],
            };
            let slot = next.slot as usize;
            if next.near <= farthest {
                let no_margin = L::Real::ZERO;
                lanes = bundle
                    .lanes_meeting_box(parent, slot, reach, no_margin)
                    .bits();
                if lanes != 0 {
                    break next.inner;
                }
            }
        };
        node = &bvh.nodes[index as usize];
    }
}

/// Visits the thin members that the rays may come close to; the rays in `merged_lanes` (bit by bit) do not count from
/// the start. What a ray is shown does not depend on the others of its packet.
#[inline(always)]
pub fn walk_thin<L: SimdFloat>(
    bvh: &Bvh<L::Real>,
    bundle: &Bundle<L>,
    margin: &ThinMargin<L::Real>,
    (stack, merged_lanes): (&mut Stack<L::Real>, u64),
    visitor: &mut impl TreeVisitor<L>,
) {
    let all = (1_u64 << L::WIDTH) - 1;
    let mut merged_lanes = merged_lanes;
    let bottom = stack.len();
    let reach = visitor.reach();
    let (token, farthest, shaft) = (reach.token(), reach.greatest(), bundle.shaft());
    let own_margin = visitor.own_margin();
    let mut index = 0;
    while let Some(node) = bvh.nodes.get(index as usize) {
        let mut widths = [L::Real::ZERO; GROUP];
        let mut bits = shaft.meets_thin::<L>(token, node, farthest, margin, &mut widths);
        visitor.exclude_lanes(merged_lanes);
        while bits != 0 {
            let slot = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let width = widths[slot];
            let end = margin.end(reach, reach.like(width));
            if !bundle.lanes_meeting_box(node, slot, end, width).any() {
                continue;
            }
            match node.child(slot) {
                Child::Member(member) if bvh.is_sliced && visitor.is_sliced(member) => {
                    visitor.visit_slice(
                        member,
                        #[inline(always)]
                        || lanes_passing_box(bundle, (node, slot), reach, &own_margin),
                    );
                }
                Child::Member(member) => visitor.visit_member(member, width, stack),
                Child::Node(inner) => {
                    let mut merged_lanes = merged_lanes;
                    let ball = node.bounds(slot).ball();
                    if ball.1 + ball.1 < width * L::Real::from_f64(MERGED_SIZE) {
                        let thickness = L::Real::from_single(node.thickness[slot]);
                        merged_lanes |= visitor.visit_merged_box(
                            ball,
                            thickness,
                            #[inline(always)]
                            || lanes_passing_box(bundle, (node, slot), reach, &own_margin),
                        );
                    }
                    if merged_lanes & all != all {
                        stack.push(StackEntry {
                            node: index,
                            slot: slot as u32,
                            inner,
                            merged_lanes,
                            near: L::Real::ZERO,
                        });
                    }
                }
            }
        }
        if stack.len() == bottom {
            return;
        }
        let Some(next) = stack.pop() else { return };
        (index, merged_lanes) = (next.inner, next.merged_lanes);
    }
}
