//! The triangle.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Property, PropertyValue};
use super::plane_piece::PlanePiece;
use crate::scene::notation;

/// Smallest valid ratio of a triangle's height to its longest side; below it, rounding decides what is hit.
const MIN_RATIO: f64 = 1e-9;

/// A flat triangle, its corners clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triangle {
    /// First corner.
    #[serde(with = "notation::vector")]
    pub a: DVec3,
    /// Second corner.
    #[serde(with = "notation::vector")]
    pub b: DVec3,
    /// Third corner.
    #[serde(with = "notation::vector")]
    pub c: DVec3,
}

impl Triangle {
    /// The corners in order.
    pub fn corners(&self) -> [DVec3; 3] {
        [self.a, self.b, self.c]
    }

    /// Returns the length of the longest side and twice the area.
    fn measures(&self) -> (f64, f64) {
        let Self { a, b, c } = *self;
        let longest = (b - a).length().max((c - a).length()).max((c - b).length());
        (longest, (b - a).cross(c - a).length())
    }

    /// The length of the longest side.
    pub fn longest_side(&self) -> f64 {
        self.measures().0
    }

    /// The smallest altitude: twice the area over the longest side.
    pub fn thickness(&self) -> f64 {
        let (longest, twice_area) = self.measures();
        twice_area / longest
    }
}

impl Describe for Triangle {
    const KIND: &'static str = "Triangle";

    fn example(at: DVec3, size: f64) -> Self {
        let corner = |x: f64, y: f64| at + DVec3::new(x * size, y * size, 0.0);
        Self {
            a: corner(-0.5, -0.4),
            b: corner(0.0, 0.5),
            c: corner(0.5, -0.4),
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
        for (name, corner) in [("a", &mut self.a), ("b", &mut self.b), ("c", &mut self.c)] {
            visit(Property {
                name,
                hint: "A corner; clockwise as seen from outside",
                value: PropertyValue::Point(corner),
            });
        }
    }

    fn problem(&self) -> Option<String> {
        let (longest, twice_area) = self.measures();
        let has_area = twice_area > MIN_RATIO * longest * longest;
        (!has_area).then(|| "the triangle has no area: its corners lie on one line".to_owned())
    }

    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let Self { a, b, c } = *self;
        Some((a.min(b).min(c), a.max(b).max(c)))
    }

    fn position(&self) -> DVec3 {
        self.a
    }

    fn feature(&self) -> Option<(DVec3, f64)> {
        Some((self.a, self.thickness()))
    }

    fn plane_piece(&self) -> Option<PlanePiece> {
        PlanePiece::between(self.corners())
    }
}
