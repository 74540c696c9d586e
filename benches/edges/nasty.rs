//! Scenes whose edges are hard to find, or whose error is hard to bound.

use std::f64::consts::TAU;
use std::path::Path;

use glam::DVec3;
use glint::mesh::Triangles;
use glint::scene::{Document, Light, Mesh, Object, Scene, Shape, Sphere, Triangle};

/// All scenes, by name.
pub fn scenes() -> Vec<(&'static str, Scene)> {
    vec![
        ("demo", Scene::demo()),
        ("mirrors", published("mirrors")),
        ("sunflower", published("sunflower")),
        ("discs", published("discs")),
        ("knot", published("knot")),
        ("bumpy mesh, 10,000", bumpy(50, 100)),
        ("bumpy mesh, 100,000", bumpy(160, 312)),
        ("5,000 small balls", balls(5_000, false)),
        ("2,000 mirror balls", balls(2_000, true)),
        ("64 lights", lights()),
        ("poles and ribbons", poles()),
        ("bicycle wheel", wheel()),
    ]
}

fn published(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.ron"));
    Document::load(&path).expect("a scene").scene
}

/// Only the floor and the lights of the demo, seen up to the horizon.
fn floor() -> Scene {
    let mut scene = Scene::demo();
    scene.objects.retain(|object| object.name == "Plane");
    scene.camera.position = DVec3::new(0.0, 70.0, 170.0);
    scene.camera.look_at = DVec3::new(0.0, -0.25, -1.0);
    scene
}

/// A number from 0 to 1 for each index and axis, from a sequence that generalises multiples of the golden ratio
/// (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
fn spread(index: u32, axis: i32) -> f64 {
    (f64::from(index) * 1.220_744_084_605_759_5_f64.powi(-axis)).fract()
}

fn balls(count: u32, are_mirrors: bool) -> Scene {
    let mut scene = floor();
    let pack = "sphere 1";
    scene.packs_mut()[pack].reflective |= are_mirrors;
    for index in 1..=count {
        let at = [1, 2, 3].map(|axis| spread(index, axis) - 0.5);
        scene.objects.push(Object::new(
            format!("Ball {index}"),
            pack,
            Sphere {
                center: DVec3::from(at) * DVec3::new(160.0, 100.0, 160.0) + DVec3::Y * 55.0,
                radius: 0.6,
            },
        ));
    }
    scene
}

/// A ball with bumps, of `down` by `around` quads.
fn bumpy(down: u32, around: u32) -> Scene {
    let mut scene = floor();
    let place = |index: u32| {
        let turn = f64::from(index % around) / f64::from(around) * TAU;
        let tilt = f64::from(index / around) / f64::from(down) * TAU / 2.0;
        let radius = 50.0 * (1.0 + 0.08 * (9.0 * turn).sin() * (11.0 * tilt).cos());
        let (sine, cosine) = tilt.sin_cos();
        DVec3::new(sine * turn.cos(), cosine, sine * turn.sin()) * radius
    };
    let quad = |index: u32| {
        let (row, column) = (index / around, index % around);
        let number = |row: u32, column: u32| row * around + column % around;
        let [a, b] = [number(row, column), number(row, column + 1)];
        let [c, d] = [number(row + 1, column + 1), number(row + 1, column)];
        [[a, b, c], [a, c, d]]
    };
    let points = (0..(down + 1) * around).map(place).collect();
    let faces = (0..down * around).flat_map(quad).collect();
    let mesh = Mesh {
        position: DVec3::Y * 55.0,
        ..Mesh::of(Triangles::new(points, faces).expect("a ball"))
    };
    scene.objects.push(Object::new("Ball", "sphere 1", mesh));
    scene
}

fn lights() -> Scene {
    let mut scene = Scene::demo();
    let like = scene.lights[0].clone();
    scene.lights = (0..64)
        .map(|index| {
            let (sine, cosine) = (f64::from(index) / 64.0 * TAU).sin_cos();
            Light {
                name: format!("Light {index}"),
                position: DVec3::new(125.0, 0.0, -100.0) + DVec3::new(cosine, 0.8, sine) * 300.0,
                intensity: 1.0 / 64.0,
                marker: None,
                ..like.clone()
            }
        })
        .collect();
    scene
}

/// Adds a flat strip as two triangles.
fn add_strip(scene: &mut Scene, name: &str, (foot, top): (DVec3, DVec3), wide: DVec3) {
    for (half, (a, b, c)) in [(foot, top, foot + wide), (foot + wide, top, top + wide)]
        .into_iter()
        .enumerate()
    {
        let shape = Shape::Triangle(Triangle { a, b, c });
        scene
            .objects
            .push(Object::new(format!("{name} {half}"), "sphere 1", shape));
    }
}

fn poles() -> Scene {
    let mut scene = floor();
    for index in 0..60_u32 {
        let at = DVec3::new(spread(index, 1) - 0.5, 0.0, spread(index, 2) - 0.5) * 160.0;
        let lean = DVec3::new(8.0 * spread(index, 3), 60.0, 0.0);
        let wide = DVec3::X * 0.05 * f64::from(1 + index % 8);
        add_strip(&mut scene, &format!("Pole {index}"), (at, at + lean), wide);
    }
    scene
}

fn wheel() -> Scene {
    let mut scene = floor();
    let hub = DVec3::new(0.0, 62.0, 40.0);
    let at = |turn: f64, radius: f64| {
        let (sine, cosine) = (turn * TAU).sin_cos();
        hub + DVec3::new(cosine, sine, 0.0) * radius
    };
    for index in 0..36 {
        let turn = f64::from(index) / 36.0;
        let spoke = (at(turn, 4.0), at(turn + 0.03, 60.0));
        let across = at(turn + 0.25, 0.12) - hub;
        add_strip(&mut scene, &format!("Spoke {index}"), spoke, across);
    }
    for index in 0..120 {
        let turn = f64::from(index) / 120.0;
        let rim = (at(turn, 60.0), at(turn + 1.0 / 120.0, 60.0));
        let across = at(turn, 0.5) - hub;
        add_strip(&mut scene, &format!("Rim {index}"), rim, across);
    }
    scene
}
