//! The camera as stored in the file, and the coordinate frame that its vectors define.

use serde::{Deserialize, Serialize};

use glam::{DAffine3, DMat3, DVec3};

use super::direction::unit;
use super::notation;

/// Least height of an orthographic picture that the editor sets, in world units: the limit of zooming in.
pub const MIN_ORTHOGRAPHIC_HEIGHT: f64 = 1e-6;

/// Position, orientation and projection of the camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Camera {
    /// The eye (perspective), or the centre of the view window (orthographic).
    #[serde(with = "notation::vector")]
    pub position: DVec3,
    /// Viewing direction; any length but zero.
    #[serde(with = "notation::vector")]
    pub look_at: DVec3,
    /// Roughly the upward direction; any vector that is not parallel to `look_at`.
    #[serde(with = "notation::vector")]
    pub up: DVec3,
    /// The kind of projection.
    pub projection: Projection,
    /// Distance of the image plane from the eye, in image heights (perspective only).
    #[serde(with = "notation::number")]
    pub projection_distance: f64,
    /// Height of the view window in world units (orthographic only).
    #[serde(with = "notation::number")]
    pub orthographic_height: f64,
}

/// A saved view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bookmark {
    /// Name of the view.
    pub name: String,
    /// The camera.
    pub camera: Camera,
}

/// The kind of projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Projection {
    /// Rays spread from the eye through every pixel.
    Perspective,
    /// Rays are parallel.
    Orthographic,
}

/// A camera prepared for projecting points into its picture.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    /// Transform from camera to world coordinates.
    frame: DAffine3,
    projection: Projection,
    projection_distance: f64,
    orthographic_height: f64,
}

/// Factor by which a framed sphere is enlarged, to leave a margin around it.
const FRAMING_MARGIN: f64 = 1.15;
/// Smallest sine of the angle between `look_at` and `up` that still defines a basis.
const MIN_SINE: f64 = 1e-6;
/// Largest difference that rounding may cause, in directions, and in positions as a share of their coordinates.
const SAME_VIEW: f64 = 1e-9;

impl Camera {
    /// The orthonormal basis of the camera as the columns of a matrix: x = up × z to the right of the
    /// picture, y = z × x upwards, z = -`look_at` towards the viewer.
    ///
    /// `None` if `look_at` or `up` has no direction or they are parallel.
    pub fn basis(&self) -> Option<DMat3> {
        let w = -unit(self.look_at)?;
        let across = unit(self.up)?.cross(w);
        if across.length() < MIN_SINE {
            return None;
        }
        let u = across.try_normalize()?;
        let v = w.cross(u).try_normalize()?;
        Some(DMat3::from_cols(u, v, w))
    }

    /// Returns whether both cameras see the same up to rounding.
    pub fn is_like(&self, other: &Self) -> bool {
        let size = self.position.abs().max_element().max(1.0);
        let is_near = |one: DVec3, other: DVec3| one.abs_diff_eq(other, SAME_VIEW);
        let moved = Self {
            position: other.position,
            look_at: other.look_at,
            up: other.up,
            ..self.clone()
        };
        moved == *other
            && is_near(self.position / size, other.position / size)
            && is_near(self.look_at, other.look_at)
            && is_near(self.up, other.up)
    }

    /// Returns the mapping between world and picture. `None` without a basis.
    pub fn framing(&self) -> Option<Framing> {
        Some(Framing {
            frame: DAffine3::from_mat3_translation(self.basis()?, self.position),
            projection: self.projection,
            projection_distance: self.projection_distance,
            orthographic_height: self.orthographic_height,
        })
    }

    /// The viewing direction as a unit vector; zero for a camera without one.
    pub fn forward(&self) -> DVec3 {
        unit(self.look_at).unwrap_or_default()
    }

