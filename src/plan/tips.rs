//! Where meshes end in something narrower than they are: their borders, and sharp points.

use crate::primitive::PackedTriangle;
use crate::simd::Vec3;

/// Cosine of the angle that all edges of a sharp point make with their middle, at least.
const SHARP: f64 = 0.75;
/// Most faces around a sharp point that are looked at one by one: those of a round cone are narrow everywhere, and
/// hardly differ.
const FEW: u32 = 8;

/// The edges of a point.
#[derive(Clone, Copy)]
struct Point {
    faces: u32,
    /// The sum of their unit directions.
    axis: Vec3<f64>,
    /// The least cosine of one of them with the axis.
    least: f64,
}

/// For each triangle whether it has an edge that no other has, or a corner that sticks out: seen from the side it is
/// narrower than the mesh is thick. `points` numbers the corners, `borders` are the triangles on borders.
pub fn tips(
    triangles: &[PackedTriangle<f64>],
    points: &[[u32; 3]],
    borders: impl Iterator<Item = u32>,
) -> Vec<bool> {
    let sharp = sharp_points(triangles, points);
    let is_sharp = |corners: &[u32; 3]| corners.iter().any(|&point| sharp[point as usize]);
    let mut tips: Vec<bool> = points.iter().map(is_sharp).collect();
    for face in borders {
        tips[face as usize] = true;
    }
    tips
}

/// For each point whether it sticks out.
fn sharp_points(triangles: &[PackedTriangle<f64>], points: &[[u32; 3]]) -> Vec<bool> {
    let count = points.iter().flatten().max().map_or(0, |last| last + 1);
    let empty = Point {
        faces: 0,
        axis: Vec3::splat(0.0),
        least: 1.0,
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
                point.least = point.least.min(axis.dot(edge));
            }
        }
    }
    let is_sharp = |point: &Point| point.faces <= FEW && SHARP < point.least;
    around.iter().map(is_sharp).collect()
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
    fn pyramid(sides: u32, height: f64, has_base: bool) -> Vec<bool> {
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
        let found = pyramid(4, 5.0, true);
        assert!(found[..4].iter().all(|tip| *tip), "{found:?}");
        assert!(!found[4..].iter().any(|tip| *tip), "{found:?}");
        let flat = pyramid(4, 0.5, true);
        assert!(!flat.iter().any(|tip| *tip), "{flat:?}");
        let cone = pyramid(40, 5.0, true);
        assert!(!cone.iter().any(|tip| *tip), "{cone:?}");
        let open = pyramid(4, 0.5, false);
        assert!(open.iter().all(|tip| *tip), "{open:?}");
    }
}
