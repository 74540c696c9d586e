//! The command line, through the real binary.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::program::{self, run, stderr_of};

const DEMO: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron");
const BAD: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/it/bad_scenes/sphere_radius_zero.ron"
);

fn glint(folder: &Path, words: &[&str]) -> Output {
    let mut command = program::glint(words);
    for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(display);
    }
    run(command.current_dir(folder))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn render_writes_the_picture_and_one_json_object() {
    let folder = folder();
    let words = [
        "render",
        DEMO,
        "-o",
        "a.png",
        "--width",
        "96",
        "--height",
        "64",
        "--threads",
        "2",
        "--repeat",
        "3",
        "--antialias",
        "none",
        "--stats",
    ];
    let run = glint(folder.path(), &words);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let stats: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let mut keys: Vec<&String> = stats.as_object().expect("an object").keys().collect();
    keys.sort();
    assert_eq!(
        keys,
        [
            "height",
            "lanes",
            "rays",
            "threads",
            "trace_ms",
            "trace_ms_min",
            "width"
        ]
    );
    assert_eq!(
        (&stats["width"], &stats["height"], &stats["threads"]),
        (&96.into(), &64.into(), &2.into())
    );
    assert_eq!(stats["rays"]["camera"], 96 * 64);
    assert!(
        stats["rays"]["shadow"].as_u64() > Some(0) && stats["rays"]["reflected"].as_u64() > Some(0)
    );
    assert!(stats["trace_ms"].as_f64() >= stats["trace_ms_min"].as_f64());
    let lanes = stats["lanes"].as_str().expect("text");
    assert!(lanes.starts_with("f32×"), "{lanes}");
    let picture = image::open(folder.path().join("a.png")).expect("a picture");
    assert_eq!((picture.width(), picture.height()), (96, 64));
}

#[test]
fn a_sampling_is_chosen_by_what_was_asked_of_the_picture() {
    let folder = folder();
    let chosen = |goal: [&str; 2]| {
        let words = [&["render", DEMO, "--width", "96", "--stats"][..], &goal].concat();
        let run = glint(folder.path(), &words);
        assert!(run.status.success(), "{}", text(&run.stderr));
        let stats: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
        let chosen = &stats["chosen"];
        let antialias = chosen["antialias"].as_str().expect("a sampling");
        (antialias == "none", chosen["is_met"] == true)
    };
    // Which of the sufficiently accurate ones is fastest may vary on a busy machine.
    assert!(chosen(["--within", "1dB"]).1);
    assert_eq!(chosen(["--within", "50dB"]), (false, true));
    assert_eq!(chosen(["--within", "300dB"]), (false, false));
    assert!(!chosen(["--budget", "0ms"]).1);
    assert_eq!(chosen(["--budget", "1000s"]), (false, true));
    let words = [
        "render", DEMO, "-o", "a.ppm", "--width", "96", "--within", "55dB",
    ];
    let run = glint(folder.path(), &words);
    let said = text(&run.stdout);
    assert!(said.contains("the cheapest within 55.0 dB"), "{said}");
    for wrong in [
        &["--within", "55dB", "--antialias", "none"][..],
        &["--within", "55dB", "--budget", "1ms"],
        &["--within", "loud"],
        &["--within", "55"],
        &["--budget", "16min"],
    ] {
        let words = [&["render", DEMO, "-o", "a.ppm"][..], wrong].concat();
        assert_eq!(
            glint(folder.path(), &words).status.code(),
            Some(2),
            "{wrong:?}"
        );
    }
}

#[test]
fn formats_threads_and_repeats_give_the_same_pixels() {
    let folder = folder();
    for (name, extra) in [
        ("a.png", ["--threads", "1"]),
        ("b.ppm", ["--threads", "7"]),
        ("c.PNG", ["--repeat", "2"]),
    ] {
        let words = [&["render", DEMO, "-o", name, "--width", "120"][..], &extra].concat();
        assert!(glint(folder.path(), &words).status.success());
    }
    let pixels = ["a.png", "b.ppm", "c.PNG"].map(|name| {
        image::open(folder.path().join(name))
            .expect("a picture")
            .to_rgb8()
    });
    assert_eq!(
        pixels[0].dimensions(),
        (120, 120),
        "a width alone keeps the aspect"
    );
    assert!(pixels[0] == pixels[1] && pixels[1] == pixels[2]);
    assert!(
        std::fs::read(folder.path().join("b.ppm"))
            .expect("there")
            .starts_with(b"P6")
    );
}

#[test]
fn the_camera_can_be_chosen() {
    let folder = folder();
    for name in ["perspective", "orthographic"] {
        let file = format!("{name}.ppm");
        let words = [
            "render", DEMO, "-o", &file, "--width", "64", "--camera", name,
        ];
        assert!(glint(folder.path(), &words).status.success());
    }
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("there");
    assert_ne!(read("perspective.ppm"), read("orthographic.ppm"));
}

