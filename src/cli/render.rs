//! `glint render`: traces a scene file into a picture file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

use clap::{Args, ValueEnum, ValueHint};
use serde::Serialize;

use super::args::{MAX_TIMES, SizeArgs, ThreadsArgs, whole_number};
use super::bar::{SHARE_TEMPLATE, TICK, progress_bar};
use super::error::{CliError, say};
use super::goal::{parse_error, parse_time};
use super::scene::{read_scene, read_whole_document};
use super::settings::SettingArgs;
use super::target::picture_format;
use crate::animate::shot_of_frame;
use crate::export::{NoSuchFrame, save_picture};
use crate::image::{Film, Format, RenderCost};
use crate::lab::{Choice, Goal, choose, quantile};
use crate::plan::{Planner, RenderRequest};
use crate::scene::{Aspect, Method as _, Projection, Scene};
use crate::simd::Level;
use crate::trace::{Rays, RenderControl, Threads};
use crate::words::milliseconds;
use crate::worker::Background;

#[derive(Debug, Args)]
pub struct RenderArgs {
    /// The scene file (RON)
    scene: PathBuf,
    /// The picture to write, ending in .png, .ppm or .exr (the same values, 0–1, unrounded); optional with --stats
    #[arg(short, long, value_name = "IMAGE", required_unless_present = "stats")]
    output: Option<PathBuf>,
    #[command(flatten)]
    size: SizeArgs,
    /// Projection to use instead of the scene's own
    #[arg(long)]
    camera: Option<CameraArg>,
    #[command(flatten)]
    settings: SettingArgs,
    /// Measure samplings on this picture and use the cheapest one whose error is at most this: 55dB, or an RMSE (linear, 0–1); another run may choose a different one
    #[arg(long, value_name = "ERROR", value_parser = parse_error, allow_hyphen_values = true, conflicts_with_all = ["antialias", "budget", "show"])]
    within: Option<f64>,
    /// Measure samplings on this picture and use the most accurate one within this time: 16ms, 2s, or a number of milliseconds; measuring takes extra time
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_negative_numbers = true, conflicts_with_all = ["antialias", "show"])]
    budget: Option<Duration>,
    /// Instruction set of the tracer; all give the same picture [default: the widest that this processor has]
    #[arg(long, value_name = "LEVEL", value_parser = parse_lanes, value_hint = ValueHint::Other)]
    lanes: Option<Level>,
    /// Frame of the animation, counted from 1 [default: the scene's own camera and values]
    #[arg(long, value_name = "N", value_parser = parse_frame, allow_negative_numbers = true)]
    frame: Option<u64>,
    #[arg(long, value_name = "ASPECT", value_parser = parse_aspect, help = aspect_help(), value_hint = ValueHint::Other)]
    show: Option<Aspect>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Number of times to trace; the statistics show the median of all runs except the first, which prepares meshes for the others
    #[arg(long, default_value = "1", value_parser = whole_number::<1, MAX_TIMES>, allow_negative_numbers = true)]
    repeat: u32,
    /// Print statistics as one JSON object to stdout
    #[arg(long)]
    stats: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum CameraArg {
    Perspective,
    Orthographic,
}

#[derive(Serialize)]
struct Stats {
    trace_ms: f64,
    trace_ms_min: f64,
    rays: Rays,
    lanes: String,
    /// The chosen sampling, if `--within` or `--budget` was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    chosen: Option<ChosenSampling>,
    threads: usize,
    width: u32,
    height: u32,
}

#[derive(Serialize)]
struct ChosenSampling {
    antialias: String,
    /// The error measured on strips of the picture.
    rmse: f64,
    /// Whether it meets the limit that was given.
    is_met: bool,
}

fn parse_lanes(word: &str) -> Result<Level, String> {
    Level::named(word).ok_or_else(|| {
        let known: Vec<&str> = Level::available()
            .into_iter()
            .map(|level| level.name)
            .collect();
        format!("this processor has {}", known.join(", "))
    })
}

/// Traces and writes the picture, then prints the statistics.
///
/// # Errors
/// [`CliError`], if the scene is invalid, if it does not have the frame, or if the picture cannot be traced or
/// written.
pub fn run(args: &RenderArgs) -> Result<(), CliError> {
    // A bad file name is reported before anything is traced.
    let format = picture_format(args.output.as_deref())?;
    let mut scene = match args.frame {
        None => read_scene(&args.scene)?,
        Some(_) => read_whole_document(&args.scene)?.scene,
    };
    let threads = args.threads.start()?;
    if let Some(frame) = args.frame {
        let with_path = |sentence| CliError::usage(format!("{}: {sentence}", args.scene.display()));
        scene = at_frame(scene, frame).map_err(with_path)?;
    }
    args.settings.apply(&mut scene.render);
    scene = args.show.unwrap_or_default().of(&scene);
    let mut request = args.request(&scene)?;
    let choice = args.choose(&scene, &request, &threads)?;
    request.sampling = choice.map_or(request.sampling, |choice| choice.sampling);
    let count = threads.count();
    let film = Film::new(format.unwrap_or(Format::Ppm));
    let total = request.pixels() * u64::from(args.repeat);
    let (repeat, output) = (args.repeat, args.output.clone());
    let traced = with_bar(total, move |control| {
        threads.run(|| {
            trace(
                &scene,
                (&request, film),
                (repeat, output.as_deref()),
                control,
            )
        })
    });
    let costs = traced.ok_or_else(CliError::no_picture)??;
    let stats = stats((&request, choice), &costs, count);
    match (&args.output, args.stats) {
        (_, true) => say(&serde_json::to_string(&stats)?),
        (Some(path), false) => say(&summary(path, &stats)),
        (None, false) => {}
    }
    if let Some(choice) = choice.filter(|_| !args.stats) {
        say(&choice.words());
    }
    Ok(())
}

