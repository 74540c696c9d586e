//! Hints about valid but probably unintended properties of a scene.

use glam::DVec3;

use super::camera::{Camera, Projection};
use super::coincidence::{Coincidence, Overlap, coincidences};
use super::frame::CoordinateFrame;
use super::shape::{Outline, Shape};
use super::whole::Scene;

/// Largest number of pairs of an object and a light that are examined.
const MAX_LIGHT_PAIRS: usize = 20_000;

/// Tolerance within which a light counts as on a surface, as a share of the relevant distances.
const ON_SURFACE: f64 = 1e-9;
/// Height of the eye above a plane, as a share of the scene's extent, below which the plane is seen edge-on. In
/// orthographic projection, the same limit applies to the cosine between view direction and normal.
const EDGE_ON: f64 = 1e-6;

/// A probably unintended property of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Hint {
    /// Description, as a sentence.
    pub words: String,
    /// The affected part of the scene.
    pub about: About,
    /// Whether the object is a duplicate of another one, so that one of them can be hidden.
    pub is_duplicate: bool,
}

/// The part of the scene that a hint is about; lists are indexed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// The camera.
    Camera,
    /// The ambient light.
    World,
    /// A light.
    Light(usize),
    /// An object.
    Object(usize),
    /// A color pack.
    Pack(usize),
}

impl Hint {
    fn new(words: String, about: About) -> Self {
        Self {
            words,
            about,
            is_duplicate: false,
        }
    }
}

/// Returns all hints about a scene.
pub fn hints(scene: &Scene) -> Vec<Hint> {
    let mut hints = camera_hints(scene);
    hints.extend(scene_hints(scene));
    hints
}

/// Returns the hints about the position of the camera.
pub fn camera_hints(scene: &Scene) -> Vec<Hint> {
    let mut hints = Vec::new();
    let extent = CoordinateFrame::of(scene).map_or(1.0, |frame| 2.0 * frame.extent);
    let eye = scene.camera.position;
    for (index, object) in scene.objects.visible() {
        let name = &object.name;
        if is_inside(&object.shape, eye) {
            let words = format!("The camera is inside {name}");
            hints.push(Hint::new(words, About::Camera));
        }
        if is_edge_on(&object.shape, &scene.camera, extent) {
            let words = format!("{name} is seen edge-on: the camera is in its plane");
            hints.push(Hint::new(words, About::Object(index)));
        }
    }
    hints
}

/// Returns all other hints, which do not depend on the camera.
pub fn scene_hints(scene: &Scene) -> Vec<Hint> {
    let mut hints = Vec::new();
    let is_small = scene.objects.len() * scene.lights.len() <= MAX_LIGHT_PAIRS;
    for (index, light) in scene.lights.iter().enumerate().filter(|_| is_small) {
        let is_shining = light.visible && light.intensity > 0.0;
        for (_, object) in scene.objects.visible().filter(|_| is_shining) {
            let name = &object.name;
            if is_on(&object.shape, light.position) {
                let words = format!("{} is on the surface of {name}", light.name);
                hints.push(Hint::new(words, About::Light(index)));
            } else if is_inside(&object.shape, light.position) {
                let words = format!("{} is inside {name}, which blocks its light", light.name);
                hints.push(Hint::new(words, About::Light(index)));
            }
        }
    }
    let used_packs = scene.used_packs();
    // In an empty scene, the first object added will use a color pack.
    let packs = scene.color_packs.iter().enumerate();
    for (index, (name, _)) in packs.filter(|_| !scene.objects.is_empty()) {
        if !used_packs.contains(name.as_str()) {
            let words = format!("No object uses {name}");
            hints.push(Hint::new(words, About::Pack(index)));
        }
    }
    let centre = CoordinateFrame::of(scene).map_or(DVec3::ZERO, |frame| frame.centre);
    add_coincident(scene, centre, &mut hints);
    hints
}

/// Adds hints about visible objects that share a surface. Coordinates are taken relative to `centre`.
fn add_coincident(scene: &Scene, centre: DVec3, hints: &mut Vec<Hint>) {
    let mut last = None;
    for found in coincidences(&scene.objects, centre) {
        let Coincidence {
            later,
            earlier,
            extent,
        } = found;
        let looks_alike = scene.look_alike(later, earlier);
        if extent.is_hidden() || (extent == Overlap::Faces && looks_alike) {
            continue; // Which of them is in front makes no visible difference.
        }
        if last.replace(later) == Some(later) {
            continue; // There is a hint about this object already.
        }
        let (object, other) = (&scene.objects[later], &scene.objects[earlier]);
        let is_duplicate = object.shape == other.shape || both_endless(&object.shape, &other.shape);
        let (name, other) = (&object.name, &other.name);
        let words = if is_duplicate {
            format!("{name} is in the same place as {other}")
        } else if extent == Overlap::Faces {
            format!("{name} shares faces with {other}, which comes first and is shown there")
        } else {
            format!("{name} lies in the surface of {other}, which comes first and is shown there")
        };
        hints.push(Hint {
            is_duplicate,
            ..Hint::new(words, About::Object(later))
        });
    }
}

