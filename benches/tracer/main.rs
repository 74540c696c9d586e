//! Speed of tracing pictures: `cargo bench`. Machines differ and may be busy, so compare rows of one run only.
//!
//! `plain` is the baseline: the image model as a student would implement it (`plain.rs`).

#![allow(
    clippy::expect_used,
    reason = "a benchmark that cannot go on has failed"
)]

mod plain;

use divan::{Bencher, black_box};
use glam::DVec3;
use glint::image::{Image, render, render_into};
use glint::plan::{Planner, RenderRequest};
use glint::scene::{Object, Precision, Sampling, Scene, Sphere};
use glint::simd::Level;
use glint::trace::{RenderControl, Threads};

fn main() {
    agree();
    divan::main();
}

/// Checks that the baseline draws the same picture; otherwise comparing with it would be meaningless.
fn agree() {
    let scene = Scene::demo();
    let plain = plain::render(&scene, 256, 256);
    let (ours, _) = render(
        &scene,
        &RenderRequest::sized(256, 256),
        &RenderControl::default(),
    )
    .expect("not stopped");
    let differ = plain.pixels.iter().zip(&ours.pixels);
    let differ = differ
        .filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 1))
        .count();
    assert!(
        differ <= 65,
        "{differ} of 65536 pixels differ by more than 1/255"
    );
}

fn trace(bencher: Bencher, scene: &Scene, request: RenderRequest, threads: usize) {
    let threads = Threads::new(Some(threads)).expect("threads");
    // Reuses the image of the last run, as the window does.
    let (mut image, mut planner) = (Image::default(), Planner::default());
    bencher.bench_local(|| {
        let control = RenderControl::default();
        threads.run(|| render_into(&mut image, &mut planner, scene, &request, &control))
    });
}

#[divan::bench(sample_count = 10)]
fn demo_1024_plain(bencher: Bencher) {
    let scene = Scene::demo();
    bencher.bench_local(|| -> Image { plain::render(black_box(&scene), 1024, 1024) });
}

#[divan::bench(args = [1, 2], sample_count = 50)]
fn demo_1024_threads(bencher: Bencher, threads: usize) {
    trace(
        bencher,
        &Scene::demo(),
        RenderRequest::sized(1024, 1024),
        threads,
    );
}

#[divan::bench(args = [1, 2], sample_count = 50)]
fn demo_1024_double_threads(bencher: Bencher, threads: usize) {
    let picture = RenderRequest {
        precision: Precision::Double,
        ..RenderRequest::sized(1024, 1024)
    };
    trace(bencher, &Scene::demo(), picture, threads);
}

#[divan::bench(args = Level::available().into_iter().map(|level| level.name), sample_count = 20)]
fn demo_1024_lanes(bencher: Bencher, name: &str) {
    let picture = RenderRequest {
        level: Level::named(name),
        ..RenderRequest::sized(1024, 1024)
    };
    trace(bencher, &Scene::demo(), picture, 2);
}

/// Clean edges: adaptive, and by the plain grid that takes about as many rays per edge pixel.
#[divan::bench(args = ["adaptive", "grid 4"], sample_count = 20)]
fn demo_1024_antialias(bencher: Bencher, sampling: &str) {
    let picture = RenderRequest {
        sampling: match sampling {
            "adaptive" => Sampling::ADAPTIVE,
            _ => Sampling::Grid(4),
        },
        ..RenderRequest::sized(1024, 1024)
    };
    trace(bencher, &Scene::demo(), picture, 2);
}

#[divan::bench(sample_count = 20)]
fn demo_3840_2160(bencher: Bencher) {
    trace(bencher, &Scene::demo(), RenderRequest::sized(3840, 2160), 2);
}

#[divan::bench(args = [10, 100, 1000, 10_000], sample_count = 10)]
fn spheres_512(bencher: Bencher, count: u32) {
    let mut scene = Scene::demo();
    let side = f64::from(count).sqrt().ceil();
    for n in 0..count {
        let (column, row) = (f64::from(n) % side, (f64::from(n) / side).floor());
        let place = |at: f64| 400.0 * (at + 0.5) / side;
        let center = DVec3::new(place(column) - 25.0, 80.0 / side, 50.0 - place(row));
        scene.objects.push(Object::new(
            format!("Ball {n}"),
            "sphere 1",
            Sphere {
                center,
                radius: 80.0 / side,
            },
        ));
    }
    trace(bencher, &scene, RenderRequest::sized(512, 512), 2);
}
