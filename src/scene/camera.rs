//! The camera as the file stores it, and the basis that its vectors span.

use serde::{Deserialize, Serialize};

use super::notation;
use crate::lanes::Vec3;

/// Where a picture is taken from, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// The eye (perspective), or the centre of the view window (orthographic).
    pub position: Vec3<f64>,
    /// Viewing direction; any length but zero.
    pub look_at: Vec3<f64>,
    /// Roughly upwards; any direction that is not along `look_at`.
    pub up: Vec3<f64>,
    /// Whether rays spread from the eye or run side by side.
    pub projection: Projection,
    /// Distance of the image plane from the eye, in image heights (perspective only).
    #[serde(with = "notation::number")]
    pub projection_distance: f64,
    /// Height of the view window in world units (orthographic only).
    #[serde(with = "notation::number")]
    pub orthographic_height: f64,
}

/// How rays leave the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Projection {
    /// From one point through every pixel.
    Perspective,
    /// Side by side.
    Orthographic,
}

/// The orthonormal basis of a camera: `u` right, `v` up, `w` towards the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    /// Right in the picture.
    pub u: Vec3<f64>,
    /// Up in the picture.
    pub v: Vec3<f64>,
    /// Against the viewing direction.
    pub w: Vec3<f64>,
}

/// A camera, ready to be asked where in its picture things are.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    basis: Basis,
    position: Vec3<f64>,
    projection: Projection,
    projection_distance: f64,
    orthographic_height: f64,
}

/// Smallest sine of the angle between `look_at` and `up` that still defines a basis.
const MIN_SINE: f64 = 1e-6;

impl Camera {
    /// w = -`look_at`, u = up × w, v = w × u, all of length 1.
    ///
    /// `None` if `look_at` or `up` has no direction or they are parallel.
    pub fn basis(&self) -> Option<Basis> {
        let w = -self.look_at.unit()?;
        let across = self.up.unit()?.cross(w);
        if across.length() < MIN_SINE {
            return None;
        }
        let u = across.unit()?;
        let v = w.cross(u).unit()?;
        Some(Basis { u, v, w })
    }

    /// Where things are in the picture. `None` without a basis.
    pub fn framing(&self) -> Option<Framing> {
        Some(Framing {
            basis: self.basis()?,
            position: self.position,
            projection: self.projection,
            projection_distance: self.projection_distance,
            orthographic_height: self.orthographic_height,
        })
    }

    /// Vertical field of view in radians (perspective): 2·atan(½ / projection distance).
    pub fn field_of_view_radians(&self) -> f64 {
        2.0 * (0.5 / self.projection_distance).atan()
    }
}

impl Framing {
    /// Place of a point in the picture, in image heights from its middle, y up; `None` behind the
    /// eye (perspective) or the view window (orthographic).
    pub fn project(&self, point: Vec3<f64>) -> Option<[f64; 2]> {
        self.place(point - self.position, self.orthographic_height)
    }

    /// Place of what is endlessly far away in a direction; `None` behind, and where rays run side by
    /// side: all of them end in one place there.
    pub fn project_direction(&self, direction: Vec3<f64>) -> Option<[f64; 2]> {
        match self.projection {
            Projection::Perspective => self.place(direction, 1.0),
            Projection::Orthographic => None,
        }
    }

    fn place(&self, arm: Vec3<f64>, height: f64) -> Option<[f64; 2]> {
        let Basis { u, v, w } = self.basis;
        let depth = -w.dot(arm);
        let scale = match self.projection {
            Projection::Perspective => self.projection_distance / depth,
            Projection::Orthographic => 1.0 / height,
        };
        let place = [u.dot(arm) * scale, v.dot(arm) * scale];
        (depth > 0.0 && place.iter().all(|part| part.is_finite())).then_some(place)
    }

    /// Origin and unit direction of the ray through a place in the picture, in image heights from
    /// its middle, y up.
    pub fn ray(&self, [x, y]: [f64; 2]) -> (Vec3<f64>, Vec3<f64>) {
        let Basis { u, v, w } = self.basis;
        match self.projection {
            Projection::Perspective => {
                let direction = u * x + v * y - w * self.projection_distance;
                (self.position, direction * (1.0 / direction.length()))
            }
            Projection::Orthographic => {
                let height = self.orthographic_height;
                (self.position + u * (x * height) + v * (y * height), -w)
            }
        }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: Vec3::new(175.0, 105.0, 14.0),
            look_at: Vec3::new(-0.25, -0.25, -0.93),
            up: Vec3::new(-0.06, 0.97, -0.25),
            projection: Projection::Perspective,
            projection_distance: 0.5625,
            orthographic_height: 200.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3<f64>> {
        let part = -1e3..1e3_f64;
        (part.clone(), part.clone(), part).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn a_basis_is_orthonormal_or_absent(look_at in vector(), up in vector()) {
            let camera = Camera { look_at, up, ..Camera::default() };
            if let Some(Basis { u, v, w }) = camera.basis() {
                for (a, b, expected) in [(u, u, 1.0), (v, v, 1.0), (w, w, 1.0), (u, v, 0.0), (v, w, 0.0), (w, u, 0.0)] {
                    prop_assert!((a.dot(b) - expected).abs() < 1e-9);
                }
                prop_assert!((u.cross(v) - w).length() < 1e-9, "right-handed");
            }
        }
    }

    #[test]
    fn what_a_ray_meets_is_seen_where_the_ray_went() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let camera = Camera {
                projection,
                ..Camera::default()
            };
            let framing = camera.framing().expect("a basis");
            for place in [[0.0, 0.0], [0.4, -0.3], [-0.5, 0.5]] {
                let (origin, direction) = framing.ray(place);
                let [x, y] = framing
                    .project(origin + direction * 70.0)
                    .expect("in front");
                assert!((x - place[0]).hypot(y - place[1]) < 1e-12, "{projection:?}");
                assert_eq!(framing.project(origin - direction * 70.0), None);
            }
        }
    }

    #[test]
    fn parallel_vectors_span_nothing() {
        let camera = Camera {
            up: Camera::default().look_at * 3.0,
            ..Camera::default()
        };
        assert_eq!(camera.basis(), None);
    }

    #[test]
    fn the_demo_sees_83_degrees() {
        assert!((Camera::default().field_of_view_radians().to_degrees() - 83.27).abs() < 0.01);
    }
}
