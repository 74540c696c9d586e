//! Coincident surfaces: a triangle in a slanting plane, and two identical balls. The earlier one in the list must be
//! visible everywhere.

use glam::DVec3;

use super::map::{Map, Tries, offset_axis, placed, scale_axis};
use super::stage::light;
use super::subject::MapSubject;
use crate::plan::RenderRequest;
use crate::scene::{
    Camera, ColorPack, List, Object, Plane, Precision, Sampling, Scene, Sphere, Triangle,
};

/// Side of the pictures in pixels.
const SIDE: u32 = 48;

/// The map of the only rule, for pictures at every scale and place.
pub fn map() -> Map {
    let seen = |away, scale, later| levels(&scene(away, scale, later));
    Map::measure(
        (MapSubject::Coincident, "pixel that shows the later surface"),
        ("earlier first".to_owned(), true),
        (offset_axis(), scale_axis()),
        |away, scale| {
            let (alone, both) = (seen(away, scale, false), seen(away, scale, true));
            // The later surface is green. Pixels that show nothing are not tried.
            let hits = alone.iter().zip(&both).filter(|(alone, _)| alone[0] > 0.5);
            Tries::count(hits.map(|(_, both)| both[1] > 0.0))
        },
    )
}

fn levels(scene: &Scene) -> Vec<[f32; 3]> {
    let request = RenderRequest {
        precision: Precision::Single,
        sampling: Sampling::Centres,
        ..RenderRequest::sized(SIDE, SIDE)
    };
    light(scene, &request)
}

/// Red surfaces, and if `with_later`, green ones in the same places; scaled by `scale`, and `away` sizes from the
/// origin.
fn scene(away: f64, scale: f64, with_later: bool) -> Scene {
    let to_world = |v: DVec3| placed(v, away, scale);
    let mut scene = Scene::empty();
    (scene.background, scene.ambient_intensity) = (DVec3::ZERO, 1.0);
    scene.lights = List::default();
    for (name, color) in [("red", DVec3::X), ("green", DVec3::Y)] {
        let pack = ColorPack {
            ambient: color * 255.0,
            ..ColorPack::default()
        };
        scene.packs_mut().insert(name.to_owned(), pack);
    }
    let normal = DVec3::new(0.13, 1.0, 0.29).normalize();
    let in_plane = |x: f64, z: f64| {
        let y = -(normal.x * x + normal.z * z) / normal.y;
        to_world(DVec3::new(x, y, z))
    };
    let ball = Sphere {
        center: to_world(DVec3::new(0.3, 0.6, 0.1)),
        radius: 0.4 * scale,
    };
    let plane = Plane {
        point: to_world(DVec3::ZERO),
        normal,
    };
    let triangle = Triangle {
        a: in_plane(-1.0, -1.0),
        b: in_plane(-0.9, 0.8),
        c: in_plane(0.9, 0.7),
    };
    let earlier = [
        Object::new("Plane", "red", plane),
        Object::new("Ball", "red", ball),
    ];
    let later = [
        Object::new("Triangle", "green", triangle),
        Object::new("Same ball", "green", ball),
    ];
    let later = later.into_iter().filter(|_| with_later);
    scene.objects = List::from(earlier.into_iter().chain(later).collect::<Vec<_>>());
    scene.camera = Camera {
        position: to_world(DVec3::new(0.4, 1.3, 2.6)),
        look_at: DVec3::new(0.0, -0.4, -1.0),
        projection_distance: 1.0,
        ..Camera::default()
    };
    scene
}
