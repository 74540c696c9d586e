//! Flying: keeps the camera's angles in double precision, and derives its vectors from them.

use glam::DVec3;

use crate::scene::{Camera, MAX_COORDINATE, MIN_ORTHOGRAPHIC_HEIGHT, Orientation, Projection};

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
    /// Zoom of an orthographic picture, as the natural logarithm of the factor by which its height shrinks: moving
    /// closer would not enlarge it.
    pub zoom: f64,
}

impl Motion {
    /// The sum of two motions.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            forward: self.forward + other.forward,
            right: self.right + other.right,
            up: self.up + other.up,
            yaw: self.yaw + other.yaw,
            pitch: self.pitch + other.pitch,
            zoom: self.zoom + other.zoom,
        }
    }

    /// The motion with its distances scaled by `distance`, and its turns and zoom by `turn`.
    #[must_use]
    pub fn times(&self, distance: f64, turn: f64) -> Self {
        Self {
            forward: self.forward * distance,
            right: self.right * distance,
            up: self.up * distance,
            yaw: self.yaw * turn,
            pitch: self.pitch * turn,
            zoom: self.zoom * turn,
        }
    }
}

/// Sets the height of the view window (orthographic) as near to this one as is valid.
pub fn set_orthographic_height(camera: &mut Camera, height: f64) {
    camera.orthographic_height = height.clamp(MIN_ORTHOGRAPHIC_HEIGHT, MAX_COORDINATE);
}

/// The angles of the camera as last computed, so that a long flight never derives them from rounded vectors again.
#[derive(Clone, Debug, Default)]
pub(super) struct Flight {
    last: Option<(Orientation, DVec3, DVec3)>,
}

impl Flight {
    pub fn orientation(&self, camera: &Camera) -> Orientation {
        match self.last {
            Some((angles, look_at, up)) if look_at == camera.look_at && up == camera.up => angles,
            _ => Orientation::of(camera),
        }
    }

    /// The camera after a step: first turned, then moved along its new axes.
    pub fn step(&mut self, camera: &Camera, motion: &Motion) -> Camera {
        let mut next = camera.clone();
        if motion.yaw != 0.0 || motion.pitch != 0.0 {
            let angles = self.orientation(camera).turned(motion.yaw, motion.pitch);
            next = angles.apply(camera);
            self.last = Some((angles, next.look_at, next.up));
        }
        if let Some(basis) = next.basis() {
            let up = DVec3::new(0.0, motion.up, 0.0);
            next.position += basis.x_axis * motion.right + up;
            match next.projection {
                Projection::Perspective => next.position -= basis.z_axis * motion.forward,
                Projection::Orthographic => {
                    let height = next.orthographic_height * (-motion.zoom).exp();
                    set_orthographic_height(&mut next, height);
                }
            }
        }
        next
    }

    /// The camera after orbiting a point, which stays in its place in the picture; yaw to the right and pitch
    /// upwards, in radians.
    pub fn orbit(&mut self, camera: &Camera, about: DVec3, (yaw, pitch): (f64, f64)) -> Camera {
        let turn = Motion {
            yaw,
            pitch,
            ..Motion::default()
        };
        let mut next = self.step(camera, &turn);
        if let (Some(from), Some(to)) = (camera.basis(), next.basis()) {
            next.position = about + to * from.transpose().mul_vec3(camera.position - about);
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn what_is_circled_stays_where_it_is_in_the_picture() {
        let (mut flight, mut camera) = (Flight::default(), Camera::default());
        let about = camera.position + DVec3::new(-40.0, -60.0, -90.0);
        let place = |camera: &Camera| camera.framing().and_then(|framing| framing.project(about));
        let (before, distance) = (place(&camera), camera.position.distance(about));
        for turn in [(0.4, 0.1), (-2.0, 3.0), (0.1, -0.7)] {
            camera = flight.orbit(&camera, about, turn);
            let [x, y] = place(&camera).expect("in front");
            let [was_x, was_y] = before.expect("in front");
            assert!((x - was_x).hypot(y - was_y) < 1e-9, "{turn:?}");
            assert!((camera.position.distance(about) - distance).abs() < 1e-9);
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
            assert!(camera.basis().expect("a basis").y_axis.y > 0.0);
        }
        assert!((flight.orientation(&camera).pitch.to_degrees() - 89.9).abs() < 1e-9);
    }

    #[test]
    fn steps_go_where_the_picture_says() {
        let level = Camera {
            look_at: DVec3::new(0.0, 0.0, -1.0),
            up: DVec3::new(0.0, 1.0, 0.0),
            position: DVec3::new(0.0, 0.0, 0.0),
            ..Camera::default()
        };
        let step = |motion: Motion| Flight::default().step(&level, &motion);
        let motion = Motion {
            forward: 2.0,
            right: 3.0,
            up: 4.0,
            ..Motion::default()
        };
        assert_eq!(step(motion).position, DVec3::new(3.0, 4.0, -2.0));
        let flat = Camera {
            projection: Projection::Orthographic,
            ..level.clone()
        };
        let zoom = 2.0_f64.ln();
        let nearer = Flight::default().step(&flat, &Motion { zoom, ..motion });
        let height = flat.orthographic_height / 2.0;
        assert!((nearer.orthographic_height - height).abs() < 1e-9 * height);
        assert_eq!(nearer.position, DVec3::new(3.0, 4.0, 0.0));
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
}
