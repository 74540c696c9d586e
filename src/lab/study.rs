//! A study: measures all candidates of a scene step by step, so that other work can go first.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::candidates::{Candidate, Family, candidates, povray};
use super::measure::{
    ErrorMetrics, difference, eight_bits, mean_of_two, quantile, scaled, trace_light,
};
use crate::export::{PovrayError, by_povray};
use crate::image::{Image, LinearRgb, render_into};
use crate::plan::{Planner, RenderRequest};
use crate::scene::{Precision, Sampling, Scene};
use crate::trace::{RenderControl, Threads, Tracer};
use crate::words::milliseconds;

/// Samples along each side of a pixel in the two pictures whose mean is the reference. The grids have only the centre
/// of the pixel in common, so their errors are independent, and the difference of the pictures tells how large they
/// are.
const REFERENCE_GRIDS: [u32; 2] = [47, 53];
/// Samples of the reference per pixel.
pub const REFERENCE_SAMPLES: u32 = REFERENCE_GRIDS[0].pow(2) + REFERENCE_GRIDS[1].pow(2);
/// Number of pieces in which each of the two pictures is traced; between them, more urgent work can go first.
const REFERENCE_PIECES: usize = 32;
/// Weight of the reference in the progress, in timed runs.
const REFERENCE_WEIGHT: f64 = 100.0;
/// Timed runs of each candidate, without the one that warms up.
const ROUNDS: usize = 9;
/// Time of the first run above which a candidate is run less often.
const SLOW_RUN: Duration = Duration::from_millis(250);
/// Timed runs of such a candidate.
const SLOW_ROUNDS: usize = 3;

/// Spread above which a time is doubtful.
const MAX_SPREAD: f64 = 0.2;

/// A way of tracing, and its measurements.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The way of tracing.
    pub candidate: Candidate,
    /// The error of its picture; `None` until it is measured.
    pub metrics: Option<ErrorMetrics>,
    /// Rays of all kinds per pixel of the finished picture.
    pub rays_per_pixel: f64,
    /// Milliseconds of each timed run.
    pub times: Vec<f64>,
    /// The picture.
    pub picture: Option<Arc<Image>>,
    /// Real type and lane count of its kernel.
    pub lanes: String,
}

/// The time of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Median of all runs, in milliseconds.
    pub median: f64,
    /// First and third quartile of the runs, in milliseconds.
    pub quartiles: (f64, f64),
    /// Interquartile range, as a share of the median.
    pub spread: f64,
    /// Number of runs.
    pub runs: usize,
}

/// The picture that errors are measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The error of the reference itself: half of the difference between the two pictures whose mean it is, which is
    /// the standard error of the mean of two.
    pub rmse: f64,
    /// The picture.
    pub picture: Arc<Image>,
}

/// The measurements of a scene. Clones share their pictures.
#[derive(Clone, Debug)]
pub struct Study {
    scene: Arc<Scene>,
    size: (u32, u32),
    /// The rows traced so far of the two pictures whose mean is the reference. Once it is complete, the mean replaces
    /// the first.
    references: [Arc<Vec<LinearRgb>>; 2],
    /// `None` until the reference is complete.
    pub reference: Option<Reference>,
    /// One entry per candidate.
    pub measurements: Vec<Measurement>,
    /// Why another engine was left out, if it was requested and failed.
    pub obstacle: Option<String>,
    planner: Planner,
    spent: Duration,
    timed: usize,
}

impl Study {
    /// Creates a study without measurements; its pictures have the scene's aspect ratio and a longer side of `side`
    /// pixels.
    pub fn of_side(scene: Arc<Scene>, side: u32) -> Self {
        let (width, height) = Self::size_of_side(&scene, side);
        Self::new(scene, width, height)
    }

    /// Width and height of a scene's picture whose longer side has `side` pixels.
    pub fn size_of_side(scene: &Scene, side: u32) -> (u32, u32) {
        let (width, height) = (scene.render.width, scene.render.height);
        let scale = f64::from(side) / f64::from(width.max(height));
        let scaled = |side: u32| ((f64::from(side) * scale).round() as u32).max(1);
        (scaled(width), scaled(height))
    }

