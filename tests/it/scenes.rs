//! Scene files: the published ones, invalid ones, and how they are saved to disk.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;
use glint::plan::RenderRequest;
use glint::scene::{
    Document, Plane, RayOffset, Sampling, Scene, SceneError, Shape, Sphere, Triangle, check,
};
use proptest::prelude::*;

/// The scene files in a folder of the project, sorted.
pub fn files_in(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("a folder");
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "ron"))
        .collect();
    files.sort();
    files
}

/// The message of an error after the file's name, without the lines that show the position.
fn said(path: &Path, error: &SceneError) -> String {
    let text = error.to_string();
    let first = text.lines().next().unwrap_or_default();
    first
        .strip_prefix(&format!("{}:", path.display()))
        .unwrap_or(first)
        .to_owned()
}

#[test]
fn every_bad_scene_is_refused_in_the_words_of_its_first_line() {
    let files = files_in("tests/it/bad_scenes");
    assert!(files.len() >= 40, "{}", files.len());
    for path in files {
        let bytes = fs::read(&path).expect("readable");
        let text = String::from_utf8_lossy(&bytes);
        let expected = text
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("// "));
        let error = Document::load(&path).expect_err("refused");
        assert_eq!(
            Some(said(&path, &error).as_str()),
            expected,
            "{}",
            path.display()
        );
    }
}

#[test]
fn a_refusal_shows_the_line_and_points_at_the_place() {
    let text = "Scene(\n    version: 1,\n    ambient_intensity: 7,\n    objects: [],\n)\n";
    let error = Document::from_text(text).expect_err("refused").to_string();
    let expected = "scene:3:24: ambient_intensity must be between 0 and 1, found 7\n 3 |     ambient_intensity: 7,\n   |                        ^";
    assert_eq!(error, expected);
}

#[test]
fn what_it_is_traced_with_is_kept_and_the_default_is_not_written() {
    let text = "Scene(version: 1, objects: [], render: Render(antialias: \"grid:3\", precision: \"f64\", sphere: \"classic\", triangle: \"edge-planes\", offset: \"relative:0.01\", specular: \"log1p\", accelerator: \"bvh\"))";
    let document = Document::from_text(text).expect("a scene");
    let written = document.to_text().expect("writable");
    assert_eq!(Document::from_text(&written).expect("a scene"), document);
    for word in [
        "grid:3",
        "f64",
        "classic",
        "edge-planes",
        "relative:0.01",
        "log1p",
        "bvh",
    ] {
        assert!(
            written.contains(&format!("\"{word}\"")),
            "{word} in {written}"
        );
    }
    let picture = RenderRequest::still(&document.scene);
    assert_eq!(picture.methods.offset, RayOffset::Relative(0.01));
    assert_eq!(picture.sampling, Sampling::Grid(3));
    let plain = Document::of(Scene::empty()).to_text().expect("writable");
    assert!(!plain.contains("antialias") && !plain.contains("offset"));
}

/// Users' files contain these words, so they remain valid whatever the program calls them.
#[test]
fn a_file_with_every_word_is_read_and_written_again() {
    let text = r#"Scene(
    version: 1,
    camera: Camera(position: (0, 0, 9), look_at: (0, 0, -1), projection: Orthographic),
    color_packs: {"a": ColorPack(ambient: (1, 2, 3))},
    lights: [Light(name: "Lamp", position: (0, 9, 0), marker: Some(LightObj(radius: 5, color_pack: "a")))],
    objects: [
        Object(name: "S", color_pack: "a", shape: Sphere(center: (0, 0, 0), radius: 1)),
        Object(name: "P", color_pack: "a", shape: Plane(point: (0, 0, 0), normal: (0, 1, 0))),
        Object(name: "T", color_pack: "a", shape: Triangle(a: (0, 0, 0), b: (1, 0, 0), c: (0, 1, 0))),
        Object(name: "D", color_pack: "a", shape: Disc(center: (0, 0, 0), normal: (0, 1, 0), radius: 1)),
    ],
    animation: Animation(keys: [
        Key(time: 0, value: Camera(position: (0, 0, 9), look_at: (0, 0, -1), projection: Perspective), interpolation: Smooth, easing: Even),
        Key(time: 1, value: Camera(position: (0, 0, 8), look_at: (0, 0, -1)), interpolation: Linear, easing: In),
        Key(time: 2, value: Camera(position: (0, 0, 7), look_at: (0, 0, -1)), interpolation: Hold, easing: Out),
        Key(time: 3, value: Camera(position: (0, 0, 6), look_at: (0, 0, -1)), interpolation: Orbit(around: (0, 0, 0)), easing: InOut),
    ]),
)"#;
    let document = Document::from_text(text).expect("a scene");
    let written = document.to_text().expect("writable");
    for word in [
        "Orthographic",
        "LightObj(",
        "Sphere(",
        "Plane(",
        "Triangle(",
        "Disc(",
        "Linear",
        "Hold",
        "Orbit(",
        "easing: In)",
        "easing: Out)",
        "easing: InOut)",
    ] {
        assert!(written.contains(word), "{word} is not in\n{written}");
    }
    assert_eq!(Document::from_text(&written).expect("a scene"), document);
}

