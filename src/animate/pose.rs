//! The scene at a given time.

use std::sync::Arc;

use glam::DVec3;

use super::path::{orbit, segment_at};
use super::{ArcLengthSpline, CameraPath, Closing, Curve};
use crate::scene::{Camera, Interpolation, Key, Owners, Projection, Scene, Value};

/// Returns the scene at `time` in seconds, with the values of all tracks applied. The camera is unchanged.
pub fn pose(scene: &Arc<Scene>, time: f64) -> Arc<Scene> {
    if scene.animation.tracks.is_empty() {
        return Arc::clone(scene);
    }
    let tracks = &scene.animation.tracks;
    let owners = Owners::of(scene, scene.animation.targets());
    let mut posed = Scene::clone(scene);
    for track in tracks {
        if let Some(value) = value_at(&track.keys, time) {
            owners.set(&mut posed, &track.target, value);
        }
    }
    Arc::new(posed)
}

/// Returns the scene as the animation shows it at `time`: like [`pose`], with the camera of the path, if it has
/// keys.
pub fn shot(scene: &Arc<Scene>, path: &CameraPath, time: f64) -> Arc<Scene> {
    let mut posed = pose(scene, time);
    if let Some(camera) = path.at(time)
        && camera != posed.camera
    {
        Arc::make_mut(&mut posed).camera = camera;
    }
    posed
}

/// Returns the scene as it is in a frame of its animation, counted from 1.
pub fn shot_of_frame(scene: &Arc<Scene>, frame: u64) -> Arc<Scene> {
    let path = CameraPath::new(&scene.animation.keys);
    shot(scene, &path, scene.animation.time_of(frame))
}

/// Returns the value of a track at a time; `None` without keys.
fn value_at(keys: &[Key<Value>], time: f64) -> Option<Value> {
    let (i, along) = segment_at(keys, time)?;
    let from = &keys[i];
    let Some(along) = along else {
        return Some(from.value);
    };
    Some(match (from.value, keys[i + 1].value, from.interpolation) {
        (Value::Number(_), Value::Number(_), Interpolation::Smooth) => {
            let (run, index) = run_around(keys, i);
            let times = run.iter().map(|key| key.time).collect();
            let values = run.iter().map(|key| number(key.value)).collect();
            Value::Number(Curve::new(times, values, Closing::Open).at(index, along))
        }
        (Value::Number(a), Value::Number(b), _) => Value::Number(a + (b - a) * along),
        (Value::Point(_), Value::Point(_), Interpolation::Smooth) => {
            let (run, index) = run_around(keys, i);
            let times = run.iter().map(|key| key.time).collect();
            let points: Vec<DVec3> = run.iter().map(|key| point(key.value)).collect();
            let route = ArcLengthSpline::with_rests(&points);
            let pace = Curve::new(times, route.lengths_at_points().to_vec(), Closing::Open);
            let position = route.at(pace.at(index, along));
            position.map_or(from.value, Value::Point)
        }
        (Value::Point(a), Value::Point(b), Interpolation::Orbit { around }) => {
            Value::Point(orbit(around, a, b, along))
        }
        (Value::Point(a), Value::Point(b), _) => Value::Point(a + (b - a) * along),
        // Tracks that passed validation have values of one type.
        _ => from.value,
    })
}

/// Returns the keys that determine a smooth segment, and its index among them: its ends, their neighbours, and on
/// each side one more key, at a different position, that shapes the neighbouring segments. These are few even in a
/// long run.
fn run_around(keys: &[Key<Value>], segment: usize) -> (&[Key<Value>], usize) {
    let is_smooth = |key: usize| keys[key].interpolation == Interpolation::Smooth;
    let is_same_value = |key: usize, other: usize| keys[key].value == keys[other].value;
    let mut start = segment;
    while start > 0
        && is_smooth(start - 1)
        && (start + 1 >= segment || is_same_value(start, start + 1))
    {
        start -= 1;
    }
    let mut end = segment + 1;
    while end + 1 < keys.len()
        && is_smooth(end)
        && (end <= segment + 2 || is_same_value(end, end - 1))
    {
        end += 1;
    }
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

/// Change of the camera from one frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CameraChange {
    /// Distance in world units.
    pub distance: f64,
    /// Angle of rotation in degrees, about any axis.
    pub turn: f64,
    /// Absolute natural logarithm of the factor by which the lens changes the size of things.
    pub zoom: f64,
}