    /// Creates a study without measurements; its pictures have `width × height` pixels.
    pub fn new(scene: Arc<Scene>, width: u32, height: u32) -> Self {
        let measurements = candidates(&scene, width, height).into_iter();
        Self {
            measurements: measurements.map(Measurement::new).collect(),
            obstacle: None,
            scene,
            size: (width, height),
            references: Default::default(),
            planner: Planner::default(),
            reference: None,
            spent: Duration::ZERO,
            timed: 0,
        }
    }

    /// Adds POV-Ray to the comparison; it is left out again if it fails.
    pub fn with_povray(mut self) -> Self {
        let referee = povray(&self.scene, self.size.0, self.size.1);
        self.measurements.push(Measurement::new(referee));
        self
    }

    /// The measured scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Width and height of the pictures.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Does the next piece of work on the current rayon pool: some rows of a reference, a picture, or a timed run.
    /// Returns `false` if all is done. A piece that `control` stopped is repeated in the next call.
    pub fn step(&mut self, control: &RenderControl) -> bool {
        let start = Instant::now();
        let has_more = if self.reference.is_none() {
            self.find_reference(control);
            true
        } else if let Some(index) = self
            .measurements
            .iter()
            .position(|dot| dot.metrics.is_none())
        {
            self.measure_error(index, control);
            true
        } else {
            self.time_next(control)
        };
        self.spent += start.elapsed();
        has_more
    }

    /// Share of the work that is done, 0–1, by the number of pieces.
    pub fn progress(&self) -> f64 {
        let measured = self
            .measurements
            .iter()
            .filter(|dot| dot.metrics.is_some())
            .count();
        let pixels = (self.size.0 * self.size.1) as usize;
        let traced = match self.reference {
            Some(_) => 2 * pixels,
            None => self.references.iter().map(|light| light.len()).sum(),
        };
        // References take as long as a considerable part of the rest.
        let reference = REFERENCE_WEIGHT * traced as f64 / (2 * pixels) as f64;
        let wanted: usize = self.measurements.iter().map(Measurement::rounds).sum();
        let runs: usize = self.measurements.iter().map(|dot| dot.times.len()).sum();
        let (done, total) = (measured + runs, self.measurements.len() + wanted);
        (reference + done as f64) / (REFERENCE_WEIGHT + total as f64)
    }

    /// Estimated time for the rest; `None` at the start.
    pub fn remaining(&self) -> Option<Duration> {
        let done = self.progress();
        (done > 0.0).then(|| self.spent.mul_f64((1.0 - done) / done))
    }

    /// Traces some rows of one of the two pictures, or computes their mean if both are complete.
    fn find_reference(&mut self, control: &RenderControl) {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let unfinished = self
            .references
            .iter()
            .position(|reference| reference.len() < width * height);
        let Some(index) = unfinished else {
            let [first, second] = std::mem::take(&mut self.references);
            let (mean, rmse) = mean_of_two(&first, &second);
            let picture = Arc::new(eight_bits(mean.clone(), (width, height)));
            self.reference = Some(Reference { rmse, picture });
            self.references[0] = Arc::new(mean);
            return;
        };
        let request = RenderRequest {
            precision: Precision::Double,
            sampling: Sampling::Grid(REFERENCE_GRIDS[index]),
            ..RenderRequest::sized(self.size.0, self.size.1)
        };
        let first = self.references[index].len() / width;
        let rows = height.div_ceil(REFERENCE_PIECES).min(height - first);
        let mut light = vec![[0.0; 3]; rows * width];
        let tracer = Tracer::planned(&self.scene, &request, &mut self.planner);
        if tracer.rows(&mut light, first, control).is_some() {
            Arc::make_mut(&mut self.references[index]).extend(light);
        }
    }

