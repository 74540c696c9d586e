//! Objects that fill the same surface, by primitive number: the earlier object of the list is seen.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use glam::DVec3;

use super::contacts::{Contacts, RankedObjects, Tie};
use super::pack::Plan;
use super::packed_mesh::MeshInstance;
use super::request::RenderRequest;
use crate::primitive::BoundingBox;
use crate::scene::{Coincidence, Overlap, Scene};
use crate::simd::Real;

/// Twice the distance up to which surfaces count as one, as a share of the coordinates: their own numbers are
/// rounded too. The same in every precision.
const CLEARANCE: f64 = 8.0 * f32::UNIT_ROUNDOFF as f64;

impl<R: Real> Plan<R> {
    /// Finds the ties of a scene; `listed` gives the primitive numbers of objects outside of the tree by their
    /// indices.
    pub fn find_ties(
        &mut self,
        scene: &Scene,
        request: &RenderRequest,
        contacts: &Contacts,
        listed: &HashMap<usize, usize>,
    ) {
        let is_perspective = !request.is_parallel(&scene.camera);
        let is_relevant = |found: &&Coincidence| !(is_perspective && self.is_hidden(scene, found));
        let relevant: Vec<&Coincidence> = contacts.shared.iter().filter(is_relevant).collect();
        // If all objects in one surface look alike, it does not matter which of them is in front.
        let look_alike = |found: &Coincidence| scene.look_alike(found.later, found.earlier);
        let unlike = relevant.iter().filter(|found| !look_alike(found));
        let unlike: HashSet<usize> = unlike.flat_map(|f| [f.later, f.earlier]).collect();
        let has_effect =
            |found: &&Coincidence| unlike.contains(&found.later) && unlike.contains(&found.earlier);
        let effective = relevant.iter().copied().filter(has_effect);
        let effective: Vec<&Coincidence> = effective.collect();
        let of_one_object = effective.chunk_by(|one, other| one.later == other.later);
        let ties = of_one_object.filter_map(|found| {
            let over = found.iter();
            let over = over.filter_map(|found| self.numbers_at(found.earlier, listed));
            let over: Vec<_> = over.collect();
            let numbers = self.numbers_at(found[0].later, listed);
            Some(Tie {
                numbers: numbers.filter(|_| !over.is_empty())?,
                over: RankedObjects::new(over, self.primitives.len()),
            })
        });
        let mut ties: Vec<Tie> = ties.collect();
        ties.sort_by_key(|tie| tie.numbers.start);
        if !relevant.is_empty() {
            self.clearance = R::from_f64(CLEARANCE);
        }
        self.ties = ties;
    }

    /// The primitive numbers of the object with this index in the scene's list.
    fn numbers_at(&self, index: usize, listed: &HashMap<usize, usize>) -> Option<Range<usize>> {
        if let Some(&number) = listed.get(&index) {
            return Some(number..number + 1);
        }
        let (first, geometry) = (self.primitives.len(), self.geometry.as_ref()?);
        let mesh = self.mesh_at(index).map(MeshInstance::numbers);
        let loose = || geometry.number_at(index).map(|number| number..number + 1);
        let inner = mesh.or_else(loose)?;
        Some(first + inner.start..first + inner.end)
    }

    /// Returns whether a solid that stands on an endless plane hides its faces there from the eye, which is on the
    /// same side and outside of the solid's box: no ray from the eye gets to the other side of the plane. A ray
    /// that starts in the solid, or on it, may see those faces.
    fn is_hidden(&self, scene: &Scene, found: &Coincidence) -> bool {
        let indices = [found.later, found.earlier];
        let mesh = indices.into_iter().find_map(|index| self.mesh_at(index));
        let plane = indices
            .into_iter()
            .find_map(|index| scene.objects[index].shape.plane_piece());
        let (Some(mesh), Some(plane)) = (mesh, plane) else {
            return false;
        };
        let middle = mesh.centre.to_dvec3() + self.centre;
        let eye = scene.camera.position;
        let is_between = plane.height(middle) * plane.height(eye) > 0.0;
        let BoundingBox { low, high } = mesh.member().bounds;
        let (low, high) = (low.to_dvec3(), high.to_dvec3());
        let eye = eye - self.centre;
        let margin = DVec3::splat(CLEARANCE * (low.abs().max(high.abs()).max_element()));
        let is_beside = eye.cmplt(low - margin).any() || eye.cmpgt(high + margin).any();
        found.extent == Overlap::Standing && mesh.is_solid() && is_between && is_beside
    }

    /// The mesh with this index in the scene's list.
    fn mesh_at(&self, index: usize) -> Option<&MeshInstance<R>> {
        let meshes = &self.geometry.as_ref()?.meshes;
        let found = meshes.binary_search_by_key(&index, |mesh| mesh.object_index);
        found.ok().map(|found| &meshes[found])
    }

    /// The tie of the primitive with this number.
    #[inline(always)]
    pub fn tie_of(&self, number: usize) -> Option<&Tie> {
        let after = self.ties.partition_point(|tie| tie.numbers.start <= number);
        let tie = self.ties.get(after.checked_sub(1)?)?;
        tie.numbers.contains(&number).then_some(tie)
    }
}