    /// Returns the camera moved so that all of a box, given by two corners, is in the picture of this aspect ratio
    /// (width over height). The viewing direction is unchanged.
    #[must_use]
    pub fn around(&self, aspect: f64, (low, high): (DVec3, DVec3)) -> Self {
        let (middle, radius) = (
            low.midpoint(high),
            (high - low).length() * 0.5 * FRAMING_MARGIN,
        );
        let forward = self.forward();
        let mut next = self.clone();
        // The shorter side of the picture, in picture heights.
        let side = aspect.min(1.0);
        let distance = match self.projection {
            Projection::Perspective => {
                radius / (0.5 * side / self.projection_distance).atan().sin()
            }
            Projection::Orthographic => {
                next.orthographic_height = 2.0 * radius / side;
                (middle - self.position).dot(forward).max(2.0 * radius)
            }
        };
        next.position = middle - forward * distance;
        next
    }

    /// Vertical field of view in radians (perspective): 2·atan(½ / projection distance).
    pub fn field_of_view_radians(&self) -> f64 {
        field_of_view_radians(self.projection_distance)
    }
}

/// The vertical field of view in radians at a projection distance in image heights.
pub fn field_of_view_radians(projection_distance: f64) -> f64 {
    2.0 * (0.5 / projection_distance).atan()
}

impl Framing {
    /// Returns the position of a point in the picture, in image heights from its centre, y up; `None` behind the
    /// eye (perspective) or the view window (orthographic).
    pub fn project(&self, point: DVec3) -> Option<[f64; 2]> {
        self.picture_position(point - self.frame.translation, self.orthographic_height)
    }

    /// Returns the position in the picture of a point at infinity in this direction. `None` behind the eye, and in
    /// orthographic projection, where all such points coincide.
    pub fn project_direction(&self, direction: DVec3) -> Option<[f64; 2]> {
        match self.projection {
            Projection::Perspective => self.picture_position(direction, 1.0),
            Projection::Orthographic => None,
        }
    }

    fn picture_position(&self, offset: DVec3, height: f64) -> Option<[f64; 2]> {
        let in_camera = self.frame.matrix3.transpose_mul_vec3(offset);
        let depth = -in_camera.z;
        let scale = match self.projection {
            Projection::Perspective => self.projection_distance / depth,
            Projection::Orthographic => 1.0 / height,
        };
        let position = [in_camera.x * scale, in_camera.y * scale];
        (depth > 0.0 && position.iter().all(|part| part.is_finite())).then_some(position)
    }

    /// Returns the origin and unit direction of the ray through a position in the picture, in image heights from
    /// its centre, y up.
    pub fn ray(&self, [x, y]: [f64; 2]) -> (DVec3, DVec3) {
        let DAffine3 {
            matrix3: basis,
            translation: eye,
        } = self.frame;
        match self.projection {
            Projection::Perspective => {
                let direction = basis * DVec3::new(x, y, -self.projection_distance);
                (eye, direction * (1.0 / direction.length()))
            }
            Projection::Orthographic => {
                let window = DVec3::new(x, y, 0.0) * self.orthographic_height;
                (eye + basis * window, -basis.z_axis)
            }
        }
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: DVec3::new(175.0, 105.0, 14.0),
            look_at: DVec3::new(-0.25, -0.25, -0.93),
            up: DVec3::new(-0.06, 0.97, -0.25),
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

    fn vector() -> impl Strategy<Value = DVec3> {
        let part = -1e3..1e3_f64;
        (part.clone(), part.clone(), part).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn a_basis_is_orthonormal_or_absent(look_at in vector(), up in vector()) {
            let camera = Camera { look_at, up, ..Camera::default() };
            if let Some(basis) = camera.basis() {
                let (u, v, w) = (basis.x_axis, basis.y_axis, basis.z_axis);
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
            for position in [[0.0, 0.0], [0.4, -0.3], [-0.5, 0.5]] {
                let (origin, direction) = framing.ray(position);
                let [x, y] = framing
                    .project(origin + direction * 70.0)
                    .expect("in front");
                assert!(
                    (x - position[0]).hypot(y - position[1]) < 1e-12,
                    "{projection:?}"
                );
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
