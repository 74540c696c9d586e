//! Scenes shared by several tests: random ones with fixed seeds, limited to what both Glint and POV-Ray can
//! represent, and the published views.

use glam::DVec3;
use glint::lab::stability::{GOLDEN, mixed, share};
use glint::scene::{
    Camera, ColorPack, Disc, Document, Light, LightObj, Object, Plane, Projection, Render, Scene,
    Shape, Sphere, Triangle, check,
};

use crate::program::FLIGHT;

/// Random numbers that are the same on every machine.
pub struct Dice(pub u64);

impl Dice {
    pub fn real(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        low + (high - low) * share(mixed(self.0))
    }

    fn vector(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(
            self.real(low, high),
            self.real(low, high),
            self.real(low, high),
        )
    }

    fn chance(&mut self, share: f64) -> bool {
        self.real(0.0, 1.0) < share
    }
}

/// A scene of spheres, triangles and a plane, some of them mirrors, under one to three lights, in either
/// projection. Highlights are grey and nothing is brighter than white, because POV-Ray has no coloured highlights
/// and does not clamp per bounce.
pub fn scene(seed: u64) -> Scene {
    let dice = &mut Dice(seed.wrapping_mul(7919) + 1);
    let mut scene = Scene::empty();
    scene.packs_mut().clear();
    scene.ambient_intensity = dice.real(0.2, 0.6);
    scene.background = dice.vector(0.0, 120.0);
    scene.light_visualization = dice.chance(0.7);
    scene.render = Render {
        width: 256,
        height: 192,
        reflection_limit: 1,
        ..Render::default()
    };
    scene
        .packs_mut()
        .insert("light".to_owned(), pack(dice, false));
    for number in 0..6 {
        let reflective = number < 2;
        scene
            .packs_mut()
            .insert(format!("pack {number}"), pack(dice, reflective));
    }
    add_objects(&mut scene, dice);
    scene.lights = (0..=(seed % 3)).map(|number| light(dice, number)).collect();
    scene.camera = camera(dice, seed);
    assert_eq!(check(&scene), Ok(()));
    scene
}

/// The demo from both camera positions that the original report publishes.
pub fn published() -> [Scene; 2] {
    let first = Scene::demo();
    let mut second = first.clone();
    second.camera.position = DVec3::new(172.0, 159.0, -27.0);
    second.camera.look_at = DVec3::new(-0.25, -0.70, -0.67);
    second.camera.up = DVec3::new(-0.25, 0.71, -0.65);
    [first, second]
}

/// A scene as a whole, scaled about the origin and then moved.
pub fn placed(mut scene: Scene, scale: f64, by: DVec3) -> Scene {
    for object in scene.objects.iter_mut() {
        object.shape = object.shape.scaled(DVec3::ZERO, scale).moved(by);
    }
    for light in scene.lights.iter_mut() {
        light.position = light.position * scale + by;
        if let Some(marker) = &mut light.marker {
            marker.radius *= scale;
        }
    }
    scene.camera.position = scene.camera.position * scale + by;
    scene.camera.orthographic_height *= scale;
    scene
}

/// The scene of the published flight.
pub fn flight() -> Scene {
    Document::load(FLIGHT.as_ref()).expect("a scene").scene
}

/// Triangles of arbitrary form over a floor that mirrors them and receives their shadows from two lights.
pub fn shards() -> Scene {
    let mut scene = Scene::demo();
    scene.objects.retain(|object| object.name == "Plane");
    let dice = &mut Dice(3);
    for n in 0..40 {
        let middle = DVec3::new(
            dice.real(-80.0, 80.0),
            dice.real(5.0, 105.0),
            dice.real(-80.0, 80.0),
        );
        let [a, b, c] = [(); 3].map(|()| middle + dice.vector(-12.0, 12.0));
        let shape = Triangle { a, b, c };
        let name = format!("Shard {n}");
        scene.objects.push(Object::new(name, "sphere 1", shape));
    }
    scene.camera.position = DVec3::new(0.0, 70.0, 170.0);
    scene.camera.look_at = DVec3::new(0.0, -0.25, -1.0);
    scene
}

/// The scene of this seed with discs added: some horizontal, some slanting, two of them mirrors.
pub fn with_discs(seed: u64) -> Scene {
    let mut scene = scene(seed);
    let dice = &mut Dice(seed.wrapping_mul(104_729) + 5);
    for number in 1..=6 {
        let lean = DVec3::new(dice.real(-1.0, 1.0), 1.0, dice.real(-1.0, 1.0));
        let disc = Disc {
            center: dice.vector(-60.0, 60.0),
            normal: if number < 3 { DVec3::Y } else { lean },
            radius: dice.real(6.0, 30.0),
        };
        scene.objects.push(Object::new(
            format!("Disc {number}"),
            format!("pack {}", number - 1),
            disc,
        ));
    }
    assert_eq!(check(&scene), Ok(()));
    scene
}

fn pack(dice: &mut Dice, reflective: bool) -> ColorPack {
    let diffuse = dice.vector(20.0, 200.0);
    let share = dice.vector(0.2, 1.0);
    ColorPack {
        diffuse,
        ambient: diffuse * share,
        specular: DVec3::splat(dice.real(0.0, 200.0)),
        phong_exponent: dice.real(2.0, 120.0).round(),
        reflective,
    }
}

fn add_objects(scene: &mut Scene, dice: &mut Dice) {
    let mut add = |shape: Shape, dice: &mut Dice| {
        let color_pack = format!("pack {}", (dice.real(0.0, 6.0)) as usize);
        let name = format!("Object {}", scene.objects.len() + 1);
        scene.objects.push(Object::new(name, color_pack, shape));
    };
    for _ in 0..8 {
        let center = dice.vector(-60.0, 60.0);
        add(
            Shape::Sphere(Sphere {
                center,
                radius: dice.real(4.0, 22.0),
            }),
            dice,
        );
    }
    for _ in 0..8 {
        let a = dice.vector(-70.0, 70.0);
        let (b, c) = (a + dice.vector(-40.0, 40.0), a + dice.vector(-40.0, 40.0));
        add(Shape::Triangle(Triangle { a, b, c }), dice);
    }
    let tilt = DVec3::new(dice.real(-0.2, 0.2), 1.0, dice.real(-0.2, 0.2));
    add(
        Shape::Plane(Plane {
            point: DVec3::new(0.0, -60.0, 0.0),
            normal: tilt,
        }),
        dice,
    );
}

fn light(dice: &mut Dice, number: u64) -> Light {
    Light {
        name: format!("Light {}", number + 1),
        position: DVec3::new(
            dice.real(-150.0, 150.0),
            dice.real(60.0, 200.0),
            dice.real(-50.0, 200.0),
        ),
        intensity: dice.real(0.05, 0.25),
        marker: Some(LightObj {
            radius: dice.real(2.0, 8.0),
            color_pack: "light".to_owned(),
        }),
        visible: true,
    }
}

fn camera(dice: &mut Dice, seed: u64) -> Camera {
    let position = DVec3::new(
        dice.real(-80.0, 80.0),
        dice.real(-20.0, 120.0),
        dice.real(120.0, 180.0),
    );
    let target = dice.vector(-20.0, 20.0);
    Camera {
        position,
        look_at: target - position,
        up: DVec3::new(dice.real(-0.3, 0.3), 1.0, 0.0),
        projection: if seed.is_multiple_of(2) {
            Projection::Perspective
        } else {
            Projection::Orthographic
        },
        projection_distance: dice.real(0.6, 1.8),
        orthographic_height: dice.real(100.0, 220.0),
    }
}
