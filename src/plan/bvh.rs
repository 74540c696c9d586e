//! A bounding volume hierarchy with sixteen boxes per node, for scenes of many things.
//!
//! All boxes of a node are tested in step against a packet of rays, so a node is as wide as the widest packet.

use std::sync::Arc;

use glam::Vec3A;
use obvhs::aabb::Aabb;

pub use super::grouping::{Child, GROUP};
use super::grouping::{WideNode, group_boxes};
use crate::primitive::{BoundingBox, PackedTriangle, Primitive as _};
use crate::simd::{Real, Vec3};

/// A node: up to [`GROUP`] boxes, one array per component, each of which fills a cache line. Single precision is
/// enough for boxes: for a million faces it takes 40 MB less than double precision, and each traversal reads half
/// of the memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct Node {
    /// The low x, y and z of each box, then the high ones: rounded outwards.
    pub planes: [[[f32; GROUP]; 3]; 2],
    /// The content of each box: the number of a member, or that of a node with the bit [`IS_NODE`] set.
    children: [u32; GROUP],
    /// The smallest thickness in each box, see [`crate::primitive::Primitive::thickness`]; rounded down.
    pub thickness: [f32; GROUP],
    /// The number of boxes.
    pub count: usize,
}

/// Factor by which the surface area of a refitted tree may grow before the tree is built anew.
const MAX_SURFACE_GROWTH: f64 = 1.2;
/// The bit that distinguishes nodes from members.
const IS_NODE: u32 = 1 << 31;

/// An entry of a tree.
#[derive(Clone, Copy, Debug)]
pub struct Member<R> {
    /// Its bounding box.
    pub bounds: BoundingBox<R>,
    /// Its thickness.
    pub thickness: R,
}

/// A bounding volume hierarchy with its root first; it has no nodes if there are no members.
#[derive(Clone, Debug)]
pub struct Bvh<R> {
    /// The nodes, each before its child nodes; trees of both precisions may share them.
    pub nodes: Arc<[Node]>,
    /// The box around all members.
    pub bounds: BoundingBox<R>,
    /// The smallest thickness of any member.
    pub thinnest: R,
    /// Half of the total surface area of all boxes when the tree was built.
    built_surface: f64,
}

impl Node {
    /// A node without boxes.
    pub fn empty() -> Self {
        Self {
            planes: [[[f32::INFINITY; GROUP]; 3], [[-f32::INFINITY; GROUP]; 3]],
            children: [0; GROUP],
            thickness: [f32::INFINITY; GROUP],
            count: 0,
        }
    }

    /// A mask with a bit set for each box.
    pub fn filled(&self) -> u64 {
        (1 << self.count) - 1
    }

    /// The box at `index`.
    #[inline(always)]
    pub fn bounds<R: Real>(&self, index: usize) -> BoundingBox<R> {
        let corner = |planes: &[[f32; GROUP]; 3]| {
            let [x, y, z] = planes;
            Vec3::new(x[index], y[index], z[index]).map(R::from_single)
        };
        BoundingBox {
            low: corner(&self.planes[0]),
            high: corner(&self.planes[1]),
        }
    }

    /// The content of the box at `index`.
    #[inline(always)]
    pub fn child(&self, index: usize) -> Child {
        let entry = self.children[index];
        if entry & IS_NODE == 0 {
            Child::Member(entry)
        } else {
            Child::Node(entry & !IS_NODE)
        }
    }

    /// The members in the node's own boxes.
    pub fn members(&self) -> impl Iterator<Item = u32> {
        let entries = self.children[..self.count].iter().copied();
        entries.filter(|entry| entry & IS_NODE == 0)
    }

    /// Appends a box of another node; there must be fewer than [`GROUP`].
    #[inline(always)]
    pub fn take(&mut self, from: &Self, index: usize) {
        for (planes, others) in self.planes.iter_mut().zip(&from.planes) {
            for (plane, other) in planes.iter_mut().zip(others) {
                plane[self.count] = other[index];
            }
        }
        self.thickness[self.count] = from.thickness[index];
        self.children[self.count] = from.children[index];
        self.count += 1;
    }

