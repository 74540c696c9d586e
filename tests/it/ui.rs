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
use glint::scene::{Document, Method as _, Projection, Scene, Shape};
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
        let mut desk = Self { window, folder };
        desk.settle();
        desk
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
        Shape::Sphere { radius, .. } => radius,
        _ => panic!("not a sphere"),
    }
}

#[test]
fn the_window_opens_on_the_demo_and_shows_its_picture() {
    let desk = EditorHarness::new();
    assert_eq!(desk.scene(), &Scene::demo());
    let shown = desk.picture();
    let smooth = RenderRequest {
        sampling: Sampling::ADAPTIVE,
        ..RenderRequest::sized(shown.width as u32, shown.height as u32)
    };
    let direct = render(desk.scene(), &smooth, &RenderControl::default())
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
    let mut desk = EditorHarness::new();
    let before = desk.picture();
    desk.click("Sphere 1");
    desk.drag("radius", 40.0);
    assert!(
        radius(desk.scene(), 0) > 55.0,
        "{}",
        radius(desk.scene(), 0)
    );
    assert!(desk.picture() != before, "the edit is traced");
    assert_eq!(desk.editor().undo_label(), Some("Sphere 1: radius"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.scene(), &Scene::demo());
    assert_eq!(desk.editor().undo_label(), None, "a drag is one step");
    assert!(desk.picture() == before);
    desk.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert!(radius(desk.scene(), 0) > 55.0);
}

#[test]
fn a_pack_is_edited_for_all_that_use_it() {
    let mut desk = EditorHarness::new();
    desk.click("tetrahedron");
    desk.type_into("diffuse red", "12");
    desk.type_into("ambient hex", "#0A141E");
    desk.type_into("phong", "64");
    desk.click("reflective");
    let pack = &desk.scene().color_packs["tetrahedron"];
    assert_eq!(pack.diffuse.to_array(), [12.0, 255.0, 255.0]);
    assert_eq!(pack.ambient.to_array(), [10.0, 20.0, 30.0]);
    assert_eq!((pack.phong_exponent, pack.reflective), (64.0, true));
    desk.click("Go to Triangle 3");
    desk.window.get_by_role_and_label(Role::SpinButton, "a x");
}

#[test]
fn looking_at_a_pack_changes_nothing() {
    let mut desk = EditorHarness::new();
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
        desk.window
            .get_all_by_label(name)
            .next()
            .expect("a row")
            .click();
        desk.settle();
        assert!(!desk.editor().is_dirty(), "{name}");
    }
}

#[test]
fn a_vector_is_pasted_whole_and_a_label_resets() {
    let mut desk = EditorHarness::new();
    desk.click("Sphere 1");
    desk.type_into("center y", "1, -2, 3.5");
    let Shape::Sphere { center, .. } = &desk.scene().objects[0].shape else {
        panic!("a sphere")
    };
    assert_eq!(center.to_array(), [1.0, -2.0, 3.5]);
    desk.type_into("radius", "7");
    desk.double_click("radius");
    assert_eq!(radius(desk.scene(), 0), 50.0);
}

#[test]
fn invalid_edits_are_refused_and_explained() {
    let mut desk = EditorHarness::new();
    desk.window
        .get_by_role_and_label(Role::Button, "Camera")
        .click();
    desk.settle();
    desk.type_into("up x", "-0.25, -0.25, -0.93");
    assert_eq!(desk.scene(), &Scene::demo());
    desk.window
        .get_by_label_contains("up must not be parallel to look_at");
    desk.click("Dismiss");
    assert!(desk.window.query_by_label_contains("parallel").is_none());
}

