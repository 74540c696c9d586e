//! Normals at the corners of faces that are shaded as one curved surface.

use glam::DVec3;
use rayon::iter::{
    IndexedParallelIterator as _, IntoParallelIterator as _, IntoParallelRefIterator as _,
    ParallelIterator as _,
};

use super::components::{count_corners, number_corners};
use crate::primitive::{CornerNormals, PackedTriangle};
use crate::simd::{Real, Vec3};

/// Number of faces at a corner above which they stay flat there, since each is compared with all others.
const MAX_FACES_AT_CORNER: usize = 1024;

/// Margin by which the cosine between two faces must exceed that of the limiting angle for them to be smooth:
/// several roundings of single precision, in which files store corners, so that faces that meet at exactly that
/// angle are never smoothed because of rounding.
const COSINE_MARGIN: f64 = 4e-6;

/// Returns the normals at the corners of each triangle: the mean of the normals of all faces there that differ from
/// the triangle's own by less than `degrees`, weighted by their angles at the corner.
///
/// Thürmer and Wüthrich, "Computing vertex normals from polygonal facets", Journal of Graphics Tools 3(1),
/// 1998.
pub fn corner_normals(triangles: &[PackedTriangle<f64>], degrees: f64) -> Vec<CornerNormals<f64>> {
    let least_cosine = degrees.to_radians().cos() + COSINE_MARGIN;
    let numbers = number_corners(triangles);
    let corner_faces = CornerFaces::of(&numbers);
    let flipped = flipped_faces(&numbers, &corner_faces);
    let is_flipped = |face: usize| flipped.get(face) == Some(&true);
    let normal = |face: usize| {
        let normal = triangles[face].normal.to_dvec3();
        if is_flipped(face) { -normal } else { normal }
    };
    let faces = triangles.par_iter().zip(&numbers).enumerate();
    let normals = faces.map(|(index, (triangle, numbers))| {
        let own = normal(index);
        let normals = numbers.map(|number| {
            let faces_here = corner_faces.of_corner(number);
            if faces_here.len() > MAX_FACES_AT_CORNER {
                return triangle.normal;
            }
            let alike = faces_here.iter().filter(|&&(face, _)| {
                face as usize == index || least_cosine < own.dot(normal(face as usize))
            });
            let sum = alike
                .map(|&(face, corner)| {
                    let face = face as usize;
                    normal(face) * angle(&triangles[face], corner as usize)
                })
                .filter(|weighted| weighted.is_finite())
                .sum::<DVec3>();
            let mean = Vec3::from_dvec3(sum.try_normalize().unwrap_or(own));
            // Back on the side of the face's own normal.
            if is_flipped(index) { -mean } else { mean }
        });
        CornerNormals {
            normals,
            curvature: curvature(triangle, &normals),
        }
    });
    normals.collect()
}

/// Returns the faces that must be flipped so that neighbours traverse their common edge in opposite directions and
/// have their normals on the same side: files do not always wind all faces the same way. Empty if there are none.
fn flipped_faces(faces: &[[u32; 3]], corner_faces: &CornerFaces) -> Vec<bool> {
    let neighbours =
        |face: usize| (0..3).filter_map(move |edge| neighbour(faces, corner_faces, face, edge));
    let all = (0..faces.len()).into_par_iter();
    if all.all(|face| neighbours(face).all(|(_, is_same_direction)| !is_same_direction)) {
        return Vec::new();
    }
    let mut flipped = vec![None; faces.len()];
    let mut waiting = Vec::new();
    for first in 0..faces.len() {
        if flipped[first].is_none() {
            flipped[first] = Some(false);
            waiting.push(first);
        }
        while let Some(face) = waiting.pop() {
            for (other, is_same_direction) in neighbours(face) {
                if flipped[other].is_none() {
                    flipped[other] = Some((flipped[face] == Some(true)) != is_same_direction);
                    waiting.push(other);
                }
            }
        }
    }
    flipped.into_iter().map(|flip| flip == Some(true)).collect()
}

/// The face on the other side of an edge, and whether it traverses the edge in the same direction; `None` if there
/// is no such face or more than one, and at a corner where too many faces meet.
fn neighbour(
    faces: &[[u32; 3]],
    corner_faces: &CornerFaces,
    face: usize,
    edge: usize,
) -> Option<(usize, bool)> {
    let (from, to) = (faces[face][edge], faces[face][(edge + 1) % 3]);
    let faces_here = corner_faces.of_corner(from);
    if faces_here.len() > MAX_FACES_AT_CORNER {
        return None;
    }
    let others = faces_here
        .iter()
        .filter(|(other, _)| *other as usize != face);
    let mut neighbours = others.filter_map(|&(other, corner)| {
        let at = |step: usize| faces[other as usize][(corner as usize + step) % 3];
        let is_same_direction = at(1) == to;
        (is_same_direction || at(2) == to).then_some((other as usize, is_same_direction))
    });
    let only = neighbours.next();
    only.filter(|_| neighbours.next().is_none())
}

/// Upper bound of the distance by which points of the faces are lifted onto the curved surface, whichever side is
/// seen, see [`crate::primitive::Curved::bend`].
pub fn largest_lift<R: Real>(triangles: &[PackedTriangle<R>], smooth: &[CornerNormals<R>]) -> R {
    let faces = triangles.iter().zip(smooth);
    let lifts = faces.flat_map(|(triangle, smooth)| {
        let corners = triangle.corners.into_iter().zip(smooth.normals);
        corners.flat_map(|(corner, normal)| {
            let others = triangle.corners.into_iter();
            others.map(move |other| normal.dot(corner - other).abs())
        })
    });
    lifts.fold(R::ZERO, R::max)
}

