//! The window, headless: its widgets are driven by the names that screen readers hear.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Context, Event, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glint::editor::{Editor, Mode};
use glint::image::{Image, render};
use glint::plan::{RenderRequest, Sampling};
use glint::scene::{Document, Method as _, Projection, Scene, Shape, Sphere};
use glint::trace::RenderControl;
use glint::ui::{App, Ask, Command, Dialogs, FLIGHT, SHORTCUTS, Setup};

/// Dialogs that answer from a list; with none left, they do as a desktop without dialogs does.
pub struct Scripted(VecDeque<(Ask, Option<PathBuf>)>);

impl Dialogs for Scripted {
    fn ask(&mut self, _: &Context, ask: &Ask, _: PathBuf) -> Receiver<Option<PathBuf>> {
        let (sender, receiver) = channel();
        let answer = self.0.pop_front().map(|(expected, answer)| {
            assert_eq!(expected, *ask);
            answer
        });
        sender
            .send(answer.flatten())
            .expect("the receiver is there");
        receiver
    }
}

/// The control key as a keyboard sends it: on Linux it is also the command key.
pub const CTRL: Modifiers = Modifiers {
    ctrl: true,
    ..Modifiers::COMMAND
};

pub struct EditorHarness {
    pub window: Harness<'static, App>,
    pub folder: tempfile::TempDir,
}

impl EditorHarness {
    pub fn new() -> Self {
        Self::with(|_| Vec::new(), None)
    }

