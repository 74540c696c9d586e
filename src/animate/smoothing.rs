//! Smoothing of takes, to remove the tremor of the hand.

use std::collections::BTreeSet;

use glam::DVec3;

use super::path::unwound;
use crate::scene::{Camera, Orientation, Sample, Take};

/// Position and angles of a sample.
type NumberRow = [f64; 6];

/// Returns the cameras of a take, with positions and angles filtered by a Gaussian of width `seconds` (standard
/// deviation). Samples before and after a cut are not mixed. At the ends of each part, the flight is continued by
/// its point reflection about the end, so that the ends stay in place.
pub(super) fn smoothed(take: &Take, cuts: &BTreeSet<usize>, seconds: f64) -> Vec<Camera> {
    let angles = take
        .samples
        .iter()
        .map(|&Sample(_, _, yaw, pitch, roll)| Orientation { yaw, pitch, roll });
    let angles = unwound(angles.map(|angles| (angles, 0.0)));
    let numbers = |(sample, angles): (&Sample, &Orientation)| {
        let [x, y, z] = sample.1.to_array();
        (sample.0, [x, y, z, angles.yaw, angles.pitch, angles.roll])
    };
    let all: Vec<(f64, NumberRow)> = take.samples.iter().zip(&angles).map(numbers).collect();
    let mut cameras = Vec::new();
    let mut start = 0;
    let ends = cuts.iter().map(|cut| cut + 1).chain([all.len()]);
    for end in ends {
        let part = &all[start..end];
        for n in 0..part.len() {
            let [x, y, z, yaw, pitch, roll] = mean(part, n, seconds);
            let turned = Orientation { yaw, pitch, roll };
            let camera = take.camera(start + n);
            cameras.extend(camera.map(|camera| {
                turned.apply(&Camera {
                    position: DVec3::new(x, y, z),
                    ..camera
                })
            }));
        }
        start = end;
    }
    cameras
}

/// Returns the weighted mean around sample `n`. The weight is the Gaussian times the time span that a sample
/// represents.
fn mean(part: &[(f64, NumberRow)], n: usize, seconds: f64) -> NumberRow {
    let (last, here) = (part.len() - 1, part[n].0);
    let (first_time, last_time) = (part[0].0, part[last].0);
    let mut sum = [0.0; 6];
    let mut weights = 0.0;
    let mut add = |apart: f64, stands_for: f64, numbers: &NumberRow, mirror: Option<&NumberRow>| {
        let weight = stands_for * (-0.5 * (apart / seconds).powi(2)).exp();
        weights += weight;
        for (index, sum) in sum.iter_mut().enumerate() {
            *sum += weight * mirror.map_or(numbers[index], |end| 2.0 * end[index] - numbers[index]);
        }
    };
    let reach = 3.0 * seconds;
    let from = |time: f64| part.partition_point(|sample| sample.0 < time);
    let stands_for = |m: usize| (part[(m + 1).min(last)].0 - part[m.saturating_sub(1)].0) / 2.0;
    let direct = part.iter().enumerate().take(from(here + reach));
    for (m, (time, numbers)) in direct.skip(from(here - reach)) {
        add(time - here, stands_for(m), numbers, None);
    }
    // A reflected sample is as far beyond the end as the original is before it.
    for m in 1..from(2.0 * first_time - here + reach) {
        let apart = here - 2.0 * first_time + part[m].0;
        add(apart, stands_for(m), &part[m].1, Some(&part[0].1));
    }
    for m in from(2.0 * last_time - here - reach)..last {
        let apart = 2.0 * last_time - part[m].0 - here;
        add(apart, stands_for(m), &part[m].1, Some(&part[last].1));
    }
    if weights > 0.0 {
        sum.map(|sum| sum / weights)
    } else {
        part[n].1
    }
}