#[test]
fn wrong_words_and_wrong_files_exit_with_2() {
    let folder = folder();
    let cases: [(&[&str], &str); 20] = [
        (&["render", DEMO], "--output <IMAGE>"),
        (
            &["render", DEMO, "-o", "a.jpg"],
            "\"a.jpg\" does not end in a known picture format",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--width", "0"],
            "expected a whole number from 1 to 16384",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--width", "-1"],
            "expected a whole number from 1 to 16384",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--height", "1e3"],
            "expected a whole number from 1 to 16384",
        ),
        (
            &["render", DEMO, "--stats", "--repeat", "0"],
            "expected a whole number from 1 to 1000000",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--antialias", "contrast"],
            "expected none, adaptive, grid:N with N from 1",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--antialias", "grid:0"],
            "expected none, adaptive, grid:N with N from 1",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--triangle", "moeller"],
            "expected watertight, edges, moller-trumbore, edge-planes",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--frame", "3"],
            "there is no frame 3: the animation has 1 frame",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--accelerator", "octree"],
            "expected auto, list, bvh",
        ),
        (
            &["render", DEMO, "-o", "a.png", "--within", "-3dB"],
            "expected decibels such as 55dB",
        ),
        (
            &["render", BAD, "-o", "a.png"],
            "radius must be greater than 0, found 0",
        ),
        (
            &["render", "missing.ron", "-o", "a.png"],
            "cannot read missing.ron",
        ),
        (
            &["missing.ron", "--screenshot", "a.png"],
            "cannot read missing.ron",
        ),
        (
            &["--screenshot", "a.png", "--select", "Sphere 7"],
            "no object or light named \"Sphere 7\"",
        ),
        (&["export", DEMO], "--output <DIR>"),
        (&["check"], "<SCENE>..."),
        (
            &["rendr"],
            "there is no command \"rendr\"; the commands are render",
        ),
        (
            &["chek", DEMO],
            "there is no command \"chek\"; the commands are render, export, job, check, convert, plan, chart, stability, referee, and",
        ),
    ];
    for (words, expected) in cases {
        let run = glint(folder.path(), words);
        assert_eq!(run.status.code(), Some(2), "{words:?}");
        assert!(
            text(&run.stderr).contains(expected),
            "{words:?}: {}",
            text(&run.stderr)
        );
        assert!(run.stdout.is_empty(), "{words:?}: {}", text(&run.stdout));
    }
    let left = std::fs::read_dir(folder.path()).expect("there").count();
    assert_eq!(left, 0, "a refused command writes nothing");
}

#[test]
fn failed_work_exits_with_1_and_names_the_file() {
    // Work that would take minutes is not started.
    let cases: [&[&str]; 6] = [
        &["render", DEMO, "--width", "16384", "-o"],
        &["chart", DEMO, "--png"],
        &["chart", DEMO, "--csv"],
        &["stability", "--effort", "1000", "--csv"],
        &["stability", "--effort", "1000", "--png"],
        &["--screenshot"],
    ];
    for words in cases {
        let is_table = words.last() == Some(&"--csv");
        let path = if is_table {
            "no/such/folder/a.csv"
        } else {
            "no/such/folder/a.png"
        };
        let run = glint(folder().path(), &[words, &[path]].concat());
        assert_eq!(run.status.code(), Some(1), "{words:?}");
        let said = text(&run.stderr);
        let expected =
            format!("error: cannot write {path}: the folder no/such/folder does not exist");
        assert!(said.starts_with(&expected), "{words:?}: {said}");
    }
}

#[test]
fn check_answers_for_every_file() {
    let run = glint(folder().path(), &["check", DEMO, BAD]);
    assert_eq!(run.status.code(), Some(2));
    assert_eq!(
        text(&run.stdout),
        format!("{DEMO}: ok, 9 objects, 2 lights, 5 color packs\n")
    );
    let complaint = text(&run.stderr);
    assert!(
        complaint.contains(&format!(
            "{BAD}:4:102: radius must be greater than 0, found 0"
        )),
        "{complaint}"
    );
    assert!(complaint.trim_end().ends_with('^'), "{complaint}");
}

