//! Rays that hit a plane at grazing angles.

use super::map::{Axis, Map, Tries, normal_and_perpendicular, scale_axis, scattered};
use super::subject::MapSubject;
use crate::primitive::{PackedPlane, Primitive as _, Ray};
use crate::scene::Methods;
use crate::simd::{Real as _, Vec3};

/// Angles between ray and plane, in degrees.
const ANGLES: [f64; 6] = [45.0, 10.0, 1.0, 0.1, 0.01, 0.001];
/// Tries per cell for a first look.
const TRIES: u64 = 200;

/// The map of the only formula. A failure is an error of the distance of more than 16u / sin(angle): twice the 8u /
/// sin(angle) that rounding must cost. The true distance is that of the rounded ray and plane.
pub fn map(effort: u32) -> Map {
    let across = Axis::new("degrees", &ANGLES);
    Map::measure(
        (
            MapSubject::Plane,
            "distance off by more than 16u / sin(angle)",
        ),
        ("plane".to_owned(), true),
        (across, scale_axis()),
        |angle, scale| {
            let tries = (0..TRIES * u64::from(effort)).filter_map(|n| fails(n, angle, scale));
            Tries::count(tries)
        },
    )
}

fn fails(number: u64, angle: f64, scale: f64) -> Option<bool> {
    let (normal, tangent) = normal_and_perpendicular(number)?;
    let (sine, cosine) = angle.to_radians().sin_cos();
    let direction = tangent * cosine - normal * sine;
    let plane = PackedPlane {
        normal: Vec3::<f32>::from_dvec3(normal),
        offset: (-scale * (1.0 + scattered(number, 6))) as f32,
        material: 0,
    };
    let ray = Ray {
        origin: Vec3::<f32>::from_dvec3(tangent * (scale * (scattered(number, 7) * 2.0 - 1.0))),
        direction: Vec3::from_dvec3(direction),
    };
    let found = f64::from(plane.intersect_single(&ray, &Methods::default()));
    let (n, o, d) = (
        plane.normal.to_dvec3(),
        ray.origin.to_dvec3(),
        ray.direction.to_dvec3(),
    );
    let truth = (f64::from(plane.offset) - n.dot(o)) / n.dot(d);
    // A ray that rounding has turned away from the plane is not expected to hit it.
    (truth > 0.0).then(|| {
        let allowed = 16.0 * f64::from(f32::UNIT_ROUNDOFF) / sine;
        (found - truth).abs() > allowed * truth.abs()
    })
}
