//! The viewport: modes, projections, flying.

use egui::{Event, Key, Modifiers, MouseWheelUnit};
use egui_kittest::kittest::Queryable as _;
use glint::editor::Mode;
use glint::plan::RenderRequest;
use glint::scene::{Projection, Sampling, Scene};

use super::tools::{button, drop_at, hover, pull};
use crate::harness::{CTRL, EditorHarness};
use crate::pictures::picture;

#[test]
fn the_window_opens_on_the_demo_and_shows_its_picture() {
    let harness = EditorHarness::new();
    assert_eq!(harness.scene(), &Scene::demo());
    let shown = harness.picture();
    let smooth = RenderRequest {
        sampling: Sampling::ADAPTIVE,
        ..RenderRequest::sized(shown.width as u32, shown.height as u32)
    };
    let direct = picture(harness.scene(), &smooth).0;
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
    // When a digit or letter is typed accidentally, a message says what it did.
    harness.press(Modifiers::NONE, Key::Num0);
    harness
        .window
        .get_by_label("Orthographic projection; P switches to perspective");
    harness.press(Modifiers::NONE, Key::P);
    harness.press(Modifiers::NONE, Key::Escape);
    harness.press(Modifiers::NONE, Key::Escape);
    harness.window.get_by_label("Quit Glint?");
    harness.click("Stay");
    assert!(harness.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn the_still_picture_stays_until_the_scene_changes() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::H);
    let still = RenderRequest::still(harness.scene());
    assert!(harness.picture() == picture(harness.scene(), &still).0);
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
    let middle = harness.middle_of("Live view");
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
fn escape_takes_a_look_around_back() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().clone();
    let middle = harness.view().center();
    let to = middle + egui::vec2(60.0, 20.0);
    let button = egui::PointerButton::Secondary;
    pull(&mut harness, middle, to, button, Modifiers::NONE);
    assert_ne!(harness.editor().shown().camera, start.camera);
    harness.window.key_press(Key::Escape);
    harness.window.step();
    assert_eq!(harness.editor().shown().camera, start.camera);
    // Releasing the button afterwards has no effect.
    hover(&mut harness, to + egui::vec2(40.0, 0.0));
    drop_at(&mut harness, to, button, Modifiers::NONE);
    assert_eq!(harness.scene(), &start);
    assert_eq!(harness.editor().undo_label(), None);
    assert!(!harness.sees("Esc once more"));
    // The next drag rotates the view again.
    pull(&mut harness, middle, to, button, Modifiers::NONE);
    drop_at(&mut harness, to, button, Modifiers::NONE);
    assert_ne!(harness.scene(), &start);
}

#[test]
fn escape_takes_what_was_flown_while_looking_around_back_and_flies_no_farther() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().clone();
    let middle = harness.view().center();
    let button = egui::PointerButton::Secondary;
    let to = middle + egui::vec2(60.0, 20.0);
    pull(&mut harness, middle, to, button, Modifiers::NONE);
    harness.window.key_down(Key::W);
    (0..5).for_each(|_| harness.window.step());
    let flown = harness.editor().shown().camera.position;
    assert_ne!(flown, start.camera.position);
    harness.window.key_press(Key::Escape);
    (0..5).for_each(|_| harness.window.step());
    assert_eq!(harness.editor().shown().camera, start.camera);
    drop_at(&mut harness, to, button, Modifiers::NONE);
    harness.window.key_up(Key::W);
    harness.settle();
    assert_eq!(harness.scene(), &start);
    assert_eq!(harness.editor().undo_label(), None);
}

