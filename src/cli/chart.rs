//! `glint chart`: measures the cost and the error of every way of tracing a scene.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::Args;

use super::action::CliAction;
use super::args::{ThreadsArgs, whole_number};
use super::bar::{SHARE_TEMPLATE, progress_bar};
use super::error::{CliError, report_warning, say};
use super::goal::{parse_error, parse_time};
use super::scene::read_scene;
use super::target::{check_table, picture_format};
use crate::export::write_text;
use crate::files::is_same_file;
use crate::lab::{
    Figure, Growth, PictureLook, Study, cheapest_within, closest_within, costs_of_choices, csv,
    csv_of, scaling, table,
};
use crate::machine::processor;
use crate::plan::RenderRequest;
use crate::scene::{Sampling, Scene};
use crate::trace::{RenderControl, Threads};
use crate::words::{capitalised, counted, milliseconds};

/// Most primitives of a scene in which growth is measured.
const MAX_PRIMITIVES: u32 = 1_000_000;
/// Sides of the picture, in pixels: room for the words, and less than what a screen is out of.
const PICTURE_SIDES: RangeInclusive<u32> = 480..=8192;
/// Default size of the picture for few scenes, in pixels.
const DEFAULT_SIZE: (u32, u32) = (1600, 960);
/// Steps of the progress bar.
const BAR_STEPS: u64 = 1000;

#[derive(Debug, Args)]
pub struct ChartArgs {
    /// Scene files (RON); several are charted in one picture with the same axes
    scenes: Vec<PathBuf>,
    /// Instead of the chart, measure how time grows with the number of primitives, in generated scenes
    #[arg(long, conflicts_with_all = ["scenes", "within", "budget"])]
    growth: bool,
    /// Instead of the chart, simulate how up to 128 cores would share pictures of the scenes, with one sample per pixel,
    /// from the measured times of their pieces
    #[arg(long, requires = "scenes", conflicts_with_all = ["growth", "within", "budget", "povray", "threads"])]
    cores: bool,
    /// Longer side of the compared pictures, in pixels
    #[arg(long, default_value = "256", value_parser = whole_number::<8, 2048>, allow_negative_numbers = true)]
    side: u32,
    /// Write all measurements to this CSV file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Save the chart as this picture (PNG, PPM or EXR)
    #[arg(long, value_name = "IMAGE")]
    png: Option<PathBuf>,
    /// Colours of the picture
    #[arg(long, value_name = "THEME", default_value = "dark")]
    theme: PictureTheme,
    /// Size of the picture in pixels [default: 1600x960, larger for many scenes]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_picture_size)]
    size: Option<(u32, u32)>,
    /// Name the cheapest method whose error is at most this: 55dB, or an RMSE (linear, 0–1)
    #[arg(long, value_name = "ERROR", value_parser = parse_error, allow_hyphen_values = true)]
    within: Option<f64>,
    /// Name the most accurate method within this time: 16ms, 2s, or a number of milliseconds
    #[arg(long, value_name = "TIME", value_parser = parse_time, allow_negative_numbers = true)]
    budget: Option<Duration>,
    /// Include POV-Ray, an independent renderer, if it is installed
    #[arg(long)]
    povray: bool,
    #[command(flatten)]
    threads: ThreadsArgs,
}

/// Colours of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum PictureTheme {
    Light,
    Dark,
}

impl ChartArgs {
    fn picture_look(&self) -> PictureLook {
        let least = self.least_size();
        let usual = (DEFAULT_SIZE.0.max(least.0), DEFAULT_SIZE.1.max(least.1));
        PictureLook {
            is_light: self.theme == PictureTheme::Light,
            size: self.size.unwrap_or(usual),
        }
    }

    /// The smallest picture that shows all charts completely.
    fn least_size(&self) -> (u32, u32) {
        PictureLook::least_size(self.charts())
    }

    /// The number of charts: the simulation of cores is one for all scenes, and growth is one without any.
    fn charts(&self) -> usize {
        if self.cores {
            1
        } else {
            self.scenes.len().max(1)
        }
    }

    /// Refuses a size that is too small, before anything is traced.
    fn check_size(&self) -> Result<(), CliError> {
        let (width, height) = self.least_size();
        match self.size {
            Some(size) if size.0 < width || size.1 < height => {
                let charts = self.charts();
                let need = if charts == 1 { "needs" } else { "need" };
                let charts = counted(charts as u64, "chart");
                Err(CliError::usage(format!(
                    "{charts} {need} a picture of {width}x{height} pixels or more"
                )))
            }
            _ => Ok(()),
        }
    }
}

