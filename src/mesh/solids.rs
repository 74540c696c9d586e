//! Generated solids: closed, centred on the origin, wound clockwise seen from outside.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::triangles::Triangles;

/// How often each face of the icosahedron is divided into four.
const HALVINGS: u32 = 2;

/// Sides of round solids.
const SIDES: u32 = 48;
/// Sides of the tube of a torus.
const TUBE_SIDES: u32 = 24;

/// Largest angle in degrees between faces that are shaded as one surface: round sides look curved, rims stay sharp.
const ROUND_SMOOTHING: f64 = 30.0;

/// A kind of solid.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    /// Its name.
    pub name: &'static str,
    /// Makes one of the given size.
    pub make: fn(f64) -> Triangles,
    /// Largest angle in degrees between faces that are shaded as one surface; 0 for flat faces.
    pub smooth: f64,
}

const fn flat(name: &'static str, make: fn(f64) -> Triangles) -> Solid {
    Solid {
        name,
        make,
        smooth: 0.0,
    }
}

const fn round(name: &'static str, make: fn(f64) -> Triangles) -> Solid {
    Solid {
        name,
        make,
        smooth: ROUND_SMOOTHING,
    }
}

/// All kinds of solids.
pub const SOLIDS: [Solid; 6] = [
    flat("Box", cuboid),
    flat("Tetrahedron", tetrahedron),
    round("Icosphere", |size| icosphere(size / 2.0)),
    round("Cylinder", |size| {
        revolved(&[(size / 2.0, size / 2.0), (size / 2.0, -size / 2.0)])
    }),
    round("Cone", |size| {
        revolved(&[(0.0, size / 2.0), (size / 2.0, -size / 2.0)])
    }),
    round("Torus", torus),
];

fn cuboid(size: f64) -> Triangles {
    let half = size / 2.0;
    let corner = |index: u32| {
        let coordinate = |bit: u32| if index >> bit & 1 == 1 { half } else { -half };
        DVec3::new(coordinate(0), coordinate(1), coordinate(2))
    };
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let faces = sides
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, c, b], [a, d, c]]);
    Triangles::of((0..8).map(corner).collect(), faces.collect())
}

fn tetrahedron(size: f64) -> Triangles {
    let corners = [
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, -1.0],
        [1.0, -1.0, -1.0],
        [-1.0, -1.0, 1.0],
    ];
    let points = corners.map(|corner| DVec3::from(corner) * (size / 2.0));
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    Triangles::of(points.to_vec(), faces)
}

/// Makes the solid of revolution of an outline of (radius, height), from the top down, around y. Ends that do not
/// come to a point are closed by flat discs.
fn revolved(outline: &[(f64, f64)]) -> Triangles {
    let mut points = Vec::new();
    let mut rings: Vec<Vec<u32>> = Vec::new();
    let mut add = |point: DVec3| {
        points.push(point);
        points.len() as u32 - 1
    };
    let first = outline.first().map(|&(_, height)| (0.0, height));
    let last = outline.last().map(|&(_, height)| (0.0, height));
    let all = first.into_iter().chain(outline.iter().copied()).chain(last);
    for (radius, height) in all {
        let angles = (0..SIDES).map(|side| f64::from(side) / f64::from(SIDES) * TAU);
        rings.push(if radius == 0.0 {
            vec![add(DVec3::Y * height); SIDES as usize]
        } else {
            let point = |angle: f64| DVec3::new(angle.cos() * radius, height, angle.sin() * radius);
            angles.map(|angle| add(point(angle))).collect()
        });
    }
    Triangles::of(points, faces_between(&rings))
}

fn torus(size: f64) -> Triangles {
    let (radius, tube) = (size * 0.35, size * 0.15);
    let mut points = Vec::new();
    let mut rings = Vec::new();
    for ring in 0..=TUBE_SIDES {
        let turn = f64::from(ring % TUBE_SIDES) / f64::from(TUBE_SIDES) * TAU;
        let (across, height) = (radius + tube * turn.cos(), -tube * turn.sin());
        let start = ring % TUBE_SIDES * SIDES;
        rings.push((start..start + SIDES).collect());
        if ring < TUBE_SIDES {
            points.extend((0..SIDES).map(|side| {
                let angle = f64::from(side) / f64::from(SIDES) * TAU;
                DVec3::new(angle.cos() * across, height, angle.sin() * across)
            }));
        }
    }
    Triangles::of(points, faces_between(&rings))
}

/// The faces between consecutive rings of points, each of which lies below or outside the previous one.
fn faces_between(rings: &[Vec<u32>]) -> Vec<[u32; 3]> {
    let mut faces = Vec::new();
    for [upper, lower] in rings.array_windows() {
        for side in 0..upper.len() {
            let next = (side + 1) % upper.len();
            let (a, b, c, d) = (upper[side], upper[next], lower[next], lower[side]);
            for face in [[a, d, c], [a, c, b]] {
                let [x, y, z] = face;
                if x != y && y != z && z != x {
                    faces.push(face);
                }
            }
        }
    }
    faces
}

