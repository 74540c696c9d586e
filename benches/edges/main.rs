//! What clean edges cost where they are hard: `cargo bench --bench edges`. For each scene the time of a picture with one
//! sample a pixel, that of clean edges and how far they are off, and the time in which a plain grid of samples is as
//! right. On one thread; compare columns of one row.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark that cannot go on has failed, and the table is what it is for"
)]

mod nasty;

use std::time::Instant;

use glint::image::LinearRgb;
use glint::lab::{difference, trace_light};
use glint::plan::RenderRequest;
use glint::scene::{Precision, Sampling, Scene};
use glint::trace::{Rays, RenderControl, Threads, Tracer};

/// Side of the pictures in pixels.
const SIDE: u32 = 256;
/// Samples along the sides of a pixel of what counts as the truth.
const TRUTH: u32 = 24;
/// The same of the grids that clean edges are held against.
const GRIDS: [u32; 9] = [1, 2, 3, 4, 5, 6, 8, 11, 16];
/// The best of so many runs counts.
const RUNS: u32 = 3;

/// One way of sampling a scene.
struct Measured {
    milliseconds: f64,
    pixels: Vec<LinearRgb>,
    rays: Rays,
}

fn main() {
    println!(
        "{:<24} {:>8} {:>8} {:>7} {:>7} {:>6} {:>7} {:>9} {:>7}",
        "scene", "plain ms", "clean ms", "× plain", "rays/px", "dB", "worst", "grid ms", "× grid"
    );
    let threads = Threads::new(Some(1)).expect("threads");
    for (name, scene) in nasty::scenes() {
        threads.run(|| print_row(name, &scene));
    }
}

fn measure(scene: &Scene, sampling: Sampling, (precision, runs): (Precision, u32)) -> Measured {
    let request = RenderRequest {
        sampling,
        precision,
        ..RenderRequest::sized(SIDE, SIDE)
    };
    let tracer = Tracer::new(scene, &request);
    let mut milliseconds = f64::INFINITY;
    let mut traced = None;
    for _ in 0..runs {
        let since = Instant::now();
        traced = trace_light(&tracer, &RenderControl::default());
        milliseconds = milliseconds.min(since.elapsed().as_secs_f64() * 1e3);
    }
    let (pixels, rays) = traced.expect("not stopped");
    Measured {
        milliseconds,
        pixels,
        rays,
    }
}

fn print_row(name: &str, scene: &Scene) {
    let truth = measure(scene, Sampling::Grid(TRUTH), (Precision::Double, 1));
    let auto = |sampling| measure(scene, sampling, (Precision::Auto, RUNS));
    let clean = auto(Sampling::ADAPTIVE);
    let off = difference(&clean.pixels, &truth.pixels);
    let grids = GRIDS.map(|side| {
        let grid = auto(Sampling::Grid(side));
        (
            difference(&grid.pixels, &truth.pixels).rmse,
            grid.milliseconds,
        )
    });
    let [(_, plain), .., (_, finest)] = grids;
    let equal = time_of_equal(&grids, off.rmse);
    println!(
        "{name:<24} {plain:>8.1} {:>8.1} {:>7.1} {:>7.1} {:>6.1} {:>7.1} {:>9} {:>7}",
        clean.milliseconds,
        clean.milliseconds / plain,
        clean.rays.camera as f64 / f64::from(SIDE * SIDE),
        off.psnr(),
        off.max * 255.0,
        equal.map_or_else(|| format!("> {finest:.0}"), |equal| format!("{equal:.0}")),
        equal.map_or_else(
            || format!("< {:.2}", clean.milliseconds / finest),
            |equal| format!("{:.2}", clean.milliseconds / equal)
        ),
    );
}

/// In what time a grid is no farther off than this, on straight lines between those that were measured (error, ms) on a
/// chart with logarithmic axes; `None` where none is.
fn time_of_equal(grids: &[(f64, f64)], rmse: f64) -> Option<f64> {
    let enough = grids.iter().position(|(error, _)| *error <= rmse)?;
    let (error, time) = grids[enough];
    let Some((coarser_error, coarser_time)) = enough.checked_sub(1).map(|index| grids[index])
    else {
        return Some(time);
    };
    let share = (rmse / coarser_error).ln() / (error / coarser_error).ln();
    Some(coarser_time * (time / coarser_time).powf(share))
}
