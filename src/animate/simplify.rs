//! From a take of hundreds of samples to few keys that show nearly the same.

use std::collections::BTreeSet;

use glam::DVec3;

use super::CameraPath;
use super::smoothing::smoothed;
use crate::scene::{Camera, Interpolation, Key, SAME_TIME, Sample, Take};

/// Keys to both sides whose removal a key feels: a smooth segment is shaped by its neighbours.
const REACH: usize = 3;

/// Least way of a jump, in image heights.
const JUMP: f64 = 0.02;
/// How many times farther than usual it is.
const JUMP_FACTOR: f64 = 6.0;
/// Steps to both sides that tell what is usual.
const BESIDE: usize = 6;

/// Widths in seconds over which a take may be smoothed, widest first.
const SMOOTHING: [f64; 6] = [0.6, 0.4, 0.25, 0.15, 0.08, 0.04];

/// A place in a picture and what is seen there: by how much it moves tells how far off another
/// camera is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmark {
    /// In the picture, in image heights from its middle, y up.
    pub at: [f64; 2],
    /// The point of the scene, in world units; for the sky, the direction.
    pub what: DVec3,
    /// Whether nothing is there but sky.
    pub is_sky: bool,
}

/// Few keys in place of a take.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplified {
    /// The keys, at times of samples.
    pub keys: Vec<Key<Camera>>,
    /// How far off the picture is at most at a sample, in image heights.
    pub worst: Worst,
    /// How often the view jumped: the picture moved farther from one sample to the next than a hand moves.
    pub jumps: usize,
}

/// Where keys are off a take the most.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// How far the picture is off, in image heights.
    pub off: f64,
    /// When, in seconds of the keys.
    pub time: f64,
}

/// How far, in image heights, what was seen at known places is off through another camera.
/// Infinite where it is behind that.
pub fn deviation(camera: &Camera, seen: &[Landmark]) -> f64 {
    let Some(framing) = camera.framing() else {
        return f64::INFINITY;
    };
    let off = seen.iter().map(|seen| {
        let place = if seen.is_sky {
            framing.project_direction(seen.what)
        } else {
            framing.project(seen.what)
        };
        let apart = |[x, y]: [f64; 2]| (x - seen.at[0]).hypot(y - seen.at[1]);
        place.map_or(f64::INFINITY, apart)
    });
    off.fold(0.0, f64::max)
}

/// Keys at as few samples as it takes to be nowhere off by more than `tolerance` image heights.
/// `seen` holds what each sample saw.
///
/// A hand trembles: where the tolerance allows it, the keys are taken from a smoother flight that is
/// itself off by no more than half of it.
pub fn simplify(take: &Take, seen: &[Vec<Landmark>], tolerance: f64) -> Simplified {
    let (cuts, jumps) = (cuts(take), jumps(take, seen));
    let edges: BTreeSet<usize> = cuts.union(&jumps).copied().collect();
    let search = Search {
        take,
        // What jumps was not meant to be smooth there.
        cameras: smoothed_cameras(take, &edges, seen, tolerance / 2.0),
        seen,
        tolerance,
        cuts,
        edges,
    };
    let mut chosen = search.refined(search.ends());
    search.prune(&mut chosen);
    // Where places coincide, a curve is shaped from farther away than pruning looks.
    let chosen = search.refined(chosen);
    let keys = search.keys(chosen.iter().copied());
    let worst = worst_off(&CameraPath::new(&keys), take, seen, ends_of(&keys));
    let jumps = jumps.len();
    Simplified { keys, worst, jumps }
}

/// The cameras of a take, as smooth as the tolerance allows.
fn smoothed_cameras(
    take: &Take,
    cuts: &BTreeSet<usize>,
    seen: &[Vec<Landmark>],
    tolerance: f64,
) -> Vec<Camera> {
    let is_near = |cameras: &Vec<Camera>| {
        let mut pairs = cameras.iter().zip(seen);
        pairs.all(|(camera, seen)| deviation(camera, seen) <= tolerance)
    };
    let smooth = SMOOTHING
        .iter()
        .map(|&seconds| smoothed(take, cuts, seconds));
    let mut smooth = smooth.filter(is_near);
    let plain = || {
        (0..take.samples.len())
            .filter_map(|n| take.camera(n))
            .collect()
    };
    smooth.next().unwrap_or_else(plain)
}

/// The times of the first and the last key; none of none.
pub fn ends_of(keys: &[Key<Camera>]) -> Option<(f64, f64)> {
    Some((keys.first()?.time, keys.last()?.time))
}

/// Where keys are off a take the most, which is flown from `start` to `end`; of what is before and behind the keys
/// nothing is said.
pub fn worst_off(
    path: &CameraPath,
    take: &Take,
    seen: &[Vec<Landmark>],
    flown: Option<(f64, f64)>,
) -> Worst {
    let (Some((start, end)), Some(ends), [first, .., last]) =
        (flown, ends_of(path.keys()), &take.samples[..])
    else {
        let off = f64::INFINITY;
        return Worst { off, time: 0.0 };
    };
    let scale = (end - start) / (last.0 - first.0);
    let time_of = |sample: &Sample| start + (sample.0 - first.0) * scale;
    let between = ends.0 - SAME_TIME..=ends.1 + SAME_TIME;
    let samples = take.samples.iter().zip(seen);
    let samples = samples.filter(|(sample, _)| between.contains(&time_of(sample)));
    let off = samples.map(|(sample, seen)| {
        let time = time_of(sample);
        let camera = path.at(time);
        let off = camera.map_or(f64::INFINITY, |camera| deviation(&camera, seen));
        Worst { off, time }
    });
    off.fold(Worst::default(), |worst, this| {
        if this.off > worst.off { this } else { worst }
    })
}

