//! The camera's orientation as angles, which flights and paths use instead of vectors.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::camera::Camera;

/// Largest pitch in radians: short of straight up, where yaw would be undefined.
const MAX_PITCH: f64 = 89.9 * PI / 180.0;

/// Returns the equivalent angle, in radians, from -π up to π.
pub fn wrapped_angle(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The orientation of a camera as angles in radians: R = Yaw · Pitch · Roll applied to a camera that looks along -z
/// with +y up, with the matrices of the original program (roll first).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orientation {
    /// Rotation to the right about the world's y axis, from -π to π.
    pub yaw: f64,
    /// Upward tilt, from -π/2 to π/2 (the original program's angle b, negated).
    pub pitch: f64,
    /// Roll to the right about the viewing direction, from -π to π.
    pub roll: f64,
}

impl Orientation {
    /// Returns the angles of a camera's basis.
    pub fn of(camera: &Camera) -> Self {
        let Some(basis) = camera.basis() else {
            return Self::default();
        };
        let (u, v, forward) = (basis.x_axis, basis.y_axis, -basis.z_axis);
        let horizontal = forward.x.hypot(forward.z);
        let pitch = forward.y.atan2(horizontal);
        if horizontal > 1e-9 {
            // Without yaw and pitch, u and v differ from the axes by the roll alone.
            let yaw = forward.x.atan2(-forward.z);
            let level_right = DVec3::new(yaw.cos(), 0.0, yaw.sin());
            let roll = (-level_right.dot(v)).atan2(level_right.dot(u));
            return Self {
                yaw,
                pitch,
                roll: -roll,
            };
        }
        // Looking straight up or down, yaw and roll are the same rotation: all of it is taken as yaw.
        Self {
            yaw: u.z.atan2(u.x),
            pitch,
            roll: 0.0,
        }
    }

    /// Returns the viewing direction and the up vector: perpendicular unit vectors.
    pub fn vectors(self) -> (DVec3, DVec3) {
        let Self { yaw, pitch, roll } = self;
        let forward = DVec3::new(
            yaw.sin() * pitch.cos(),
            pitch.sin(),
            -yaw.cos() * pitch.cos(),
        );
        let level_up = DVec3::new(
            -yaw.sin() * pitch.sin(),
            pitch.cos(),
            yaw.cos() * pitch.sin(),
        );
        let right = DVec3::new(yaw.cos(), 0.0, yaw.sin());
        (forward, level_up * roll.cos() + right * roll.sin())
    }

    /// Returns the camera with these angles instead of its own.
    pub fn apply(self, camera: &Camera) -> Camera {
        let (look_at, up) = self.vectors();
        Camera {
            look_at,
            up,
            ..camera.clone()
        }
    }

    /// Returns the orientation turned to the right and upwards by angles in radians. The pitch is limited to just
    /// short of straight up and down.
    #[must_use]
    pub fn turned(self, yaw: f64, pitch: f64) -> Self {
        Self {
            yaw: wrapped_angle(self.yaw + yaw),
            pitch: (self.pitch + pitch).clamp(-MAX_PITCH, MAX_PITCH),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_published_camera_has_the_published_angles() {
        let camera = Camera {
            look_at: DVec3::new(-0.25, -0.70, -0.67),
            up: DVec3::new(-0.25, 0.71, -0.65),
            ..Camera::default()
        };
        let angles = Orientation::of(&camera);
        // The report on the original program has sin b = 0.70 (pitch, downwards) and sin c = -0.35.
        assert!((angles.pitch.sin() + 0.70).abs() < 0.01, "{angles:?}");
        assert!((angles.yaw.sin() + 0.35).abs() < 0.01, "{angles:?}");
        assert!(angles.roll.abs() < 0.02, "{angles:?}");
    }

    proptest! {
        #[test]
        fn angles_and_vectors_are_each_other(yaw in -3.1..3.1_f64, pitch in -1.56..1.56_f64, roll in -3.1..3.1_f64) {
            let angles = Orientation { yaw, pitch, roll };
            let back = Orientation::of(&angles.apply(&Camera::default()));
            prop_assert!((back.yaw - yaw).abs() < 1e-9);
            prop_assert!((back.pitch - pitch).abs() < 1e-9);
            prop_assert!((back.roll - roll).abs() < 1e-9, "{} {}", back.roll, roll);
        }
    }
}
