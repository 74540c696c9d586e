//! A take without the trembling of the hand.

use std::collections::BTreeSet;

use glam::DVec3;

use super::path::unwound;
use crate::scene::{Camera, Orientation, Sample, Take};

/// Place and angles of a sample.
type NumberRow = [f64; 6];

/// The cameras of a take after a Gaussian of this width in seconds has gone over places and angles.
/// What is before a cut is not mixed with what is after it; at the ends of each part the flight is
/// continued as its mirror image through the end, so that the ends stay where they are.
pub(super) fn smoothed(take: &Take, cuts: &BTreeSet<usize>, seconds: f64) -> Vec<Camera> {
    let angles = take
        .samples
        .iter()
        .map(|&Sample(_, _, yaw, pitch, roll)| Orientation { yaw, pitch, roll });
    let angles = unwound(angles);
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

/// The mean around sample `n`, near samples weighing more, each for the time that it stands for.
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
    // What is beyond an end is as far from it as what is mirrored there.
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
