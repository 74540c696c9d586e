//! No more than the scene needs: each rule of the plan leaves the picture unchanged, saves what it claims, and does
//! not apply where it must not.

use glam::DVec3;
use glint::image::Image;
use glint::plan::{Model, Need, Plan, PlanCache, RenderRequest, needs};
use glint::scene::{
    Accelerator, Disc, HighlightMethod, Object, Sampling, Scene, Shape, Sphere, Triangle,
};
use glint::trace::Rays;

use crate::pictures::{differing, picture};
use crate::random;

fn picture_of(scene: &Scene, model: Model) -> (Image, Rays) {
    let wanted = RenderRequest {
        model,
        ..RenderRequest::sized(160, 120)
    };
    picture(scene, &wanted)
}

/// The plan's answer to a rule.
fn need(scene: &Scene, rule: &str) -> Need {
    let needs = needs(scene, &RenderRequest::still(scene));
    let need = needs.into_iter().find(|need| need.rule == rule);
    need.expect("a known rule")
}

fn said(scene: &Scene, rule: &str) -> String {
    need(scene, rule).what
}

/// The demo with a change applied.
fn demo(change: impl Fn(&mut Scene)) -> Scene {
    let mut scene = Scene::demo();
    change(&mut scene);
    scene
}

#[test]
fn what_is_left_out_is_not_missed() {
    let scenes = (0..12).map(random::scene).chain([
        Scene::demo(),
        demo(|scene| scene.lights[0].intensity = 0.0),
        demo(|scene| scene.lights[1].position = DVec3::new(100.0, -20.0, -50.0)),
        demo(|scene| {
            scene
                .packs_mut()
                .values_mut()
                .for_each(|pack| pack.specular = DVec3::new(0.0, 0.0, 0.0));
        }),
    ]);
    for (index, scene) in scenes.enumerate() {
        let (needed, few) = picture_of(&scene, Model::Needed);
        let (everything, many) = picture_of(&scene, Model::Everything);
        assert_eq!(differing(&needed, &everything, 0), 0, "scene {index}");
        assert!(
            few.shadow < many.shadow && few.reflected <= many.reflected,
            "{few:?} {many:?}"
        );
    }
}

/// With culling, every ray hits what it would hit if every primitive were tested: byte for byte, ray for ray, with
/// every sampling, even where adaptive sampling looks beside its rays.
#[test]
fn what_is_culled_is_not_missed() {
    let mut many = Scene::demo();
    many.render.reflection_limit = 3;
    for number in 0..200 {
        let mut ball = many.objects[0].clone();
        let (column, row) = (f64::from(number % 20), f64::from(number / 20));
        ball.name = format!("Ball {number}");
        ball.shape = Shape::Sphere(Sphere {
            center: DVec3::new(10.0 * column, 1.0 + row % 3.0, -40.0 - 20.0 * row),
            radius: 0.2 + 0.4 * row,
        });
        many.objects.push(ball);
    }
    let scenes = (0..10).map(random::scene);
    let scenes = scenes.chain((0..6).map(random::with_discs));
    let scenes = scenes
        .chain(random::published())
        .chain([many, random::shards()]);
    for (index, scene) in scenes.enumerate() {
        for sampling in [Sampling::Centres, Sampling::Grid(2), Sampling::ADAPTIVE] {
            let traced = |model| {
                let request = RenderRequest {
                    model,
                    sampling,
                    ..RenderRequest::sized(96, 72)
                };
                picture(&scene, &request)
            };
            let (culled, unculled) = (traced(Model::Needed), traced(Model::Unculled));
            assert_eq!(culled.1, unculled.1, "rays of scene {index}, {sampling:?}");
            assert!(culled.0 == unculled.0, "scene {index}, {sampling:?}");
        }
    }
}