#[test]
fn a_long_line_is_shown_around_the_place_only() {
    let objects =
        "Object(name: \"x\", color_pack: \"plane\", shape: Sphere(center: (0, 0, 0), radius: 0)), "
            .repeat(300);
    let text = format!("Scene(version: 1, objects: [{objects}])");
    let error = Document::from_text(&text).expect_err("refused").to_string();
    assert!(
        error.lines().all(|line| line.chars().count() < 120),
        "{error}"
    );
    let caret = error.lines().last().expect("a caret").chars().count() - 1;
    let shown = error.lines().nth(1).expect("the line").chars().nth(caret);
    assert_eq!(shown, Some('0'));
}

#[test]
fn emptiness_and_size_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.ron");
    fs::write(&path, "").expect("written");
    let error = Document::load(&path).expect_err("empty");
    assert_eq!(
        said(&path, &error),
        "1:1: the file ends here; expected Scene(…)"
    );
    let file = fs::File::create(&path).expect("made");
    file.set_len(1 << 40).expect("a sparse terabyte");
    let error = Document::load(&path).expect_err("too large").to_string();
    assert!(
        error.contains("a scene file may have at most 268435456 bytes; this one has 1099511627776"),
        "{error}"
    );
    let error = Document::load(&folder.path().join("none.ron"))
        .expect_err("missing")
        .to_string();
    assert!(
        error.starts_with("cannot read ") && error.contains("No such file"),
        "{error}"
    );
}

#[test]
fn published_scenes_are_valid_and_saved_as_they_stand() {
    let files = files_in("scenes");
    assert!(files.len() >= 4);
    for path in files {
        let text = fs::read_to_string(&path).expect("readable");
        let document = Document::load(&path).expect("valid");
        assert_eq!(
            document.to_text().expect("text"),
            text,
            "{}",
            path.display()
        );
    }
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn the_demo_has_every_number_of_the_report() {
    let demo = Scene::demo();
    let vector = |[x, y, z]: [f64; 3]| DVec3::new(x, y, z);
    let sphere = |center, radius| {
        Shape::Sphere(Sphere {
            center: vector(center),
            radius,
        })
    };
    let triangle = |a, b, c| {
        Shape::Triangle(Triangle {
            a: vector(a),
            b: vector(b),
            c: vector(c),
        })
    };
    let (p, q, r, s, top) = (
        [175.0, 5.0, -75.0],
        [225.0, 5.0, -75.0],
        [225.0, 5.0, -125.0],
        [175.0, 5.0, -125.0],
        [200.0, 55.0, -100.0],
    );
    let expected = [
        (
            "Sphere 1",
            sphere([125.0, 50.0, -150.0], 50.0),
            [255.0, 128.0, 255.0],
            false,
        ),
        (
            "Sphere 2",
            sphere([128.0, 41.0, -64.0], 20.0),
            [255.0, 128.0, 128.0],
            false,
        ),
        (
            "Triangle 1",
            triangle(p, top, q),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Triangle 2",
            triangle(q, top, r),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Triangle 3",
            triangle(r, top, s),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Triangle 4",
            triangle(s, top, p),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Triangle 5",
            triangle(r, s, p),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Triangle 6",
            triangle(q, r, p),
            [128.0, 255.0, 255.0],
            false,
        ),
        (
            "Plane",
            Shape::Plane(Plane {
                point: vector([0.0; 3]),
                normal: vector([0.0, 1.0, 0.0]),
            }),
            [255.0, 128.0, 128.0],
            true,
        ),
    ];
    assert_eq!(demo.objects.len(), expected.len());
    for (object, (name, shape, color, reflective)) in demo.objects.iter().zip(expected) {
        let pack = &demo.color_packs[&object.color_pack];
        assert_eq!((object.name.as_str(), &object.shape), (name, &shape));
        assert_eq!(
            (pack.ambient, pack.diffuse),
            (vector(color), vector(color)),
            "{name}"
        );
        assert_eq!(
            (pack.specular, pack.phong_exponent),
            (vector([255.0; 3]), 16.0),
            "{name}"
        );
        assert_eq!(pack.reflective, reflective, "{name}");
    }
    let lights = [[100.0, 100.0, -50.0], [231.0, 63.0, -127.0]];
    assert_eq!(demo.lights.len(), lights.len());
    for (light, position) in demo.lights.iter().zip(lights) {
        let marker = light.marker.as_ref().expect("a marker");
        let pack = &demo.color_packs[&marker.color_pack];
        assert_eq!(
            (light.position, light.intensity, marker.radius),
            (vector(position), 0.2, 5.0)
        );
        assert_eq!(
            (pack.ambient, pack.reflective),
            (vector([255.0, 255.0, 0.0]), false)
        );
    }
    assert_eq!(
        (demo.ambient_intensity, demo.background),
        (0.5, vector([0.0; 3]))
    );
}

#[test]
fn saving_keeps_the_header_and_backs_inner_comments_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.ron");
    let text = "// My scene.\n\n/* by me */\nScene(version: 1, objects: [ /* none yet */ ])";
    fs::write(&path, text).expect("written");
    let document = Document::load(&path).expect("valid");
    let backup = document.save(&path).expect("saved").expect("a backup");
    assert_eq!(fs::read_to_string(&backup).expect("kept"), text);
    let saved = fs::read_to_string(&path).expect("saved");
    assert!(
        saved.starts_with("// My scene.\n\n/* by me */\nScene(\n"),
        "{saved}"
    );
    assert_eq!(Document::load(&path).expect("valid"), document);
    assert_eq!(
        document.save(&path).expect("saved again"),
        None,
        "nothing is lost the second time"
    );
}

