//! The views that show other quantities than light, compared with their expected values.

use glam::DVec3;
use glint::image::{LinearImage, render_light_into};
use glint::plan::{Planner, Region, RenderRequest};
use glint::scene::{Accelerator, Aspect, Light, Object, Precision, Sampling, Scene, Sphere};
use glint::trace::RenderControl;

use crate::pictures::picture;

fn light_of(scene: &Scene, request: &RenderRequest) -> LinearImage {
    let shown = request.aspect.of(scene);
    let mut image = LinearImage::default();
    let (planner, control) = (&mut Planner::default(), RenderControl::default());
    render_light_into(&mut image, planner, &shown, request, &control).expect("nobody stops it");
    image
}

/// A sphere of radius 10 around the origin, seen from z = 50 along -z, with one light far to the right.
fn ball() -> Scene {
    let mut scene = Scene::empty();
    scene.camera.position = DVec3::new(0.0, 0.0, 50.0);
    scene.camera.look_at = DVec3::NEG_Z;
    scene.camera.up = DVec3::Y;
    scene.objects.push(Object::new(
        "Ball",
        "pack 1",
        Sphere {
            center: DVec3::ZERO,
            radius: 10.0,
        },
    ));
    let light = |x: f64| Light {
        name: format!("Light at {x}"),
        position: DVec3::new(x, 0.0, 0.0),
        intensity: 0.3,
        marker: None,
        visible: true,
    };
    scene.lights = vec![light(1000.0), light(-1000.0), light(2000.0)].into();
    scene
}

#[test]
fn normals_depth_and_shadows_of_a_ball_are_those_of_geometry() {
    let scene = ball();
    for precision in [Precision::Single, Precision::Double] {
        for aspect in [Aspect::Normals, Aspect::Depth, Aspect::Shadows] {
            let request = RenderRequest {
                aspect,
                precision,
                ..RenderRequest::sized(101, 101)
            };
            let image = light_of(&scene, &request);
            let framing = scene.camera.framing().expect("a basis");
            let mut hits = 0;
            for row in 0..101_u32 {
                for column in 0..101_u32 {
                    let at = [
                        (f64::from(column) + 0.5 - 50.5) / 101.0,
                        (50.5 - f64::from(row) - 0.5) / 101.0,
                    ];
                    let (origin, direction) = framing.ray(at);
                    let b = origin.dot(direction);
                    let inside = b * b - origin.length_squared() + 100.0;
                    let pixel = image.pixels[(row * 101 + column) as usize];
                    if inside <= 0.0 {
                        assert_eq!(pixel, [0.0; 3], "{aspect:?} of the sky");
                        continue;
                    }
                    hits += 1;
                    let t = -b - inside.sqrt();
                    let normal = (origin + direction * t) / 10.0;
                    let expected = match aspect {
                        Aspect::Normals => normal * 0.5 + 0.5,
                        // The bounding sphere of a cube of side 20 begins at 50 - 10·√3, and is 20·√3 deep.
                        Aspect::Depth => {
                            let deep = 10.0 * 3.0_f64.sqrt();
                            DVec3::splat(1.0 - (t - (50.0 - deep)) / (2.0 * deep))
                        }
                        // Two of the lights are on the right.
                        _ if normal.x.abs() < 0.02 => continue,
                        _ if normal.x > 0.0 => DVec3::splat(2.0 / 3.0),
                        _ => DVec3::splat(1.0 / 3.0),
                    };
                    let found = DVec3::from(pixel.map(f64::from));
                    let off = (found - expected).abs().max_element();
                    assert!(off < 1e-4, "{aspect:?} {column},{row}: {found} {expected}");
                }
            }
            assert!(hits > 300, "{hits}");
        }
    }
}