/// A globe of 4 · `rings` · (`rings` − 1) triangles around the origin, with its poles on the y axis and a radius for
/// each polar angle and azimuth, in radians.
pub fn globe(rings: u32, radius: impl Fn(f64, f64) -> f64) -> Triangles {
    let columns = 2 * rings;
    let point_at = |ring: u32, column: u32| {
        let polar = f64::from(ring) / f64::from(rings) * PI;
        let azimuth = f64::from(column) / f64::from(columns) * TAU;
        let (x, z) = (azimuth.cos() * polar.sin(), azimuth.sin() * polar.sin());
        DVec3::new(x, polar.cos(), z) * radius(polar, azimuth)
    };
    let mut points = vec![point_at(0, 0), point_at(rings, 0)];
    for ring in 1..rings {
        points.extend((0..columns).map(|column| point_at(ring, column)));
    }
    let number = |ring: u32, column: u32| match ring {
        0 => 0,
        _ if ring == rings => 1,
        _ => 2 + (ring - 1) * columns + column % columns,
    };
    let mut faces = Vec::new();
    for ring in 0..rings {
        for column in 0..columns {
            let (a, b) = (number(ring, column), number(ring, column + 1));
            let (c, d) = (number(ring + 1, column + 1), number(ring + 1, column));
            if ring > 0 {
                faces.push([a, c, b]);
            }
            if ring + 1 < rings {
                faces.push([a, d, c]);
            }
        }
    }
    Triangles::of(points, faces)
}

/// A sphere of 320 triangles around the origin: a subdivided icosahedron.
pub fn icosphere(radius: f64) -> Triangles {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points = Vec::new();
    for (a, b) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        points.extend([
            DVec3::new(0.0, a, b),
            DVec3::new(a, b, 0.0),
            DVec3::new(b, 0.0, a),
        ]);
    }
    let mut faces = nearest_triples(&points);
    for _ in 0..HALVINGS {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push(points[a as usize] + points[b as usize]);
                points.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(faces.len() * 4);
        for [a, b, c] in faces {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
        for point in &mut points {
            *point = point.normalize();
        }
    }
    let points = points.iter().map(|point| *point * radius).collect();
    Triangles::of(points, faces)
}

/// Finds all triples of neighbouring points, clockwise seen from outside.
fn nearest_triples(points: &[DVec3]) -> Vec<[u32; 3]> {
    // The edges of the icosahedron above have length 2, all other distances are more than 3.
    let is_edge = |a: usize, b: usize| (points[a] - points[b]).length() < 2.5;
    let count = points.len();
    let mut faces = Vec::new();
    for a in 0..count {
        for b in (a + 1..count).filter(|&b| is_edge(a, b)) {
            for c in (b + 1..count).filter(|&c| is_edge(a, c) && is_edge(b, c)) {
                let normal = (points[c] - points[a]).cross(points[b] - points[a]);
                let is_outwards = normal.dot(points[a]) > 0.0;
                let face = if is_outwards { [a, b, c] } else { [a, c, b] };
                faces.push(face.map(|point| point as u32));
            }
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::are_closed;

    #[test]
    fn solids_are_closed_and_look_outwards() {
        for Solid { name, make, smooth } in SOLIDS {
            let solid = make(2.0);
            assert!(are_closed(solid.corners()), "{name} is open");
            let volume: f64 = solid
                .corners()
                .map(|[a, b, c]| a.dot(c.cross(b)) / 6.0)
                .sum();
            assert!((0.3..8.1).contains(&volume), "{name}: {volume}");
            let (low, high) = solid.bounds().expect("it has an end");
            assert!((high - low).max_element() <= 2.0 + 1e-12, "{name}");
            // Solids that are marked as round must be fine enough to look so, and have no rims that would be smoothed
            // away.
            let normals: Vec<DVec3> = solid
                .corners()
                .map(|[a, b, c]| (c - a).cross(b - a))
                .collect();
            let mut faces_of: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
            for (face, &[a, b, c]) in solid.faces().iter().enumerate() {
                for (a, b) in [(a, b), (b, c), (c, a)] {
                    faces_of.entry((a.min(b), a.max(b))).or_default().push(face);
                }
            }
            for pair in faces_of.values() {
                let angle = normals[pair[0]]
                    .angle_between(normals[pair[1]])
                    .to_degrees();
                let (is_rim, is_curve) =
                    (angle > 60.0, (1e-4..ROUND_SMOOTHING * 0.8).contains(&angle));
                assert!(angle < 1e-4 || is_rim || is_curve, "{name}: {angle}");
                assert!(smooth > 0.0 || !is_curve, "{name} is round: {angle}");
            }
        }
    }
}
