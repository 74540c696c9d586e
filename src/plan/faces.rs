//! Faces that camera rays, or shadow rays to a light, can skip.

use glam::DVec3;

use super::culled_faces::CulledFacesCache;
use super::pack::Plan;
use super::request::RenderRequest;
use super::solids::Solids;
use crate::primitive::Culling;
use crate::scene::{Projection, Scene};
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
        let projection = request.projection_of(&scene.camera);
        if projection == Projection::Perspective {
            self.camera_culled_faces = turned_away(scene.camera.position - self.centre);
        }
        for light in &mut self.lights {
            light.shadow_culled_faces = turned_away(light.position.to_dvec3());
        }
    }

    /// Finds the meshes whose faces towards a light need no shadow test: those with an inside that contains neither
    /// the eye nor the light, so that no relevant ray starts in there either.
    pub fn drop_lit_faces(
        &mut self,
        scene: &Scene,
        request: &RenderRequest,
        cache: &mut CulledFacesCache<R>,
    ) {
        let projection = request.projection_of(&scene.camera);
        let Some(geometry) = &self.geometry else {
            return;
        };
        if projection != Projection::Perspective {
            return;
        }
        let eye = Vec3::from_dvec3(scene.camera.position - self.centre);
        // A face that is shaded as curved also receives light from below its plane.
        let meshes = geometry.meshes.iter().enumerate();
        let are_outside = meshes.map(|(index, mesh)| {
            let holds_eye = self.unseen_faces.get(index).is_some_and(Option::is_some);
            mesh.mesh.smooth.is_empty() && !holds_eye && mesh.is_seen_from_outside(eye)
        });
        let are_outside: Vec<bool> = are_outside.collect();
        for light in &mut self.lights {
            let mut holding = std::mem::take(&mut light.culled_faces).into_iter();
            let meshes = geometry.meshes.iter().zip(&are_outside);
            let culled_faces = meshes.map(|(mesh, are_outside)| {
                holding.next().flatten().or_else(|| {
                    let can_skip = *are_outside && mesh.is_seen_from_outside(light.position);
                    can_skip.then(|| cache.towards(light.position, mesh))
                })
            });
            light.culled_faces = culled_faces.collect();
        }
    }
}