    /// A window with dialogs that answer as listed, on a scene text (or the demo).
    pub fn with(
        answers: impl FnOnce(&std::path::Path) -> Vec<(Ask, Option<PathBuf>)>,
        scene: Option<&str>,
    ) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let dialogs = Box::new(Scripted(answers(folder.path()).into()));
        let scene = scene.map(|text| {
            let path = folder.path().join("given.ron");
            std::fs::write(&path, text).expect("written");
            path
        });
        let window = Harness::builder()
            .with_size([1280.0, 800.0])
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(32)
            .build_eframe(move |cc| {
                App::new(
                    cc,
                    Setup {
                        scene,
                        dialogs,
                        data_folder: None,
                        screenshot: None,
                        exports: false,
                    },
                )
                .expect("a lane")
            });
        let mut harness = Self { window, folder };
        harness.settle();
        harness
    }

    /// Steps until the picture on screen is the finished one of the newest scene.
    pub fn settle(&mut self) {
        let start = Instant::now();
        self.window.step();
        self.window.step();
        while !self.window.state().is_settled() {
            assert!(
                start.elapsed() < Duration::from_mins(1),
                "the picture never came"
            );
            std::thread::sleep(Duration::from_millis(2));
            self.window.step();
        }
        self.window.step();
    }

    pub fn editor(&self) -> &Editor {
        self.window.state().editor()
    }

    pub fn scene(&self) -> &Scene {
        self.editor().scene()
    }

    pub fn picture(&self) -> Image {
        self.window
            .state()
            .shown_picture()
            .expect("a picture")
            .clone()
    }

    pub fn click(&mut self, name: &str) {
        self.window.get_by_label(name).click();
        self.settle();
    }

    pub fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.settle();
    }

    /// Opens a menu and chooses an entry of it.
    pub fn choose(&mut self, menu: &str, entry: &str) {
        self.window
            .get_by_role_and_label(Role::Button, menu)
            .click();
        self.settle();
        self.click(entry);
    }

    /// Types a number over the one in a field.
    pub fn type_into(&mut self, field: &str, text: &str) {
        self.window
            .get_by_role_and_label(Role::SpinButton, field)
            .click();
        self.settle();
        self.window.event(Event::Text(text.to_owned()));
        self.settle();
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Types a name over the one in a field.
    pub fn type_name(&mut self, field: &str, text: &str) {
        self.window
            .get_by_role_and_label(Role::TextInput, field)
            .click();
        self.settle();
        self.press(CTRL, Key::A);
        self.window.event(Event::Text(text.to_owned()));
        self.settle();
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Double-clicks a label, which brings its default back.
    pub fn double_click(&mut self, label: &str) {
        let at = self
            .window
            .get_by_role_and_label(Role::Label, label)
            .rect()
            .center();
        // Long enough after any other click, with which it would count as three.
        (0..60).for_each(|_| self.window.step());
        for _ in 0..2 {
            self.window.drag_at(at);
            self.window.drop_at(at);
        }
        self.settle();
    }

    /// Drags a number field sideways in several moves.
    pub fn drag(&mut self, field: &str, points: f32) {
        let start = self
            .window
            .get_by_role_and_label(Role::SpinButton, field)
            .rect()
            .center();
        self.window.drag_at(start);
        self.window.step();
        for part in 1..=5 {
            self.window
                .hover_at(start + egui::vec2(points * part as f32 / 5.0, 0.0));
            self.window.step();
        }
        self.window.drop_at(start + egui::vec2(points, 0.0));
        self.settle();
    }
}

fn radius(scene: &Scene, object: usize) -> f64 {
    match scene.objects[object].shape {
        Shape::Sphere(Sphere { radius, .. }) => radius,
        _ => panic!("not a sphere"),
    }
}

#[test]
fn the_window_opens_on_the_demo_and_shows_its_picture() {
    let harness = EditorHarness::new();
    assert_eq!(harness.scene(), &Scene::demo());
    let shown = harness.picture();
    let smooth = RenderRequest {
        sampling: Sampling::ADAPTIVE,
        ..RenderRequest::sized(shown.width as u32, shown.height as u32)
    };
    let direct = render(harness.scene(), &smooth, &RenderControl::default())
        .expect("not stopped")
        .0;
    assert!(
        shown == direct,
        "the live view and a plain render are the same bytes"
    );
    assert!(
        shown.width >= 500 && shown.width == shown.height,
        "{}×{}",
        shown.width,
        shown.height
    );
}

#[test]
fn a_drag_changes_the_radius_and_one_undo_brings_it_back() {
    let mut harness = EditorHarness::new();
    let before = harness.picture();
    harness.click("Sphere 1");
    harness.drag("radius", 40.0);
    assert!(
        radius(harness.scene(), 0) > 55.0,
        "{}",
        radius(harness.scene(), 0)
    );
    assert!(harness.picture() != before, "the edit is traced");
    assert_eq!(harness.editor().undo_label(), Some("Sphere 1: radius"));
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene(), &Scene::demo());
    assert_eq!(harness.editor().undo_label(), None, "a drag is one step");
    assert!(harness.picture() == before);
    harness.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert!(radius(harness.scene(), 0) > 55.0);
}

#[test]
fn a_pack_is_edited_for_all_that_use_it() {
    let mut harness = EditorHarness::new();
    harness.click("tetrahedron");
    harness.type_into("diffuse red", "12");
    harness.type_into("ambient hex", "#0A141E");
    harness.type_into("phong", "64");
    harness.click("reflective");
    let pack = &harness.scene().color_packs["tetrahedron"];
    assert_eq!(pack.diffuse.to_array(), [12.0, 255.0, 255.0]);
    assert_eq!(pack.ambient.to_array(), [10.0, 20.0, 30.0]);
    assert_eq!((pack.phong_exponent, pack.reflective), (64.0, true));
    harness.click("Go to Triangle 3");
    harness
        .window
        .get_by_role_and_label(Role::SpinButton, "a x");
}

#[test]
fn looking_at_a_pack_changes_nothing() {
    let mut harness = EditorHarness::new();
    for name in [
        "tetrahedron",
        "Light 1",
        "Sphere 2",
        "Triangle 1",
        "Plane",
        "World",
        "Picture",
        "Camera",
    ] {
        harness
            .window
            .get_all_by_label(name)
            .next()
            .expect("a row")
            .click();
        harness.settle();
        assert!(!harness.editor().is_dirty(), "{name}");
    }
}

