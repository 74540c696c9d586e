//! The camera as a function of time.

use std::array;
use std::f64::consts::PI;
use std::ops::Range;

use glam::DVec3;

use super::{ArcLengthSpline, Closing, Curve};
use crate::scene::{Camera, Easing, Interpolation, Key, Orientation, SAME_TIME, wrapped_angle};

/// Distance from the axis of an orbit below which a position counts as on it, as a share of the other end's
/// distance.
const ON_AXIS: f64 = 1e-9;

/// What is interpolated besides the position: yaw, pitch and roll in radians, and the logarithms of the projection
/// distance and the orthographic height.
type CameraNumbers = [f64; 5];

/// Camera keys prepared for evaluation at any time.
#[derive(Clone, Debug)]
pub struct CameraPath {
    keys: Vec<Key<Camera>>,
    /// Those of the keys. Each angle has the full turns that make it nearest to the one before, so that the camera
    /// never turns the longer way.
    numbers: Vec<CameraNumbers>,
    /// For each key that begins a smooth segment, the index of its run and its index in that run; `None` for others.
    smooth_segments: Vec<Option<(usize, usize)>>,
    runs: Vec<Run>,
}

/// Consecutive smooth segments.
#[derive(Clone, Debug)]
struct Run {
    route: ArcLengthSpline,
    /// Arc length over time.
    pace: Curve,
    /// The [`CameraNumbers`] over time.
    curves: [Curve; 5],
}

impl CameraPath {
    /// Creates the path through `keys`, which are in order of time.
    pub fn new(keys: &[Key<Camera>]) -> Self {
        let cameras = keys.iter().map(|key| &key.value);
        let turns = keys.windows(2).map(|pair| match pair[0].interpolation {
            Interpolation::Orbit { around } => {
                orbit_turn(around, pair[0].value.position, pair[1].value.position)
            }
            _ => 0.0,
        });
        let turns = std::iter::once(0.0).chain(turns);
        let angles = unwound(cameras.clone().map(Orientation::of).zip(turns));
        let numbers = cameras.zip(angles).map(|(camera, angles)| {
            let (zoom, height) = (camera.projection_distance, camera.orthographic_height);
            let Orientation { yaw, pitch, roll } = angles;
            [yaw, pitch, roll, zoom.ln(), height.ln()]
        });
        let mut path = Self {
            keys: keys.to_vec(),
            numbers: numbers.collect(),
            smooth_segments: Vec::new(),
            runs: Vec::new(),
        };
        for run in keys.chunk_by(|key, _| key.interpolation == Interpolation::Smooth) {
            let (start, number) = (path.smooth_segments.len(), path.runs.len());
            let segments = (1..run.len()).map(|end| Some((number, end - 1)));
            path.smooth_segments.extend(segments.chain([None]));
            if run.len() > 1 {
                path.runs.push(path.run(start..start + run.len()));
            }
        }
        path
    }

    fn run(&self, range: Range<usize>) -> Run {
        let keys = &self.keys[range.clone()];
        let numbers = &self.numbers[range];
        // Only a flight that is a single run from start to end can be closed.
        let is_whole = keys.len() == self.keys.len();
        let closing = if is_whole && is_closed(&keys[0].value, &keys[keys.len() - 1].value) {
            Closing::Closed
        } else {
            Closing::Open
        };
        let times: Vec<f64> = keys.iter().map(|key| key.time).collect();
        let curve = |values: Vec<f64>| Curve::new(times.clone(), values, closing);
        let points: Vec<DVec3> = keys.iter().map(|key| key.value.position).collect();
        let route = ArcLengthSpline::new(&points, closing);
        Run {
            pace: curve(route.lengths_at_points().to_vec()),
            route,
            curves: array::from_fn(|n| curve(numbers.iter().map(|numbers| numbers[n]).collect())),
        }
    }

    /// The keys.
    pub fn keys(&self) -> &[Key<Camera>] {
        &self.keys
    }

    /// Returns the camera at `time` in seconds; before the first and after the last key, it is that of the key.
    /// `None` without keys. At the time of a key, the result is exactly that key's camera.
    pub fn at(&self, time: f64) -> Option<Camera> {
        let (i, along) = segment_at(&self.keys, time)?;
        Some(match along {
            None => self.keys[i].value.clone(),
            Some(along) => self.between(i, along),
        })
    }

    /// Returns the camera after a share of the way from the key `i` to the next one.
    fn between(&self, i: usize, along: f64) -> Camera {
        let (from, to) = (&self.keys[i].value, &self.keys[i + 1].value);
        let smooth = self.smooth_segments[i].map(|(run, index)| (&self.runs[run], index));
        let position = match (smooth, self.keys[i].interpolation) {
            (Some((run, index)), _) => {
                let position = run.route.at(run.pace.at(index, along));
                let moved = position.filter(|_| from.position != to.position);
                moved.unwrap_or(from.position)
            }
            (None, Interpolation::Orbit { around }) => {
                orbit(around, from.position, to.position, along)
            }
            (None, _) => from.position + (to.position - from.position) * along,
        };
        let (start, end) = (self.numbers[i], self.numbers[i + 1]);
        let numbers = match smooth {
            Some((run, index)) => run.curves.each_ref().map(|curve| curve.at(index, along)),
            None => array::from_fn(|n| start[n] + (end[n] - start[n]) * along),
        };
        let [yaw, pitch, roll, zoom, height] = numbers;
        let zoomed = |a: f64, b: f64, log: f64| if a == b { a } else { log.exp() };
        let camera = Camera {
            position,
            projection_distance: zoomed(from.projection_distance, to.projection_distance, zoom),
            orthographic_height: zoomed(from.orthographic_height, to.orthographic_height, height),
            ..from.clone()
        };
        // Without rotation, the key's own vectors are kept, so that a constant orientation is exactly constant.
        if smooth.is_some() && numbers[..3] == start[..3] {
            camera
        } else {
            Orientation { yaw, pitch, roll }.apply(&camera)
        }
    }
}

