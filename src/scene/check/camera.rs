//! Validation of cameras.

use std::ops::RangeInclusive;

use super::place::{At, Check};
use crate::scene::camera::Camera;

/// Valid projection distances, in image heights: beyond them, directions are too inaccurate in single precision.
pub const PROJECTION_DISTANCES: RangeInclusive<f64> = 1e-3..=1e5;

/// Rejects invalid cameras.
pub fn check_camera(at: &At, camera: &Camera) -> Check {
    at.field("position").point(camera.position)?;
    at.field("look_at").direction(camera.look_at)?;
    at.field("up").direction(camera.up)?;
    if camera.basis().is_none() {
        return at
            .field("up")
            .refuse("up must not be parallel to look_at".to_owned());
    }
    check_lens(at, camera.projection_distance, camera.orthographic_height)
}

/// Rejects projection distances and window heights out of range.
pub fn check_lens(at: &At, projection_distance: f64, orthographic_height: f64) -> Check {
    at.field("projection_distance")
        .within(projection_distance, PROJECTION_DISTANCES)?;
    at.field("orthographic_height")
        .positive(orthographic_height)
}
