//! Rays from inside a closed mesh that aim at its edges and corners: each must hit something.

use glam::DVec3;

use super::map::{Map, Tries, offset_axis, placed, scale_axis, scattered};
use super::subject::MapSubject;
use crate::primitive::{Culling, PackedTriangle, Primitive as _, Ray, Slicing, Tip};
use crate::scene::{Methods, TriangleMethod};
use crate::simd::Vec3;

/// Tries per cell for a first look.
const TRIES: u64 = 300;
/// A point inside the mesh, but not its centre.
const INSIDE: DVec3 = DVec3::new(0.11, -0.07, 0.05);

/// One map per method.
pub fn maps(effort: u32) -> Vec<Map> {
    let ball = ball();
    Map::of_methods(
        (
            MapSubject::Triangle,
            "ray from inside a closed mesh that hits nothing",
        ),
        (offset_axis(), scale_axis()),
        |method, away, scale| {
            let mesh: Vec<PackedTriangle<f32>> = ball
                .iter()
                .map(|&face| placed_triangle(face, away, scale))
                .collect();
            let origin = Vec3::<f32>::from_dvec3(placed(INSIDE, away, scale));
            let tries = 0..TRIES * u64::from(effort);
            Tries::count(tries.filter_map(|n| leaks(method, &mesh, origin, n)))
        },
    )
}

/// Returns whether the ray leaks out of the mesh; `None` if the target gives no direction.
fn leaks(
    method: TriangleMethod,
    mesh: &[PackedTriangle<f32>],
    origin: Vec3<f32>,
    number: u64,
) -> Option<bool> {
    let [a, b, _] = mesh[number as usize % mesh.len()].corners;
    // Half of the rays aim at a corner, the rest at points on edges.
    let along = if number.is_multiple_of(2) {
        0.0
    } else {
        scattered(number, 0) as f32
    };
    let direction = (a + (b - a) * along - origin).to_dvec3().try_normalize()?;
    let ray = Ray {
        origin,
        direction: Vec3::from_dvec3(direction),
    };
    let methods = Methods {
        triangle: method,
        ..Methods::default()
    };
    let is_hit = |face: &PackedTriangle<f32>| face.intersect_single(&ray, &methods).is_finite();
    Some(!mesh.iter().any(is_hit))
}

fn placed_triangle(corners: [DVec3; 3], away: f64, scale: f64) -> PackedTriangle<f32> {
    let to_world = |corner: DVec3| Vec3::<f32>::from_dvec3(placed(corner, away, scale));
    let [a, b, c] = corners.map(to_world);
    let normal = (c - a).to_dvec3().cross((b - a).to_dvec3());
    PackedTriangle {
        corners: [a, b, c],
        normal: Vec3::from_dvec3(normal.try_normalize().unwrap_or(normal)),
        in_mesh: true,
        thickness: 1.0,
        wider: 0.0,
        tip: Tip::Nowhere,
        culling: Culling::Lit,
        slicing: Slicing::WHOLE,
        longest: 1.0,
        material: 0,
    }
}

/// An octahedron whose faces are split twice and projected onto the sphere around them.
pub(super) fn ball() -> Vec<[DVec3; 3]> {
    let to_sphere = |v: DVec3| v * (1.0 / v.length());
    let mut faces = Vec::new();
    for x in [-1.0, 1.0] {
        for y in [-1.0, 1.0] {
            for z in [-1.0, 1.0] {
                // Rotated, so that no edge is parallel to an axis.
                let turn = |v: DVec3| {
                    let (x, y) = (0.8 * v.x - 0.6 * v.y, 0.6 * v.x + 0.8 * v.y);
                    DVec3::new(x, y * 0.96 - v.z * 0.28, y * 0.28 + v.z * 0.96)
                };
                faces.push([
                    turn(DVec3::new(x, 0.0, 0.0)),
                    turn(DVec3::new(0.0, y, 0.0)),
                    turn(DVec3::new(0.0, 0.0, z)),
                ]);
            }
        }
    }
    for _ in 0..2 {
        let split = faces.iter().flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (to_sphere(a + b), to_sphere(b + c), to_sphere(c + a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        faces = split.collect();
    }
    faces
}