/// Returns the index of the key whose value is shown at `time` in seconds: before the first and after the last key, it
/// is that key. Between two values, it is the first key, with the share of the path covered to the next one. `None`
/// without keys.
pub(super) fn segment_at<T>(keys: &[Key<T>], time: f64) -> Option<(usize, Option<f64>)> {
    let after = keys.partition_point(|key| key.time <= time);
    let i = after.saturating_sub(1);
    let from = keys.get(i)?;
    let Some(to) = keys.get(i + 1).filter(|_| time > from.time) else {
        return Some((i, None));
    };
    if from.interpolation == Interpolation::Hold {
        let is_next = to.time - time < SAME_TIME;
        return Some((i + usize::from(is_next), None));
    }
    let along = (time - from.time) / (to.time - from.time);
    Some((i, Some(eased(from.easing, along))))
}

/// Returns the share of the path covered after a share `along` of the time.
fn eased(easing: Easing, along: f64) -> f64 {
    match easing {
        Easing::Even => along,
        Easing::In => along * along,
        Easing::Out => along * (2.0 - along),
        Easing::InOut => along * along * (3.0 - 2.0 * along),
    }
}

/// Returns the position at a share of an arc around the vertical axis through `around`. Angle, radius and height
/// change uniformly, the angle in the shorter direction. From and to a point on the axis, the path is straight.
pub(super) fn orbit(around: DVec3, from: DVec3, to: DVec3, along: f64) -> DVec3 {
    let (start, end) = (from - around, to - around);
    let (near, far) = (start.x.hypot(start.z), end.x.hypot(end.z));
    let first = angle_about_axis(if near < far && is_on_axis(near, far) {
        end
    } else {
        start
    });
    let turn = orbit_turn(around, from, to);
    let radius = near + (far - near) * along;
    let (sine, cosine) = (first + turn * along).sin_cos();
    let height = start.y + (end.y - start.y) * along;
    around + DVec3::new(radius * cosine, height, radius * sine)
}

/// Returns the angle by which [`orbit`] turns from one point to the other, at most half a turn.
fn orbit_turn(around: DVec3, from: DVec3, to: DVec3) -> f64 {
    let (start, end) = (from - around, to - around);
    if is_on_axis(start.x.hypot(start.z), end.x.hypot(end.z)) {
        return 0.0;
    }
    shorter_turn(angle_about_axis(end) - angle_about_axis(start))
}

/// The angle of a point about the vertical axis, from x towards z, as the yaw of cameras counts.
fn angle_about_axis(point: DVec3) -> f64 {
    point.z.atan2(point.x)
}

/// Returns whether one of two distances from the axis is only rounding noise, and so is the angle of its point.
fn is_on_axis(one: f64, other: f64) -> bool {
    one.min(other) <= ON_AXIS * one.max(other)
}

/// Returns the equivalent angle of at most half a turn.
fn shorter_turn(turn: f64) -> f64 {
    let wound = wrapped_angle(turn);
    // Half a turn is equally long in both directions: the positive one is chosen.
    if wound == -PI { PI } else { wound }
}

/// Adds full turns to each angle, so that it is nearest to the one before. Each orientation comes with the angle by
/// which its position turns about a vertical axis on the way to it: the yaw is nearest to the one before plus that, so
/// that what looks at the axis goes on looking at it.
pub(super) fn unwound(angles: impl Iterator<Item = (Orientation, f64)>) -> Vec<Orientation> {
    let mut unwound: Vec<Orientation> = Vec::new();
    for (angles, turn) in angles {
        let next = match unwound.last() {
            None => angles,
            Some(last) => {
                let (direct, turned) = (last.yaw, last.yaw + turn);
                let yaw = nearest_equivalent(angles.yaw, direct);
                // What does not turn along with half a turn is as near by rounding alone.
                let is_other_way = (yaw - turned).abs() > PI + 1e-9;
                Orientation {
                    yaw: if is_other_way {
                        nearest_equivalent(yaw, turned)
                    } else {
                        yaw
                    },
                    roll: nearest_equivalent(angles.roll, last.roll),
                    ..angles
                }
            }
        };
        unwound.push(next);
    }
    unwound
}

/// Adds full turns to `angle`, so that it is nearest to `to`. If none are needed, it is returned unchanged.
pub(super) fn nearest_equivalent(angle: f64, to: f64) -> f64 {
    let turn = angle - to;
    if turn.abs() < PI {
        angle
    } else {
        to + shorter_turn(turn)
    }
}

/// Returns whether both cameras are the same, so that a flight from one to the other is closed.
fn is_closed(first: &Camera, last: &Camera) -> bool {
    let is_close = |a: f64, b: f64| (a - b).abs() <= 1e-9;
    // Angles half a turn either way are the same.
    let same_angle = |a: f64, b: f64| is_close(a.sin(), b.sin()) && is_close(a.cos(), b.cos());
    let (a, b) = (Orientation::of(first), Orientation::of(last));
    first.position == last.position
        && same_angle(a.yaw, b.yaw)
        && is_close(a.pitch, b.pitch)
        && same_angle(a.roll, b.roll)
        && first.projection_distance == last.projection_distance
        && first.orthographic_height == last.orthographic_height
}
