//! The scene at a time.

use std::sync::Arc;

use glam::DVec3;

use super::path::{eased, orbit};
use super::{ArcLengthSpline, CameraPath, Closing, Curve};
use crate::scene::{Camera, Interpolation, Key, Orientation, Owners, Scene, Value};

/// The scene as it is at `time` in seconds, seen by its own camera: every track has set its value.
pub fn pose(scene: &Arc<Scene>, time: f64) -> Arc<Scene> {
    if scene.animation.tracks.is_empty() {
        return Arc::clone(scene);
    }
    let tracks = &scene.animation.tracks;
    let owners = Owners::of(scene, tracks.iter().map(|track| &track.target));
    let mut posed = Scene::clone(scene);
    for track in tracks {
        if let Some(value) = value_at(&track.keys, time) {
            owners.set(&mut posed, &track.target, value);
        }
    }
    Arc::new(posed)
}

/// The scene as the animation shows it at `time`: posed, and through the camera of the keys, if
/// there are any.
pub fn shot(scene: &Arc<Scene>, path: &CameraPath, time: f64) -> Arc<Scene> {
    let mut posed = pose(scene, time);
    if let Some(camera) = path.at(time)
        && camera != posed.camera
    {
        Arc::make_mut(&mut posed).camera = camera;
    }
    posed
}

/// The value of a track's keys; `None` without keys.
fn value_at(keys: &[Key<Value>], time: f64) -> Option<Value> {
    let after = keys.partition_point(|key| key.time <= time);
    let Some(i) = after.checked_sub(1) else {
        return keys.first().map(|key| key.value);
    };
    let from = &keys[i];
    let Some(to) = keys.get(i + 1).filter(|_| time > from.time) else {
        return Some(from.value);
    };
    let along = eased(from.easing, (time - from.time) / (to.time - from.time));
    Some(match (from.value, to.value, from.interpolation) {
        (_, _, Interpolation::Hold) => from.value,
        (Value::Number(_), Value::Number(_), Interpolation::Smooth) => {
            let (run, place) = run_around(keys, i);
            let times = run.iter().map(|key| key.time).collect();
            let values = run.iter().map(|key| number(key.value)).collect();
            Value::Number(Curve::new(times, values, Closing::Open).at(place, along))
        }
        (Value::Number(a), Value::Number(b), _) => Value::Number(a + (b - a) * along),
        (Value::Point(_), Value::Point(_), Interpolation::Smooth) => {
            let (run, place) = run_around(keys, i);
            let times = run.iter().map(|key| key.time).collect();
            let points: Vec<DVec3> = run.iter().map(|key| point(key.value)).collect();
            let route = ArcLengthSpline::new(&points, Closing::Open);
            let pace = Curve::new(times, route.reached().to_vec(), Closing::Open);
            let there = route.at(pace.at(place, along));
            there.map_or(from.value, Value::Point)
        }
        (Value::Point(a), Value::Point(b), Interpolation::Orbit { around }) => {
            Value::Point(orbit(around, a, b, along))
        }
        (Value::Point(a), Value::Point(b), _) => Value::Point(a + (b - a) * along),
        // A checked track has values of one kind.
        _ => from.value,
    })
}

/// The keys that a smooth segment is shaped by, and its place among them.
fn run_around(keys: &[Key<Value>], segment: usize) -> (&[Key<Value>], usize) {
    let is_smooth = |key: &Key<Value>| key.interpolation == Interpolation::Smooth;
    let before = keys[..segment].iter().rev();
    let start = segment - before.take_while(|key| is_smooth(key)).count();
    let after = keys[segment..keys.len() - 1].iter();
    let end = segment + after.take_while(|key| is_smooth(key)).count();
    (&keys[start..=end], segment - start)
}

fn number(value: Value) -> f64 {
    match value {
        Value::Number(number) => number,
        Value::Point(point) => point.length(),
    }
}

fn point(value: Value) -> DVec3 {
    match value {
        Value::Point(point) => point,
        Value::Number(number) => DVec3::splat(number),
    }
}

/// How far a camera moves and turns from one frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraChange {
    /// World units.
    pub distance: f64,
    /// Degrees between the viewing directions, or of roll if that is more.
    pub turn: f64,
}

/// The step from one camera to another.
pub fn motion_between(from: &Camera, to: &Camera) -> CameraChange {
    let (Some(a), Some(b)) = (from.basis(), to.basis()) else {
        return CameraChange::default();
    };
    // Accurate for small angles and for opposite directions: Kahan, "How futile are mindless
    // assessments of roundoff in floating-point computation?", 2006, §12.
    let angle = |a: DVec3, b: DVec3| 2.0 * (a - b).length().atan2((a + b).length());
    let roll = Orientation::of(to).roll - Orientation::of(from).roll;
    let roll = (roll.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
    CameraChange {
        distance: (to.position - from.position).length(),
        turn: angle(a.z_axis, b.z_axis).to_degrees().max(roll.abs()),
    }
}
