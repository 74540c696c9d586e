use std::sync::LazyLock;
use std::sync::atomic::Ordering;

use glam::DVec3;

use super::*;
use crate::mesh::SOLIDS;
use crate::scene::{Accelerator, Mesh, Object, Shape};
use crate::simd::Real;

impl Pixel for [u64; 3] {
    fn of<R: Real>(red: R, green: R, blue: R) -> Self {
        [red, green, blue].map(|channel| channel.to_f64().to_bits())
    }
}

/// Traces all of a picture.
fn picture(tracer: &Tracer) -> (Vec<[u64; 3]>, Option<Rays>) {
    let mut pixels = vec![[0_u64; 3]; tracer.width() * tracer.height()];
    let rays = tracer.pass(&mut pixels, Pass::Whole, &RenderControl::default());
    (pixels, rays)
}

#[test]
fn tiles_of_any_size_give_the_same_bits() {
    let mut scene = Scene::demo();
    scene.render.reflection_limit = 3;
    for sampling in [Sampling::Centres, Sampling::Grid(2), Sampling::ADAPTIVE] {
        let pictures = [16, 8, 5, 32, 200].map(|tile| {
            let request = RenderRequest {
                sampling,
                ..RenderRequest::sized(171, 93)
            };
            let tracer = Tracer {
                tile,
                ..Tracer::new(&scene, &request)
            };
            let (pixels, rays) = picture(&tracer);
            assert!(rays.is_some());
            pixels
        });
        for other in &pictures[1..] {
            assert!(*other == pictures[0], "{sampling:?}");
        }
    }
}

#[test]
fn many_threads_share_the_tiles_of_a_row() {
    let scene = Scene::demo();
    for (sampling, tiles) in [(Sampling::Centres, 66), (Sampling::ADAPTIVE, 84)] {
        let request = RenderRequest {
            sampling,
            ..RenderRequest::sized(171, 93)
        };
        let tracer = Tracer::new(&scene, &request);
        let pictures = [1, 24].map(|threads| {
            let threads = Threads::new(Some(threads)).expect("threads");
            threads.run(|| picture(&tracer).0)
        });
        assert!(pictures[0] == pictures[1], "{sampling:?}");
        assert_eq!(tracer.pieces(24).count(), tiles, "every tile");
        let large = Tracer::new(&scene, &RenderRequest::sized(1024, 1024));
        assert_eq!(large.pieces(1).count(), 128, "quarters of rows");
        let pixels = tracer
            .pieces(24)
            .map(|piece| piece.width() * piece.rows.len());
        assert_eq!(pixels.sum::<usize>(), 171 * 93);
        assert_eq!(tracer.time_pieces(24).len(), tiles);
    }
}

#[test]
fn packets_in_squares_give_the_same_bits() {
    let scene = Scene::demo();
    for (sampling, tile) in [(Sampling::Centres, 16), (Sampling::Grid(2), 13)] {
        let pictures = [false, true].map(|in_squares| {
            let request = RenderRequest {
                sampling,
                accelerator: Accelerator::Bvh,
                ..RenderRequest::sized(83, 61)
            };
            picture(&Tracer {
                tile,
                in_squares,
                ..Tracer::new(&scene, &request)
            })
        });
        assert!(pictures[0] == pictures[1], "{sampling:?}");
    }
}

/// The number of boxes.
const BOXES: u32 = 81;

