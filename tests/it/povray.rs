//! The referee: POV-Ray, an engine with which Glint shares no code, draws the same pictures.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use glam::DVec3;
use glint::image::{Image, render};
use glint::plan::RenderRequest;
use glint::scene::{
    ColorPack, Disc, Methods, Plane, Projection, RayOffset, Scene, Shape, Sphere, Triangle,
};
use glint::trace::RenderControl;

use crate::random;

fn vector(v: DVec3) -> String {
    format!("<{:?},{:?},{:?}>", v.x, v.y, v.z)
}

fn color(v: DVec3) -> String {
    format!("rgb {}", vector(v * (1.0 / 255.0)))
}

/// The scene in POV-Ray's language. Needs grey specular colours.
fn translate(scene: &Scene) -> String {
    let mut pov = String::new();
    let total: f64 = scene.lights.iter().map(|light| light.intensity).sum();
    let level = scene.render.reflection_limit + 1;
    let _ = writeln!(
        pov,
        "#version 3.7;\nglobal_settings {{ assumed_gamma 1 max_trace_level {level} adc_bailout 0 ambient_light rgb {:?} }}\nbackground {{ {} }}",
        scene.ambient_intensity,
        color(scene.background)
    );
    translate_camera(&mut pov, scene);
    for light in &scene.lights {
        let _ = writeln!(
            pov,
            "light_source {{ {} rgb {:?} }}",
            vector(light.position),
            light.intensity
        );
        if let Some(marker) = light.marker.as_ref().filter(|_| scene.light_visualization) {
            let pack = &scene.color_packs[&marker.color_pack];
            let _ = writeln!(
                pov,
                "sphere {{ {}, {:?} pigment {{ {} }} finish {{ ambient 0 diffuse 0 emission 1 }} no_shadow }}",
                vector(light.position),
                marker.radius,
                color(pack.ambient)
            );
        }
    }
    for object in &scene.objects {
        let texture = texture(&scene.color_packs[&object.color_pack], total);
        let _ = match &object.shape {
            Shape::Sphere(Sphere { center, radius }) => {
                writeln!(
                    pov,
                    "sphere {{ {}, {radius:?} {texture} }}",
                    vector(*center)
                )
            }
            Shape::Plane(Plane { point, normal }) => {
                let n = normal.try_normalize().expect("checked");
                writeln!(
                    pov,
                    "plane {{ {}, {:?} {texture} }}",
                    vector(n),
                    n.dot(*point)
                )
            }
            Shape::Disc(Disc {
                center,
                normal,
                radius,
            }) => {
                writeln!(
                    pov,
                    "disc {{ {}, {}, {radius:?} {texture} }}",
                    vector(*center),
                    vector(*normal)
                )
            }
            Shape::Mesh(mesh) => {
                let transform = mesh.transform();
                let _ = writeln!(pov, "mesh {{");
                for corners in mesh.source.triangles().corners() {
                    let [a, b, c] = corners.map(|p| vector(transform.transform_point3(p)));
                    let _ = writeln!(pov, "triangle {{ {a}, {b}, {c} }}");
                }
                writeln!(pov, "{texture} }}")
            }
            Shape::Triangle(Triangle { a, b, c }) => {
                writeln!(
                    pov,
                    "triangle {{ {}, {}, {} {texture} }}",
                    vector(*a),
                    vector(*b),
                    vector(*c)
                )
            }
        };
    }
    pov
}

fn translate_camera(pov: &mut String, scene: &Scene) {
    let camera = &scene.camera;
    let basis = camera.basis().expect("checked");
    let aspect = f64::from(scene.render.width) / f64::from(scene.render.height);
    let (kind, scale, distance) = match camera.projection {
        Projection::Perspective => ("perspective", 1.0, camera.projection_distance),
        Projection::Orthographic => ("orthographic", camera.orthographic_height, 1.0),
    };
    let _ = writeln!(
        pov,
        "camera {{ {kind} location {} direction {} right {} up {} }}",
        vector(camera.position),
        vector(-basis.z_axis * distance),
        vector(basis.x_axis * (scale * aspect)),
        vector(basis.y_axis * scale)
    );
}