#[test]
fn a_missing_mesh_is_named_once_where_it_is_first_needed() {
    let folder = folder();
    let object = |name| {
        format!("Object(name: \"{name}\", color_pack: \"plane\", shape: Mesh(file: \"tree.ply\"))")
    };
    let objects = ["A", "B", "C"].map(object).join(",\n  ");
    let scene = format!("Scene(version: 1, objects: [\n  {objects}])");
    fs::write(folder.path().join("a.ron"), scene).expect("written");
    let run = glint(folder.path(), &["check", "a.ron"]);
    assert_eq!(run.status.code(), Some(2));
    let said = text(&run.stderr);
    let message = "a.ron:2:3: \"A\" and 2 more objects cannot be shown: cannot read ";
    assert!(said.contains(message), "{said}");
    assert_eq!(said.matches("tree.ply:").count(), 1, "{said}");
}

#[test]
fn plan_says_what_a_scene_needs() {
    let run = glint(folder().path(), &["plan", DEMO]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let said = text(&run.stdout);
    for expected in [
        "single precision",
        "reflected rays, up to 1 bounce",
        "shadow rays to 2 of 2 lights",
        "1 plane never tested for shadows",
    ] {
        assert!(said.contains(expected), "{said}");
    }
    let run = glint(folder().path(), &["plan", DEMO, "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let needs = json.as_array().expect("an array");
    assert_eq!(needs.len(), 11);
    assert!(needs.iter().all(|need| {
        ["rule", "what", "why", "saves"]
            .iter()
            .all(|key| need[key].is_string())
    }));
    // The savings of a tree are counted on this particular picture.
    let knot = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/knot.ron");
    let said = text(&glint(folder().path(), &["plan", knot]).stdout);
    assert!(
        said.contains("primitives instead of 24004 for each"),
        "{said}"
    );
    let run = glint(folder().path(), &["plan", BAD]);
    assert_eq!(run.status.code(), Some(2));
}

#[test]
fn help_and_version_are_results() {
    for (words, expected) in [
        (["--help"], "Usage: glint"),
        (["--version"], env!("CARGO_PKG_VERSION")),
    ] {
        let run = glint(folder().path(), &words);
        assert!(run.status.success() && text(&run.stdout).contains(expected));
    }
}

#[test]
fn without_a_display_the_editor_ends_in_a_picture() {
    let folder = folder();
    let run = glint(folder.path(), &[]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let said = text(&run.stderr);
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(
        said.contains("no window")
            && said.contains("libxkbcommon-x11-0")
            && said.contains("glint render"),
        "{said}"
    );
    assert!(!said.contains("panicked"), "{said}");
    let picture = image::open(folder.path().join("demo.png")).expect("a picture");
    assert_eq!((picture.width(), picture.height()), (1024, 1024));
    // A second run overwrites nothing.
    std::fs::write(folder.path().join("demo.png"), "mine").expect("written");
    assert!(glint(folder.path(), &[DEMO]).status.success());
    assert_eq!(
        std::fs::read(folder.path().join("demo.png")).expect("there"),
        b"mine"
    );
    assert!(folder.path().join("demo-2.png").exists());
    let bad = glint(folder.path(), &[BAD]);
    assert_eq!(bad.status.code(), Some(2));
    assert!(
        text(&bad.stderr).contains("radius must be greater than 0"),
        "{}",
        text(&bad.stderr)
    );
}

#[test]
fn chart_prints_the_front_and_writes_every_figure() {
    let folder = folder();
    let words = [
        "chart", DEMO, "--side", "16", "--csv", "c.csv", "--png", "c.png", "--within", "0.01",
    ];
    let run = glint(folder.path(), &words);
    assert!(run.status.success(), "{run:?}");
    let said = text(&run.stdout);
    assert!(
        said.contains("the original program") && said.contains("16×16; reference: f64"),
        "{said}"
    );
    assert!(said.lines().any(|line| line.starts_with("* ")), "{said}");
    assert!(
        said.lines()
            .last()
            .is_some_and(|line| line.starts_with("use ")),
        "{said}"
    );
    // Scenes, meshes and pictures are not overwritten.
    let scene = folder.path().join("own.ron");
    std::fs::copy(DEMO, &scene).expect("copied");
    for name in ["knot.ply", "p.png", "other.ron"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "precious").expect("written");
        for command in [&["chart", DEMO, "--side", "16"][..], &["stability"]] {
            let refused = glint(folder.path(), &[command, &["--csv", name]].concat());
            assert_eq!(refused.status.code(), Some(2), "{refused:?}");
        }
        assert_eq!(std::fs::read_to_string(&path).expect("there"), "precious");
        std::fs::remove_file(&path).expect("removed");
    }
    let refused = glint(
        folder.path(),
        &["chart", "own.ron", "--side", "16", "--csv", "./own.ron"],
    );
    assert_eq!(refused.status.code(), Some(2), "{refused:?}");
    assert!(std::fs::read(&scene).expect("there") == std::fs::read(DEMO).expect("there"));
    let chart = image::open(folder.path().join("c.png")).expect("a picture");
    assert_eq!((chart.width(), chart.height()), (1600, 960));
    let accent = image::Rgba([0xF2, 0xB1, 0x34, 255]);
    let front = chart.to_rgba8().pixels().filter(|p| **p == accent).count();
    assert!(front > 300, "{front} pixels of the front");
    let csv = std::fs::read_to_string(folder.path().join("c.csv")).expect("a file");
    let mut lines = csv.lines();
    let columns = lines.next().expect("a head").split(',').count();
    let measurements: Vec<&str> = lines.collect();
    assert!(measurements.len() > 30, "{}", measurements.len());
    for dot in measurements {
        // Texts are quoted and may contain commas.
        let plain: String = dot.split('"').step_by(2).collect();
        assert_eq!(plain.split(',').count(), columns, "{dot}");
        assert!(dot.contains("f32×") || dot.contains("f64×"), "{dot}");
    }
    let run = glint(
        folder.path(),
        &["chart", DEMO, "--side", "8", "--budget", "0.0000001"],
    );
    assert!(text(&run.stdout).contains("no measured method is within that limit"));
}

#[test]
fn chart_shares_a_picture_between_cores_that_do_not_exist() {
    let folder = folder();
    let words = [
        "chart", "--cores", DEMO, "--side", "256", "--csv", "c.csv", "--png", "c.png",
    ];
    let run = glint(folder.path(), &words);
    assert!(run.status.success(), "{run:?}");
    assert!(
        text(&run.stdout).contains("Demo                  128 cores,  256 pieces"),
        "{run:?}"
    );
    let csv = std::fs::read_to_string(folder.path().join("c.csv")).expect("a file");
    assert_eq!(csv.lines().count(), 9);
    assert!(image::open(folder.path().join("c.png")).is_ok());
}

#[test]
fn stability_tells_the_robust_from_the_rest() {
    let folder = folder();
    let run = glint(
        folder.path(),
        &["stability", "--csv", "s.csv", "--png", "s.png"],
    );
    assert!(run.status.success(), "{run:?}");
    let said = text(&run.stdout);
    for line in said
        .lines()
        .filter(|line| line.starts_with("* ") && line.contains('%'))
    {
        // Far below the width of a pixel, every sampling misses something.
        let is_robust = line.ends_with("nowhere") || line.contains("thin things");
        assert!(is_robust, "{line}");
    }
    for weak in [
        "classic",
        "edges",
        "moller-trumbore",
        "edge-planes",
        "fixed:0.1",
        "pow",
    ] {
        let line = said.lines().find(|line| line.contains(weak));
        assert!(
            line.is_some_and(|line| line.contains("% at ")),
            "{weak} in {said}"
        );
    }
    let maps = image::open(folder.path().join("s.png")).expect("a picture");
    assert!(maps.width() == 1600 && maps.height() >= 1000);
    let csv = std::fs::read_to_string(folder.path().join("s.csv")).expect("a file");
    let columns = csv.lines().next().expect("a head").split(',').count();
    assert!(csv.lines().count() > 800);
    assert!(csv.lines().all(|line| line.split(',').count() == columns));
}

#[test]
fn desktops_and_shells_are_told_of_the_program() {
    let folder = folder();
    let mut install = program::glint(&["--install-desktop"]);
    let run = run(install.env("XDG_DATA_HOME", folder.path()));
    assert!(run.status.success(), "{}", text(&run.stderr));
    for path in text(&run.stdout).lines() {
        assert!(Path::new(path).starts_with(folder.path()) && Path::new(path).is_file());
    }
    let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).expect(file);
    assert!(read("applications/glint.desktop").contains(env!("CARGO_BIN_EXE_glint")));
    let icon = image::open(folder.path().join("icons/hicolor/256x256/apps/glint.png"));
    assert_eq!(icon.expect("an icon").width(), 256);
    assert!(read("man/man1/glint.1").contains("Trace a scene and save the picture"));
    assert!(read("man/man1/glint-render.1").contains("antialias"));
    for completed in [
        "bash-completion/completions/glint",
        "zsh/site-functions/_glint",
        "fish/vendor_completions.d/glint.fish",
    ] {
        assert!(read(completed).contains("antialias"), "{completed}");
    }
}

#[test]
fn results_that_cannot_be_written_are_a_failure() {
    let Ok(full) = std::fs::File::options().write(true).open("/dev/full") else {
        return; // Not every system has a device that is always full.
    };
    for words in [
        &["plan", DEMO][..],
        &["check", DEMO],
        &["--help"],
        &["--version"],
    ] {
        let mut command = program::glint(words);
        let said = stderr_of(command.stdout(full.try_clone().expect("a second one")), 1);
        assert!(said.contains("could not be written to stdout"), "{said}");
    }
}
