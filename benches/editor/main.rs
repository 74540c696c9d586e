//! How soon an edit is visible, and what it costs the UI thread: `cargo bench --bench editor`.
//!
//! Everything runs without a display: the render thread is the real one; the window is driven headlessly, and its
//! shapes are tessellated as for a graphics card.

#![allow(
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a benchmark that cannot go on has failed"
)]

use std::cell::{Cell, RefCell};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use divan::Bencher;
use egui::accesskit::Role;
use egui::{Event, PointerButton, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use glint::editor::{Action, Edit, Editor};
use glint::image::{Image, render_into};
use glint::plan::{Planner, RenderRequest};
use glint::scene::{Document, Object, Sampling, Scene, Sphere};
use glint::trace::{RenderControl, Threads};
use glint::ui::{App, Setup};
use glint::worker::{BUDGET, Frame, LiveJob, Pace, Worker};

fn main() {
    divan::main();
}

const SIDE: u32 = 1024;

/// Size of the window when it is first opened.
const OPENED: Vec2 = vec2(1280.0, 800.0);

/// Reference for `published`: the same picture without the render thread.
#[divan::bench(sample_count = 100, sample_size = 1)]
fn plain_frame(bencher: Bencher) {
    let threads = Threads::new(None).expect("threads");
    let (scene, picture) = (Scene::demo(), RenderRequest::sized(SIDE, SIDE));
    let (mut image, mut planner) = (Image::default(), Planner::default());
    bencher.bench_local(|| {
        threads.run(|| {
            let control = RenderControl::default();
            render_into(&mut image, &mut planner, &scene, &picture, &control)
        })
    });
}

/// Time from an edit of the demo to its picture in full resolution, through the render thread, while the clean edges
/// of the previous revision are being traced.
#[divan::bench(sample_count = 100, sample_size = 1)]
fn published(bencher: Bencher) {
    let (sender, woken) = channel();
    let worker = Worker::new(None, move || {
        // The receiver may be gone when the last frame arrives; nobody waits for that one.
        let _ = sender.send(());
    })
    .expect("a render thread");
    let revision = Cell::new(0);
    let submit = || {
        revision.set(revision.get() + 1);
        let mut scene = Scene::demo();
        scene.camera.position.x += revision.get() as f64 * 0.01;
        worker.submit(LiveJob {
            revision: revision.get(),
            scene: Arc::new(scene),
            request: RenderRequest {
                sampling: Sampling::ADAPTIVE,
                ..RenderRequest::sized(SIDE, SIDE)
            },
            pace: Pace::Within(BUDGET),
        });
    };
    // Warm up: the render thread learns how fine the first picture can be.
    for _ in 0..20 {
        submit();
        wait(&worker, &woken, revision.get());
    }
    let between = || std::thread::sleep(Duration::from_millis(8));
    bencher.with_inputs(between).bench_local_values(|()| {
        submit();
        let frame = wait(&worker, &woken, revision.get());
        assert_eq!(
            frame.sampling,
            Sampling::Centres,
            "the plain picture comes first"
        );
    });
}

/// Waits for the first frame in full resolution of this revision.
fn wait(worker: &Worker, woken: &Receiver<()>, revision: u64) -> Frame {
    loop {
        woken.recv().expect("the render thread lives");
        if let Some(frame) = worker.take_frame()
            && frame.revision == revision
            && frame.step == 1
        {
            return frame;
        }
    }
}

/// One frame of the window while the camera is turned with the mouse: a new picture is received and uploaded,
/// everything is laid out, and the next picture is requested.
#[divan::bench(sample_count = 100, sample_size = 1)]
fn window_while_dragging(bencher: Bencher) {
    let harness = RefCell::new(EditorHarness::new());
    harness.borrow_mut().press();
    bencher
        .with_inputs(|| harness.borrow_mut().drag())
        .bench_local_values(|()| harness.borrow_mut().frame());
}

/// One frame of the window while the radius of an object is dragged, in scenes with this number of objects: the cost
/// of an edit must depend on what it changes, not on the size of the scene.
#[divan::bench(args = [10, 1_000, 100_000], sample_count = 60, sample_size = 1)]
fn window_while_a_number_is_dragged(bencher: Bencher, objects: u32) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("many.ron");
    std::fs::write(&path, many(objects)).expect("written");
    let harness = RefCell::new(EditorHarness::on(Some(path), OPENED));
    harness.borrow_mut().press_number();
    bencher
        .with_inputs(|| harness.borrow_mut().drag_number())
        .bench_local_values(|()| harness.borrow_mut().frame());
}

