//! Awkward cases of keys on the timeline: between frames, beyond the end, on top of each other.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable as _;
use glint::editor::Mode;

use super::tools::{click, drag, drop_at, hover, pull};
use crate::harness::{CTRL, EditorHarness};
use crate::timeline::{animation, times};

/// A window on the demo with camera keys at these times, at ten frames per second.
fn window(times: &[f64]) -> EditorHarness {
    let keys: Vec<(f64, f64)> = times.iter().map(|time| (*time, *time)).collect();
    animation(&keys)
}

/// Position of a time on the ruler, which shows four seconds.
fn on_ruler(harness: &EditorHarness, seconds: f32) -> Pos2 {
    let ruler = harness
        .window
        .get_by_role_and_label(Role::Slider, "Playhead")
        .rect();
    // Its area of interaction is wider than the ruler, on both sides.
    let inner = ruler.shrink2(egui::vec2(8.0, 0.0));
    Pos2::new(
        inner.left() + inner.width() * seconds / 4.0,
        inner.center().y,
    )
}

#[test]
fn the_second_key_goes_where_there_was_no_time_yet() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::K);
    harness.click_at(on_ruler(&harness, 3.0));
    let shown = harness.editor().shown_time();
    assert!((2.8..3.2).contains(&shown), "{shown}");
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(harness.scene().animation.keys.len(), 2);
    assert!((harness.scene().animation.duration() - shown).abs() < 1e-9);
}

#[test]
fn a_view_that_was_flown_to_is_kept_for_the_next_key() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::K);
    let fly = |harness: &mut EditorHarness| {
        harness.hold(Key::D, 30);
        harness.editor().shown().camera.clone()
    };
    let seek = |harness: &mut EditorHarness, seconds: f32| {
        harness.click_at(on_ruler(harness, seconds));
    };
    let flown = fly(&mut harness);
    seek(&mut harness, 3.0);
    assert_eq!(harness.editor().shown().camera, flown);
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(harness.scene().animation.keys[1].value, flown);
    // At a time within the flight, the view follows the shot.
    fly(&mut harness);
    seek(&mut harness, 1.0);
    assert!(harness.editor().looks_through());
}

#[test]
fn a_value_that_is_set_on_a_key_between_frames_is_seen() {
    let mut harness = window(&[0.0, 0.34, 1.02]);
    harness.press(Modifiers::NONE, Key::CloseBracket);
    assert!((harness.editor().shown_time() - 0.3).abs() < 1e-9);
    harness.hold(Key::D, 30);
    let flown = harness.editor().shown().camera.clone();
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(
        times(&harness).len(),
        3,
        "in place of the one that is there"
    );
    harness.press(Modifiers::NONE, Key::Period);
    harness.press(Modifiers::NONE, Key::Comma);
    assert_eq!(harness.editor().shown().camera, flown);
}

#[test]
fn selected_keys_are_copied_to_the_playhead_and_frames_are_typed() {
    let mut harness = window(&[0.0, 1.0]);
    harness.type_into("frame", "31");
    assert!((harness.editor().shown_time() - 3.0).abs() < 1e-9);
    harness.click("Key 2");
    harness.press(CTRL, Key::D);
    assert_eq!(times(&harness), [0.0, 1.0, 3.0]);
    assert_eq!(harness.editor().undo_label(), Some("Copy keys"));
    harness.press(CTRL, Key::D);
    assert_eq!(times(&harness), [0.0, 1.0, 3.0]);
    harness.assert_says("move it to where they should go");
    // The playhead is on the frame nearest to a key.
    let mut harness = window(&[0.0, 0.34, 1.0]);
    harness.click("Key 2");
    harness.press(Modifiers::NONE, Key::CloseBracket);
    harness.press(CTRL, Key::D);
    assert_eq!(times(&harness), [0.0, 0.34, 1.0]);
}

#[test]
fn brackets_go_from_key_to_key_wherever_those_are_between_frames() {
    let mut harness = window(&[0.0, 0.34, 0.36, 1.02, 1.98]);
    let mut shown = vec![harness.editor().shown_time()];
    for key in [Key::CloseBracket, Key::OpenBracket] {
        for _ in 0..6 {
            harness.press(Modifiers::NONE, key);
            shown.push(harness.editor().shown_time());
        }
    }
    shown.dedup();
    let frames: Vec<i32> = shown
        .iter()
        .map(|time| (time * 10.0).round() as i32)
        .collect();
    assert_eq!(frames, [0, 3, 4, 10, 20, 10, 4, 3, 0]);
    // The frame nearest to the last key is beyond the last frame.
    harness.press(CTRL, Key::End);
    assert!((harness.editor().shown_time() - 1.9).abs() < 1e-9);
}

