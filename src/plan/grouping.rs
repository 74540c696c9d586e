//! Groups boxes into the nodes of a tree: into pairs first, then into nodes of up to sixteen.

use std::collections::{HashSet, VecDeque};

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::morton::morton_encode_u64_unorm;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

/// Maximum number of boxes per node.
pub const GROUP: usize = 16;
/// Maximum number of nodes on the path from the root to a member.
pub const MAX_DEPTH: usize = 24;
/// Number of boxes above which they are split into parts first. Clustered as a whole, a million boxes would take
/// 230 MB at once and make a worse tree: clustering joins neighbours without regard to the whole. With parts, a
/// hilly ground with a finer middle is traced in 0.79 of the time; balls that fill a space gain nothing, and
/// 100,000 of them take 1.08 times as long.
const PARTITION_THRESHOLD: usize = 1 << 17;
/// Maximum number of boxes per part.
const MAX_PART_SIZE: usize = 1 << 14;
/// The same for boxes of which clustering joins few pairs at a time.
const MAX_SLOW_PART_SIZE: usize = 1 << 10;
/// Share of the boxes that find a partner at a time, below which that is too slow; usually, a third does.
const MIN_JOINED: f64 = 1.0 / 16.0;
/// Share of the boxes that are reinserted elsewhere after clustering, if that improves the tree.
const REINSERTED: f32 = 0.02;

/// Number of boxes that are sampled to find out whether many coincide.
const SAMPLED: usize = 512;
/// Maximum distance by which coinciding boxes are moved, as a share of the largest coordinate.
const MAX_NUDGE: f32 = 1e-3;

/// The content of one box of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// The node of this index.
    Node(u32),
    /// The member with this number.
    Member(u32),
}

/// The content of a node.
#[derive(Clone, Copy, Debug)]
pub struct WideNode {
    /// The children, in the first [`Self::count`] places.
    pub children: [Child; GROUP],
    /// The number of children.
    pub count: usize,
}

impl Default for WideNode {
    fn default() -> Self {
        Self {
            children: [Child::Member(0); GROUP],
            count: 0,
        }
    }
}

impl WideNode {
    fn push(&mut self, child: Child) {
        self.children[self.count] = child;
        self.count += 1;
    }
}

/// Builds the nodes of a tree over `boxes`; their indices are their numbers. The root comes first, and each node
/// before its child nodes.
pub fn group_boxes(boxes: &[Aabb]) -> Vec<WideNode> {
    if boxes.is_empty() {
        return Vec::new();
    }
    let mut members: Vec<u32> = (0..boxes.len() as u32).collect();
    let max_size = if boxes.len() > PARTITION_THRESHOLD {
        MAX_PART_SIZE
    } else {
        PARTITION_THRESHOLD
    };
    build_nodes(boxes, &mut members, max_size, MAX_DEPTH)
}

/// Builds the tree over some of the boxes; splits them into parts first if there are more than `max_size`, or if they
/// would be clustered too slowly.
fn build_nodes(
    boxes: &[Aabb],
    members: &mut [u32],
    max_size: usize,
    max_depth: usize,
) -> Vec<WideNode> {
    let is_slow = members.len() > MAX_SLOW_PART_SIZE && are_joined_singly(boxes, members);
    if members.len() > max_size || is_slow {
        let parts = split_into_parts(boxes, members).into_par_iter();
        let trees = parts.map(|part| build_nodes(boxes, part, max_size, max_depth - 1));
        return under_one_root(trees.collect());
    }
    let own_boxes = members.iter().map(|&member| boxes[member as usize]);
    let mut pairs = build_pairs(own_boxes.collect());
    for member in &mut pairs.primitive_indices {
        *member = members[*member as usize];
    }
    widen(&pairs, max_depth).unwrap_or_else(|| group_by_order(&pairs.primitive_indices))
}

/// Splits the members into [`GROUP`] parts of equal size, by repeated halving across the longest axis.
fn split_into_parts<'a>(boxes: &[Aabb], members: &'a mut [u32]) -> Vec<&'a mut [u32]> {
    let mut parts = vec![members];
    while parts.len() < GROUP {
        let halves = parts.into_iter().flat_map(|part| {
            let middle = |member: u32| boxes[member as usize].center();
            let around = part.iter().fold(Aabb::empty(), |around, &member| {
                around.union(&Aabb::from_point(middle(member)))
            });
            let axis = around.largest_axis();
            let half = part.len() / 2;
            part.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]));
            <[_; 2]>::from(part.split_at_mut(half))
        });
        parts = halves.collect();
    }
    parts
}

