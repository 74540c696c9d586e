//! Speed of exporting an animation to disk: `cargo bench --bench export`. Tracing, encoding and writing overlap; each
//! run writes to an empty folder.

#![allow(
    clippy::expect_used,
    reason = "a benchmark that cannot go on has failed"
)]

use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use glint::export::{ExportStep, Exporting, Pattern, Sequence};
use glint::image::Format;
use glint::scene::{Document, Sampling};
use glint::trace::{RenderControl, Threads};

const FLIGHT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/flight.ron");

fn main() {
    divan::main();
}

fn flight(bencher: Bencher, sampling: Sampling, format: Format) {
    let threads = Threads::new(None).expect("threads");
    let mut scene = Document::load(FLIGHT.as_ref()).expect("a scene").scene;
    scene.render.antialias = sampling;
    let scene = Arc::new(scene);
    let count = scene.animation.frame_count();
    bencher
        .counter(ItemsCount::new(count))
        .with_inputs(|| tempfile::tempdir().expect("a folder"))
        .bench_local_values(|folder| {
            let frames = folder.path().to_owned();
            let sequence =
                Sequence::new(Arc::clone(&scene), None, Pattern::default(), format, frames);
            let mut exporting = Exporting::new(sequence.expect("frames")).expect("a folder");
            threads
                .run(|| while let ExportStep::Going = exporting.step(&RenderControl::default()) {});
            assert_eq!(exporting.finish().expect("written").written as u64, count);
            folder
        });
}

/// The 202 frames of `flight.ron`, 1024², one sample per pixel, PPM.
#[divan::bench(sample_count = 5, sample_size = 1)]
fn flight_ppm(bencher: Bencher) {
    flight(bencher, Sampling::Centres, Format::Ppm);
}

/// The same frames with clean edges, PNG.
#[divan::bench(sample_count = 2, sample_size = 1)]
fn flight_png_smooth(bencher: Bencher) {
    flight(bencher, Sampling::ADAPTIVE, Format::Png);
}
