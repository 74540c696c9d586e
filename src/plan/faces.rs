//! Faces that camera rays, or shadow rays to a light, can skip.

use glam::DVec3;

use super::culled_faces::CulledFacesCache;
use super::pack::Plan;
use super::request::RenderRequest;
use super::solids::Solids;
use crate::primitive::Culling;
use crate::scene::Scene;
use crate::simd::{Real, Vec3};

impl<R: Real> Plan<R> {
    /// Finds the faces of solids that camera rays, and shadow rays to each light, can skip.
    pub fn drop_far_faces(&mut self, scene: &Scene, request: &RenderRequest) {
        let triangles = &self.primitives.triangles;
        let solids = Solids::among(triangles);
        let turned_away = |point: DVec3| {
            let away = triangles.iter().zip(solids.turned_away(point));
            // In single precision, an open solid may look closed.
            away.map(|(face, is_away)| is_away && face.culling == Culling::Far)
                .collect()
        };
        if !request.is_parallel(&scene.camera) {
            self.camera_culled_faces = turned_away(scene.camera.position - self.centre);
        }
        for light in &mut self.lights {
            light.shadow_culled_faces = turned_away(light.position.to_dvec3());
        }
    }

    /// Finds the meshes whose faces towards a light need no shadow test: those with an inside that contains neither
    /// the eye nor the light, so that no relevant ray starts in there either. The faces that hold one of these must be
    /// known, see [`Self::find_held_faces`].
    pub fn drop_lit_faces(
        &mut self,
        scene: &Scene,
        request: &RenderRequest,
        cache: &mut CulledFacesCache<R>,
    ) {
        let Some(geometry) = &self.geometry else {
            return;
        };
        if request.is_parallel(&scene.camera) {
            return;
        }
        let eye = Vec3::from_dvec3(scene.camera.position - self.centre);
        // A face that is shaded as curved also receives light from below its plane.
        let meshes = geometry.meshes.iter().zip(&self.unseen_faces);
        let are_outside = meshes.map(|(mesh, holding_eye)| {
            let may_skip = mesh.mesh.smooth.is_empty() && holding_eye.is_none();
            may_skip && mesh.is_seen_from_outside(eye)
        });
        let are_outside: Vec<bool> = are_outside.collect();
        for light in &mut self.lights {
            let meshes = geometry.meshes.iter().zip(&are_outside);
            for (culled_faces, (mesh, are_outside)) in light.culled_faces.iter_mut().zip(meshes) {
                let may_skip = *are_outside && culled_faces.is_none();
                if may_skip && mesh.is_seen_from_outside(light.position) {
                    *culled_faces = Some(cache.towards(light.position, mesh));
                }
            }
        }
    }
}
