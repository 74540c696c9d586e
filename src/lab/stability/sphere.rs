//! Rays that hit or pass distant spheres.

use glam::DVec3;

use super::map::{Axis, Map, Tries, scale_axis, scattered};
use super::subject::MapSubject;
use crate::primitive::{PackedSphere, Primitive as _, Ray};
use crate::scene::{Methods, SphereMethod};
use crate::simd::Vec3;

/// Distances in radii. For larger ones, a ray's own coordinates are too coarse for the sphere.
const DISTANCES: [f64; 7] = [3.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
/// Tries per cell for a first look.
const TRIES: u64 = 400;

/// One map per method. A failure is a hit by a ray that passes the sphere, or a miss by one that does not. Rays
/// within a tenth of a radius of the silhouette are not tried.
pub fn maps(effort: u32) -> Vec<Map> {
    Map::of_methods(
        (
            MapSubject::Sphere,
            "hit where the ray passes by or missed where it hits",
        ),
        (Axis::new("radii away", &DISTANCES), scale_axis()),
        |method, distance, scale| {
            let tries = 0..TRIES * u64::from(effort);
            Tries::count(tries.map(|n| fails(method, n, distance, scale)))
        },
    )
}

fn fails(method: SphereMethod, number: u64, distance: f64, scale: f64) -> bool {
    let turn = |stream| scattered(number, stream) * std::f64::consts::TAU;
    let (a, b, c) = (turn(0), turn(1), turn(2));
    let towards = DVec3::new(a.cos() * b.cos(), b.sin(), a.sin() * b.cos());
    let Some(perpendicular) = towards
        .cross(DVec3::new(c.cos(), 0.3, c.sin()))
        .try_normalize()
    else {
        return false;
    };
    let is_hit = number.is_multiple_of(2);
    let offset_in_radii = if is_hit {
        0.9 * scattered(number, 4)
    } else {
        1.1 + scattered(number, 3)
    };
    let center = (towards * distance + perpendicular * offset_in_radii) * scale;
    let sphere = PackedSphere {
        center: Vec3::<f32>::from_dvec3(center),
        radius: scale as f32,
        material: 0,
    };
    let ray = Ray {
        origin: Vec3::splat(0.0_f32),
        direction: Vec3::from_dvec3(towards),
    };
    let methods = Methods {
        sphere: method,
        ..Methods::default()
    };
    let t: f32 = sphere.intersect_single(&ray, &methods);
    t.is_finite() != is_hit
}
