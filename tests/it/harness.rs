//! The window without a display, and functions to operate it.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{
    Context, Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, TexturesDelta,
    TouchPhase, vec2,
};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, TestRenderer};
use glint::editor::{Action, Editor, Time};
use glint::image::Image;
use glint::scene::{Document, Scene, Shape, Sphere};
use glint::trace::{RenderControl, SceneQuery, survey};
use glint::ui::{App, Ask, Dialogs, Setup};
use glint::worker::Background;

use crate::PATIENCE;

/// Dialogs that answer from a list; when it is used up, they behave as on a desktop without dialogs.
pub struct Scripted(VecDeque<(Ask, Option<PathBuf>)>);

impl Dialogs for Scripted {
    fn ask(&mut self, _: &Context, ask: &Ask, _: PathBuf) -> Background<Option<PathBuf>> {
        let (sender, receiver) = channel();
        let answer = self.0.pop_front().map(|(expected, answer)| {
            assert_eq!(expected, *ask);
            answer
        });
        sender
            .send(answer.flatten())
            .expect("the receiver is there");
        receiver.into()
    }
}

/// A file that is dropped onto the window.
#[derive(Debug)]
struct OnDisk(PathBuf);

impl egui::DroppedFile for OnDisk {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// A renderer that draws nothing. The usual one keeps every part of a texture that was ever sent to it.
struct Unseen;

impl TestRenderer for Unseen {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        delta.clear();
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
        answers: impl FnOnce(&Path) -> Vec<(Ask, Option<PathBuf>)>,
        scene: Option<&str>,
    ) -> Self {
        Self::asked(|folder| Box::new(Scripted(answers(folder).into())), scene)
    }

    /// A window on a scene, with no answers.
    pub fn on(scene: Scene) -> Self {
        let text = Document::of(scene).to_text();
        Self::with(|_| Vec::new(), Some(&text.expect("a text")))
    }

