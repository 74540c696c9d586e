//! How thick a mesh is at each of its faces: what is narrower than two pixels may slip between samples,
//! and a face of something thick never does, however small it is.

use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};
use rayon::slice::ParallelSliceMut as _;

use super::bvh::{Bvh, Child};
use super::cast::cast;
use super::parts::{inside_out, parts_along_edges};
use super::tips::tips;
use crate::primitive::PackedTriangle;
use crate::simd::{Real, Vec3};

/// Of the faces in a node, one of so many is measured for all of them, and those that look elsewhere.
const MEASURED: usize = 8;
/// Cosine between the normals of faces above which they look the same way.
const ALIKE: f64 = 0.7;
/// Where faces are measured, as shares of their corners: not in the middle, which lies before an edge of the other side
/// where that is its mirror image.
const NEARLY_MIDDLE: [f64; 3] = [0.38, 0.34, 0.28];
/// Most faces on the way from one border of a mesh to the other.
const LONGEST_WALK: usize = 32;

/// For each triangle how thick the mesh is there, at least: through the inside to the other side of it
/// (Shapira, Shamir and Cohen-Or, "Consistent mesh partitioning and skeletonisation using the shape
/// diameter function", The Visual Computer 24, 2008; with one ray), whichever way its faces are wound, and along
/// the surface from border to border. Infinity where there is neither. `points` numbers the corners of each triangle.
pub fn measures<R: Real>(
    triangles: &[PackedTriangle<R>],
    points: &[[u32; 3]],
    bvh: &Bvh<R>,
) -> Measures<R> {
    let borders = Borders::of(points);
    let mut parts = parts_along_edges(points.len(), borders.pairs());
    let faces = Faces {
        triangles,
        points,
        bvh,
        inside_out: inside_out(triangles, &parts),
    };
    let material_of = |face: u32| triangles[face as usize].material;
    if (1..points.len() as u32).any(|face| material_of(face) != material_of(0)) {
        let is_alike = |&[one, other]: &[u32; 2]| material_of(one) == material_of(other);
        parts = parts_along_edges(points.len(), borders.pairs().filter(is_alike));
    }
    let is_closed = borders.is_closed();
    let width = |&face: &u32| faces.width(face as usize, &borders);
    let widths: Vec<R> = borders.faces.iter().map(width).collect();
    let at_borders = borders.faces;
    // Those of a million faces are not kept while the rest takes its room.
    drop(borders.edges);
    let mut thicknesses = faces.depths();
    for (&face, width) in at_borders.iter().zip(widths) {
        let thickness = &mut thicknesses[face as usize];
        *thickness = thickness.min(width);
    }
    Measures {
        tips: tips(triangles, points, &at_borders),
        thicknesses,
        is_closed,
        parts,
    }
}

/// Faces of a mesh in space.
struct Faces<'a, R> {
    triangles: &'a [PackedTriangle<R>],
    /// The numbers of the corners: the same where faces meet.
    points: &'a [[u32; 3]],
    /// The way to the faces.
    bvh: &'a Bvh<R>,
    /// Which of them look inwards.
    inside_out: Vec<bool>,
}

/// An edge, from the smaller number to the larger, and a face that has it, twice its number, and 1 if the
/// face passes it that way.
type Edge = (u32, u32, u32);

/// What is known of a mesh.
pub struct Measures<R> {
    /// For each triangle how thick the mesh is there, at least.
    pub thicknesses: Vec<R>,
    /// For each triangle whether it ends in something narrower, see [`tips`].
    pub tips: Vec<bool>,
    /// Whether every edge is passed once in each direction: it has an inside.
    pub is_closed: bool,
    /// For each triangle the part that it is connected with, along edges and in one material.
    pub parts: Vec<u32>,
}