struct Search<'t> {
    take: &'t Take,
    /// What the samples' keys are.
    cameras: Vec<Camera>,
    seen: &'t [Vec<Landmark>],
    tolerance: f64,
    /// Last samples before the projection changes.
    cuts: BTreeSet<usize>,
    /// The same, and before the view jumped.
    edges: BTreeSet<usize>,
}

/// The samples after which rays suddenly spread, or run side by side.
fn cuts(take: &Take) -> BTreeSet<usize> {
    let changes = take.lenses.windows(2).filter_map(|pair| {
        let is_cut = pair[0].projection != pair[1].projection;
        is_cut.then(|| pair[1].from - 1)
    });
    changes.collect()
}

/// The samples after which the picture moves much farther than it did around them: a script or a touchpad
/// moved the mouse, or the machine was busy with something else.
fn jumps(take: &Take, seen: &[Vec<Landmark>]) -> BTreeSet<usize> {
    let cameras = (1..take.samples.len()).map(|n| take.camera(n));
    let steps: Vec<f64> = cameras
        .zip(seen)
        .map(|(camera, seen)| camera.map_or(0.0, |camera| deviation(&camera, seen)))
        .collect();
    let is_jump = |n: &usize| {
        let around = n.saturating_sub(BESIDE)..(n + 1 + BESIDE).min(steps.len());
        let others = around.filter(|other| other != n).map(|other| steps[other]);
        let mut others: Vec<f64> = others.collect();
        others.sort_by(f64::total_cmp);
        let usual = others.get(others.len() / 2).copied().unwrap_or(0.0);
        // A short turn between two rests is none, though most around it stand still: it takes three samples or more.
        let near = n.saturating_sub(2)..(n + 3).min(steps.len());
        let mut near: Vec<f64> = near.map(|near| steps[near]).collect();
        near.sort_by(f64::total_cmp);
        let third = near.iter().rev().nth(2).copied().unwrap_or(0.0);
        steps[*n] > JUMP.max(usual.max(third) * JUMP_FACTOR)
    };
    (0..steps.len()).filter(is_jump).collect()
}

impl Search<'_> {
    fn keys(&self, chosen: impl Iterator<Item = usize>) -> Vec<Key<Camera>> {
        let key = |sample: usize| {
            let camera = self.cameras.get(sample)?.clone();
            let mut key = Key::new(self.take.samples[sample].0, camera);
            if self.cuts.contains(&sample) {
                key.interpolation = Interpolation::Hold;
            }
            Some(key)
        };
        chosen.filter_map(key).collect()
    }

    fn off(&self, path: &CameraPath, sample: usize) -> f64 {
        let camera = path.at(self.take.samples[sample].0);
        let seen = self.seen.get(sample).map_or(&[][..], Vec::as_slice);
        camera.map_or(f64::INFINITY, |camera| deviation(&camera, seen))
    }

    /// The sample in a range that is off the most, if one is off too far.
    fn worst(&self, path: &CameraPath, samples: impl Iterator<Item = usize>) -> Option<usize> {
        let off = samples.map(|sample| (sample, self.off(path, sample)));
        let worst = off.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (worst.1 > self.tolerance).then_some(worst.0)
    }

    /// The samples that are keys in any case: the ends, and both sides of cuts and jumps.
    fn ends(&self) -> BTreeSet<usize> {
        let last = self.take.samples.len().saturating_sub(1);
        let edges = self.edges.iter().flat_map(|&edge| [edge, edge + 1]);
        [0, last].into_iter().chain(edges).collect()
    }

    /// With the worst sample of each stretch added until none is off too far.
    fn refined(&self, mut chosen: BTreeSet<usize>) -> BTreeSet<usize> {
        loop {
            let places: Vec<usize> = chosen.iter().copied().collect();
            let path = CameraPath::new(&self.keys(places.iter().copied()));
            let stretches = places.windows(2);
            let worst: Vec<usize> = stretches
                .filter_map(|ends| self.worst(&path, ends[0] + 1..ends[1]))
                .collect();
            if worst.is_empty() {
                return chosen;
            }
            chosen.extend(worst);
        }
    }

    /// Takes keys away again that later ones made needless.
    fn prune(&self, chosen: &mut BTreeSet<usize>) {
        let inner: Vec<usize> = chosen.iter().copied().collect();
        let inner = inner.get(1..inner.len().saturating_sub(1)).unwrap_or(&[]);
        for &sample in inner {
            if self.edges.contains(&sample) || (sample > 0 && self.edges.contains(&(sample - 1))) {
                continue;
            }
            let mut around: Vec<usize> = chosen
                .range(..sample)
                .rev()
                .take(REACH + 1)
                .copied()
                .collect();
            around.reverse();
            let before = around.len();
            around.extend(chosen.range(sample + 1..).take(REACH + 1));
            let path = CameraPath::new(&self.keys(around.iter().copied()));
            // The outermost stretches are shaped by keys that are not in the window.
            let first = around[usize::from(before > REACH)];
            let is_cut_off = around.len() - before > REACH;
            let last = around[around.len() - 1 - usize::from(is_cut_off)];
            if self.worst(&path, first..=last).is_none() {
                chosen.remove(&sample);
            }
        }
    }
}
