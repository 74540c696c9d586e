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
    /// Which slice of a member is in each box; only known in the nodes of a tree.
    slices: [u8; GROUP],
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
    /// Whether members have several boxes.
    pub is_sliced: bool,
    /// Half of the total surface area of all boxes when the tree was built.
    built_surface: f64,
}

impl Node {
    /// A node without boxes.
    pub fn empty() -> Self {
        Self {
            planes: [[[f32::INFINITY; GROUP]; 3], [[-f32::INFINITY; GROUP]; 3]],
            children: [0; GROUP],
            slices: [0; GROUP],
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

    /// The members in the node's own boxes; those in several of them as often.
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

    /// A slice of a triangle as a member of a tree.
    pub fn of_slice(triangle: &PackedTriangle<f64>, slice: u8) -> Self {
        Self {
            bounds: triangle.slicing.tree_bounds(&triangle.corners, slice),
            thickness: triangle.thickness(),
        }
    }
}

impl<R: Real> Bvh<R> {
    /// Builds a tree over `count` members. They are queried by number instead of stored, since a million of them
    /// would take much memory twice.
    pub fn new(count: usize, member: impl Fn(usize) -> Member<R>) -> Self {
        Self::of_slices(
            count,
            |number| (number as u32, 0),
            |number, _| member(number),
        )
    }

    /// Builds a tree over `count` slices of members. `slice` returns the number of the member and that of its slice,
    /// `member` that slice as an entry of the tree.
    pub fn of_slices(
        count: usize,
        slice: impl Fn(usize) -> (u32, u8),
        member: impl Fn(usize, u8) -> Member<R>,
    ) -> Self {
        // Single precision is enough to decide the grouping.
        let point = |v: Vec3<R>| Vec3A::from(v.to_dvec3().as_vec3());
        let bounds = (0..count).map(|entry| {
            let (number, slice) = slice(entry);
            member(number as usize, slice).bounds
        });
        let boxes = bounds.map(|bounds| Aabb::new(point(bounds.low), point(bounds.high)));
        let node = |WideNode { children, count }| {
            let mut node = Node {
                count,
                ..Node::empty()
            };
            for (index, child) in children[..count].iter().enumerate() {
                (node.children[index], node.slices[index]) = match *child {
                    Child::Node(node) => (node | IS_NODE, 0),
                    Child::Member(entry) => slice(entry as usize),
                };
            }
            node
        };
        let boxes: Vec<_> = boxes.collect();
        let groups = group_boxes(&boxes);
        drop(boxes);
        let nodes = groups.into_iter().map(node).collect();
        let mut bvh = Self {
            is_sliced: (0..count).any(|entry| slice(entry).1 > 0),
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
        bvh.refit(|number, _| member(number));
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

    /// Renumbers the `count` members in the order in which nodes hold them first, so that those of a node are mostly
    /// consecutive. Returns the old numbers in the new order.
    pub fn renumber(&mut self, count: usize) -> Vec<u32> {
        let (mut old, mut new) = (Vec::with_capacity(count), vec![u32::MAX; count]);
        for node in Arc::make_mut(&mut self.nodes) {
            for entry in &mut node.children[..node.count] {
                if *entry & IS_NODE == 0 {
                    let number = &mut new[*entry as usize];
                    // The other slices of a member have the number of the first one.
                    if *number == u32::MAX {
                        *number = old.len() as u32;
                        old.push(*entry);
                    }
                    *entry = *number;
                }
            }
        }
        old
    }

    /// Fits the boxes to members that have moved.
    pub fn refit(&mut self, member: impl Fn(usize, u8) -> Member<R>) {
        let nodes = Arc::make_mut(&mut self.nodes);
        // A node comes before its child nodes.
        for index in (0..nodes.len()).rev() {
            for slot in 0..nodes[index].count {
                let fitted = match nodes[index].child(slot) {
                    Child::Member(number) => member(number as usize, nodes[index].slices[slot]),
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
        Bvh {
            nodes: Arc::clone(&self.nodes),
            bounds: self.bounds.in_precision(),
            thinnest: S::from_f64(self.thinnest.to_f64()),
            is_sliced: self.is_sliced,
            built_surface: self.built_surface,
        }
    }

    /// The members for whose boxes, and all boxes around these, a condition holds; in any order, and once for each
    /// box.
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
mod tests;