impl<R: Real> Faces<'_, R> {
    /// Through the inside. Neighbours share the least of what some of them have.
    fn depths(&self) -> Vec<R> {
        let nodes = (0..self.bvh.nodes.len()).into_par_iter();
        let found: Vec<(Vec<u32>, R)> = nodes
            .map(|node| {
                let node = &self.bvh.nodes[node];
                let faces: Vec<u32> = (0..node.count)
                    .filter_map(|place| match node.child(place) {
                        Child::Member(face) => Some(face),
                        Child::Node(_) => None,
                    })
                    .collect();
                let least = self.least_depth(&faces);
                (faces, least)
            })
            .collect();
        let mut depths = vec![R::INFINITY; self.triangles.len()];
        for (faces, least) in found {
            for face in faces {
                depths[face as usize] = least;
            }
        }
        depths
    }

    /// The least of what some of these faces have: one of each way that they look at least, since the ends of a rod are
    /// as far apart as it is long.
    fn least_depth(&self, faces: &[u32]) -> R {
        let (mut least, mut measured) = (R::INFINITY, Vec::new());
        for (place, &face) in faces.iter().enumerate() {
            let normal = self.triangles[face as usize].normal;
            let is_alike = |other: &Vec3<R>| R::from_f64(ALIKE) < normal.dot(*other);
            if place.is_multiple_of(MEASURED) || !measured.iter().any(is_alike) {
                least = least.min(self.depth(face as usize));
                measured.push(normal);
            }
        }
        least
    }

    /// How far the other side is from about the middle of a face, straight through the inside.
    fn depth(&self, face: usize) -> R {
        let [a, b, c] = self.triangles[face].corners;
        let [of_a, of_b, of_c] = NEARLY_MIDDLE.map(R::from_f64);
        let normal = self.triangles[face].normal;
        let inwards = if self.inside_out[face] {
            normal
        } else {
            -normal
        };
        let middle = a * of_a + b * of_b + c * of_c;
        let is_other = |other: u32| other as usize != face;
        let mut nearest = R::INFINITY;
        cast(self.triangles, self.bvh, (middle, inwards), |face, t| {
            if is_other(face) {
                nearest = nearest.min(t);
            }
            nearest
        });
        nearest
    }
}

/// Where a mesh ends.
struct Borders {
    /// Faces with an edge that no other face has.
    faces: Vec<u32>,
    /// All edges, sorted.
    edges: Vec<Edge>,
}

impl Borders {
    /// Those of faces whose corners have these numbers.
    fn of(points: &[[u32; 3]]) -> Self {
        let mut edges: Vec<Edge> = Vec::with_capacity(points.len() * 3);
        for (face, &[a, b, c]) in (0..).zip(points) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                edges.push((from.min(to), from.max(to), face * 2 + u32::from(from < to)));
            }
        }
        edges.par_sort_unstable();
        let alone = edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        let mut faces: Vec<u32> = alone
            .filter(|edge| edge.len() == 1)
            .map(|edge| edge[0].2 / 2)
            .collect();
        faces.sort_unstable();
        faces.dedup();
        Self { faces, edges }
    }

    /// Pairs of faces that have an edge in common: enough of them to connect all that do.
    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        let neighbours = self.edges.windows(2);
        let pairs = neighbours.filter(|pair| (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1));
        pairs.map(|pair| [pair[0].2 / 2, pair[1].2 / 2])
    }

    /// Whether two faces meet at every edge and pass it in different directions.
    fn is_closed(&self) -> bool {
        let mut edges = self.edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        edges.all(|edge| matches!(edge, [one, two] if (one.2 ^ two.2) & 1 == 1))
    }

    /// The other face at an edge; `None` on a border, and where more than two faces meet.
    fn other(&self, from: u32, to: u32, face: u32) -> Option<u32> {
        let edge = (from.min(to), from.max(to));
        let first = self.edges.partition_point(|&(a, b, _)| (a, b) < edge);
        let here = self.edges[first..].iter();
        let mut here = here.take_while(|&&(a, b, _)| (a, b) == edge);
        match (here.next(), here.next(), here.next()) {
            (Some(&(_, _, one)), Some(&(_, _, two)), None) => {
                Some(if one / 2 == face { two / 2 } else { one / 2 })
            }
            _ => None,
        }
    }
}

