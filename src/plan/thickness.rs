//! The thickness of a mesh at each of its faces: what is narrower than two pixels may slip between samples, whereas
//! a face of something thick never does, however small it is.

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use super::borders::Borders;
use super::bvh::{Bvh, Node};
use super::cast::cast;
use super::components::inside_out;
use crate::primitive::PackedTriangle;
use crate::simd::Vec3;

/// One face in this many of a node is measured for all its faces, and also each that faces in a new direction.
const MEASURED_STEP: usize = 8;
/// Cosine between the normals of two faces above which they face the same way.
const SAME_SIDE_COSINE: f64 = 0.7;
/// Maximum number of nodes visited behind a face: where the boxes of long thin faces overlap, it would be all of
/// them.
const MAX_NODES: usize = 256;
/// Barycentric coordinates of the point where a face is measured: off the centroid, which lies in front of an edge
/// of the opposite side if that is its mirror image.
const MEASURED_POINT: [f64; 3] = [0.38, 0.34, 0.28];

/// Measures the least thickness of the mesh at each triangle: through the inside to the opposite side (Shapira,
/// Shamir and Cohen-Or, "Consistent mesh partitioning and skeletonisation using the shape diameter function", The
/// Visual Computer 24, 2008; with one ray), whichever way its faces are wound, and along the surface from border to
/// border. Infinity where there is neither. `borders` are those of the triangles.
pub fn thicknesses(
    triangles: &[PackedTriangle<f64>],
    bvh: &Bvh<f64>,
    borders: &Borders,
) -> Vec<f64> {
    let faces = Faces {
        triangles,
        bvh,
        inside_out: inside_out(triangles, &borders.connected),
    };
    let mut thicknesses = faces.depths();
    for &(face, width) in &borders.widths {
        let thickness = &mut thicknesses[face as usize];
        *thickness = thickness.min(width);
    }
    thicknesses
}

/// The faces of a mesh with their tree.
struct Faces<'a> {
    triangles: &'a [PackedTriangle<f64>],
    /// The tree over the faces.
    bvh: &'a Bvh<f64>,
    /// Which of the faces have normals that point inwards.
    inside_out: Vec<bool>,
}

impl Faces<'_> {
    /// The thickness through the inside. All faces of a node get the least value measured for some of them; faces in
    /// several nodes get the least of these.
    fn depths(&self) -> Vec<f64> {
        let nodes = self.bvh.nodes.par_iter();
        let found: Vec<f64> = nodes.map(|node| self.least_depth(node)).collect();
        let mut depths = vec![f64::INFINITY; self.triangles.len()];
        for (node, least) in self.bvh.nodes.iter().zip(found) {
            for face in node.members() {
                let depth = &mut depths[face as usize];
                *depth = depth.min(least);
            }
        }
        depths
    }

    /// The least depth of the measured faces in a node: at least one for each direction in which they face, since
    /// the ends of a rod are as far apart as it is long.
    fn least_depth(&self, node: &Node) -> f64 {
        let (mut least, mut measured) = (f64::INFINITY, Vec::new());
        for (index, face) in node.members().enumerate() {
            let normal = self.triangles[face as usize].normal;
            let is_alike = |other: &Vec3<f64>| SAME_SIDE_COSINE < normal.dot(*other);
            if index.is_multiple_of(MEASURED_STEP) || !measured.iter().any(is_alike) {
                least = least.min(self.depth(face as usize));
                measured.push(normal);
            }
        }
        least
    }

    /// The distance from about the middle of a face straight through the inside to the opposite side.
    fn depth(&self, face: usize) -> f64 {
        let [a, b, c] = self.triangles[face].corners;
        let [weight_a, weight_b, weight_c] = MEASURED_POINT;
        let normal = self.triangles[face].normal;
        let inwards = if self.inside_out[face] {
            normal
        } else {
            -normal
        };
        let middle = a * weight_a + b * weight_b + c * weight_c;
        let mut nearest = f64::INFINITY;
        let (triangles, bvh) = (self.triangles, self.bvh);
        let is_complete = cast(triangles, bvh, middle, inwards, MAX_NODES, |other, t| {
            if other as usize != face {
                nearest = nearest.min(t);
            }
            nearest
        });
        if is_complete {
            nearest
        } else {
            // As far as is known, thin by itself, so thin things are looked for there.
            nearest.min(self.triangles[face].thickness)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::bvh::Member;
    use crate::plan::components::number_corners;

    fn found(corners: &[[Vec3<f64>; 3]]) -> Vec<f64> {
        let packed =
            |corners: &[Vec3<f64>; 3]| PackedTriangle::of_mesh(corners.map(Vec3::to_dvec3));
        let triangles: Vec<_> = corners.iter().filter_map(packed).collect();
        let points = number_corners(&triangles);
        let borders = Borders::of(&points, |face| triangles[face as usize].corners, |_| 0);
        let bvh = Bvh::new(triangles.len(), |n| Member::of(&triangles[n]));
        thicknesses(&triangles, &bvh, &borders)
    }

    fn at(x: f64, y: f64, z: f64) -> Vec3<f64> {
        Vec3::new(x, y, z)
    }

    /// Two triangles that make a square, clockwise seen from the side from which its corners are.
    fn square(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>, d: Vec3<f64>) -> [[Vec3<f64>; 3]; 2] {
        [[a, b, c], [a, c, d]]
    }

    /// A rod of this width along x, in `steps` pieces, without ends.
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
            // The rod has no ends, so its first and last faces have a border.
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
            // Components of a mesh may be wound differently.
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
        // Along x, wavy, with six squares across at each step.
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
        // At its corners, the distance across is short.
        assert!(thin < 80, "{thin} of 3200");
    }
}
