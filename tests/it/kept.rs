//! What is cached from one picture to the next changes no picture; neither does the tree that most of the cache is
//! for.

use glam::DVec3;
use glint::image::{Image, render_into};
use glint::mesh::SOLIDS;
use glint::plan::{Planner, RenderRequest};
use glint::scene::{
    Accelerator, Camera, ColorPack, Light, Mesh, Object, Plane, Sampling, Scene, Shape, Sphere,
};
use glint::trace::RenderControl;

use crate::pictures::picture;
use crate::random::Dice;

/// Number of balls: enough for a tree, and with so few pixels each that hits are sorted.
const BALLS: usize = 600;

type Change = fn(&mut Scene, &mut Dice);

fn place(dice: &mut Dice) -> DVec3 {
    let mut coordinate = || dice.real(-40.0, 40.0);
    DVec3::new(coordinate(), coordinate() + 45.0, coordinate())
}

/// Balls with several color packs, a solid mesh and a floor, under two lights.
fn crowd(dice: &mut Dice) -> Scene {
    let mut scene = Scene::empty();
    scene.camera = Camera {
        position: DVec3::new(10.0, 70.0, 150.0),
        look_at: DVec3::new(0.0, -0.3, -1.0),
        up: DVec3::Y,
        ..scene.camera
    };
    for (name, exponent, color) in [("a", 16.0, 200.0), ("b", 3.5, 90.0), ("c", 900.0, 150.0)] {
        let pack = ColorPack {
            diffuse: DVec3::new(color, 255.0 - color, 120.0),
            phong_exponent: exponent,
            reflective: name == "b",
            ..ColorPack::default()
        };
        scene.packs_mut().insert(name.to_owned(), pack);
    }
    let mut add = |name: String, pack: &str, shape: Shape| {
        scene.objects.push(Object::new(name, pack, shape));
    };
    let solid = (SOLIDS[2].make)(30.0);
    add("Solid".to_owned(), "a", Shape::Mesh(Mesh::of(solid)));
    for ball in 0..BALLS {
        let shape = Shape::Sphere(Sphere {
            center: place(dice),
            radius: dice.real(0.5, 2.0),
        });
        add(format!("Ball {ball}"), ["a", "b", "c"][ball % 3], shape);
    }
    let floor = Shape::Plane(Plane {
        point: DVec3::ZERO,
        normal: DVec3::Y,
    });
    add("Floor".to_owned(), "c", floor);
    scene.lights = [(-150.0, 200.0), (120.0, 150.0)]
        .map(|(x, y)| Light {
            name: format!("Light at {x}"),
            position: DVec3::new(x, y, 90.0),
            intensity: 0.4,
            marker: None,
            visible: true,
        })
        .to_vec()
        .into();
    scene
}

fn move_ball(scene: &mut Scene, ball: usize, to: DVec3) {
    match &mut scene.objects[1 + ball].shape {
        Shape::Sphere(sphere) => sphere.center = to,
        other => panic!("a ball, not {other:?}"),
    }
}

fn mesh(scene: &mut Scene) -> &mut Mesh {
    match &mut scene.objects[0].shape {
        Shape::Mesh(mesh) => mesh,
        other => panic!("a mesh, not {other:?}"),
    }
}

#[test]
fn pictures_after_others_are_as_if_they_were_the_first() {
    let mut dice = Dice(8);
    let changes: [(&str, Change); 8] = [
        ("nothing", |_, _| {}),
        ("a ball", |scene, dice| move_ball(scene, 7, place(dice))),
        ("a light", |scene, _| scene.lights[0].position.x = 80.0),
        ("the mesh", |scene, _| mesh(scene).position.y += 12.0),
        ("its turn", |scene, _| mesh(scene).rotation.x += 33.0),
        ("all balls", |scene, dice| {
            (0..BALLS).for_each(|ball| move_ball(scene, ball, place(dice)));
        }),
        ("one hidden", |scene, _| scene.objects[9].visible = false),
        ("the camera", |scene, _| scene.camera.position.x = -30.0),
    ];
    for sampling in [Sampling::Centres, Sampling::ADAPTIVE] {
        let mut scene = crowd(&mut dice);
        let mut planner = Planner::default();
        let request = RenderRequest {
            sampling,
            ..RenderRequest::sized(160, 120)
        };
        let control = RenderControl::default();
        for (what, change) in changes {
            change(&mut scene, &mut dice);
            let mut kept = Image::default();
            render_into(&mut kept, &mut planner, &scene, &request, &control).expect("not stopped");
            assert!(kept == picture(&scene, &request).0, "{what}, {sampling:?}");
            if sampling == Sampling::Centres {
                let listed = RenderRequest {
                    accelerator: Accelerator::List,
                    ..request
                };
                assert!(kept == picture(&scene, &listed).0, "{what}, listed");
            }
        }
    }
}
