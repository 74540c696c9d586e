//! The picture: the same bytes whatever way it is computed, and the rules of the model on analytic scenes.

use std::collections::HashSet;

use glam::DVec3;
use glint::image::Image;
use glint::mesh::Triangles;
use glint::plan::RenderRequest;
use glint::scene::{
    Document, HighlightMethod, Mesh, Method as _, Methods, Object, Plane, Precision, Projection,
    RayOffset, Sampling, Scene, Shape, Sphere, SphereMethod, TriangleMethod,
};
use glint::simd::Level;
use glint::trace::{Grid, Pass, Rays, RenderControl, Threads, Tracer};

use crate::pictures::{differing, picture};
use crate::random;

fn small(scene: &Scene) -> Image {
    picture(scene, &RenderRequest::sized(160, 120)).0
}

const SAMPLINGS: [Sampling; 3] = [Sampling::Centres, Sampling::Grid(2), Sampling::ADAPTIVE];

/// The colour at the centre of a picture.
fn middle(scene: &Scene) -> [u8; 3] {
    let image = picture(scene, &RenderRequest::sized(31, 31)).0;
    let [r, g, b, _] = image.pixels[15 * 31 + 15];
    [r, g, b]
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    for scene in [Scene::demo(), random::scene(3), random::scene(4)] {
        let pictures: HashSet<[Vec<[u8; 4]>; 3]> = [1, 2, 7]
            .map(|count| {
                let threads = Threads::new(Some(count)).expect("threads");
                threads.run(|| {
                    SAMPLINGS.map(|sampling| {
                        let wanted = RenderRequest {
                            sampling,
                            ..RenderRequest::sized(201, 133)
                        };
                        picture(&scene, &wanted).0.pixels
                    })
                })
            })
            .into();
        assert_eq!(pictures.len(), 1);
    }
}

#[test]
fn any_lanes_give_the_same_bytes() {
    let levels = Level::available();
    assert!(levels.len() > 1, "a processor with vectors");
    for scene in [
        Scene::demo(),
        random::scene(1),
        random::scene(2),
        random::scene(6),
        random::shards(),
    ] {
        let precisions = [Precision::Single, Precision::Double];
        for (precision, sampling) in precisions
            .into_iter()
            .flat_map(|p| SAMPLINGS.map(|s| (p, s)))
        {
            let at = |level| RenderRequest {
                precision,
                sampling,
                level: Some(level),
                ..RenderRequest::sized(203, 131)
            };
            let single = picture(&scene, &at(Level::SINGLE));
            for level in &levels {
                assert!(
                    picture(&scene, &at(*level)) == single,
                    "{} {precision:?} {sampling:?}",
                    level.name
                );
            }
        }
    }
}

/// A box in front of a disc seen nearly edge-on: rays that hit the box pass close to the start of the disc.
const BEFORE_A_DISC: &str = r#"
    camera: Camera(position: (93.2379, 21.8223, -139.607), look_at: (-108.221, -11.442, 135.074), up: (0, 1, 0), projection_distance: 1.284),
    objects: [
        Object(name: "Box", color_pack: "dull", shape: Mesh(BOX,
            position: (-23.9713, 38.2683, 40.9062), rotation: (141.882, 0, 0), scale: (20.4303, 24.2158, 13.0766))),
        Object(name: "Disc", color_pack: "pale", shape: Disc(center: (-33.576, 39.0663, 27.5988), normal: (0.866922, 0.16259, 0.0632068), radius: 20.6733)),
    ],
    lights: [
        Light(name: "One", position: (-103.949, 119.116, -53.9353), intensity: 0.11),
        Light(name: "Two", position: (-21.8643, 176.909, -65.0833), intensity: 0.14),
        Light(name: "Three", position: (49.4944, 182.114, -36.6859), intensity: 0.33),
    ],"#;

/// Boxes, and a mirroring ball and floor: rays spread by the ball treat boxes as a whole, while others look into
/// them.
const BEFORE_A_BALL: &str = r#"
    camera: Camera(position: (-130, 25.39, 120), look_at: (130, -33.44, -120), up: (0, 1, 0), projection_distance: 1.3),
    objects: [
        Object(name: "One", color_pack: "dull", shape: Mesh(BOX,
            position: (-29.39, 32.25, -6.061), rotation: (54.57, 103.9, -146.2), scale: (5.284, 17.41, 15.98))),
        Object(name: "Two", color_pack: "dull", shape: Mesh(BOX,
            position: (4.969, 56.65, -14.26), rotation: (-102, -28.04, -169.5), scale: (18.32, 3.52, 3.433))),
        Object(name: "Ball", color_pack: "mirror", shape: Sphere(center: (-22.26, 23.14, -0.335), radius: 14.66)),
        Object(name: "Floor", color_pack: "mirror", shape: Plane(point: (0, 0, 0), normal: (0, 1, 0))),
    ],
    lights: [Light(name: "Lamp", position: (-4.04, 90, -21.02), intensity: 0.7)],"#;