fn both_endless(one: &Shape, other: &Shape) -> bool {
    one.bounds().is_none() && other.bounds().is_none()
}

fn is_inside(shape: &Shape, point: DVec3) -> bool {
    match shape {
        Shape::Sphere(ball) => ball.center.distance(point) < ball.radius * (1.0 - ON_SURFACE),
        _ => false,
    }
}

fn is_on(shape: &Shape, point: DVec3) -> bool {
    if let Shape::Sphere(ball) = shape {
        let distance = (ball.center.distance(point) - ball.radius).abs();
        return distance <= ON_SURFACE * (ball.radius + point.length());
    }
    let Some(piece) = shape.plane_piece() else {
        return false;
    };
    let height = (point - piece.point).dot(piece.normal).abs();
    let is_on_plane = height <= ON_SURFACE * (point.length() + piece.point.length());
    let is_within = || match piece.outline {
        Outline::Endless => true,
        Outline::Disc(radius) => piece.point.distance(point) <= radius,
        Outline::Triangle([a, b, c]) => {
            let side = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(piece.normal);
            [side(a, b), side(b, c), side(c, a)]
                .iter()
                .all(|side| *side >= 0.0)
        }
    };
    is_on_plane && is_within()
}

fn is_edge_on(shape: &Shape, camera: &Camera, extent: f64) -> bool {
    let Some(plane) = shape.endless_plane() else {
        return false;
    };
    match camera.projection {
        Projection::Perspective => plane.height(camera.position).abs() < EDGE_ON * extent,
        Projection::Orthographic => {
            let direction = camera.forward();
            direction.dot(plane.normal).abs() < EDGE_ON
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(scene: &Scene) -> Vec<String> {
        hints(scene).into_iter().map(|hint| hint.words).collect()
    }

    #[test]
    fn a_scene_of_nothing_has_nothing_to_mend() {
        assert_eq!(hints(&Scene::empty()), []);
    }

    #[test]
    fn nothing_is_said_of_the_demo() {
        assert_eq!(words(&Scene::demo()), Vec::<String>::new());
    }

    #[test]
    fn what_is_probably_not_meant_is_said() {
        let demo = Scene::demo();
        let mut scene = demo.clone();
        scene.camera.position = scene.objects[0].shape.position();
        scene.lights[0].position = scene.objects[1].shape.position();
        scene.lights[1].position = DVec3::new(3.0, 0.0, 4.0);
        scene
            .packs_mut()
            .insert("idle".to_owned(), crate::scene::ColorPack::default());
        let mut copy = scene.objects[8].clone();
        "Plane 2".clone_into(&mut copy.name);
        copy.shape = copy.shape.moved(DVec3::X);
        scene.objects.push(copy);
        assert_eq!(
            words(&scene),
            [
                "The camera is inside Sphere 1",
                "Light 1 is inside Sphere 2, which blocks its light",
                "Light 2 is on the surface of Plane",
                "Light 2 is on the surface of Plane 2",
                "No object uses idle",
                "Plane 2 is in the same place as Plane",
            ]
        );
        let mut twin = demo.clone();
        let mut copy = twin.objects[8].clone();
        "Plane 2".clone_into(&mut copy.name);
        let Shape::Plane(plane) = &mut copy.shape else {
            panic!("a plane");
        };
        plane.normal = -plane.normal;
        twin.objects.push(copy);
        assert_eq!(words(&twin), ["Plane 2 is in the same place as Plane"]);
        let mut edge = demo;
        edge.camera.position.y = 0.0;
        assert_eq!(
            words(&edge),
            ["Plane is seen edge-on: the camera is in its plane"]
        );
    }

    #[test]
    fn normals_may_be_of_any_length() {
        let mut scene = Scene::demo();
        let Shape::Plane(plane) = &mut scene.objects[8].shape else {
            panic!("a plane");
        };
        plane.normal *= 1e-200;
        assert_eq!(words(&scene), Vec::<String>::new());
    }
}
