//! The limits of what a scene can hold: the picture is right – judged by the other engine, or by the same scene in
//! milder circumstances – or an error says why there is none.

use std::collections::HashSet;

use glam::DVec3;
use glint::mesh::SOLIDS;
use glint::plan::RenderRequest;
use glint::scene::{
    Accelerator, Camera, ColorPack, Light, List, MAX_REFLECTIONS, MAX_SIDE, Mesh, Object, Plane,
    Sampling, Scene, Sphere, check, hints,
};
use glint::trace::Threads;

use crate::pictures::{differing, picture};
use crate::random::{Dice, placed};
use crate::scalar::assert_agreed;

#[test]
fn something_very_far_away_changes_nothing_else() {
    let mut scene = Scene::demo();
    let solid = SOLIDS.iter().find(|solid| solid.name == "Torus");
    let torus = Mesh {
        position: DVec3::new(140.0, 40.0, -60.0),
        ..Mesh::of((solid.expect("there is one").make)(15.0))
    };
    scene
        .objects
        .push(Object::new("Torus", "tetrahedron", torus));
    let request = RenderRequest::sized(200, 150);
    let known = picture(&scene, &request).0;
    for place in [
        DVec3::X * 1e9,
        DVec3::new(3e7, 1e8, 2e9),
        DVec3::splat(-1e11),
    ] {
        let mut scene = scene.clone();
        let far = Sphere {
            center: place,
            radius: 20.0,
        };
        scene.objects.push(Object::new("Far", "sphere 2", far));
        let off = differing(&known, &picture(&scene, &request).0, 1);
        assert!(off <= 3, "{off} pixels with a ball at {place}");
        // At most, a hint says that it is small.
        let said = hints(&scene).len();
        assert!(said <= 1 + hints(&Scene::demo()).len(), "{said} hints");
    }
}

#[test]
fn a_scene_of_any_size_anywhere_shows_the_same() {
    let request = RenderRequest::sized(200, 150);
    let known = picture(&Scene::demo(), &request).0;
    let far = DVec3::new(0.8, -0.5, 0.3);
    for (scale, away) in [
        (1e-9, 0.0),
        (1e-3, 0.0),
        (1e3, 0.0),
        (1e9, 0.0),
        (1.0, 1e6),
        (1.0, 1e9),
        (1e-6, 1e3),
        (1e9, 5e11),
    ] {
        let scene = placed(Scene::demo(), scale, far * away);
        assert_eq!(check(&scene), Ok(()));
        let other = picture(&scene, &request).0;
        let differ = differing(&known, &other, 1);
        assert!(
            differ * 500 <= known.pixels.len(),
            "{scale:e} times as large, {away:e} away: {differ} pixels"
        );
    }
}

#[test]
fn nothing_at_all_is_a_picture_of_the_background() {
    let mut scene = Scene::demo();
    scene.objects = List::default();
    scene.lights = List::default();
    scene.background = DVec3::new(10.0, 20.0, 30.0);
    for sampling in [Sampling::Centres, Sampling::ADAPTIVE, Sampling::Grid(3)] {
        let request = RenderRequest {
            sampling,
            ..RenderRequest::sized(70, 50)
        };
        let pixels: HashSet<[u8; 4]> = picture(&scene, &request).0.pixels.into_iter().collect();
        assert_eq!(pixels, HashSet::from([[10, 20, 30, 255]]));
    }
    scene = Scene::demo();
    scene.lights = List::default();
    assert_agreed("no lights", scene);
}

#[test]
fn hundreds_of_lights_and_any_sharpness_are_shaded_as_by_the_other_engine() {
    let mut scene = Scene::demo();
    let dice = &mut Dice(5);
    let light = |number: usize, dice: &mut Dice| Light {
        name: format!("Light {number}"),
        position: DVec3::new(
            dice.real(0.0, 300.0),
            dice.real(150.0, 300.0),
            dice.real(-200.0, 100.0),
        ),
        intensity: 1.0 / 300.0,
        visible: true,
        marker: None,
    };
    scene.lights = (0..300).map(|number| light(number, dice)).collect();
    assert_agreed("300 lights", scene);
    for exponent in [0.0, 1e-3, 1.0, 1e4, 1e7, 1e9] {
        let mut scene = Scene::demo();
        for pack in scene.packs_mut().values_mut() {
            pack.phong_exponent = exponent;
        }
        assert_eq!(check(&scene), Ok(()));
        assert_agreed(&format!("exponent {exponent:e}"), scene);
    }
}

/// Two mirrors that face each other, with a ball between them.
fn hall(limit: u32) -> Scene {
    let mut scene = Scene::demo();
    scene.render.reflection_limit = limit;
    let mirror = ColorPack {
        ambient: DVec3::splat(20.0),
        diffuse: DVec3::splat(60.0),
        specular: DVec3::splat(200.0),
        reflective: true,
        ..ColorPack::default()
    };
    scene.packs_mut().insert("mirror".to_owned(), mirror);
    let wall = |name: &str, x: f64| {
        Object::new(
            name,
            "mirror",
            Plane {
                point: DVec3::new(x, 0.0, 0.0),
                normal: DVec3::X,
            },
        )
    };
    scene.objects.push(wall("Left", 0.0));
    scene.objects.push(wall("Right", 320.0));
    scene.camera = Camera {
        position: DVec3::new(160.0, 100.0, 150.0),
        look_at: DVec3::new(0.9, -0.1, -0.4),
        ..scene.camera
    };
    scene
}

#[test]
fn mirrors_in_mirrors_end_where_they_are_to() {
    for limit in [0, 1, 5, MAX_REFLECTIONS] {
        assert_agreed(&format!("{limit} bounces"), hall(limit));
    }
    let problem = check(&hall(MAX_REFLECTIONS + 1)).expect_err("too many");
    let said = format!("{problem:?}");
    assert!(said.contains("reflection_limit"), "{said}");
}

#[test]
fn pictures_of_any_shape_are_whole() {
    let scene = Scene::demo();
    for (width, height) in [(1, 1), (MAX_SIDE, 1), (1, MAX_SIDE), (3, 2000)] {
        for sampling in [Sampling::Centres, Sampling::ADAPTIVE] {
            let request = RenderRequest {
                sampling,
                ..RenderRequest::sized(width, height)
            };
            let pictures = [1, 64].map(|count| {
                let threads = Threads::new(Some(count)).expect("threads");
                threads.run(|| picture(&scene, &request).0)
            });
            assert!(pictures[0] == pictures[1], "{width}×{height}");
            assert_eq!(pictures[0].pixels.len(), (width * height) as usize);
        }
    }
}

#[test]
fn very_many_things_are_seen_as_one_by_one() {
    let mut scene = Scene::demo();
    let dice = &mut Dice(9);
    let ball = |number: usize, dice: &mut Dice| {
        Object::new(
            format!("Ball {number}"),
            "sphere 1",
            Sphere {
                center: DVec3::new(
                    dice.real(0.0, 300.0),
                    dice.real(20.0, 120.0),
                    dice.real(-250.0, -50.0),
                ),
                radius: dice.real(0.1, 0.8),
            },
        )
    };
    for number in 0..100_000 {
        scene.objects.push(ball(number, dice));
    }
    let with = |accelerator| {
        let request = RenderRequest {
            accelerator,
            ..RenderRequest::sized(40, 30)
        };
        picture(&scene, &request).0.pixels
    };
    assert!(with(Accelerator::Bvh) == with(Accelerator::List));
}
