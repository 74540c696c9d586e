//! Faces of meshes that rays from the eye or to a light can skip.

use std::collections::HashMap;
use std::sync::Arc;

use rayon::iter::ParallelIterator as _;
use rayon::slice::ParallelSlice as _;

use super::bvh::Child;
use super::packed_mesh::{MeshInstance, PackedMesh};
use crate::primitive::{FAR_CAUTION, PackedTriangle};
use crate::simd::{Real, Vec3};

/// Bits per word.
const BITS: usize = 64;

/// Some faces of a mesh, and the nodes that contain only such faces.
#[derive(Clone, Debug)]
pub struct CulledFaces {
    faces: Vec<u64>,
    nodes: Vec<u64>,
}

impl CulledFaces {
    /// The faces that are turned to a light at `light`, relative to the middle of the mesh: rays to the light that
    /// leave a closed mesh through these faces have entered it through others.
    fn towards<R: Real>(mesh: &PackedMesh<R>, light: Vec3<R>) -> Self {
        let size = light.max_abs() + mesh.bvh.bounds.max_abs();
        let margin = size * R::from_f64(FAR_CAUTION);
        Self::of(mesh, |face| {
            margin < face.normal.dot(light - face.corners[0])
        })
    }

    /// Collects the faces of a mesh for which `is_culled` holds.
    pub fn of<R: Real>(
        mesh: &PackedMesh<R>,
        is_culled: impl Fn(&PackedTriangle<R>) -> bool + Sync,
    ) -> Self {
        let word = |faces: &[PackedTriangle<R>]| {
            let bits = faces.iter().enumerate();
            bits.fold(0, |word, (bit, face)| {
                word | u64::from(is_culled(face)) << bit
            })
        };
        let mut culled_faces = Self {
            faces: mesh.triangles.par_chunks(BITS).map(word).collect(),
            nodes: vec![0; mesh.bvh.nodes.len().div_ceil(BITS)],
        };
        // A node comes before its child nodes.
        for (index, node) in mesh.bvh.nodes.iter().enumerate().rev() {
            let all = (0..node.count).all(|slot| culled_faces.holds(node.child(slot)));
            culled_faces.nodes[index / BITS] |= u64::from(all) << (index % BITS);
        }
        culled_faces
    }

    /// Returns whether the child is one of the faces, or a node that contains only such faces.
    #[inline(always)]
    pub fn holds(&self, child: Child) -> bool {
        let (words, index) = match child {
            Child::Member(face) => (&self.faces, face as usize),
            Child::Node(node) => (&self.nodes, node as usize),
        };
        words[index / BITS] >> (index % BITS) & 1 == 1
    }
}

/// Results for the previous picture, which the next one may reuse.
#[derive(Clone, Debug, Default)]
pub struct CulledFacesCache<R> {
    known: HashMap<Key, Known<R>>,
    used: HashMap<Key, Known<R>>,
}

/// The address of a mesh, and the bits of a light's position relative to the mesh's middle.
type Key = (usize, [u64; 3]);

#[derive(Clone, Debug)]
struct Known<R> {
    /// Kept alive so that no other mesh gets its address.
    _mesh: Arc<PackedMesh<R>>,
    culled_faces: Arc<CulledFaces>,
}

impl<R: Real> CulledFacesCache<R> {
    /// Returns the faces of a mesh that rays to a light can skip.
    pub fn towards(&mut self, light: Vec3<R>, mesh: &MeshInstance<R>) -> Arc<CulledFaces> {
        let local_light = light - mesh.centre;
        let bits = local_light.to_array().map(|part| part.to_f64().to_bits());
        let key = (Arc::as_ptr(&mesh.mesh).addr(), bits);
        let known = &mut self.known;
        let found = self.used.entry(key).or_insert_with(|| {
            known.remove(&key).unwrap_or_else(|| Known {
                _mesh: Arc::clone(&mesh.mesh),
                culled_faces: Arc::new(CulledFaces::towards(&mesh.mesh, local_light)),
            })
        });
        Arc::clone(&found.culled_faces)
    }

    /// Ends a picture: drops the results that it did not use.
    pub fn end_picture(&mut self) {
        self.known = std::mem::take(&mut self.used);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::icosphere;
    use crate::scene::Mesh;

    #[test]
    fn the_faces_of_a_ball_towards_a_light_are_culled_with_their_nodes() {
        let mesh = PackedMesh::new(&Mesh::of(icosphere(1.0)));
        let culled_faces = CulledFaces::towards(&mesh, Vec3::new(0.0, 1e4, 0.0));
        let faces = 0..mesh.triangles.len() as u32;
        for face in faces.clone() {
            let is_up = mesh.triangles[face as usize].normal.y > 1e-3;
            assert_eq!(culled_faces.holds(Child::Member(face)), is_up, "{face}");
        }
        for (index, node) in mesh.bvh.nodes.iter().enumerate() {
            let all = (0..node.count).all(|slot| culled_faces.holds(node.child(slot)));
            assert_eq!(
                culled_faces.holds(Child::Node(index as u32)),
                all,
                "{index}"
            );
        }
        assert!(!culled_faces.holds(Child::Node(0)));
    }
}
