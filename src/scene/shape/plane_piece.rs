//! Pieces of planes: which points are on them, and which of them coincide.

use glam::DVec3;

use crate::scene::direction::unit;

/// A piece of a plane, in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePiece {
    /// A point of the plane; for a disc, its centre.
    pub point: DVec3,
    /// The unit normal.
    pub normal: DVec3,
    /// The shape of the piece within the plane.
    pub outline: Outline,
}

/// The shape of a piece of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// The whole plane.
    Endless,
    /// The triangle with these corners.
    Triangle([DVec3; 3]),
    /// The disc of this radius around [`PlanePiece::point`].
    Disc(f64),
}

/// Largest distance from a plane, as a share of the coordinates, of a point that counts as on it: how far rounding
/// of the coordinates may have moved it.
const ON_PLANE: f64 = 1e-12;

/// Sine of the angle to a normal below which a direction counts as parallel to it.
const ALONG_NORMAL: f64 = 1e-12;

/// Distance, as a share of the coordinates, below which two surfaces count as one: single precision cannot tell
/// them apart.
const SAME_PLANE: f64 = 4.0 / (1 << 24) as f64;

/// Share of the smaller size by which two pieces must reach across each other's borders to overlap: neighbours
/// share their borders.
const MIN_OVERLAP: f64 = 1e-6;

impl PlanePiece {
    /// Returns the triangle between three corners; `None` if it has no area.
    pub fn between(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        Some(Self {
            point: a,
            normal: unit((b - a).cross(c - a))?,
            outline: Outline::Triangle(corners),
        })
    }

    /// Returns the signed distance from the plane, in world units: positive on the side of the normal, and exactly
    /// zero within rounding.
    pub fn height(&self, point: DVec3) -> f64 {
        let height = self.normal.dot(point - self.point);
        let rounding = ON_PLANE * (point.abs().max_element() + self.point.abs().max_element());
        if height.abs() <= rounding {
            0.0
        } else {
            height
        }
    }

    /// Returns the distance of a point from the border, in world units; infinity for a whole plane.
    pub fn distance_of_border(&self, point: DVec3) -> f64 {
        match self.outline {
            Outline::Endless => f64::INFINITY,
            Outline::Triangle([a, b, c]) => {
                let distance = |(from, to): (DVec3, DVec3)| {
                    let side = to - from;
                    let share = (point - from).dot(side) / side.length_squared();
                    (from + side * share.clamp(0.0, 1.0) - point).length()
                };
                let sides = [(a, b), (b, c), (c, a)];
                sides
                    .map(distance)
                    .into_iter()
                    .fold(f64::INFINITY, f64::min)
            }
            Outline::Disc(radius) => {
                let offset = point - self.point;
                let height = self.normal.dot(offset);
                let along = (offset - self.normal * height).length();
                height.hypot(along - radius)
            }
        }
    }

    /// Returns whether a unit direction is perpendicular to the plane.
    pub fn is_perpendicular_to(&self, direction: DVec3) -> bool {
        direction.cross(self.normal).length() <= ALONG_NORMAL
    }

    /// Returns the largest distance from the plane, in world units, at which points count as on it, if their
    /// coordinates relative to `centre` are at most `farthest`.
    pub fn plane_tolerance(&self, centre: DVec3, farthest: f64) -> f64 {
        SAME_PLANE * farthest.max((self.point - centre).abs().max_element())
    }

    /// Returns whether both cover some common area of the same plane. Rounding is estimated from coordinates
    /// relative to `centre`.
    pub fn coincides(&self, other: &Self, centre: DVec3) -> bool {
        // The normal of the larger piece is more accurate.
        let (small, large) = if self.size() < other.size() {
            (self, other)
        } else {
            (other, self)
        };
        let reach = |point: &DVec3| (*point - centre).abs().max_element();
        let points = small.points();
        let farthest = points.iter().map(reach).fold(reach(&large.point), f64::max);
        small.lies_over(large, SAME_PLANE * farthest)
    }

    /// Returns whether all of this piece is within `height` world units of the plane of `large`, which is no
    /// smaller, and part of it is in front of or behind `large`.
    fn lies_over(&self, large: &Self, height: f64) -> bool {
        let is_in = |point: &DVec3| large.normal.dot(*point - large.point).abs() <= height;
        self.points().iter().all(is_in) && self.overlaps(large, large.normal)
    }

    /// Returns whether all of the smaller piece is within `height` world units of the plane of the larger one, and
    /// they overlap.
    pub fn is_layered_with(&self, other: &Self, height: f64) -> bool {
        if self.size() < other.size() {
            self.lies_over(other, height)
        } else {
            other.lies_over(self, height)
        }
    }

    /// A measure of size for comparing pieces; infinity for a whole plane.
    fn size(&self) -> f64 {
        match self.outline {
            Outline::Endless => f64::INFINITY,
            Outline::Triangle([a, b, c]) => (b - a).length().max((c - a).length()),
            Outline::Disc(radius) => radius,
        }
    }

    /// Returns three points that are not collinear; those of a whole plane are one unit apart.
    fn points(&self) -> [DVec3; 3] {
        let radius = match self.outline {
            Outline::Triangle(corners) => return corners,
            Outline::Endless => 1.0,
            Outline::Disc(radius) => radius,
        };
        let (across, along) = self.normal.any_orthonormal_pair();
        [DVec3::ZERO, across, along].map(|direction| self.point + direction * radius)
    }

