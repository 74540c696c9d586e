//! Boxes within boxes, sixteen in each: the way down to what a ray can meet among many things.
//!
//! A packet of rays is held against all boxes of a node in step, so that a node is as wide as the widest
//! packet.

use std::collections::VecDeque;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};

use crate::primitive::BoundingBox;
use crate::simd::{Real, Vec3};

/// How many boxes a node has.
pub const GROUP: usize = 16;
/// Most nodes on the way from the root to a member.
pub const DEEPEST: usize = 24;
/// Share of the boxes that are put elsewhere after the first pass, where that makes the tree better.
const REINSERTED: f32 = 0.02;

/// What a box of a node holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// The node of this index.
    Node(u32),
    /// The member of this number.
    Member(u32),
}

/// A node: up to [`GROUP`] boxes, component by component.
#[derive(Clone, Copy, Debug)]
pub struct Node<R> {
    /// The lowest x of each box, y, z; then the highest.
    pub planes: [[[R; GROUP]; 3]; 2],
    /// The smallest thickness of what is in each box, see [`crate::primitive::Primitive::thickness`].
    pub thickness: [R; GROUP],
    children: [Child; GROUP],
    /// How many boxes there are.
    pub count: usize,
}

/// What is to be found in a tree.
#[derive(Clone, Copy, Debug)]
pub struct Member<R> {
    /// The box around it.
    pub bounds: BoundingBox<R>,
    /// Its smallest measure.
    pub thickness: R,
}

/// A bounding volume hierarchy, the root first; no nodes where there are no members.
#[derive(Clone, Debug)]
pub struct Bvh<R> {
    /// The nodes, each before those in its boxes.
    pub nodes: Vec<Node<R>>,
    /// The box around everything.
    pub bounds: BoundingBox<R>,
    /// The smallest thickness of any member.
    pub thinnest: R,
}

impl<R: Real> Node<R> {
    /// No boxes.
    pub fn empty() -> Self {
        Self {
            planes: [[[R::INFINITY; GROUP]; 3], [[-R::INFINITY; GROUP]; 3]],
            thickness: [R::INFINITY; GROUP],
            children: [Child::Member(0); GROUP],
            count: 0,
        }
    }

    /// A bit for each box.
    pub fn filled(&self) -> u64 {
        (1 << self.count) - 1
    }

    /// What the box at `place` holds.
    pub fn child(&self, place: usize) -> Child {
        self.children[place]
    }

    /// Takes over a box of another node, behind its own, of which there are fewer than [`GROUP`].
    #[inline(always)]
    pub fn take(&mut self, from: &Self, place: usize) {
        for (planes, others) in self.planes.iter_mut().zip(&from.planes) {
            for (plane, other) in planes.iter_mut().zip(others) {
                plane[self.count] = other[place];
            }
        }
        self.thickness[self.count] = from.thickness[place];
        self.children[self.count] = from.children[place];
        self.count += 1;
    }

    /// Takes a box out; the last one comes into its place.
    #[inline(always)]
    pub fn remove(&mut self, place: usize) {
        let last = self.count - 1;
        for plane in self.planes.iter_mut().flatten() {
            plane[place] = plane[last];
        }
        self.thickness[place] = self.thickness[last];
        self.children[place] = self.children[last];
        self.count = last;
    }

    fn set(&mut self, place: usize, member: &Member<R>) {
        let Member { bounds, thickness } = member;
        for (planes, corner) in self.planes.iter_mut().zip([bounds.low, bounds.high]) {
            for (plane, coordinate) in planes.iter_mut().zip(corner.to_array()) {
                plane[place] = coordinate;
            }
        }
        self.thickness[place] = *thickness;
    }

    /// The box at `place` as if it were a member.
    fn get(&self, place: usize) -> Member<R> {
        let corner = |planes: &[[R; GROUP]; 3]| Vec3::from(planes.map(|plane| plane[place]));
        Member {
            bounds: BoundingBox {
                low: corner(&self.planes[0]),
                high: corner(&self.planes[1]),
            },
            thickness: self.thickness[place],
        }
    }