#[test]
fn ctrl_flies_down_and_is_no_shortcut_in_flight() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.position;
    let frames =
        |harness: &mut EditorHarness, count| (0..count).for_each(|_| harness.window.step());
    // As the desktop reports it: the key, and the changed modifiers.
    let ctrl = |harness: &mut EditorHarness, is_down: bool| {
        harness.window.event(Event::Key {
            key: Key::ControlLeft,
            physical_key: None,
            pressed: is_down,
            repeat: false,
            modifiers: if is_down { CTRL } else { Modifiers::NONE },
        });
        let modifiers = if is_down { CTRL } else { Modifiers::NONE };
        harness.window.event(Event::ModifiersChanged(modifiers));
    };
    let middle = harness.view().center();
    harness.window.hover_at(middle);
    frames(&mut harness, 2);
    ctrl(&mut harness, true);
    frames(&mut harness, 30);
    ctrl(&mut harness, false);
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
        let middle = harness.view().center();
        harness.window.hover_at(middle);
        harness.window.step();
        harness.turn_wheel(MouseWheelUnit::Line, 1.0);
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
fn two_fingers_that_move_apart_zoom() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    let at = harness.view().center();
    hover(&mut harness, at);
    let pinch = |harness: &mut EditorHarness| {
        harness.window.event(Event::Zoom(2.0));
        (0..40).for_each(|_| harness.window.step());
        harness.settle();
    };
    pinch(&mut harness);
    let moved = harness.scene().camera.position - start.position;
    assert!(moved.dot(start.look_at) > 0.0, "{moved}");
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene().camera, start);
    harness.press(Modifiers::NONE, Key::H);
    pinch(&mut harness);
    harness.window.get_by_label("Leave High-res picture 1:1");
}

#[test]
fn the_still_picture_is_enlarged_moved_and_traced_in_part() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::H);
    let whole = harness.picture();
    let at = harness.view().center();
    hover(&mut harness, at);
    let turn = |harness: &mut EditorHarness, by: f32| {
        harness.turn_wheel(MouseWheelUnit::Line, by);
        // Longer than one notch takes.
        (0..10).for_each(|_| harness.window.step());
        harness.settle();
    };
    turn(&mut harness, 1.0);
    harness.window.get_by_label("Leave High-res picture 1:1");
    turn(&mut harness, 1.0);
    harness.window.get_by_label("Leave High-res picture 2:1");
    // Another picture is shown as a whole.
    harness.press(Modifiers::NONE, Key::Escape);
    harness.press(Modifiers::NONE, Key::H);
    harness.picture();
    harness.window.get_by_label("Leave High-res picture");
    turn(&mut harness, 1.0);
    turn(&mut harness, 1.0);
    harness.window.get_by_label("Leave High-res picture 2:1");
    turn(&mut harness, -1.0);
    turn(&mut harness, -1.0);
    harness.window.get_by_label("Leave High-res picture");
    let (from, to) = (at - egui::vec2(60.0, 40.0), at + egui::vec2(20.0, 30.0));
    let primary = egui::PointerButton::Primary;
    pull(&mut harness, from, to, primary, Modifiers::SHIFT);
    drop_at(&mut harness, to, primary, Modifiers::SHIFT);
    harness.window.get_by_label("Leave High-res, partial");
    assert!(harness.picture() == whole, "all of it is there already");
    harness.press(Modifiers::NONE, Key::U);
    harness.press(Modifiers::NONE, Key::H);
    let part = harness.picture();
    let traced = part.pixels.iter().filter(|pixel| pixel[3] == 255).count();
    assert!((4_000..40_000).contains(&traced), "{traced}");
    // Escape leads to the whole picture first, and only then to the live view.
    harness.press(Modifiers::NONE, Key::Escape);
    let whole = harness.picture();
    let same = part.pixels.iter().zip(&whole.pixels);
    assert!(same.filter(|(part, _)| part[3] == 255).all(|(a, b)| a == b));
    assert!(whole.pixels.iter().all(|pixel| pixel[3] == 255));
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.editor().mode, Mode::Live);
}

#[test]
fn the_wheel_changes_the_flying_speed_while_one_looks_around() {
    let mut harness = EditorHarness::new();
    let before = harness.scene().camera.clone();
    let at = harness.view().center();
    hover(&mut harness, at);
    let secondary = egui::PointerButton::Secondary;
    button(&mut harness, at, secondary, true, Modifiers::NONE);
    hover(&mut harness, at + egui::vec2(20.0, 0.0));
    harness.turn_wheel(MouseWheelUnit::Point, 100.0);
    (0..10).for_each(|_| harness.window.step());
    button(&mut harness, at, secondary, false, Modifiers::NONE);
    harness.settle();
    let camera = &harness.scene().camera;
    assert_eq!(camera.position, before.position, "nothing was flown");
    assert_ne!(camera.look_at, before.look_at);
    harness.press(Modifiers::NONE, Key::Escape);
    harness.choose("View", "Histogram");
    harness.choose("View", "Flying speed");
    let speed = harness.window.get_by_label("flying speed").value();
    assert_ne!(speed.as_deref(), Some("1.00×"), "{speed:?}");
}
