//! Files: opening, saving, and the questions before something is lost.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glint::editor::{Action, Edit, Editor, Item, Selection, excerpt};
use glint::export::povray_text;
use glint::files::Stamp;
use glint::scene::{Document, Recovery, Scene, Shape};
use glint::ui::Ask;

use super::monkey::Unanswered;
use crate::harness::{CTRL, EditorHarness, radius};

#[test]
fn a_scene_is_saved_and_opened_through_dialogs() {
    let answers = |folder: &std::path::Path| {
        let path = folder.join("mine");
        vec![
            (Ask::SaveScene, Some(path)),
            (Ask::OpenScene, Some(folder.join("mine.ron"))),
        ]
    };
    let mut harness = EditorHarness::with(answers, None);
    harness.click("Sphere 1");
    harness.type_into("radius", "33");
    harness.press(Modifiers::COMMAND, Key::S);
    let path = harness.folder.path().join("mine.ron");
    let saved = Document::load(&path).expect("valid");
    assert_eq!(radius(&saved.scene, 0), 33.0);
    assert!(saved.header.starts_with("// The demo scene"));
    assert!(!harness.editor().is_dirty());
    assert_eq!(harness.editor().title(), "mine.ron");
    harness.press(Modifiers::COMMAND, Key::N);
    assert!(harness.scene().objects.is_empty());
    harness.press(Modifiers::COMMAND, Key::O);
    assert_eq!(harness.scene(), &saved.scene);
    harness.choose("File", "Open example");
    harness.click("demo");
    harness.press_button("File");
    harness.window.get_by_label_contains("Open recent").click();
    harness.settle();
    harness.click("mine.ron");
    assert_eq!(harness.scene(), &saved.scene);
}

#[test]
fn without_dialogs_a_path_is_typed() {
    let mut harness = EditorHarness::new();
    let path = harness.folder.path().join("typed.ron");
    harness.press(Modifiers::COMMAND, Key::S);
    let field = harness.window.get_by_label_contains("Path (this desktop");
    field.set_text_value_accesskit(path.to_str().expect("text"));
    harness.settle();
    harness.click("Save file");
    assert!(path.exists());
    assert_eq!(harness.editor().path(), Some(path.as_path()));
}

#[test]
fn a_file_that_is_there_is_replaced_once_that_is_meant() {
    let mut harness = EditorHarness::new();
    let path = harness.folder.path().join("theirs.ron");
    std::fs::write(&path, "theirs").expect("written");
    harness.press(Modifiers::COMMAND, Key::S);
    let text = path.to_str().expect("plain");
    harness.type_name("Path (this desktop offers no file dialog)", text);
    harness.assert_says("already exists. Replace it?");
    let held = || std::fs::read_to_string(&path).expect("read");
    assert_eq!(held(), "theirs");
    harness.click("Replace it");
    assert_ne!(held(), "theirs");
    assert_eq!(harness.editor().path(), Some(path.as_path()));
}

#[test]
fn a_scene_has_its_ending_and_no_folder_for_a_name() {
    let mut harness = EditorHarness::new();
    let folder = harness.folder.path().to_owned();
    let field = "Path (this desktop offers no file dialog)";
    harness.press(Modifiers::COMMAND, Key::S);
    for text in [
        format!("{}/", folder.display()),
        folder.display().to_string(),
    ] {
        harness.type_name(field, &text);
        assert_eq!(harness.editor().path(), None, "{text}");
        assert!(!folder.with_extension("ron").exists());
    }
    harness.window.get_by_label("This is a folder");
    harness.type_name(field, &folder.join("view.1").display().to_string());
    let path = folder.join("view.1.ron");
    assert_eq!(harness.editor().path(), Some(path.as_path()));
    assert!(path.exists());
}

#[test]
fn a_name_that_cannot_be_written_is_told_where_it_is_typed() {
    let mut harness = EditorHarness::new();
    let field = "Path (this desktop offers no file dialog)";
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::S);
    let long = harness.folder.path().join("a".repeat(300));
    harness.type_name(field, long.to_str().expect("plain"));
    harness.assert_says("File name too long");
    let short = harness.folder.path().join("short.ron");
    harness.type_name(field, short.to_str().expect("plain"));
    assert!(short.exists());
    assert!(harness.window.query_by_label(field).is_none());
}

#[test]
fn the_still_picture_is_written_to_a_file() {
    let answers =
        |folder: &std::path::Path| vec![(Ask::SaveImage, Some(folder.join("picture.png")))];
    let mut harness = EditorHarness::with(answers, None);
    harness.press(Modifiers::COMMAND, Key::E);
    let path = harness.folder.path().join("picture.png");
    harness.wait_for("the file", |_| path.exists());
    harness.settle();
    let saved = image::open(path).expect("a picture").to_rgba8();
    assert_eq!(saved.into_raw(), harness.picture().pixels.concat());
}

