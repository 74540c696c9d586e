//! Faces of meshes that contain the eye, the window of parallel rays, or a light, so that rounding would decide on
//! which side of them it is. Such a face is invisible to the eye and casts no shadow from the light.

use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec3;

use super::culled_faces::CulledFaces;
use super::pack::Plan;
use super::packed_mesh::{MeshInstance, PackedMesh};
use super::request::{Model, RenderRequest};
use crate::primitive::{BoundingBox, PackedTriangle};
use crate::scene::{Mesh, PlanePiece, Scene, Shape, unit};
use crate::simd::{Real, Vec3};

/// Height above a face, as a share of the coordinates, that single precision may give a point on the face.
const MAX_FACE_HEIGHT: f64 = 8.0 * f32::UNIT_ROUNDOFF as f64;

/// Greatest number of pairs of a mesh and a light that are examined: with more, that takes seconds and gigabytes.
const MAX_PAIRS: usize = 200_000;

/// A point from which rays start, or to which they go.
#[derive(Clone, Copy)]
struct RayEnd {
    /// In the world.
    point: DVec3,
    /// The direction of parallel rays, which start from a window through the point.
    direction: Option<DVec3>,
}

impl<R: Real> Plan<R> {
    /// Finds the faces that contain the eye or a light; the latter only if meshes and lights are not too many.
    pub fn find_held_faces(&mut self, scene: &Scene, request: &RenderRequest) {
        let Some(geometry) = &self.geometry else {
            return;
        };
        if request.model == Model::Everything {
            return;
        }
        let containing = |end: RayEnd| {
            let meshes = geometry.meshes.iter();
            meshes
                .map(
                    |instance| match &scene.objects[instance.object_index].shape {
                        Shape::Mesh(mesh) => end.containing_faces(instance, mesh),
                        _ => None,
                    },
                )
                .collect()
        };
        let is_parallel = request.is_parallel(&scene.camera);
        self.unseen_faces = containing(RayEnd {
            point: scene.camera.position,
            direction: unit(scene.camera.look_at).filter(|_| is_parallel),
        });
        if geometry.meshes.len() * self.lights.len() > MAX_PAIRS {
            return;
        }
        for light in &mut self.lights {
            light.culled_faces = containing(RayEnd {
                point: light.world_position,
                direction: None,
            });
            light.may_be_on_surface |= light.culled_faces.iter().any(Option::is_some);
        }
    }
}

impl RayEnd {
    /// The faces of a mesh that contain the end; `None` if there are none.
    fn containing_faces<R: Real>(
        &self,
        instance: &MeshInstance<R>,
        mesh: &Mesh,
    ) -> Option<Arc<CulledFaces>> {
        let packed = &*instance.mesh;
        let local = LocalRayEnd::new(self, packed, mesh);
        // Most meshes are far away, and there may be many.
        if !local.meets(&packed.bvh.bounds) {
            return None;
        }
        let mut near = packed
            .bvh
            .members_where(|bounds| local.meets(bounds))
            .into_iter();
        if !near.any(|face| local.may_be_held(&packed.triangles[face as usize])) {
            return None; // Only now is it worth checking all faces.
        }
        let faces = mesh.source.triangles().corners().zip(mesh.world_corners());
        // A point only near a face is not on it: there rounding may decide, and doubtful samples are traced again.
        let holding = faces.filter(|(_, corners)| {
            PlanePiece::between(*corners).is_some_and(|piece| self.is_in(&piece))
        });
        let holding: HashSet<_> = holding
            .map(|(corners, _)| sorted_corners(corners.map(|corner| packed.to_local(corner))))
            .collect();
        let is_held = |face: &PackedTriangle<R>| holding.contains(&sorted_corners(face.corners));
        (!holding.is_empty()).then(|| Arc::new(CulledFaces::of(packed, is_held)))
    }

    fn is_in(&self, piece: &PlanePiece) -> bool {
        piece.height(self.point) == 0.0
            && self
                .direction
                .is_none_or(|direction| piece.is_perpendicular_to(direction))
    }
}

/// The same point relative to the middle of a mesh, with the rounding error of the mesh's faces.
#[derive(Clone, Copy)]
struct LocalRayEnd<R> {
    point: Vec3<R>,
    direction: Option<Vec3<R>>,
    slack: R,
}

impl<R: Real> LocalRayEnd<R> {
    fn new(end: &RayEnd, packed: &PackedMesh<R>, mesh: &Mesh) -> Self {
        let point = Vec3::from_dvec3(end.point - packed.middle_of(mesh));
        let size = point.max_abs() + packed.bvh.bounds.max_abs();
        Self {
            point,
            direction: end.direction.map(Vec3::from_dvec3),
            slack: size * R::from_f64(MAX_FACE_HEIGHT),
        }
    }

    /// Returns whether a box may contain the point, or intersects the window.
    fn meets(&self, bounds: &BoundingBox<R>) -> bool {
        let (middle, _) = bounds.ball();
        let half = bounds.high - middle + Vec3::splat(self.slack);
        let offset = (self.point - middle).to_array();
        match self.direction {
            None => offset
                .into_iter()
                .zip(half.to_array())
                .all(|(offset, half)| offset.abs() <= half),
            Some(direction) => {
                let across = direction.to_array().map(R::abs);
                (self.point - middle).dot(direction).abs() <= half.dot(Vec3::from(across))
            }
        }
    }

    fn may_be_held(&self, face: &PackedTriangle<R>) -> bool {
        let is_in =
            |point: Vec3<R>, normal: Vec3<R>| normal.dot(self.point - point).abs() <= self.slack;
        match self.direction {
            None => is_in(face.corners[0], face.normal),
            Some(direction) => face.corners.iter().all(|&corner| is_in(corner, direction)),
        }
    }
}

/// The bits of a face's corners, independent of winding and of which corner comes first.
fn sorted_corners<R: Real>(corners: [Vec3<R>; 3]) -> [[u64; 3]; 3] {
    let bits = |corner: Vec3<R>| corner.to_array().map(|part| part.to_f64().to_bits());
    let mut corners = corners.map(bits);
    corners.sort_unstable();
    corners
}