#[test]
fn mirrors_alone_are_what_the_picture_without_them_lacks() {
    let mut scene = Scene::demo();
    scene.background = DVec3::new(30.0, 60.0, 90.0);
    let show = |aspect| {
        let request = RenderRequest {
            aspect,
            ..RenderRequest::sized(96, 96)
        };
        light_of(&scene, &request)
    };
    let [all, without, mirrors] = [Aspect::All, Aspect::WithoutMirrors, Aspect::Mirrors].map(show);
    let mut seen = 0;
    for n in 0..all.pixels.len() {
        for channel in 0..3 {
            let sum = without.pixels[n][channel] + mirrors.pixels[n][channel];
            let is_sky_or_marker = mirrors.pixels[n] == [0.0; 3];
            let off = (all.pixels[n][channel] - sum.min(1.0)).abs();
            assert!(off < 1e-5, "{n}: {off}");
            seen += usize::from(!is_sky_or_marker);
        }
    }
    assert!(seen > 1000, "{seen}");
}

#[test]
fn rays_per_pixel_are_more_where_edges_are() {
    let request = RenderRequest {
        aspect: Aspect::Cost,
        sampling: Sampling::ADAPTIVE,
        ..RenderRequest::sized(128, 128)
    };
    let image = light_of(&Scene::demo(), &request);
    let brightness = |pixel: &[f32; 3]| pixel.iter().sum::<f32>();
    let all: Vec<f32> = image.pixels.iter().map(brightness).collect();
    let (least, most) = (
        all.iter().copied().fold(f32::MAX, f32::min),
        all.iter().copied().fold(0.0, f32::max),
    );
    assert!(most > least + 0.5, "{least} to {most}");
    // In squares of eight pixels.
    for row in 0..128 {
        for column in 0..128 {
            let corner = row / 8 * 8 * 128 + column / 8 * 8;
            assert_eq!(image.pixels[row * 128 + column], image.pixels[corner]);
        }
    }
}

#[test]
fn a_part_has_the_same_pixels_as_the_whole_and_nothing_else() {
    let scene = Scene::demo();
    for sampling in [Sampling::Centres, Sampling::Grid(2), Sampling::ADAPTIVE] {
        let whole = RenderRequest {
            sampling,
            ..RenderRequest::sized(200, 150)
        };
        let part = RenderRequest {
            region: Some(Region {
                columns: (70, 101),
                rows: (40, 41),
            }),
            ..whole
        };
        let [whole, part] = [whole, part].map(|request| picture(&scene, &request).0);
        let mut traced = 0;
        for (n, (part, whole)) in part.pixels.iter().zip(&whole.pixels).enumerate() {
            let (column, row) = (n % 200, n / 200);
            let is_in = (70..101).contains(&column) && row == 40;
            assert!(part[3] == 255 || !is_in, "{column},{row}");
            if part[3] == 255 {
                traced += 1;
                assert_eq!(part, whole, "{column},{row}");
            }
        }
        assert!(
            (31..6000).contains(&traced),
            "{traced}: whole tiles, no more"
        );
    }
}

#[test]
fn what_mirrors_add_is_nothing_where_nothing_is_met_however_it_is_traced() {
    let mut scene = ball();
    scene.background = DVec3::splat(255.0);
    for pack in scene.packs_mut().values_mut() {
        pack.reflective = true;
        pack.specular = DVec3::splat(255.0);
    }
    for accelerator in [Accelerator::List, Accelerator::Bvh] {
        for sampling in [Sampling::Centres, Sampling::ADAPTIVE] {
            let request = RenderRequest {
                aspect: Aspect::Mirrors,
                accelerator,
                sampling,
                ..RenderRequest::sized(120, 120)
            };
            let image = light_of(&scene, &request);
            let case = format!("{accelerator:?} {sampling:?}");
            let at = |row: usize| &image.pixels[row * 120..][..120];
            assert!(at(60)[60][0] > 0.0, "{case}: the ball mirrors the sky");
            let sky = (0..20).chain(100..120).flat_map(at);
            assert!(sky.flatten().all(|channel| *channel == 0.0), "{case}");
        }
    }
}