const BOX: &str = "points: [(-1, -1, -1), (-1, -1, 1), (-1, 1, -1), (-1, 1, 1), (1, -1, -1), (1, -1, 1), (1, 1, -1), (1, 1, 1)],
    faces: [(0, 3, 1), (0, 2, 3), (4, 7, 6), (4, 5, 7), (0, 5, 4), (0, 1, 5), (2, 7, 3), (2, 6, 7), (0, 6, 2), (0, 4, 6), (1, 7, 5), (1, 3, 7)]";

const THREE_PACKS: &str = r#"Scene(version: 1, light_visualization: false,
    color_packs: {
        "dull": ColorPack(ambient: (224, 158, 84), diffuse: (224, 158, 84)),
        "pale": ColorPack(ambient: (211, 210, 167), diffuse: (211, 210, 167)),
        "mirror": ColorPack(ambient: (60, 160, 120), diffuse: (60, 160, 120), specular: (220, 220, 240), phong_exponent: 16, reflective: true),
    },
    render: Render(reflection_limit: 2),"#;

#[test]
fn what_a_ray_finds_beside_itself_depends_on_no_other_ray_of_its_packet() {
    for rest in [BEFORE_A_DISC, BEFORE_A_BALL] {
        let text = format!("{THREE_PACKS}{})", rest.replace("BOX", BOX));
        let scene = Document::from_text(&text).expect("a scene").scene;
        let [alone, together] = [Level::SINGLE, Level::widest()].map(|level| {
            let request = RenderRequest {
                sampling: Sampling::ADAPTIVE,
                level: Some(level),
                ..RenderRequest::sized(160, 120)
            };
            picture(&scene, &request)
        });
        assert!(alone == together, "{rest}");
    }
}

/// A mesh of thin tubes over a floor, whose faces have several boxes each.
fn tubes(salt: u32) -> Scene {
    const COUNT: u32 = 30;
    let text = r#"Scene(version: 1, light_visualization: false,
        color_packs: {"a": ColorPack(ambient: (200, 150, 90), diffuse: (200, 150, 90))},
        camera: Camera(position: (1.7, 2.5, 5.4), look_at: (0.15, -0.1, -1), projection_distance: 1.2),
        objects: [Object(name: "Floor", color_pack: "a", shape: Plane(point: (0, 0, 0), normal: (0, 1, 0)))],
        lights: [Light(name: "Lamp", position: (-5, 3.8, 6.7), intensity: 0.6)])"#;
    let mut scene = Document::from_text(text).expect("a scene").scene;
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for tube in 0..COUNT {
        let wave = |speed: f64| (f64::from(tube + 1 + salt * COUNT) * speed).sin();
        let middle = DVec3::new(
            wave(1.7) * 3.0,
            3.0 + wave(2.3) * 3.0,
            wave(3.1) * 6.0 - 6.0,
        );
        let angle = wave(4.7) * std::f64::consts::PI;
        let along = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let (across, half) = (DVec3::new(-along.y, along.x, 0.0), 2.5 + 1.5 * wave(5.9));
        let first = points.len() as u32;
        for end in [-half, half] {
            for side in [across, DVec3::Z, -across, -DVec3::Z] {
                points.push(middle + along * end + side * 0.01);
            }
        }
        for side in 0..4 {
            let [a, b] = [side, (side + 1) % 4].map(|side| first + side);
            faces.extend([[a, b, a + 4], [b, b + 4, a + 4]]);
        }
    }
    let tubes = Mesh::of(Triangles::new(points, faces).expect("tubes"));
    scene.objects.push(Object::new("Tubes", "a", tubes));
    scene
}

#[test]
fn faces_with_several_boxes_count_alike_whatever_the_packet() {
    for salt in 0..6 {
        let [alone, together] = [Level::SINGLE, Level::widest()].map(|level| {
            let request = RenderRequest {
                sampling: Sampling::ADAPTIVE,
                level: Some(level),
                ..RenderRequest::sized(96, 96)
            };
            picture(&tubes(salt), &request)
        });
        assert!(alone == together, "{salt}");
    }
}