/// Five hundred moves of one object among a hundred thousand, each its own undo step. Prints the memory that the
/// steps take, if the system tells it.
#[divan::bench(sample_count = 1, sample_size = 1)]
fn five_hundred_steps_of_undo(bencher: Bencher) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("many.ron");
    std::fs::write(&path, many(100_000)).expect("written");
    let mut editor = Editor::demo();
    editor.open(Document::load_stamped(&path).expect("a scene"), &path);
    let before = resident_megabytes();
    bencher.bench_local(|| {
        for step in 0..500 {
            let mut object = editor.scene().objects[77_777].clone();
            object.shape = object.shape.moved(DVec3::X * f64::from(step % 7 - 3));
            editor.apply(Action::Edit(Edit::object(77_777, object, "center")));
            editor.end_gesture();
        }
    });
    if let (Some(before), Some(after)) = (before, resident_megabytes()) {
        // Memory freed after reading the scene is reused, so the difference alone would be too low.
        eprintln!("{:.1} MB more, {after:.0} MB in all", after - before);
    }
}

/// Resident memory of this process, if the system tells it.
fn resident_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kibibytes: f64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kibibytes / 1024.0)
}

/// A scene file of small balls in rows, all but ten hidden, so that the window is measured and not the tracer.
fn many(objects: u32) -> String {
    let document = Document {
        header: String::new(),
        scene: Scene {
            objects: (0..objects)
                .map(|number| {
                    let (column, row) = (f64::from(number % 400), f64::from(number / 400));
                    Object {
                        name: format!("Ball {number}"),
                        color_pack: "sphere 1".to_owned(),
                        shape: Sphere {
                            center: DVec3::new(column - 25.0, 1.0, -row - 50.0),
                            radius: 0.4,
                        }
                        .into(),
                        visible: number < 10,
                        group: String::new(),
                    }
                })
                .collect(),
            ..Scene::demo()
        },
    };
    document.to_text().expect("a text")
}

/// One frame of the window without any input.
#[divan::bench(sample_count = 100, sample_size = 1)]
fn window_at_rest(bencher: Bencher) {
    let mut harness = EditorHarness::new();
    bencher.bench_local(|| harness.frame());
}

struct EditorHarness {
    window: Harness<'static, App>,
    x: f32,
    /// Where the button was pressed on a number field.
    at: egui::Pos2,
    revision: u64,
}

impl EditorHarness {
    fn new() -> Self {
        let harness = Self::on(None, vec2(1680.0, 1200.0));
        let picture = harness.window.state().shown_picture().expect("a picture");
        let side = SIDE as usize;
        assert!(
            picture.width >= side && picture.height >= side,
            "a small picture"
        );
        harness
    }

    fn on(scene: Option<PathBuf>, size: Vec2) -> Self {
        let setup = Setup {
            data_folder: None,
            ..Setup::native(scene)
        };
        let window = Harness::builder()
            .with_size(size)
            .build_eframe(|cc| App::new(cc, setup).expect("a render thread"));
        let mut harness = Self {
            window,
            x: 800.0,
            at: pos2(0.0, 0.0),
            revision: 0,
        };
        let start = Instant::now();
        while !harness.window.state().is_settled() {
            assert!(start.elapsed() < Duration::from_mins(1), "no picture");
            harness.window.step();
        }
        harness
    }

    fn press(&mut self) {
        let pos = pos2(self.x, 500.0);
        self.window.event(Event::PointerMoved(pos));
        self.window.event(Event::PointerButton {
            pos,
            button: PointerButton::Secondary,
            pressed: true,
            modifiers: egui::Modifiers::NONE,
        });
        self.window.step();
        self.window
            .event(Event::PointerMoved(pos2(self.x + 9.0, 500.0)));
        self.window.step();
    }

    /// Selects the first object, and presses the button on its radius field.
    fn press_number(&mut self) {
        self.window.get_by_label("Ball 0").click();
        (0..4).for_each(|_| self.window.step());
        let field = self
            .window
            .get_by_role_and_label(Role::SpinButton, "radius");
        let pos = field.rect().center();
        self.at = pos;
        self.window.drag_at(pos);
        self.window.step();
        self.window.hover_at(pos + vec2(9.0, 0.0));
        self.window.step();
    }

    /// Moves the mouse on the number field. The previous edit must have been applied.
    fn drag_number(&mut self) {
        std::thread::sleep(Duration::from_millis(20));
        let revision = self.window.state().editor().revision();
        assert!(revision > self.revision, "nothing has changed");
        self.revision = revision;
        // To and fro: far enough to change a rounded number, but never up to its limit.
        self.x = if self.x > 25.0 { 20.0 } else { 30.0 };
        self.window.hover_at(self.at + vec2(self.x, 0.0));
    }

    /// Moves the mouse. The previous move must have been applied.
    fn drag(&mut self) {
        std::thread::sleep(Duration::from_millis(40));
        self.x = if self.x > 900.0 { 700.0 } else { self.x + 1.0 };
        let revision = self.window.state().editor().revision();
        assert!(revision > self.revision, "nothing has moved");
        self.revision = revision;
        self.window.event(Event::PointerMoved(pos2(self.x, 500.0)));
    }

    fn frame(&mut self) -> usize {
        self.window.step();
        let shapes = self.window.output().shapes.clone();
        self.window.ctx.tessellate(shapes, 1.0).len()
    }
}
