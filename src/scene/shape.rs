//! The primitives as the file stores them.

use serde::{Deserialize, Serialize};

use glam::DVec3;

use super::notation;

/// A primitive: all numbers in world units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Its middle.
        #[serde(with = "notation::vector")]
        center: DVec3,
        /// > 0.
        #[serde(with = "notation::number")]
        radius: f64,
    },
    /// An endless plane.
    Plane {
        /// Any point on it.
        #[serde(with = "notation::vector")]
        point: DVec3,
        /// Across it; any length but zero.
        #[serde(with = "notation::vector")]
        normal: DVec3,
    },
    /// A flat triangle, its corners clockwise seen from outside.
    Triangle {
        /// First corner.
        #[serde(with = "notation::vector")]
        a: DVec3,
        /// Second corner.
        #[serde(with = "notation::vector")]
        b: DVec3,
        /// Third corner.
        #[serde(with = "notation::vector")]
        c: DVec3,
    },
}

impl Shape {
    /// The name of the kind, as the file writes it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Sphere { .. } => "Sphere",
            Self::Plane { .. } => "Plane",
            Self::Triangle { .. } => "Triangle",
        }
    }

    /// One shape of every kind, of the given size around `at`: what "Add" offers.
    pub fn examples(at: DVec3, size: f64) -> [Self; 3] {
        let corner = |x: f64, y: f64| at + DVec3::new(x * size, y * size, 0.0);
        [
            Self::Sphere {
                center: at,
                radius: size / 2.0,
            },
            Self::Plane {
                point: at,
                normal: DVec3::new(0.0, 1.0, 0.0),
            },
            Self::Triangle {
                a: corner(-0.5, -0.4),
                b: corner(0.0, 0.5),
                c: corner(0.5, -0.4),
            },
        ]
    }

    /// Smallest and largest corner of the box around the shape; `None` for what never ends.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Sphere { center, radius } => {
                let reach = DVec3::splat(*radius);
                Some((*center - reach, *center + reach))
            }
            Self::Plane { .. } => None,
            Self::Triangle { a, b, c } => Some((a.min(*b).min(*c), a.max(*b).max(*c))),
        }
    }

    /// Where it is: the middle of a sphere, the point of a plane, the first corner of a triangle.
    pub fn position(&self) -> DVec3 {
        match *self {
            Self::Sphere { center, .. } => center,
            Self::Plane { point, .. } => point,
            Self::Triangle { a, .. } => a,
        }
    }

    /// The same shape, moved.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        match *self {
            Self::Sphere { center, radius } => Self::Sphere {
                center: center + by,
                radius,
            },
            Self::Plane { point, normal } => Self::Plane {
                point: point + by,
                normal,
            },
            Self::Triangle { a, b, c } => Self::Triangle {
                a: a + by,
                b: b + by,
                c: c + by,
            },
        }
    }
}
