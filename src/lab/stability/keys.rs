//! Interpolation between keys of a flight: paths that overshoot, and rotations without a proper direction.

use glam::DVec3;

use super::map::{Axis, Map, Tries, scattered};
use super::subject::MapSubject;
use crate::animate::{CameraPath, motion_between};
use crate::scene::{Camera, Key, Orientation};
use crate::simd::Vec3;

/// Ratios between the lengths of the middle segment and its neighbours; either may be the longer.
const RATIOS: [f64; 7] = [1.0, 2.0, 5.0, 1e1, 1e2, 1e3, 1e4];
/// Angles between the viewing directions of two keys, in degrees.
const ANGLES: [f64; 8] = [1e-6, 1e-3, 1.0, 90.0, 179.0, 179.9, 179.99, 180.0];
/// Tries per cell for a first look.
const TRIES: u64 = 40;
/// Points that are checked between two keys.
const SAMPLES: u32 = 50;
/// Allowed overshoot, as a share of the length of a segment.
const OVERSHOOT: f64 = 1e-6;
/// Allowed deviation of directions from unit length or from right angles.
const MAX_DEVIATION: f64 = 1e-6;

/// One map for each interpolation of points on a line, and for each interpolation of two directions.
pub fn maps(effort: u32) -> Vec<Map> {
    let tries = || 0..TRIES * u64::from(effort);
    let ratios = Axis::new("longest to shortest segment", &RATIOS);
    let angles = Axis::new("degrees between keys", &ANGLES);
    let method = |name: &'static str, is_default, leaves: fn(&[f64; 4]) -> bool| {
        Map::measure(
            (MapSubject::Path, "overshoots a key"),
            (name.to_owned(), is_default),
            (ratios.clone(), Axis::one("flight")),
            |ratio, _| Tries::count(tries().map(|n| leaves(&stops(n, ratio)))),
        )
    };
    let turn = |name: &'static str, is_default, fails: fn(f64, f64) -> bool| {
        Map::measure(
            (MapSubject::Turn, "no direction or a step of twice the mean"),
            (name.to_owned(), is_default),
            (angles.clone(), Axis::one("flight")),
            |degrees, _| {
                let yaw = |n| (scattered(n, 0) * 2.0 - 1.0) * std::f64::consts::PI;
                Tries::count(tries().map(|n| fails(yaw(n), degrees.to_radians())))
            },
        )
    };
    vec![
        method("centripetal", true, path_overshoots),
        method("uniform", false, uniform_overshoots),
        turn("yaw and pitch", true, path_loses_direction),
        turn("straight f32", false, lerp_loses_direction),
        turn("acos-slerp f32", false, slerp_loses_direction),
    ]
}

/// Four points on a line, of which the middle segment is longer or shorter than its neighbours; every third flight
/// reverses its direction there.
fn stops(number: u64, ratio: f64) -> [f64; 4] {
    let (outer, inner) = if number.is_multiple_of(2) {
        (ratio, 1.0)
    } else {
        (1.0, ratio)
    };
    let outer = |stream| outer * (0.5 + scattered(number, stream));
    let sign = if number.is_multiple_of(3) { -1.0 } else { 1.0 };
    let first = outer(0);
    let second = first + inner * sign;
    [0.0, first, second, second + outer(1)]
}

fn leaves_segments(stops: &[f64; 4], position_at: impl Fn(usize, f64) -> f64) -> bool {
    (0..3).any(|segment| {
        let (from, to) = (stops[segment], stops[segment + 1]);
        let slack = (to - from).abs() * OVERSHOOT;
        let (low, high) = (from.min(to) - slack, from.max(to) + slack);
        (0..=SAMPLES).any(|n| {
            let x = position_at(segment, f64::from(n) / f64::from(SAMPLES));
            !(low..=high).contains(&x)
        })
    })
}

fn path_overshoots(stops: &[f64; 4]) -> bool {
    let key = |(n, &x): (usize, &f64)| {
        let position = DVec3::new(x, 0.0, 0.0);
        let camera = Camera {
            position,
            ..Camera::default()
        };
        Key::new(n as f64, camera)
    };
    let path = CameraPath::new(&stops.iter().enumerate().map(key).collect::<Vec<_>>());
    leaves_segments(stops, |segment, along| {
        let camera = path.at(segment as f64 + along);
        camera.map_or(f64::NAN, |camera| camera.position.x)
    })
}