    /// Returns whether two pieces of the same plane share an area: no line in the plane separates them. A
    /// separating line is parallel to an edge, or perpendicular to the line from a disc's centre to the nearest
    /// point of the other.
    fn overlaps(&self, other: &Self, normal: DVec3) -> bool {
        let border = MIN_OVERLAP * self.size().min(other.size());
        let separating_axes = self
            .separating_axes(other, normal)
            .chain(other.separating_axes(self, normal));
        let mut separating_axes = separating_axes.filter_map(DVec3::try_normalize);
        separating_axes.all(|direction| {
            let (own, theirs) = (self.interval(direction), other.interval(direction));
            own.0 + border < theirs.1 && theirs.0 + border < own.1
        })
    }

    /// Returns the normals of lines that may separate this piece from another one; their lengths are arbitrary.
    fn separating_axes(&self, other: &Self, normal: DVec3) -> impl Iterator<Item = DVec3> {
        let separating_axes = match (self.outline, other.outline) {
            (Outline::Endless, _) => [DVec3::ZERO; 3],
            (Outline::Triangle([a, b, c]), _) => {
                [b - a, c - b, a - c].map(|side| side.cross(normal))
            }
            (Outline::Disc(_), Outline::Triangle(corners)) => {
                corners.map(|corner| corner - self.point)
            }
            (Outline::Disc(_), _) => [other.point - self.point; 3],
        };
        separating_axes.into_iter()
    }

    /// Returns the interval that the piece covers along a unit direction in its plane.
    fn interval(&self, direction: DVec3) -> (f64, f64) {
        match self.outline {
            Outline::Endless => (f64::NEG_INFINITY, f64::INFINITY),
            Outline::Triangle(corners) => {
                let [a, b, c] = corners.map(|corner| direction.dot(corner));
                (a.min(b).min(c), a.max(b).max(c))
            }
            Outline::Disc(radius) => {
                let middle = direction.dot(self.point);
                (middle - radius, middle + radius)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 2]; 3]) -> PlanePiece {
        let corners = corners.map(|[x, z]| DVec3::new(x, 0.0, z));
        PlanePiece::between(corners).expect("an area")
    }

    fn disc(x: f64, z: f64, radius: f64) -> PlanePiece {
        PlanePiece {
            point: DVec3::new(x, 0.0, z),
            normal: DVec3::Y,
            outline: Outline::Disc(radius),
        }
    }

    fn coincide(one: PlanePiece, other: PlanePiece) -> bool {
        let there = one.coincides(&other, DVec3::ZERO);
        assert_eq!(there, other.coincides(&one, DVec3::ZERO));
        there
    }

    #[test]
    fn neighbours_share_a_border_and_no_area() {
        let half = triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!(coincide(half, half));
        let other_half = triangle([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert!(!coincide(half, other_half));
        assert!(coincide(
            half,
            triangle([[0.9, 0.0], [1.0, 1.0], [0.0, 0.9]])
        ));
        assert!(!coincide(disc(-1.0, 0.5, 1.0), half), "it touches a side");
        assert!(coincide(disc(-1.0, 0.5, 1.001), half));
        assert!(!coincide(disc(1.0, 1.0, 0.7), half), "before the long side");
        assert!(coincide(disc(1.0, 1.0, 0.72), half));
        assert!(!coincide(disc(-0.72, -0.72, 1.0), half), "before a corner");
        assert!(!coincide(disc(0.0, 0.0, 1.0), disc(2.0, 0.0, 1.0)));
        assert!(coincide(disc(0.0, 0.0, 1.0), disc(1.9, 0.0, 1.0)));
    }

    #[test]
    fn pieces_a_hair_apart_are_beside_each_other_where_they_overlap() {
        let rug = disc(0.0, 0.0, 1.0);
        let lifted = |x: f64, height: f64| PlanePiece {
            point: DVec3::new(x, height, 0.0),
            ..rug
        };
        assert!(
            rug.is_layered_with(&lifted(0.5, 1e-3), 2e-3)
                && lifted(0.5, 1e-3).is_layered_with(&rug, 2e-3)
        );
        assert!(!rug.is_layered_with(&lifted(0.5, 3e-3), 2e-3), "too far");
        assert!(
            !rug.is_layered_with(&lifted(2.1, 1e-3), 2e-3),
            "side by side"
        );
    }

    #[test]
    fn a_border_is_as_far_as_its_nearest_side_corner_or_rim() {
        let piece = triangle([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]);
        for (point, expected) in [
            ([1.0, 0.0, 0.5], 0.5),
            ([2.0, 3.0, -4.0], 5.0),
            ([-3.0, 0.0, -4.0], 5.0),
            ([4.0, 0.0, 3.0], 2.4),
        ] {
            let distance = piece.distance_of_border(point.into());
            assert!((distance - expected).abs() < 1e-12, "{point:?} {distance}");
        }
        let distance =
            |x: f64, y: f64| disc(1.0, 0.0, 2.0).distance_of_border(DVec3::new(x, y, 0.0));
        assert_eq!(distance(1.0, 0.0), 2.0);
        assert_eq!((distance(6.0, 4.0), distance(2.5, 0.0)), (5.0, 0.5));
    }

    #[test]
    fn what_is_higher_or_leans_lies_in_no_floor() {
        let floor = PlanePiece {
            outline: Outline::Endless,
            ..disc(7.0, 7.0, 1.0)
        };
        let rug = disc(0.0, 0.0, 1.0);
        assert!(coincide(rug, floor) && coincide(floor, floor));
        let moved = |height: f64| PlanePiece {
            point: rug.point + DVec3::Y * height,
            ..rug
        };
        assert!(!coincide(moved(1e-5), floor));
        assert!(
            coincide(moved(1e-8), floor),
            "single precision sees no difference"
        );
        let leaning = PlanePiece {
            normal: DVec3::new(1e-4, 1.0, 0.0).normalize(),
            ..rug
        };
        assert!(!coincide(leaning, floor));
    }
}