#[test]
fn a_vector_is_pasted_whole_and_a_label_resets() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.type_into("center y", "1, -2, 3.5");
    let Shape::Sphere(Sphere { center, .. }) = &harness.scene().objects[0].shape else {
        panic!("a sphere")
    };
    assert_eq!(center.to_array(), [1.0, -2.0, 3.5]);
    harness.type_into("radius", "7");
    harness.double_click("radius");
    assert_eq!(radius(harness.scene(), 0), 50.0);
}

#[test]
fn invalid_edits_are_refused_and_explained() {
    let mut harness = EditorHarness::new();
    harness
        .window
        .get_by_role_and_label(Role::Button, "Camera")
        .click();
    harness.settle();
    harness.type_into("up x", "-0.25, -0.25, -0.93");
    assert_eq!(harness.scene(), &Scene::demo());
    harness
        .window
        .get_by_label_contains("up must not be parallel to look_at");
    harness.click("Dismiss");
    assert!(harness.window.query_by_label_contains("parallel").is_none());
}

#[test]
fn keys_switch_projection_markers_and_resolution() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::O);
    assert_eq!(harness.scene().camera.projection, Projection::Orthographic);
    harness.press(Modifiers::NONE, Key::P);
    assert_eq!(harness.scene().camera.projection, Projection::Perspective);
    harness.press(Modifiers::NONE, Key::U);
    assert!(!harness.scene().light_visualization);
    harness.press(Modifiers::NONE, Key::I);
    assert!(harness.scene().light_visualization);
    harness.press(Modifiers::NONE, Key::L);
    assert_eq!(
        (
            harness.editor().mode,
            harness.picture().width,
            harness.picture().height
        ),
        (Mode::LowRes, 64, 64)
    );
    harness.press(Modifiers::NONE, Key::H);
    assert_eq!(
        (harness.editor().mode, harness.picture().width),
        (Mode::HighRes, 1024)
    );
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.editor().mode, Mode::Live);
    harness.press(Modifiers::NONE, Key::Escape);
    harness.window.get_by_label("Quit Glint?");
    harness.click("Stay");
    assert!(harness.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn the_still_picture_stays_until_the_scene_changes() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::H);
    let still = render(
        harness.scene(),
        &RenderRequest::still(harness.scene()),
        &RenderControl::default(),
    );
    assert!(harness.picture() == still.expect("not stopped").0);
    harness.click("Sphere 2");
    assert_eq!(
        harness.editor().mode,
        Mode::HighRes,
        "looking elsewhere keeps it"
    );
    harness.type_into("radius", "30");
    assert_eq!(harness.editor().mode, Mode::Live);
    assert!(harness.picture().width < 1024);
}

#[test]
fn flying_is_per_second_and_one_step() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    harness.window.key_down(Key::W);
    harness.window.key_down(Key::ArrowRight);
    for _ in 0..30 {
        harness.window.step();
    }
    harness.window.key_up(Key::W);
    harness.window.key_up(Key::ArrowRight);
    harness.settle();
    let end = harness.scene().camera.clone();
    let flown = (end.position - start.position).length();
    // Half a second at a quarter of the scene's extent (about 320) per second.
    assert!((20.0..80.0).contains(&flown), "{flown}");
    assert!(
        end.look_at.x > start.look_at.try_normalize().expect("a direction").x,
        "turned right"
    );
    assert_eq!(harness.editor().undo_label(), Some("Camera: move"));
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene().camera, start);
    assert_eq!(harness.editor().undo_label(), None);
}