fn texture(pack: &ColorPack, total_intensity: f64) -> String {
    let share = DVec3::new(
        pack.ambient.x / pack.diffuse.x,
        pack.ambient.y / pack.diffuse.y,
        pack.ambient.z / pack.diffuse.z,
    );
    let specular = pack.specular.x / 255.0;
    let mirror = if pack.reflective {
        total_intensity * specular
    } else {
        0.0
    };
    format!(
        "pigment {{ {} }} finish {{ ambient rgb {} diffuse 1 specular {specular:?} roughness {:?} reflection {{ rgb {mirror:?} }} }}",
        color(pack.diffuse),
        vector(share),
        1.0 / pack.phong_exponent
    )
}

fn by_povray(scene: &Scene, folder: &Path) -> Image {
    std::fs::write(folder.join("scene.pov"), translate(scene)).expect("written");
    let (width, height) = (scene.render.width, scene.render.height);
    let run = Command::new("povray")
        .args([
            "+Iscene.pov",
            "+Oscene.png",
            "-D",
            "+FN8",
            "-A",
            "Dither=off",
            "File_Gamma=1.0",
        ])
        .args([format!("+W{width}"), format!("+H{height}")])
        .current_dir(folder)
        .output()
        .expect("povray is installed (Debian package povray)");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    let picture = image::open(folder.join("scene.png"))
        .expect("a picture")
        .to_rgba8();
    let pixels = picture.pixels().map(|pixel| pixel.0).collect();
    Image {
        width: width as usize,
        height: height as usize,
        pixels,
    }
}

fn by_glint(scene: &Scene, methods: Methods) -> Image {
    let picture = RenderRequest {
        methods,
        ..RenderRequest::sized(scene.render.width, scene.render.height)
    };
    render(scene, &picture, &RenderControl::default())
        .expect("not stopped")
        .0
}

/// How many of a million pixels differ by more than one level of 255 in some channel.
fn different_ppm(a: &Image, b: &Image) -> usize {
    let differ = |(a, b): &(&[u8; 4], &[u8; 4])| (0..3).any(|c| a[c].abs_diff(b[c]) > 1);
    a.pixels.iter().zip(&b.pixels).filter(differ).count() * 1_000_000 / a.pixels.len()
}

#[test]
#[ignore = "needs POV-Ray (Debian package povray)"]
fn povray_draws_the_same_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let [front, mut side] = random::published();
    let mut scenes = vec![("demo".to_owned(), front)];
    scenes.push(("demo, second camera".to_owned(), side.clone()));
    side.camera.projection = Projection::Orthographic;
    scenes.push(("demo, orthographic".to_owned(), side));
    scenes.extend((0..14).map(|seed| (format!("random {seed}"), random::scene(seed))));
    scenes.extend((0..4).map(|seed| {
        (
            format!("random {seed} with discs"),
            random::with_discs(seed),
        )
    }));
    for (name, mut scene) in scenes {
        scene.render.width = scene.render.width.min(512);
        scene.render.height = scene.render.height.min(512);
        let theirs = by_povray(&scene, folder.path());
        let ppm = different_ppm(&by_glint(&scene, Methods::default()), &theirs);
        println!("{name}: {ppm} ppm of the pixels differ by more than 1/255");
        assert!(ppm <= 1000, "{name}: {ppm} ppm");
    }
    // The referee can say no: shadow rays that start 20 units off their surface are another picture.
    let demo = Scene::demo();
    let wrong = Methods {
        offset: RayOffset::Fixed(20.0),
        ..Methods::default()
    };
    let ppm = different_ppm(&by_glint(&demo, wrong), &by_povray(&demo, folder.path()));
    assert!(ppm > 1000, "only {ppm} ppm");
}
