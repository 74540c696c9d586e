//! Rendering of meshes, and the tree that is used for many objects.

use glam::DVec3;
use glint::animate::pose;
use glint::mesh::{Triangles, globe, icosphere};
use glint::plan::{Model, RenderRequest};
use glint::scene::{
    Accelerator, Document, Mesh, Object, Precision, Sampling, Scene, Shape, Sphere, Triangle,
    check_edit,
};

use crate::pictures::{differing, picture};
use crate::random;

/// A closed bumpy ball around the origin, of about this many triangles.
fn bumpy(triangles: f64) -> Triangles {
    let rings = (triangles / 4.0).sqrt() as u32;
    globe(rings, |polar, azimuth| {
        20.0 * (1.0 + 0.1 * (5.0 * azimuth).sin() * (4.0 * polar).sin())
    })
}

/// Joining or pasting more would make a scene that could be neither saved nor read.
#[test]
fn no_edit_makes_more_triangles_than_a_file_has_room_for() {
    let mesh = Mesh::of(bumpy(20_000.0));
    let with = |count: usize| {
        let mut scene = Scene::demo();
        let one = |number| Object::new(format!("Ball {number}"), "sphere 1", mesh.clone());
        let objects = scene.objects.iter().cloned();
        scene.objects = objects.chain((0..count).map(one)).collect();
        scene
    };
    let [few, many, more] = [100, 400, 401].map(with);
    assert_eq!(check_edit(&few, &Scene::demo()), Ok(()));
    let refused = check_edit(&many, &few).expect_err("too many");
    assert!(refused.sentence.contains("256 MiB"), "{}", refused.sentence);
    assert!(check_edit(&more, &many).is_err());
    // An edit that reduces the number is allowed.
    assert_eq!(check_edit(&many, &more), Ok(()));
}

/// The demo with two meshes, one of them used twice, rotated and scaled.
fn exhibition() -> Scene {
    let mut scene = Scene::demo();
    let ball = Mesh::of(bumpy(700.0));
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    scene.objects.push(Object::new(
        "Bumps 1",
        "sphere 2",
        Mesh {
            position: at(160.0, 30.0, -60.0),
            ..ball.clone()
        },
    ));
    scene.objects.push(Object::new(
        "Bumps 2",
        "plane",
        Mesh {
            position: at(215.0, 60.0, -140.0),
            rotation: at(20.0, 35.0, -70.0),
            scale: at(1.0, -0.4, 1.3),
            ..ball
        },
    ));
    scene.objects.push(Object::new(
        "Ball",
        "tetrahedron",
        Mesh {
            position: at(90.0, 25.0, -90.0),
            ..Mesh::of(icosphere(18.0))
        },
    ));
    scene
}

/// The demo with slender meshes in all directions, which have oriented boxes.
fn rods() -> Scene {
    let mut scene = Scene::demo();
    let ball = Mesh::of(icosphere(1.0));
    let mut dice = random::Dice(64);
    for number in 0..16 {
        let [mut place, mut turn] = [DVec3::ZERO; 2];
        for axis in 0..3 {
            place[axis] = dice.real(-60.0, 60.0);
            turn[axis] = dice.real(0.0, 360.0);
        }
        let rod = Mesh {
            position: DVec3::new(140.0, 50.0, -90.0) + place,
            rotation: turn,
            scale: DVec3::new(0.5, 45.0, 0.5),
            ..ball.clone()
        };
        let name = format!("Rod {number}");
        scene.objects.push(Object::new(name, "sphere 2", rod));
    }
    scene
}

/// The demo with a cone of many sides, which has slices of its faces in its tree.
fn cone() -> Scene {
    let mut scene = Scene::demo();
    let rim = |side: u32| {
        let angle = f64::from(side) / 80.0 * std::f64::consts::TAU;
        DVec3::new(angle.cos() * 30.0, 0.0, angle.sin() * 30.0)
    };
    let points = (0..80).map(rim).chain([DVec3::ZERO, DVec3::Y * 70.0]);
    let side = |side: u32| [[side, 81, (side + 1) % 80], [(side + 1) % 80, 80, side]];
    let faces = (0..80).flat_map(side).collect();
    let cone = Mesh {
        position: DVec3::new(130.0, 10.0, -60.0),
        rotation: DVec3::new(20.0, 0.0, 35.0),
        ..Mesh::of(Triangles::new(points.collect(), faces).expect("a cone"))
    };
    scene.objects.push(Object::new("Cone", "sphere 2", cone));
    scene
}