impl<R: Real> Faces<'_, R> {
    /// The way along the surface from the border of a face to the next one; infinity if that is far.
    fn width(&self, face: usize, borders: &Borders) -> R {
        let mut least = R::INFINITY;
        for side in 0..3 {
            let [from, to] = [self.points[face][side], self.points[face][(side + 1) % 3]];
            if borders.other(from, to, face as u32).is_none() {
                least = least.min(self.walk(face, side, borders));
            }
        }
        least
    }

    /// The length of the straight line over the surface that sets out across the middle of a side.
    fn walk(&self, mut face: usize, side: usize, borders: &Borders) -> R {
        let mut entered = side;
        let corners = self.triangles[face].corners;
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let mut at = (from + to) * R::from_f64(0.5);
        let mut direction = inwards(&corners, side);
        let mut length = R::ZERO;
        for _ in 0..LONGEST_WALK {
            let corners = self.triangles[face].corners;
            // Each of the other sides is crossed where the line comes to its height over it.
            let crossing = |side: usize| {
                let inwards = inwards(&corners, side);
                let (height, speed) = ((at - corners[side]).dot(inwards), direction.dot(inwards));
                if speed < R::ZERO {
                    -height / speed
                } else {
                    R::INFINITY
                }
            };
            let sides = [(entered + 1) % 3, (entered + 2) % 3];
            let (one, two) = (crossing(sides[0]), crossing(sides[1]));
            let (left, step) = if one < two {
                (sides[0], one)
            } else {
                (sides[1], two)
            };
            if !step.less(R::INFINITY) {
                return R::INFINITY;
            }
            length = length + step.max(R::ZERO);
            at = at + direction * step;
            let points = self.points[face];
            let (a, b) = (points[left], points[(left + 1) % 3]);
            let Some(next) = borders.other(a, b, face as u32) else {
                return length;
            };
            // Over the edge: what goes along it stays, what goes across it goes on across.
            let along = (corners[(left + 1) % 3] - corners[left]).try_normalize();
            let Some(along) = along else { return length };
            let across = -direction.dot(inwards(&corners, left));
            let kept = along * direction.dot(along);
            face = next as usize;
            let is_entered = |side: &usize| {
                let points = self.points[face];
                let edge = (points[*side], points[(*side + 1) % 3]);
                edge == (a, b) || edge == (b, a)
            };
            let Some(side) = (0..3).find(is_entered) else {
                return length;
            };
            entered = side;
            direction = kept + inwards(&self.triangles[face].corners, side) * across;
        }
        R::INFINITY
    }
}

