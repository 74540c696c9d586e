//! Simulates how much sooner a picture would be done with more cores than this machine has: its pieces are timed one
//! by one, and assigned to imaginary workers.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::ops::Range;
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::Tracer;
use crate::words::milliseconds;

/// Numbers of workers that are simulated.
const WORKERS: [usize; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
/// How often each piece is traced; the fastest run counts.
const ROUNDS: usize = 9;

/// A picture that a number of workers share.
#[derive(Clone, Debug, Serialize)]
pub struct SharedPicture {
    /// Name of the scene.
    pub scene: String,
    /// Number of workers.
    pub workers: usize,
    /// Number of pieces that they share.
    pub pieces: usize,
    /// Milliseconds until the last piece is done, including the planning by one worker alone.
    pub ms: f64,
    /// Time in which one worker alone would make the picture, as a share of the total time of all workers, 0–1.
    pub efficiency: f64,
}

/// Simulates pictures of a scene whose camera moves. Distributing the pieces takes no time here, and workers do not
/// slow each other down, so real cores could not do better.
///
/// On sixteen real cores (a virtual Xeon, 2026-11), the throughput of pictures that take 9 ms and more equalled that
/// of sixteen single-threaded processes at the same time; of the demo, which takes 1.7 ms there, it was 0.6 of that.
/// With a shared list from which threads take one piece after the other, instead of recursive halving, the demo took
/// 3.0 ms: 1,024 pieces of 10 µs are too many to queue for.
pub fn scaling(name: &str, scene: &Scene, request: &RenderRequest) -> Vec<SharedPicture> {
    let mut planner = Planner::default();
    let _ = Tracer::planned(scene, request, &mut planner);
    let since = Instant::now();
    let tracer = Tracer::planned(scene, request, &mut planner);
    let planning = since.elapsed();
    let mut measured = WORKERS.map(|workers| (workers, tracer.time_pieces(workers)));
    // All numbers of workers take turns in each round, so that a disturbance affects them alike.
    for _ in 1..ROUNDS {
        for (workers, times) in &mut measured {
            for (time, again) in times.iter_mut().zip(tracer.time_pieces(*workers)) {
                *time = again.min(*time);
            }
        }
    }
    // The fastest split counts as the time alone: otherwise measurement noise could make the efficiency exceed 1.
    let sums = measured.iter().map(|(_, times)| times.iter().sum());
    let ms_alone = milliseconds(planning + sums.min().unwrap_or(Duration::ZERO));
    let picture = |(workers, times): (usize, Vec<Duration>)| {
        let ms = milliseconds(planning + makespan(&times, workers));
        SharedPicture {
            scene: name.to_owned(),
            workers,
            pieces: times.len(),
            ms,
            efficiency: ms_alone / (ms * workers as f64),
        }
    };
    measured.into_iter().map(picture).collect()
}

/// Returns when the last piece is done if each worker halves its range down to one piece, always keeping the first
/// half and putting the other aside, and idle workers steal the range that another one put aside first, as in rayon
/// (Blumofe and Leiserson, "Scheduling multithreaded computations by work stealing", JACM 46(5), 1999).
fn makespan(times: &[Duration], workers: usize) -> Duration {
    let mut queues: Vec<VecDeque<Range<usize>>> = vec![VecDeque::new(); workers];
    queues[0].push_back(0..times.len());
    let mut idle: BinaryHeap<Reverse<(Duration, usize)>> = (0..workers)
        .map(|worker| Reverse((Duration::ZERO, worker)))
        .collect();
    let mut last = Duration::ZERO;
    while let Some(Reverse((now, worker))) = idle.pop() {
        let own_range = queues[worker].pop_back();
        let victim = (0..workers).max_by_key(|&other| queues[other].front().map_or(0, Range::len));
        let Some(mut range) = own_range.or_else(|| queues[victim?].pop_front()) else {
            continue;
        };
        while range.len() > 1 {
            let middle = range.start + range.len() / 2;
            queues[worker].push_back(middle..range.end);
            range.end = middle;
        }
        let done = now + range.map(|piece| times[piece]).sum::<Duration>();
        last = last.max(done);
        idle.push(Reverse((done, worker)));
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::csv_of;

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
        // The largest piece cannot be divided.
        assert_eq!(last(&[1, 1, 1, 20, 1, 1, 1, 1], 8), 20);
    }

    #[test]
    fn no_worker_is_busier_than_it_can_be() {
        let pictures = scaling("demo", &Scene::demo(), &RenderRequest::sized(256, 256));
        assert_eq!(pictures.len(), WORKERS.len());
        let is_share = |picture: &SharedPicture| (0.0..=1.0).contains(&picture.efficiency);
        assert!(pictures.iter().all(is_share), "{pictures:?}");
        assert!(pictures.iter().all(|picture| picture.ms > 0.0));
        let text = csv_of(&pictures).expect("written");
        assert!(
            text.starts_with("scene,workers,pieces,ms,efficiency\ndemo,1,"),
            "{text}"
        );
    }
}