    /// A window with these dialogs on a scene text (or the demo).
    pub fn asked(dialogs: impl FnOnce(&Path) -> Box<dyn Dialogs>, scene: Option<&str>) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let dialogs = dialogs(folder.path());
        let scene = scene.map(|text| {
            let path = folder.path().join("given.ron");
            std::fs::write(&path, text).expect("written");
            path
        });
        Self::open(folder, dialogs, scene, None)
    }

    /// A window on a scene file, with `data` as the program's data folder.
    pub fn kept_in(data: &Path, scene: PathBuf) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let dialogs = Box::new(Scripted(VecDeque::new()));
        Self::open(folder, dialogs, Some(scene), Some(data.to_owned()))
    }

    fn open(
        folder: tempfile::TempDir,
        dialogs: Box<dyn Dialogs>,
        scene: Option<PathBuf>,
        data_folder: Option<PathBuf>,
    ) -> Self {
        let window = Harness::builder()
            .with_size([1280.0, 800.0])
            .with_step_dt(1.0 / 60.0)
            .with_max_steps(32)
            .renderer(Unseen)
            .build_eframe(move |cc| {
                App::new(
                    cc,
                    Setup {
                        scene,
                        dialogs,
                        data_folder,
                        screenshot: None,
                        start: None,
                        exports: false,
                        select: Vec::new(),
                    },
                )
                .expect("a render thread")
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
                start.elapsed() < PATIENCE,
                "the picture never came of {:?}",
                self.editor().to_text()
            );
            // The window takes each step for a sixtieth of a second: on a busy machine, many steps would outlast
            // its messages.
            std::thread::sleep((start.elapsed() / 8).max(Duration::from_millis(2)));
            self.window.step();
        }
        self.window.step();
    }

    /// Steps until a condition holds; in real time, as messages disappear after a while.
    pub fn wait_for(&mut self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !is_so(self) {
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
            std::thread::sleep(Duration::from_millis(16));
            self.window.step();
        }
        // A new widget is measured in its first frame and visible in its second.
        self.window.step();
    }

    /// Returns whether the window shows a text that contains these words.
    pub fn sees(&self, words: &str) -> bool {
        let mut seen = self.window.query_all_by_label_contains(words);
        seen.next().is_some()
    }

    /// Asserts that the window shows one text that contains these words.
    #[track_caller]
    pub fn assert_says(&self, words: &str) {
        self.window.get_by_label_contains(words);
    }

    pub fn editor(&self) -> &Editor {
        self.window.state().editor()
    }

    /// The names of the selected items.
    pub fn selected(&self) -> Vec<&str> {
        let items = self.editor().selection().items().iter();
        items.filter_map(|item| item.name(self.scene())).collect()
    }

    pub fn scene(&self) -> &Scene {
        self.editor().scene()
    }

    /// Rectangle of the picture in the window.
    pub fn view(&self) -> egui::Rect {
        let mut pictures = self.window.get_all_by_role(Role::Image);
        pictures.next().expect("a picture").rect()
    }

    pub fn picture(&self) -> Image {
        self.window
            .state()
            .shown_picture()
            .expect("a picture")
            .clone()
    }

    /// Drops a file onto the window.
    pub fn drop_file(&mut self, path: PathBuf) {
        self.drop_files([path]);
    }

    /// Drops several files at once.
    pub fn drop_files(&mut self, paths: impl IntoIterator<Item = PathBuf>) {
        let dropped = &mut self.window.input_mut().dropped_files;
        for path in paths {
            dropped.push(Arc::new(OnDisk(path)));
        }
        self.settle();
    }

    pub fn click(&mut self, name: &str) {
        self.window.get_by_label(name).click();
        self.settle();
    }

    /// The middle of what has this name.
    pub fn middle_of(&self, name: &str) -> Pos2 {
        self.window.get_by_label(name).rect().center()
    }

    /// Clicks while these modifier keys are held.
    pub fn click_with(&mut self, modifiers: Modifiers, name: &str) {
        self.window.get_by_label(name).click_modifiers(modifiers);
        self.settle();
    }

    /// Turns the mouse wheel.
    pub fn turn_wheel(&mut self, unit: MouseWheelUnit, amount: f32) {
        self.window.event(Event::MouseWheel {
            unit,
            delta: vec2(0.0, amount),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
    }

    /// Clicks at a position in the window.
    pub fn click_at(&mut self, at: Pos2) {
        self.window.drag_at(at);
        self.window.drop_at(at);
        self.settle();
    }

    pub fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.settle();
    }

    /// Holds a key down for this many frames.
    pub fn hold(&mut self, key: Key, frames: usize) {
        self.window.key_down(key);
        (0..frames).for_each(|_| self.window.step());
        self.window.key_up(key);
        self.settle();
    }

    /// Clicks the button with this name, where other widgets have the same name.
    pub fn press_button(&mut self, name: &str) {
        self.window
            .get_by_role_and_label(Role::Button, name)
            .click();
        self.settle();
    }

    /// Opens a menu and chooses one of its entries.
    pub fn choose(&mut self, menu: &str, entry: &str) {
        self.press_button(menu);
        self.click(entry);
    }

    /// Opens a combo box in a panel.
    pub fn unfold(&mut self, choice: &str) {
        self.window
            .get_by_role_and_label(Role::ComboBox, choice)
            .click();
        self.settle();
    }

    /// Types a text where the cursor is.
    pub fn type_text(&mut self, text: &str) {
        self.window.event(Event::Text(text.to_owned()));
        self.settle();
    }

    /// Clicks a number to edit it as text.
    pub fn put_cursor_into(&mut self, field: &str) {
        self.window
            .get_by_role_and_label(Role::SpinButton, field)
            .click();
        self.settle();
    }

    /// Replaces the number in a field by typing.
    pub fn type_into(&mut self, field: &str, text: &str) {
        self.put_cursor_into(field);
        self.type_text(text);
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Presses the button on a number field and moves sideways in several steps. Returns where it was pressed.
    fn pull(&mut self, field: &str, points: f32) -> Pos2 {
        let field = self.window.get_by_role_and_label(Role::SpinButton, field);
        let start = field.rect().center();
        self.window.drag_at(start);
        self.window.step();
        for part in 1..=5 {
            self.window
                .hover_at(start + vec2(points * part as f32 / 5.0, 0.0));
            self.window.step();
        }
        start
    }

    /// Drags a number, calls `meanwhile`, and cancels the drag with Escape; the button stays down. Returns the
    /// pointer's position.
    pub fn give_up_dragging(&mut self, field: &str, meanwhile: impl FnOnce(&Self)) -> Pos2 {
        let start = self.pull(field, 40.0);
        meanwhile(self);
        self.window.key_down(Key::Escape);
        self.window.step();
        self.window.key_up(Key::Escape);
        self.window.step();
        start
    }

    /// Replaces the text in a field by typing.
    pub fn type_name(&mut self, field: &str, text: &str) {
        self.window
            .get_by_role_and_label(Role::TextInput, field)
            .click();
        self.settle();
        self.press(CTRL, Key::A);
        self.type_text(text);
        self.press(Modifiers::NONE, Key::Enter);
    }

    /// Double-clicks a label, which resets its field to the default.
    pub fn double_click(&mut self, label: &str) {
        let at = self
            .window
            .get_by_role_and_label(Role::Label, label)
            .rect()
            .center();
        // Long enough after any other click, which would otherwise make it a triple click.
        (0..60).for_each(|_| self.window.step());
        for _ in 0..2 {
            self.window.drag_at(at);
            self.window.drop_at(at);
        }
        self.settle();
    }

    /// Drags a number field sideways in several moves.
    pub fn drag(&mut self, field: &str, points: f32) {
        let start = self.pull(field, points);
        self.window.drop_at(start + vec2(points, 0.0));
        self.settle();
    }
}

/// The radius of an object that is a sphere.
pub fn radius(scene: &Scene, object: usize) -> f64 {
    match scene.objects[object].shape {
        Shape::Sphere(Sphere { radius, .. }) => radius,
        _ => panic!("not a sphere"),
    }
}

/// Answers the editor's question about its recorded flight, as the window does.
pub fn survey_flight(editor: &mut Editor) {
    while let Some(take) = editor.wanted_survey().cloned() {
        let mut seen = Vec::new();
        let scene = editor.scene();
        let (query, aspect) = (SceneQuery::new(scene), scene.render.aspect_ratio());
        let control = RenderControl::default();
        assert!(survey(&take, &query, aspect, &mut seen, &control));
        editor.apply(Action::Time(Time::Surveyed(take, seen)));
    }
}
