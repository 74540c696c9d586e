//! Rays aimed at a disc near its rim, from far away.

use glam::DVec3;

use super::map::{Axis, Map, Tries, normal_and_aside, scales, scattered};
use super::subject::MapSubject;
use crate::primitive::{PackedDisc, Primitive as _, Ray};
use crate::scene::Methods;
use crate::simd::Vec3;

/// Distances in radii: beyond, the plan takes double precision.
const DISTANCES: [f64; 5] = [1.5, 1e1, 1e2, 1e3, 5e3];
/// Tries in each cell for a first look.
const TRIES: u64 = 300;
/// How far from the rim rays are aimed, in radii: twenty times what the coordinates of a ray from the
/// largest distance are rounded by.
const BESIDE: f64 = 0.006;

/// The one formula: hits where the ray passes by, misses where it does not.
pub fn map(effort: u32) -> Map {
    let across = Axis::new("radii away", &DISTANCES);
    Map::measure(
        (
            MapSubject::Disc,
            "hit where the ray passes by, or missed where it hits",
        ),
        ("disc".to_owned(), true),
        (across, scales()),
        |distance, scale| {
            let tries = (0..TRIES * u64::from(effort)).filter_map(|n| fails(n, distance, scale));
            Tries::count(tries)
        },
    )
}

fn fails(number: u64, distance: f64, scale: f64) -> Option<bool> {
    let random = |stream| scattered(number, stream) * 2.0 - 1.0;
    let (normal, aside) = normal_and_aside(number)?;
    let towards = DVec3::new(random(6), random(7), random(8)).try_normalize()?;
    let is_hit = number.is_multiple_of(2);
    let share = if is_hit { 1.0 - BESIDE } else { 1.0 + BESIDE };
    // Seen edge-on, the rim is nowhere beside the disc.
    let cosine = normal.dot(towards).abs();
    let disc = PackedDisc {
        center: Vec3::<f32>::from_dvec3(towards * (distance * scale)),
        normal: Vec3::from_dvec3(normal),
        radius: scale as f32,
        material: 0,
    };
    let target = towards * distance + aside * share;
    let ray = Ray {
        origin: Vec3::<f32>::splat(0.0),
        direction: Vec3::from_dvec3(target.try_normalize()?),
    };
    (cosine > 0.2).then(|| {
        let t: f32 = disc.meet(&ray, &Methods::default());
        t.is_finite() != is_hit
    })
}
