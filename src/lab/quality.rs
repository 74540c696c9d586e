//! Chooses the sampling for a picture: the cheapest within an error, or the closest within a time, as measured on
//! strips of the picture itself.

use std::time::{Duration, Instant};

use super::candidates::samplings;
use super::measure::{decibels, difference, mean_of_two};
use super::pareto_front::{cheapest_within, closest_within};
use crate::image::LinearRgb;
use crate::plan::{Planner, RenderRequest};
use crate::scene::{Method as _, Sampling, Scene};
use crate::trace::{RenderControl, Tracer};
use crate::words::milliseconds;

/// Samples along each side of a pixel in the two pictures whose mean is the reference for errors: with these numbers,
/// few of their samples coincide with those of other grids.
const REFERENCE_GRIDS: [u32; 2] = [23, 19];
/// Rows per strip.
const STRIP_ROWS: usize = 8;
/// Number of pixels, roughly, that are measured: few enough to take a second or so, many enough to cover the content
/// of the picture.
const MEASURED_PIXELS: usize = 1 << 17;
/// Least number of strips.
const MIN_STRIPS: usize = 4;

/// The limit that a picture must keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// The cheapest whose error, the root mean square over linear colours from 0 to 1, is at most this.
    Within(f64),
    /// The closest that takes at most this time.
    Budget(Duration),
}

/// A sampling that was chosen for a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The limit that was given.
    pub goal: Goal,
    /// The chosen sampling.
    pub sampling: Sampling,
    /// Its error, root mean square, 0–1.
    pub rmse: f64,
    /// Estimated time of the whole picture.
    pub time: Duration,
    /// Number of samplings that were measured.
    pub tried: usize,
    /// Whether the limit is kept; otherwise the choice is the one nearest to it.
    pub is_met: bool,
}

impl Choice {
    /// Describes the choice and its reason.
    pub fn words(&self) -> String {
        let level = |rmse: f64| format!("{:.1} dB", decibels(rmse));
        let millis = |time: Duration| format!("{:.1} ms", milliseconds(time));
        let goal = match (self.goal, self.is_met) {
            (Goal::Within(error), true) => format!("the cheapest within {}", level(error)),
            (Goal::Within(error), false) => {
                format!(
                    "the most accurate, as none measurably reaches {}",
                    level(error)
                )
            }
            (Goal::Budget(time), true) => format!("the most accurate within {}", millis(time)),
            (Goal::Budget(time), false) => {
                format!("the cheapest, as none takes less than {}", millis(time))
            }
        };
        format!(
            "antialias {}: {goal}, of {} measured here ({} in about {})",
            self.sampling.id(),
            self.tried,
            level(self.rmse),
            millis(self.time),
        )
    }
}

/// Measures samplings on strips of a picture, on the current rayon pool, and chooses one. `None` if `control` stopped
/// it.
pub fn choose(
    scene: &Scene,
    request: &RenderRequest,
    goal: Goal,
    planner: &mut Planner,
    control: &RenderControl,
) -> Option<Choice> {
    let mut strips = MeasuredStrips::new(scene, request, planner, control);
    let (reference, first) = strips.trace(Sampling::Grid(REFERENCE_GRIDS[0]))?;
    let (other, _) = strips.trace(Sampling::Grid(REFERENCE_GRIDS[1]))?;
    let (reference, reference_error) = mean_of_two(&reference, &other);
    // Meshes are prepared once, for all samplings, but whoever traces the picture has to wait for that again.
    let planned_with_meshes = first.planned;
    let mut measured: Vec<(Sampling, (f64, f64))> = Vec::new();
    for sampling in samplings() {
        // Grids come in order of size: after one that is close enough, or too slow, all others take longer.
        let is_enough = measured.iter().any(|(other, (time, error))| {
            matches!(other, Sampling::Grid(_))
                && match goal {
                    Goal::Within(bound) => *error <= bound,
                    Goal::Budget(bound) => *time > bound.as_secs_f64(),
                }
        });
        if matches!(sampling, Sampling::Grid(_)) && is_enough {
            continue;
        }
        let (light, first) = strips.trace(sampling)?;
        let (_, second) = strips.trace(sampling)?;
        // The faster of two runs counts, because disturbances only make a run slower.
        let planned = first.planned.min(second.planned).max(planned_with_meshes);
        let time = planned + first.traced.min(second.traced);
        let error = error_without(reference_error, difference(&light, &reference).rmse);
        measured.push((sampling, (time, error)));
    }
    pick(goal, &measured)
}

/// The error of a sampling, from its difference from a reference that has an error of its own: independent errors add
/// up as squares. What is below half of the reference's error cannot be told from it.
fn error_without(reference_error: f64, difference: f64) -> f64 {
    let own = (difference.powi(2) - reference_error.powi(2)).max(0.0);
    own.sqrt().max(reference_error / 2.0)
}

/// Chooses among the measured samplings (time in s, error); `None` if there are none.
fn pick(goal: Goal, measured: &[(Sampling, (f64, f64))]) -> Option<Choice> {
    let costs: Vec<(f64, f64)> = measured.iter().map(|(_, figures)| *figures).collect();
    let unbounded = f64::INFINITY;
    let (within_goal, nearest) = match goal {
        Goal::Within(error) => (
            cheapest_within(&costs, error, unbounded),
            closest_within(&costs, unbounded),
        ),
        Goal::Budget(time) => (
            closest_within(&costs, time.as_secs_f64()),
            cheapest_within(&costs, unbounded, unbounded),
        ),
    };
    let (sampling, (time, rmse)) = measured[within_goal.or(nearest)?];
    Some(Choice {
        goal,
        sampling,
        rmse,
        time: Duration::from_secs_f64(time),
        tried: measured.len(),
        is_met: within_goal.is_some(),
    })
}

