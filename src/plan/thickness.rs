//! How thick and how wide a mesh is at each of its faces: what is narrower than two pixels may slip between samples,
//! whereas a face of something thick never does, however small it is.

use std::f64::consts::FRAC_1_SQRT_2;

use rayon::iter::{IntoParallelRefIterator as _, ParallelIterator as _};

use super::borders::Borders;
use super::bvh::{Bvh, Node};
use super::cast::cast;
use super::components::inside_out;
use crate::primitive::{BoundingBox, PackedTriangle};
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

/// Cosine between the normal of a face and the direction in which the mesh is thinnest there above which the face
/// belongs to a flat side.
const FLAT_SIDE_COSINE: f64 = 0.9;

/// How wide a mesh is at a face, in scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Width {
    /// From wherever one looks; infinity where there is nothing behind the face.
    least: f64,
    /// For somebody who looks straight at the face.
    facing: f64,
}

impl Width {
    const UNLIMITED: Self = Self {
        least: f64::INFINITY,
        facing: f64::INFINITY,
    };

    fn min(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            facing: self.facing.min(other.facing),
        }
    }

    /// The least width and how much wider the mesh is from the front, given the width of the face by itself.
    pub fn at_least(self, own: f64) -> (f64, f64) {
        let least = self.least.max(own);
        let wider = self.facing - least;
        (
            least,
            if wider.is_finite() {
                wider.max(0.0)
            } else {
                0.0
            },
        )
    }
}