    fn measure_error(&mut self, index: usize, control: &RenderControl) {
        let candidate = &self.measurements[index].candidate;
        if candidate.family == Family::Referee {
            if let Err(error) = self.measure_povray(index, control) {
                self.leave_out(index, &error);
            }
            return;
        }
        let request = candidate.request(&self.scene);
        let tracer = Tracer::planned(&candidate.scene(&self.scene), &request, &mut self.planner);
        let Some((light, rays)) = trace_light(&tracer, control) else {
            return;
        };
        let size = (self.size.0 as usize, self.size.1 as usize);
        let light = scaled(&light, (tracer.width(), tracer.height()), size);
        let dot = &mut self.measurements[index];
        dot.metrics = Some(difference(&light, &self.references[0]));
        dot.rays_per_pixel = rays.total() as f64 / (size.0 * size.1) as f64;
        dot.picture = Some(Arc::new(eight_bits(light, size)));
        dot.lanes = tracer.lanes();
    }

    /// Removes a measurement that cannot be made, unless it was only stopped.
    fn leave_out(&mut self, index: usize, error: &PovrayError) {
        if !matches!(error, PovrayError::Stopped) {
            self.obstacle = Some(error.to_string());
            self.measurements.remove(index);
        }
    }

    /// Draws the picture with POV-Ray, and records its first time.
    fn measure_povray(&mut self, index: usize, control: &RenderControl) -> Result<(), PovrayError> {
        let scene = self.measurements[index].candidate.scene(&self.scene);
        let drawn = by_povray(&scene, Threads::current(), control)?;
        let light = drawn.picture.to_linear().pixels;
        let dot = &mut self.measurements[index];
        dot.metrics = Some(difference(&light, &self.references[0]));
        dot.rays_per_pixel = drawn.rays as f64 / light.len().max(1) as f64;
        dot.picture = Some(Arc::new(drawn.picture));
        dot.times.push(milliseconds(drawn.time));
        "f64".clone_into(&mut dot.lanes);
        Ok(())
    }

    /// Times one run of the candidate that has had the fewest, so that all take turns and a temporary disturbance of
    /// the machine affects them all. The other engine goes first, because it disturbs what runs after it.
    fn time_next(&mut self, control: &RenderControl) -> bool {
        let needs_runs = |(_, dot): &(usize, &mut Measurement)| dot.times.len() < dot.rounds();
        let Some((index, dot)) = self
            .measurements
            .iter_mut()
            .enumerate()
            .filter(needs_runs)
            .min_by_key(|(_, dot)| (dot.candidate.family != Family::Referee, dot.times.len()))
        else {
            return false;
        };
        if dot.candidate.family == Family::Referee {
            let scene = dot.candidate.scene(&self.scene);
            match by_povray(&scene, Threads::current(), control) {
                Ok(drawn) => dot.times.push(milliseconds(drawn.time)),
                Err(error) => self.leave_out(index, &error),
            }
            return true;
        }
        // The very first run is not counted: it finds cold caches and sleeping threads.
        let runs = if self.timed == 0 { 2 } else { 1 };
        for _ in 0..runs {
            let start = Instant::now();
            if draw(&dot.candidate, &self.scene, &mut self.planner, control).is_none() {
                return true;
            }
            self.timed += 1;
            if self.timed > 1 {
                dot.times.push(milliseconds(start.elapsed()));
            }
        }
        true
    }
}

/// Draws the finished picture, as users would get it.
fn draw(
    candidate: &Candidate,
    scene: &Scene,
    planner: &mut Planner,
    control: &RenderControl,
) -> Option<Image> {
    let (scene, request) = (candidate.scene(scene), candidate.request(scene));
    let mut image = Image::default();
    if candidate.upscale == 1 {
        render_into(&mut image, planner, &scene, &request, control)?;
        return Some(image);
    }
    let tracer = Tracer::planned(&scene, &request, planner);
    let (light, _) = trace_light(&tracer, control)?;
    let size = (scene.render.width as usize, scene.render.height as usize);
    let light = scaled(&light, (tracer.width(), tracer.height()), size);
    Some(eight_bits(light, size))
}

