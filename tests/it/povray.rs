//! POV-Ray as the referee: an engine with which Glint shares no code renders the same pictures.

use std::process::Command;

use glint::export::{by_povray, povray_differences};
use glint::image::Image;
use glint::plan::RenderRequest;
use glint::scene::{EXAMPLES, Methods, Projection, RayOffset, Scene, Shape};
use glint::trace::RenderControl;

use crate::pictures::{differing, picture};
use crate::program::{done, glint, run};
use crate::random;

fn by_glint(scene: &Scene, methods: Methods) -> Image {
    let wanted = RenderRequest {
        methods,
        ..RenderRequest::sized(scene.render.width, scene.render.height)
    };
    picture(scene, &wanted).0
}

/// The number of pixels per million that differ by more than one level of 255 in some channel.
fn different_ppm(a: &Image, b: &Image) -> usize {
    differing(a, b, 1) * 1_000_000 / a.pixels.len()
}

/// Removes what POV-Ray interprets differently: colours above white, and smooth meshes.
fn dim_and_flatten(scene: &mut Scene) {
    scene.ambient_intensity *= 0.5;
    for index in 0..scene.lights.len() {
        scene.lights[index].intensity *= 0.5;
    }
    for index in 0..scene.objects.len() {
        if let Shape::Mesh(mesh) = &mut scene.objects[index].shape {
            mesh.smooth = 0.0;
        }
    }
}

#[test]
#[ignore = "needs POV-Ray (Debian package povray)"]
fn povray_draws_the_same_pictures() {
    let [front, mut side] = random::published();
    let mut scenes = vec![("demo".to_owned(), front)];
    scenes.push(("demo, second camera".to_owned(), side.clone()));
    side.camera.projection = Projection::Orthographic;
    scenes.push(("demo, orthographic".to_owned(), side));
    scenes.extend((0..50).map(|seed| (format!("random {seed}"), random::scene(seed))));
    for example in EXAMPLES {
        scenes.push((example.name.to_owned(), example.document().scene));
    }
    scenes.extend((0..4).map(|seed| {
        (
            format!("random {seed} with discs"),
            random::with_discs(seed),
        )
    }));
    for (name, mut scene) in scenes {
        scene.render.width = scene.render.width.min(512);
        scene.render.height = scene.render.height.min(512);
        // Where POV-Ray's model differs, the pictures are still close, and the same once the difference is removed.
        if !povray_differences(&scene).is_empty() {
            let theirs = by_povray(&scene, 2, &RenderControl::default()).expect("POV-Ray");
            let ppm = different_ppm(&by_glint(&scene, Methods::default()), &theirs.picture);
            println!("{name}, as it is: {ppm} ppm");
            assert!(ppm <= 10_000, "{name}: {ppm} ppm");
            dim_and_flatten(&mut scene);
        }
        let theirs = by_povray(&scene, 2, &RenderControl::default())
            .expect("POV-Ray (Debian package povray)");
        let ppm = different_ppm(&by_glint(&scene, Methods::default()), &theirs.picture);
        println!("{name}: {ppm} ppm of the pixels differ by more than 1/255");
        assert!(ppm <= 1000, "{name}: {ppm} ppm");
    }
    // The comparison can fail: with shadow rays that start 20 units off their surface, the picture is different.
    let demo = Scene::demo();
    let wrong = Methods {
        offset: RayOffset::Fixed(20.0),
        ..Methods::default()
    };
    let theirs = by_povray(&demo, 2, &RenderControl::default()).expect("POV-Ray");
    let ppm = different_ppm(&by_glint(&demo, wrong), &theirs.picture);
    assert!(ppm > 1000, "only {ppm} ppm");
}

#[test]
#[ignore = "needs POV-Ray (Debian package povray)"]
fn the_line_that_convert_says_draws_the_scene_wherever_that_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let demo = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron");
    for name in ["plain", "my scene", "it's;#1"] {
        let file = format!("{name}.pov");
        let mut convert = glint(&["convert", demo, "-o", &file]);
        let said = done(convert.current_dir(folder.path()));
        let (_, line) = said.split_once("draw it with ").expect("a line");
        let line = format!("{} +W16 +H16", line.trim());
        let output = run(Command::new("sh")
            .args(["-c", &line])
            .current_dir(folder.path()));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{line}: {said}");
        assert!(folder.path().join(format!("{name}.png")).exists(), "{line}");
    }
}
