//! Simplifying a take of hundreds of samples to a few keys that show nearly the same.

use std::collections::BTreeSet;

use glam::DVec3;

use super::CameraPath;
use super::smoothing::smoothed;
use crate::scene::{Camera, Interpolation, Key, SAME_TIME, Sample, Take};

/// Number of keys on each side that the removal of a key affects: a smooth segment is shaped by its neighbours.
const REACH: usize = 3;

/// Smallest shift of the picture that counts as a jump, in image heights.
const MIN_JUMP: f64 = 0.02;
/// Smallest ratio of a jump to the usual shift.
const JUMP_FACTOR: f64 = 6.0;
/// Number of steps on each side from which the usual shift is determined.
const JUMP_WINDOW: usize = 6;

/// Widths in seconds with which a take may be smoothed, widest first.
const SMOOTHING: [f64; 6] = [0.6, 0.4, 0.25, 0.15, 0.08, 0.04];

/// A position in a picture, and what is seen there: its shift in the picture of another camera measures that
/// camera's deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmark {
    /// Position in the picture, in image heights from its centre, y up.
    pub at: [f64; 2],
    /// The visible point of the scene in world units; for the sky, the direction.
    pub what: DVec3,
    /// Whether only sky is seen there.
    pub is_sky: bool,
}

/// A take simplified to a few keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplified {
    /// The keys, at times of samples.
    pub keys: Vec<Key<Camera>>,
    /// Largest deviation of the picture at any sample.
    pub worst: WorstDeviation,
    /// Number of jumps: shifts of the picture from one sample to the next that are larger than by hand.
    pub jumps: usize,
}

/// The largest deviation of keys from a take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WorstDeviation {
    /// Deviation of the picture, in image heights.
    pub deviation: f64,
    /// When it occurs, in seconds of the keys.
    pub time: f64,
}

/// Returns the largest shift of the landmarks in the picture of another camera, in image heights. Infinite if one
/// is behind that camera.
pub fn deviation(camera: &Camera, landmarks: &[Landmark]) -> f64 {
    let Some(framing) = camera.framing() else {
        return f64::INFINITY;
    };
    let shifts = landmarks.iter().map(|landmark| {
        let projected = if landmark.is_sky {
            framing.project_direction(landmark.what)
        } else {
            framing.project(landmark.what)
        };
        let distance = |[x, y]: [f64; 2]| (x - landmark.at[0]).hypot(y - landmark.at[1]);
        projected.map_or(f64::INFINITY, distance)
    });
    shifts.fold(0.0, f64::max)
}

/// Chooses keys at as few samples as needed for a deviation of at most `tolerance` image heights everywhere.
/// `landmarks` holds those of each sample.
///
/// Hands tremble: if the tolerance allows, the keys are taken from a smoothed flight, which itself deviates by at
/// most half the tolerance.
pub fn simplify(take: &Take, landmarks: &[Vec<Landmark>], tolerance: f64) -> Simplified {
    let (cuts, jumps) = (cuts(take), jumps(take, landmarks));
    let edges: BTreeSet<usize> = cuts.union(&jumps).copied().collect();
    let jump_count = jumps.difference(&cuts).count();
    let search = Search {
        take,
        // Jumps must not be smoothed.
        cameras: smoothed_cameras(take, &edges, landmarks, tolerance / 2.0),
        landmarks,
        tolerance,
        cuts,
        edges,
    };
    let mut chosen = search.refined(search.ends());
    search.prune(&mut chosen);
    // Where keys coincide, a curve is shaped by keys farther away than pruning considers.
    let chosen = search.refined(chosen);
    let keys = search.keys(&chosen);
    let worst = worst_deviation(&CameraPath::new(&keys), take, landmarks, ends_of(&keys));
    Simplified {
        keys,
        worst,
        jumps: jump_count,
    }
}