    /// Removes a box; the last one takes its place.
    #[inline(always)]
    pub fn remove(&mut self, index: usize) {
        let last = self.count - 1;
        for plane in self.planes.iter_mut().flatten() {
            plane[index] = plane[last];
        }
        self.thickness[index] = self.thickness[last];
        self.children[index] = self.children[last];
        self.count = last;
    }

    fn set<R: Real>(&mut self, index: usize, member: &Member<R>) {
        let BoundingBox { low, high } = member.bounds;
        let low = low.to_array().map(below);
        let high = high.to_array().map(|high| -below(-high));
        for (planes, corner) in self.planes.iter_mut().zip([low, high]) {
            for (plane, coordinate) in planes.iter_mut().zip(corner) {
                plane[index] = coordinate;
            }
        }
        self.thickness[index] = below(member.thickness);
    }

    /// The box at `index` as a member.
    fn get<R: Real>(&self, index: usize) -> Member<R> {
        Member {
            bounds: self.bounds(index),
            thickness: R::from_single(self.thickness[index]),
        }
    }

    /// The union of all boxes.
    fn around<R: Real>(&self) -> Member<R> {
        (0..self.count).fold(Member::nothing(), |around, index| {
            around.union(&self.get(index))
        })
    }
}

impl<R: Real> Member<R> {
    fn nothing() -> Self {
        Self {
            bounds: BoundingBox::nothing(),
            thickness: R::INFINITY,
        }
    }

    fn union(&self, other: &Self) -> Self {
        Self {
            bounds: self.bounds.union(&other.bounds),
            thickness: self.thickness.min(other.thickness),
        }
    }
}

impl Member<f64> {
    /// A triangle as a member of a tree.
    pub fn of(triangle: &PackedTriangle<f64>) -> Self {
        Self {
            bounds: BoundingBox::around(&triangle.corners),
            thickness: triangle.thickness(),
        }
    }
}

impl<R: Real> Bvh<R> {
    /// Builds a tree over `count` members. They are queried by number instead of stored, since a million of them
    /// would take much memory twice.
    pub fn new(count: usize, member: impl Fn(usize) -> Member<R>) -> Self {
        // Single precision is enough to decide the grouping.
        let point = |v: Vec3<R>| Vec3A::from(v.to_dvec3().as_vec3());
        let bounds = (0..count).map(|number| member(number).bounds);
        let boxes = bounds.map(|bounds| Aabb::new(point(bounds.low), point(bounds.high)));
        let bits = |child| match child {
            Child::Member(member) => member,
            Child::Node(node) => node | IS_NODE,
        };
        let node = |WideNode { children, count }| Node {
            children: children.map(bits),
            count,
            ..Node::empty()
        };
        let boxes: Vec<_> = boxes.collect();
        let groups = group_boxes(&boxes);
        drop(boxes);
        let nodes = groups.into_iter().map(node).collect();
        let mut bvh = Self {
            nodes,
            bounds: BoundingBox::nothing(),
            thinnest: R::INFINITY,
            built_surface: 0.0,
        };
        bvh.refit(member);
        bvh.built_surface = bvh.surface();
        bvh
    }

    /// Returns the same tree refitted to moved members; `None` if its boxes have grown so large that a new tree is
    /// better.
    pub fn refitted(&self, member: impl Fn(usize) -> Member<R>) -> Option<Self> {
        let mut bvh = self.clone();
        bvh.refit(member);
        (bvh.surface() <= self.built_surface * MAX_SURFACE_GROWTH).then_some(bvh)
    }