#[test]
fn a_picture_in_an_unknown_format_is_asked_about_again() {
    let answers =
        |folder: &std::path::Path| vec![(Ask::SaveImage, Some(folder.join("picture.jpg")))];
    let mut harness = EditorHarness::with(answers, None);
    harness.press(Modifiers::COMMAND, Key::E);
    harness
        .window
        .get_by_label("The file name must end in one of these: .png, .ppm, .exr");
    let folder = harness.folder.path().to_owned();
    let path = folder.join("picture.PNG");
    harness.type_name("Path", path.to_str().expect("plain"));
    harness.wait_for("the file", |_| path.exists());
    assert!(path.exists() && !folder.join("picture.jpg").exists());
}

#[test]
fn unsaved_changes_are_asked_about() {
    let mut harness = EditorHarness::with(
        |folder| vec![(Ask::SaveScene, Some(folder.join("kept.ron")))],
        None,
    );
    harness.press(Modifiers::NONE, Key::O);
    harness.press(Modifiers::COMMAND, Key::N);
    harness
        .window
        .get_by_label("Save changes to demo before starting another scene?");
    harness.click("Keep editing");
    assert!(harness.editor().is_dirty());
    harness.press(Modifiers::COMMAND, Key::N);
    harness.click("Save changes");
    assert!(harness.folder.path().join("kept.ron").exists());
    assert!(
        harness.scene().objects.is_empty(),
        "then the new scene is there"
    );
    harness.choose("Add", "Add ColorPack");
    harness.press(Modifiers::COMMAND, Key::N);
    harness.click("Don't save");
    assert_eq!(harness.scene(), &Scene::empty());
}

#[test]
fn a_refused_file_is_shown_with_its_place_and_the_document_stays() {
    let answers = |folder: &std::path::Path| vec![(Ask::OpenScene, Some(folder.join("given.ron")))];
    let text = "Scene(\n    version: 1,\n    objects: [5],\n)\n";
    let mut harness = EditorHarness::with(answers, Some(text));
    harness.assert_says("given.ron:3:15: expected Object(…)");
    assert_eq!(harness.scene(), &Scene::demo());
    harness.click("Dismiss");
    harness.press(Modifiers::COMMAND, Key::O);
    harness.assert_says("given.ron:3:15");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn dropped_files_open() {
    let mut harness = EditorHarness::new();
    let path = harness.folder.path().join("dropped.ron");
    let document = Document::of(Scene::empty());
    document.save(&path).expect("saved");
    harness.drop_file(path);
    assert_eq!(harness.scene(), &Scene::empty());
    assert_eq!(harness.editor().title(), "dropped.ron");
}

#[test]
fn a_model_is_dropped_with_all_that_lies_beside_it() {
    let mut harness = EditorHarness::new();
    let folder = harness.folder.path().to_owned();
    for (name, text) in [
        ("m.mtl", "newmtl gold\nKd 1 0.8 0\n"),
        (
            "m.obj",
            "mtllib m.mtl\nv 0 0 0\nv 90 0 0\nv 0 90 0\nusemtl gold\nf 1 2 3\n",
        ),
        ("wood.png", "no picture"),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
    harness.drop_files(["m.mtl", "m.obj", "wood.png"].map(|name| folder.join(name)));
    harness.wait_for("the model", |harness| {
        harness.scene().color_packs.contains_key("gold")
    });
    assert_eq!(
        harness.scene().objects.len(),
        Scene::demo().objects.len() + 1
    );
    assert!(!harness.sees("Save changes"));
    // A table of numbers is imported as a flight.
    let path = folder.join("path.CSV");
    std::fs::write(&path, "Time;X;Y;Z\n0;1,5;2;3\n1;2,5;2;3\n").expect("written");
    harness.drop_file(path);
    let keys = &harness.scene().animation.keys;
    assert_eq!(keys.len(), 2);
    assert_eq!(keys[1].value.position.to_array(), [2.5, 2.0, 3.0]);
}

#[test]
fn a_flight_that_is_dropped_waits_for_the_answer_to_an_open_question() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::O);
    harness.press(Modifiers::COMMAND, Key::N);
    harness.window.get_by_label("Don't save");
    let path = harness.folder.path().join("path.csv");
    std::fs::write(&path, "time,x,y,z\n0,1,2,3\n1,2,2,3\n").expect("written");
    harness.drop_file(path.clone());
    harness
        .window
        .get_by_label("Answer the open question first");
    assert!(harness.scene().animation.keys.is_empty());
    harness.press(Modifiers::NONE, Key::Escape);
    harness.drop_file(path);
    assert_eq!(harness.scene().animation.keys.len(), 2);
}

#[test]
fn a_model_in_other_units_says_how_large_it_is() {
    let mut harness = EditorHarness::new();
    for (reach, is_odd) in [("0.01", true), ("90", false), ("90000", true)] {
        let path = harness.folder.path().join("model.obj");
        let text = format!("v 0 0 0\nv {reach} 0 0\nv 0 {reach} 0\nf 1 2 3\n");
        std::fs::write(&path, text).expect("written");
        harness.drop_file(path);
        harness.wait_for("the model", |harness| {
            harness.scene().objects.len() > Scene::demo().objects.len()
        });
        let words = format!("they measure {reach} units, the scene");
        assert_eq!(harness.sees(&words), is_odd, "{reach}");
        harness.press(CTRL, Key::Z);
        assert_eq!(harness.scene(), &Scene::demo());
    }
}