#[test]
fn the_right_button_looks_around() {
    let mut harness = EditorHarness::new();
    let start = harness.editor().orientation();
    let middle = harness.window.get_by_label("Live view").rect().center();
    let button = |pressed, pos| Event::PointerButton {
        pos,
        button: egui::PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    harness.window.hover_at(middle);
    harness.window.step();
    harness.window.event(button(true, middle));
    harness.window.step();
    for n in 1..=4 {
        harness
            .window
            .hover_at(middle + egui::vec2(10.0 * n as f32, -5.0 * n as f32));
        harness.window.step();
    }
    harness
        .window
        .event(button(false, middle + egui::vec2(40.0, -20.0)));
    harness.settle();
    let end = harness.editor().orientation();
    assert!(
        end.yaw > start.yaw + 0.1 && end.pitch > start.pitch + 0.05,
        "{start:?} {end:?}"
    );
    assert!((end.roll - start.roll).abs() < 1e-9);
}

#[test]
fn keys_do_nothing_while_a_text_is_edited() {
    let mut harness = EditorHarness::new();
    harness.window.get_by_label("Filter").focus();
    harness.settle();
    for key in [Key::O, Key::U, Key::W, Key::L] {
        harness.press(Modifiers::NONE, key);
    }
    assert_eq!(harness.scene(), &Scene::demo());
    assert_eq!(harness.editor().mode, Mode::Live);
}

#[test]
fn the_outliner_filters_hides_renames_and_reorders() {
    let mut harness = EditorHarness::new();
    harness.window.get_by_label("Filter").focus();
    harness.window.get_by_label("Filter").type_text("sphere");
    harness.settle();
    assert!(harness.window.query_by_label("Plane").is_none());
    assert!(harness.window.query_by_label("Sphere 2").is_some());
    harness.click("Hide Sphere 2");
    assert!(!harness.scene().objects[1].visible);
    harness.click("Sphere 1");
    harness.press(Modifiers::ALT, Key::ArrowDown);
    assert_eq!(harness.scene().objects[1].name, "Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    harness
        .window
        .event(Event::Text("Sphere of glass".to_owned()));
    harness.settle();
    harness.press(Modifiers::NONE, Key::Enter);
    assert_eq!(harness.scene().objects[1].name, "Sphere of glass");
    harness.press(Modifiers::COMMAND, Key::D);
    assert_eq!(harness.scene().objects.len(), 10);
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(harness.scene().objects.len(), 9);
}

#[test]
fn everything_can_be_added() {
    let mut harness = EditorHarness::new();
    for (entry, count) in [("Add Sphere", 10), ("Add Plane", 11), ("Add Triangle", 12)] {
        harness
            .window
            .get_by_role_and_label(Role::Button, "Add to scene")
            .click();
        harness.settle();
        harness.click(entry);
        assert_eq!(harness.scene().objects.len(), count);
    }
    harness
        .window
        .get_by_role_and_label(Role::Button, "Add to scene")
        .click();
    harness.settle();
    harness.click("Add Light");
    assert_eq!(harness.scene().lights.len(), 3);
}

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
    harness.choose("File", "Open demo");
    harness
        .window
        .get_by_role_and_label(Role::Button, "File")
        .click();
    harness.settle();
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
fn the_still_picture_is_written_to_a_file() {
    let answers =
        |folder: &std::path::Path| vec![(Ask::SaveImage, Some(folder.join("picture.png")))];
    let mut harness = EditorHarness::with(answers, None);
    harness.press(Modifiers::COMMAND, Key::E);
    let path = harness.folder.path().join("picture.png");
    let start = Instant::now();
    while !path.exists() && start.elapsed() < Duration::from_secs(30) {
        harness.window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    harness.settle();
    let saved = image::open(path).expect("a picture").to_rgba8();
    assert_eq!(saved.into_raw(), harness.picture().pixels.concat());
}

#[test]
fn unsaved_changes_are_asked_about() {
    let mut harness = EditorHarness::with(
        |folder| vec![(Ask::SaveScene, Some(folder.join("kept.ron")))],
        None,
    );
    harness.press(Modifiers::NONE, Key::O);
    harness.press(Modifiers::COMMAND, Key::N);
    harness.window.get_by_label("Save changes to demo?");
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
    harness
        .window
        .get_by_label_contains("given.ron:3:15: expected Object(…)");
    assert_eq!(harness.scene(), &Scene::demo());
    harness.click("Dismiss");
    harness.press(Modifiers::COMMAND, Key::O);
    harness.window.get_by_label_contains("given.ron:3:15");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn dropped_files_open() {
    #[derive(Debug)]
    struct OnDisk(PathBuf);
    impl egui::DroppedFile for OnDisk {
        fn path(&self) -> &std::path::Path {
            &self.0
        }
        fn bytes(&self) -> Result<Vec<u8>, String> {
            std::fs::read(&self.0).map_err(|error| error.to_string())
        }
    }
    let mut harness = EditorHarness::new();
    let path = harness.folder.path().join("dropped.ron");
    let document = Document {
        header: String::new(),
        scene: Scene::empty(),
    };
    document.save(&path).expect("saved");
    harness
        .window
        .input_mut()
        .dropped_files
        .push(std::sync::Arc::new(OnDisk(path)));
    harness.settle();
    assert_eq!(harness.scene(), &Scene::empty());
    assert_eq!(harness.editor().title(), "dropped.ron");
}

#[test]
fn escape_closes_an_open_menu_and_nothing_else() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::L);
    harness
        .window
        .get_by_role_and_label(Role::Button, "File")
        .click();
    harness.settle();
    assert!(harness.window.query_by_label("Save as…").is_some());
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Save as…").is_none());
    assert_eq!(harness.editor().mode, Mode::LowRes);
}

#[test]
fn help_lists_every_key() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::F1);
    for what in SHORTCUTS
        .iter()
        .map(|shortcut| shortcut.what)
        .chain(FLIGHT.iter().map(|key| key.what))
    {
        assert!(
            harness.window.query_all_by_label(what).next().is_some(),
            "{what}"
        );
    }
    assert!(
        SHORTCUTS
            .iter()
            .any(|shortcut| shortcut.command == Command::HighRes)
    );
}