#[test]
fn nested_passes_end_in_the_same_bytes_with_no_ray_more() {
    let scene = Scene::demo();
    let wanted = RenderRequest::sized(203, 131);
    let (whole, rays) = picture(&scene, &wanted);
    let tracer = Tracer::new(&scene, &wanted);
    let mut nested = Image::new(203, 131);
    let mut traced = Rays::default();
    let mut coarser = None;
    for step in [16, 8, 4, 2, 1] {
        let pass = nested.trace(
            &tracer,
            Pass::Centres(Grid { step, coarser }),
            &RenderControl::default(),
        );
        traced += pass.expect("not stopped");
        coarser = Some(step);
    }
    assert_eq!(nested, whole);
    assert_eq!(traced, rays);
}

/// Returns whether a pixel is within the range of what the other picture shows there and right beside it.
fn is_on_edge(pixel: [u8; 4], x: usize, y: usize, other: &Image) -> bool {
    let beside = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    (0..3).all(|channel| {
        let rows = beside(y, other.height);
        let around = rows.flat_map(|row| {
            beside(x, other.width).map(move |column| other.pixels[row * other.width + column])
        });
        let (low, high) = around.fold((255, 0), |(low, high): (u8, u8), other| {
            (low.min(other[channel]), high.max(other[channel]))
        });
        (low.saturating_sub(2)..=high.saturating_add(2)).contains(&pixel[channel])
    })
}

#[test]
fn single_and_double_precision_differ_on_edges_only() {
    let scenes = (0..50).map(random::scene).chain(random::published());
    for (number, scene) in scenes.enumerate() {
        let at = |precision| RenderRequest {
            precision,
            ..RenderRequest::sized(256, 192)
        };
        let single = picture(&scene, &at(Precision::Single)).0;
        let double = picture(&scene, &at(Precision::Double)).0;
        assert_same_but_for_edges(&single, &double, &format!("scene {number}"));
    }
}

/// Asserts that pixels differ by more than 1 of 255 only at edges, and at most one in 2000.
pub fn assert_same_but_for_edges(one: &Image, other: &Image, what: &str) {
    let mut differ = 0;
    for (index, (a, b)) in one.pixels.iter().zip(&other.pixels).enumerate() {
        if (0..3).any(|c| a[c].abs_diff(b[c]) > 1) {
            differ += 1;
            let (x, y) = (index % one.width, index / one.width);
            assert!(
                is_on_edge(*a, x, y, other),
                "{what}: {a:?} instead of {b:?} at {x}, {y}"
            );
        }
    }
    assert!(
        differ * 2000 <= one.pixels.len(),
        "{what}: {differ} pixels differ"
    );
}

#[test]
fn the_classic_formulas_show_the_same_where_they_work() {
    let scene = Scene::demo();
    let robust = small(&scene);
    let methods = Methods {
        sphere: SphereMethod::Classic,
        triangle: TriangleMethod::Edges,
        offset: RayOffset::Fixed(0.1),
        highlight: HighlightMethod::Power,
    };
    let wanted = RenderRequest {
        methods,
        ..RenderRequest::sized(160, 120)
    };
    let differ = differing(&robust, &picture(&scene, &wanted).0, 2);
    assert!(differ <= 100, "{differ} of 19200");
}

/// Every formula renders the demo correctly, a scene on which all of them work.
#[test]
fn every_formula_draws_the_demo() {
    let scene = Scene::demo();
    let robust = small(&scene);
    let changes = changed_one_at_a_time();
    assert_eq!(changes.len(), 1 + 3 + 3 + 2);
    for (word, methods) in changes {
        let wanted = RenderRequest {
            methods,
            ..RenderRequest::sized(160, 120)
        };
        let other = picture(&scene, &wanted).0;
        let differ = differing(&robust, &other, 2);
        assert!(differ <= 60, "{word}: {differ} of 19200");
    }
}