#[test]
fn a_time_that_is_dragged_passes_other_keys_and_leaves_them() {
    let mut harness = window(&[0.0, 0.5, 1.0, 1.5, 2.0, 4.0]);
    harness.click("Key 2");
    harness.drag("time", 110.0);
    let moved = times(&harness);
    assert_eq!(moved.len(), 6, "{moved:?}");
    assert!(
        moved.contains(&1.0) && moved.contains(&1.5) && !moved.contains(&0.5),
        "{moved:?}"
    );
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(times(&harness), [0.0, 0.5, 1.0, 1.5, 2.0, 4.0], "one step");
}

#[test]
fn escape_takes_the_drag_of_a_key_back() {
    give_up_a_drag(Modifiers::NONE);
}

#[test]
fn escape_takes_the_copy_of_a_key_back() {
    give_up_a_drag(CTRL);
}

/// Cancels a drag during which these modifier keys are held.
fn give_up_a_drag(held: Modifiers) {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    harness.window.event(Event::ModifiersChanged(held));
    let from = harness
        .window
        .get_by_role_and_label(Role::Button, "Key 2")
        .rect()
        .center();
    harness.window.drag_at(from);
    harness.window.step();
    for part in 1..=4_u8 {
        harness
            .window
            .hover_at(from + egui::vec2(f32::from(part) * 20.0, 0.0));
        harness.window.step();
    }
    assert_ne!(times(&harness), [0.0, 1.0, 2.0]);
    harness.window.key_press_modifiers(held, Key::Escape);
    harness.window.step();
    harness.window.hover_at(from + egui::vec2(120.0, 0.0));
    harness.window.step();
    harness.window.drop_at(from + egui::vec2(120.0, 0.0));
    harness.settle();
    assert_eq!(times(&harness), [0.0, 1.0, 2.0]);
    assert_eq!(harness.editor().undo_label(), None);
}

#[test]
fn all_selected_keys_are_dragged_in_the_view() {
    let mut harness = animation(&[(0.0, -60.0), (2.0, 40.0)]);
    // From farther back, the flight is in view.
    harness.hold(Key::S, 60);
    let place = |harness: &EditorHarness, key: &str| {
        let key = harness.window.get_by_label(key);
        key.rect().center()
    };
    let first = place(&harness, "Key 1 in the view");
    click(&mut harness, first, Modifiers::NONE);
    let second = place(&harness, "Key 2 in the view");
    click(&mut harness, second, Modifiers::SHIFT);
    assert_eq!(harness.editor().selection().keys().len(), 2);
    let before = harness.scene().animation.keys.clone();
    let to = second - egui::vec2(0.0, 60.0);
    let (with, held) = (PointerButton::Primary, Modifiers::NONE);
    drag(&mut harness, second, to, with, held);
    let after = harness.scene().animation.keys.clone();
    let by = |key: usize| after[key].value.position - before[key].value.position;
    assert!(by(0).length() > 5.0, "{:?}", by(0));
    assert!((by(0) - by(1)).length() < 1e-9, "{:?}", by(1));
}

#[test]
fn undo_of_a_stretch_brings_the_playhead_back() {
    let mut harness = window(&[0.0, 2.0]);
    let at = on_ruler(&harness, 1.0);
    click(&mut harness, at, Modifiers::NONE);
    let before = harness.editor().timeline().playhead;
    assert!((before - 1.0).abs() < 0.1, "{before}");
    harness.type_into("length of the flight", "4");
    assert_eq!(harness.editor().timeline().playhead, 2.0 * before);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.editor().timeline().playhead, before);
}

