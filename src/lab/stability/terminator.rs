//! The terminator on smoothly shaded faces: points on a ball of triangles that are lit on the curved surface, but
//! shadowed by the ball's own flat faces.

use std::sync::Arc;

use glam::DVec3;

use super::map::{Axis, Map, Tries, scattered};
use super::subject::MapSubject;
use crate::mesh::Triangles;
use crate::plan::PackedMesh;
use crate::primitive::{Curved, PackedTriangle, Primitive as _, Ray, SurfacePoint};
use crate::scene::{Mesh, Methods};
use crate::simd::Vec3;

/// How often each face of an octahedron is split into four.
const SPLITS: [u32; 4] = [1, 2, 3, 4];
/// Elevation of the light above the curved surface, in degrees.
const HEIGHTS: [f64; 5] = [1.0, 3.0, 10.0, 20.0, 40.0];
/// Tries per cell for a first look.
const TRIES: u64 = 150;
/// Rounding error of a coordinate on the ball.
const SLACK: f32 = 1e-6;

/// One map for each point where shadow rays can start: on the curved surface, or on the flat face.
pub fn maps(effort: u32) -> Vec<Map> {
    let balls = SPLITS.map(ball);
    let map = |method: &str, is_lifted| {
        let across = Axis {
            name: "faces",
            values: balls
                .iter()
                .map(|ball| ball.triangles.len() as f64)
                .collect(),
        };
        let up = Axis::new("degrees of light", &HEIGHTS);
        Map::measure(
            (MapSubject::Terminator, "lit point that is dark"),
            (method.to_owned(), is_lifted),
            (across, up),
            |faces, height| {
                let ball = balls
                    .iter()
                    .find(|ball| ball.triangles.len() as f64 == faces);
                let tries = (0..TRIES * u64::from(effort))
                    .filter_map(|n| fails(ball?, n, height, is_lifted));
                Tries::count(tries)
            },
        )
    };
    vec![map("lifted", true), map("flat", false)]
}

/// A ball of radius 1, shaded as one surface.
fn ball(splits: u32) -> Arc<PackedMesh<f32>> {
    let mut points = vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        -DVec3::X,
        -DVec3::Y,
        -DVec3::Z,
    ];
    let mut faces: Vec<[u32; 3]> = (0..8)
        .map(|octant: u32| {
            let end = |axis: u32| axis + 3 * (octant >> axis & 1);
            // Clockwise seen from outside.
            if octant.count_ones().is_multiple_of(2) {
                [end(0), end(2), end(1)]
            } else {
                [end(0), end(1), end(2)]
            }
        })
        .collect();
    for _ in 0..splits {
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let mut middle = |from: u32, to: u32| {
                    points.push((points[from as usize] + points[to as usize]).normalize());
                    points.len() as u32 - 1
                };
                let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    let triangles = Triangles::new(points, faces).unwrap_or_default();
    let packed = PackedMesh::new(&Mesh {
        smooth: 180.0,
        ..Mesh::of(triangles)
    });
    PackedMesh::in_precision(&Arc::new(packed))
}

fn fails(ball: &PackedMesh<f32>, number: u64, height: f64, is_lifted: bool) -> Option<bool> {
    let random = |stream| scattered(number, stream);
    let face_index = (random(0) * ball.triangles.len() as f64) as usize;
    let (face, smooth) = (&ball.triangles[face_index], &ball.smooth[face_index]);
    let point = point_on(face, random(1), random(2));
    let flat = SurfacePoint {
        point,
        normal: face.normal,
        curvature: 0.0,
        slack: SLACK,
        size: 1.0,
    };
    let curved = Curved {
        corners: face.corners,
        normals: smooth.normals,
        curvature: smooth.curvature,
    };
    let curved_point = curved.bend(&flat, -face.normal);
    let normal = curved_point.normal.to_dvec3();
    let tangent = DVec3::new(random(3) - 0.5, random(4) - 0.5, random(5) - 0.5);
    let tangent = normal.cross(tangent).try_normalize()?;
    let (sine, cosine) = height.to_radians().sin_cos();
    let ray = Ray {
        origin: if is_lifted {
            curved_point.point
        } else {
            flat.point + flat.normal * flat.slack
        },
        direction: Vec3::from_dvec3(normal * sine + tangent * cosine),
    };
    let others = ball
        .triangles
        .iter()
        .enumerate()
        .filter(|&(index, _)| index != face_index);
    let mut hits =
        others.map(|(_, other)| -> f32 { other.intersect_single(&ray, &Methods::default()) });
    Some(hits.any(f32::is_finite))
}

/// A point of a triangle: uniform if the two shares are uniform from 0 to 1.
fn point_on(face: &PackedTriangle<f32>, first: f64, second: f64) -> Vec3<f32> {
    let (first, second) = if first + second > 1.0 {
        (1.0 - first, 1.0 - second)
    } else {
        (first, second)
    };
    let [a, b, c] = face.corners;
    a + (b - a) * first as f32 + (c - a) * second as f32
}
