//! A study: all candidates of a scene, measured step by step, so that other work can go first.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::candidates::{Candidate, Family, candidates, povray};
use super::measure::{ErrorMetrics, difference, eight_bits, mean, scaled, trace_light};
use crate::export::{PovrayError, by_povray};
use crate::image::{Image, LinearRgb, render_into};
use crate::plan::{Planner, RenderRequest};
use crate::scene::{Precision, Sampling, Scene};
use crate::trace::{RenderControl, Threads, Tracer};

/// Samples along each side of a pixel of the two pictures whose mean is the reference. They have no place in common
/// but the middle of the pixel, so that they are off in other ways, and what they differ by tells how far.
const REFERENCE_GRIDS: [u32; 2] = [47, 53];
/// Samples of the reference per pixel.
pub const REFERENCE_SAMPLES: u32 = REFERENCE_GRIDS[0].pow(2) + REFERENCE_GRIDS[1].pow(2);
/// Each of the two is traced in so many pieces, between which more urgent work can go first.
const REFERENCE_PIECES: usize = 32;
/// What the references count for in the progress, in timed runs.
const REFERENCE_WORTH: f64 = 100.0;
/// Timed runs of each candidate, not counting the one that warms up.
const ROUNDS: usize = 9;
/// A candidate that takes longer than this is run less often.
const SLOW: Duration = Duration::from_millis(250);
/// Timed runs of such.
const SLOW_ROUNDS: usize = 3;

/// A spread above this makes a time doubtful.
const DOUBTFUL: f64 = 0.2;

/// One measured way of tracing.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// The way.
    pub candidate: Candidate,
    /// What its picture is off; `None` until it is measured.
    pub metrics: Option<ErrorMetrics>,
    /// Rays per pixel of the finished picture, all kinds together.
    pub rays_per_pixel: f64,
    /// Milliseconds of each timed run.
    pub times: Vec<f64>,
    /// The picture.
    pub picture: Option<Arc<Image>>,
    /// Real type and width of its kernel.
    pub lanes: String,
}

/// The time of a dot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Milliseconds; the middle of all runs.
    pub median: f64,
    /// Milliseconds; a quarter of the runs was faster than the first, and slower than the second.
    pub quartiles: (f64, f64),
    /// Distance of the quartiles, as a share of the median.
    pub spread: f64,
    /// How many runs there were.
    pub runs: usize,
}

/// What the errors are measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// How far it is off itself: half of what the two pictures differ by whose mean it is, which is the standard error
    /// of a mean of two.
    pub rmse: f64,
    /// The picture.
    pub picture: Arc<Image>,
}

/// The measuring of a scene. Pictures are shared between copies.
#[derive(Clone, Debug)]
pub struct Study {
    scene: Arc<Scene>,
    size: (u32, u32),
    /// The two pictures whose mean is the reference, as many rows as are traced; their mean in place of the first, once
    /// it is known.
    references: [Arc<Vec<LinearRgb>>; 2],
    /// There once the reference is.
    pub reference: Option<Reference>,
    /// One for each candidate.
    pub measurements: Vec<Measurement>,
    /// Why another engine is not among them, though it was to be.
    pub obstacle: Option<String>,
    planner: Planner,
    spent: Duration,
    timed: usize,
}

impl Study {
    /// Nothing measured yet; pictures will have the scene's aspect, and a longer side of `side` pixels.
    pub fn of_side(scene: Arc<Scene>, side: u32) -> Self {
        let (width, height) = Self::size_of_side(&scene, side);
        Self::new(scene, width, height)
    }

    /// Width and height of a scene's picture whose longer side is so long.
    pub fn size_of_side(scene: &Scene, side: u32) -> (u32, u32) {
        let (width, height) = (scene.render.width, scene.render.height);
        let scale = f64::from(side) / f64::from(width.max(height));
        let scaled = |side: u32| ((f64::from(side) * scale).round() as u32).max(1);
        (scaled(width), scaled(height))
    }

    /// Nothing measured yet; pictures will be `width × height`.
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

    /// The same, and POV-Ray beside all ways, if it is there.
    pub fn with_povray(mut self) -> Self {
        let referee = povray(&self.scene, self.size.0, self.size.1);
        self.measurements.push(Measurement::new(referee));
        self
    }

    /// The scene that is measured.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Width and height of the pictures.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Does the next piece of work on the current rayon pool: rows of a reference, a picture, or a timed
    /// run.
    /// `false` when all is done. A piece that `control` has stopped is done again the next time.
    pub fn step(&mut self, control: &RenderControl) -> bool {
        let start = Instant::now();
        let is_more = if self.reference.is_none() {
            self.find_reference(control);
            true
        } else if let Some(index) = self
            .measurements
            .iter()
            .position(|dot| dot.metrics.is_none())
        {
            self.look_at(index, control);
            true
        } else {
            self.time_next(control)
        };
        self.spent += start.elapsed();
        is_more
    }