/// The same scene with every mesh separated into triangles.
fn apart(scene: &Scene) -> Scene {
    let mut apart = scene.clone();
    let is_mesh = |object: &Object| matches!(object.shape, Shape::Mesh(_));
    while let Some(index) = apart.objects.iter().position(is_mesh) {
        assert!(!apart.separate(index).is_empty());
    }
    apart
}

#[test]
fn a_tree_changes_no_bit_and_no_ray() {
    let mut crowd = random::scene(5);
    for n in 0..300 {
        let place = |speed: f64| (f64::from(n) * speed).sin() * 70.0;
        let center = DVec3::new(place(1.7), place(2.3), place(3.1));
        let radius = 2.5;
        crowd.objects.push(Object::new(
            format!("Speck {n}"),
            "pack 0",
            Sphere { center, radius },
        ));
    }
    let mut mirrors = exhibition();
    mirrors.render.reflection_limit = 3;
    for index in 0..mirrors.objects.len() {
        if let Shape::Mesh(mesh) = &mut mirrors.objects[index].shape {
            mesh.smooth = 70.0;
        }
    }
    // Allowed relative difference of the number of rays with clean edges: a list also considers thin things beside
    // a ray behind its hit, and a tree treats the content of a box of half a pixel as one thing, such as the slices of a
    // rod.
    let scenes = [
        (exhibition(), 0.0),
        (apart(&exhibition()), 0.25),
        (mirrors, 0.0),
        (crowd, 0.01),
        (rods(), 0.001),
        (cone(), 0.0),
    ];
    for (number, (scene, other_rays)) in scenes.iter().enumerate() {
        // Clean edges take long as a list.
        for (sampling, (width, height)) in [
            (Sampling::Centres, (120, 90)),
            (Sampling::Grid(2), (120, 90)),
            (Sampling::ADAPTIVE, (72, 54)),
        ] {
            for precision in [Precision::Single, Precision::Double] {
                let with = |accelerator, model| {
                    let wanted = RenderRequest {
                        accelerator,
                        model,
                        sampling,
                        precision,
                        ..RenderRequest::sized(width, height)
                    };
                    picture(scene, &wanted)
                };
                let tree = with(Accelerator::Bvh, Model::Needed);
                for (accelerator, model) in [
                    (Accelerator::List, Model::Needed),
                    (Accelerator::Auto, Model::Unculled),
                ] {
                    let flat = with(accelerator, model);
                    let case = format!("scene {number}, {sampling:?}, {precision:?}");
                    if sampling != Sampling::ADAPTIVE {
                        assert!(tree == flat, "{case}");
                        continue;
                    }
                    let off = [1, 8].map(|levels| differing(&tree.0, &flat.0, levels));
                    assert!(off[0] <= 4 && off[1] == 0, "{case}: {off:?} of 3888 pixels");
                    let (ours, theirs) = (tree.1.camera as f64, flat.1.camera as f64);

                    assert!(
                        (ours / theirs - 1.0).abs() <= *other_rays,
                        "{case}: {ours} {theirs}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_mesh_is_its_triangles() {
    let wanted = RenderRequest::sized(320, 240);
    let (whole, rays) = picture(&exhibition(), &wanted);
    let (pieces, other_rays) = picture(&apart(&exhibition()), &wanted);
    let differ = differing(&whole, &pieces, 1);
    assert!(differ <= 8, "{differ} of 76,800 pixels");
    let share = rays.shadow as f64 / other_rays.shadow as f64;
    assert!((share - 1.0).abs() < 1e-3, "{rays:?} {other_rays:?}");
}

#[test]
fn where_a_mesh_is_costs_no_precision() {
    let moved = random::placed(exhibition(), 1.0, DVec3::new(3e6, -2e6, 5e6));
    let wanted = RenderRequest {
        precision: Precision::Single,
        ..RenderRequest::sized(320, 240)
    };
    let differ = differing(
        &picture(&exhibition(), &wanted).0,
        &picture(&moved, &wanted).0,
        1,
    );
    assert!(differ <= 8, "{differ} of 76,800 pixels");
}

#[test]
fn nobody_looks_out_of_a_closed_mesh() {
    let sky = DVec3::new(0.0, 255.0, 0.0);
    for scale in [1e-4, 1.0, 1e4] {
        for away in [0.0, 1e2, 1e4] {
            let mut scene = Scene::empty();
            scene.background = sky;
            scene.light_visualization = false;
            let centre = DVec3::new(0.6, -0.64, 0.48) * (scale * away * 20.0);
            scene.objects.push(Object::new(
                "Room",
                "pack 1",
                Mesh {
                    position: centre,
                    rotation: DVec3::new(10.0, 20.0, 30.0),
                    scale: DVec3::splat(scale),
                    ..Mesh::of(bumpy(5000.0))
                },
            ));
            for light in scene.lights.iter_mut() {
                light.position = centre + DVec3::splat(scale);
            }
            scene.camera.position = centre + DVec3::new(1.0, 2.0, -3.0) * scale;
            for look_at in [DVec3::NEG_Z, DVec3::new(1.0, 0.3, 0.2)] {
                scene.camera.look_at = look_at;
                scene.camera.up = DVec3::Y;
                let wanted = RenderRequest {
                    precision: Precision::Single,
                    ..RenderRequest::sized(600, 600)
                };
                let (image, _) = picture(&scene, &wanted);
                let leaks = image
                    .pixels
                    .iter()
                    .filter(|pixel| pixel[1] == 255 && pixel[0] == 0);
                assert_eq!(leaks.count(), 0, "scale {scale:e}, {away} sizes away");
            }
        }
    }
}

#[test]
fn a_closed_mesh_in_the_light_has_no_dark_specks() {
    // Seen from the light, everything visible is lit.
    let mut scene = Scene::empty();
    scene.ambient_intensity = 0.0;
    scene.light_visualization = false;
    scene.background = DVec3::splat(255.0);
    scene
        .objects
        .push(Object::new("Bumps", "pack 1", Mesh::of(bumpy(20_000.0))));
    let eye = DVec3::new(30.0, 20.0, 60.0);
    for light in scene.lights.iter_mut() {
        light.position = eye;
        light.intensity = 1.0;
    }
    scene.camera.position = eye;
    scene.camera.look_at = -eye;
    for precision in [Precision::Single, Precision::Double] {
        let wanted = RenderRequest {
            precision,
            ..RenderRequest::sized(500, 500)
        };
        let (image, _) = picture(&scene, &wanted);
        // At the contour, the light is at grazing incidence.
        let is_rim = |at: usize| {
            let around = [1, 499, 500, 501]
                .into_iter()
                .flat_map(|by| [at - by, at + by]);
            around.into_iter().any(|at| image.pixels[at][1] == 255)
        };
        let dark = (501..500 * 499).filter(|&at| image.pixels[at][0] == 0 && !is_rim(at));
        assert_eq!(dark.count(), 0, "{precision:?}");
    }
}

#[test]
fn what_is_thin_in_a_mesh_is_found_and_what_is_thick_is_left_alone() {
    // A closed rod half a pixel wide, of many faces, and a ball of as many.
    let mut scene = Scene::demo();
    let rod = |width: f64| {
        let ring = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        let mut points = Vec::new();
        for step in 0..=40 {
            let x = f64::from(step) - 20.0;
            let at = |(y, z): (f64, f64)| DVec3::new(x, y * width / 2.0, z * width / 2.0);
            points.extend(ring.map(at));
        }
        let mut faces = vec![[0, 2, 1], [0, 3, 2]];
        for step in 0..40 {
            for side in 0..4 {
                let (a, b) = (4 * step + side, 4 * step + (side + 1) % 4);
                faces.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
        }
        faces.extend([[160, 161, 162], [160, 162, 163]]);
        Mesh::of(Triangles::new(points, faces).expect("a rod"))
    };
    let at = DVec3::new(170.0, 40.0, -80.0);
    let rays = |shape: Mesh| {
        let mut scene = scene.clone();
        scene.objects.push(Object::new(
            "it",
            "sphere 1",
            Mesh {
                position: at,
                ..shape
            },
        ));
        let wanted = RenderRequest {
            sampling: Sampling::ADAPTIVE,
            ..RenderRequest::sized(256, 256)
        };
        picture(&scene, &wanted).1.camera
    };
    let (thin, ball) = (rays(rod(0.15)), rays(Mesh::of(bumpy(20_000.0))));
    scene.objects.push(Object::new(
        "one",
        "sphere 1",
        Triangle {
            a: at,
            b: at + DVec3::Y,
            c: at + DVec3::X,
        },
    ));
    assert!(thin > 100_000, "{thin}");
    assert!(ball < 300_000, "{ball}");
}

/// A ball over a floor, lit from one side and made of `shape`.
fn lit_ball(shape: impl Into<Shape>, is_mirror: bool) -> Scene {
    let mut scene = Scene::demo();
    scene
        .objects
        .retain(|object| matches!(object.shape, Shape::Plane(_)));
    scene.light_visualization = false;
    scene.packs_mut()["sphere 1"].reflective = is_mirror;
    scene.objects.push(Object::new("Ball", "sphere 1", shape));
    scene.camera.position = DVec3::new(0.0, 45.0, 120.0);
    scene.camera.look_at = DVec3::new(0.0, -0.1, -1.0);
    scene.lights[0].position = DVec3::new(120.0, 60.0, 10.0);
    scene.lights[1].visible = false;
    scene
}

#[test]
fn a_smooth_ball_of_triangles_is_shaded_like_a_ball() {
    let center = DVec3::new(0.0, 30.0, -10.0);
    for is_mirror in [false, true] {
        let seen = |shape: Shape| {
            let wanted = RenderRequest {
                sampling: Sampling::Centres,
                ..RenderRequest::sized(200, 200)
            };
            picture(&lit_ball(shape, is_mirror), &wanted).0
        };
        let mesh = |smooth: f64| {
            seen(
                Mesh {
                    position: center,
                    smooth,
                    ..Mesh::of(icosphere(25.0))
                }
                .into(),
            )
        };
        let ball = seen(
            Sphere {
                center,
                radius: 25.0,
            }
            .into(),
        );
        let (smooth, flat) = (
            differing(&mesh(60.0), &ball, 4),
            differing(&mesh(0.0), &ball, 4),
        );
        assert!(smooth < 600 && flat > 2 * smooth, "{smooth} {flat}");
    }
}

#[test]
fn a_mesh_turns_along_its_track() {
    let track = |name: &str| {
        let text = format!(
            "Scene(version: 1, objects: [
                Object(name: \"Ball\", color_pack: \"a\", shape: Sphere(center: (0, 0, 0), radius: 1)),
                Object(name: \"Card\", color_pack: \"a\", shape: Mesh(points: [(0, 0, 0), (1, 0, 0), (0, 1, 0)], faces: [(0, 1, 2)], smooth: 30)),
            ], color_packs: {{\"a\": ColorPack()}}, animation: Animation(tracks: [
                Track(target: ObjectRotation({name:?}), keys: [Key(time: 0, value: (0, 0, 0), interpolation: Linear), Key(time: 4, value: (0, 360, 0))]),
            ]))"
        );
        Document::from_text(&text)
    };
    let scene = std::sync::Arc::new(track("Card").expect("a scene").scene);
    let Shape::Mesh(turned) = &pose(&scene, 1.0).objects[1].shape else {
        panic!("a mesh");
    };
    assert_eq!((turned.rotation, turned.smooth), (DVec3::Y * 90.0, 30.0));
    let refused = track("Ball").expect_err("a ball has no rotation");
    assert!(
        refused
            .to_string()
            .contains("there is no mesh named \"Ball\""),
        "{refused}"
    );
}

#[test]
fn how_long_meshes_become_is_known_before_they_are_written() {
    let ball = bumpy(1000.0);
    // Coordinates with few digits, and with all digits.
    let short = |point: &DVec3| point.round();
    let long = |point: &DVec3| *point * 1e6 / 3.0;
    for change in [&short as &dyn Fn(&DVec3) -> DVec3, &long] {
        let points = ball.points().iter().map(change).collect();
        let ball = Triangles::new(points, ball.faces().to_vec()).expect("a mesh");
        let mut scene = Scene::empty();
        let bytes = |scene: &Scene| {
            let text = Document::of(scene.clone()).to_text();
            text.expect("a text").len() as f64
        };
        let without = bytes(&scene);
        let object = Object {
            shape: Shape::Mesh(Mesh::of(ball)),
            ..Scene::demo().objects[0].clone()
        };
        scene.objects = [object].into_iter().collect();
        let told = scene.own_bytes() as f64 / (bytes(&scene) - without);
        assert!((0.85..=1.25).contains(&told), "{told}");
    }
}
