//! Changing the timing and the smoothness of a flight.

use super::path::nearest_equivalent;
use super::{CameraChange, CameraPath, motion_between};
use crate::scene::{
    Animation, Camera, Easing, Interpolation, Key, MAX_SECONDS, Orientation, Track,
};

/// Number of steps in which the length of a segment is measured.
const STEPS_PER_SEGMENT: usize = 16;
/// Smallest time between keys at constant speed (before scaling), and shortest flight, in seconds.
const MIN_KEY_GAP: f64 = 1.0 / 240.0;
/// Share of the flight's mean speed below which a segment is a pause.
const PAUSE_SHARE: f64 = 0.05;
/// Length that a rotation by one radian counts as, as a share of the length of the path; so does a zoom by a factor
/// of e.
const TURN_SHARE: f64 = 0.2;

/// A way of changing the timing of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Retime {
    /// Constant speed; the duration is unchanged.
    ConstantSpeed,
    /// Pauses, in which nothing moves, are removed.
    TrimPauses,
    /// Each inner key moves towards the straight line between its neighbours.
    Smooth,
}

impl Retime {
    /// All variants.
    pub const ALL: [Self; 3] = [Self::ConstantSpeed, Self::TrimPauses, Self::Smooth];

    /// Name and description.
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::ConstantSpeed => (
                "Constant speed",
                "The camera moves equally fast all the time; keys of values stay",
            ),
            Self::TrimPauses => (
                "Trim pauses",
                "Removes the time in which the camera does not move; keys of values stay",
            ),
            Self::Smooth => ("Smooth", "Rounds the corners of the flight"),
        }
    }

    /// Returns the keys with the new timing. Cuts are kept.
    pub fn apply(self, keys: &[Key<Camera>]) -> Vec<Key<Camera>> {
        if keys.len() < 2 {
            return keys.to_vec();
        }
        match self {
            Self::ConstantSpeed => constant_speed(keys),
            Self::TrimPauses => trimmed(keys),
            Self::Smooth => smoothed(keys),
        }
    }
}

/// Returns the animation with a camera flight of `seconds`. Keys of tracks after its start are scaled with it.
#[must_use]
pub fn stretched(animation: &Animation, seconds: f64) -> Animation {
    let [first, .., last] = &animation.keys[..] else {
        return animation.clone();
    };
    let start = first.time;
    let seconds = seconds.min(longest_flight(animation));
    let scale = seconds.max(MIN_KEY_GAP) / (last.time - start);
    let tracks = animation.tracks.iter().map(|track| Track {
        target: track.target.clone(),
        keys: scaled(&track.keys, start, scale),
    });
    Animation {
        keys: scaled(&animation.keys, start, scale),
        tracks: tracks.collect(),
        ..animation.clone()
    }
}

/// Returns the longest duration of the flight in seconds for which no key is after [`MAX_SECONDS`].
pub fn longest_flight(animation: &Animation) -> f64 {
    let [first, .., last] = &animation.keys[..] else {
        return MAX_SECONDS;
    };
    let tracks = animation.tracks.iter();
    let ends = tracks.filter_map(|track| Some(track.keys.last()?.time));
    let latest = ends.fold(last.time, f64::max);
    (MAX_SECONDS - first.time) * (last.time - first.time) / (latest - first.time)
}

/// Scales the times of all keys after `start`, relative to it.
fn scaled<T: Clone>(keys: &[Key<T>], start: f64, scale: f64) -> Vec<Key<T>> {
    let rescaled = |key: &Key<T>| Key {
        time: if key.time > start {
            (start + (key.time - start) * scale).min(MAX_SECONDS)
        } else {
            key.time
        },
        ..key.clone()
    };
    keys.iter().map(rescaled).collect()
}

/// Returns the length of each segment: that of its curve, or of its rotation and zoom if larger. Cuts have no
/// length.
fn lengths(keys: &[Key<Camera>]) -> Vec<f64> {
    let path = CameraPath::new(keys);
    let segment = |pair: &[Key<Camera>]| {
        let mut sum = CameraChange::default();
        if pair[0].interpolation == Interpolation::Hold {
            return sum;
        }
        let step = (pair[1].time - pair[0].time) / STEPS_PER_SEGMENT as f64;
        let at = |n: usize| path.at(pair[0].time + step * n as f64);
        let cameras: Vec<Camera> = (0..=STEPS_PER_SEGMENT).filter_map(at).collect();
        for [from, to] in cameras.array_windows() {
            let motion = motion_between(from, to);
            sum.distance += motion.distance;
            sum.turn += motion.turn;
            sum.zoom += motion.zoom;
        }
        sum
    };
    let motions: Vec<CameraChange> = keys.windows(2).map(segment).collect();
    let path_length: f64 = motions.iter().map(|motion| motion.distance).sum();
    // If the camera never moves, only rotations and zooms count.
    let length_per_radian = if path_length > 0.0 {
        path_length * TURN_SHARE
    } else {
        1.0
    };
    let length = |motion: &CameraChange| {
        let turned = motion.turn.to_radians().max(motion.zoom);
        motion.distance.max(turned * length_per_radian)
    };
    motions.iter().map(length).collect()
}