#[test]
fn a_scene_of_thousands_shows_only_the_rows_in_sight() {
    let mut scene = Scene::empty();
    for n in 0..3000_u32 {
        scene.objects.push(glint::scene::Object {
            name: format!("Ball {n} with a name that is rather longer than the panel is wide"),
            color_pack: "pack 1".to_owned(),
            shape: Shape::Sphere(Sphere {
                center: glam::DVec3::new(f64::from(n), 0.0, 0.0),
                radius: 0.4,
            }),
            visible: n % 3 != 0,
        });
    }
    scene.render.width = 40;
    let text = Document {
        header: String::new(),
        scene,
    }
    .to_text()
    .expect("text");
    let harness = EditorHarness::with(|_| Vec::new(), Some(&text));
    let rows = harness.window.query_all_by_label_contains("Ball").count();
    assert!((10..200).contains(&rows), "{rows}");
    let picture = harness.window.get_by_label("Live view").rect();
    assert!(
        picture.left() > 200.0 && picture.right() < 980.0,
        "{picture:?}: panels keep their width"
    );
}

#[test]
fn escape_in_a_field_gives_up_what_was_typed_and_nothing_else() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness
        .window
        .get_by_role_and_label(Role::SpinButton, "radius")
        .click();
    harness.settle();
    harness.window.event(Event::Text("3".to_owned()));
    harness.settle();
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene(), &Scene::demo());
    harness.press(Modifiers::NONE, Key::F2);
    harness.window.event(Event::Text("q".to_owned()));
    harness.settle();
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene(), &Scene::demo());
    harness.window.get_by_label("Filter").focus();
    harness.settle();
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn a_held_key_commands_once() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    for repeat in [false, true, true, true] {
        harness
            .window
            .event(Event::ModifiersChanged(Modifiers::COMMAND));
        harness.window.event(Event::Key {
            key: Key::D,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: Modifiers::COMMAND,
        });
        harness.window.step();
    }
    harness.window.key_up_modifiers(Modifiers::COMMAND, Key::D);
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.settle();
    assert_eq!(harness.scene().objects.len(), 10);
    let Shape::Sphere(Sphere { center, radius }) = &harness.scene().objects[1].shape else {
        panic!("a sphere")
    };
    assert_eq!(
        (center.x, *radius),
        (225.0, 50.0),
        "the copy stands beside the original"
    );
}

