//! Packed meshes, kept from picture to picture.

use std::collections::HashMap;
use std::sync::Arc;

use super::packed_mesh::{LevelKey, MeshKey, PackedMesh};
use crate::scene::Mesh;
use crate::simd::Real;

/// Packed meshes of one precision, by what they were made from.
#[derive(Clone, Debug, Default)]
pub struct Meshes<R> {
    by_key: HashMap<MeshKey, Arc<PackedMesh<R>>>,
    /// For meshes that differ only in rotation, one of them.
    by_level: HashMap<LevelKey, Arc<PackedMesh<R>>>,
}

impl<R: Real> Meshes<R> {
    /// Returns the packed form of a mesh, independent of its position; packs it if it is not known yet.
    pub fn get_or_pack(&mut self, mesh: &Mesh) -> Arc<PackedMesh<R>> {
        let key = MeshKey::of(mesh);
        if let Some(known) = self.by_key.get(&key) {
            return Arc::clone(known);
        }
        let turned = self.by_level.get(&key.level);
        let turned = turned.and_then(|other| other.turned(mesh));
        let packed = turned.unwrap_or_else(|| PackedMesh::new(mesh));
        let packed = PackedMesh::in_precision(&Arc::new(packed));
        self.keep(Arc::clone(&packed));
        packed
    }

    fn keep(&mut self, packed: Arc<PackedMesh<R>>) {
        self.by_level.insert(packed.key.level, Arc::clone(&packed));
        self.by_key.insert(packed.key, packed);
    }

    /// Takes over a mesh packed in double precision, rounded, and shares its tree.
    pub fn take_over(&mut self, packed: &Arc<PackedMesh<f64>>) {
        let known = self.by_key.get(&packed.key);
        if !known.is_some_and(|known| Arc::ptr_eq(&known.bvh.nodes, &packed.bvh.nodes)) {
            self.keep(PackedMesh::in_precision(packed));
        }
    }
}

impl<R: Real> Extend<Arc<PackedMesh<R>>> for Meshes<R> {
    fn extend<I: IntoIterator<Item = Arc<PackedMesh<R>>>>(&mut self, packed: I) {
        packed.into_iter().for_each(|packed| self.keep(packed));
    }
}