/// Measures, prints the table, and writes the CSV file. Drawing the picture is left to the caller.
///
/// # Errors
/// [`CliError`], if a scene is invalid, if the picture has no known format, or if a file cannot be written.
pub fn run(args: &ChartArgs) -> Result<CliAction, CliError> {
    // A bad file name is reported before anything is traced.
    picture_format(args.png.as_deref())?;
    if args.scenes.is_empty() && !args.growth {
        return Err(CliError::usage("name scene files, or use --growth"));
    }
    args.check_size()?;
    check_table(args.csv.as_deref())?;
    if let Some(path) = &args.csv
        && args.scenes.iter().any(|scene| is_same_file(scene, path))
    {
        let path = path.display();
        let sentence = format!("{path} is the scene file: give the CSV file another name");
        return Err(CliError::usage(sentence));
    }
    let threads = args.threads.start()?;
    if args.growth {
        return measure_growth(args, &threads);
    }
    // A scene that cannot be read is reported before anything is measured.
    let scenes = args.scenes.iter().map(|path| Ok((path, read_scene(path)?)));
    let scenes = scenes.collect::<Result<Vec<_>, CliError>>()?;
    if args.cores {
        return simulate_cores(args, &scenes);
    }
    let mut studies = Vec::new();
    for (path, scene) in scenes {
        let name = name_of(path, &args.scenes);
        let mut study = Study::of_side(Arc::new(scene), args.side);
        if args.povray {
            study = study.with_povray();
        }
        measure(&mut study, &threads);
        if let Some(obstacle) = &study.obstacle {
            report_warning(obstacle);
        }
        if args.scenes.len() > 1 {
            say(&format!("{name}:"));
        }
        say(table(&study).trim_end());
        if args.within.is_some() || args.budget.is_some() {
            say(&advice(&study, args.within, args.budget));
        }
        // The pictures, which may be many and large, are not needed here.
        for dot in &mut study.measurements {
            dot.picture = None;
        }
        studies.push((name, study));
    }
    if let Some(path) = &args.csv {
        let machine = format!("{}, {}", processor(), std::env::consts::ARCH);
        write_text(path, &csv(&studies, &machine, threads.count())?)?;
    }
    let machine = format!("{}, {}", counted(threads.count(), "thread"), processor());
    let look = args.picture_look();
    let figure = Figure::Chart {
        studies,
        machine,
        look,
    };
    Ok(CliAction::drawing(figure, args.png.clone()))
}

/// Name of a scene: the stem of its file, or its whole path if other scenes have the same stem.
fn name_of(path: &Path, scenes: &[PathBuf]) -> String {
    let name = |path: &Path| capitalised(&path.file_stem().unwrap_or_default().to_string_lossy());
    let stem = name(path);
    let same_stem = scenes.iter().filter(|other| name(other) == stem);
    if same_stem.count() == 1 {
        stem
    } else {
        path.display().to_string()
    }
}

/// Parses a size such as `1600x960`.
fn parse_picture_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', '×']);
    let side = |text: &str| {
        text.trim()
            .parse()
            .ok()
            .filter(|side| PICTURE_SIDES.contains(side))
    };
    let size = sides.and_then(|(width, height)| Some((side(width)?, side(height)?)));
    let (least, most) = (PICTURE_SIDES.start(), PICTURE_SIDES.end());
    size.ok_or_else(|| format!("expected a size such as 1600x960, sides from {least} to {most}"))
}

/// Measures how time grows with the number of primitives, and prints and writes the costs.
fn measure_growth(args: &ChartArgs, threads: &Threads) -> Result<CliAction, CliError> {
    let mut growth = Growth::new(args.side, MAX_PRIMITIVES);
    if args.povray {
        growth = growth.with_povray();
    }
    run_with_bar(threads, || growth.step().then(|| growth.progress()));
    for obstacle in &growth.obstacles {
        report_warning(obstacle);
    }
    for cost in &growth.costs {
        let planned = cost.plan_ms.map(|ms| format!(", planned in {ms:.1} ms"));
        say(&format!(
            "{:<20} {:>9} primitives {:>9.2} ms{}",
            cost.name(),
            cost.primitives,
            cost.ms,
            planned.unwrap_or_default()
        ));
    }
    if let Some(path) = &args.csv {
        write_text(path, &csv_of(&growth.costs)?)?;
    }
    let figure = Figure::Growth(growth, args.picture_look());
    Ok(CliAction::drawing(figure, args.png.clone()))
}

