//! Flying: the camera's angles, kept in double precision, and its vectors rebuilt from them.

use std::f64::consts::{PI, TAU};

use crate::lanes::Vec3;
use crate::scene::{Basis, Camera};

/// Steepest pitch: short of straight up, where yaw would lose its meaning.
const MAX_PITCH: f64 = 89.9 * PI / 180.0;

/// The angles of a camera in radians: R = Yaw · Pitch · Roll applied to a camera that looks along
/// -z with +y up, with the matrices of the program that Glint grew from (roll first).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orientation {
    /// Turn to the right about the world's y axis, from -π to π.
    pub yaw: f64,
    /// Upward tilt, from -π/2 to π/2 (the ancestor's angle b, negated).
    pub pitch: f64,
    /// Lean to the right about the viewing direction, from -π to π.
    pub roll: f64,
}

/// A step of a flight: distances in world units, turns in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Along the viewing direction.
    pub forward: f64,
    /// To the right in the picture.
    pub right: f64,
    /// Along the world's y axis.
    pub up: f64,
    /// Turn to the right.
    pub yaw: f64,
    /// Tilt upwards.
    pub pitch: f64,
}

impl Motion {
    /// Both motions at once.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            forward: self.forward + other.forward,
            right: self.right + other.right,
            up: self.up + other.up,
            yaw: self.yaw + other.yaw,
            pitch: self.pitch + other.pitch,
        }
    }

    /// The motion with its distances and its turns scaled.
    #[must_use]
    pub fn times(&self, distance: f64, turn: f64) -> Self {
        Self {
            forward: self.forward * distance,
            right: self.right * distance,
            up: self.up * distance,
            yaw: self.yaw * turn,
            pitch: self.pitch * turn,
        }
    }
}

/// The angles of the camera as last written, so that a long flight never derives them from rounded
/// vectors again.
#[derive(Clone, Debug, Default)]
pub(super) struct Flight {
    last: Option<(Orientation, Vec3<f64>, Vec3<f64>)>,
}

impl Orientation {
    /// The angles of a camera's basis.
    pub fn of(camera: &Camera) -> Self {
        let Some(Basis { u, v, w }) = camera.basis() else {
            return Self::default();
        };
        let look = -w;
        let level = look.x.hypot(look.z);
        let pitch = look.y.atan2(level);
        if level > 1e-9 {
            // With yaw and pitch taken away, u and v are turned by the roll alone.
            let yaw = look.x.atan2(-look.z);
            let flat = Vec3::new(yaw.cos(), 0.0, yaw.sin());
            let roll = (-flat.dot(v)).atan2(flat.dot(u));
            return Self {
                yaw,
                pitch,
                roll: -roll,
            };
        }
        // Straight up or down, yaw and roll are one: call it yaw.
        Self {
            yaw: u.z.atan2(u.x),
            pitch,
            roll: 0.0,
        }
    }

    /// Viewing direction and up vector, both of length 1 and at right angles.
    pub fn vectors(self) -> (Vec3<f64>, Vec3<f64>) {
        let Self { yaw, pitch, roll } = self;
        let look = Vec3::new(
            yaw.sin() * pitch.cos(),
            pitch.sin(),
            -yaw.cos() * pitch.cos(),
        );
        let level_up = Vec3::new(
            -yaw.sin() * pitch.sin(),
            pitch.cos(),
            yaw.cos() * pitch.sin(),
        );
        let right = Vec3::new(yaw.cos(), 0.0, yaw.sin());
        (look, level_up * roll.cos() + right * roll.sin())
    }

    /// The camera with these angles in place of its own.
    pub fn apply(self, camera: &Camera) -> Camera {
        let (look_at, up) = self.vectors();
        Camera {
            look_at,
            up,
            ..camera.clone()
        }
    }

