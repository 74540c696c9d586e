//! The camera over time.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{ArcLengthSpline, Closing, Curve};
use crate::scene::{Camera, Easing, Interpolation, Key, Orientation, SAME_TIME};

/// How near to the axis of an orbit a place counts as on it, as a share of how far the other is.
const ON_AXIS: f64 = 1e-9;

/// Keys, ready to be asked for the camera at any time.
#[derive(Clone, Debug)]
pub struct CameraPath {
    keys: Vec<Key<Camera>>,
    /// Yaw, pitch and roll of the keys, each the nearest to the one before: a turn never takes the
    /// longer way.
    angles: Vec<Orientation>,
    /// For each segment that is smooth, its run and its place in that.
    smooth: Vec<Option<(usize, usize)>>,
    runs: Vec<Run>,
}

/// Smooth segments one after the other.
#[derive(Clone, Debug)]
struct Run {
    route: ArcLengthSpline,
    /// Length over time.
    pace: Curve,
    yaw: Curve,
    pitch: Curve,
    roll: Curve,
    /// Logarithm of the projection distance.
    zoom: Curve,
    /// Logarithm of the orthographic height.
    height: Curve,
}

impl CameraPath {
    /// The path through `keys`, which are in order of time.
    pub fn new(keys: &[Key<Camera>]) -> Self {
        let angles = unwound(keys.iter().map(|key| Orientation::of(&key.value)));
        let mut path = Self {
            keys: keys.to_vec(),
            angles,
            smooth: vec![None; keys.len().saturating_sub(1)],
            runs: Vec::new(),
        };
        let is_smooth = |i: usize| keys[i].interpolation == Interpolation::Smooth;
        let mut start = 0;
        while start + 1 < keys.len() {
            let mut end = start;
            while end + 1 < keys.len() && is_smooth(end) {
                path.smooth[end] = Some((path.runs.len(), end - start));
                end += 1;
            }
            if end > start {
                path.runs.push(path.run(start, end));
            }
            start = end.max(start + 1);
        }
        path
    }

    fn run(&self, start: usize, end: usize) -> Run {
        let keys = &self.keys[start..=end];
        let angles = &self.angles[start..=end];
        // Only a flight that is one run from its start to its end can be a round.
        let is_whole = start == 0 && end + 1 == self.keys.len();
        let closing = if is_whole && is_round(&keys[0].value, &keys[keys.len() - 1].value) {
            Closing::Closed
        } else {
            Closing::Open
        };
        let times: Vec<f64> = keys.iter().map(|key| key.time).collect();
        let curve = |values: Vec<f64>| Curve::new(times.clone(), values, closing);
        let angle = |of: fn(&Orientation) -> f64| curve(angles.iter().map(of).collect());
        let lens =
            |of: fn(&Camera) -> f64| curve(keys.iter().map(|key| of(&key.value).ln()).collect());
        let points: Vec<DVec3> = keys.iter().map(|key| key.value.position).collect();
        let route = ArcLengthSpline::new(&points, closing);
        Run {
            pace: curve(route.reached().to_vec()),
            route,
            yaw: angle(|angles| angles.yaw),
            pitch: angle(|angles| angles.pitch),
            roll: angle(|angles| angles.roll),
            zoom: lens(|camera| camera.projection_distance),
            height: lens(|camera| camera.orthographic_height),
        }
    }

    /// The keys.
    pub fn keys(&self) -> &[Key<Camera>] {
        &self.keys
    }

    /// The camera at `time` in seconds: before the first key as there, after the last as there;
    /// `None` without keys. At the time of a key it is that key's camera, bit by bit.
    pub fn at(&self, time: f64) -> Option<Camera> {
        let after = self.keys.partition_point(|key| key.time <= time);
        let Some(i) = after.checked_sub(1) else {
            return self.keys.first().map(|key| key.value.clone());
        };
        let from = &self.keys[i];
        let Some(to) = self.keys.get(i + 1).filter(|_| time > from.time) else {
            return Some(from.value.clone());
        };
        let along = eased(from.easing, (time - from.time) / (to.time - from.time));
        let camera = match (from.interpolation, self.smooth[i]) {
            (Interpolation::Hold, _) if to.time - time < SAME_TIME => to.value.clone(),
            (Interpolation::Hold, _) => from.value.clone(),
            (_, Some((run, index))) => self.on_curve(i, &self.runs[run], index, along),
            (Interpolation::Orbit { around }, _) => {
                let position = orbit(around, from.value.position, to.value.position, along);
                Camera {
                    position,
                    ..self.straight(i, along)
                }
            }
            (Interpolation::Linear | Interpolation::Smooth, _) => self.straight(i, along),
        };
        Some(camera)
    }

