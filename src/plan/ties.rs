//! Objects that fill the same surface, as the tracer counts them: the earlier one of the list is seen.

use super::contacts::{Contacts, Tie};
use super::pack::Plan;
use super::packed_mesh::MeshInstance;
use super::request::RenderRequest;
use crate::scene::{Coincidence, Extent, Projection, Scene};
use crate::simd::Real;

impl<R: Real> Plan<R> {
    /// The ties of a scene, sorted, given the numbers of what stands in no tree.
    pub fn ties(
        &self,
        scene: &Scene,
        (request, contacts): (&RenderRequest, &Contacts),
        number: impl Fn(&usize) -> Option<usize>,
    ) -> Vec<Tie> {
        let numbers = |place: usize| match self.mesh_at(place) {
            Some(mesh) => {
                let (first, inner) = (self.primitives.len(), mesh.numbers());
                Some(first + inner.start..first + inner.end)
            }
            None => number(&place).map(|number| number..number + 1),
        };
        let is_perspective = request.projection_of(&scene.camera) == Projection::Perspective;
        let mut ties: Vec<Tie> = Vec::new();
        for found in &contacts.shared {
            let (later, earlier) = (numbers(found.later), numbers(found.earlier));
            let (Some(later), Some(earlier)) = (later, earlier) else {
                continue;
            };
            if is_perspective && self.hides(scene, found) {
                continue;
            }
            match ties.last_mut().filter(|tie| tie.numbers == later) {
                Some(tie) => tie.over.push(earlier),
                None => ties.push(Tie {
                    numbers: later,
                    over: vec![earlier],
                }),
            }
        }
        ties.sort_by_key(|tie| tie.numbers.start);
        ties
    }

    /// Whether a solid stands between the eye and the faces on which it stands: no ray that comes from the eye
    /// reaches the other side of an endless plane.
    fn hides(&self, scene: &Scene, found: &Coincidence) -> bool {
        let places = [found.later, found.earlier];
        let mesh = places.into_iter().find_map(|place| self.mesh_at(place));
        let plane = places
            .into_iter()
            .find_map(|place| scene.objects[place].shape.plane_piece());
        let (Some(mesh), Some(plane)) = (mesh, plane) else {
            return false;
        };
        let middle = mesh.centre.to_dvec3() + self.centre;
        let sides = plane.height(middle) * plane.height(scene.camera.position);
        found.extent == Extent::Standing && mesh.is_solid() && sides > 0.0
    }

    /// The mesh that is at this place in the scene's list.
    fn mesh_at(&self, place: usize) -> Option<&MeshInstance<R>> {
        let meshes = &self.geometry.as_ref()?.meshes;
        let found = meshes.binary_search_by_key(&place, |mesh| mesh.place);
        found.ok().map(|index| &meshes[index])
    }

    /// The tie of what has this number.
    #[inline(always)]
    pub fn tie_of(&self, number: usize) -> Option<&Tie> {
        let after = self.ties.partition_point(|tie| tie.numbers.start <= number);
        let tie = self.ties.get(after.checked_sub(1)?)?;
        tie.numbers.contains(&number).then_some(tie)
    }
}
