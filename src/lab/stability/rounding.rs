//! Pictures in single precision: counts pixels in which rounding decides what is visible, at edges, in shadows, and
//! increasingly in mirrors that are seen in mirrors.

use glam::DVec3;

use super::map::{Axis, Map, Tries};
use super::stage::light;
use super::subject::MapSubject;
use crate::mesh::SOLIDS;
use crate::plan::RenderRequest;
use crate::scene::{
    Camera, ColorPack, Light, List, Mesh, Method as _, Object, Plane, Precision, Sampling, Scene,
    Shape, Sphere,
};

/// Side of the pictures in pixels.
const SIDE: u32 = 128;
/// Solids along each side of the floor.
const ROW: usize = 5;
/// Allowed difference of a channel: one level of 8 bits.
const LEVEL_STEP: f32 = 1.0 / 255.0;

/// One map for plain single precision, and one for the plan's way of using it.
pub fn maps() -> Vec<Map> {
    let map = |precision: Precision| {
        Map::measure(
            (
                MapSubject::Rounding,
                "pixel that differs from double precision",
            ),
            (precision.id(), precision == Precision::default()),
            (bounces(), distances()),
            |bounces, away| {
                let scene = scene(bounces as u32, away);
                let [exact, other] = [Precision::Double, precision].map(|precision| {
                    let request = RenderRequest {
                        precision,
                        sampling: Sampling::Centres,
                        ..RenderRequest::sized(SIDE, SIDE)
                    };
                    light(&scene, &request)
                });
                let pixels = exact.iter().zip(&other);
                Tries::count(pixels.map(|(exact, other)| differ(*exact, *other)))
            },
        )
    };
    vec![map(Precision::default()), map(Precision::Single)]
}

fn bounces() -> Axis {
    Axis::new("bounces", &[0.0, 1.0, 2.0, 3.0, 4.0])
}

fn distances() -> Axis {
    Axis::new("sizes away", &[3.0, 30.0, 300.0, 3000.0])
}

/// Compares colours as 8 bits show them: anything brighter than white is white.
fn differ(one: [f32; 3], other: [f32; 3]) -> bool {
    let channels = one.into_iter().zip(other);
    let mut gaps = channels.map(|(one, other)| (one.min(1.0) - other.min(1.0)).abs());
    gaps.any(|gap| gap > LEVEL_STEP)
}

/// Flat and round mirrors over a floor that reflect each other, seen from `away` sizes through a lens that keeps them
/// equally large.
fn scene(bounces: u32, away: f64) -> Scene {
    let mut scene = Scene::empty();
    let pack = ColorPack {
        ambient: DVec3::new(30.0, 60.0, 90.0),
        diffuse: DVec3::new(120.0, 90.0, 60.0),
        specular: DVec3::splat(200.0),
        phong_exponent: 30.0,
        reflective: true,
    };
    scene.packs_mut().insert("mirror".to_owned(), pack);
    scene.render.reflection_limit = bounces;
    scene.lights = List::from(vec![Light {
        position: DVec3::new(3.1, 7.3, 4.7),
        intensity: 0.8,
        name: "Lamp".to_owned(),
        marker: None,
        visible: true,
    }]);
    let mut objects = vec![Object::new(
        "Floor",
        "mirror",
        Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        },
    )];
    for cell in 0..ROW * ROW {
        let along = |number: usize| (number as f64 / (ROW - 1) as f64 - 0.5) * 2.3;
        let middle = DVec3::new(along(cell % ROW), 0.29, along(cell / ROW));
        let name = format!("Solid {cell}");
        // A ball, or a solid with its own rotation.
        let shape: Shape = match SOLIDS.get(cell % (SOLIDS.len() + 1)) {
            None => Sphere {
                center: middle,
                radius: 0.25,
            }
            .into(),
            Some(solid) => Mesh {
                position: middle,
                rotation: DVec3::new(11.0, 23.0, 37.0) * (cell + 1) as f64,
                ..Mesh::of((solid.make)(0.4))
            }
            .into(),
        };
        objects.push(Object::new(name, "mirror", shape));
    }
    scene.objects = List::from(objects);
    let view = DVec3::new(0.41, 0.37, 0.83).normalize();
    scene.camera = Camera {
        position: view * away,
        look_at: DVec3::new(0.0, 0.4, 0.0) - view * away,
        projection_distance: away / 3.0,
        ..Camera::default()
    };
    scene
}
