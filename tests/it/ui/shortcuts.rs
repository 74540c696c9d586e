//! Keyboard shortcuts: who receives them, and what Escape leaves.

use egui::{Event, Key, Modifiers, Theme};
use egui_kittest::kittest::Queryable as _;
use glint::editor::Mode;
use glint::scene::{Object, Scene, Shape, Sphere};
use glint::ui::{Command, FLIGHT, SHORTCUTS};

use crate::harness::{CTRL, EditorHarness};

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
fn escape_closes_an_open_menu_and_nothing_else() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::L);
    harness.press_button("File");
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
fn keys_of_shortcuts_do_not_fly_when_control_is_let_go_first() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    let key = |pressed: bool, modifiers: Modifiers| Event::Key {
        key: Key::A,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    };
    harness.window.event_modifiers(key(true, CTRL), CTRL);
    harness.window.step();
    for _ in 0..20 {
        harness.window.event(Event::PointerGone);
        harness.window.step();
    }
    assert_eq!(harness.scene().camera, start);
    harness.window.event(key(false, Modifiers::NONE));
    harness.window.step();
    harness.hold(Key::A, 5);
    assert!(harness.scene().camera != start, "pressed anew, it flies");
}

#[test]
fn a_shortcut_is_one_however_long_control_was_held_before() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let start = harness.scene().camera.clone();
    let middle = harness.view().center();
    harness.window.hover_at(middle);
    (0..2).for_each(|_| harness.window.step());
    harness.window.event(Event::ModifiersChanged(CTRL));
    (0..40).for_each(|_| harness.window.step());
    assert!(harness.scene().camera != start, "held by itself, it flies");
    let key = |pressed: bool| Event::Key {
        key: Key::D,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: CTRL,
    };
    harness.window.event(key(true));
    harness.window.step();
    assert_eq!(harness.scene().objects.len(), 10, "duplicated");
    assert_eq!(harness.scene().camera, start, "it was for the shortcut");
    (0..5).for_each(|_| harness.window.step());
    harness.window.event(key(false));
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.settle();
    assert_eq!(harness.scene().camera, start, "and nothing flies meanwhile");
}

/// Types into the finder and runs the first match.
fn find(harness: &mut EditorHarness, text: &str) {
    harness.press(CTRL, Key::K);
    harness.type_text(text);
    harness.press(Modifiers::NONE, Key::Enter);
}

#[test]
fn the_finder_knows_what_menus_and_panels_do() {
    let mut harness = EditorHarness::new();
    find(&mut harness, "light theme");
    assert_eq!(harness.window.ctx.theme(), Theme::Light);
    find(&mut harness, "turntable");
    assert_eq!(harness.editor().undo_label(), Some("Turntable"));
    find(&mut harness, "constant speed");
    assert_eq!(harness.editor().undo_label(), Some("Constant speed"));
    let before = harness.scene().objects.len();
    harness.click("Triangle 1");
    find(&mut harness, "join");
    assert_eq!(harness.scene().objects.len(), before - 5);
    find(&mut harness, "separate a mesh");
    assert_eq!(harness.scene().objects.len(), before);
    let group = harness.editor().selection().group(harness.scene());
    assert_eq!(group, Some("Triangle 1"), "all pieces, as a group");
}

#[test]
fn the_finder_has_room_for_what_begins_with_the_words() {
    let mut scene = Scene::demo();
    let ball = scene.objects[0].clone();
    let named = |name: String| Object {
        name,
        ..ball.clone()
    };
    let red = (0..300).map(|number| named(format!("Red heron {number}")));
    scene.objects = red.chain([named("Heron".to_owned())]).collect();
    let mut harness = EditorHarness::on(scene);
    find(&mut harness, "heron");
    assert_eq!(harness.selected(), ["Heron"]);
}

#[test]
fn a_menu_closes_when_its_entry_is_chosen_by_a_key() {
    let mut harness = EditorHarness::new();
    harness.press_button("Edit");
    harness.window.get_by_label("Select all").focus();
    harness.press(Modifiers::NONE, Key::Enter);
    assert!(harness.editor().selection().items().len() > 1);
    assert!(harness.window.query_by_label("Select all").is_none());
    // With Alt, a key means something else.
    let before = harness.scene().camera.clone();
    harness.press(Modifiers::ALT, Key::F);
    assert_eq!(harness.scene().camera, before);
}

#[test]
fn a_bookmark_leaves_the_finished_picture_on_screen() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::H);
    harness.press(CTRL, Key::B);
    assert_eq!(harness.scene().bookmarks.len(), 1);
    assert_eq!(harness.editor().mode, Mode::HighRes);
    harness.click("Sphere 1");
    harness.type_into("radius", "40");
    assert_eq!(harness.editor().mode, Mode::Live);
}

#[test]
fn playback_pauses_when_a_text_is_edited() {
    let mut harness = EditorHarness::new();
    harness.drop_file("scenes/flight.ron".into());
    harness.press(Modifiers::NONE, Key::G);
    assert!(harness.editor().timeline().is_playing);
    harness.click("Sphere 1");
    harness.put_cursor_into("radius");
    assert!(!harness.editor().timeline().is_playing);
}
