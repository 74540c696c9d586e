//! Exported frames that are wrongly taken for unchanged: one key of the camera is moved by various distances, and
//! every frame whose picture changes must get another fingerprint.

use std::sync::Arc;

use glam::DVec3;

use super::map::{Axis, Map, Tries, scattered};
use super::subject::MapSubject;
use crate::animate::shot_of_frame;
use crate::export::fingerprint;
use crate::image::{Format, Image, render};
use crate::plan::RenderRequest;
use crate::scene::{Animation, Camera, Key, Scene};
use crate::trace::RenderControl;

/// Distances by which the key moves, in units of a scene whose size is some hundred of them.
const MOVES: [f64; 7] = [1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0];
/// Moved keys per cell for a first look.
const TRIES: u64 = 3;
/// Frames that are compared for each.
const FRAMES: [u64; 4] = [1, 4, 8, 11];
/// Size of their pictures in pixels.
const SIZE: (u32, u32) = (32, 24);

/// The map of the only rule.
pub fn map(effort: u32) -> Map {
    let across = Axis::new("units moved", &MOVES);
    Map::measure(
        (
            MapSubject::Fingerprint,
            "changed frame that is not traced again",
        ),
        ("all that decides it".to_owned(), true),
        (across, Axis::one("")),
        |distance, _| {
            // Each takes eight pictures, so their number grows with the square root of the effort only.
            let tries = TRIES * u64::from(effort.isqrt());
            let moved = (0..tries).flat_map(|number| changed(number, distance));
            Tries::count(moved)
        },
    )
}

/// For each frame whose picture has changed, whether its fingerprint is unchanged.
fn changed(number: u64, distance: f64) -> Vec<bool> {
    let random = |stream| scattered(number, stream) - 0.5;
    let step = DVec3::new(random(0), random(1), random(2)).normalize_or(DVec3::X) * distance;
    let (before, after) = (flight(DVec3::ZERO), flight(step));
    let frames = FRAMES.iter().filter_map(|frame| {
        let (one, other) = (
            shot_of_frame(&before, *frame),
            shot_of_frame(&after, *frame),
        );
        let is_changed = picture(&one) != picture(&other);
        let fingerprint_of = |scene| fingerprint(scene, Format::Png).ok();
        is_changed.then(|| fingerprint_of(&one) == fingerprint_of(&other))
    });
    frames.collect()
}

/// The demo with a flight of three keys; the middle one is displaced by `step`.
fn flight(step: DVec3) -> Arc<Scene> {
    let scene = Scene::demo();
    let at = |time: f64, offset: DVec3| {
        let position = scene.camera.position + offset;
        Key::new(
            time,
            Camera {
                position,
                ..scene.camera.clone()
            },
        )
    };
    let keys = vec![
        at(0.0, DVec3::ZERO),
        at(0.5, DVec3::new(30.0, 20.0, -10.0) + step),
        at(1.0, DVec3::new(60.0, 0.0, -40.0)),
    ];
    Arc::new(Scene {
        animation: Arc::new(Animation {
            frames_per_second: 12.0,
            keys,
            ..Animation::default()
        }),
        ..scene
    })
}

fn picture(scene: &Scene) -> Option<Image> {
    let request = RenderRequest::of(scene, SIZE.0, SIZE.1);
    let traced = render(scene, &request, &RenderControl::default());
    traced.map(|(image, _)| image)
}