/// Simulates how more cores would share the pictures of the scenes, and prints and writes the figures.
fn simulate_cores(args: &ChartArgs, scenes: &[(&PathBuf, Scene)]) -> Result<CliAction, CliError> {
    // One thread, because planning is done by one worker alone.
    let alone = Threads::new(Some(1))?;
    let mut pictures = Vec::new();
    for (path, scene) in scenes {
        let name = name_of(path, &args.scenes);
        let (width, height) = Study::size_of_side(scene, args.side);
        let request = RenderRequest {
            sampling: Sampling::Centres,
            ..RenderRequest::of(scene, width, height)
        };
        pictures.extend(alone.run(|| scaling(&name, scene, &request)));
    }
    for picture in &pictures {
        say(&format!(
            "{:<20} {:>10}, {:>4} pieces {:>9.3} ms, {:>3.0} % busy",
            picture.scene,
            counted(picture.workers, "core"),
            picture.pieces,
            picture.ms,
            picture.efficiency * 100.0
        ));
    }
    if let Some(path) = &args.csv {
        write_text(path, &csv_of(&pictures)?)?;
    }
    let figure = Figure::Scaling(pictures, args.picture_look());
    Ok(CliAction::drawing(figure, args.png.clone()))
}

fn measure(study: &mut Study, threads: &Threads) {
    let control = RenderControl::default();
    run_with_bar(threads, || study.step(&control).then(|| study.progress()));
}

/// Shows a progress bar while `step` returns the share that is done; `None` ends it.
fn run_with_bar(threads: &Threads, mut step: impl FnMut() -> Option<f64> + Send) {
    let bar = progress_bar(BAR_STEPS, SHARE_TEMPLATE);
    while let Some(share) = threads.run(&mut step) {
        bar.set_position((share * BAR_STEPS as f64) as u64);
    }
    bar.finish_and_clear();
}

/// The way of tracing that meets the given limits, in a sentence.
fn advice(study: &Study, within: Option<f64>, budget: Option<Duration>) -> String {
    let costs = costs_of_choices(study);
    let budget = budget.unwrap_or(Duration::MAX);
    let best = match within {
        Some(error) => cheapest_within(&costs, error, milliseconds(budget)),
        None => closest_within(&costs, milliseconds(budget)),
    };
    best.map_or_else(
        || "no measured method is within that limit".to_owned(),
        |index| {
            let candidate = &study.measurements[index].candidate;
            format!("use {}: {}", candidate.name, candidate.words())
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_one_name_are_told_apart() {
        let scenes = ["a/x.ron", "b/X.ron", "b/y.ron"].map(PathBuf::from);
        let names = scenes.each_ref().map(|path| name_of(path, &scenes));
        assert_eq!(names, ["a/x.ron", "b/X.ron", "Y"]);
    }

    #[test]
    fn a_picture_shows_all_of_its_charts() {
        let args = |scenes: usize, size| ChartArgs {
            scenes: vec![PathBuf::from("a.ron"); scenes],
            growth: false,
            cores: false,
            side: 8,
            csv: None,
            png: None,
            theme: PictureTheme::Dark,
            size,
            within: None,
            budget: None,
            povray: false,
            threads: ThreadsArgs::default(),
        };
        assert_eq!(args(1, None).picture_look().size, DEFAULT_SIZE);
        assert_eq!(args(9, None).picture_look().size, DEFAULT_SIZE);
        assert_eq!(args(16, None).picture_look().size, (1920, 1240));
        assert!(args(1, Some((480, 480))).check_size().is_ok());
        let problem = args(3, Some((480, 480))).check_size().expect_err("cut off");
        let expected = "3 charts need a picture of 960x680 pixels or more";
        assert_eq!(problem.to_string(), expected);
        let problem = args(0, Some((100, 100))).check_size().expect_err("cut off");
        let expected = "1 chart needs a picture of 480x400 pixels or more";
        assert_eq!(problem.to_string(), expected);
    }
}