#[test]
fn what_is_copied_brings_its_mesh_into_another_window() {
    let object = "Object(name: \"a\", color_pack: \"p\", shape: Mesh(file: \"m.obj\"))";
    let text =
        format!("Scene(version: 1, color_packs: {{\"p\": ColorPack()}}, objects: [{object}])");
    let open = |shift: u32| {
        let folder = tempfile::tempdir().expect("a folder");
        let mesh = format!("v {shift} 0 0\nv 90 0 0\nv 0 90 0\nf 1 2 3\n");
        std::fs::write(folder.path().join("m.obj"), mesh).expect("written");
        let scene = folder.path().join("s.ron");
        std::fs::write(&scene, &text).expect("written");
        (EditorHarness::kept_in(folder.path(), scene), folder)
    };
    let (mut one, _kept) = open(0);
    let (mut other, _also) = open(5);
    one.click("a");
    one.window.event(Event::Copy);
    one.window.step();
    let commands = &one.window.output().platform_output.commands;
    let copied = commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.expect("a text");
    let triangles =
        |harness: &EditorHarness, index: usize| match &harness.scene().objects[index].shape {
            Shape::Mesh(mesh) => mesh.source.triangles().clone(),
            _ => panic!("a mesh"),
        };
    let own = triangles(&one, 0);
    for harness in [&mut one, &mut other] {
        harness.window.event(Event::Paste(copied.clone()));
        harness.settle();
        assert_eq!(triangles(harness, 1), own);
    }
    assert_ne!(triangles(&other, 0), own);
    // In the window it was copied from, it is still the same mesh file.
    let text = one.editor().to_text().expect("a text");
    assert_eq!(text.matches("Mesh(file: \"m.obj\"").count(), 2, "{text}");
}

#[test]
fn nothing_is_made_of_a_scene_with_a_mesh_that_is_gone() {
    let object = "Object(name: \"Bunny\", color_pack: \"p\", shape: Mesh(file: \"gone.ply\"))";
    let text =
        format!("Scene(version: 1, color_packs: {{\"p\": ColorPack()}}, objects: [{object}])");
    let answers = |folder: &Path| vec![(Ask::ExportJob, Some(folder.join("job.yaml")))];
    let mut harness = EditorHarness::with(answers, Some(&text));
    harness.click("Dismiss");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    let refusal = "\"Bunny\" cannot be shown, and no frame is made without it";
    harness.assert_says(refusal);
    assert!(
        harness
            .window
            .get_by_label("Start export")
            .accesskit_node()
            .is_disabled()
    );
    harness.press(Modifiers::NONE, Key::Escape);
    harness.choose("File", "Export farm job…");
    harness.assert_says(refusal);
    assert!(!harness.folder.path().join("job.yaml").exists());
}

#[test]
fn a_window_that_rests_draws_nothing() {
    let mut harness = EditorHarness::on(Scene::demo());
    let delay = |harness: &EditorHarness| {
        let output = &harness.window.output().viewport_output;
        output[&egui::ViewportId::ROOT].repaint_delay
    };
    // For a while it checks its file as often as it scheduled.
    let start = std::time::Instant::now();
    while delay(&harness) < Duration::from_mins(1) {
        assert!(
            start.elapsed() < Duration::from_mins(1),
            "{:?}",
            delay(&harness)
        );
        std::thread::sleep(delay(&harness));
        harness.window.step();
    }
    assert!(!harness.sees("Changed outside"));
    // It still notices changes of the file.
    let other = Document::of(Scene::empty()).to_text().expect("a text");
    std::fs::write(harness.folder.path().join("given.ron"), other).expect("written");
    harness.wait_for("what was written", |harness| {
        harness.scene() == &Scene::empty()
    });
}

#[test]
fn povray_gets_what_is_on_show() {
    let answers = |folder: &Path| vec![(Ask::ExportPovray, Some(folder.join("now.pov")))];
    let text = std::fs::read_to_string("scenes/flight.ron").expect("readable");
    let mut harness = EditorHarness::with(answers, Some(&text));
    harness.press(CTRL, Key::End);
    harness.choose("File", "Export for POV-Ray…");
    let written = std::fs::read_to_string(harness.folder.path().join("now.pov")).expect("written");
    assert_eq!(written, povray_text(harness.editor().shown()));
    assert_ne!(written, povray_text(harness.scene()));
}