fn constant_speed(keys: &[Key<Camera>]) -> Vec<Key<Camera>> {
    let lengths = lengths(keys);
    let hold_seconds: f64 = keys
        .windows(2)
        .filter(|pair| pair[0].interpolation == Interpolation::Hold)
        .map(|pair| pair[1].time - pair[0].time)
        .sum();
    let (start, end) = (keys[0].time, keys[keys.len() - 1].time);
    let seconds_per_length = (end - start - hold_seconds) / lengths.iter().sum::<f64>();
    if !seconds_per_length.is_finite() {
        return keys.to_vec();
    }
    let step = |i: usize| {
        if keys[i].interpolation == Interpolation::Hold {
            keys[i + 1].time - keys[i].time
        } else {
            (lengths[i] * seconds_per_length).max(MIN_KEY_GAP)
        }
    };
    let mut retimed = with_steps(keys, step);
    for key in &mut retimed {
        // Easing would vary the speed.
        key.easing = Easing::Even;
    }
    // Compensates for steps that were lengthened to the minimum.
    let last = retimed.last().map_or(end, |key| key.time);
    scaled(&retimed, start, (end - start) / (last - start))
}

/// Returns, for each segment, whether next to nothing moves in it.
fn pauses(keys: &[Key<Camera>]) -> Vec<bool> {
    let lengths = lengths(keys);
    let seconds = |i: usize| keys[i + 1].time - keys[i].time;
    let total: f64 = (0..lengths.len()).map(seconds).sum();
    let mean = lengths.iter().sum::<f64>() / total;
    let is_pause = |i: usize| {
        let is_cut = keys[i].interpolation == Interpolation::Hold;
        !is_cut && lengths[i] / seconds(i) <= mean * PAUSE_SHARE
    };
    (0..lengths.len()).map(is_pause).collect()
}

/// Returns the total duration of all pauses in seconds.
pub fn paused_seconds(keys: &[Key<Camera>]) -> f64 {
    if keys.len() < 2 {
        return 0.0;
    }
    let pairs = pauses(keys).into_iter().zip(keys.windows(2));
    pairs
        .filter(|(is_pause, _)| *is_pause)
        .map(|(_, pair)| pair[1].time - pair[0].time)
        .sum()
}

fn trimmed(keys: &[Key<Camera>]) -> Vec<Key<Camera>> {
    let pauses = pauses(keys);
    if pauses.iter().all(|is_pause| *is_pause) {
        // A flight that is a single pause would vanish.
        return keys.to_vec();
    }
    let step = |i: usize| {
        if pauses[i] {
            0.0
        } else {
            keys[i + 1].time - keys[i].time
        }
    };
    // Of two keys that coincide now, the one after the pause is kept.
    let is_kept = pauses.iter().map(|is_pause| !is_pause).chain([true]);
    let retimed = with_steps(keys, step).into_iter().zip(is_kept);
    retimed
        .filter_map(|(key, is_kept)| is_kept.then_some(key))
        .collect()
}

/// Returns the keys with new time steps between them.
fn with_steps(keys: &[Key<Camera>], step: impl Fn(usize) -> f64) -> Vec<Key<Camera>> {
    let mut time = keys[0].time;
    let retimed = keys.iter().enumerate().map(|(index, key)| {
        if index > 0 {
            time += step(index - 1);
        }
        Key {
            time,
            ..key.clone()
        }
    });
    retimed.collect()
}

fn smoothed(keys: &[Key<Camera>]) -> Vec<Key<Camera>> {
    let mut smooth = keys.to_vec();
    for i in 1..keys.len() - 1 {
        // Cuts are intended, and arcs have no corners.
        let has_no_corner = |key: &Key<Camera>| {
            matches!(
                key.interpolation,
                Interpolation::Hold | Interpolation::Orbit { .. }
            )
        };
        if has_no_corner(&keys[i - 1]) || has_no_corner(&keys[i]) {
            continue;
        }
        let (before, here, after) = (&keys[i - 1].value, &keys[i].value, &keys[i + 1].value);
        // The mean of the key and of the position on a straight flight at its time.
        let share = (keys[i].time - keys[i - 1].time) / (keys[i + 1].time - keys[i - 1].time);
        let straight = |a: f64, b: f64, c: f64| (b + a + (c - a) * share) / 2.0;
        let angles = [before, here, after].map(Orientation::of);
        let middle = angles[1];
        let turn = |of: fn(&Orientation) -> f64| {
            let here = of(&middle);
            straight(
                nearest_equivalent(of(&angles[0]), here),
                here,
                nearest_equivalent(of(&angles[2]), here),
            )
        };
        let turned = Orientation {
            yaw: turn(|angles| angles.yaw),
            pitch: turn(|angles| angles.pitch),
            roll: turn(|angles| angles.roll),
        };
        let straight_position = before.position + (after.position - before.position) * share;
        smooth[i].value = turned.apply(&Camera {
            position: (here.position + straight_position) * 0.5,
            ..here.clone()
        });
    }
    smooth
}
