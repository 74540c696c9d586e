//! Packed meshes, kept from picture to picture.

use std::collections::HashMap;
use std::sync::Arc;

use super::packed_mesh::{LevelKey, MeshKey, PackedMesh};
use crate::scene::Mesh;
use crate::simd::Real;

/// Packed meshes of one precision, by what they were made from.
#[derive(Clone, Debug, Default)]
pub struct Meshes<R> {
    all: HashMap<MeshKey, Arc<PackedMesh<R>>>,
    /// For meshes that differ only in rotation, one of them.
    turned: HashMap<LevelKey, Arc<PackedMesh<R>>>,
}

impl<R: Real> Meshes<R> {
    /// Returns the packed form of a mesh, independent of its position; packs it if it is not known yet.
    pub fn ready(&mut self, mesh: &Mesh) -> Arc<PackedMesh<R>> {
        let key = MeshKey::of(mesh);
        if let Some(known) = self.all.get(&key) {
            return Arc::clone(known);
        }
        let turned = self.turned.get(&key.level());
        let turned = turned.and_then(|other| other.turned(mesh));
        let packed = turned.unwrap_or_else(|| PackedMesh::new(mesh));
        let packed = PackedMesh::in_precision(&Arc::new(packed));
        self.keep(Arc::clone(&packed));
        packed
    }

    fn keep(&mut self, packed: Arc<PackedMesh<R>>) {
        self.turned.insert(packed.key.level(), Arc::clone(&packed));
        self.all.insert(packed.key, packed);
    }

    /// Takes over a mesh packed in double precision, rounded, and shares its tree.
    pub fn take_over(&mut self, packed: &Arc<PackedMesh<f64>>) {
        let own = self.all.get(&packed.key);
        if !own.is_some_and(|own| Arc::ptr_eq(&own.bvh.nodes, &packed.bvh.nodes)) {
            self.keep(PackedMesh::in_precision(packed));
        }
    }
}

impl<R: Real> Extend<Arc<PackedMesh<R>>> for Meshes<R> {
    fn extend<I: IntoIterator<Item = Arc<PackedMesh<R>>>>(&mut self, packed: I) {
        packed.into_iter().for_each(|packed| self.keep(packed));
    }
}