#[test]
fn the_first_things_of_a_scene_are_brought_into_the_picture_in_the_step_that_imports_them() {
    let mut harness = EditorHarness::on(Scene::empty());
    let before = harness.scene().clone();
    let corners = |place: f64| format!("v {place} 0 0\nv {place} 900 0\nv {place} 0 900\n");
    for (name, place) in [("far.obj", 3000.0), ("near.obj", 100.0)] {
        let path = harness.folder.path().join(name);
        std::fs::write(&path, format!("{}f 1 2 3\n", corners(place))).expect("written");
        harness.drop_file(path);
    }
    let framing = harness.scene().camera.framing().expect("a camera");
    let aspect = harness.scene().render.aspect_ratio();
    for corner in [
        [3000.0, 0.0, 0.0],
        [3000.0, 900.0, 0.0],
        [3000.0, 0.0, 900.0],
    ] {
        let place = framing.project(corner.into());
        let is_seen = place.is_some_and(|[x, y]| x.abs() * 2.0 < aspect && y.abs() < 0.5);
        assert!(is_seen, "{corner:?}: {place:?}");
    }
    assert_eq!(harness.scene().objects.len(), 2);
    harness.window.get_by_label_contains("near.obj; F frames");
    // The camera stays where the first import put it, and is undone with that import.
    harness.press(Modifiers::COMMAND, Key::Z);
    let told = harness.window.query_by_label_contains("near.obj; F frames");
    assert!(told.is_none(), "it is undone");
    assert_ne!(harness.scene().camera, before.camera);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene(), &before);
}

#[test]
fn an_import_into_an_empty_scene_leaves_the_shot() {
    let mut scene = Scene::empty();
    let camera = scene.camera.clone();
    scene.animation_mut().keys = [0.0, 2.0]
        .map(|time| glint::scene::Key::new(time, camera.clone()))
        .into();
    let mut harness = EditorHarness::on(scene);
    harness.press(Modifiers::NONE, Key::C);
    assert!(harness.editor().looks_through());
    let path = harness.folder.path().join("far.obj");
    std::fs::write(&path, "v 900 0 0\nv 900 90 0\nv 900 0 90\nf 1 2 3\n").expect("written");
    harness.drop_file(path);
    assert!(!harness.editor().looks_through());
    assert_ne!(harness.editor().shown().camera, camera);
}

#[test]
fn an_import_that_no_camera_can_see_whole_is_made_all_the_same() {
    let mut harness = EditorHarness::on(Scene::empty());
    let before = harness.scene().camera.clone();
    let path = harness.folder.path().join("wide.obj");
    std::fs::write(&path, "v 9e11 0 0\nv -9e11 0 0\nv 0 9e11 0\nf 1 2 3\n").expect("written");
    harness.drop_file(path);
    assert_eq!(harness.scene().objects.len(), 1);
    assert_eq!(harness.scene().camera, before);
    harness.assert_says("F frames them");
}

#[test]
fn unsaved_changes_survive_a_cancelled_open() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::O);
    harness.press(Modifiers::COMMAND, Key::O);
    harness.click("Don't save");
    harness.window.get_by_label("Open scene");
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(
        harness.editor().is_dirty(),
        "nothing took the document's place"
    );
}

#[test]
fn saving_works_from_within_a_field() {
    let mut harness = EditorHarness::on(Scene::empty());
    harness.put_cursor_into("position x");
    harness.type_text("12.5");
    harness.press(CTRL, Key::S);
    harness.settle();
    assert!(!harness.editor().is_dirty());
    let file = harness.folder.path().join("given.ron");
    let saved = Document::load(&file).expect("a scene").scene;
    assert_eq!(
        saved.camera.position.x, 12.5,
        "what was typed is in the file"
    );
}

const PARTS: &str =
    "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\no wing\nf 1 2 3\no tail\nf 1 2 4\nf 1 3 4\n";

#[test]
fn a_mesh_is_imported_turned_and_taken_apart() {
    let answers = |folder: &std::path::Path| {
        let path = folder.join("plane.obj");
        std::fs::write(&path, PARTS).expect("written");
        std::fs::write(folder.join("bad.stl"), "solid\n").expect("written");
        let bad = folder.join("bad.stl");
        vec![(Ask::ImportMesh, Some(path)), (Ask::ImportMesh, Some(bad))]
    };
    let mut harness = EditorHarness::with(answers, None);
    let before = harness.scene().objects.len();
    harness.choose("File", "Import mesh…");
    assert_eq!(harness.scene().objects.len(), before + 2);
    harness.click("tail");
    harness.assert_says("2 triangles");
    harness.click("Separate");
    assert_eq!(harness.scene().objects.len(), before + 3);
    harness.press(Modifiers::COMMAND, Key::Z);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene().objects.len(), before, "one step each");
    harness.choose("File", "Import mesh…");
    assert_eq!(harness.scene().objects.len(), before);
    harness.assert_says("bad.stl");
    harness.click("Triangle 1");
    harness.click("Join connected");
    assert_eq!(harness.scene().objects.len(), before - 5);
}