    fn straight(&self, i: usize, along: f64) -> Camera {
        let (from, to) = (&self.keys[i].value, &self.keys[i + 1].value);
        let (start, end) = (self.angles[i], self.angles[i + 1]);
        let mix = |a: f64, b: f64| a + (b - a) * along;
        let angles = Orientation {
            yaw: mix(start.yaw, end.yaw),
            pitch: mix(start.pitch, end.pitch),
            roll: mix(start.roll, end.roll),
        };
        let zoom = |a: f64, b: f64| if a == b { a } else { mix(a.ln(), b.ln()).exp() };
        angles.apply(&Camera {
            position: from.position + (to.position - from.position) * along,
            projection_distance: zoom(from.projection_distance, to.projection_distance),
            orthographic_height: zoom(from.orthographic_height, to.orthographic_height),
            ..from.clone()
        })
    }

    /// `i` is the segment's place in the path, `place` that in its run.
    fn on_curve(&self, i: usize, run: &Run, index: usize, along: f64) -> Camera {
        let (from, to) = (&self.keys[i].value, &self.keys[i + 1].value);
        let position = match run.route.at(run.pace.at(index, along)) {
            Some(position) if from.position != to.position => position,
            _ => from.position,
        };
        let start = self.angles[i];
        let turned = Orientation {
            yaw: run.yaw.at(index, along),
            pitch: run.pitch.at(index, along),
            roll: run.roll.at(index, along),
        };
        let zoom = |a: f64, b: f64, curve: &Curve| {
            if a == b {
                a
            } else {
                curve.at(index, along).exp()
            }
        };
        let camera = Camera {
            position,
            projection_distance: zoom(from.projection_distance, to.projection_distance, &run.zoom),
            orthographic_height: zoom(
                from.orthographic_height,
                to.orthographic_height,
                &run.height,
            ),
            ..from.clone()
        };
        // Angles that stay keep the key's own vectors: what is held is held bit by bit.
        if turned == start {
            camera
        } else {
            turned.apply(&camera)
        }
    }
}

/// The share of the way that is done at a share of the time.
pub(super) fn eased(easing: Easing, along: f64) -> f64 {
    match easing {
        Easing::Even => along,
        Easing::In => along * along,
        Easing::Out => along * (2.0 - along),
        Easing::InOut => along * along * (3.0 - 2.0 * along),
    }
}

/// The place at a share of an arc around the vertical axis through `around`: angle, radius and
/// height change evenly, the angle the shorter way. From the axis, and to it, the way is straight.
pub(super) fn orbit(around: DVec3, from: DVec3, to: DVec3, along: f64) -> DVec3 {
    let (start, end) = (from - around, to - around);
    let angle = |v: DVec3| v.z.atan2(v.x);
    let (near, far) = (start.x.hypot(start.z), end.x.hypot(end.z));
    // A place on the axis has no angle but that of rounding.
    let is_on_axis = near.min(far) <= ON_AXIS * near.max(far);
    let (first, turn) = if is_on_axis {
        (angle(if near < far { end } else { start }), 0.0)
    } else {
        (angle(start), shorter(angle(end) - angle(start)))
    };
    let radius = near + (far - near) * along;
    let (sine, cosine) = (first + turn * along).sin_cos();
    let height = start.y + (end.y - start.y) * along;
    around + DVec3::new(radius * cosine, height, radius * sine)
}

/// The turn to the same direction that is no longer than half a round.
fn shorter(turn: f64) -> f64 {
    let wound = (turn + PI).rem_euclid(TAU) - PI;
    // Half a round is the same to both sides: to the right.
    if wound == -PI { PI } else { wound }
}

/// Each angle moved by whole rounds to be the nearest to the one before it.
pub(super) fn unwound(angles: impl Iterator<Item = Orientation>) -> Vec<Orientation> {
    let mut unwound: Vec<Orientation> = Vec::new();
    for angles in angles {
        let next = match unwound.last() {
            None => angles,
            Some(last) => Orientation {
                yaw: nearest(angles.yaw, last.yaw),
                roll: nearest(angles.roll, last.roll),
                ..angles
            },
        };
        unwound.push(next);
    }
    unwound
}

/// `angle` plus whole rounds; itself where none is needed, bit by bit.
pub(super) fn nearest(angle: f64, to: f64) -> f64 {
    let turn = angle - to;
    if turn.abs() < PI {
        angle
    } else {
        to + shorter(turn)
    }
}

/// Whether a flight from one to the other comes back to where it began.
fn is_round(first: &Camera, last: &Camera) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9;
    let (a, b) = (Orientation::of(first), Orientation::of(last));
    first.position == last.position
        && near(a.yaw.sin(), b.yaw.sin())
        && near(a.yaw.cos(), b.yaw.cos())
        && near(a.pitch, b.pitch)
        && near(a.roll, b.roll)
        && first.projection_distance == last.projection_distance
        && first.orthographic_height == last.orthographic_height
}