/// Returns a scene of boxes seen from above, each turned differently: pixels send messages, to other tiles and
/// strips as well, about corners that end in them.
fn boxes(turn: f64) -> Scene {
    let solid = SOLIDS.iter().find(|solid| solid.name == "Box");
    let solid = Mesh::of((solid.expect("there is").make)(0.75));
    let mut scene = Scene::demo();
    let object = scene.objects[0].clone();
    scene.camera.position = DVec3::new(0.0, 10.0, 0.1);
    scene.camera.look_at = DVec3::NEG_Y;
    let boxes = (0..BOXES).map(|index| {
        let (along, down) = (f64::from(index % 9) - 4.0, f64::from(index / 9) - 4.0);
        let mesh = Mesh {
            // Wider than what counts as thin, and with corners that end in pixels.
            position: DVec3::new(along * 1.1 + down * 0.03, 0.0, down * 1.1),
            rotation: DVec3::new(0.0, turn * f64::from(index), 0.0),
            ..solid.clone()
        };
        Object {
            name: format!("Box {index}"),
            shape: Shape::Mesh(mesh),
            ..object.clone()
        }
    });
    scene.objects = boxes.collect();
    scene
}

#[test]
fn a_picture_in_strips_has_the_same_bits() {
    let boxes = (1..24).map(|turn| (boxes(f64::from(turn)), Sampling::ADAPTIVE));
    let demos = [Sampling::Grid(2), Sampling::ADAPTIVE].map(|sampling| (Scene::demo(), sampling));
    let mut matters = 0;
    for (scene, sampling) in demos.into_iter().chain(boxes) {
        let request = RenderRequest {
            sampling,
            ..RenderRequest::sized(83, 61)
        };
        let control = RenderControl::default();
        let tracer = Tracer {
            strip_rows: 3,
            ..Tracer::new(&scene, &request)
        };
        let (whole, rays) = picture(&tracer);
        let mut strips = Vec::new();
        let mut sum = Rays::default();
        for first in (0..61).step_by(tracer.strip()) {
            let mut strip = vec![[0_u64; 3]; 83 * (61 - first).min(3)];
            sum += tracer
                .rows(&mut strip, first, &control)
                .expect("not stopped");
            strips.extend(strip);
        }
        assert!(strips == whole, "{sampling:?}");
        assert_eq!(Some(sum), rays);
        if scene.objects.len() == BOXES as usize {
            let (other, _) = picture(&Tracer::new(&scene, &request));
            matters += usize::from(other != whole);
        }
    }
    assert!(matters > 0, "in some it matters that strips tell nothing");
}

#[test]
fn a_large_picture_is_no_more_than_a_strip_in_memory() {
    for (width, height) in [(16_384, 16_384), (16_384, 1), (1, 16_384), (2048, 2048)] {
        let tracer = Tracer::new(&Scene::demo(), &RenderRequest::sized(width, height));
        let strip = tracer.strip();
        assert!(strip * width as usize <= MAX_STRIP_PIXELS.max(EXR_SQUARE * width as usize));
        let is_whole = strip >= height as usize;
        assert!(is_whole || strip.is_multiple_of(EXR_SQUARE), "{strip}");
        assert_eq!(is_whole, width < 16_384 || height == 1);
    }
}

/// Stopped by the first pixel that is written.
static FIRST: LazyLock<RenderControl> = LazyLock::new(RenderControl::default);

#[derive(Clone, Copy)]
struct Stopping;

impl Pixel for Stopping {
    fn of<R: Real>(_: R, _: R, _: R) -> Self {
        FIRST.stop();
        Self
    }
}

#[test]
fn a_stopped_pass_writes_no_tile_that_was_being_traced() {
    let (scene, side) = (Scene::demo(), 2048);
    let tracer = Tracer::new(&scene, &RenderRequest::sized(side, side));
    let mut pixels = vec![Stopping; (side * side) as usize];
    let threads = Threads::new(Some(3)).expect("threads");
    let rays = threads.run(|| tracer.pass(&mut pixels, Pass::Whole, &FIRST));
    assert_eq!(rays, None);
    let traced = FIRST.pixels.load(Ordering::Relaxed);
    // The tile that caused the stop, and those that the other threads were writing meanwhile.
    let most = (3 * tracer.tile * tracer.tile) as u64;
    assert!(
        traced <= most,
        "{traced} pixels after the stop, {most} at most"
    );
}