/// The angle of a triangle at one of its corners.
fn angle(triangle: &PackedTriangle<f64>, corner: usize) -> f64 {
    let at = |step: usize| triangle.corners[(corner + step) % 3].to_dvec3();
    (at(1) - at(0)).angle_between(at(2) - at(0))
}

fn curvature(triangle: &PackedTriangle<f64>, normals: &[Vec3<f64>; 3]) -> f64 {
    let bend = |from: usize, to: usize| {
        let length = (triangle.corners[from] - triangle.corners[to]).length();
        (normals[from] - normals[to]).length() / length
    };
    bend(0, 1).max(bend(1, 2)).max(bend(2, 0))
}

/// The faces that meet at each corner.
struct CornerFaces {
    /// Start of each corner's faces in `faces`, and the end of the last ones.
    firsts: Vec<u32>,
    /// Faces, each with the index (0–2) that the corner has in it.
    faces: Vec<(u32, u8)>,
}

impl CornerFaces {
    fn of(faces: &[[u32; 3]]) -> Self {
        let corners = count_corners(faces);
        let mut firsts = vec![0_u32; corners as usize + 1];
        for &corner in faces.iter().flatten() {
            firsts[corner as usize + 1] += 1;
        }
        for corner in 0..corners as usize {
            firsts[corner + 1] += firsts[corner];
        }
        let mut next_free = firsts.clone();
        let mut sorted = vec![(0, 0); faces.len() * 3];
        for (face, corners) in faces.iter().enumerate() {
            for (index, &corner) in corners.iter().enumerate() {
                let next = &mut next_free[corner as usize];
                sorted[*next as usize] = (face as u32, index as u8);
                *next += 1;
            }
        }
        Self {
            firsts,
            faces: sorted,
        }
    }

    fn of_corner(&self, corner: u32) -> &[(u32, u8)] {
        let corner = corner as usize;
        &self.faces[self.firsts[corner] as usize..self.firsts[corner + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive::{Curved, Primitive as _, Ray};

    /// An octahedron of which every second face is wound the other way.
    #[test]
    fn faces_in_any_order_have_the_normals_of_those_in_one() {
        let mut faces = Vec::new();
        for x in [-1.0, 1.0] {
            for y in [-1.0, 1.0] {
                for z in [-1.0, 1.0] {
                    let [a, b, c] = [DVec3::X * x, DVec3::Y * y, DVec3::Z * z];
                    faces.push(if x * y * z > 0.0 {
                        [a, c, b]
                    } else {
                        [a, b, c]
                    });
                }
            }
        }
        let packed = |faces: &[[DVec3; 3]]| -> Vec<PackedTriangle<f64>> {
            let faces = faces
                .iter()
                .filter_map(|face| PackedTriangle::of_mesh(*face));
            faces.collect()
        };
        let even = packed(&faces);
        let expected = corner_normals(&even, 120.0);
        for face in faces.iter_mut().step_by(2) {
            face.swap(1, 2);
        }
        let mixed = packed(&faces);
        let found = corner_normals(&mixed, 120.0);
        for (face, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let side = even[face].normal.dot(mixed[face].normal);
            let place = |corner: usize| if side > 0.0 { corner } else { (3 - corner) % 3 };
            for corner in 0..3 {
                let off = found.normals[place(corner)] * side - expected.normals[corner];
                assert!(off.length() < 1e-12, "{face} {corner}: {off:?}");
            }
        }
    }

    #[test]
    fn nothing_is_lifted_farther_than_told_whichever_side_is_seen() {
        // Two faces of a roof.
        let [left, right] = [DVec3::NEG_X, DVec3::X].map(|side| side - DVec3::Y);
        let (front, back) = (DVec3::Z, DVec3::NEG_Z);
        let faces = [[front, back, left], [back, front, right]];
        let triangles: Vec<_> = faces
            .into_iter()
            .filter_map(PackedTriangle::<f64>::of_mesh)
            .collect();
        let smooth = corner_normals(&triangles, 120.0);
        let most = largest_lift(&triangles, &smooth);
        let mut farthest = [0.0_f64; 2];
        for (triangle, smooth) in triangles.iter().zip(&smooth) {
            let curved = Curved {
                corners: triangle.corners,
                normals: smooth.normals,
                curvature: smooth.curvature,
            };
            let [a, b, c] = triangle.corners;
            let middle = (a + b + c) * (1.0 / 3.0);
            for (farthest, side) in farthest.iter_mut().zip([1.0, -1.0]) {
                let direction = triangle.normal * side;
                let origin = middle - direction;
                let flat = triangle.refine(&Ray { origin, direction }, 1.0);
                let bent = curved.bend(&flat, direction);
                *farthest = farthest.max((bent.point - flat.point).length());
            }
        }
        // From one side it is a roof, and is lifted; from the other it is a valley, and is not.
        assert!(farthest[0].max(farthest[1]) > 0.1, "{farthest:?}");
        assert!(farthest[0].max(farthest[1]) <= most, "{farthest:?} {most}");
        assert!(farthest[0].min(farthest[1]) < 1e-9, "{farthest:?}");
        let turned = triangles.iter().map(|triangle| {
            let mut turned = *triangle;
            turned.flip();
            turned
        });
        let turned: Vec<_> = turned.collect();
        let other = largest_lift(&turned, &corner_normals(&turned, 120.0));
        assert!((other - most).abs() < 1e-12, "{other} {most}");
    }
}
