//! Pieces of planes: what lies in them, and which of them lie in each other.

use glam::DVec3;

/// A piece of a plane, in world units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePiece {
    /// A point of the plane.
    pub point: DVec3,
    /// The unit vector across it.
    pub normal: DVec3,
    /// How far it reaches.
    pub outline: Outline,
}

/// How far a piece of a plane reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// All of the plane.
    Endless,
    /// What is between these corners.
    Triangle([DVec3; 3]),
    /// So far from [`PlanePiece::point`].
    Disc(f64),
}

/// Share of the coordinates within which a point counts as on a plane: what their own rounding may have
/// moved it by.
const ON_PLANE: f64 = 1e-12;

/// The sine of an angle from a normal below which a direction counts as along it.
const ALONG_NORMAL: f64 = 1e-12;

/// Share of the coordinates within which two surfaces count as one: what single precision cannot tell apart.
const IN_PLANE: f64 = 4.0 / (1 << 24) as f64;

/// Share of its size by which a piece must reach over the border of another one to lie in it: neighbours
/// share their borders.
const OVER_BORDER: f64 = 1e-6;

impl PlanePiece {
    /// What is between three corners; none if that has no area.
    pub fn between(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        Some(Self {
            point: a,
            normal: (b - a).cross(c - a).try_normalize()?,
            outline: Outline::Triangle(corners),
        })
    }

    /// Above zero on the side that the normal points to, below it on the other, zero on the plane, all within
    /// rounding; in world units.
    pub fn height(&self, point: DVec3) -> f64 {
        let height = self.normal.dot(point - self.point);
        let rounding = ON_PLANE * (point.abs().max_element() + self.point.abs().max_element());
        if height.abs() <= rounding {
            0.0
        } else {
            height
        }
    }

    /// How far a point is from its border, in world units; infinity for what is endless.
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

    /// Whether a unit direction is across it.
    pub fn is_across(&self, direction: DVec3) -> bool {
        direction.cross(self.normal).length() <= ALONG_NORMAL
    }

    /// How far a point may be from the plane and count as on it, if the farthest of its like has coordinates up to
    /// `farthest` from `centre`; in world units.
    pub fn height_in(&self, centre: DVec3, farthest: f64) -> f64 {
        IN_PLANE * farthest.max((self.point - centre).abs().max_element())
    }

    /// Whether both fill some area of the same plane; coordinates count from `centre`.
    pub fn coincides(&self, other: &Self, centre: DVec3) -> bool {
        // The normal of the larger one is the more certain.
        let (small, large) = if self.size() < other.size() {
            (self, other)
        } else {
            (other, self)
        };
        let reach = |point: &DVec3| (*point - centre).abs().max_element();
        let points = small.points();
        let farthest = points.iter().map(reach).fold(reach(&large.point), f64::max);
        small.lies_over(large, IN_PLANE * farthest)
    }

    /// Whether some of it is in front of or behind a piece that is no smaller, and all of it within so much of that one's
    /// plane; in world units.
    fn lies_over(&self, large: &Self, height: f64) -> bool {
        let is_in = |point: &DVec3| large.normal.dot(*point - large.point).abs() <= height;
        self.points().iter().all(is_in) && self.overlaps(large, large.normal)
    }

    /// Whether one of them is that close to the other all over, and they lie over each other; in world units.
    pub fn is_beside(&self, other: &Self, height: f64) -> bool {
        if self.size() < other.size() {
            self.lies_over(other, height)
        } else {
            other.lies_over(self, height)
        }
    }

    /// Infinity for what is endless.
    fn size(&self) -> f64 {
        match self.outline {
            Outline::Endless => f64::INFINITY,
            Outline::Triangle([a, b, c]) => (b - a).length().max((c - a).length()),
            Outline::Disc(radius) => radius,
        }
    }

    /// Three points that are not in a line; those of an endless one are one unit apart.
    fn points(&self) -> [DVec3; 3] {
        let radius = match self.outline {
            Outline::Triangle(corners) => return corners,
            Outline::Endless => 1.0,
            Outline::Disc(radius) => radius,
        };
        let (across, along) = self.normal.any_orthonormal_pair();
        [DVec3::ZERO, across, along].map(|way| self.point + way * radius)
    }

    /// Whether two pieces of the same plane have an area in common: no line in it separates them. Such a line
    /// lies along an edge, or across the way from a disc to the nearest point of the other.
    fn overlaps(&self, other: &Self, normal: DVec3) -> bool {
        let border = OVER_BORDER * self.size().min(other.size());
        let ways = self.ways(other, normal).chain(other.ways(self, normal));
        let mut ways = ways.filter_map(DVec3::try_normalize);
        ways.all(|way| {
            let (own, theirs) = (self.interval(way), other.interval(way));
            own.0 + border < theirs.1 && theirs.0 + border < own.1
        })
    }

    /// Across lines that may separate it from another piece.
    fn ways(&self, other: &Self, normal: DVec3) -> impl Iterator<Item = DVec3> {
        let ways = match (self.outline, other.outline) {
            (Outline::Endless, _) => [DVec3::ZERO; 3],
            (Outline::Triangle([a, b, c]), _) => {
                [b - a, c - b, a - c].map(|side| side.cross(normal))
            }
            (Outline::Disc(_), Outline::Triangle(corners)) => {
                corners.map(|corner| corner - self.point)
            }
            (Outline::Disc(_), _) => [other.point - self.point; 3],
        };
        ways.into_iter()
    }

    /// From where to where it reaches along a unit direction in its plane.
    fn interval(&self, way: DVec3) -> (f64, f64) {
        match self.outline {
            Outline::Endless => (f64::NEG_INFINITY, f64::INFINITY),
            Outline::Triangle(corners) => {
                let [a, b, c] = corners.map(|corner| way.dot(corner));
                (a.min(b).min(c), a.max(b).max(c))
            }
            Outline::Disc(radius) => {
                let middle = way.dot(self.point);
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
        assert!(rug.is_beside(&lifted(0.5, 1e-3), 2e-3) && lifted(0.5, 1e-3).is_beside(&rug, 2e-3));
        assert!(!rug.is_beside(&lifted(0.5, 3e-3), 2e-3), "too far");
        assert!(!rug.is_beside(&lifted(2.1, 1e-3), 2e-3), "side by side");
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