#[test]
fn what_is_imported_into_an_empty_scene_is_brought_into_the_picture() {
    let answers = |folder: &std::path::Path| {
        let path = folder.join("plane.obj");
        std::fs::write(&path, PARTS).expect("written");
        vec![(Ask::ImportMesh, Some(path))]
    };
    let empty = "Scene(version: 1, objects: [])";
    let mut harness = EditorHarness::with(answers, Some(empty));
    let before = harness.scene().camera.clone();
    harness.choose("File", "Import mesh…");
    harness.settle();
    let camera = &harness.scene().camera;
    assert_ne!(*camera, before);
    let (low, high) = harness.scene().objects_bounds().expect("objects");
    let middle = (low + high) * 0.5 - camera.position;
    let off = middle.angle_between(camera.look_at).to_degrees();
    assert!(off < 20.0, "{off} degrees off the middle");
}

/// The text of the demo with another radius of its first sphere.
fn demo_text(radius: f64) -> String {
    let mut scene = Scene::demo();
    let Shape::Sphere(ball) = &mut scene.objects[0].shape else {
        panic!("a ball");
    };
    ball.radius = radius;
    let document = Document::of(scene);
    document.to_text().expect("a text")
}

/// Opens a file in a window, applies `edit`, and then changes the file as another program would.
fn changed_outside(edit: impl FnOnce(&mut EditorHarness)) -> (EditorHarness, PathBuf) {
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&demo_text(20.0)));
    let path = harness.folder.path().join("given.ron");
    edit(&mut harness);
    std::fs::write(&path, demo_text(31.5)).expect("written");
    (harness, path)
}

#[test]
fn what_another_program_breaks_is_told_where_it_is() {
    let (mut harness, path) = changed_outside(|_| {});
    std::fs::write(&path, "Scene(\n  version: 1,\n  objects: [}\n").expect("written");
    harness.wait_for("the place", |harness| harness.sees("given.ron:3:"));
    assert_eq!(radius(harness.scene(), 0), 20.0);
    std::fs::write(&path, demo_text(31.5)).expect("written");
    harness.wait_for("what was written", |harness| {
        radius(harness.scene(), 0) == 31.5
    });
    assert!(!harness.sees("given.ron:3:"));
}

#[test]
fn what_another_program_writes_is_read_anew_and_can_be_undone() {
    let (mut harness, _) = changed_outside(|_| {});
    harness.wait_for("what was written", |harness| {
        radius(harness.scene(), 0) == 31.5
    });
    assert!(!harness.editor().is_dirty());
    harness.assert_says("changed by another program");
    harness.press(CTRL, Key::Z);
    assert_eq!(radius(harness.scene(), 0), 20.0);
    assert!(harness.editor().is_dirty());
}

