//! Numerical limits: where weaker methods fail, the robust ones hold. Each check shows a weaker method to fail,
//! which proves that the check can fail. Every row runs with few tries in `cargo test` and with all of them in CI.
//!
//! Rows that need the internals of a kernel are tested beside it: refined hits and planets in
//! `primitive/sphere.rs`, leaks in `primitive/triangle`, grazing planes in `primitive/plane.rs`, highlights in
//! `simd/highlight.rs`, mouse moves in `editor/fly.rs`, paths in `animate/tests`; shadow rays at every scale and
//! position, for single shapes and for meshes, are stability maps of the lab.

use glam::DVec3;
use glint::plan::RenderRequest;
use glint::primitive::{PackedSphere, Primitive as _, Ray};
use glint::scene::{
    Accelerator, Camera, ColorPack, Methods, Object, Plane, Precision, Projection, RayOffset,
    Scene, Shape, Sphere, SphereMethod, Triangle,
};
use glint::simd::{Real, Vec3};

use crate::pictures::{differing, picture};

/// The t > 0 at which the ray hits the sphere; infinity if it misses.
fn meet_sphere<R: Real>(method: SphereMethod, ray: &Ray<R>, sphere: &PackedSphere<R>) -> R {
    let methods = Methods {
        sphere: method,
        ..Methods::default()
    };
    sphere.intersect_single(ray, &methods)
}

