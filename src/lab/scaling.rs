//! How much sooner a picture would come with more cores than this machine has: the times of its pieces, measured
//! one by one, given to workers that do not exist.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::ops::Range;
use std::time::{Duration, Instant};

use serde::Serialize;

use super::table::csv_of;
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::Tracer;

/// How many workers there are.
const WORKERS: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
/// Times that each piece is traced, of which the fastest counts.
const ROUNDS: usize = 9;

/// A picture by so many workers.
#[derive(Clone, Debug, Serialize)]
pub struct SharedPicture {
    /// The scene.
    pub scene: String,
    /// How many workers there are.
    pub workers: usize,
    /// How many pieces they share.
    pub pieces: usize,
    /// Milliseconds until the last piece is done, with the planning that one worker does alone.
    pub ms: f64,
    /// Share of the workers' time in which one worker alone would make the picture, 0–1.
    pub efficiency: f64,
}

/// Simulates pictures of a scene whose camera moves. Handing out the pieces takes no time here, and a worker is as
/// fast beside others as alone: more cores than these could not do better.
///
/// Sixteen real cores (a virtual Xeon, 2026-11) made as many pictures of 9 ms and more as sixteen programs of one
/// thread each at the same time; of the demo, which takes 1.7 ms there, 0.6 of that. A list of pieces from which
/// threads take one after the other, in place of halves that are halved, made it 3.0 ms: 1,024 pieces of 10 µs are too
/// many to stand in line for.
pub fn scaling(name: &str, scene: &Scene, request: &RenderRequest) -> Vec<SharedPicture> {
    let mut planner = Planner::default();
    let _ = Tracer::planned(scene, request, &mut planner);
    let since = Instant::now();
    let tracer = Tracer::planned(scene, request, &mut planner);
    let planning = since.elapsed();
    let mut measured = WORKERS.map(|workers| (workers, tracer.time_pieces(workers)));
    // One after the other in each round: what disturbs a moment disturbs them alike.
    for _ in 1..ROUNDS {
        for (workers, times) in &mut measured {
            for (time, again) in times.iter_mut().zip(tracer.time_pieces(*workers)) {
                *time = again.min(*time);
            }
        }
    }
    // In whatever pieces that is fastest: else what was measured twice would seem to be faster than it is.
    let sums = measured.iter().map(|(_, times)| times.iter().sum());
    let alone = milliseconds(planning + sums.min().unwrap_or(Duration::ZERO));
    let picture = |(workers, times): (usize, Vec<Duration>)| {
        let ms = milliseconds(planning + makespan(&times, workers));
        SharedPicture {
            scene: name.to_owned(),
            workers,
            pieces: times.len(),
            ms,
            efficiency: alone / (ms * workers as f64),
        }
    };
    measured.into_iter().map(picture).collect()
}

/// All figures as comma-separated values.
///
/// # Errors
/// None is known: everything is written to memory.
pub fn scaling_csv(pictures: &[SharedPicture]) -> Result<String, csv::Error> {
    csv_of(pictures)
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// When the last of these pieces is done, if workers halve what they have until it is one piece, keep the first
/// halves and take from each other's last ones what was put aside first, as those of rayon do (Blumofe and
/// Leiserson, "Scheduling multithreaded computations by work stealing", JACM 46(5), 1999).
fn makespan(times: &[Duration], workers: usize) -> Duration {
    let mut aside: Vec<VecDeque<Range<usize>>> = vec![VecDeque::new(); workers];
    aside[0].push_back(0..times.len());
    let mut free: BinaryHeap<Reverse<(Duration, usize)>> = (0..workers)
        .map(|worker| Reverse((Duration::ZERO, worker)))
        .collect();
    let mut last = Duration::ZERO;
    while let Some(Reverse((now, worker))) = free.pop() {
        let own = aside[worker].pop_back();
        let victim = (0..workers).max_by_key(|&other| aside[other].front().map_or(0, Range::len));
        let Some(mut range) = own.or_else(|| aside[victim?].pop_front()) else {
            continue;
        };
        while range.len() > 1 {
            let middle = range.start + range.len() / 2;
            aside[worker].push_back(middle..range.end);
            range.end = middle;
        }
        let done = now + range.map(|piece| times[piece]).sum::<Duration>();
        last = last.max(done);
        free.push(Reverse((done, worker)));
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn workers_share_until_a_single_piece_is_left() {
        let millis = |times: &[u64]| times.iter().map(|&ms| Duration::from_millis(ms)).collect();
        let last = |times: &[u64], workers| {
            let times: Vec<Duration> = millis(times);
            makespan(&times, workers).as_millis()
        };
        assert_eq!(last(&[], 4), 0);
        assert_eq!(last(&[3, 1, 2], 1), 6);
        assert_eq!(last(&[1; 64], 4), 16);
        assert_eq!(last(&[1; 64], 128), 1);
        // Nobody can help with the largest piece.
        assert_eq!(last(&[1, 1, 1, 20, 1, 1, 1, 1], 8), 20);
    }

    #[test]
    fn no_worker_is_busier_than_it_can_be() {
        let pictures = scaling("demo", &Scene::demo(), &RenderRequest::sized(256, 256));
        assert_eq!(pictures.len(), WORKERS.len());
        let is_share = |picture: &SharedPicture| (0.0..=1.0).contains(&picture.efficiency);
        assert!(pictures.iter().all(is_share), "{pictures:?}");
        assert!(pictures.iter().all(|picture| picture.ms > 0.0));
        let text = scaling_csv(&pictures).expect("written");
        assert!(
            text.starts_with("scene,workers,pieces,ms,efficiency\ndemo,1,"),
            "{text}"
        );
    }
}