#[test]
fn a_mesh_file_that_another_program_writes_is_read_anew_before_and_after_what_is_undone() {
    let mesh =
        |height: f64| format!("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 {height}\nf 1 2 3\nf 1 2 4\n");
    let text = r#"Scene(version: 1, color_packs: {"a": ColorPack()}, lights: [], objects: [
        Object(name: "roof", color_pack: "a", shape: Mesh(file: "roof.obj", position: (0, 0, -50))),
        Object(name: "late", color_pack: "a", shape: Mesh(file: "late.obj")),
    ])"#;
    let prepare = |folder: &Path| {
        std::fs::write(folder.join("roof.obj"), mesh(3.0)).expect("written");
        Vec::new()
    };
    let mut harness = EditorHarness::with(prepare, Some(text));
    let top = |harness: &EditorHarness, index: usize| {
        let Shape::Mesh(mesh) = &harness.scene().objects[index].shape else {
            panic!("a mesh");
        };
        let points = mesh.source.triangles().points().iter();
        points.map(|point| point.z).fold(0.0, f64::max)
    };
    assert_eq!((top(&harness, 0), top(&harness, 1)), (3.0, 0.0));
    harness.click("roof");
    harness.type_into("position x", "5");
    let folder = harness.folder.path().to_owned();
    let wait = |harness: &mut EditorHarness, name: &str, index: usize, height: f64| {
        // The window has checked the file before it changes.
        std::thread::sleep(Duration::from_millis(1100));
        harness.window.step();
        std::fs::write(folder.join(name), mesh(height)).expect("written");
        harness.wait_for("the mesh", |harness| top(harness, index) == height);
    };
    wait(&mut harness, "roof.obj", 0, 7.0);
    // The file that was missing now exists.
    wait(&mut harness, "late.obj", 1, 4.0);
    assert!(harness.scene().mesh_problems().next().is_none());
    // Only the typed position is unsaved, and undoing it does not bring back an old mesh.
    assert!(harness.editor().is_dirty());
    harness.press(CTRL, Key::Z);
    assert!(!harness.editor().is_dirty());
    assert_eq!((top(&harness, 0), top(&harness, 1)), (7.0, 4.0));
    // A copy made before is pasted with the current mesh.
    harness.click("roof");
    harness.window.event(Event::Copy);
    harness.settle();
    let editor = harness.editor();
    let copied = Document::of(excerpt(editor.scene(), editor.selection()));
    let copied = copied.to_text().expect("a text");
    wait(&mut harness, "roof.obj", 0, 8.0);
    harness.window.event(Event::Paste(copied));
    harness.settle();
    // Listed after its original.
    assert_eq!(top(&harness, 1), 8.0);
    harness.press(CTRL, Key::Z);
    wait(&mut harness, "roof.obj", 0, 7.0);
    assert!(!harness.editor().is_dirty());
    // A broken file is reported, and the mesh stays as it was, until the file is restored with its old modification
    // time.
    let roof = folder.join("roof.obj");
    let good = std::fs::read(&roof).expect("there");
    let time = std::fs::metadata(&roof).expect("there").modified();
    let is_told = |harness: &EditorHarness| harness.sees("the version read before is kept");
    std::fs::write(&roof, "f 1 2 3\n").expect("written");
    harness.wait_for("the message", is_told);
    std::fs::write(&roof, good).expect("written");
    let file = std::fs::File::options().write(true).open(&roof);
    let file = file.expect("there");
    file.set_modified(time.expect("a time")).expect("set");
    harness.wait_for("the mesh again", |harness| !is_told(harness));
    // So is one that is gone, until it is back.
    let away = folder.join("away.obj");
    std::fs::rename(&roof, &away).expect("moved");
    harness.wait_for("the message", is_told);
    assert!(harness.editor().is_dirty());
    std::fs::rename(&away, &roof).expect("moved");
    harness.wait_for("the mesh again", |harness| !is_told(harness));
    assert!(!harness.editor().is_dirty());
    std::fs::write(&roof, "f 1 2 3\n").expect("written");
    harness.wait_for("the message", is_told);
    assert_eq!(top(&harness, 0), 7.0);
    // The mesh is now saved within the scene, which no longer depends on the file.
    harness.click("roof");
    harness.type_into("position x", "6");
    harness.press(CTRL, Key::S);
    harness.assert_says("the contents of roof.obj are in the scene file now");
    let saved = |harness: &EditorHarness| {
        let path = harness.folder.path().join("given.ron");
        Document::load(&path).expect("valid").scene == **harness.editor().scene()
    };
    assert!(saved(&harness));
    std::fs::write(folder.join("roof.obj"), mesh(9.0)).expect("written");
    wait(&mut harness, "late.obj", 1, 5.0);
    assert_eq!(top(&harness, 0), 7.0);
    assert!(saved(&harness) && !harness.editor().is_dirty());
}

#[test]
fn a_name_that_is_typed_is_not_given_to_another_thing_that_comes_in_its_place() {
    let (mut harness, path) = changed_outside(|harness| {
        harness.click("Sphere 1");
        harness.press(Modifiers::NONE, Key::F2);
    });
    harness.wait_for("what was written", |harness| {
        radius(harness.scene(), 0) == 31.5
    });
    harness.window.get_by_label("new name");
    let mut scene = Scene::demo();
    scene.objects.remove(0);
    let text = Document::of(scene.clone()).to_text().expect("a text");
    // The window has checked the file before it changes.
    std::thread::sleep(Duration::from_millis(1100));
    harness.window.step();
    std::fs::write(&path, text).expect("written");
    let count = scene.objects.len();
    harness.wait_for("what was written", |harness| {
        harness.scene().objects.len() == count
    });
    assert!(harness.window.query_by_label("new name").is_none());
}

#[test]
fn both_changed_one_is_asked_which_is_to_stay() {
    let edit = |harness: &mut EditorHarness| {
        harness.click("Sphere 2");
        harness.type_into("radius", "7");
    };
    let is_asked = |harness: &EditorHarness| harness.window.query_by_label("Keep mine").is_some();
    for answer in ["Keep mine", "Take theirs"] {
        let (mut harness, path) = changed_outside(edit);
        harness.wait_for("the question", is_asked);
        harness.assert_says("2 objects changed: Sphere 1, Sphere 2");
        harness.click(answer);
        harness.press(CTRL, Key::S);
        assert!(!is_asked(&harness));
        let saved = Document::load(&path).expect("valid").scene;
        let expected = if answer == "Keep mine" { 20.0 } else { 31.5 };
        assert_eq!(radius(&saved, 0), expected, "{answer}");
        assert_eq!(&saved, harness.scene());
    }
}

#[test]
fn a_save_replaces_nothing_that_was_not_seen() {
    let (mut harness, path) = changed_outside(|harness| {
        harness.click("Sphere 2");
        harness.type_into("radius", "7");
        // The window has just checked the file, and does so again only in a second.
        harness.settle();
    });
    harness.press(CTRL, Key::S);
    let on_disk = Document::load(&path).expect("valid").scene;
    assert_eq!(radius(&on_disk, 0), 31.5);
    harness.window.get_by_label("Keep mine");
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.editor().is_dirty());
    harness.press(CTRL, Key::S);
    harness.click("Keep mine");
    let on_disk = Document::load(&path).expect("valid").scene;
    assert_eq!(radius(&on_disk, 0), 20.0);
    assert!(!harness.editor().is_dirty());
}

