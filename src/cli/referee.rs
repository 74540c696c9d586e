//! `glint referee`: compares the picture with that of an independent engine.

use std::path::PathBuf;

use clap::Args;

use super::args::{SizeArgs, ThreadsArgs};
use super::error::{CliError, say};
use super::scene::read_scene;
use super::target::picture_format;
use crate::export::{by_povray, povray_differences, save_image};
use crate::image::{Film, Image, render_into};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Sampling;
use crate::trace::RenderControl;
use crate::words::{counted, milliseconds};

/// Factor by which the output picture amplifies differences.
const AMPLIFICATION: u16 = 64;

#[derive(Debug, Args)]
pub struct RefereeArgs {
    /// The scene file (RON)
    scene: PathBuf,
    #[command(flatten)]
    size: SizeArgs,
    /// Save the differences, magnified 64 times, as this picture (PNG, PPM or EXR)
    #[arg(short, long, value_name = "IMAGE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
}

/// Draws the scene with both engines, one ray through the centre of each pixel, and prints how far the pictures
/// differ.
///
/// # Errors
/// [`CliError`], if the scene is invalid, if POV-Ray fails or is missing, or if the picture cannot be written.
pub fn run(args: &RefereeArgs) -> Result<(), CliError> {
    picture_format(args.output.as_deref())?;
    let mut scene = read_scene(&args.scene)?;
    let size = &mut scene.render;
    let scene_size = (size.width, size.height);
    (size.width, size.height) = args.size.of(scene_size)?;
    size.antialias = Sampling::Centres;
    let threads = args.threads.start()?;
    let theirs =
        by_povray(&scene, threads.count(), &RenderControl::default()).map_err(CliError::failed)?;
    let request = RenderRequest::still(&scene);
    // Twice, because POV-Ray's time does not include reading the scene: the first run prepares the meshes.
    let mut ours = Image::new(request.width as usize, request.height as usize);
    let (mut planner, control) = (Planner::default(), RenderControl::default());
    let mut trace = || render_into(&mut ours, &mut planner, &scene, &request, &control);
    let cost = threads.run(|| trace().and_then(|_| trace()));
    let cost = cost.ok_or_else(CliError::no_picture)?;
    let differences = ours.pixels.iter().zip(&theirs.picture.pixels);
    let differences: Vec<[u8; 3]> = differences
        .map(|(a, b)| std::array::from_fn(|channel| a[channel].abs_diff(b[channel])))
        .collect();
    let worst = differences.iter().flatten().max().copied().unwrap_or(0);
    let same = differences
        .iter()
        .filter(|difference| difference.iter().all(|difference| *difference <= 1))
        .count();
    let share = same as f64 * 100.0 / differences.len().max(1) as f64;
    say(&format!(
        "{share:.3} % of {}×{} pixels are within 1/255 of POV-Ray's, all but {}; the largest difference is {worst}",
        ours.width,
        ours.height,
        differences.len() - same,
    ));
    say(&format!(
        "Glint {:.1} ms, POV-Ray {:.0} ms without reading the scene, {} each",
        milliseconds(cost.time),
        milliseconds(theirs.time),
        counted(threads.count(), "thread")
    ));
    if share < 100.0 {
        for difference in povray_differences(&scene) {
            say(&format!("known difference: {difference}"));
        }
    }
    if let Some(path) = &args.output {
        let amplified = |difference: u8| (u16::from(difference) * AMPLIFICATION).min(255) as u8;
        let pixels = differences
            .iter()
            .map(|&[r, g, b]| [amplified(r), amplified(g), amplified(b), 255]);
        let image = Image {
            pixels: pixels.collect(),
            ..ours
        };
        save_image(&Film::Levels(image), path)?;
    }
    Ok(())
}