/// Joins trees under a new root.
fn under_one_root(trees: Vec<Vec<WideNode>>) -> Vec<WideNode> {
    let mut groups = vec![WideNode::default()];
    for tree in trees {
        let first = groups.len() as u32;
        groups[0].push(Child::Node(first));
        groups.extend(tree.into_iter().map(|mut node| {
            for child in &mut node.children[..node.count] {
                if let Child::Node(index) = child {
                    *index += first;
                }
            }
            node
        }));
    }
    groups
}

/// Clusters boxes into a binary tree: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume
/// Hierarchy Construction", TVCG 24(3), 2018, followed by reinsertion of some boxes.
fn build_pairs(mut boxes: Vec<Aabb>) -> Bvh2 {
    if are_many_coincident(&boxes) {
        separate_coincident(&mut boxes);
    }
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

/// Returns whether clustering would join few pairs at a time, as each box is to be the best partner of the other. In a
/// regular row, all choose the neighbour on the same side: 40,000 triangles in a row took 27 s. In a nest of boxes, all
/// choose the smaller one.
fn are_joined_singly(boxes: &[Aabb], members: &[u32]) -> bool {
    let own = |member: &u32| &boxes[*member as usize];
    let around = members.iter().map(own);
    let around = around.fold(Aabb::empty(), |around, one| around.union(one));
    let scale = 1.0 / around.diagonal().as_dvec3();
    // The order in which clustering looks for partners.
    let mut curve: Vec<(u64, u32)> = members
        .iter()
        .map(|member| {
            let middle = own(member).center() - around.min;
            let place =
                (middle.as_dvec3() * scale).map(|part| if part.is_finite() { part } else { 0.0 });
            (morton_encode_u64_unorm(place), *member)
        })
        .collect();
    curve.sort_unstable();
    let cost = |pair: &[(u64, u32)]| own(&pair[0].1).union(own(&pair[1].1)).half_area();
    let costs: Vec<f32> = curve.windows(2).map(cost).collect();
    let is_joined = |three: &&[f32]| three[1] <= three[0] && three[1] < three[2];
    let joined = costs.windows(3).filter(is_joined).count();
    (joined as f64) < MIN_JOINED * members.len() as f64
}

/// Returns whether many boxes coincide with others, judged by a sample.
fn are_many_coincident(boxes: &[Aabb]) -> bool {
    let step = boxes.len().div_ceil(SAMPLED).max(1);
    let bits = |one: &Aabb| {
        (
            one.min.to_array().map(f32::to_bits),
            one.max.to_array().map(f32::to_bits),
        )
    };
    let sampled: Vec<_> = boxes.iter().step_by(step).map(bits).collect();
    let different: HashSet<_> = sampled.iter().collect();
    different.len() * 2 < sampled.len()
}

/// Moves each box a little in its own direction. Coinciding boxes would be joined one at a time, since all choose
/// the same nearest neighbour: 40,000 balls took half a minute. The moved boxes only determine the grouping.
fn separate_coincident(boxes: &mut [Aabb]) {
    let reach = |one: &Aabb| one.min.abs().max(one.max.abs()).max_element();
    let size = boxes.iter().map(reach).fold(f32::MIN_POSITIVE, f32::max);
    let mut state = 1_u32;
    let mut random = || {
        // A linear congruential generator: Knuth, "The art of computer programming" 2, §3.3.4.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / 16_777_216.0
    };
    for one in boxes {
        let nudge = Vec3A::new(random(), random(), random()) * (size * MAX_NUDGE);
        one.min += nudge;
        one.max += nudge;
    }
}

/// How a pair (a node of the binary tree) is distributed if it may take up 1, 2, … [`GROUP`] places of a wide node:
/// 0 if it stays one box, otherwise the number of places for its first half. With only one place it always is one
/// box, so that entry holds how the wide node of the pair itself is distributed.
type Splits = [u8; GROUP];

/// The [`Splits`] of all pairs that have halves. Halves are stored side by side after the root, so their position
/// identifies the pair.
struct AllSplits(Vec<Splits>);

impl AllSplits {
    fn of(&self, pairs: &Bvh2, pair: usize) -> &Splits {
        &self.0[pairs.nodes[pair].first_index as usize / 2]
    }
}

/// Distributes the places of wide nodes so that the total surface area of their boxes is smallest: random rays hit
/// a box in proportion to its surface area. Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs
/// through compressed wide BVHs", HPG 2017, ch. 3; members cost the same wherever they are held.
fn distribute_places(pairs: &Bvh2) -> AllSplits {
    let mut splits = vec![[0; GROUP]; pairs.nodes.len().div_ceil(2)];
    let mut waiting = vec![(0, false)];
    // Total surface area of the wide nodes in a pair, by the number of places it may take up.
    let mut surfaces: Vec<[f32; GROUP]> = Vec::new();
    while let Some((index, is_entered)) = waiting.pop() {
        let node = &pairs.nodes[index];
        let first = node.first_index as usize;
        if node.is_leaf() {
            surfaces.push([0.0; GROUP]);
        } else if !is_entered {
            waiting.extend([(index, true), (first + 1, false), (first, false)]);
        } else if let (Some(second), Some(first)) = (surfaces.pop(), surfaces.pop()) {
            let (surface, split) = distribute_pair(node.aabb().half_area(), &first, &second);
            splits[node.first_index as usize / 2] = split;
            surfaces.push(surface);
        }
    }
    AllSplits(splits)
}

/// Returns the total surface areas for a pair with this surface area and these halves, and how it is distributed.
fn distribute_pair(
    surface: f32,
    first: &[f32; GROUP],
    second: &[f32; GROUP],
) -> ([f32; GROUP], Splits) {
    let (mut surfaces, mut splits) = ([f32::INFINITY; GROUP], [0; GROUP]);
    for places in 1..GROUP {
        for taken in 0..places {
            let sum = first[taken] + second[places - 1 - taken];
            if sum < surfaces[places] {
                surfaces[places] = sum;
                splits[places] = taken as u8 + 1;
            }
        }
    }
    let as_one_box = surface + surfaces[GROUP - 1];
    surfaces[0] = as_one_box;
    splits[0] = splits[GROUP - 1];
    for places in 1..GROUP {
        if as_one_box <= surfaces[places] {
            (surfaces[places], splits[places]) = (as_one_box, 0);
        }
    }
    (surfaces, splits)
}

/// Turns pairs into wide nodes, from the root down; `None` if the tree becomes too deep.
fn widen(pairs: &Bvh2, max_depth: usize) -> Option<Vec<WideNode>> {
    let splits = distribute_places(pairs);
    // The pair and the depth of each wide node; they are listed first, so that no more memory is allocated than
    // needed.
    let mut tops = vec![(0, 1)];
    let mut next_top = 0;
    while let Some(&(pair, depth)) = tops.get(next_top) {
        if depth > max_depth {
            return None;
        }
        let inner = node_boxes(pairs, &splits, pair).into_iter();
        let inner = inner.filter(|&pair| !pairs.nodes[pair].is_leaf());
        tops.extend(inner.map(|pair| (pair, depth + 1)));
        next_top += 1;
    }
    let mut groups = Vec::with_capacity(tops.len());
    let mut next = 0;
    for (pair, _) in tops {
        let mut group = WideNode::default();
        for pair in node_boxes(pairs, &splits, pair) {
            let half = &pairs.nodes[pair];
            group.push(if half.is_leaf() {
                Child::Member(pairs.primitive_indices[half.first_index as usize])
            } else {
                next += 1;
                Child::Node(next)
            });
        }
        groups.push(group);
    }
    Some(groups)
}

/// The pairs that become the boxes of the wide node of `pair`.
fn node_boxes(pairs: &Bvh2, splits: &AllSplits, pair: usize) -> Vec<usize> {
    let mut boxes = Vec::with_capacity(GROUP);
    let split_pair = |pair: usize, places: usize, split: u8| {
        let (first, taken) = (pairs.nodes[pair].first_index as usize, usize::from(split));
        [(first + 1, places - taken), (first, taken)]
    };
    if pairs.nodes[pair].is_leaf() {
        return vec![pair];
    }
    let split = splits.of(pairs, pair)[0];
    let mut waiting = Vec::from(split_pair(pair, GROUP, split));
    while let Some((pair, places)) = waiting.pop() {
        let is_leaf = pairs.nodes[pair].is_leaf();
        let split = if places == 1 || is_leaf {
            0
        } else {
            splits.of(pairs, pair)[places - 1]
        };
        if split == 0 {
            boxes.push(pair);
        } else {
            waiting.extend(split_pair(pair, places, split));
        }
    }
    boxes
}

/// Groups neighbours in a list into nodes: only as good as the order of the list, but never deep.
fn group_by_order(order: &[u32]) -> Vec<WideNode> {
    let mut groups = vec![WideNode::default()];
    let mut waiting = VecDeque::from([(0, order)]);
    while let Some((index, members)) = waiting.pop_front() {
        for part in members.chunks(members.len().div_ceil(GROUP)) {
            let child = if let [member] = *part {
                Child::Member(member)
            } else {
                groups.push(WideNode::default());
                waiting.push_back((groups.len() - 1, part));
                Child::Node(groups.len() as u32 - 1)
            };
            groups[index].push(child);
        }
    }
    groups
}

#[cfg(test)]
mod tests;