#[test]
fn a_key_follows_a_pointer_that_leaves_the_window_and_comes_back() {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    let key = harness.window.get_by_role_and_label(Role::Button, "Key 2");
    let from = key.rect().center();
    let to = from + egui::vec2(40.0, 0.0);
    pull(
        &mut harness,
        from,
        to,
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let there = times(&harness);
    assert!(there[1] > 1.0);
    harness.window.event(Event::PointerGone);
    harness.window.step();
    harness.window.step();
    assert_eq!(times(&harness), there, "it waits");
    let to = from + egui::vec2(60.0, 0.0);
    hover(&mut harness, to);
    drop_at(&mut harness, to, PointerButton::Primary, Modifiers::NONE);
    assert!(times(&harness)[1] > there[1], "{there:?}");
    harness.press(CTRL, Key::Z);
    assert_eq!(times(&harness), [0.0, 1.0, 2.0], "it was one drag");
}

#[test]
fn a_key_takes_the_place_of_one_in_the_same_frame() {
    // Keys of a recorded flight lie between frames.
    let mut harness = window(&[0.0, 0.46, 1.04, 2.0]);
    for _ in 0..2 {
        harness.press(Modifiers::NONE, Key::CloseBracket);
        harness.press(Modifiers::NONE, Key::K);
    }
    // Replaced by the view, they are now exactly on frames.
    assert_eq!(times(&harness), [0.0, 0.5, 1.0, 2.0]);
    harness.press(Modifiers::NONE, Key::Period);
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(harness.scene().animation.keys.len(), 5);
}

#[test]
fn deleting_twice_deletes_once() {
    let mut harness = window(&[0.0, 1.0, 2.0, 3.0]);
    harness.click("Key 2");
    harness.press(Modifiers::NONE, Key::Delete);
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(times(&harness), [0.0, 2.0, 3.0]);
    harness.press(CTRL, Key::Z);
    assert_eq!(times(&harness), [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(
        harness.editor().selection().keys().len(),
        1,
        "it is selected"
    );
}

#[test]
fn a_flight_of_any_length_is_left_as_it_is() {
    for keys in [[0.0, 43_200.0], [0.0, 0.05], [86_399.998, 86_400.0]] {
        let harness = window(&keys);
        assert!(!harness.editor().is_dirty(), "{keys:?}");
        assert_eq!(times(&harness), keys);
    }
}

#[test]
fn what_is_keyed_can_have_the_value_that_it_had_without_keys() {
    let mut harness = window(&[0.0, 2.0]);
    harness.click("Light 1");
    harness.click("key intensity");
    harness.press(Modifiers::NONE, Key::End);
    harness.type_into("intensity", "0.8");
    harness.type_into("intensity", "0.2");
    assert_eq!(harness.editor().shown().lights[0].intensity, 0.2);
    // Hiding it does not change its keys.
    harness.type_into("intensity", "0.6");
    let animation = harness.scene().animation.clone();
    harness.click("Hide Light 1");
    assert!(!harness.scene().lights[0].visible);
    assert_eq!(harness.scene().animation, animation);
    assert_eq!(harness.scene().lights[0].intensity, 0.2);
}

#[test]
fn the_still_picture_stops_what_plays() {
    let mut harness = window(&[0.0, 2.0]);
    harness.window.key_press(Key::G);
    (0..20).for_each(|_| harness.window.step());
    harness.press(Modifiers::NONE, Key::H);
    assert!(!harness.editor().timeline().is_playing);
    assert_eq!(harness.editor().mode, Mode::HighRes);
}

#[test]
fn the_window_of_exports_follows_the_scene() {
    let mut harness = window(&[0.0, 1.0]);
    harness.press(crate::harness::CTRL.plus(Modifiers::SHIFT), Key::E);
    harness.assert_says("11 frames");
    harness.click("Key 2");
    harness.type_into("time", "3");
    harness.assert_says("31 frames");
}

#[test]
fn home_over_the_line_of_time_leaves_the_camera() {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    let above = on_ruler(&harness, 1.5);
    harness.window.hover_at(above);
    harness.settle();
    // Zooms in, then shows everything again.
    let key = |harness: &EditorHarness| harness.middle_of("Key 2").x;
    let before = key(&harness);
    harness.window.event(egui::Event::Zoom(2.0));
    harness.settle();
    assert!((key(&harness) - before).abs() > 10.0);
    harness.press(Modifiers::NONE, Key::Home);
    assert!((key(&harness) - before).abs() < 1.0);
    assert!(!harness.editor().is_dirty());
}

#[test]
fn all_that_is_selected_is_all_things_or_all_keys() {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    let selected = |harness: &EditorHarness| {
        let editor = harness.editor();
        let keys = editor.selection().keys().len();
        (editor.selection().items().len(), keys)
    };
    let above = on_ruler(&harness, 1.5);
    harness.window.hover_at(above);
    harness.settle();
    harness.press(CTRL, Key::A);
    assert_eq!(selected(&harness), (0, 3));
    harness.click("Plane");
    harness.press(CTRL, Key::A);
    assert_eq!(selected(&harness), (11, 0));
    // With the pointer over the picture, the things are selected, whatever was selected before.
    harness.window.hover_at(above);
    harness.settle();
    harness.press(CTRL, Key::A);
    assert_eq!(selected(&harness), (0, 3));
    harness
        .window
        .hover_at(harness.view().left_top() + egui::vec2(5.0, 5.0));
    harness.settle();
    harness.press(CTRL, Key::A);
    assert_eq!(selected(&harness), (11, 0));
    harness.press(CTRL, Key::H);
    let scene = harness.scene();
    assert!(!scene.objects.iter().any(|object| object.visible));
    assert!(!scene.lights.iter().any(|light| light.visible));

    // Without keys, only things can be selected.
    let mut harness = window(&[]);
    harness.press(CTRL, Key::A);
    assert_eq!(selected(&harness), (11, 0));
}

#[test]
fn the_line_of_time_zooms_where_the_pointer_is() {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    let apart = |harness: &EditorHarness| {
        let left = |key: &str| {
            let key = harness.window.get_by_role_and_label(Role::Button, key);
            key.rect().center().x
        };
        left("Key 3") - left("Key 2")
    };
    let (before, at) = (apart(&harness), on_ruler(&harness, 1.5));
    harness.window.hover_at(at);
    harness.settle();
    harness.window.event(egui::Event::Zoom(1.5));
    harness.settle();
    let zoomed = apart(&harness) / before;
    assert!((zoomed - 1.5).abs() < 0.05, "{zoomed}");
    harness.press(Modifiers::NONE, Key::Home);
    assert!((apart(&harness) - before).abs() < 1.0, "all of it again");
}

#[test]
fn the_middle_button_moves_the_line_of_time_and_not_the_playhead() {
    let mut harness = window(&[0.0, 1.0, 2.0]);
    let before = harness.editor().timeline().playhead;
    let (from, to) = (on_ruler(&harness, 0.5), on_ruler(&harness, 1.5));
    drag(
        &mut harness,
        from,
        to,
        PointerButton::Middle,
        Modifiers::NONE,
    );
    assert_eq!(harness.editor().timeline().playhead, before);
    drag(
        &mut harness,
        from,
        to,
        PointerButton::Primary,
        Modifiers::NONE,
    );
    assert_ne!(harness.editor().timeline().playhead, before);
}

#[test]
fn what_changes_no_camera_leaves_no_shot() {
    let mut harness = window(&[0.0, 1.0]);
    harness.press(Modifiers::NONE, Key::C);
    let before = harness.scene().clone();
    harness.press(Modifiers::NONE, Key::P);
    assert!(harness.editor().looks_through());
    harness.press_button("Camera");
    harness.type_into("up x", "0, 0, 0");
    assert!(harness.editor().looks_through(), "it is refused");
    assert_eq!(harness.scene(), &before);
}

#[test]
fn a_ready_made_flight_says_what_it_replaces() {
    let mut harness = window(&[0.0, 1.0]);
    harness.press(CTRL, Key::K);
    harness.type_text("turntable");
    harness.press(Modifiers::NONE, Key::Enter);
    let words = "Turntable has replaced 2 keys of the camera; undo brings them back";
    harness.assert_says(words);
    harness.press(CTRL, Key::Z);
    assert!(!harness.sees(words));
    assert_eq!(times(&harness), [0.0, 1.0]);
}

#[test]
fn the_playhead_stays_where_it_is_in_a_flight_that_is_stretched() {
    let mut harness = window(&[0.0, 4.0]);
    harness.click_at(on_ruler(&harness, 1.0));
    let before = harness.editor().shown_time();
    assert!((before - 1.0).abs() < 0.2, "{before}");
    harness.type_into("length of the flight", "8");
    let after = harness.editor().shown_time();
    assert!((after - 2.0 * before).abs() < 1e-9, "{after}");
}