/// A row: its name, and its check, which takes the number of tries per case.
type Row = (&'static str, fn(u32));

const ROWS: &[Row] = &[
    ("spheres far away, single precision", far_spheres),
    ("spheres far away, double precision", far_spheres_in_double),
    ("an eye just above a huge ball", low_over_a_planet),
    ("viewing directions of any length", unnormalised_cameras),
    ("trees of flat things on their own borders", flat_trees),
    ("shadows that touch what casts them", contact_shadows),
    ("light inside and outside a hollow ball", hollow_balls),
    (
        "lights, exponents and planes that degenerate",
        degenerate_shading,
    ),
    ("thirty-two mirror images", many_mirrors),
];

#[test]
fn every_row_holds_for_few_tries() {
    for (name, row) in ROWS {
        println!("{name}");
        row(2_000);
    }
}

#[test]
#[ignore = "much computing: every row with all its tries"]
fn every_row_holds_for_all_tries() {
    for (name, row) in ROWS {
        println!("{name}");
        row(200_000);
    }
}

const U: f64 = 5.960_464_477_539_063e-8;

/// Deterministic, evenly distributed numbers: Weyl's sequence.
fn share(n: u32, stream: u32) -> f64 {
    let speeds = [
        0.754_877_666_246_693,
        0.569_840_290_998_053,
        0.430_159_709_001_947,
    ];
    let speed = speeds[stream as usize % 3] + f64::from(stream / 3) * 0.117_323;
    (f64::from(n + 1) * speed).fract()
}

/// A ray from a distance of `ratio` radii that passes a unit sphere at `miss` radii from its centre.
fn aimed<R: Real>(n: u32, ratio: f64, miss: f64) -> (Ray<R>, PackedSphere<R>) {
    let (a, b) = (share(n, 0) * std::f64::consts::TAU, share(n, 1) * 3.0 - 1.5);
    let towards = DVec3::new(a.cos() * b.cos(), b.sin(), a.sin() * b.cos());
    let c = share(n, 2) * std::f64::consts::TAU;
    let aside = towards.cross(DVec3::new(c.cos(), 0.3, c.sin()));
    let aside = aside.try_normalize().expect("not along the ray");
    let sphere = PackedSphere {
        center: Vec3::from_dvec3(towards * ratio + aside * miss),
        radius: R::ONE,
        material: 0,
    };
    let ray = Ray {
        origin: Vec3::from_dvec3(DVec3::splat(0.0)),
        direction: Vec3::from_dvec3(towards),
    };
    (ray, sphere)
}

/// The exact distance to the sphere, computed from the rounded inputs.
fn truth(ray: &Ray<f32>, sphere: &PackedSphere<f32>) -> f64 {
    let (c, d) = (sphere.center.to_dvec3(), ray.direction.to_dvec3());
    let d = d.try_normalize().expect("a direction");
    let b = d.dot(c);
    let across = c - d * b;
    b - (1.0 - across.dot(across)).max(0.0).sqrt()
}

fn quantile(mut errors: Vec<f64>, share: f64) -> f64 {
    errors.sort_by(f64::total_cmp);
    errors[((errors.len() - 1) as f64 * share) as usize]
}

fn far_spheres(tries: u32) {
    for ratio in [1.5, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6] {
        let errors = |method| {
            let error = |n| {
                let (ray, sphere) = aimed::<f32>(n, ratio, 0.9 * share(n, 3));
                let t = f64::from(meet_sphere(method, &ray, &sphere));
                (t - truth(&ray, &sphere)).abs()
            };
            (0..tries).map(error).collect::<Vec<f64>>()
        };
        let stable = errors(SphereMethod::Stable);
        // A miss has an infinite error, so it is counted here, too.
        let misses = stable.iter().filter(|error| !error.is_finite()).count();
        assert_eq!(misses, 0, "missed at {ratio} radii");
        let worst = quantile(stable, 0.999);
        assert!(
            worst <= 4.0 * U * (ratio + 2.0),
            "{worst:e} at {ratio} radii"
        );
        let passes_by = |n: &u32| {
            let (ray, sphere) = aimed::<f32>(*n, ratio, 1.1 + share(*n, 3));
            meet_sphere(SphereMethod::Stable, &ray, &sphere).is_finite()
        };
        assert_eq!(
            (0..tries).filter(passes_by).count(),
            0,
            "hit at {ratio} radii"
        );
        if ratio == 1e4 {
            let classic = quantile(errors(SphereMethod::Classic), 0.9);
            assert!(classic > 0.1, "the classic formula must fail: {classic:e}");
        }
    }
}

fn far_spheres_in_double(tries: u32) {
    for ratio in [1e2, 1e4, 1e6, 1e8] {
        for n in 0..tries {
            let (ray, sphere) = aimed::<f64>(n, ratio, 0.9 * share(n, 3));
            let t = meet_sphere(SphereMethod::Stable, &ray, &sphere);
            let off = (ray.direction * t - sphere.center).length() - 1.0;
            // The error along the ray is at most 1 / cos times the error perpendicular to the surface.
            assert!(off.abs() <= 4e-7, "{off:e} at {ratio} radii");
        }
    }
    let missed = |n: &u32| {
        let (ray, sphere) = aimed::<f64>(*n, 1e8, 0.8 * share(*n, 3));
        !meet_sphere(SphereMethod::Classic, &ray, &sphere).is_finite()
    };
    assert!(
        (0..2000).filter(missed).count() > 100,
        "the classic one must fail"
    );
}

/// The single-precision kernel is not accurate enough; the plan recognizes that and uses double precision.
fn low_over_a_planet(tries: u32) {
    for height in [1e-1, 1e-3, 1e-5, 1e-7] {
        let errors = |is_double: bool| {
            let error = |n: u32| {
                let down = DVec3::new(share(n, 0) - 0.5, -1.0, share(n, 1) - 0.5);
                let down = Vec3::<f32>::from_dvec3(down.try_normalize().expect("a direction"));
                let y = 1.0 + height;
                // Rounded to single precision first, so that both kernels get the same numbers.
                let (y, d) = (
                    f64::from(y as f32),
                    down.to_dvec3().try_normalize().expect("unit"),
                );
                let half = -d.y * y;
                let exact =
                    (y - 1.0) * (y + 1.0) / (half + (half * half - (y - 1.0) * (y + 1.0)).sqrt());
                let t = if is_double {
                    meet_sphere(SphereMethod::Stable, &over::<f64>(y, d), &ball())
                } else {
                    let ray = over::<f32>(y, d);
                    f64::from(meet_sphere(SphereMethod::Stable, &ray, &ball()))
                };
                if exact > 0.0 {
                    (t - exact).abs() / exact
                } else {
                    0.0
                }
            };
            quantile((0..tries).map(error).collect(), 0.999)
        };
        let worst = errors(true);
        assert!(worst <= 4.0 * U, "{worst:e} at a height of {height}");
        if height == 1e-5 {
            assert!(errors(false) > 4.0 * U, "single precision must fail");
        }
    }
    let mut scene = Scene::empty();
    scene
        .objects
        .push(object("Planet", DVec3::new(0.0, -1e6, 0.0), 1e6));
    scene.camera.position = DVec3::new(0.0, 100.0, 0.0);
    let plan = glint::plan::needs(&scene, &RenderRequest::sized(64, 64));
    let precision = plan.iter().find(|need| need.what == "double precision");
    assert!(precision.is_some(), "the plan must take f64: {plan:?}");
}

fn over<R: Real>(y: f64, direction: DVec3) -> Ray<R> {
    Ray {
        origin: Vec3::from_dvec3(DVec3::new(0.0, y, 0.0)),
        direction: Vec3::from_dvec3(direction),
    }
}

fn ball<R: Real>() -> PackedSphere<R> {
    PackedSphere {
        center: Vec3::from_dvec3(DVec3::splat(0.0)),
        radius: R::ONE,
        material: 0,
    }
}

fn object(name: &str, center: DVec3, radius: f64) -> Object {
    Object::new(name, "pack 1", Sphere { center, radius })
}

fn unnormalised_cameras(_: u32) {
    let demo = Scene::demo();
    let here = picture(&demo, &RenderRequest::sized(96, 96)).0;
    for scale in [0.5, 3.0, 1e-9, 1e9] {
        let mut scene = demo.clone();
        scene.camera.look_at = demo.camera.look_at * scale;
        scene.camera.up = demo.camera.up * (1.0 / scale);
        let there = picture(&scene, &RenderRequest::sized(96, 96)).0;
        let differ = differing(&here, &there, 0);
        // Powers of two are exact; other factors cause one more rounding.
        let allowed = if scale == 0.5 { 0 } else { 2 };
        assert!(differ <= allowed, "scaled by {scale}");
    }
    for method in [SphereMethod::Stable, SphereMethod::Classic] {
        let nowhere = over::<f32>(3.0, DVec3::splat(0.0));
        assert!(
            !meet_sphere(method, &nowhere, &ball()).is_nan(),
            "{method:?}"
        );
    }
}

/// A wall of axis-aligned triangles, viewed so that pixel centres lie on their edges.
fn flat_trees(_: u32) {
    for away in [0.0, 1e4, 1e6] {
        let corner = |x: u32, y: u32| DVec3::new(f64::from(x) + away, f64::from(y), -away);
        let mut scene = Scene::empty();
        for n in 0..144_u32 {
            let (x, y) = (n % 12, n / 12);
            for (half, far) in [("a", corner(x, y + 1)), ("b", corner(x + 1, y))] {
                scene.objects.push(Object {
                    shape: Shape::Triangle(Triangle {
                        a: corner(x, y),
                        b: corner(x + 1, y + 1),
                        c: far,
                    }),
                    ..object(&format!("{n} {half}"), DVec3::splat(0.0), 1.0)
                });
            }
        }
        scene.camera = Camera {
            position: DVec3::new(6.0 + away, 6.0, 20.0 - away),
            look_at: DVec3::new(0.0, 0.0, -1.0),
            up: DVec3::new(0.0, 1.0, 0.0),
            projection: Projection::Orthographic,
            orthographic_height: 13.0,
            ..Camera::default()
        };
        let with = |accelerator| {
            let request = RenderRequest {
                accelerator,
                ..RenderRequest::sized(13 * 8 + 1, 13 * 8 + 1)
            };
            picture(&scene, &request).0
        };
        let list = with(Accelerator::List);
        assert!(list == with(Accelerator::Bvh), "{away} away");
        let side = 13 * 8 + 1;
        let middle = list.pixels[side / 2 * side + side / 2];
        assert_ne!(middle, list.pixels[0], "the wall is in the picture");
        let inside = (8..side - 8).flat_map(|y| (8..side - 8).map(move |x| (x, y)));
        let holes = inside.filter(|&(x, y)| list.pixels[y * side + x] == list.pixels[0]);
        assert_eq!(holes.count(), 0, "no edge lets a ray through, {away} away");
    }
}

/// The ground right behind an upright card is in its shadow: the gap is less than a hundred-thousandth of the card.
fn contact_shadows(_: u32) {
    let lit = |scale: f64, offset: RayOffset| {
        let mut scene = Scene::empty();
        scene.ambient_intensity = 0.0;
        let place = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * scale;
        let shapes = [
            Shape::Plane(Plane {
                point: DVec3::splat(0.0),
                normal: DVec3::new(0.0, 1.0, 0.0),
            }),
            Shape::Triangle(Triangle {
                a: place(0.0, 0.0, -0.5),
                b: place(0.0, 1.0, 0.0),
                c: place(0.0, 0.0, 0.5),
            }),
        ];
        for (shape, name) in shapes.into_iter().zip(["Floor", "Card"]) {
            scene.objects.push(Object {
                shape,
                ..object(name, DVec3::splat(0.0), 1.0)
            });
        }
        scene.lights[0].position = place(-3.0, 1.0, 0.0);
        scene.lights[0].intensity = 1.0;
        scene.lights[0].marker = None;
        scene.camera = Camera {
            position: place(1.0 + 2e-5, 1.0, 0.0),
            look_at: DVec3::new(-1.0, -1.0, 0.0),
            up: DVec3::new(0.0, 1.0, 0.0),
            projection: Projection::Orthographic,
            orthographic_height: 2e-5 * scale,
            ..Camera::default()
        };
        let request = RenderRequest {
            precision: Precision::Single,
            methods: Methods {
                offset,
                ..Methods::default()
            },
            ..RenderRequest::sized(32, 32)
        };
        let image = picture(&scene, &request).0;
        image.pixels.iter().filter(|pixel| pixel[0] > 0).count()
    };
    for scale in [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6] {
        assert_eq!(lit(scale, RayOffset::Robust), 0, "at scale {scale}");
    }
    assert_eq!(
        lit(1.0, RayOffset::Fixed(0.1)),
        32 * 32,
        "a fixed offset must leave a gap"
    );
}

/// A camera inside a sphere: a light inside lights all of the wall, one outside lights none of it.
fn hollow_balls(_: u32) {
    for radius in [1e-4, 1.0, 1e6] {
        for away in [0.0, 1e4] {
            let center = DVec3::new(0.6, -0.64, 0.48) * (away * radius);
            let dark = |distance: f64| {
                let mut scene = Scene::empty();
                scene.ambient_intensity = 0.0;
                scene.objects.push(object("Ball", center, radius));
                scene.lights[0].position =
                    center + DVec3::new(0.1, 0.3, -0.2) * (distance * radius);
                scene.lights[0].intensity = 1.0;
                scene.lights[0].marker = None;
                scene.camera.position = center + DVec3::new(0.2, 0.1, 0.3) * radius;
                let request = RenderRequest {
                    precision: Precision::Single,
                    ..RenderRequest::sized(160, 160)
                };
                let image = picture(&scene, &request).0;
                image.pixels.iter().filter(|pixel| pixel[0] == 0).count()
            };
            assert_eq!(dark(1.0), 0, "radius {radius}, {away} away, light inside");
            assert_eq!(
                dark(9.0),
                160 * 160,
                "radius {radius}, {away} away, light outside"
            );
        }
    }
}

fn shaded(pack: ColorPack, light: DVec3, precision: Precision) -> [u8; 4] {
    let mut scene = Scene::empty();
    scene.ambient_intensity = 0.0;
    scene.background = DVec3::new(9.0, 9.0, 9.0);
    scene.packs_mut()["pack 1"] = pack;
    scene.objects.push(object("Ball", DVec3::splat(0.0), 1.0));
    scene.lights[0].position = light;
    scene.lights[0].intensity = 1.0;
    scene.lights[0].marker = None;
    scene.camera.position = DVec3::new(0.0, 0.0, 10.0);
    scene.camera.look_at = DVec3::new(0.0, 0.0, -1.0);
    scene.camera.up = DVec3::new(0.0, 1.0, 0.0);
    let request = RenderRequest {
        precision,
        ..RenderRequest::sized(3, 3)
    };
    picture(&scene, &request).0.pixels[4]
}

fn degenerate_shading(_: u32) {
    let pack = |phong_exponent: f64| ColorPack {
        ambient: DVec3::splat(0.0),
        diffuse: DVec3::splat(0.0),
        specular: DVec3::splat(255.0),
        phong_exponent,
        reflective: false,
    };
    for precision in [Precision::Single, Precision::Double] {
        for exponent in [0.0, 0.5, 16.0, 16.5, 1e4, 1e6, 1e7, 1e9] {
            let at = |z: f64| shaded(pack(exponent), DVec3::new(0.0, 0.0, z), precision);
            assert_eq!(at(20.0), [255; 4], "straight on, {exponent}");
            assert_eq!(at(1.0), [0, 0, 0, 255], "in the surface, {exponent}");
            assert_eq!(at(-20.0), [0, 0, 0, 255], "behind, {exponent}");
            assert_eq!(at(0.999_999), [0, 0, 0, 255], "just below, {exponent}");
        }
        // With exponent 0 the shade is flat, wherever the light is, provided it reaches the point.
        for x in [0.0, 5.0, 500.0] {
            let flat = shaded(pack(0.0), DVec3::new(x, 0.0, 20.0), precision);
            assert_eq!(flat, [255; 4], "exponent 0 from {x}");
        }
        // The light is opposite to the eye, on the horizon of the visible point: no highlight, and no NaN.
        let aside = shaded(pack(16.0), DVec3::new(1e12, 0.0, 1.0), precision);
        assert_eq!(aside, [0, 0, 0, 255]);
    }
}

/// Between two mirrors, single precision shows the same as double precision, down to the last image.
fn many_mirrors(_: u32) {
    let mut scene = Scene::empty();
    scene.ambient_intensity = 0.4;
    scene.render.reflection_limit = 32;
    let mut mirror = scene.color_packs["pack 1"].clone();
    mirror.reflective = true;
    mirror.specular = DVec3::splat(255.0);
    mirror.ambient = DVec3::splat(2.0);
    mirror.diffuse = DVec3::splat(0.0);
    scene.packs_mut().insert("mirror".to_owned(), mirror);
    for (name, z) in [("Front", -2.0), ("Back", 2.0)] {
        scene.objects.push(Object {
            color_pack: "mirror".to_owned(),
            shape: Shape::Plane(Plane {
                point: DVec3::new(0.0, 0.0, z),
                normal: DVec3::new(0.02, 0.0, 1.0),
            }),
            ..object(name, DVec3::splat(0.0), 1.0)
        });
    }
    scene
        .objects
        .push(object("Ball", DVec3::new(0.4, 0.2, -0.5), 0.3));
    scene.lights[0].position = DVec3::new(1.0, 3.0, 1.0);
    scene.lights[0].intensity = 1.0;
    scene.camera.position = DVec3::new(-0.3, 0.1, 1.5);
    scene.camera.look_at = DVec3::new(0.1, 0.0, -1.0);
    scene.camera.up = DVec3::new(0.0, 1.0, 0.0);
    let at = |precision| {
        let request = RenderRequest {
            precision,
            ..RenderRequest::sized(128, 128)
        };
        picture(&scene, &request).0
    };
    let (single, double) = (at(Precision::Single), at(Precision::Double));
    let far_off = differing(&single, &double, 1);
    assert!(far_off <= 8 * 128 * 128 / 1000, "{far_off} pixels differ");
}