    /// Half of the total surface area of all boxes, to which the number of boxes that a random ray hits is
    /// proportional.
    fn surface(&self) -> f64 {
        let half_surface = |bounds: BoundingBox<R>| {
            let size = (bounds.high - bounds.low).to_dvec3();
            size.x * size.y + size.y * size.z + size.z * size.x
        };
        let nodes = self.nodes.iter();
        let boxes = nodes.flat_map(|node| (0..node.count).map(|index| node.bounds(index)));
        boxes.map(half_surface).sum()
    }

    /// Renumbers the members so that those of a node are consecutive. Returns the old numbers in the new order.
    pub fn renumber(&mut self) -> Vec<u32> {
        let mut old = Vec::new();
        for node in Arc::make_mut(&mut self.nodes) {
            for entry in &mut node.children[..node.count] {
                if *entry & IS_NODE == 0 {
                    old.push(std::mem::replace(entry, old.len() as u32));
                }
            }
        }
        old
    }

    /// Fits the boxes to members that have moved.
    pub fn refit(&mut self, member: impl Fn(usize) -> Member<R>) {
        let nodes = Arc::make_mut(&mut self.nodes);
        // A node comes before its child nodes.
        for index in (0..nodes.len()).rev() {
            for slot in 0..nodes[index].count {
                let fitted = match nodes[index].child(slot) {
                    Child::Member(number) => member(number as usize),
                    Child::Node(node) => nodes[node as usize].around(),
                };
                nodes[index].set(slot, &fitted);
            }
        }
        let all = self.nodes.first().map_or(Member::nothing(), Node::around);
        (self.bounds, self.thinnest) = (all.bounds, all.thickness);
    }

    /// Returns the same tree in another precision, around the same members rounded to it: a member inside a box of
    /// single precision stays inside when it is rounded.
    pub fn in_precision<S: Real>(&self) -> Bvh<S> {
        let BoundingBox { low, high } = self.bounds;
        Bvh {
            nodes: Arc::clone(&self.nodes),
            bounds: BoundingBox {
                low: low.in_precision(),
                high: high.in_precision(),
            },
            thinnest: S::from_f64(self.thinnest.to_f64()),
            built_surface: self.built_surface,
        }
    }

    /// The members for whose boxes, and all boxes around these, a condition holds; in any order.
    pub fn members_where(&self, mut holds: impl FnMut(&BoundingBox<R>) -> bool) -> Vec<u32> {
        let (mut members, mut waiting) = (Vec::new(), vec![0_u32]);
        while let Some(node) = waiting.pop().and_then(|node| self.nodes.get(node as usize)) {
            for index in (0..node.count).filter(|&index| holds(&node.bounds(index))) {
                match node.child(index) {
                    Child::Member(member) => members.push(member),
                    Child::Node(inner) => waiting.push(inner),
                }
            }
        }
        members
    }

    /// The boxes of the root.
    pub fn outline(&self) -> impl Iterator<Item = BoundingBox<R>> {
        let root = self.nodes.first();
        root.into_iter()
            .flat_map(|root| (0..root.count).map(|index| root.bounds(index)))
    }
}