#[test]
fn a_file_that_is_gone_is_told_and_what_is_open_counts_as_unsaved() {
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&demo_text(20.0)));
    let path = harness.folder.path().join("given.ron");
    let elsewhere = harness.folder.path().join("moved.ron");
    let is_told = |harness: &EditorHarness| {
        let told = harness.window.query_by_label_contains("no longer exists");
        told.is_some()
    };
    std::fs::rename(&path, &elsewhere).expect("moved");
    harness.wait_for("the message", is_told);
    assert!(harness.editor().is_dirty());
    // The file exists again.
    std::fs::rename(&elsewhere, &path).expect("moved");
    harness.wait_for("the file again", |harness| !is_told(harness));
    assert!(!harness.editor().is_dirty());
    std::fs::remove_file(&path).expect("removed");
    harness.wait_for("the message", is_told);
    harness.press(CTRL, Key::S);
    assert!(!harness.editor().is_dirty());
    assert_eq!(
        radius(&Document::load(&path).expect("saved").scene, 0),
        20.0
    );
}

#[test]
fn a_file_that_another_program_has_broken_is_told_and_what_is_open_counts_as_unsaved() {
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&demo_text(20.0)));
    let path = harness.folder.path().join("given.ron");
    std::fs::write(&path, "Scene(").expect("written");
    harness.wait_for("the message", |harness| harness.sees("given.ron:1"));
    assert!(harness.editor().is_dirty());
    // It is deleted, which replaces the message; and then valid again.
    std::fs::remove_file(&path).expect("removed");
    harness.wait_for("the message", |harness| harness.sees("no longer exists"));
    assert!(!harness.sees("given.ron:1"));
    std::fs::write(&path, demo_text(20.0)).expect("written");
    harness.wait_for("the file again", |harness| !harness.editor().is_dirty());
    assert!(!harness.sees("no longer exists"));
}

#[test]
fn undo_brings_back_what_another_program_has_replaced_with_its_comments() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.ron");
    let header = |editor: &Editor| editor.document().header;
    std::fs::write(&path, format!("// mine\n{}", demo_text(20.0))).expect("written");
    let mut editor = Editor::demo();
    editor.open(Document::load_stamped(&path).expect("valid"), &path);
    editor.apply(Action::Select(Selection::all([Item::object(0)])));
    let mut other = Editor::demo();
    other.apply(Action::Edit(Edit::Delete(vec![Item::object(0)])));
    let theirs = Document::of(Scene::clone(other.scene()));
    let text = theirs.to_text().expect("a text");
    std::fs::write(&path, format!("// theirs\n{text}")).expect("written");
    editor.take_theirs(Document::load_stamped(&path).expect("valid"));
    assert_eq!(header(&editor), "// theirs\n");
    // What was selected is gone, and nothing else is selected in its place.
    assert!(editor.selection().items().is_empty());
    editor.apply(Action::Undo);
    assert_eq!(header(&editor), "// mine\n");
    assert_eq!(editor.selection().items(), [Item::object(0)]);
    editor.apply(Action::Redo);
    assert_eq!(header(&editor), "// theirs\n");
}

#[test]
fn what_comes_after_a_broken_file_is_not_replaced_unseen() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.ron");
    std::fs::write(&path, demo_text(20.0)).expect("written");
    let mut editor = Editor::demo();
    editor.open(Document::load_stamped(&path).expect("valid"), &path);
    std::fs::write(&path, "Scene(").expect("written");
    editor.keep_mine(None, Stamp::read(&path));
    assert!(editor.is_dirty() && !editor.is_changed_outside());
    std::fs::write(&path, demo_text(31.5)).expect("written");
    assert!(editor.is_changed_outside() && editor.would_lose(&path));
}

#[test]
fn a_question_that_is_left_open_does_not_end_the_watch() {
    let (mut harness, path) = changed_outside(|_| {});
    std::fs::write(&path, "Scene(").expect("written");
    harness.press(CTRL, Key::S);
    harness.window.get_by_label("Keep mine");
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Keep mine").is_none());
    std::fs::write(&path, demo_text(31.5)).expect("written");
    harness.wait_for("what was written", |harness| {
        radius(harness.scene(), 0) == 31.5
    });
    // Without unsaved changes here, the file of the other program is loaded.
    std::fs::write(&path, demo_text(12.5)).expect("written");
    harness.press(CTRL, Key::S);
    assert!(harness.window.query_by_label("Keep mine").is_none());
    assert_eq!(radius(harness.scene(), 0), 12.5);
    assert_eq!(
        radius(&Document::load(&path).expect("valid").scene, 0),
        12.5
    );
}

