//! Meshes that are ready, kept from picture to picture.

use std::collections::HashMap;
use std::sync::Arc;

use super::packed_mesh::{MeshKey, PackedMesh};
use crate::scene::Mesh;
use crate::simd::Real;

/// Meshes that are ready in a precision, by what they were made of.
#[derive(Clone, Debug, Default)]
pub struct Meshes<R>(HashMap<MeshKey, Arc<PackedMesh<R>>>);

impl<R: Real> Meshes<R> {
    /// What is packed of a mesh, wherever that is: made ready unless it is.
    pub fn ready(&mut self, mesh: &Mesh) -> Arc<PackedMesh<R>> {
        let make = || PackedMesh::in_precision(&Arc::new(PackedMesh::new(mesh)));
        Arc::clone(self.0.entry(MeshKey::of(mesh)).or_insert_with(make))
    }

    /// Takes over what is ready in double precision, and shares its tree from then on.
    pub fn take_over(&mut self, packed: &Arc<PackedMesh<f64>>) {
        let own = self.0.get(&packed.key);
        if !own.is_some_and(|own| Arc::ptr_eq(&own.bvh.nodes, &packed.bvh.nodes)) {
            self.0.insert(packed.key, PackedMesh::in_precision(packed));
        }
    }
}

impl<R: Real> Extend<Arc<PackedMesh<R>>> for Meshes<R> {
    fn extend<I: IntoIterator<Item = Arc<PackedMesh<R>>>>(&mut self, packed: I) {
        self.0
            .extend(packed.into_iter().map(|packed| (packed.key, packed)));
    }
}
