//! Where meshes end in something narrower than they are: their borders, and sharp points.

use crate::primitive::{PackedTriangle, Tip, Vertex};
use crate::simd::Vec3;

/// Cosine of the angle that all edges of a sharp point make with their middle, at least.
const SHARP: f64 = 0.75;
/// Most faces around a sharp point that are looked at one by one, wherever they are narrow: those of a round cone are
/// everywhere, and only where they meet is it narrow itself.
const FEW: u32 = 8;
/// Around more faces nothing is looked for: each of them would be, by every ray near their point.
const MOST: u32 = 128;

/// The edges of a point.
#[derive(Clone, Copy)]
struct PointEdges {
    faces: u32,
    /// The sum of their unit directions.
    axis: Vec3<f64>,
    /// The least cosine of one of them with the axis.
    least: f64,
    /// The greatest one.
    greatest: f64,
}

impl PointEdges {
    /// What the faces around it have there, as far as they have it as their corner `which`.
    fn tip(&self, which: Vertex) -> Tip {
        if self.least <= SHARP || MOST < self.faces {
            return Tip::Nowhere;
        }
        if self.faces <= FEW {
            return Tip::Narrow;
        }
        // From one side to the other, seen from where that is least.
        let tangent = (1.0 - self.greatest.powi(2)).max(0.0).sqrt() / self.greatest;
        Tip::round(which, 2.0 * tangent)
    }
}

/// For each triangle where it has an edge that no other has, or a corner that sticks out: seen from the side it is
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

/// The edges of each point.
fn around_points(triangles: &[PackedTriangle<f64>], points: &[[u32; 3]]) -> Vec<PointEdges> {
    let count = points.iter().flatten().max().map_or(0, |last| last + 1);
    let empty = PointEdges {
        faces: 0,
        axis: Vec3::splat(0.0),
        least: 1.0,
        greatest: 0.0,
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
                point.least = point.least.min(cosine);
                point.greatest = point.greatest.max(cosine);
            }
        }
    }
    around
}

/// The unit directions from a corner of a triangle to the others.
fn edges_from(triangle: &PackedTriangle<f64>, corner: usize) -> [Vec3<f64>; 2] {
    let at = |step: usize| triangle.corners[(corner + step) % 3];
    let towards = |step: usize| (at(step) - at(0)).try_normalize();
    [1, 2].map(|step| towards(step).unwrap_or(Vec3::splat(0.0)))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// A closed pyramid of so many sides, this high, its top first; with its base, or open.
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
        // Two fifths as wide as it is far from its top, which each face has as its first corner.
        let cone = pyramid(40, 5.0, true);
        assert!(are_all(&cone[..40], Tip::round(Vertex::A, 0.4)), "{cone:?}");
        assert!(are_all(&cone[40..], Tip::Nowhere), "{cone:?}");
        let rounder = pyramid(MOST + 1, 5.0, true);
        assert!(are_all(&rounder, Tip::Nowhere), "{rounder:?}");
    }
}