#[test]
fn keys_switch_projection_markers_and_resolution() {
    let mut desk = EditorHarness::new();
    desk.press(Modifiers::NONE, Key::O);
    assert_eq!(desk.scene().camera.projection, Projection::Orthographic);
    desk.press(Modifiers::NONE, Key::P);
    assert_eq!(desk.scene().camera.projection, Projection::Perspective);
    desk.press(Modifiers::NONE, Key::U);
    assert!(!desk.scene().light_visualization);
    desk.press(Modifiers::NONE, Key::I);
    assert!(desk.scene().light_visualization);
    desk.press(Modifiers::NONE, Key::L);
    assert_eq!(
        (
            desk.editor().mode,
            desk.picture().width,
            desk.picture().height
        ),
        (Mode::LowRes, 64, 64)
    );
    desk.press(Modifiers::NONE, Key::H);
    assert_eq!(
        (desk.editor().mode, desk.picture().width),
        (Mode::HighRes, 1024)
    );
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.editor().mode, Mode::Live);
    desk.press(Modifiers::NONE, Key::Escape);
    desk.window.get_by_label("Quit Glint?");
    desk.click("Stay");
    assert!(desk.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn the_still_picture_stays_until_the_scene_changes() {
    let mut desk = EditorHarness::new();
    desk.press(Modifiers::NONE, Key::H);
    let still = render(
        desk.scene(),
        &RenderRequest::still(desk.scene()),
        &RenderControl::default(),
    );
    assert!(desk.picture() == still.expect("not stopped").0);
    desk.click("Sphere 2");
    assert_eq!(
        desk.editor().mode,
        Mode::HighRes,
        "looking elsewhere keeps it"
    );
    desk.type_into("radius", "30");
    assert_eq!(desk.editor().mode, Mode::Live);
    assert!(desk.picture().width < 1024);
}

#[test]
fn flying_is_per_second_and_one_step() {
    let mut desk = EditorHarness::new();
    let start = desk.scene().camera.clone();
    desk.window.key_down(Key::W);
    desk.window.key_down(Key::ArrowRight);
    for _ in 0..30 {
        desk.window.step();
    }
    desk.window.key_up(Key::W);
    desk.window.key_up(Key::ArrowRight);
    desk.settle();
    let end = desk.scene().camera.clone();
    let flown = (end.position - start.position).length();
    // Half a second at a quarter of the scene's extent (about 320) per second.
    assert!((20.0..80.0).contains(&flown), "{flown}");
    assert!(
        end.look_at.x > start.look_at.try_normalize().expect("a direction").x,
        "turned right"
    );
    assert_eq!(desk.editor().undo_label(), Some("Camera: move"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.scene().camera, start);
    assert_eq!(desk.editor().undo_label(), None);
}

#[test]
fn the_right_button_looks_around() {
    let mut desk = EditorHarness::new();
    let start = desk.editor().orientation();
    let middle = desk.window.get_by_label("Live view").rect().center();
    let button = |pressed, pos| Event::PointerButton {
        pos,
        button: egui::PointerButton::Secondary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    desk.window.hover_at(middle);
    desk.window.step();
    desk.window.event(button(true, middle));
    desk.window.step();
    for n in 1..=4 {
        desk.window
            .hover_at(middle + egui::vec2(10.0 * n as f32, -5.0 * n as f32));
        desk.window.step();
    }
    desk.window
        .event(button(false, middle + egui::vec2(40.0, -20.0)));
    desk.settle();
    let end = desk.editor().orientation();
    assert!(
        end.yaw > start.yaw + 0.1 && end.pitch > start.pitch + 0.05,
        "{start:?} {end:?}"
    );
    assert!((end.roll - start.roll).abs() < 1e-9);
}

#[test]
fn keys_do_nothing_while_a_text_is_edited() {
    let mut desk = EditorHarness::new();
    desk.window.get_by_label("Filter").focus();
    desk.settle();
    for key in [Key::O, Key::U, Key::W, Key::L] {
        desk.press(Modifiers::NONE, key);
    }
    assert_eq!(desk.scene(), &Scene::demo());
    assert_eq!(desk.editor().mode, Mode::Live);
}

#[test]
fn the_outliner_filters_hides_renames_and_reorders() {
    let mut desk = EditorHarness::new();
    desk.window.get_by_label("Filter").focus();
    desk.window.get_by_label("Filter").type_text("sphere");
    desk.settle();
    assert!(desk.window.query_by_label("Plane").is_none());
    assert!(desk.window.query_by_label("Sphere 2").is_some());
    desk.click("Hide Sphere 2");
    assert!(!desk.scene().objects[1].visible);
    desk.click("Sphere 1");
    desk.press(Modifiers::ALT, Key::ArrowDown);
    assert_eq!(desk.scene().objects[1].name, "Sphere 1");
    desk.press(Modifiers::NONE, Key::F2);
    desk.window.event(Event::Text("Sphere of glass".to_owned()));
    desk.settle();
    desk.press(Modifiers::NONE, Key::Enter);
    assert_eq!(desk.scene().objects[1].name, "Sphere of glass");
    desk.press(Modifiers::COMMAND, Key::D);
    assert_eq!(desk.scene().objects.len(), 10);
    desk.press(Modifiers::NONE, Key::Delete);
    assert_eq!(desk.scene().objects.len(), 9);
}

#[test]
fn everything_can_be_added() {
    let mut desk = EditorHarness::new();
    for (entry, count) in [("Add Sphere", 10), ("Add Plane", 11), ("Add Triangle", 12)] {
        desk.window
            .get_by_role_and_label(Role::Button, "Add to scene")
            .click();
        desk.settle();
        desk.click(entry);
        assert_eq!(desk.scene().objects.len(), count);
    }
    desk.window
        .get_by_role_and_label(Role::Button, "Add to scene")
        .click();
    desk.settle();
    desk.click("Add Light");
    assert_eq!(desk.scene().lights.len(), 3);
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
    let mut desk = EditorHarness::with(answers, None);
    desk.click("Sphere 1");
    desk.type_into("radius", "33");
    desk.press(Modifiers::COMMAND, Key::S);
    let path = desk.folder.path().join("mine.ron");
    let saved = Document::load(&path).expect("valid");
    assert_eq!(radius(&saved.scene, 0), 33.0);
    assert!(saved.header.starts_with("// The demo scene"));
    assert!(!desk.editor().is_dirty());
    assert_eq!(desk.editor().title(), "mine.ron");
    desk.press(Modifiers::COMMAND, Key::N);
    assert!(desk.scene().objects.is_empty());
    desk.press(Modifiers::COMMAND, Key::O);
    assert_eq!(desk.scene(), &saved.scene);
    desk.choose("File", "Open demo");
    desk.window
        .get_by_role_and_label(Role::Button, "File")
        .click();
    desk.settle();
    desk.window.get_by_label_contains("Open recent").click();
    desk.settle();
    desk.click("mine.ron");
    assert_eq!(desk.scene(), &saved.scene);
}

#[test]
fn without_dialogs_a_path_is_typed() {
    let mut desk = EditorHarness::new();
    let path = desk.folder.path().join("typed.ron");
    desk.press(Modifiers::COMMAND, Key::S);
    let field = desk.window.get_by_label_contains("Path (this desktop");
    field.set_text_value_accesskit(path.to_str().expect("text"));
    desk.settle();
    desk.click("Save file");
    assert!(path.exists());
    assert_eq!(desk.editor().path(), Some(path.as_path()));
}

#[test]
fn the_still_picture_is_written_to_a_file() {
    let answers =
        |folder: &std::path::Path| vec![(Ask::SaveImage, Some(folder.join("picture.png")))];
    let mut desk = EditorHarness::with(answers, None);
    desk.press(Modifiers::COMMAND, Key::E);
    let path = desk.folder.path().join("picture.png");
    let start = Instant::now();
    while !path.exists() && start.elapsed() < Duration::from_secs(30) {
        desk.window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    desk.settle();
    let saved = image::open(path).expect("a picture").to_rgba8();
    assert_eq!(saved.into_raw(), desk.picture().pixels.concat());
}

#[test]
fn unsaved_changes_are_asked_about() {
    let mut desk = EditorHarness::with(
        |folder| vec![(Ask::SaveScene, Some(folder.join("kept.ron")))],
        None,
    );
    desk.press(Modifiers::NONE, Key::O);
    desk.press(Modifiers::COMMAND, Key::N);
    desk.window.get_by_label("Save changes to demo?");
    desk.click("Keep editing");
    assert!(desk.editor().is_dirty());
    desk.press(Modifiers::COMMAND, Key::N);
    desk.click("Save changes");
    assert!(desk.folder.path().join("kept.ron").exists());
    assert!(
        desk.scene().objects.is_empty(),
        "then the new scene is there"
    );
    desk.choose("Add", "Add ColorPack");
    desk.press(Modifiers::COMMAND, Key::N);
    desk.click("Don't save");
    assert_eq!(desk.scene(), &Scene::empty());
}

#[test]
fn a_refused_file_is_shown_with_its_place_and_the_document_stays() {
    let answers = |folder: &std::path::Path| vec![(Ask::OpenScene, Some(folder.join("given.ron")))];
    let text = "Scene(\n    version: 1,\n    objects: [5],\n)\n";
    let mut desk = EditorHarness::with(answers, Some(text));
    desk.window
        .get_by_label_contains("given.ron:3:15: expected Object(…)");
    assert_eq!(desk.scene(), &Scene::demo());
    desk.click("Dismiss");
    desk.press(Modifiers::COMMAND, Key::O);
    desk.window.get_by_label_contains("given.ron:3:15");
    assert_eq!(desk.scene(), &Scene::demo());
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
    let mut desk = EditorHarness::new();
    let path = desk.folder.path().join("dropped.ron");
    let document = Document {
        header: String::new(),
        scene: Scene::empty(),
    };
    document.save(&path).expect("saved");
    desk.window
        .input_mut()
        .dropped_files
        .push(std::sync::Arc::new(OnDisk(path)));
    desk.settle();
    assert_eq!(desk.scene(), &Scene::empty());
    assert_eq!(desk.editor().title(), "dropped.ron");
}

#[test]
fn escape_closes_an_open_menu_and_nothing_else() {
    let mut desk = EditorHarness::new();
    desk.press(Modifiers::NONE, Key::L);
    desk.window
        .get_by_role_and_label(Role::Button, "File")
        .click();
    desk.settle();
    assert!(desk.window.query_by_label("Save as…").is_some());
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(desk.window.query_by_label("Save as…").is_none());
    assert_eq!(desk.editor().mode, Mode::LowRes);
}

#[test]
fn help_lists_every_key() {
    let mut desk = EditorHarness::new();
    desk.press(Modifiers::NONE, Key::F1);
    for what in SHORTCUTS
        .iter()
        .map(|shortcut| shortcut.what)
        .chain(FLIGHT.iter().map(|key| key.what))
    {
        assert!(
            desk.window.query_all_by_label(what).next().is_some(),
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
            shape: Shape::Sphere {
                center: glam::DVec3::new(f64::from(n), 0.0, 0.0),
                radius: 0.4,
            },
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
    let desk = EditorHarness::with(|_| Vec::new(), Some(&text));
    let rows = desk.window.query_all_by_label_contains("Ball").count();
    assert!((10..200).contains(&rows), "{rows}");
    let picture = desk.window.get_by_label("Live view").rect();
    assert!(
        picture.left() > 200.0 && picture.right() < 980.0,
        "{picture:?}: panels keep their width"
    );
}

#[test]
fn escape_in_a_field_gives_up_what_was_typed_and_nothing_else() {
    let mut desk = EditorHarness::new();
    desk.click("Sphere 1");
    desk.window
        .get_by_role_and_label(Role::SpinButton, "radius")
        .click();
    desk.settle();
    desk.window.event(Event::Text("3".to_owned()));
    desk.settle();
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.scene(), &Scene::demo());
    desk.press(Modifiers::NONE, Key::F2);
    desk.window.event(Event::Text("q".to_owned()));
    desk.settle();
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.scene(), &Scene::demo());
    desk.window.get_by_label("Filter").focus();
    desk.settle();
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(desk.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn a_held_key_commands_once() {
    let mut desk = EditorHarness::new();
    desk.click("Sphere 1");
    for repeat in [false, true, true, true] {
        desk.window
            .event(Event::ModifiersChanged(Modifiers::COMMAND));
        desk.window.event(Event::Key {
            key: Key::D,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: Modifiers::COMMAND,
        });
        desk.window.step();
    }
    desk.window.key_up_modifiers(Modifiers::COMMAND, Key::D);
    desk.window.event(Event::ModifiersChanged(Modifiers::NONE));
    desk.settle();
    assert_eq!(desk.scene().objects.len(), 10);
    let Shape::Sphere { center, radius } = &desk.scene().objects[1].shape else {
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
    let mut desk = EditorHarness::new();
    let start = desk.scene().camera.position;
    let frames = |desk: &mut EditorHarness, count| (0..count).for_each(|_| desk.window.step());
    desk.window.event(Event::ModifiersChanged(CTRL));
    frames(&mut desk, 30);
    desk.window.event(Event::ModifiersChanged(Modifiers::NONE));
    desk.settle();
    assert!(
        desk.scene().camera.position.y < start.y - 5.0,
        "by itself, after a moment"
    );
    let height = desk.scene().camera.position.y;
    desk.window.key_down(Key::D);
    frames(&mut desk, 5);
    desk.window.event(Event::ModifiersChanged(CTRL));
    desk.window.key_down_modifiers(CTRL, Key::D);
    frames(&mut desk, 10);
    desk.window.key_up(Key::D);
    desk.window.event(Event::ModifiersChanged(Modifiers::NONE));
    desk.settle();
    assert_eq!(desk.scene().objects.len(), 9, "no duplicate");
    assert!(
        desk.scene().camera.position.y < height,
        "down at once in flight"
    );
}

#[test]
fn shortcuts_work_after_flying_into_the_still_picture() {
    let mut desk = EditorHarness::new();
    let start = desk.scene().camera.clone();
    desk.window.key_down(Key::W);
    (0..5).for_each(|_| desk.window.step());
    desk.press(Modifiers::NONE, Key::H);
    desk.window.key_up(Key::W);
    desk.settle();
    assert_eq!(desk.editor().mode, Mode::HighRes);
    desk.press(CTRL, Key::Z);
    assert_eq!(desk.scene().camera, start);
}

#[test]
fn a_turn_of_the_wheel_is_one_step_and_spares_the_still_picture() {
    let mut desk = EditorHarness::new();
    let start = desk.scene().camera.clone();
    let turn = |desk: &mut EditorHarness| {
        let middle = desk
            .window
            .get_all_by_role(Role::Image)
            .next()
            .expect("a picture")
            .rect()
            .center();
        desk.window.hover_at(middle);
        desk.window.step();
        desk.window.event(Event::MouseWheel {
            unit: egui::MouseWheelUnit::Line,
            delta: egui::vec2(0.0, 1.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        (0..40).for_each(|_| desk.window.step());
        desk.settle();
    };
    turn(&mut desk);
    assert_ne!(desk.scene().camera.position, start.position);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.scene().camera, start);
    desk.press(Modifiers::NONE, Key::H);
    turn(&mut desk);
    assert_eq!(
        (desk.editor().mode, &desk.scene().camera),
        (Mode::HighRes, &start)
    );
}

#[test]
fn unsaved_changes_survive_a_cancelled_open() {
    let mut desk = EditorHarness::new();
    desk.press(Modifiers::NONE, Key::O);
    desk.press(Modifiers::COMMAND, Key::O);
    desk.click("Don't save");
    desk.window.get_by_label("Open scene");
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(
        desk.editor().is_dirty(),
        "nothing took the document's place"
    );
}

#[test]
fn a_label_brings_the_default_back() {
    let mut desk = EditorHarness::new();
    desk.window
        .get_by_role_and_label(Role::Button, "Camera")
        .click();
    desk.settle();
    desk.type_into("up x", "0.5, 0.5, 0.5");
    desk.double_click("up");
    assert_eq!(desk.scene(), &Scene::demo());
}

#[test]
fn the_inspector_says_what_the_scene_needs() {
    let mut desk = EditorHarness::new();
    desk.window.get_by_label("Needs").click();
    desk.settle();
    desk.window.get_by_label("reflected rays, up to 1 bounce");
    desk.window
        .get_by_label("because everything the camera can reach is on its side of every plane");
}

#[test]
fn the_lab_measures_shows_a_dot_and_adopts_it_in_one_step() {
    let mut desk = EditorHarness::new();
    let before = desk.scene().clone();
    desk.press(CTRL, Key::L);
    desk.click("Measure");
    let start = Instant::now();
    while desk.window.query_by_label("Cancel measuring").is_some() {
        assert!(start.elapsed() < Duration::from_mins(2), "never measured");
        std::thread::sleep(Duration::from_millis(50));
        desk.window.step();
    }
    assert!(
        desk.window.query_by_label("Use this").is_none(),
        "no dot is chosen"
    );
    // Of all ways, plain adaptive sampling or one of its neighbours is the cheapest within 8 bits.
    desk.click("Cheapest within");
    desk.window.get_by_label("Lab picture");
    assert!(desk.window.query_by_label("stale").is_none());
    desk.click("×64");
    let steps = desk.editor().undo_label().map(str::to_owned);
    desk.click("Use this");
    assert_eq!(steps, None);
    assert_eq!(
        desk.editor().undo_label(),
        Some("Render: settings from the lab")
    );
    let sampling = desk.scene().render.antialias;
    assert!(
        matches!(sampling, Sampling::Adaptive { .. }),
        "{sampling:?}"
    );
    assert!(
        desk.window.query_by_label("stale").is_none(),
        "settings are what is compared"
    );
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(desk.window.query_by_label("Lab picture").is_none());
    desk.press(CTRL, Key::Z);
    assert_eq!(*desk.scene(), before);
    desk.press(Modifiers::NONE, Key::O);
    desk.window.get_by_label("stale");
    desk.press(CTRL, Key::L);
    assert!(desk.window.query_by_label("Measure").is_none());
}

#[test]
fn the_lab_shows_where_formulas_break_and_warns_of_those_in_use() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron"));
    let text = text.expect("the demo").replace(
        "reflection_limit: 1",
        "reflection_limit: 1, triangle: \"edges\"",
    );
    let mut desk = EditorHarness::with(|_| Vec::new(), Some(&text));
    assert_eq!(desk.scene().render.triangle.word(), "edges");
    desk.press(CTRL, Key::L);
    desk.click("Stability");
    let start = Instant::now();
    while desk
        .window
        .query_all_by_label_contains("stable")
        .next()
        .is_none()
    {
        assert!(start.elapsed() < Duration::from_mins(1), "no maps");
        std::thread::sleep(Duration::from_millis(20));
        desk.window.step();
    }
    desk.window
        .get_by_label("The frame is where your scene stands.");
    let row = |desk: &EditorHarness, words: &str| {
        let rows = desk.window.query_all_by_label_contains(words);
        rows.last().map(|row| row.rect().center())
    };
    for (method, warned) in [("edges", true), ("watertight", false)] {
        let at = row(&desk, method).expect("a row");
        desk.window.drag_at(at);
        desk.window.drop_at(at);
        desk.settle();
        let mut warnings = desk
            .window
            .query_all_by_label_contains("Your scene uses this");
        assert_eq!(warnings.next().is_some(), warned, "{method}");
    }
}

#[test]
fn panels_keep_their_width_while_numbers_change() {
    let mut desk = EditorHarness::new();
    let left = |desk: &EditorHarness| desk.window.get_by_label("look_at x").rect().left();
    let before = left(&desk);
    desk.window.key_down(Key::ArrowRight);
    desk.window.key_down(Key::W);
    // Past the back, where one of the numbers is nearly nothing.
    for _ in 0..300 {
        desk.window.step();
        assert_eq!(left(&desk), before);
    }
}

#[test]
fn a_field_that_is_left_as_it_was_changes_nothing() {
    let mut desk = EditorHarness::new();
    for field in ["view angle", "distance", "yaw", "look_at x", "position y"] {
        desk.window
            .get_by_role_and_label(Role::SpinButton, field)
            .click();
        desk.settle();
        desk.press(Modifiers::NONE, Key::Enter);
        assert!(!desk.editor().is_dirty(), "{field}");
    }
}

#[test]
fn saving_works_from_within_a_field() {
    let text = Document::empty().to_text().expect("a text");
    let mut desk = EditorHarness::with(|_| Vec::new(), Some(&text));
    desk.window
        .get_by_role_and_label(Role::SpinButton, "position x")
        .click();
    desk.settle();
    desk.window.event(Event::Text("12.5".to_owned()));
    desk.settle();
    desk.press(CTRL, Key::S);
    desk.settle();
    assert!(!desk.editor().is_dirty());
    let file = desk.folder.path().join("given.ron");
    let saved = Document::load(&file).expect("a scene").scene;
    assert_eq!(
        saved.camera.position.x, 12.5,
        "what was typed is in the file"
    );
}