/// The default formulas with one of them replaced, for each alternative.
fn changed_one_at_a_time() -> Vec<(&'static str, Methods)> {
    let default = Methods::default();
    let mut all = Vec::new();
    for way in &SphereMethod::ALL[1..] {
        let sphere = way.value;
        all.push((way.id, Methods { sphere, ..default }));
    }
    for way in &TriangleMethod::ALL[1..] {
        let triangle = way.value;
        all.push((
            way.id,
            Methods {
                triangle,
                ..default
            },
        ));
    }
    for way in &RayOffset::ALL[1..] {
        let offset = way.value;
        all.push((way.id, Methods { offset, ..default }));
    }
    for way in &HighlightMethod::ALL[1..] {
        let highlight = way.value;
        all.push((
            way.id,
            Methods {
                highlight,
                ..default
            },
        ));
    }
    all
}

fn changed_ppm(scale: f64, by: DVec3, methods: Methods, precision: Precision) -> usize {
    let at = |scene: &Scene, methods| {
        let wanted = RenderRequest {
            precision,
            methods,
            ..RenderRequest::sized(320, 320)
        };
        picture(scene, &wanted).0
    };
    let (here, there) = (
        at(&Scene::demo(), Methods::default()),
        at(&random::placed(Scene::demo(), scale, by), methods),
    );
    let differ = differing(&here, &there, 1);
    differ * 1_000_000 / here.pixels.len()
}

#[test]
fn no_scale_and_no_place_changes_the_picture() {
    let here = DVec3::new(0.0, 0.0, 0.0);
    let (single, double) = (Precision::Single, Precision::Double);
    for scale in [1e-4, 1e-2, 1e2, 1e4, 1e6] {
        let ppm = changed_ppm(scale, here, Methods::default(), single);
        assert!(ppm <= 500, "scale {scale}: {ppm} ppm");
        let ppm = changed_ppm(scale, here, Methods::default(), double);
        assert_eq!(ppm, 0, "double precision at scale {scale}");
    }
    let (low, high) = Scene::demo().bounds().expect("a size");
    let size = (high - low).length();
    let aside = DVec3::new(0.6, -0.64, 0.48);
    for sizes in [1.0, 1e2, 1e3, 1e4, 1e5] {
        let ppm = changed_ppm(1.0, aside * (size * sizes), Methods::default(), single);
        assert!(ppm <= 500, "{sizes} sizes away: {ppm} ppm");
    }
    let fixed = Methods {
        offset: RayOffset::Fixed(0.1),
        ..Methods::default()
    };
    let ppm = changed_ppm(1e-4, here, fixed, single);
    assert!(
        ppm > 10_000,
        "a fixed offset must fail in a tiny scene, or this test has no power: {ppm}"
    );
}

/// A white sphere of radius 1 in front of a camera that looks along -z, lit from the camera.
fn ball() -> Scene {
    let mut scene = Scene::empty();
    scene.camera.position = DVec3::new(0.0, 0.0, 10.0);
    scene.camera.look_at = DVec3::new(0.0, 0.0, -1.0);
    scene.camera.up = DVec3::new(0.0, 1.0, 0.0);
    scene.lights[0].position = DVec3::new(0.0, 0.0, 20.0);
    scene.lights[0].intensity = 0.5;
    scene.lights[0].marker.as_mut().expect("a marker").radius = 0.5;
    let pack = &mut scene.packs_mut()["pack 1"];
    pack.ambient = DVec3::new(40.0, 80.0, 120.0);
    pack.diffuse = DVec3::new(100.0, 50.0, 0.0);
    pack.specular = DVec3::new(0.0, 0.0, 60.0);
    scene.objects.push(glint::scene::Object::new(
        "Ball",
        "pack 1",
        Sphere {
            center: DVec3::new(0.0, 0.0, 0.0),
            radius: 1.0,
        },
    ));
    scene
}

#[test]
fn ambient_diffuse_and_specular_add_up_as_written() {
    // At normal incidence, n·l = n·h = 1: 0.5·(40, 80, 120) + 0.5·(100, 50, 0) + 0.5·(0, 0, 60).
    assert_eq!(middle(&ball()), [70, 65, 90]);
}

#[test]
fn a_blocked_light_leaves_ambient_and_a_marker_blocks_nothing() {
    let mut scene = ball();
    // The marker is between the ball and the camera, with its light inside.
    scene.lights[0].position = DVec3::new(0.0, 0.0, 5.0);
    scene.light_visualization = false;
    assert_eq!(middle(&scene), [70, 65, 90], "hidden markers are not there");
    let mut blocker = scene.objects[0].clone();
    blocker.name = "Blocker".to_owned();
    scene.lights[0].position = DVec3::new(10.0, 0.0, 10.0);
    blocker.shape = Shape::Sphere(Sphere {
        center: DVec3::new(5.0, 0.0, 5.5),
        radius: 1.0,
    });
    let lit = middle(&scene);
    scene.objects.push(blocker);
    assert_eq!(
        middle(&scene),
        [20, 40, 60],
        "only ambient is left of {lit:?}"
    );
    scene.objects[1].visible = false;
    assert_eq!(middle(&scene), lit);
}