/// Returns the change from one camera to another.
pub fn motion_between(from: &Camera, to: &Camera) -> CameraChange {
    let (Some(a), Some(b)) = (from.basis(), to.basis()) else {
        return CameraChange::default();
    };
    // For a rotation by an angle θ about any axis, the squared lengths of the differences of corresponding basis
    // vectors add up to 8 sin²(θ/2), and those of their sums to 8 cos²(θ/2) + 4. Unlike the trace, this is accurate
    // for small angles.
    let axes = [
        (a.x_axis, b.x_axis),
        (a.y_axis, b.y_axis),
        (a.z_axis, b.z_axis),
    ];
    let differences: f64 = axes.iter().map(|(a, b)| (*a - *b).length_squared()).sum();
    let sums: f64 = axes.iter().map(|(a, b)| (*a + *b).length_squared()).sum();
    let half_angle = differences.sqrt().atan2((sums - 4.0).max(0.0).sqrt());
    CameraChange {
        distance: (to.position - from.position).length(),
        turn: (2.0 * half_angle).to_degrees(),
        zoom: match (from.projection, to.projection) {
            (Projection::Perspective, Projection::Perspective) => {
                (to.projection_distance / from.projection_distance).ln()
            }
            (Projection::Orthographic, Projection::Orthographic) => {
                (to.orthographic_height / from.orthographic_height).ln()
            }
            // A change of projection is a cut.
            _ => 0.0,
        }
        .abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Animation;
    use proptest::prelude::*;

    /// Keys at few positions, so that successive ones often coincide, with some segments that are not smooth.
    fn any_keys() -> impl Strategy<Value = Vec<Key<Value>>> {
        let key = (0.1..2.0_f64, 0..3_i32, 0..2_i32, prop::bool::weighted(0.9));
        prop::collection::vec(key, 2..30).prop_map(|keys| {
            let mut time = 0.0;
            let keys = keys.into_iter().map(|(step, x, y, is_smooth)| {
                time += step;
                let place = DVec3::new(f64::from(x), f64::from(y), 0.5);
                Key {
                    interpolation: if is_smooth {
                        Interpolation::Smooth
                    } else {
                        Interpolation::Linear
                    },
                    ..Key::new(time, Value::Point(place))
                }
            });
            keys.collect()
        })
    }

    #[test]
    fn what_is_written_with_six_digits_is_at_its_frame() {
        let hold = |time: f64, value: f64| Key {
            interpolation: Interpolation::Hold,
            ..Key::new(time, Value::Number(value))
        };
        let keys = [hold(0.0, 1.0), hold(0.071_429, 2.0)];
        for (frame, expected) in [(1.0, 2.0), (0.99, 1.0)] {
            assert_eq!(value_at(&keys, frame / 14.0), Some(Value::Number(expected)));
        }
        assert_eq!(Animation::frames_in(0.333_333, 30.0), 11);
        assert_eq!(Animation::frames_in(0.333_33, 30.0), 10);
    }

    /// Returns the whole run of a segment, and the segment's index in it.
    fn run(keys: &[Key<Value>], segment: usize) -> (&[Key<Value>], usize) {
        let is_smooth = |key: &Key<Value>| key.interpolation == Interpolation::Smooth;
        let before = keys[..segment].iter().rev();
        let start = segment - before.take_while(|key| is_smooth(key)).count();
        let after = keys[segment..keys.len() - 1].iter();
        let end = segment + after.take_while(|key| is_smooth(key)).count();
        (&keys[start..=end], segment - start)
    }

    proptest! {
        #[test]
        fn a_segment_is_shaped_as_if_all_keys_of_its_run_were_looked_at(keys in any_keys()) {
            let lengths = keys.iter().map(|key| Key::new(key.time, Value::Number(number(key.value))));
            let numbers: Vec<_> = lengths.zip(&keys).map(|(number, key)| Key {
                interpolation: key.interpolation,
                ..number
            }).collect();
            for segment in 0..keys.len() - 1 {
                if keys[segment].interpolation != Interpolation::Smooth {
                    continue;
                }
                let time = keys[segment].time * 0.7 + keys[segment + 1].time * 0.3;
                let along = (time - keys[segment].time) / (keys[segment + 1].time - keys[segment].time);
                let (whole, index) = run(&keys, segment);
                let times: Vec<f64> = whole.iter().map(|key| key.time).collect();
                let values = whole.iter().map(|key| number(key.value)).collect();
                let expected = Curve::new(times.clone(), values, Closing::Open).at(index, along);
                prop_assert_eq!(value_at(&numbers, time), Some(Value::Number(expected)));
                let points: Vec<DVec3> = whole.iter().map(|key| point(key.value)).collect();
                let route = ArcLengthSpline::with_rests(&points);
                let pace = Curve::new(times, route.lengths_at_points().to_vec(), Closing::Open);
                let expected = route.at(pace.at(index, along)).unwrap_or(points[index]);
                let Some(Value::Point(found)) = value_at(&keys, time) else {
                    return Err(TestCaseError::fail("no point"));
                };
                prop_assert!(found.distance(expected) < 1e-12, "{found} {expected}");
            }
        }
    }
}
