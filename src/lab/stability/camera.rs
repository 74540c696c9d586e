//! The basis of a camera that looks almost straight up, and of one after many turns.

use glam::{DMat3, DVec3};

use super::map::{Axis, Map, Tries, scattered};
use super::subject::MapSubject;

use crate::scene::{Camera, Orientation};
use crate::simd::Vec3;

/// Angles from the vertical, in degrees.
const FROM_POLE: [f64; 8] = [45.0, 1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 0.0];
/// Numbers of frames in which the camera turns.
const FRAMES: [f64; 6] = [1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
/// Tries per cell for a first look.
const TRIES: u64 = 200;
/// Roll in radians that is visible at the border of a picture of 1024 pixels.
const VISIBLE_ROLL: f64 = 1e-3;
/// Allowed deviation of a basis from orthonormality: a tenth of a pixel in 1024.
const MAX_DEVIATION: f64 = 1e-4;

/// One map for each way of keeping a camera level at the pole, and one for each way of storing it through turns.
pub fn maps(effort: u32) -> Vec<Map> {
    let across = || Axis::new("degrees from the pole", &FROM_POLE);
    let pole = |name: &'static str, is_default, right: fn(f64, f64) -> Option<DVec3>| {
        Map::measure(
            (MapSubject::CameraPole, "leans by more than a thousandth"),
            (name.to_owned(), is_default),
            (across(), Axis::one("camera")),
            |degrees, _| {
                let tries = 0..TRIES * u64::from(effort);
                Tries::count(tries.map(|n| leans(n, degrees, right)))
            },
        )
    };
    let frames = || Axis::new("frames", &FRAMES);
    let drift = |name: &'static str, is_default, turned: fn(u64) -> DMat3| {
        Map::measure(
            (MapSubject::CameraTurns, "is no longer an orthonormal basis"),
            (name.to_owned(), is_default),
            (frames(), Axis::one("camera")),
            |frames, _| Tries::count([is_distorted(&turned(frames as u64))]),
        )
    };
    vec![
        pole("yaw and pitch", true, right_from_angles),
        pole("fixed-up f32", false, right_from_fixed_up),
        drift("yaw and pitch", true, basis_from_angles),
        drift("matrix-steps f32", false, basis_from_steps),
    ]
}

/// Returns whether the camera's right is not the horizontal direction that belongs to the yaw.
fn leans(number: u64, degrees: f64, right: fn(f64, f64) -> Option<DVec3>) -> bool {
    let yaw = (scattered(number, 0) * 2.0 - 1.0) * std::f64::consts::PI;
    let pitch = (90.0 - degrees).to_radians();
    let level = DVec3::new(yaw.cos(), 0.0, yaw.sin());
    right(yaw, pitch).is_none_or(|right| (right - level).length() > VISIBLE_ROLL)
}

fn right_from_angles(yaw: f64, pitch: f64) -> Option<DVec3> {
    let angles = Orientation {
        yaw,
        pitch,
        roll: 0.0,
    };
    Some(angles.apply(&Camera::default()).basis()?.x_axis)
}

/// u = up × w with the world's up, in single precision: as in a typical first program.
fn right_from_fixed_up(yaw: f64, pitch: f64) -> Option<DVec3> {
    let (yaw, pitch) = (yaw as f32, pitch as f32);
    let look = Vec3::new(
        yaw.sin() * pitch.cos(),
        pitch.sin(),
        -yaw.cos() * pitch.cos(),
    );
    let across = look.cross(Vec3::new(0.0, 1.0, 0.0));
    Some(across.try_normalize()?.to_dvec3())
}

fn is_distorted(basis: &DMat3) -> bool {
    let (u, v, w) = (basis.x_axis, basis.y_axis, basis.z_axis);
    let errors = [
        u.dot(u) - 1.0,
        v.dot(v) - 1.0,
        w.dot(w) - 1.0,
        u.dot(v),
        v.dot(w),
        w.dot(u),
    ];
    !errors.iter().all(|error| error.abs() <= MAX_DEVIATION)
}

/// Yaw and pitch of one frame: a tenth of a degree each, the pitch to and fro.
fn frame_turn(frame: u64) -> (f64, f64) {
    let tenth = 0.1_f64.to_radians();
    (
        tenth,
        if (frame / 300).is_multiple_of(2) {
            tenth
        } else {
            -tenth
        },
    )
}

/// Stores the angles, and computes the basis from them.
fn basis_from_angles(frames: u64) -> DMat3 {
    let mut angles = Orientation::default();
    for frame in 0..frames {
        let (yaw, pitch) = frame_turn(frame);
        angles = angles.turned(yaw, pitch);
    }
    let basis = angles.apply(&Camera::default()).basis();
    basis.unwrap_or(DMat3::NAN)
}

/// Rotates the stored basis by a small matrix in every frame.
fn basis_from_steps(frames: u64) -> DMat3 {
    let mut basis = [
        Vec3::new(1.0_f32, 0.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(0.0, 0.0, 1.0),
    ];
    for frame in 0..frames {
        let (yaw, pitch) = frame_turn(frame);
        let turned = |v: Vec3<f32>| {
            let (sine, cosine) = (yaw as f32).sin_cos();
            let v = Vec3::new(v.x * cosine - v.z * sine, v.y, v.x * sine + v.z * cosine);
            let (sine, cosine) = (pitch as f32).sin_cos();
            Vec3::new(v.x, v.y * cosine - v.z * sine, v.y * sine + v.z * cosine)
        };
        basis = basis.map(turned);
    }
    let [u, v, w] = basis.map(Vec3::to_dvec3);
    DMat3::from_cols(u, v, w)
}