    /// All boxes together.
    fn around(&self) -> Member<R> {
        (0..self.count).fold(Member::nothing(), |around, place| {
            around.and(&self.get(place))
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

    fn and(&self, other: &Self) -> Self {
        Self {
            bounds: self.bounds.and(&other.bounds),
            thickness: self.thickness.min(other.thickness),
        }
    }
}

impl<R: Real> Bvh<R> {
    /// A tree of so many members, each given by its number: a million of them would take much room twice.
    pub fn new(count: usize, member: impl Fn(usize) -> Member<R>) -> Self {
        let mut nodes = Vec::new();
        if count > 0 {
            let pairs = build_pairs((0..count).map(&member));
            nodes = match widened(&pairs) {
                Some(nodes) => nodes,
                None => bundled(&pairs.primitive_indices),
            };
        }
        let mut bvh = Self {
            nodes,
            bounds: BoundingBox::nothing(),
            thinnest: R::INFINITY,
        };
        bvh.refit(member);
        bvh
    }

    /// Fits the boxes to the members, which have moved.
    pub fn refit(&mut self, member: impl Fn(usize) -> Member<R>) {
        // A node stands before those in its boxes.
        for index in (0..self.nodes.len()).rev() {
            for place in 0..self.nodes[index].count {
                let held = match self.nodes[index].child(place) {
                    Child::Member(number) => member(number as usize),
                    Child::Node(node) => self.nodes[node as usize].around(),
                };
                self.nodes[index].set(place, &held);
            }
        }
        let all = self.nodes.first().map_or(Member::nothing(), Node::around);
        (self.bounds, self.thinnest) = (all.bounds, all.thickness);
    }

    /// The boxes of the root.
    pub fn outline(&self) -> impl Iterator<Item = BoundingBox<R>> {
        let root = self.nodes.first();
        root.into_iter()
            .flat_map(|root| (0..root.count).map(|place| root.get(place).bounds))
    }
}

/// Boxes two by two: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume
/// Hierarchy Construction", TVCG 24(3), 2018, with some boxes put elsewhere afterwards.
fn build_pairs<R: Real>(members: impl Iterator<Item = Member<R>>) -> Bvh2 {
    // Single precision is enough to decide what goes with what.
    let point = |v: Vec3<R>| Vec3A::from(v.to_dvec3().as_vec3());
    let boxes: Vec<Aabb> = members
        .map(|member| Aabb::new(point(member.bounds.low), point(member.bounds.high)))
        .collect();
    let mut pairs = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Low,
        &boxes,
        (0..boxes.len() as u32).collect(),
        SortPrecision::U64,
        2,
    );
    drop(boxes);
    ReinsertionOptimizer::default().run(&mut pairs, REINSERTED, None);
    pairs
}

/// What becomes of a pair where its box may take up 1, 2, … [`GROUP`] places of a node: 0 if it is one box,
/// else how many of the places its first half takes. It has one box in one place; how its own node is shared
/// out stands there.
type Shares = [u8; GROUP];

/// The [`Shares`] of all pairs that have halves. Halves stand side by side behind the root: where they do says
/// whose they are.
struct AllShares(Vec<Shares>);

impl AllShares {
    fn of(&self, pairs: &Bvh2, pair: usize) -> &Shares {
        &self.0[pairs.nodes[pair].first_index as usize / 2]
    }
}

/// Shares out the places of nodes so that their boxes have the smallest surfaces together: what is met at
/// random is met in proportion to its surface. Ylitie, Karras and Laine, "Efficient incoherent ray traversal
/// on GPUs through compressed wide BVHs", HPG 2017, ch. 3; members cost the same wherever they are held.
fn shared_out(pairs: &Bvh2) -> AllShares {
    let mut shares = vec![[0; GROUP]; pairs.nodes.len().div_ceil(2)];
    let mut waiting = vec![(0, false)];
    // The surfaces of all nodes in a pair, by the places that it may take up.
    let mut surfaces: Vec<[f32; GROUP]> = Vec::new();
    while let Some((index, is_entered)) = waiting.pop() {
        let node = &pairs.nodes[index];
        let first = node.first_index as usize;
        if node.is_leaf() {
            surfaces.push([0.0; GROUP]);
        } else if !is_entered {
            waiting.extend([(index, true), (first + 1, false), (first, false)]);
        } else if let (Some(second), Some(first)) = (surfaces.pop(), surfaces.pop()) {
            let (surface, share) = shared_among(node.aabb().half_area(), &first, &second);
            shares[node.first_index as usize / 2] = share;
            surfaces.push(surface);
        }
    }
    AllShares(shares)
}

/// The surfaces of a pair of this surface, whose halves have those, and how it is shared out.
fn shared_among(
    surface: f32,
    first: &[f32; GROUP],
    second: &[f32; GROUP],
) -> ([f32; GROUP], Shares) {
    let (mut surfaces, mut shares) = ([f32::INFINITY; GROUP], [0; GROUP]);
    for places in 1..GROUP {
        for taken in 0..places {
            let sum = first[taken] + second[places - 1 - taken];
            if sum < surfaces[places] {
                surfaces[places] = sum;
                shares[places] = taken as u8 + 1;
            }
        }
    }
    let alone = surface + surfaces[GROUP - 1];
    surfaces[0] = alone;
    shares[0] = shares[GROUP - 1];
    for places in 1..GROUP {
        if alone <= surfaces[places] {
            (surfaces[places], shares[places]) = (alone, 0);
        }
    }
    (surfaces, shares)
}

/// Nodes of pairs, from the largest pairs down; `None` if that becomes too deep.
fn widened<R: Real>(pairs: &Bvh2) -> Option<Vec<Node<R>>> {
    let shares = shared_out(pairs);
    // The pair of each node, and how deep it is: nodes are large, and no more room is taken than they need.
    let mut tops = vec![(0, 1)];
    let mut at = 0;
    while let Some(&(pair, depth)) = tops.get(at) {
        if depth > DEEPEST {
            return None;
        }
        let held = opened(pairs, &shares, pair).into_iter();
        let halved = held.filter(|&held| !pairs.nodes[held].is_leaf());
        tops.extend(halved.map(|held| (held, depth + 1)));
        at += 1;
    }
    let mut nodes = Vec::with_capacity(tops.len());
    let mut next = 0;
    for (pair, _) in tops {
        let mut node = Node::empty();
        for held in opened(pairs, &shares, pair) {
            let half = &pairs.nodes[held];
            node.children[node.count] = if half.is_leaf() {
                Child::Member(pairs.primitive_indices[half.first_index as usize])
            } else {
                next += 1;
                Child::Node(next)
            };
            node.count += 1;
        }
        nodes.push(node);
    }
    Some(nodes)
}

/// The pairs in the node of a pair.
fn opened(pairs: &Bvh2, shares: &AllShares, pair: usize) -> Vec<usize> {
    let mut held = Vec::with_capacity(GROUP);
    let halves = |pair: usize, places: usize, share: u8| {
        let (first, taken) = (pairs.nodes[pair].first_index as usize, usize::from(share));
        [(first + 1, places - taken), (first, taken)]
    };
    if pairs.nodes[pair].is_leaf() {
        return vec![pair];
    }
    let share = shares.of(pairs, pair)[0];
    let mut waiting = Vec::from(halves(pair, GROUP, share));
    while let Some((pair, places)) = waiting.pop() {
        let is_leaf = pairs.nodes[pair].is_leaf();
        let share = if places == 1 || is_leaf {
            0
        } else {
            shares.of(pairs, pair)[places - 1]
        };
        if share == 0 {
            held.push(pair);
        } else {
            waiting.extend(halves(pair, places, share));
        }
    }
    held
}

/// Nodes of neighbours in a list: no better than their order, but never deep.
fn bundled<R: Real>(order: &[u32]) -> Vec<Node<R>> {
    let mut nodes = vec![Node::empty()];
    let mut waiting = VecDeque::from([(0, order)]);
    while let Some((index, members)) = waiting.pop_front() {
        for part in members.chunks(members.len().div_ceil(GROUP)) {
            let child = if let [member] = *part {
                Child::Member(member)
            } else {
                nodes.push(Node::empty());
                waiting.push_back((nodes.len() - 1, part));
                Child::Node(nodes.len() as u32 - 1)
            };
            let node: &mut Node<R> = &mut nodes[index];
            node.children[node.count] = child;
            node.count += 1;
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
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
        outer.and(inner) == *outer
    }

    /// Every member is held once, and by all boxes above it.
    fn is_whole(bvh: &Bvh<f64>, members: &[Member<f64>]) -> bool {
        let mut found = vec![0; members.len()];
        let mut waiting: Vec<(u32, BoundingBox<f64>, usize)> = vec![(0, bvh.bounds, 1)];
        while let Some((index, around, depth)) = waiting.pop() {
            let node = &bvh.nodes[index as usize];
            for place in 0..node.count {
                let held = node.get(place);
                if depth > DEEPEST || !holds(&around, &held.bounds) {
                    return false;
                }
                match node.child(place) {
                    Child::Node(node) => waiting.push((node, held.bounds, depth + 1)),
                    Child::Member(member) => {
                        found[member as usize] += 1;
                        if held.bounds != members[member as usize].bounds {
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
            prop_assert_eq!(bvh.thinnest, thinnest);
            for moved in &mut members {
                moved.bounds.high = moved.bounds.high + Vec3::new(1.0, 2.0, 0.0);
            }
            bvh.refit(|n| members[n]);
            prop_assert!(is_whole(&bvh, &members));
        }

        #[test]
        fn a_list_becomes_a_flat_tree(length in 1..3000_usize) {
            let members: Vec<_> = (0..length).map(|at| member((DVec3::X * at as f64, 0.5))).collect();
            let mut bvh = Bvh { nodes: bundled(&(0..length as u32).collect::<Vec<_>>()), ..tree(&members) };
            bvh.refit(|n| members[n]);
            prop_assert!(is_whole(&bvh, &members));
        }
    }

    #[test]
    fn a_thousand_members_in_one_place_are_found() {
        let members = vec![member((DVec3::ONE, 1.0)); 1000];
        assert!(is_whole(&tree(&members), &members));
        // Each around the one before it: a chain of pairs.
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
