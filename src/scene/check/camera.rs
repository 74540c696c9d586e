//! Whether a camera means something.

use super::place::{At, Check};
use crate::scene::camera::Camera;

/// Projection distances (image heights) between which directions keep single-precision meaning.
pub const PROJECTION_DISTANCES: (f64, f64) = (1e-3, 1e5);

/// Refuses a camera that sees nothing.
pub fn check_camera(at: &At, camera: &Camera) -> Check {
    at.field("position").point(camera.position)?;
    at.field("look_at").direction(camera.look_at)?;
    at.field("up").direction(camera.up)?;
    if camera.basis().is_none() {
        return at
            .field("up")
            .refuse("up must not be parallel to look_at".to_owned());
    }
    let (nearest, farthest) = PROJECTION_DISTANCES;
    at.field("projection_distance")
        .within(camera.projection_distance, nearest, farthest)?;
    at.field("orthographic_height")
        .positive(camera.orthographic_height)
}