#[test]
fn ctrl_flies_down_and_is_no_shortcut_in_flight() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.position;
    let frames =
        |harness: &mut EditorHarness, count| (0..count).for_each(|_| harness.window.step());
    harness.window.event(Event::ModifiersChanged(CTRL));
    frames(&mut harness, 30);
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.settle();
    assert!(
        harness.scene().camera.position.y < start.y - 5.0,
        "by itself, after a moment"
    );
    let height = harness.scene().camera.position.y;
    harness.window.key_down(Key::D);
    frames(&mut harness, 5);
    harness.window.event(Event::ModifiersChanged(CTRL));
    harness.window.key_down_modifiers(CTRL, Key::D);
    frames(&mut harness, 10);
    harness.window.key_up(Key::D);
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.settle();
    assert_eq!(harness.scene().objects.len(), 9, "no duplicate");
    assert!(
        harness.scene().camera.position.y < height,
        "down at once in flight"
    );
}

#[test]
fn shortcuts_work_after_flying_into_the_still_picture() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    harness.window.key_down(Key::W);
    (0..5).for_each(|_| harness.window.step());
    harness.press(Modifiers::NONE, Key::H);
    harness.window.key_up(Key::W);
    harness.settle();
    assert_eq!(harness.editor().mode, Mode::HighRes);
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene().camera, start);
}

