//! Planes that block a light for everything visible or for nothing.

use glam::DVec3;

use super::closeness::visible_planes;
use super::request::{Model, RenderRequest};
use crate::scene::{PlanePiece, Scene};

/// A plane of which only one side can be seen.
pub struct PlaneOccluder {
    piece: PlanePiece,
    /// Whether its normal points away from the eye.
    is_turned: bool,
}

impl PlaneOccluder {
    /// Returns a positive number on the eye's side, a negative one behind the plane, zero on it.
    pub fn side(&self, point: DVec3) -> f64 {
        let height = self.piece.height(point);
        if self.is_turned { -height } else { height }
    }
}

/// Returns the planes as occluders that hide every light behind them from everything that the eye can reach and
/// block no other light. Returns `None` if planes must be tested per ray: for parallel rays, which start on both
/// sides, for an eye on a plane, and for formulas whose failures must show.
pub fn classify_planes(scene: &Scene, request: &RenderRequest) -> Option<Vec<PlaneOccluder>> {
    let camera = &scene.camera;
    if request.is_parallel(camera)
        || !request.methods.is_sound()
        || request.model == Model::Everything
    {
        return None;
    }
    visible_planes(scene)
        .map(|piece| {
            let height = piece.height(camera.position);
            let is_turned = height < 0.0;
            (height != 0.0).then_some(PlaneOccluder { piece, is_turned })
        })
        .collect()
}
