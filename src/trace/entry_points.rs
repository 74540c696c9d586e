//! Entry points into the trees for the packets of a tile: the part of the traversal that all of them share is done
//! once.

use super::bundle::Shaft;
use crate::plan::{Bvh, Child, GROUP, Geometry, Node};
use crate::simd::{Real as _, SimdFloat};

/// Greatest number of meshes with entry points of their own per tile; others are entered at their roots.
const MAX_MESHES: usize = 4;

/// The nodes at which a tile's rays enter the trees. They need not be nodes of a tree: their boxes may come from
/// several nodes, and together contain everything that the rays can meet.
#[derive(Clone, Debug, Default)]
pub struct EntryPoints {
    objects: Option<Node>,
    meshes: Vec<(u32, Node)>,
}

impl EntryPoints {
    /// Resets the entry points to the roots of the trees.
    pub fn reset(&mut self) {
        self.objects = None;
        self.meshes.clear();
    }

    /// Finds the entry points of rays that go no farther than `reach`. Returns whether they can meet anything.
    #[inline(never)]
    pub fn narrow<L: SimdFloat>(
        &mut self,
        token: L::Token,
        geometry: &Geometry<L::Real>,
        shaft: &Shaft<L::Real>,
        reach: L::Real,
    ) -> bool {
        L::vectorize(
            token,
            #[inline(always)]
            || self.narrow_vectorized::<L>(token, geometry, shaft, reach),
        )
    }

    #[inline(always)]
    fn narrow_vectorized<L: SimdFloat>(
        &mut self,
        token: L::Token,
        geometry: &Geometry<L::Real>,
        shaft: &Shaft<L::Real>,
        reach: L::Real,
    ) -> bool {
        self.meshes.clear();
        let Some(objects) = entry_node::<L>(token, &geometry.bvh, shaft, reach) else {
            return false;
        };
        let mut kept = Node::empty();
        for index in 0..objects.count {
            if let Child::Member(member) = objects.child(index)
                && let Some(mesh) = (member as usize).checked_sub(geometry.primitives.len())
                && self.meshes.len() < MAX_MESHES
            {
                let instance = &geometry.meshes[mesh];
                let local_shaft = shaft.seen_from(instance.centre);
                match entry_node::<L>(token, &instance.mesh.bvh, &local_shaft, reach) {
                    Some(node) => self.meshes.push((mesh as u32, node)),
                    None => continue,
                }
            }
            kept.take(&objects, index);
        }
        self.objects = Some(kept);
        kept.count > 0
    }

    /// The entry point into the tree of objects.
    #[inline(always)]
    pub fn of_objects<'a, R>(&'a self, geometry: &'a Geometry<R>) -> Option<&'a Node> {
        self.objects.as_ref().or(geometry.bvh.nodes.first())
    }

    /// The entry point into the tree of a mesh.
    #[inline(always)]
    pub fn of_mesh<'a, R>(&'a self, geometry: &'a Geometry<R>, mesh: usize) -> Option<&'a Node> {
        let narrowed = self
            .meshes
            .iter()
            .find(|(index, _)| *index as usize == mesh);
        match narrowed {
            Some((_, node)) => Some(node),
            None => geometry.meshes[mesh].mesh.bvh.nodes.first(),
        }
    }
}

/// Returns the boxes that the rays can meet, descended as far as all of them fit in one node; `None` if there are
/// none.
#[inline(always)]
fn entry_node<L: SimdFloat>(
    token: L::Token,
    bvh: &Bvh<L::Real>,
    shaft: &Shaft<L::Real>,
    reach: L::Real,
) -> Option<Node> {
    let mut nears = [L::Real::ZERO; GROUP];
    let mut met = Node::empty();
    met.take_met(
        bvh.nodes.first()?,
        shaft.meets::<L>(token, &bvh.nodes[0], reach, &mut nears),
    );
    let mut index = 0;
    while index < met.count {
        if let Child::Node(inner) = met.child(index) {
            let inner = &bvh.nodes[inner as usize];
            let bits = shaft.meets::<L>(token, inner, reach, &mut nears);
            if bits.count_ones() as usize <= GROUP + 1 - met.count {
                met.remove(index);
                met.take_met(inner, bits);
                // The box that was moved to this index comes next.
                continue;
            }
        }
        index += 1;
    }
    (met.count > 0).then_some(met)
}

impl Node {
    /// Appends the boxes of another node whose bits are set.
    #[inline(always)]
    fn take_met(&mut self, from: &Self, mut bits: u64) {
        while bits != 0 {
            self.take(from, bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}
