//! Things thinner than a pixel: counts the pixels that miss bright ribbons in a dark picture.

use std::f64::consts::PI;

use glam::DVec3;

use super::map::{Axis, Map, Tries, scattered};
use super::stage::light;
use super::subject::MapSubject;
use crate::plan::RenderRequest;
use crate::scene::{Camera, ColorPack, List, Method as _, Object, Sampling, Scene, Triangle};

/// Side of the pictures in pixels.
const SIDE: u32 = 24;
/// Widths of the ribbons, in pixels.
const WIDTHS: [f64; 6] = [0.04, 0.1, 0.25, 0.5, 1.0, 2.0];
/// Distances of the ribbons from the camera.
const DISTANCES: [f64; 5] = [1.0, 10.0, 100.0, 1e3, 1e4];
/// The default sampling, and those that it is compared with.
const SAMPLINGS: [Sampling; 4] = [
    Sampling::ADAPTIVE,
    Sampling::Adaptive {
        contrast: 0.3,
        depth: 1,
    },
    Sampling::Grid(4),
    Sampling::Centres,
];
/// The sampling that tells what a pixel should show.
const REFERENCE: Sampling = Sampling::Grid(48);
/// Least brightness of a pixel that is tried: enough to be visible.
const MIN_BRIGHTNESS: f32 = 8.0 / 255.0;
/// Brightness below which a pixel shows nothing.
const MAX_DARK: f32 = 0.5 / 255.0;
/// Ribbons per cell for a first look.
const TRIES: u64 = 4;

/// One map per sampling.
pub fn maps(effort: u32) -> Vec<Map> {
    let mut maps: Vec<Map> = SAMPLINGS
        .iter()
        .map(|sampling| Map {
            subject: MapSubject::Thin,
            method: sampling.id(),
            is_default: *sampling == Sampling::default(),
            failure: "pixel that does not show it",
            across: Axis::new("pixels wide", &WIDTHS),
            up: Axis::new("away", &DISTANCES),
            cells: Vec::new(),
        })
        .collect();
    for (row, distance) in DISTANCES.into_iter().enumerate() {
        for (column, width) in WIDTHS.into_iter().enumerate() {
            let first = ((row * WIDTHS.len() + column) << 32) as u64;
            let cell = missed((first, effort), width, distance);
            for (map, tries) in maps.iter_mut().zip(cell) {
                map.cells.push(tries);
            }
        }
    }
    maps
}

/// For each sampling, counts the pixels that should show a ribbon, and as failures those that show nothing. `first`
/// is the number of the first ribbon.
fn missed((first, effort): (u64, u32), width: f64, distance: f64) -> [Tries; SAMPLINGS.len()] {
    let mut sums = [Tries::default(); SAMPLINGS.len()];
    // Each ribbon takes a picture of a million rays, so their number grows with the square root of the effort only.
    for number in first..first + TRIES * u64::from(effort.isqrt()) {
        let scene = ribbon(number, width, distance);
        let truth = brightness(&scene, REFERENCE);
        for (sum, sampling) in sums.iter_mut().zip(SAMPLINGS) {
            let shown = brightness(&scene, sampling);
            let tried = truth
                .iter()
                .zip(shown)
                .filter(|(truth, _)| **truth >= MIN_BRIGHTNESS);
            let tries = Tries::count(tried.map(|(_, shown)| shown < MAX_DARK));
            *sum = [*sum, tries].into_iter().sum();
        }
    }
    sums
}

fn brightness(scene: &Scene, sampling: Sampling) -> Vec<f32> {
    let request = RenderRequest {
        sampling,
        ..RenderRequest::sized(SIDE, SIDE)
    };
    light(scene, &request)
        .iter()
        .map(|pixel| pixel[0])
        .collect()
}

/// A ribbon at a random place and in a random direction, which ends inside the picture: two triangles.
fn ribbon(number: u64, width: f64, distance: f64) -> Scene {
    let random = |stream| scattered(number, stream);
    let pixel = distance / f64::from(SIDE);
    let (sine, cosine) = (random(0) * PI).sin_cos();
    let along = DVec3::new(cosine, sine, 0.0) * (distance * 0.4);
    let aside = DVec3::new(-sine, cosine, 0.0) * (width * pixel / 2.0);
    let middle = DVec3::new(random(1) - 0.5, random(2) - 0.5, 0.0) * (distance * 0.2);
    let middle = middle - DVec3::Z * distance;
    let [a, b, c, d] = [
        middle - along - aside,
        middle - along + aside,
        middle + along - aside,
        middle + along + aside,
    ];
    let mut scene = Scene::empty();
    (scene.background, scene.ambient_intensity) = (DVec3::ZERO, 1.0);
    scene.lights = List::default();
    let white = ColorPack {
        ambient: DVec3::splat(255.0),
        ..ColorPack::default()
    };
    scene.packs_mut().insert("white".to_owned(), white);
    let half = |name: &str, [a, b, c]: [DVec3; 3]| Object::new(name, "white", Triangle { a, b, c });
    scene.objects = List::from(vec![half("One", [a, b, c]), half("Other", [b, d, c])]);
    scene.camera = Camera {
        position: DVec3::ZERO,
        look_at: -DVec3::Z,
        projection_distance: 1.0,
        ..Camera::default()
    };
    scene
}
