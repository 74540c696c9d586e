//! Connectivity and borders of faces, derived from their corner numbers.

use rayon::slice::ParallelSliceMut as _;

use super::components::components_along_edges;
use crate::simd::Vec3;

/// Maximum number of faces on the way from one border of a mesh to the other.
const MAX_WALK: usize = 32;

/// The connectivity of faces along their edges.
pub struct Borders {
    /// Faces on a border (with an edge that no other face has), in ascending order, with the distance over the
    /// surface to the next border; infinity if that is far.
    pub widths: Vec<(u32, f64)>,
    /// Whether every edge is traversed once in each direction, so that there is an inside.
    pub is_closed: bool,
    /// For each face, its component when connected along edges.
    pub connected: Vec<u32>,
    /// The same for components of one material, if there are several materials.
    pub of_one_material: Option<Vec<u32>>,
}

impl Borders {
    /// Analyses faces with these corner numbers, corner positions and materials.
    pub fn of(
        points: &[[u32; 3]],
        corners: impl Fn(u32) -> [Vec3<f64>; 3],
        material: impl Fn(u32) -> u32,
    ) -> Self {
        let edges = Edges::of(points);
        let count = points.len();
        let are_different = (1..count as u32).any(|face| material(face) != material(0));
        let is_alike = |&[one, other]: &[u32; 2]| material(one) == material(other);
        let surface = Faces {
            points,
            corners,
            edges: &edges,
        };
        let border_faces = edges.border_faces().into_iter();
        Self {
            widths: border_faces
                .map(|face| (face, surface.width(face)))
                .collect(),
            is_closed: edges.are_closed(),
            connected: components_along_edges(count, edges.pairs()),
            of_one_material: are_different
                .then(|| components_along_edges(count, edges.pairs().filter(is_alike))),
        }
    }
}

/// An edge of a face; in the order of its corners, so that the faces at an edge follow each other.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// The smaller corner number.
    low: u32,
    /// The larger corner number.
    high: u32,
    /// Twice the number of the face, plus 1 if it traverses the edge from the smaller corner to the larger.
    face_and_direction: u32,
}

impl Edge {
    fn corners(&self) -> (u32, u32) {
        (self.low, self.high)
    }

    fn face(&self) -> u32 {
        self.face_and_direction / 2
    }

    fn is_ascending(&self) -> bool {
        self.face_and_direction & 1 == 1
    }
}

/// All edges, sorted.
struct Edges(Vec<Edge>);

impl Edges {
    /// The edges of faces with these corner numbers.
    fn of(points: &[[u32; 3]]) -> Self {
        let mut edges: Vec<Edge> = Vec::with_capacity(points.len() * 3);
        for (face, &[a, b, c]) in (0..).zip(points) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.push(Edge {
                    low: from.min(to),
                    high: from.max(to),
                    face_and_direction: face * 2 + u32::from(from < to),
                });
            }
        }
        edges.par_sort_unstable();
        Self(edges)
    }

    /// Groups of entries that are the same edge.
    fn groups(&self) -> impl Iterator<Item = &[Edge]> {
        self.0.chunk_by(|a, b| a.corners() == b.corners())
    }

    /// The faces with an edge that no other face has.
    fn border_faces(&self) -> Vec<u32> {
        let border_faces = self.groups().filter(|edge| edge.len() == 1);
        let mut faces: Vec<u32> = border_faces.map(|edge| edge[0].face()).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// Pairs of faces that share an edge: enough of them to connect all faces that do.
    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        let neighbours = self.0.windows(2);
        let pairs = neighbours.filter(|pair| pair[0].corners() == pair[1].corners());
        pairs.map(|pair| [pair[0].face(), pair[1].face()])
    }

    /// Returns whether exactly two faces meet at every edge and traverse it in opposite directions.
    fn are_closed(&self) -> bool {
        self.groups()
            .all(|edge| matches!(edge, [one, two] if one.is_ascending() != two.is_ascending()))
    }

    /// The other face at an edge; `None` on a border, and where more than two faces meet.
    fn across_edge(&self, from: u32, to: u32, face: u32) -> Option<u32> {
        let corners = (from.min(to), from.max(to));
        let first = self.0.partition_point(|edge| edge.corners() < corners);
        let entries = self.0[first..].iter();
        let mut entries = entries.take_while(|edge| edge.corners() == corners);
        match (entries.next(), entries.next(), entries.next()) {
            (Some(one), Some(two), None) if one.face() == face => Some(two.face()),
            (Some(one), Some(_), None) => Some(one.face()),
            _ => None,
        }
    }
}