/// The largest single-precision number that is not above `number`.
fn below<R: Real>(number: R) -> f32 {
    let number = number.to_f64();
    let nearest = number as f32;
    if f64::from(nearest) > number {
        nearest.next_down()
    } else {
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::super::grouping::MAX_DEPTH;
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-50.0..50.0_f64).prop_map(DVec3::from)
    }

    fn member((center, reach): (DVec3, f64)) -> Member<f64> {
        Member {
            bounds: BoundingBox {
                low: Vec3::from_dvec3(center - reach),
                high: Vec3::from_dvec3(center + reach),
            },
            thickness: reach,
        }
    }

    fn tree(members: &[Member<f64>]) -> Bvh<f64> {
        Bvh::new(members.len(), |n| members[n])
    }

    fn holds(outer: &BoundingBox<f64>, inner: &BoundingBox<f64>) -> bool {
        outer.union(inner) == *outer
    }

    #[test]
    fn numbers_are_rounded_down_by_less_than_a_digit() {
        for number in [0.1, 1e12 / 3.0, 1e300, 1e-45, 1e-300, 0.0, 16_777_217.0] {
            for number in [number, -number] {
                let found = below(number);
                assert!(f64::from(found) <= number, "{found} {number}");
                assert!(f64::from(found.next_up()) > number, "{found} {number}");
            }
        }
    }

    /// Returns whether a box is no larger than rounding to single precision requires.
    fn is_near(outer: &BoundingBox<f64>, inner: &BoundingBox<f64>) -> bool {
        let off = (outer.low - inner.low)
            .max_abs()
            .max((outer.high - inner.high).max_abs());
        off <= 100.0 * f64::from(f32::EPSILON)
    }

    /// Returns whether every member is held once, and contained in all boxes above it.
    fn is_whole(bvh: &Bvh<f64>, members: &[Member<f64>]) -> bool {
        let mut found = vec![0; members.len()];
        let mut waiting: Vec<(u32, BoundingBox<f64>, usize)> = vec![(0, bvh.bounds, 1)];
        while let Some((index, around, depth)) = waiting.pop() {
            let node = &bvh.nodes[index as usize];
            for slot in 0..node.count {
                let fitted = node.get(slot);
                if depth > MAX_DEPTH || !holds(&around, &fitted.bounds) {
                    return false;
                }
                match node.child(slot) {
                    Child::Node(node) => waiting.push((node, fitted.bounds, depth + 1)),
                    Child::Member(member) => {
                        found[member as usize] += 1;
                        let own = &members[member as usize].bounds;
                        if !holds(&fitted.bounds, own) || !is_near(&fitted.bounds, own) {
                            return false;
                        }
                    }
                }
            }
        }
        found.iter().all(|&times| times == 1)
    }

    proptest! {
        #[test]
        fn every_member_is_held_by_all_boxes_above_it(places in prop::collection::vec((vector(), 0.0..5.0_f64), 1..700)) {
            let mut members: Vec<_> = places.into_iter().map(member).collect();
            let mut bvh = tree(&members);
            prop_assert!(is_whole(&bvh, &members));
            let thinnest = members.iter().map(|member| member.thickness).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(bvh.thinnest, f64::from(below(thinnest)));
            for moved in &mut members {
                moved.bounds.high = moved.bounds.high + Vec3::new(1.0, 2.0, 0.0);
            }
            bvh.refit(|n| members[n]);
            prop_assert!(is_whole(&bvh, &members));
        }
    }

    #[test]
    fn a_tree_is_kept_while_little_moves() {
        let place = |at: usize| DVec3::new((at % 32) as f64, (at / 32) as f64, 0.0) * 10.0;
        let mut members: Vec<_> = (0..1000).map(|at| member((place(at), 1.0))).collect();
        let bvh = tree(&members);
        members[17] = member((place(40), 1.0));
        let moved = bvh.refitted(|n| members[n]).expect("hardly larger");
        assert!(is_whole(&moved, &members));
        let scattered: Vec<_> = (0..1000)
            .map(|at| member((place(at * 367 % 1000), 1.0)))
            .collect();
        assert!(moved.refitted(|n| scattered[n]).is_none());
    }

    #[test]
    fn a_thousand_members_in_one_place_are_found() {
        let members = vec![member((DVec3::ONE, 1.0)); 1000];
        assert!(is_whole(&tree(&members), &members));
        // Each box contains the previous one: a chain of pairs.
        let nested: Vec<_> = (0..2000)
            .map(|at| member((DVec3::ZERO, f64::from(at))))
            .collect();
        assert!(is_whole(&tree(&nested), &nested));
    }

    #[test]
    fn nodes_are_well_filled() {
        let grid = (0..4096).map(|at| {
            let (x, y) = (f64::from(at % 64), f64::from(at / 64));
            member((DVec3::new(x, y, 0.0), 0.5))
        });
        let bvh = tree(&grid.collect::<Vec<_>>());
        assert!(bvh.nodes.len() < 4096 / 8, "{} nodes", bvh.nodes.len());
    }
}