#[test]
fn a_flight_that_is_still_recorded_is_asked_about() {
    let mut harness = EditorHarness::with(
        |folder| vec![(Ask::SaveScene, Some(folder.join("flown.ron")))],
        None,
    );
    harness.press(Modifiers::NONE, Key::R);
    harness.hold(Key::W, 40);
    assert!(harness.editor().timeline().recorded().is_some());
    harness.press(CTRL, Key::N);
    // Enter presses the default button.
    harness.press(Modifiers::NONE, Key::Enter);
    let path = harness.folder.path().join("flown.ron");
    harness.wait_for("the file", |_| path.exists());
    let keys = Document::load(&path)
        .expect("valid")
        .scene
        .animation
        .keys
        .len();
    assert!(keys > 1, "{keys}");
}

#[test]
fn recovered_work_does_not_replace_what_was_written_since() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.ron");
    for (since, is_lost) in [(demo_text(20.0), false), (demo_text(31.5), true)] {
        std::fs::write(&path, demo_text(20.0)).expect("written");
        let (document, stamp) = Document::load_stamped(&path).expect("valid");
        let place = Recovery::new(&folder.path().join("data")).expect("a place");
        let text = document.to_text().expect("a text");
        place.keep(&text, Some(&path), Some(&stamp)).expect("kept");
        drop(place);
        std::fs::write(&path, since).expect("written");
        let next = Recovery::new(&folder.path().join("data")).expect("a place");
        let mut editor = Editor::demo();
        editor.recover(next.take_leftover(None).expect("left behind"));
        assert_eq!(editor.would_lose(&path), is_lost);
        assert_eq!(editor.is_changed_outside(), is_lost);
    }
}

#[test]
fn work_that_was_left_is_taken_up_when_its_file_is_opened_later() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, second, data] = ["a.ron", "b.ron", "data"].map(|name| folder.path().join(name));
    for path in [&first, &second] {
        std::fs::write(path, demo_text(20.0)).expect("written");
    }
    let place = Recovery::new(&data).expect("a place");
    let left = demo_text(31.5);
    place.keep(&left, Some(&second), None).expect("kept");
    drop(place);
    let mut harness = EditorHarness::kept_in(&data, first);
    assert_eq!(radius(harness.scene(), 0), 20.0);
    harness.drop_file(second);
    assert_eq!(radius(harness.scene(), 0), 31.5);
    assert!(harness.editor().is_dirty());
    harness.assert_says("Glint ended with unsaved changes to");
}

#[test]
fn what_is_done_while_the_desktop_asks_is_asked_about() {
    let dialogs = Unanswered::default();
    let mut harness = EditorHarness::asked(|_| Box::new(dialogs.clone()), None);
    let path = harness.folder.path().join("other.ron");
    std::fs::write(&path, demo_text(31.5)).expect("written");
    // While a dialog is open, the window does not settle.
    let tap = |harness: &mut EditorHarness, modifiers: Modifiers, key: Key| {
        harness.window.key_press_modifiers(modifiers, key);
        (0..5).for_each(|_| harness.window.step());
    };
    tap(&mut harness, CTRL, Key::O);
    tap(&mut harness, Modifiers::NONE, Key::O);
    assert!(harness.editor().is_dirty());
    dialogs.answer(&path);
    harness.settle();
    harness
        .window
        .get_by_label("Save changes to demo before opening another scene?");
    harness.click("Don't save");
    assert_eq!(harness.editor().path(), Some(path.as_path()));
    // The document that was to be saved is no longer open.
    harness.click("Sphere 1");
    harness.type_into("radius", "12");
    let copy = harness.folder.path().join("copy.ron");
    tap(&mut harness, CTRL.plus(Modifiers::SHIFT), Key::S);
    tap(&mut harness, CTRL, Key::N);
    harness.window.get_by_label("Don't save").click();
    (0..5).for_each(|_| harness.window.step());
    assert!(harness.scene().objects.is_empty());
    dialogs.answer(&copy);
    harness.settle();
    assert!(!copy.exists());
}

#[test]
fn a_typed_name_is_taken_before_the_click_that_ends_it_and_belongs_to_its_item() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let name = |harness: &EditorHarness| {
        let field = harness
            .window
            .get_by_role_and_label(Role::TextInput, "name");
        field.rect().center()
    };
    let at = name(&harness);
    harness.click_at(at);
    harness.press(CTRL, Key::A);
    harness.type_text("Ball");
    let eye = harness.middle_of("Hide Sphere 1");
    harness.window.drag_at(eye);
    harness.window.step();
    harness.window.drop_at(eye);
    harness.settle();
    let ball = &harness.scene().objects[0];
    assert_eq!((ball.name.as_str(), ball.visible), ("Ball", false));
}

#[test]
fn a_number_being_typed_counts_before_another_scene_is_opened() {
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&demo_text(20.0)));
    harness.click("Sphere 1");
    harness.put_cursor_into("radius");
    harness.type_text("50");
    harness.drop_file("scenes/mirrors.ron".into());
    assert_eq!(radius(harness.scene(), 0), 50.0);
    assert!(harness.sees("Save changes"));
}