/// The faces of a surface, over which straight lines are traced.
struct Faces<'a, F> {
    points: &'a [[u32; 3]],
    corners: F,
    edges: &'a Edges,
}

impl<F: Fn(u32) -> [Vec3<f64>; 3]> Faces<'_, F> {
    /// The distance along the surface from the border edge of a face to the next border; infinity if that is far.
    fn width(&self, face: u32) -> f64 {
        let mut least = f64::INFINITY;
        for side in 0..3 {
            let points = self.points[face as usize];
            let (from, to) = (points[side], points[(side + 1) % 3]);
            if self.edges.across_edge(from, to, face).is_none() {
                least = least.min(self.walk(face, side));
            }
        }
        least
    }

    /// The length of the straight line over the surface that starts perpendicularly across the middle of a side.
    fn walk(&self, mut face: u32, side: usize) -> f64 {
        let mut entry_side = side;
        let corners = (self.corners)(face);
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let mut point = (from + to) * 0.5;
        let mut direction = inwards(&corners, side);
        let mut length = 0.0;
        for _ in 0..MAX_WALK {
            let corners = (self.corners)(face);
            // The line crosses a side where its height above that side becomes zero.
            let crossing = |side: usize| {
                let inwards = inwards(&corners, side);
                let (height, speed) =
                    ((point - corners[side]).dot(inwards), direction.dot(inwards));
                if speed < 0.0 {
                    -height / speed
                } else {
                    f64::INFINITY
                }
            };
            let sides = [(entry_side + 1) % 3, (entry_side + 2) % 3];
            let (one, two) = (crossing(sides[0]), crossing(sides[1]));
            let (exit_side, step) = if one < two {
                (sides[0], one)
            } else {
                (sides[1], two)
            };
            // Infinite or NaN.
            if !step.is_finite() {
                return f64::INFINITY;
            }
            length += step.max(0.0);
            point = point + direction * step;
            let points = self.points[face as usize];
            let (a, b) = (points[exit_side], points[(exit_side + 1) % 3]);
            let Some(next) = self.edges.across_edge(a, b, face) else {
                return length;
            };
            // Across the edge: the component along it is kept, the one across it goes on into the next face.
            let along = (corners[(exit_side + 1) % 3] - corners[exit_side]).try_normalize();
            let Some(along) = along else { return length };
            let across = -direction.dot(inwards(&corners, exit_side));
            let along_part = along * direction.dot(along);
            face = next;
            let points = self.points[face as usize];
            let is_entered = |side: &usize| {
                let edge = (points[*side], points[(*side + 1) % 3]);
                edge == (a, b) || edge == (b, a)
            };
            let Some(side) = (0..3).find(is_entered) else {
                return length;
            };
            entry_side = side;
            direction = along_part + inwards(&(self.corners)(face), side) * across;
        }
        f64::INFINITY
    }
}

/// The unit vector in the plane of a triangle that points from one of its sides inwards.
fn inwards(corners: &[Vec3<f64>; 3], side: usize) -> Vec3<f64> {
    let (from, to) = (corners[side], corners[(side + 1) % 3]);
    let third = corners[(side + 2) % 3];
    let along = to - from;
    let normal = along.cross(third - from);
    let direction = normal.cross(along).try_normalize();
    direction.unwrap_or(Vec3::splat(0.0))
}