fn parse_aspect(word: &str) -> Result<Aspect, String> {
    let mut all = Aspect::EACH.into_iter();
    let found = all.find(|(aspect, ..)| aspect.word() == word);
    found
        .map(|(aspect, ..)| aspect)
        .ok_or_else(|| format!("expected {}", Aspect::words()))
}

fn aspect_help() -> String {
    format!(
        "Show one aspect instead of the picture: {}",
        Aspect::words()
    )
}

fn parse_frame(word: &str) -> Result<u64, String> {
    let number = word.parse().ok().filter(|&number| number > 0);
    number.ok_or_else(|| "frames are whole numbers, counted from 1".to_owned())
}

/// The scene in a frame of its animation.
fn at_frame(scene: Scene, frame: u64) -> Result<Scene, NoSuchFrame> {
    let count = scene.animation.frame_count();
    if frame > count {
        return Err(NoSuchFrame { frame, count });
    }
    let shown = shot_of_frame(&Arc::new(scene), frame);
    Ok(Arc::unwrap_or_clone(shown))
}

impl RenderArgs {
    /// The sampling that meets the given limit, if there is one.
    fn choose(
        &self,
        scene: &Scene,
        request: &RenderRequest,
        threads: &Threads,
    ) -> Result<Option<Choice>, CliError> {
        let goal = self.within.map(Goal::Within);
        let Some(goal) = goal.or(self.budget.map(Goal::Budget)) else {
            return Ok(None);
        };
        let (mut planner, control) = (Planner::default(), RenderControl::default());
        let chosen = threads.run(|| choose(scene, request, goal, &mut planner, &control));
        let no_choice = || CliError::failed("measuring ended without a choice");
        chosen.ok_or_else(no_choice).map(Some)
    }

    fn request(&self, scene: &Scene) -> Result<RenderRequest, CliError> {
        let scene_size = (scene.render.width, scene.render.height);
        let (width, height) = self.size.of(scene_size)?;
        Ok(RenderRequest {
            projection: self.camera.map(|arg| match arg {
                CameraArg::Perspective => Projection::Perspective,
                CameraArg::Orthographic => Projection::Orthographic,
            }),
            level: self.lanes,
            aspect: self.show.unwrap_or_default(),
            ..RenderRequest::of(scene, width, height)
        })
    }
}

/// Traces `repeat` times, the last time into a file if one is given.
fn trace(
    scene: &Scene,
    (request, mut film): (&RenderRequest, Film),
    (repeat, output): (u32, Option<&Path>),
    control: &RenderControl,
) -> Result<Vec<RenderCost>, CliError> {
    let no_picture = |_| CliError::no_picture();
    let mut costs = Vec::new();
    // All runs use the same prepared meshes, which may be large.
    let mut planner = Planner::default();
    for remaining in (0..repeat).rev() {
        let mut drawing = film.draw(&mut planner, (scene, request), control);
        drawing.start().map_err(no_picture)?;
        match output.filter(|_| remaining == 0) {
            Some(path) => save_picture(path, |format, file| drawing.encode(format, file))?,
            None => drawing.finish().map_err(no_picture)?,
        }
        costs.push(drawing.cost());
    }
    Ok(costs)
}

/// Does work on `total` pixels in the background, with a progress bar if it takes a while; `None` if it panics.
fn with_bar<T: Send + 'static>(
    total: u64,
    work: impl FnOnce(&RenderControl) -> T + Send + 'static,
) -> Option<T> {
    let control = Arc::new(RenderControl::default());
    let mut result = Background::start("glint-render", {
        let control = Arc::clone(&control);
        move || work(&control)
    });
    let mut bar = None;
    loop {
        if let Some(done) = result.take_within(TICK) {
            return done.ok();
        }
        let bar = bar.get_or_insert_with(|| progress_bar(total, SHARE_TEMPLATE));
        bar.set_position(control.pixels.load(Ordering::Relaxed));
    }
}

fn stats(
    (request, choice): (&RenderRequest, Option<Choice>),
    costs: &[RenderCost],
    threads: usize,
) -> Stats {
    // The first run prepares the meshes for all of them.
    let timed = if costs.len() > 1 { &costs[1..] } else { costs };
    let mut millis: Vec<f64> = timed.iter().map(|cost| milliseconds(cost.time)).collect();
    millis.sort_by(f64::total_cmp);
    let RenderCost { rays, lanes, .. } = costs[0].clone();
    Stats {
        trace_ms: quantile(&millis, 0.5).unwrap_or(millis[0]),
        trace_ms_min: millis[0],
        rays,
        lanes,
        chosen: choice.map(|choice| ChosenSampling {
            antialias: choice.sampling.id(),
            rmse: choice.rmse,
            is_met: choice.is_met,
        }),
        threads,
        width: request.width,
        height: request.height,
    }
}

fn summary(path: &Path, stats: &Stats) -> String {
    let Stats {
        width,
        height,
        trace_ms,
        ..
    } = stats;
    let rays = stats.rays.total();
    let per_pixel = rays as f64 / (f64::from(*width) * f64::from(*height));
    format!(
        "{}: {width}×{height}, {trace_ms:.1} ms, {per_pixel:.2} rays/px",
        path.display()
    )
}