/// Seconds that a picture takes.
struct Seconds {
    planned: f64,
    traced: f64,
}

/// Strips that are spread over a picture from top to bottom.
struct MeasuredStrips<'a> {
    scene: &'a Scene,
    request: &'a RenderRequest,
    planner: &'a mut Planner,
    control: &'a RenderControl,
    /// The first row of each strip.
    first_rows: Vec<usize>,
    rows: usize,
}

impl<'a> MeasuredStrips<'a> {
    fn new(
        scene: &'a Scene,
        request: &'a RenderRequest,
        planner: &'a mut Planner,
        control: &'a RenderControl,
    ) -> Self {
        let (width, height) = (request.width as usize, request.height as usize);
        let count = (MEASURED_PIXELS / (STRIP_ROWS * width)).max(MIN_STRIPS);
        let (first_rows, rows) = if count * STRIP_ROWS >= height {
            (vec![0], height)
        } else {
            let first = |strip: usize| (2 * strip + 1) * (height - STRIP_ROWS) / (2 * count);
            ((0..count).map(first).collect(), STRIP_ROWS)
        };
        Self {
            scene,
            request,
            planner,
            control,
            first_rows,
            rows,
        }
    }

    /// The number of rows of the whole picture, relative to that of the strips.
    fn rows_ratio(&self) -> f64 {
        f64::from(self.request.height) / (self.rows * self.first_rows.len()) as f64
    }

    /// Traces the strips, and estimates the time of the whole picture. Planning counts once, whatever the number of
    /// rows.
    fn trace(&mut self, sampling: Sampling) -> Option<(Vec<LinearRgb>, Seconds)> {
        let start = Instant::now();
        let request = RenderRequest {
            sampling,
            ..*self.request
        };
        let tracer = Tracer::planned(self.scene, &request, self.planner);
        let planned = start.elapsed().as_secs_f64();
        let strip = self.rows * self.request.width as usize;
        let mut light = vec![[0.0; 3]; strip * self.first_rows.len()];
        for (strip, first) in light.chunks_exact_mut(strip).zip(&self.first_rows) {
            tracer.rows(strip, *first, self.control)?;
        }
        let traced = start.elapsed().as_secs_f64() - planned;
        let traced = traced * self.rows_ratio();
        Some((light, Seconds { planned, traced }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(goal: Goal) -> Choice {
        let scene = Scene::demo();
        let request = RenderRequest::of(&scene, 96, 72);
        let control = RenderControl::default();
        choose(&scene, &request, goal, &mut Planner::default(), &control).expect("not stopped")
    }

    #[test]
    fn a_choice_is_no_better_than_what_was_asked_for() {
        let measured = [
            (Sampling::Centres, (1.0, 0.04)),
            (Sampling::ADAPTIVE, (3.0, 0.002)),
            (Sampling::Grid(2), (4.0, 0.02)),
            (Sampling::Grid(8), (64.0, 0.001)),
        ];
        let picked = |goal: Goal| pick(goal, &measured).expect("some were measured");
        let within = |error: f64| picked(Goal::Within(error));
        assert_eq!(within(0.05).sampling, Sampling::Centres);
        assert_eq!(within(0.03).sampling, Sampling::ADAPTIVE);
        assert_eq!(within(0.001).sampling, Sampling::Grid(8));
        assert!(within(0.001).is_met && !within(0.000_5).is_met);
        assert_eq!(within(0.000_5).sampling, Sampling::Grid(8));
        let budget = |seconds: u64| picked(Goal::Budget(Duration::from_secs(seconds)));
        assert_eq!(budget(2).sampling, Sampling::Centres);
        assert_eq!(budget(10).sampling, Sampling::ADAPTIVE);
        assert!(budget(100).sampling == Sampling::Grid(8) && !budget(0).is_met);
        assert_eq!(pick(Goal::Within(0.1), &[]), None);
    }

    #[test]
    fn the_error_of_the_reference_is_not_that_of_a_sampling() {
        assert!((error_without(3e-4, 5e-4) - 4e-4).abs() < 1e-12);
        // What is closer than the reference itself cannot be told from it.
        assert_eq!(error_without(4e-4, 3e-4), 2e-4);
        assert_eq!(error_without(0.0, 0.0), 0.0);
    }

    #[test]
    fn a_choice_keeps_to_what_was_asked_for() {
        for error in [0.05, 0.003] {
            let choice = chosen(Goal::Within(error));
            assert!(choice.is_met && choice.rmse <= error, "{choice:?}");
        }
        let exact = chosen(Goal::Within(1e-9));
        assert!(!exact.is_met && exact.rmse < 0.003, "{exact:?}");
        assert!(
            exact.words().contains("none measurably reaches 180.0 dB"),
            "{}",
            exact.words()
        );
    }

    #[test]
    fn a_time_buys_what_it_can() {
        let hasty = chosen(Goal::Budget(Duration::ZERO));
        assert!(!hasty.is_met, "{hasty:?}");
        let patient = chosen(Goal::Budget(Duration::from_hours(1)));
        assert!(
            patient.is_met && patient.rmse < hasty.rmse,
            "{hasty:?} {patient:?}"
        );
    }

    #[test]
    fn a_picture_that_nobody_wants_any_more_is_not_measured() {
        let scene = Scene::demo();
        let stopped = RenderControl::default();
        stopped.stop();
        let request = RenderRequest::of(&scene, 96, 72);
        let planner = &mut Planner::default();
        assert_eq!(
            choose(&scene, &request, Goal::Within(0.1), planner, &stopped),
            None
        );
    }
}
