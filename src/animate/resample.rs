//! Interpolates a recorded flight between input events: mice and touchpads report less often than pictures are
//! shown, so that the recorded camera stands still in between, although the hand did not.

use std::collections::HashSet;

use glam::DVec3;

use crate::scene::{Sample, Take, wrapped_angle};

/// Longest time between two movements, in seconds, that is not a pause.
const PAUSE: f64 = 0.15;

/// Returns the flight without the steps due to rare input events: samples between two movements in quick succession
/// are interpolated linearly. Also returns how many samples were changed.
pub fn resampled(take: &Take) -> (Take, usize) {
    let samples = &take.samples;
    let mut even = take.clone();
    let mut changed = HashSet::new();
    for (from, to) in steps(samples, |a, b| a.1 == b.1) {
        for n in from + 1..to {
            let share = share(samples, (from, n, to));
            even.samples[n].1 = samples[from].1.lerp(samples[to].1, share);
            changed.insert(n);
        }
    }
    for (from, to) in steps(samples, |a, b| angles(a) == angles(b)) {
        let (before, after) = (angles(&samples[from]), angles(&samples[to]));
        let turn = (after - before).map(wrapped_angle);
        for n in from + 1..to {
            let turned = before + turn * share(samples, (from, n, to));
            let sample = &mut even.samples[n];
            (sample.2, sample.3, sample.4) = turned.into();
            changed.insert(n);
        }
    }
    (even, changed.len())
}

fn angles(sample: &Sample) -> DVec3 {
    DVec3::new(sample.2, sample.3, sample.4)
}

/// Returns the share of the time between two samples that has passed at one between them.
fn share(samples: &[Sample], (from, at, to): (usize, usize, usize)) -> f64 {
    (samples[at].0 - samples[from].0) / (samples[to].0 - samples[from].0)
}

/// Returns pairs of successive movements in quick succession that have unchanged samples between them.
fn steps(samples: &[Sample], is_same: impl Fn(&Sample, &Sample) -> bool) -> Vec<(usize, usize)> {
    let is_movement = |n: &usize| !is_same(&samples[n - 1], &samples[*n]);
    let movements: Vec<usize> = (1..samples.len()).filter(is_movement).collect();
    let pairs = movements.windows(2).map(|pair| (pair[0], pair[1]));
    let is_close =
        |(from, to): &(usize, usize)| to - from > 1 && samples[*to].0 - samples[*from].0 <= PAUSE;
    pairs.filter(is_close).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_that_arrives_in_steps_is_even_and_a_pause_stays_one() {
        let mut take = Take::default();
        for n in 0..40_u32 {
            let time = f64::from(n) * 0.02;
            // A step of 0.03 in every third sample; none for 0.2 s from 0.4 s on.
            let turned = if n < 20 {
                n / 3
            } else {
                6 + n.saturating_sub(30) / 3
            };
            let yaw = f64::from(turned) * 0.03;
            let sample = Sample(time, DVec3::X * f64::from(n), yaw, 0.1, 0.0);
            take.samples.push(sample);
        }
        let (even, count) = resampled(&take);
        assert_eq!(count, 10 + 4);
        for n in 3..=18_u32 {
            let sample = even.samples[n as usize];
            assert!((sample.2 - f64::from(n) * 0.01).abs() < 1e-12, "{n}");
            assert_eq!(sample.1, DVec3::X * f64::from(n));
        }
        for n in 19..=30 {
            assert_eq!(even.samples[n], take.samples[n], "{n}");
        }
        assert_eq!(resampled(&even).1, 0);
    }
}
