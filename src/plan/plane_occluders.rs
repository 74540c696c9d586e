//! Planes that settle once for all points which lights they hide.

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{Projection, Scene};

/// A plane, its normal turned to the eye.
pub struct PlaneOccluder {
    /// The unit normal.
    normal: DVec3,
    /// Any of its points.
    point: DVec3,
}

/// Share of the coordinates within which a point counts as on a plane: what their own rounding
/// may have moved it by.
const ON_PLANE: f64 = 1e-12;

impl PlaneOccluder {
    /// Above zero on the eye's side, below it behind the plane, zero on it.
    pub fn side(&self, point: DVec3) -> f64 {
        let height = self.normal.dot(point - self.point);
        let rounding = ON_PLANE * (point.abs().max_element() + self.point.abs().max_element());
        if height.abs() <= rounding {
            0.0
        } else {
            height
        }
    }
}

/// The planes as occluders that hide every light behind them from everything that the eye can reach,
/// and block no other light; `None` where planes have to be tested ray by ray: for parallel rays,
/// which start on both sides, for an eye on a plane, and for formulas whose failures shall show.
pub fn classify_planes(scene: &Scene, request: &RenderRequest) -> Option<Vec<PlaneOccluder>> {
    let camera = &scene.camera;
    let is_parallel = request.projection.unwrap_or(camera.projection) == Projection::Orthographic;
    if is_parallel || !request.methods.is_sound() || request.model == Model::Everything {
        return None;
    }
    let visible = scene.objects.iter().filter(|object| object.visible);
    let planes = visible.filter_map(|object| {
        let (point, normal) = object.shape.endless_plane()?;
        Some(PlaneOccluder {
            normal: normal.try_normalize()?,
            point,
        })
    });
    planes
        .map(|plane| match plane.side(camera.position) {
            0.0 => None,
            side if side < 0.0 => Some(PlaneOccluder {
                normal: -plane.normal,
                ..plane
            }),
            _ => Some(plane),
        })
        .collect()
}