impl Measurement {
    /// Creates an entry without measurements.
    fn new(candidate: Candidate) -> Self {
        Self {
            candidate,
            metrics: None,
            rays_per_pixel: 0.0,
            times: Vec::new(),
            picture: None,
            lanes: String::new(),
        }
    }

    /// The number of timed runs that it needs.
    fn rounds(&self) -> usize {
        let slow = milliseconds(SLOW_RUN);
        if self.times.first().is_some_and(|&time| time > slow) {
            SLOW_ROUNDS
        } else {
            ROUNDS
        }
    }

    /// Returns whether its runs differ too much to trust the median.
    pub fn is_doubtful(&self) -> bool {
        self.timing()
            .is_some_and(|timing| timing.spread > MAX_SPREAD)
    }

    /// Statistics of its runs; `None` before the first.
    pub fn timing(&self) -> Option<Timing> {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        let at = |share| quantile(&times, share);
        let (median, low, high) = (at(0.5)?, at(0.25)?, at(0.75)?);
        Some(Timing {
            median,
            quartiles: (low, high),
            spread: (high - low) / median,
            runs: times.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::MAX_GRID;

    #[test]
    fn a_study_measures_everything_and_its_reference_is_no_method() {
        let scene = Arc::new(Scene::demo());
        let mut study = Study::new(Arc::clone(&scene), 24, 18);
        let control = RenderControl::default();
        let mut last = 0.0;
        while study.step(&control) {
            let done = study.progress();
            assert!(done >= last && done <= 1.0);
            last = done;
        }
        assert_eq!(study.progress(), 1.0);
        let reference = study.reference.as_ref().expect("a reference");
        assert!(
            reference.rmse > 0.0 && reference.rmse < 3e-4,
            "{:e}",
            reference.rmse
        );
        for dot in &study.measurements {
            let metrics = dot.metrics.expect("measured");
            assert!(
                metrics.rmse > 0.0,
                "{} is its own reference",
                dot.candidate.name
            );
            assert!(dot.timing().expect("timed").runs >= SLOW_ROUNDS);
            assert!(dot.rays_per_pixel > 0.0);
        }
        let rmse = |name: &str| {
            let dot = study
                .measurements
                .iter()
                .find(|dot| dot.candidate.name == name);
            dot.and_then(|dot| dot.metrics).expect("measured").rmse
        };
        assert!(rmse("the plan") < rmse("none") / 3.0);
        assert!(rmse("grid:8") < rmse("grid:2"));
        assert!(rmse("0 bounces") > 10.0 * rmse("the plan"));
    }

    #[test]
    fn a_reference_knows_how_far_it_is_off() {
        let scene = Scene::demo();
        let (width, height) = (32, 24);
        let request = RenderRequest {
            precision: Precision::Double,
            sampling: Sampling::Grid(MAX_GRID),
            ..RenderRequest::sized(width, height)
        };
        let control = RenderControl::default();
        let tracer = Tracer::planned(&scene, &request, &mut Planner::default());
        let (truth, _) = trace_light(&tracer, &control).expect("not stopped");
        let mut study = Study::new(Arc::new(scene), width, height);
        while study.reference.is_none() {
            study.step(&control);
        }
        let said = study.reference.as_ref().expect("a reference").rmse;
        let off = difference(&study.references[0], &truth).rmse;
        assert!(off < 1.5 * said && off > said / 3.0, "{said:e} {off:e}");
    }

    #[test]
    fn a_stopped_piece_is_done_again() {
        let mut study = Study::new(Arc::new(Scene::demo()), 16, 16);
        let stopped = RenderControl::default();
        stopped.stop();
        assert!(study.step(&stopped) && study.progress() == 0.0);
        assert!(study.step(&RenderControl::default()) && study.progress() > 0.0);
    }
}