/// Returns the cameras of a take, smoothed as far as the tolerance allows.
fn smoothed_cameras(
    take: &Take,
    cuts: &BTreeSet<usize>,
    landmarks: &[Vec<Landmark>],
    tolerance: f64,
) -> Vec<Camera> {
    let is_within_tolerance = |cameras: &Vec<Camera>| {
        let mut pairs = cameras.iter().zip(landmarks);
        pairs.all(|(camera, landmarks)| deviation(camera, landmarks) <= tolerance)
    };
    let smooth = SMOOTHING
        .iter()
        .map(|&seconds| smoothed(take, cuts, seconds));
    let mut smooth = smooth.filter(is_within_tolerance);
    let unsmoothed = || {
        (0..take.samples.len())
            .filter_map(|n| take.camera(n))
            .collect()
    };
    smooth.next().unwrap_or_else(unsmoothed)
}

/// Returns the times of the first and the last key; `None` without keys.
pub fn ends_of(keys: &[Key<Camera>]) -> Option<(f64, f64)> {
    Some((keys.first()?.time, keys.last()?.time))
}

/// Returns the largest deviation of a path from a take. `span` is the time span of the path in which the take is
/// flown. Samples before the first and after the last key are ignored.
pub fn worst_deviation(
    path: &CameraPath,
    take: &Take,
    landmarks: &[Vec<Landmark>],
    span: Option<(f64, f64)>,
) -> WorstDeviation {
    let (Some((start, end)), Some(ends), [first, .., last]) =
        (span, ends_of(path.keys()), &take.samples[..])
    else {
        let deviation = f64::INFINITY;
        return WorstDeviation {
            deviation,
            time: 0.0,
        };
    };
    let scale = (end - start) / (last.0 - first.0);
    let time_of = |sample: &Sample| start + (sample.0 - first.0) * scale;
    let covered = ends.0 - SAME_TIME..=ends.1 + SAME_TIME;
    let samples = take.samples.iter().zip(landmarks);
    let samples = samples.filter(|(sample, _)| covered.contains(&time_of(sample)));
    let deviations = samples.map(|(sample, landmarks)| {
        let time = time_of(sample);
        let camera = path.at(time);
        let deviation = camera.map_or(f64::INFINITY, |camera| deviation(&camera, landmarks));
        WorstDeviation { deviation, time }
    });
    deviations.fold(WorstDeviation::default(), |worst, candidate| {
        if candidate.deviation > worst.deviation {
            candidate
        } else {
            worst
        }
    })
}

struct Search<'t> {
    take: &'t Take,
    /// The camera of each sample, from which keys are made.
    cameras: Vec<Camera>,
    landmarks: &'t [Vec<Landmark>],
    tolerance: f64,
    /// The last samples before changes of projection.
    cuts: BTreeSet<usize>,
    /// The cuts, and the last samples before jumps.
    edges: BTreeSet<usize>,
}

/// Returns the samples after which the projection changes.
fn cuts(take: &Take) -> BTreeSet<usize> {
    let changes = take.lenses.windows(2).filter_map(|pair| {
        let is_cut = pair[0].projection != pair[1].projection;
        is_cut.then(|| pair[1].from - 1)
    });
    changes.collect()
}

/// Returns the samples after which the picture shifts much farther than around them: a script or a touchpad moved
/// the mouse, or the machine was busy.
fn jumps(take: &Take, landmarks: &[Vec<Landmark>]) -> BTreeSet<usize> {
    let cameras = (1..take.samples.len()).map(|n| take.camera(n));
    let steps: Vec<f64> = cameras
        .zip(landmarks)
        .map(|(camera, landmarks)| camera.map_or(0.0, |camera| deviation(&camera, landmarks)))
        .collect();
    let is_jump = |n: &usize| {
        let around = n.saturating_sub(JUMP_WINDOW)..(n + 1 + JUMP_WINDOW).min(steps.len());
        let others = around.filter(|other| other != n).map(|other| steps[other]);
        let mut others: Vec<f64> = others.collect();
        others.sort_by(f64::total_cmp);
        let usual = others.get(others.len() / 2).copied().unwrap_or(0.0);
        // A short turn between two rests takes three samples or more. It is not a jump, though most steps around it
        // are still.
        let near = n.saturating_sub(2)..(n + 3).min(steps.len());
        let mut near: Vec<f64> = near.map(|near| steps[near]).collect();
        near.sort_by(f64::total_cmp);
        let third_largest = near.iter().rev().nth(2).copied().unwrap_or(0.0);
        steps[*n] > MIN_JUMP.max(usual.max(third_largest) * JUMP_FACTOR)
    };
    (0..steps.len()).filter(is_jump).collect()
}