#[test]
fn surfaces_that_face_away_cast_no_shadow_rays() {
    let scene = demo(|scene| scene.light_visualization = false);
    let (_, few) = picture_of(&scene, Model::Needed);
    let (_, many) = picture_of(&scene, Model::Everything);
    let spared = 1.0 - few.total() as f64 / many.total() as f64;
    assert!((0.02..0.3).contains(&spared), "{spared}");
    assert_eq!(few.reflected, many.reflected);
}

#[test]
fn a_dark_or_hidden_light_costs_no_ray() {
    let bright = picture_of(&Scene::demo(), Model::Needed).1;
    let dark = demo(|scene| scene.lights[0].intensity = 0.0);
    let below = demo(|scene| scene.lights[0].position = DVec3::new(100.0, -20.0, -50.0));
    for scene in [&dark, &below] {
        let rays = picture_of(scene, Model::Needed).1;
        assert!(rays.shadow < bright.shadow * 2 / 3, "{rays:?} {bright:?}");
        assert!(said(scene, "shadows").starts_with("shadow rays to 1 of 2 lights"));
    }
}

#[test]
fn without_mirrors_nothing_is_reflected_and_one_brings_it_back() {
    let matte = demo(|scene| {
        scene
            .packs_mut()
            .values_mut()
            .for_each(|pack| pack.reflective = false);
    });
    assert_eq!(picture_of(&matte, Model::Needed).1.reflected, 0);
    assert_eq!(said(&matte, "reflections"), "no reflected rays");
    let black = demo(|scene| {
        for pack in scene.packs_mut().values_mut() {
            pack.specular = DVec3::new(0.0, 0.0, 0.0);
        }
    });
    assert_eq!(picture_of(&black, Model::Needed).1.reflected, 0);
    assert!(picture_of(&black, Model::Everything).1.reflected > 0);
    let flat = demo(|scene| scene.render.reflection_limit = 0);
    assert_eq!(said(&flat, "reflections"), "no reflected rays");
    let one = demo(|scene| {
        scene
            .packs_mut()
            .values_mut()
            .for_each(|pack| pack.reflective = false);
        scene.packs_mut()["sphere 1"].reflective = true;
    });
    assert!(picture_of(&one, Model::Needed).1.reflected > 0);
    assert!(said(&one, "reflections").starts_with("reflected rays"));
}

#[test]
fn the_tree_begins_where_a_list_is_too_long() {
    let ball = |center: DVec3| {
        Shape::Sphere(Sphere {
            center,
            radius: 0.4,
        })
    };
    let triangle = |a: DVec3| {
        Shape::Triangle(Triangle {
            a,
            b: a + DVec3::X,
            c: a + DVec3::Y,
        })
    };
    let disc = |center: DVec3| {
        Shape::Disc(Disc {
            center,
            normal: DVec3::Z,
            radius: 0.4,
        })
    };
    let crowd = |kind: &dyn Fn(DVec3) -> Shape, count: usize, sampling: Sampling, side: u32| {
        let mut scene = Scene::empty();
        let pack = scene.color_packs.keys().next().expect("a pack").clone();
        for n in 0..count {
            scene.objects.push(Object {
                name: format!("Object {n}"),
                color_pack: pack.clone(),
                shape: kind(DVec3::new(n as f64, 0.0, -50.0)),
                visible: true,
                group: String::new(),
            });
        }
        scene.light_visualization = false;
        let request = RenderRequest {
            sampling,
            ..RenderRequest::sized(side, side)
        };
        let plan = Plan::<f32>::new(&scene, &request, &mut PlanCache::default());
        plan.geometry.is_some()
    };
    let (plain, smooth) = (Sampling::Centres, Sampling::ADAPTIVE);
    // Independent of the size of the picture.
    for sampling in [plain, smooth] {
        assert!(!crowd(&disc, 384, sampling, 2000) && crowd(&disc, 385, sampling, 2000));
        assert!(!crowd(&ball, 128, sampling, 2000) && crowd(&ball, 129, sampling, 2000));
        assert!(!crowd(&triangle, 128, sampling, 2000) && crowd(&triangle, 129, sampling, 2000));
        assert!(!crowd(&ball, 32, sampling, 64) && crowd(&ball, 33, sampling, 64));
    }
    // With 200 objects, it depends on the size: 2,000 pixels per object, or 500 with clean edges.
    assert!(crowd(&disc, 200, plain, 632) && !crowd(&disc, 200, plain, 633));
    assert!(crowd(&disc, 200, smooth, 316) && !crowd(&disc, 200, smooth, 317));
    // So far the objects were in a row; this crowd fills a volume.
    let space = |side: f64| {
        let mut scene = Scene::empty();
        for n in 0..64 {
            let place = DVec3::new(f64::from(n % 4), f64::from(n / 4 % 4), f64::from(n / 16));
            scene.objects.push(Object::new(
                format!("Ball {n}"),
                "pack 1",
                Sphere {
                    center: place * side,
                    radius: 1.0,
                },
            ));
        }
        let request = RenderRequest::sized(2000, 2000);
        let plan = Plan::<f32>::new(&scene, &request, &mut PlanCache::default());
        plan.geometry.is_some()
    };
    assert!(!space(1.9) && space(2.1));
}