    fn turned(self, yaw: f64, pitch: f64) -> Self {
        Self {
            yaw: (self.yaw + yaw + PI).rem_euclid(TAU) - PI,
            pitch: (self.pitch + pitch).clamp(-MAX_PITCH, MAX_PITCH),
            ..self
        }
    }
}

impl Flight {
    pub fn orientation(&self, camera: &Camera) -> Orientation {
        match self.last {
            Some((angles, look_at, up)) if look_at == camera.look_at && up == camera.up => angles,
            _ => Orientation::of(camera),
        }
    }

    /// The camera after a step: turned, then moved in its new directions.
    pub fn step(&mut self, camera: &Camera, motion: &Motion) -> Camera {
        let mut next = camera.clone();
        if motion.yaw != 0.0 || motion.pitch != 0.0 {
            let angles = self.orientation(camera).turned(motion.yaw, motion.pitch);
            next = angles.apply(camera);
            self.last = Some((angles, next.look_at, next.up));
        }
        if let Some(Basis { u, w, .. }) = next.basis() {
            let up = Vec3::new(0.0, motion.up, 0.0);
            next.position = next.position - w * motion.forward + u * motion.right + up;
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_published_camera_has_the_published_angles() {
        let camera = Camera {
            look_at: Vec3::new(-0.25, -0.70, -0.67),
            up: Vec3::new(-0.25, 0.71, -0.65),
            ..Camera::default()
        };
        let angles = Orientation::of(&camera);
        // sin b = 0.70 (its pitch, downwards) and sin c = -0.35 are what its report shows.
        assert!((angles.pitch.sin() + 0.70).abs() < 0.01, "{angles:?}");
        assert!((angles.yaw.sin() + 0.35).abs() < 0.01, "{angles:?}");
        assert!(angles.roll.abs() < 0.02, "{angles:?}");
    }

    #[test]
    fn a_million_mouse_moves_do_not_wear_the_basis_out() {
        let mut flight = Flight::default();
        let mut camera = Camera::default();
        for n in 0..1_000_000_u32 {
            let wobble = f64::from(n % 1000) / 1000.0 - 0.4995;
            let motion = Motion {
                yaw: 0.0017,
                pitch: wobble * 0.01,
                ..Motion::default()
            };
            camera = flight.step(&camera, &motion);
        }
        let (look, up) = (camera.look_at, camera.up);
        for error in [look.dot(look) - 1.0, up.dot(up) - 1.0, look.dot(up)] {
            assert!(error.abs() <= 1e-12, "{error:e}");
        }
    }

    #[test]
    fn pitch_never_flips() {
        let mut flight = Flight::default();
        let mut camera = Camera::default();
        for _ in 0..100 {
            camera = flight.step(
                &camera,
                &Motion {
                    pitch: 0.1,
                    ..Motion::default()
                },
            );
            assert!(camera.basis().expect("a basis").v.y > 0.0);
        }
        assert!((flight.orientation(&camera).pitch - MAX_PITCH).abs() < 1e-12);
    }

    #[test]
    fn steps_go_where_the_picture_says() {
        let level = Camera {
            look_at: Vec3::new(0.0, 0.0, -1.0),
            up: Vec3::new(0.0, 1.0, 0.0),
            position: Vec3::new(0.0, 0.0, 0.0),
            ..Camera::default()
        };
        let step = |motion: Motion| Flight::default().step(&level, &motion);
        let motion = Motion {
            forward: 2.0,
            right: 3.0,
            up: 4.0,
            ..Motion::default()
        };
        assert_eq!(step(motion).position, Vec3::new(3.0, 4.0, -2.0));
        let right = step(Motion {
            yaw: 0.1,
            ..Motion::default()
        });
        assert!(
            right.look_at.x > 0.0,
            "a turn to the right looks to the right"
        );
        let up = step(Motion {
            pitch: 0.1,
            ..Motion::default()
        });
        assert!(up.look_at.y > 0.0, "a tilt upwards looks up");
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