/// The Catmull–Rom spline of textbooks, with the same parameter length for every segment.
///
/// Catmull and Rom, "A class of local interpolating splines", Computer Aided Geometric Design, 1974.
fn uniform_overshoots(stops: &[f64; 4]) -> bool {
    leaves_segments(stops, |segment, u| {
        let (b, c) = (stops[segment], stops[segment + 1]);
        let (a, d) = (
            stops[segment.saturating_sub(1)],
            stops[(segment + 2).min(3)],
        );
        let cubic = 3.0 * (b - c) + d - a;
        0.5 * (2.0 * b + u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * cubic)))
    })
}

/// Returns whether the steps of a rotation are uneven, or one of its directions is invalid.
fn is_uneven(directions: &[Option<DVec3>], angle: f64) -> bool {
    let mean = angle / f64::from(SAMPLES);
    // Comparisons with NaN are false, so NaN counts as a failure.
    let is_unit = |direction: &Option<DVec3>| {
        direction.is_some_and(|direction| (direction.dot(direction) - 1.0).abs() <= MAX_DEVIATION)
    };
    !directions.iter().all(is_unit)
        || !directions.windows(2).all(|pair| match (pair[0], pair[1]) {
            (Some(a), Some(b)) => {
                let step = 2.0 * (a - b).length().atan2((a + b).length());
                // Rounding of directions in single precision, 6e-8, is not the method's fault.
                step <= 2.0 * mean + 2.5e-7
            }
            _ => false,
        })
}

fn direction_of(yaw: f64) -> DVec3 {
    DVec3::new(yaw.sin(), 0.0, -yaw.cos())
}

fn path_loses_direction(yaw: f64, angle: f64) -> bool {
    let key = |time: f64, yaw: f64| {
        let level = Orientation {
            yaw,
            ..Orientation::default()
        };
        Key::new(time, level.apply(&Camera::default()))
    };
    let path = CameraPath::new(&[key(0.0, yaw), key(1.0, yaw + angle)]);
    let camera = |n: u32| path.at(f64::from(n) / f64::from(SAMPLES));
    let cameras: Vec<Option<Camera>> = (0..=SAMPLES).map(camera).collect();
    let is_crooked = |camera: &Option<Camera>| {
        let upright = |camera: &Camera| camera.look_at.dot(camera.up).abs() <= MAX_DEVIATION;
        !camera.as_ref().is_some_and(upright)
    };
    let directions: Vec<_> = cameras
        .iter()
        .map(|camera| camera.as_ref().map(|camera| camera.look_at))
        .collect();
    let total_angle = match (&cameras[0], &cameras[cameras.len() - 1]) {
        (Some(from), Some(to)) => motion_between(from, to).turn.to_radians(),
        _ => f64::NAN,
    };
    let covers_angle = (total_angle - angle).abs() < 1e-6;
    cameras.iter().any(is_crooked) || is_uneven(&directions, angle) || !covers_angle
}

/// Linear interpolation of two unit vectors, normalised.
fn lerp_loses_direction(yaw: f64, angle: f64) -> bool {
    let (a, b) = (direction_of(yaw), direction_of(yaw + angle));
    let (a, b) = (Vec3::<f32>::from_dvec3(a), Vec3::<f32>::from_dvec3(b));
    let at = |n: u32| {
        let along = n as f32 / SAMPLES as f32;
        (a + (b - a) * along).try_normalize().map(Vec3::to_dvec3)
    };
    is_uneven(&(0..=SAMPLES).map(at).collect::<Vec<_>>(), angle)
}

/// Spherical interpolation of directions, after Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985.
fn slerp_loses_direction(yaw: f64, angle: f64) -> bool {
    let (a, b) = (direction_of(yaw), direction_of(yaw + angle));
    let (a, b) = (Vec3::<f32>::from_dvec3(a), Vec3::<f32>::from_dvec3(b));
    let total_angle = a.dot(b).acos();
    let at = |n: u32| {
        let along = n as f32 / SAMPLES as f32;
        let (out, into) = (
            ((1.0 - along) * total_angle).sin(),
            (along * total_angle).sin(),
        );
        let sum = a * (out / total_angle.sin()) + b * (into / total_angle.sin());
        Some(sum.to_dvec3())
    };
    is_uneven(&(0..=SAMPLES).map(at).collect::<Vec<_>>(), angle)
}