#[test]
#[cfg(unix)]
fn saving_follows_links_and_keeps_permissions() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().expect("a folder");
    let (real, link) = (
        folder.path().join("real.ron"),
        folder.path().join("link.ron"),
    );
    fs::write(&real, "old").expect("written");
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).expect("set");
    symlink(&real, &link).expect("linked");
    let document = Document::of(Scene::demo());
    document.save(&link).expect("saved");
    assert!(
        fs::symlink_metadata(&link)
            .expect("there")
            .file_type()
            .is_symlink()
    );
    assert_eq!(
        fs::metadata(&real).expect("there").permissions().mode() & 0o777,
        0o640
    );
    assert_eq!(Document::load(&real).expect("valid").scene, Scene::demo());
    // Saving through a link to a file that does not exist creates that file.
    let (new, early) = (
        folder.path().join("new.ron"),
        folder.path().join("early.ron"),
    );
    symlink("new.ron", &early).expect("linked");
    document.save(&early).expect("saved");
    assert!(
        new.is_file()
            && fs::symlink_metadata(&early)
                .expect("there")
                .file_type()
                .is_symlink()
    );
}

#[test]
fn a_save_that_fails_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a folder");
    let document = Document::of(Scene::demo());
    let inside = folder.path().join("missing").join("scene.ron");
    let error = document
        .save(&inside)
        .expect_err("no such folder")
        .to_string();
    assert!(error.starts_with("cannot write "), "{error}");
    // A folder has the name of the file: the temporary file with the new text must be removed.
    let taken = folder.path().join("taken.ron");
    fs::create_dir(&taken).expect("made");
    document.save(&taken).expect_err("a folder is in the way");
    let left: Vec<_> = fs::read_dir(folder.path()).expect("there").collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

proptest! {
    #[test]
    fn damaged_texts_are_refused_without_a_panic(at in 0.0..1.0_f64, cut in 0..40_usize, put in "[-0-9a-zA-Z(){}\\[\\],:.\"/* \n]{0,6}") {
        let text = glint::scene::DEMO_TEXT;
        let start = (at * text.len() as f64) as usize;
        let end = (start + cut).min(text.len());
        let damaged = format!("{}{put}{}", &text[..start], &text[end..]);
        match Document::from_text(&damaged) {
            Ok(document) => prop_assert_eq!(check(&document.scene), Ok(())),
            Err(error) => prop_assert!(error.to_string().starts_with("scene:"), "{}", error),
        }
    }

    #[test]
    fn any_scene_survives_its_file(seed in 0..1000_u64, x in prop::num::f64::NORMAL, y in -1e12..1e12_f64) {
        let mut scene = crate::random::scene(seed);
        scene.camera.position = DVec3::new(x.clamp(-1e12, 1e12), y, -0.0);
        let document = Document { header: "// seed\n".to_owned(), scene };
        let text = document.to_text().expect("text");
        let back = Document::from_text(&text).expect("valid");
        prop_assert_eq!(&back.to_text().expect("text"), &text);
        prop_assert_eq!(back, document);
    }
}
