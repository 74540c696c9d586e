//! Cost of clean edges in scenes where they are difficult: `cargo bench --bench edges`. For each scene, the table has
//! the time of a picture with one sample per pixel, the time and error of clean edges, and the time in which a plain
//! grid of samples reaches the same error. Runs on one thread; compare columns within one row.

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
/// Samples along each side of a pixel in the picture that counts as the truth.
const TRUTH: u32 = 24;
/// Samples along each side of a pixel in the grids that clean edges are compared with.
const GRIDS: [u32; 9] = [1, 2, 3, 4, 5, 6, 8, 11, 16];
/// Number of runs, of which the fastest counts.
const RUNS: u32 = 3;

/// Measurements of one sampling of a scene.
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

/// Time in which a grid reaches this error, interpolated linearly between the measured (error, ms) on logarithmic
/// axes; `None` if no grid does.
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
