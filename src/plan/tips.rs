//! Where meshes taper to less than their thickness: at their borders and sharp points.

use super::components::count_corners;
use crate::primitive::{PackedTriangle, Tip, Vertex};
use crate::simd::Vec3;

/// Least cosine between the edges of a sharp point and their mean direction.
const MIN_SHARP_COSINE: f64 = 0.75;
/// Number of faces at a sharp point up to which thin things are looked for wherever a face is narrow. With more, as
/// in a round cone, faces are narrow everywhere, but the cone itself only near its point.
const MAX_NARROW_FACES: u32 = 8;
/// Number of faces at a point above which nothing is looked for, since every ray near the point would look for each
/// of them.
const MAX_FACES: u32 = 128;

/// The edges that meet at a point.
#[derive(Clone, Copy)]
struct PointEdges {
    faces: u32,
    /// The sum of the edges' unit directions.
    axis: Vec3<f64>,
    /// The least cosine between an edge and the axis.
    min_cosine: f64,
    /// The greatest such cosine.
    max_cosine: f64,
}

impl PointEdges {
    /// The tip of the faces around the point, seen as their corner `which`.
    fn tip(&self, which: Vertex) -> Tip {
        if self.min_cosine <= MIN_SHARP_COSINE || MAX_FACES < self.faces {
            return Tip::Nowhere;
        }
        if self.faces <= MAX_NARROW_FACES {
            return Tip::Narrow;
        }
        // The width across the point per distance from it, seen from where that is smallest.
        let tangent = (1.0 - self.max_cosine.powi(2)).max(0.0).sqrt() / self.max_cosine;
        Tip::round(which, 2.0 * tangent)
    }
}

/// Returns for each triangle where it tapers, at a border edge or at a sharp corner: seen from the side, it is
/// narrower there than the mesh is thick. `points` numbers the corners, `borders` are the triangles on borders.
pub fn tips(
    triangles: &[PackedTriangle<f64>],
    points: &[[u32; 3]],
    borders: impl Iterator<Item = u32>,
) -> Vec<Tip> {
    let around = around_points(triangles, points);
    let tip = |corners: &[u32; 3]| {
        let tips = [0, 1, 2].map(|at| around[corners[at] as usize].tip(Vertex::ALL[at]));
        let mut tips = tips.into_iter().filter(|tip| *tip != Tip::Nowhere);
        match (tips.next(), tips.next()) {
            (only, None) => only.unwrap_or(Tip::Nowhere),
            _ => Tip::Narrow,
        }
    };
    let mut tips: Vec<Tip> = points.iter().map(tip).collect();
    for face in borders {
        tips[face as usize] = Tip::Narrow;
    }
    tips
}

/// Collects the edges at each point.
fn around_points(triangles: &[PackedTriangle<f64>], points: &[[u32; 3]]) -> Vec<PointEdges> {
    let count = count_corners(points);
    let empty = PointEdges {
        faces: 0,
        axis: Vec3::splat(0.0),
        min_cosine: 1.0,
        max_cosine: 0.0,
    };
    let mut around = vec![empty; count as usize];
    for (triangle, numbers) in triangles.iter().zip(points) {
        for (corner, &number) in numbers.iter().enumerate() {
            let point = &mut around[number as usize];
            point.faces += 1;
            for edge in edges_from(triangle, corner) {
                point.axis = point.axis + edge;
            }
        }
    }
    for (triangle, numbers) in triangles.iter().zip(points) {
        for (corner, &number) in numbers.iter().enumerate() {
            let point = &mut around[number as usize];
            let axis = point.axis.try_normalize();
            let axis = axis.unwrap_or(Vec3::splat(0.0));
            for edge in edges_from(triangle, corner) {
                let cosine = axis.dot(edge);
                point.min_cosine = point.min_cosine.min(cosine);
                point.max_cosine = point.max_cosine.max(cosine);
            }
        }
    }
    around
}

/// The unit directions from a corner of a triangle to the other corners.
fn edges_from(triangle: &PackedTriangle<f64>, corner: usize) -> [Vec3<f64>; 2] {
    let at = |step: usize| triangle.corners[(corner + step) % 3];
    let towards = |step: usize| (at(step) - at(0)).try_normalize();
    [1, 2].map(|step| towards(step).unwrap_or(Vec3::splat(0.0)))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// A pyramid with this number of sides and this height, its apex first; closed by a base, or open.
    fn pyramid(sides: u32, height: f64, has_base: bool) -> Vec<Tip> {
        let place = |number: u32| match number {
            0 => DVec3::Y * height,
            1 => DVec3::ZERO,
            _ => {
                let turn = f64::from(number - 2) / f64::from(sides) * std::f64::consts::TAU;
                DVec3::new(turn.cos(), 0.0, turn.sin())
            }
        };
        let rim = |side: u32| 2 + side % sides;
        let mut faces: Vec<[u32; 3]> = (0..sides).map(|n| [0, rim(n + 1), rim(n)]).collect();
        if has_base {
            faces.extend((0..sides).map(|n| [1, rim(n), rim(n + 1)]));
        }
        let packed = |face: &[u32; 3]| PackedTriangle::of_mesh(face.map(place));
        let triangles: Vec<_> = faces.iter().filter_map(packed).collect();
        let borders: Vec<u32> = if has_base {
            Vec::new()
        } else {
            (0..sides).collect()
        };
        tips(&triangles, &faces, borders.into_iter())
    }

    #[test]
    fn the_sides_of_a_spike_have_a_tip_and_its_base_has_none() {
        let are_all = |tips: &[Tip], tip: Tip| tips.iter().all(|found| *found == tip);
        let found = pyramid(4, 5.0, true);
        assert!(are_all(&found[..4], Tip::Narrow), "{found:?}");
        assert!(are_all(&found[4..], Tip::Nowhere), "{found:?}");
        let flat = pyramid(4, 0.5, true);
        assert!(are_all(&flat, Tip::Nowhere), "{flat:?}");
        let open = pyramid(4, 0.5, false);
        assert!(are_all(&open, Tip::Narrow), "{open:?}");
        // Two fifths as wide as the distance from the apex, which is the first corner of each face.
        let cone = pyramid(40, 5.0, true);
        assert!(are_all(&cone[..40], Tip::round(Vertex::A, 0.4)), "{cone:?}");
        assert!(are_all(&cone[40..], Tip::Nowhere), "{cone:?}");
        let rounder = pyramid(MAX_FACES + 1, 5.0, true);
        assert!(are_all(&rounder, Tip::Nowhere), "{rounder:?}");
    }
}
