//! Rays from far away that aim close to the rim of a disc.

use glam::DVec3;

use super::map::{Axis, Map, Tries, normal_and_perpendicular, scale_axis, scattered};
use super::subject::MapSubject;
use crate::primitive::{PackedDisc, Primitive as _, Ray};
use crate::scene::Methods;
use crate::simd::Vec3;

/// Distances in radii. For larger ones, the plan uses double precision.
const DISTANCES: [f64; 5] = [1.5, 1e1, 1e2, 1e3, 5e3];
/// Tries per cell for a first look.
const TRIES: u64 = 300;
/// Distance from the rim at which rays aim, in radii: twenty times the rounding error of a ray's coordinates at the
/// largest distance.
const RIM_OFFSET: f64 = 0.006;

/// The map of the only formula. A failure is a hit by a ray that passes the disc, or a miss by one that does not.
pub fn map(effort: u32) -> Map {
    let across = Axis::new("radii away", &DISTANCES);
    Map::measure(
        (
            MapSubject::Disc,
            "hit where the ray passes by or missed where it hits",
        ),
        ("disc".to_owned(), true),
        (across, scale_axis()),
        |distance, scale| {
            let tries = (0..TRIES * u64::from(effort)).filter_map(|n| fails(n, distance, scale));
            Tries::count(tries)
        },
    )
}

fn fails(number: u64, distance: f64, scale: f64) -> Option<bool> {
    let random = |stream| scattered(number, stream) * 2.0 - 1.0;
    let (normal, perpendicular) = normal_and_perpendicular(number)?;
    let towards = DVec3::new(random(6), random(7), random(8)).try_normalize()?;
    let is_hit = number.is_multiple_of(2);
    let radius_share = if is_hit {
        1.0 - RIM_OFFSET
    } else {
        1.0 + RIM_OFFSET
    };
    // If the disc is seen edge-on, its rim is not beside it; such tries are left out.
    let cosine = normal.dot(towards).abs();
    let disc = PackedDisc {
        center: Vec3::<f32>::from_dvec3(towards * (distance * scale)),
        normal: Vec3::from_dvec3(normal),
        radius: scale as f32,
        material: 0,
    };
    let target = towards * distance + perpendicular * radius_share;
    let ray = Ray {
        origin: Vec3::<f32>::splat(0.0),
        direction: Vec3::from_dvec3(target.try_normalize()?),
    };
    (cosine > 0.2).then(|| {
        let t: f32 = disc.intersect_single(&ray, &Methods::default());
        t.is_finite() != is_hit
    })
}