#[test]
fn far_faces_of_solids_are_left_out_and_of_open_meshes_are_not() {
    let left_out = |scene: &Scene| {
        let plan = Plan::<f32>::new(
            scene,
            &RenderRequest::sized(64, 64),
            &mut PlanCache::default(),
        );
        let eye = plan
            .camera_culled_faces
            .iter()
            .filter(|away| **away)
            .count();
        let lights = plan
            .lights
            .iter()
            .flat_map(|light| &light.shadow_culled_faces);
        (eye, lights.filter(|away| **away).count())
    };
    let closed = Scene::demo();
    let (eye, lights) = left_out(&closed);
    assert!(eye >= 3 && lights >= 4, "{eye} {lights}");
    assert!(said(&closed, "faces").contains("left out"));
    let open = demo(|scene| scene.objects[2].visible = false);
    assert_eq!(left_out(&open), (0, 0));
    assert!(said(&open, "faces").starts_with("both sides"));
    let inside = demo(|scene| scene.camera.position = DVec3::new(200.0, 20.0, -100.0));
    assert_eq!(left_out(&inside).0, 0);
    for scene in [closed, open, inside] {
        let (needed, everything) = (
            picture_of(&scene, Model::Needed).0,
            picture_of(&scene, Model::Everything).0,
        );
        assert!(needed == everything);
    }
}

#[test]
fn what_was_asked_for_is_said_to_be() {
    let why = |change: fn(&mut Scene), rule: &str| {
        let need = need(&demo(change), rule);
        format!("{}: {}", need.what, need.why)
    };
    let tree = why(
        |scene| scene.render.accelerator = Accelerator::Bvh,
        "accelerator",
    );
    assert_eq!(
        tree,
        "10 bounded primitives in a tree of boxes: it was requested"
    );
    let power = why(
        |scene| scene.render.specular = HighlightMethod::Log1p,
        "highlights",
    );
    assert!(power.ends_with("Phong exponents: it was requested"));
    let nothing = |scene: &mut Scene| scene.objects = std::iter::empty().collect();
    assert!(why(nothing, "highlights").contains("no visible object has a specular colour"));
    assert!(why(nothing, "shadows").ends_with("nothing is visible"));
    assert!(why(nothing, "faces").starts_with("no single triangles"));
    let demo = why(|_| {}, "faces");
    let counted = "3 of 6 triangles left out for the camera, 8 of 12 for 2 lights";
    assert!(demo.contains(counted), "{demo}");
}

#[test]
fn large_exponents_are_told() {
    let with = |p: f64| demo(|scene| scene.packs_mut()["plane"].phong_exponent = p);
    assert_eq!(said(&with(256.0), "highlights"), "repeated squaring");
    assert!(said(&with(257.0), "highlights").contains("log1p"));
    assert!(said(&with(16.5), "highlights").contains("fractions"));
}