#[test]
fn a_marker_is_full_ambient_and_nothing_else() {
    let mut scene = ball();
    scene.lights[0].position = DVec3::new(0.0, 0.0, 5.0);
    assert_eq!(middle(&scene), [255, 255, 0]);
    scene.packs_mut()["light"].ambient = DVec3::new(10.0, 20.0, 30.0);
    assert_eq!(middle(&scene), [10, 20, 30]);
}

#[test]
fn a_mirror_adds_the_sum_of_intensities_even_in_shadow() {
    let mut scene = ball();
    scene.background = DVec3::new(200.0, 0.0, 0.0);
    scene.packs_mut()["pack 1"].reflective = true;
    scene.packs_mut()["pack 1"].specular = DVec3::new(255.0, 255.0, 255.0);
    // Behind the ball: no diffuse light, no highlight, but the reflection stays: 0.5·ambient + 0.5·200.
    scene.lights[0].position = DVec3::new(0.0, 0.0, -50.0);
    scene.light_visualization = false;
    assert_eq!(middle(&scene), [120, 40, 60]);
    scene.render.reflection_limit = 0;
    assert_eq!(middle(&scene), [20, 40, 60]);
}

#[test]
fn a_camera_inside_a_ball_sees_its_lit_wall() {
    let mut scene = ball();
    scene.objects[0].shape = Shape::Sphere(Sphere {
        center: DVec3::new(0.0, 0.0, 0.0),
        radius: 100.0,
    });
    assert_eq!(
        middle(&scene),
        [70, 65, 90],
        "the inner wall faces the light inside"
    );
    scene.lights[0].position = DVec3::new(0.0, 0.0, 300.0);
    assert_eq!(
        middle(&scene),
        [20, 40, 60],
        "the near wall shadows a light outside"
    );
}

#[test]
fn what_is_left_out_would_not_have_shown() {
    // Any formula but the default ones disables all culling, so that its failures show. The classic triangle is
    // such a formula, and differs by itself on a few pixels along edges.
    for scene in (0..8).map(|n| random::scene(2 * n)).chain([Scene::demo()]) {
        let mut scene = scene;
        scene.lights[0].position.y = -300.0;
        let everything = Methods {
            triangle: TriangleMethod::Edges,
            ..Methods::default()
        };
        let at = |methods| {
            let wanted = RenderRequest {
                methods,
                ..RenderRequest::sized(256, 192)
            };
            picture(&scene, &wanted).0
        };
        let differ = differing(&at(Methods::default()), &at(everything), 0);
        assert!(differ <= 25, "{differ} pixels differ");
    }
}

#[test]
fn degenerate_lights_and_views_stay_finite() {
    let mut scene = ball();
    scene.light_visualization = false;
    scene.lights[0].position = DVec3::new(0.0, 0.0, 1.0);
    assert_eq!(
        middle(&scene),
        [20, 40, 60],
        "a light in the surface adds nothing"
    );
    scene.objects[0].shape = Shape::Plane(Plane {
        point: DVec3::new(0.0, 0.0, 0.0),
        normal: DVec3::new(0.0, 1.0, 0.0),
    });
    scene.camera.projection = Projection::Orthographic;
    scene.background = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(
        middle(&scene),
        [1, 2, 3],
        "a plane seen edge-on is not seen"
    );
}

#[test]
fn rays_are_traced_only_where_they_can_show() {
    let mut scene = Scene::demo();
    let count = |scene: &Scene| picture(scene, &RenderRequest::sized(160, 160)).1;
    let full = count(&scene);
    assert!(full.shadow > 0 && full.reflected > 0);
    scene.packs_mut()["plane"].reflective = false;
    let matte = count(&scene);
    assert_eq!(matte.reflected, 0);
    assert!(matte.shadow < full.shadow);
    for light in scene.lights.iter_mut() {
        light.intensity = 0.0;
    }
    assert_eq!(
        count(&scene),
        Rays {
            camera: 25_600,
            shadow: 0,
            reflected: 0,
            again: 0
        }
    );
}