impl Search<'_> {
    fn keys<'c>(&self, chosen: impl IntoIterator<Item = &'c usize>) -> Vec<Key<Camera>> {
        let key = |&sample: &usize| {
            let camera = self.cameras.get(sample)?.clone();
            let mut key = Key::new(self.take.samples[sample].0, camera);
            if self.cuts.contains(&sample) {
                key.interpolation = Interpolation::Hold;
            }
            Some(key)
        };
        chosen.into_iter().filter_map(key).collect()
    }

    fn deviation_at(&self, path: &CameraPath, sample: usize) -> f64 {
        let camera = path.at(self.take.samples[sample].0);
        let landmarks = self.landmarks.get(sample).map_or(&[][..], Vec::as_slice);
        camera.map_or(f64::INFINITY, |camera| deviation(&camera, landmarks))
    }

    /// Returns the sample with the largest deviation, if that exceeds the tolerance.
    fn worst(&self, path: &CameraPath, samples: impl Iterator<Item = usize>) -> Option<usize> {
        let deviations = samples.map(|sample| (sample, self.deviation_at(path, sample)));
        let worst = deviations.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (worst.1 > self.tolerance).then_some(worst.0)
    }

    /// Returns the samples that are always keys: the ends, and both sides of cuts and jumps.
    fn ends(&self) -> BTreeSet<usize> {
        let last = self.take.samples.len().saturating_sub(1);
        let edges = self.edges.iter().flat_map(|&edge| [edge, edge + 1]);
        [0, last].into_iter().chain(edges).collect()
    }

    /// Adds the worst sample of each stretch until no deviation exceeds the tolerance.
    fn refined(&self, mut chosen: BTreeSet<usize>) -> BTreeSet<usize> {
        loop {
            let samples: Vec<usize> = chosen.iter().copied().collect();
            let path = CameraPath::new(&self.keys(&samples));
            let stretches = samples.windows(2);
            let worst: Vec<usize> = stretches
                .filter_map(|ends| self.worst(&path, ends[0] + 1..ends[1]))
                .collect();
            if worst.is_empty() {
                return chosen;
            }
            chosen.extend(worst);
        }
    }

    /// Removes keys that later ones made unnecessary.
    fn prune(&self, chosen: &mut BTreeSet<usize>) {
        let inner: Vec<usize> = chosen.iter().copied().collect();
        let inner = inner.get(1..inner.len().saturating_sub(1)).unwrap_or(&[]);
        for &sample in inner {
            if self.edges.contains(&sample) || (sample > 0 && self.edges.contains(&(sample - 1))) {
                continue;
            }
            let mut window: Vec<usize> = chosen
                .range(..sample)
                .rev()
                .take(REACH + 1)
                .copied()
                .collect();
            window.reverse();
            let before = window.len();
            window.extend(chosen.range(sample + 1..).take(REACH + 1));
            let path = CameraPath::new(&self.keys(&window));
            // The outermost stretches also depend on keys outside the window.
            let first = window[usize::from(before > REACH)];
            let is_cut_off = window.len() - before > REACH;
            let last = window[window.len() - 1 - usize::from(is_cut_off)];
            if self.worst(&path, first..=last).is_none() {
                chosen.remove(&sample);
            }
        }
    }
}