/// Measures how wide the mesh is at each triangle: through the inside to the opposite side (Shapira, Shamir and
/// Cohen-Or, "Consistent mesh partitioning and skeletonisation using the shape diameter function", The Visual
/// Computer 24, 2008; with one ray), whichever way its faces are wound, and along the surface from border to border;
/// and, half way through the inside, parallel to the triangle. `borders` are those of the triangles.
pub fn widths(triangles: &[PackedTriangle<f64>], bvh: &Bvh<f64>, borders: &Borders) -> Vec<Width> {
    let faces = Faces {
        triangles,
        bvh,
        inside_out: inside_out(triangles, &borders.connected),
    };
    let mut widths = faces.widths();
    for &(face, across) in &borders.widths {
        let width = &mut widths[face as usize];
        let (least, facing) = (across, across);
        *width = width.min(Width { least, facing });
    }
    widths
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
    /// The widths through the inside. All faces of a node get the least values measured for some of them; faces in
    /// several nodes get the least of these.
    fn widths(&self) -> Vec<Width> {
        let nodes = self.bvh.nodes.par_iter();
        let found: Vec<_> = nodes.map(|node| self.width_in(node)).collect();
        let mut widths = vec![Width::UNLIMITED; self.triangles.len()];
        for (node, found) in self.bvh.nodes.iter().zip(found) {
            for face in node.members() {
                let (across, mut found) = found;
                if !self.is_of_flat_side(face, across) {
                    found.facing = found.least;
                }
                let width = &mut widths[face as usize];
                *width = width.min(found);
            }
        }
        widths
    }

    /// The direction in which the mesh is thinnest at the faces of a node, and its widths there.
    fn width_in(&self, node: &Node) -> (Vec3<f64>, Width) {
        let Some((thinnest, least)) = self.thinnest(node) else {
            return (Vec3::splat(0.0), Width::UNLIMITED);
        };
        let across = self.triangles[thinnest].normal;
        let flat_side = node
            .members()
            .filter(|&face| self.is_of_flat_side(face, across));
        // Not where the faces are smaller than the mesh is thick: most meshes are of that kind.
        let facing = if least < self.extent(flat_side) {
            self.breadth(thinnest, least)
        } else {
            least
        };
        (across, Width { least, facing })
    }

    /// Returns whether a face lies across the direction in which the mesh is thinnest.
    fn is_of_flat_side(&self, face: u32, across: Vec3<f64>) -> bool {
        let cosine = across.dot(self.triangles[face as usize].normal);
        FLAT_SIDE_COSINE < cosine.abs()
    }

    /// The length of the diagonal of the box around some faces.
    fn extent(&self, faces: impl Iterator<Item = u32>) -> f64 {
        let corners = faces.flat_map(|face| self.triangles[face as usize].corners);
        let corners: Vec<_> = corners.collect();
        let bounds = BoundingBox::around(&corners);
        (bounds.high - bounds.low).length()
    }

    /// The measured face of a node behind which the mesh is thinnest, and its depth there: one face is measured at
    /// least for each direction in which they face, since the ends of a rod are as far apart as it is long.
    fn thinnest(&self, node: &Node) -> Option<(usize, f64)> {
        let mut measured: Vec<(Vec3<f64>, usize, f64)> = Vec::new();
        for (index, face) in node.members().enumerate() {
            let face = face as usize;
            let normal = self.triangles[face].normal;
            let is_alike = |other: &(Vec3<f64>, usize, f64)| SAME_SIDE_COSINE < normal.dot(other.0);
            if index.is_multiple_of(MEASURED_STEP) || !measured.iter().any(is_alike) {
                measured.push((normal, face, self.depth(face)));
            }
        }
        let faces = measured.into_iter().map(|(_, face, depth)| (face, depth));
        faces.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// The distance from about the middle of a face straight through the inside to the opposite side.
    fn depth(&self, face: usize) -> f64 {
        let (nearest, is_complete) = self.distance(face, self.middle(face), self.inwards(face));
        if is_complete {
            nearest
        } else {
            // As far as is known, thin by itself, so thin things are looked for there.
            nearest.min(self.triangles[face].thickness)
        }
    }

    /// The least width of the mesh parallel to a face, half way to the opposite side, measured in two directions at
    /// right angles; the depth if it is not known. A bar that lies between them is narrower, but by √2 at most.
    fn breadth(&self, face: usize, depth: f64) -> f64 {
        let inwards = self.inwards(face);
        let inside = self.middle(face) + inwards * (depth * 0.5);
        let [a, b, _] = self.triangles[face].corners;
        let Some(along) = (b - a).try_normalize() else {
            return depth;
        };
        let mut least = f64::INFINITY;
        for direction in [along, along.cross(inwards)] {
            let (ahead, is_complete) = self.distance(face, inside, direction);
            let (behind, is_other_complete) = self.distance(face, inside, -direction);
            if !is_complete || !is_other_complete {
                return depth;
            }
            least = least.min(ahead + behind);
        }
        depth.max(least * FRAC_1_SQRT_2)
    }

    /// A point about in the middle of a face.
    fn middle(&self, face: usize) -> Vec3<f64> {
        let [a, b, c] = self.triangles[face].corners;
        let [weight_a, weight_b, weight_c] = MEASURED_POINT;
        a * weight_a + b * weight_b + c * weight_c
    }

    /// The direction through a face into the mesh.
    fn inwards(&self, face: usize) -> Vec3<f64> {
        let normal = self.triangles[face].normal;
        if self.inside_out[face] {
            normal
        } else {
            -normal
        }
    }

    /// The distance from a point to the nearest face but this one, and whether the search was complete.
    fn distance(&self, face: usize, from: Vec3<f64>, direction: Vec3<f64>) -> (f64, bool) {
        let mut nearest = f64::INFINITY;
        let (triangles, bvh) = (self.triangles, self.bvh);
        let is_complete = cast(triangles, bvh, from, direction, MAX_NODES, |other, t| {
            if other as usize != face {
                nearest = nearest.min(t);
            }
            nearest
        });
        (nearest, is_complete)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::plan::bvh::Member;
    use crate::plan::components::number_corners;

    fn found(corners: &[[Vec3<f64>; 3]]) -> Vec<f64> {
        let widths = widths_of(corners).into_iter();
        widths.map(|width| width.least).collect()
    }

    fn widths_of(corners: &[[Vec3<f64>; 3]]) -> Vec<Width> {
        let packed =
            |corners: &[Vec3<f64>; 3]| PackedTriangle::of_mesh(corners.map(Vec3::to_dvec3));
        let triangles: Vec<_> = corners.iter().filter_map(packed).collect();
        let points = number_corners(&triangles);
        let borders = Borders::of(&points, |face| triangles[face as usize].corners, |_| 0);
        let bvh = Bvh::new(triangles.len(), |n| Member::of(&triangles[n]));
        widths(&triangles, &bvh, &borders)
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
                let angle = (side % SIDES) as f64 / SIDES as f64 * TAU;
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
    fn a_coin_is_wide_from_above_and_thin_from_beside() {
        const SIDES: usize = 40;
        let rim = |side: usize, z: f64| {
            let angle = (side % SIDES) as f64 / SIDES as f64 * TAU;
            at(10.0 * angle.cos(), 10.0 * angle.sin(), z)
        };
        let (mut faces, mut side_faces) = (Vec::new(), Vec::new());
        for side in 0..SIDES {
            let (next, top, bottom) = (side + 1, at(0.0, 0.0, 1.0), at(0.0, 0.0, 0.0));
            faces.push([top, rim(next, 1.0), rim(side, 1.0)]);
            faces.push([bottom, rim(side, 0.0), rim(next, 0.0)]);
            let (low, high) = (rim(side, 0.0), rim(side, 1.0));
            side_faces.extend(square(low, high, rim(next, 1.0), rim(next, 0.0)));
        }
        let flat_sides = faces.len();
        faces.extend(side_faces);
        let widths = widths_of(&faces);
        for (face, width) in widths.iter().enumerate().take(flat_sides) {
            assert!((width.least - 1.0).abs() < 1e-9, "{face}: {width:?}");
            assert!((10.0..14.2).contains(&width.facing), "{face}: {width:?}");
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