/// The unit direction in the plane of a triangle that leads from one of its sides into it.
fn inwards<R: Real>(corners: &[Vec3<R>; 3], side: usize) -> Vec3<R> {
    let (from, to) = (corners[side], corners[(side + 1) % 3]);
    let third = corners[(side + 2) % 3];
    let along = to - from;
    let normal = along.cross(third - from);
    let direction = normal.cross(along).try_normalize();
    direction.unwrap_or(Vec3::splat(R::ZERO))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::bvh::Member;
    use crate::primitive::{BoundingBox, number_corners};

    fn found(corners: &[[Vec3<f64>; 3]]) -> Vec<f64> {
        let packed =
            |corners: &[Vec3<f64>; 3]| PackedTriangle::of_mesh(corners.map(Vec3::to_dvec3));
        let triangles: Vec<_> = corners.iter().filter_map(packed).collect();
        let member = |triangle: &PackedTriangle<f64>| Member {
            bounds: BoundingBox::around(&triangle.corners),
            thickness: triangle.thickness,
        };
        let members: Vec<_> = triangles.iter().map(member).collect();
        let points = number_corners(&triangles);
        measures(
            &triangles,
            &points,
            &Bvh::new(members.len(), |n| members[n]),
        )
        .thicknesses
    }

    fn at(x: f64, y: f64, z: f64) -> Vec3<f64> {
        Vec3::new(x, y, z)
    }

    /// Two triangles, clockwise seen from where their four corners are.
    fn square(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>, d: Vec3<f64>) -> [[Vec3<f64>; 3]; 2] {
        [[a, b, c], [a, c, d]]
    }

    /// A rod along x of this width, in `steps` pieces, without ends.
    fn rod(width: f64, steps: usize) -> Vec<[Vec3<f64>; 3]> {
        let ring = [(0.0, 0.0), (0.0, width), (width, width), (width, 0.0)];
        let mut faces = Vec::new();
        for step in 0..steps {
            let (x, next) = (step as f64, step as f64 + 1.0);
            for side in 0..4 {
                let ((y, z), (v, w)) = (ring[side], ring[(side + 1) % 4]);
                faces.extend(square(
                    at(x, y, z),
                    at(x, v, w),
                    at(next, v, w),
                    at(next, y, z),
                ));
            }
        }
        faces
    }

    #[test]
    fn a_rod_is_as_thick_as_it_is_wide_however_long_its_faces_are() {
        for width in [0.1, 3.0] {
            let found = found(&rod(width, 20));
            // Without ends, those at the ends have a border.
            for thickness in &found[8..found.len() - 8] {
                assert!((thickness - width).abs() < 1e-9, "{thickness} for {width}");
            }
        }
    }

    #[test]
    fn a_rod_with_ends_is_no_thicker_whichever_way_it_lies_or_is_wound() {
        const SIDES: usize = 6;
        let radius = 0.2;
        for turn in 0..60 {
            let turn = f64::from(turn);
            let along = at(turn.sin(), (turn * 0.7).cos(), (turn * 1.3).sin());
            let along = along.try_normalize().expect("a direction");
            let across = along.cross(at(0.31, 0.57, -0.76)).try_normalize();
            let across = across.expect("askew");
            let up = along.cross(across);
            let corner = |end: usize, side: usize| {
                let angle = (side % SIDES) as f64 / SIDES as f64 * std::f64::consts::TAU;
                let off = across * angle.cos() + up * angle.sin();
                along * (end as f64 * 40.0) + off * radius
            };
            let mut faces = Vec::new();
            for side in 0..SIDES {
                let (a, b) = (corner(0, side), corner(1, side));
                faces.extend(square(a, b, corner(1, side + 1), corner(0, side + 1)));
            }
            for side in 1..SIDES - 1 {
                faces.push([corner(0, 0), corner(0, side), corner(0, side + 1)]);
                faces.push([corner(1, 0), corner(1, side + 1), corner(1, side)]);
            }
            let other_way: Vec<_> = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
            // Parts of a mesh need not be wound alike.
            let beside =
                |[a, b, c]: [Vec3<f64>; 3]| [a, b, c].map(|corner| corner + at(0.0, 0.0, 90.0));
            let both: Vec<_> = faces
                .iter()
                .copied()
                .chain(other_way.iter().copied().map(beside))
                .collect();
            let sides = |found: Vec<f64>| found.into_iter().take(2 * SIDES);
            let beside = found(&both).split_off(faces.len());
            let all = sides(found(&faces)).chain(sides(found(&other_way)));
            for (face, thickness) in all
                .chain(sides(found(&both)))
                .chain(sides(beside))
                .enumerate()
            {
                assert!(thickness < 2.0 * radius, "{turn} {face}: {thickness}");
            }
        }
    }

    #[test]
    fn a_ribbon_is_as_thick_as_it_is_wide_and_its_inside_is_no_edge() {
        // Along x, wavy, each step six triangles wide.
        let (mut faces, rows) = (Vec::new(), 6);
        for step in 0..12 {
            for row in 0..rows {
                let corner = |step: i32, row: i32| {
                    let x = f64::from(step);
                    at(x, (x * 0.7).sin(), f64::from(row) * 0.1)
                };
                let (a, b) = (corner(step, row), corner(step, row + 1));
                let (c, d) = (corner(step + 1, row + 1), corner(step + 1, row));
                faces.extend(square(a, b, c, d));
            }
        }
        let found = found(&faces);
        let edge = found[12 * 3 + 1];
        assert!((edge - 0.6).abs() < 0.05, "{edge}");
        assert_eq!(found[12 * 3 + 4], f64::INFINITY);
    }

    #[test]
    fn a_sheet_of_many_triangles_is_thick() {
        let mut faces = Vec::new();
        for x in 0..40 {
            for y in 0..40 {
                let corner = |x: i32, y: i32| at(f64::from(x), f64::from(y), 0.0);
                let (a, b) = (corner(x, y), corner(x, y + 1));
                faces.extend(square(a, b, corner(x + 1, y + 1), corner(x + 1, y)));
            }
        }
        let thin = found(&faces).iter().filter(|t| **t < 20.0).count();
        // At its corners the way across is short.
        assert!(thin < 80, "{thin} of 3200");
    }
}