#[test]
fn a_turn_of_the_wheel_is_one_step_and_spares_the_still_picture() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    let turn = |harness: &mut EditorHarness| {
        let middle = harness
            .window
            .get_all_by_role(Role::Image)
            .next()
            .expect("a picture")
            .rect()
            .center();
        harness.window.hover_at(middle);
        harness.window.step();
        harness.window.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: egui::vec2(0.0, 1.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        (0..40).for_each(|_| harness.window.step());
        harness.settle();
    };
    turn(&mut harness);
    assert_ne!(harness.scene().camera.position, start.position);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene().camera, start);
    harness.press(Modifiers::NONE, Key::H);
    turn(&mut harness);
    assert_eq!(
        (harness.editor().mode, &harness.scene().camera),
        (Mode::HighRes, &start)
    );
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
fn a_label_brings_the_default_back() {
    let mut harness = EditorHarness::new();
    harness
        .window
        .get_by_role_and_label(Role::Button, "Camera")
        .click();
    harness.settle();
    harness.type_into("up x", "0.5, 0.5, 0.5");
    harness.double_click("up");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn the_inspector_says_what_the_scene_needs() {
    let mut harness = EditorHarness::new();
    harness.window.get_by_label("Needs").click();
    harness.settle();
    harness
        .window
        .get_by_label("reflected rays, up to 1 bounce");
    harness
        .window
        .get_by_label("because everything the camera can reach is on its side of every plane");
}

#[test]
fn the_lab_measures_shows_a_dot_and_adopts_it_in_one_step() {
    let mut harness = EditorHarness::new();
    let before = harness.scene().clone();
    harness.press(CTRL, Key::L);
    harness.click("Measure");
    let start = Instant::now();
    while harness.window.query_by_label("Cancel measuring").is_some() {
        assert!(start.elapsed() < Duration::from_mins(2), "never measured");
        std::thread::sleep(Duration::from_millis(50));
        harness.window.step();
    }
    assert!(
        harness.window.query_by_label("Use this").is_none(),
        "no dot is chosen"
    );
    // Of all ways, plain adaptive sampling or one of its neighbours is the cheapest within 8 bits.
    harness.click("Cheapest within");
    harness.window.get_by_label("Lab picture");
    assert!(harness.window.query_by_label("stale").is_none());
    harness.click("×64");
    let steps = harness.editor().undo_label().map(str::to_owned);
    harness.click("Use this");
    assert_eq!(steps, None);
    assert_eq!(
        harness.editor().undo_label(),
        Some("Render: settings from the lab")
    );
    let sampling = harness.scene().render.antialias;
    assert!(
        matches!(sampling, Sampling::Adaptive { .. }),
        "{sampling:?}"
    );
    assert!(
        harness.window.query_by_label("stale").is_none(),
        "settings are what is compared"
    );
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Lab picture").is_none());
    harness.press(CTRL, Key::Z);
    assert_eq!(*harness.scene(), before);
    harness.press(Modifiers::NONE, Key::O);
    harness.window.get_by_label("stale");
    harness.press(CTRL, Key::L);
    assert!(harness.window.query_by_label("Measure").is_none());
}

#[test]
fn the_lab_shows_where_formulas_break_and_warns_of_those_in_use() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron"));
    let text = text.expect("the demo").replace(
        "reflection_limit: 1",
        "reflection_limit: 1, triangle: \"edges\"",
    );
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&text));
    assert_eq!(harness.scene().render.triangle.id(), "edges");
    harness.press(CTRL, Key::L);
    harness.click("Stability");
    let start = Instant::now();
    while harness
        .window
        .query_all_by_label_contains("stable")
        .next()
        .is_none()
    {
        assert!(start.elapsed() < Duration::from_mins(1), "no maps");
        std::thread::sleep(Duration::from_millis(20));
        harness.window.step();
    }
    harness
        .window
        .get_by_label("The frame is where your scene stands.");
    let row = |harness: &EditorHarness, words: &str| {
        let rows = harness.window.query_all_by_label_contains(words);
        rows.last().map(|row| row.rect().center())
    };
    for (method, warned) in [("edges", true), ("watertight", false)] {
        let at = row(&harness, method).expect("a row");
        harness.window.drag_at(at);
        harness.window.drop_at(at);
        harness.settle();
        let mut warnings = harness
            .window
            .query_all_by_label_contains("Your scene uses this");
        assert_eq!(warnings.next().is_some(), warned, "{method}");
    }
}

#[test]
fn panels_keep_their_width_while_numbers_change() {
    let mut harness = EditorHarness::new();
    let left = |harness: &EditorHarness| harness.window.get_by_label("look_at x").rect().left();
    let before = left(&harness);
    harness.window.key_down(Key::ArrowRight);
    harness.window.key_down(Key::W);
    // Past the back, where one of the numbers is nearly nothing.
    for _ in 0..300 {
        harness.window.step();
        assert_eq!(left(&harness), before);
    }
}

#[test]
fn a_field_that_is_left_as_it_was_changes_nothing() {
    let mut harness = EditorHarness::new();
    for field in ["view angle", "distance", "yaw", "look_at x", "position y"] {
        harness
            .window
            .get_by_role_and_label(Role::SpinButton, field)
            .click();
        harness.settle();
        harness.press(Modifiers::NONE, Key::Enter);
        assert!(!harness.editor().is_dirty(), "{field}");
    }
}

#[test]
fn saving_works_from_within_a_field() {
    let text = Document::empty().to_text().expect("a text");
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&text));
    harness
        .window
        .get_by_role_and_label(Role::SpinButton, "position x")
        .click();
    harness.settle();
    harness.window.event(Event::Text("12.5".to_owned()));
    harness.settle();
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