    /// Share of the work that is done, 0–1, by the number of its pieces.
    pub fn progress(&self) -> f64 {
        let seen = self
            .measurements
            .iter()
            .filter(|dot| dot.metrics.is_some())
            .count();
        let pixels = (self.size.0 * self.size.1) as usize;
        let traced = match self.reference {
            Some(_) => 2 * pixels,
            None => self.references.iter().map(|light| light.len()).sum(),
        };
        // References take as long as a good part of the rest.
        let reference = REFERENCE_WORTH * traced as f64 / (2 * pixels) as f64;
        let wanted: usize = self.measurements.iter().map(Measurement::rounds).sum();
        let runs: usize = self.measurements.iter().map(|dot| dot.times.len()).sum();
        let (done, all) = (seen + runs, self.measurements.len() + wanted);
        (reference + done as f64) / (REFERENCE_WORTH + all as f64)
    }

    /// How long the rest will take; `None` at the start.
    pub fn remaining(&self) -> Option<Duration> {
        let done = self.progress();
        (done > 0.0).then(|| self.spent.mul_f64((1.0 - done) / done))
    }

    /// A few rows of one of the two pictures, or their mean when both are there.
    fn find_reference(&mut self, control: &RenderControl) {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let unfinished = self
            .references
            .iter()
            .position(|reference| reference.len() < width * height);
        let Some(index) = unfinished else {
            let [first, second] = std::mem::take(&mut self.references);
            let rmse = difference(&first, &second).rmse / 2.0;
            let mean = mean(&first, &second);
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

    fn look_at(&mut self, index: usize, control: &RenderControl) {
        let candidate = &self.measurements[index].candidate;
        if candidate.family == Family::Referee {
            match self.ask_povray(index, control) {
                Ok(()) | Err(PovrayError::Stopped) => {}
                Err(error) => {
                    self.obstacle = Some(error.to_string());
                    self.measurements.remove(index);
                }
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
        dot.picture = Some(Arc::new(eight_bits(light, (size.0, size.1))));
        dot.lanes = tracer.lanes();
    }

    /// The picture of the other engine, and one of its times.
    fn ask_povray(&mut self, index: usize, control: &RenderControl) -> Result<(), PovrayError> {
        let scene = self.measurements[index].candidate.scene(&self.scene);
        let drawn = by_povray(&scene, Threads::current(), control)?;
        let light = drawn.picture.to_linear().pixels;
        let dot = &mut self.measurements[index];
        dot.metrics = Some(difference(&light, &self.references[0]));
        dot.rays_per_pixel = drawn.rays as f64 / light.len().max(1) as f64;
        dot.picture = Some(Arc::new(drawn.picture));
        dot.times.push(drawn.time.as_secs_f64() * 1e3);
        "f64".clone_into(&mut dot.lanes);
        Ok(())
    }

    /// One run of the candidate that has had the fewest, in turn, so that what disturbs the machine
    /// for a while disturbs all of them. Another engine comes first: what it leaves behind disturbs who comes next.
    fn time_next(&mut self, control: &RenderControl) -> bool {
        let waiting = |dot: &&mut Measurement| dot.times.len() < dot.rounds();
        let Some(dot) = self
            .measurements
            .iter_mut()
            .filter(waiting)
            .min_by_key(|dot| (dot.candidate.family != Family::Referee, dot.times.len()))
        else {
            return false;
        };
        if dot.candidate.family == Family::Referee {
            let scene = dot.candidate.scene(&self.scene);
            let first = dot.times.first().copied().unwrap_or_default();
            match by_povray(&scene, Threads::current(), control) {
                Ok(drawn) => dot.times.push(drawn.time.as_secs_f64() * 1e3),
                Err(PovrayError::Stopped) => {}
                // It has drawn this before: what it took then has to do.
                Err(_) => dot.times.push(first),
            }
            return true;
        }
        // The first run of all finds cold caches and sleeping threads.
        let runs = if self.timed == 0 { 2 } else { 1 };
        for _ in 0..runs {
            let start = Instant::now();
            if draw(&dot.candidate, &self.scene, &mut self.planner, control).is_none() {
                return true;
            }
            self.timed += 1;
            if self.timed > 1 {
                dot.times.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        true
    }
}

/// The finished picture, as the user would get it.
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
    Some(eight_bits(light, (size.0, size.1)))
}

impl Measurement {
    /// Nothing measured yet.
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

    /// How often it is to be timed.
    fn rounds(&self) -> usize {
        let slow = SLOW.as_secs_f64() * 1e3;
        if self.times.first().is_some_and(|&time| time > slow) {
            SLOW_ROUNDS
        } else {
            ROUNDS
        }
    }

    /// Whether its runs differ by too much to trust their median.
    pub fn is_doubtful(&self) -> bool {
        self.timing().is_some_and(|timing| timing.spread > DOUBTFUL)
    }

    /// Its time, once there is one.
    pub fn timing(&self) -> Option<Timing> {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        // Between neighbours in proportion (Hyndman and Fan, "Sample quantiles in statistical packages", The
        // American Statistician 50(4), 1996, definition 7).
        let at = |share: f64| {
            let place = times.len().checked_sub(1)? as f64 * share;
            let (below, above) = (times[place.floor() as usize], times[place.ceil() as usize]);
            Some(below + (above - below) * place.fract())
        };
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
