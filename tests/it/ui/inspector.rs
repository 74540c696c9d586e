//! The inspector: numbers, colours and names.

use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use glint::editor::ItemKind;
use glint::scene::{Sampling, Scene, Shape, Sphere};

use super::tools::{center, click, drop_at, place, pull};
use crate::harness::{CTRL, EditorHarness, radius};
use crate::timeline::animation;

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
    // Thousands are no vector.
    harness.type_into("center x", "1,250,000");
    assert_eq!(harness.scene().objects[0].shape.position().x, 1.0);
    harness.assert_says("is not a number");
    harness.type_into("radius", "7");
    harness.double_click("radius");
    assert_eq!(radius(harness.scene(), 0), 50.0);
}

#[test]
fn invalid_edits_are_refused_and_explained() {
    let mut harness = EditorHarness::new();
    harness.press_button("Camera");
    harness.type_into("up x", "-0.25, -0.25, -0.93");
    assert_eq!(harness.scene(), &Scene::demo());
    harness.assert_says("up must not be parallel to look_at");
    harness.click("Dismiss");
    assert!(!harness.sees("parallel"));
}

#[test]
fn a_double_click_selects_a_number_as_a_whole() {
    let mut harness = EditorHarness::new();
    harness.click("Light 1");
    let field = harness
        .window
        .get_by_role_and_label(Role::SpinButton, "intensity");
    let at = field.rect().center();
    (0..60).for_each(|_| harness.window.step());
    for _ in 0..2 {
        harness.window.drag_at(at);
        harness.window.step();
        harness.window.drop_at(at);
        harness.window.step();
    }
    harness.settle();
    harness.type_text("0.55");
    harness.press(Modifiers::NONE, Key::Enter);
    assert_eq!(harness.scene().lights[0].intensity, 0.55);
}

#[test]
fn escape_in_a_field_gives_up_what_was_typed_and_nothing_else() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.put_cursor_into("radius");
    harness.type_text("3");
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene(), &Scene::demo());
    harness.press(Modifiers::NONE, Key::F2);
    harness.type_text("q");
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene(), &Scene::demo());
    harness.window.get_by_label("Filter").focus();
    harness.settle();
    harness.press(Modifiers::NONE, Key::Escape);
    assert!(harness.window.query_by_label("Quit Glint?").is_none());
}

#[test]
fn a_label_brings_the_default_back() {
    let mut harness = EditorHarness::new();
    harness.press_button("Camera");
    harness.type_into("up x", "0.5, 0.5, 0.5");
    harness.double_click("up");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn the_inspector_says_what_the_scene_needs() {
    let mut harness = EditorHarness::new();
    harness.click("What the scene needs");
    harness
        .window
        .get_by_label("reflected rays, up to 1 bounce");
    harness
        .window
        .get_by_label("because everything visible is on the camera's side of every plane");
}

#[test]
fn a_quality_is_chosen_by_measuring_and_needs_tells_why() {
    let mut small = Scene::demo();
    (small.render.width, small.render.height) = (128, 96);
    let mut harness = EditorHarness::on(small.clone());
    harness.click("Picture");
    harness.unfold("quality");
    harness.click("automatic: 50 dB, hardly visible");
    harness.wait_for("the qualities", |harness| {
        !harness.sees("measuring this scene")
    });
    harness.settle();
    // Whichever is cheapest today, the default is far more accurate than required.
    assert_ne!(harness.scene().render.antialias, Sampling::default());
    assert_eq!(harness.editor().undo_label(), Some("Render: quality"));
    harness.click("What the scene needs");
    harness.assert_says("the cheapest within 50.0 dB");
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene(), &small);
}

#[test]
fn what_was_measured_is_taken_up_when_nothing_is_dragged() {
    let mut small = Scene::demo();
    (small.render.width, small.render.height) = (128, 96);
    // Not among the measured samplings, so that another one is certainly chosen, however busy the machine is.
    small.render.antialias = Sampling::Grid(5);
    let mut harness = EditorHarness::on(small.clone());
    harness.click("Picture");
    let choose = |harness: &mut EditorHarness| {
        harness.unfold("quality");
        let entry = harness
            .window
            .get_by_label("automatic: 50 dB, hardly visible");
        entry.click();
        harness.window.step();
        harness.window.step();
    };
    let start = Instant::now();
    choose(&mut harness);
    harness.wait_for("the qualities", |harness| {
        !harness.sees("measuring this scene")
    });
    let measuring = start.elapsed();
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene(), &small);
    let from = place(&harness, center(harness.scene(), 0));
    choose(&mut harness);
    pull(
        &mut harness,
        from,
        from + vec2(40.0, 0.0),
        PointerButton::Primary,
        Modifiers::NONE,
    );
    let start = Instant::now();
    while start.elapsed() < 3 * measuring {
        std::thread::sleep(Duration::from_millis(16));
        harness.window.step();
    }
    assert_eq!(
        harness.scene().render,
        small.render,
        "it waits for the hand"
    );
    assert_ne!(harness.scene(), &small);
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene(), &small, "all of the drag is taken back");
    drop_at(&mut harness, from, PointerButton::Primary, Modifiers::NONE);
    harness.wait_for("the quality", |harness| {
        harness.scene().render != small.render
    });
}

#[test]
fn panels_keep_their_width_while_numbers_change() {
    let mut harness = EditorHarness::new();
    let left = |harness: &EditorHarness| harness.window.get_by_label("look_at x").rect().left();
    let before = left(&harness);
    harness.window.key_down(Key::ArrowRight);
    harness.window.key_down(Key::W);
    // Past the back, where one of the numbers is nearly zero.
    for _ in 0..300 {
        harness.window.step();
        assert_eq!(left(&harness), before);
    }
}

#[test]
fn a_field_that_is_left_as_it_was_changes_nothing() {
    let mut harness = EditorHarness::new();
    for field in ["view angle", "distance", "yaw", "look_at x", "position y"] {
        harness.put_cursor_into(field);
        harness.press(Modifiers::NONE, Key::Enter);
        assert!(!harness.editor().is_dirty(), "{field}");
    }
}

#[test]
fn escape_gives_a_typed_vector_up() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let before = harness.scene().objects[0].clone();
    harness.put_cursor_into("center x");
    harness.type_text("1, 2, 3");
    harness.press(Modifiers::NONE, Key::Escape);
    assert_eq!(harness.scene().objects[0], before);
}

/// Selects both spheres; returns their centres.
fn both_balls(harness: &mut EditorHarness) -> [DVec3; 2] {
    let centers = [0, 1].map(|ball| center(harness.scene(), ball));
    let places = centers.map(|point| place(harness, point));
    click(harness, places[0], Modifiers::NONE);
    click(harness, places[1], Modifiers::SHIFT);
    assert_eq!(harness.editor().selection().items().len(), 2);
    centers
}

#[test]
fn a_knob_resizes_several_around_their_middle() {
    let mut harness = EditorHarness::new();
    let [one, other] = both_balls(&mut harness);
    let middle = place(&harness, (one + other) / 2.0);
    let arm = vec2(1.0, -1.0).normalized() * 76.0 * 1.5;
    let (primary, none) = (PointerButton::Primary, Modifiers::NONE);
    pull(
        &mut harness,
        middle + arm,
        middle + arm * 1.5,
        primary,
        none,
    );
    drop_at(&mut harness, middle + arm * 1.5, primary, none);
    assert_eq!(harness.editor().undo_label(), Some("Resize 2 items"));
    let radii = [0, 1].map(|ball| radius(harness.scene(), ball));
    assert_eq!(radii, [75.0, 30.0]);
    let [now, then] = [0, 1].map(|ball| center(harness.scene(), ball));
    assert!(((now - then) - (one - other) * 1.5).length() < 1e-9);
    assert!(((now + then) - (one + other)).length() < 1e-9);
}

#[test]
fn of_several_a_dragged_position_moves_all_and_a_typed_one_is_for_all() {
    let mut harness = EditorHarness::new();
    let [one, other] = both_balls(&mut harness);
    harness.drag("center x", 40.0);
    let [now, then] = [0, 1].map(|ball| center(harness.scene(), ball));
    assert!(now.x > one.x + 1.0, "{now}");
    assert!((now - one - (then - other)).length() < 1e-9, "{now} {then}");
    harness.press(CTRL, Key::Z);
    harness.type_into("center y", "70");
    let [now, then] = [0, 1].map(|ball| center(harness.scene(), ball));
    assert_eq!((now.y, then.y), (70.0, 70.0));
    assert_eq!((now.x, then.x), (one.x, other.x));
    // A negative radius is rejected.
    harness.type_into("radius", "-5");
    assert_eq!(
        [0, 1].map(|ball| radius(harness.scene(), ball)),
        [50.0, 20.0]
    );
}

#[test]
fn what_is_typed_is_a_step_of_its_own_though_a_drag_ends_it() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let start = center(harness.scene(), 0);
    harness.put_cursor_into("center x");
    harness.type_text("5");
    harness.drag("center y", 40.0);
    let end = center(harness.scene(), 0);
    assert_eq!(end.x, 5.0);
    assert!(end.y > start.y);
    harness.press(CTRL, Key::Z);
    assert_eq!(center(harness.scene(), 0), DVec3 { x: 5.0, ..start });
    harness.give_up_dragging("center y", |_| {});
    assert_eq!(center(harness.scene(), 0), DVec3 { x: 5.0, ..start });
}

#[test]
fn a_marker_is_as_large_as_the_others() {
    let mut harness = EditorHarness::new();
    harness.click("Light 1");
    let before = harness.scene().lights[0].clone();
    harness.type_into("radius", "2");
    harness.click("Light 2");
    harness.click("marker");
    assert_eq!(harness.scene().lights[1].marker, None);
    harness.click("marker");
    let marker = harness.scene().lights[1].marker.as_ref();
    assert_eq!(marker.map(|marker| marker.radius), Some(2.0));
    assert_ne!(before.marker.map(|marker| marker.radius), Some(2.0));
}

#[test]
fn a_typed_position_moves_a_group_as_one_and_its_name_is_the_groups() {
    let mut harness = EditorHarness::new();
    let [one, other] = both_balls(&mut harness);
    harness.press(CTRL, Key::G);
    harness.type_into("center y", "70");
    let [now, then] = [0, 1].map(|ball| center(harness.scene(), ball));
    assert_eq!(then.y, 70.0, "what was selected last");
    assert!((now - one - (then - other)).length() < 1e-9, "{now} {then}");
    harness.type_name("group", "Balls");
    let groups = [0, 1].map(|ball| harness.scene().objects[ball].group.clone());
    assert_eq!(groups, ["Balls", "Balls"]);
}

#[test]
fn a_group_gets_keys_as_one_and_moves_from_one_to_the_other() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 0.0)]);
    let [one, other] = both_balls(&mut harness);
    harness.press(CTRL, Key::G);
    // One of them has a key there, which stays.
    harness.click("Sphere 1");
    harness.click("key position");
    harness.click("Group 1");
    let keys = |harness: &EditorHarness| -> Vec<usize> {
        let tracks = harness.scene().animation.tracks.iter();
        tracks.map(|track| track.keys.len()).collect()
    };
    assert_eq!(keys(&harness), [1]);
    harness.click("key position");
    assert_eq!(keys(&harness), [1, 1]);
    harness.press(Modifiers::NONE, Key::End);
    harness.type_into("center y", "70");
    assert_eq!(keys(&harness), [2, 2], "changes set keys");
    let shown = |harness: &EditorHarness| [0, 1].map(|ball| center(harness.editor().shown(), ball));
    let [now, then] = shown(&harness);
    assert!((now - one - (then - other)).length() < 1e-9, "{now} {then}");
    assert_ne!(now, one);
    // Sets both again, then removes both.
    harness.click("key position");
    assert_eq!(keys(&harness), [1, 1]);
    assert_eq!(shown(&harness), [one, other]);
}

#[test]
fn what_is_typed_and_not_taken_is_told() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    for (field, text, words) in [
        ("radius", "-5", "radius must be greater than 0"),
        ("radius", "big", "“big” is not a number"),
        (
            "center y",
            "1e30",
            "center must be between -1.0e12 and 1.0e12",
        ),
        (
            "center x",
            "0, 1e30, 0",
            "center must be between -1.0e12 and 1.0e12",
        ),
        ("diffuse red", "300", "diffuse must be between 0 and 255"),
        (
            "diffuse green",
            "10, 20, 300",
            "diffuse must be between 0 and 255",
        ),
        ("diffuse hex", "#12", "“#12” is not a color"),
    ] {
        harness.type_into(field, text);
        harness.assert_says(words);
    }
    assert_eq!(harness.scene(), &Scene::demo());
    harness.type_into("diffuse hex", "#0f0");
    let pack = &harness.scene().color_packs["sphere 1"];
    assert_eq!(pack.diffuse.to_array(), [0.0, 255.0, 0.0]);
    assert_ne!(pack.ambient, pack.diffuse);
    harness.type_into("color hex", "#FF8040");
    let pack = &harness.scene().color_packs["sphere 1"];
    assert_eq!(pack.diffuse.to_array(), [255.0, 128.0, 64.0]);
    assert_eq!(pack.ambient, pack.diffuse, "both at once");
}

#[test]
fn a_turn_may_be_typed_either_way_around() {
    let turned = ["270", "-90"].map(|text| {
        let mut harness = EditorHarness::new();
        harness.type_into("yaw", text);
        assert_ne!(harness.scene().camera, Scene::demo().camera);
        harness.scene().camera.look_at
    });
    assert!(turned[0].distance(turned[1]) < 1e-12, "{turned:?}");
}

#[test]
fn escape_gives_the_drag_of_a_number_up() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let start = harness.give_up_dragging("radius", |harness| {
        assert!(radius(harness.scene(), 0) > 55.0);
    });
    assert_eq!(harness.scene(), &Scene::demo());
    harness.window.hover_at(start + vec2(80.0, 0.0));
    harness.window.step();
    harness.window.drop_at(start + vec2(80.0, 0.0));
    harness.settle();
    assert_eq!(harness.scene(), &Scene::demo(), "it was let go");
    assert_eq!(harness.editor().undo_label(), None);
    assert_eq!(harness.editor().selection().items().len(), 1);
}

#[test]
fn a_step_with_an_arrow_key_moves_several_together() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.click_with(CTRL, "Sphere 2");
    let places = |harness: &EditorHarness| {
        let objects = harness.scene().objects.iter();
        objects
            .take(2)
            .map(|object| object.shape.position())
            .collect::<Vec<_>>()
    };
    let before = places(&harness);
    harness.put_cursor_into("center z");
    harness.press(Modifiers::NONE, Key::ArrowUp);
    let after = places(&harness);
    assert!(after[1].z > before[1].z);
    assert!((after[0] - before[0]).abs_diff_eq(after[1] - before[1], 1e-9));
}

#[test]
fn what_is_typed_for_several_is_for_all_however_it_is_ended() {
    let mut harness = EditorHarness::new();
    both_balls(&mut harness);
    harness.put_cursor_into("center x");
    harness.type_text("100");
    let away = harness.view().left_top() - vec2(4.0, 0.0);
    click(&mut harness, away, Modifiers::NONE);
    let [now, then] = [0, 1].map(|ball| center(harness.scene(), ball));
    assert_eq!((now.x, then.x), (100.0, 100.0));
}

#[test]
fn others_get_what_the_last_of_them_has_already() {
    let mut harness = EditorHarness::new();
    both_balls(&mut harness);
    let (x, other) = (center(harness.scene(), 1).x, center(harness.scene(), 0));
    // Enter in a field without a change confirms its value.
    for field in ["radius", "center x", "specular green"] {
        harness.put_cursor_into(field);
        harness.press(Modifiers::NONE, Key::Enter);
    }
    let scene = harness.scene();
    assert_eq!([0, 1].map(|ball| radius(scene, ball)), [20.0; 2]);
    assert_eq!(center(scene, 0), DVec3::new(x, other.y, other.z));
    assert_eq!(center(scene, 1).x, x);
    // Leaving a field without Enter changes nothing.
    harness.press(CTRL, Key::Z);
    harness.press(CTRL, Key::Z);
    let before = harness.scene().clone();
    harness.put_cursor_into("radius");
    harness.press(Modifiers::NONE, Key::Tab);
    assert_eq!(*harness.scene(), before);
    harness.unfold("color pack");
    let choices = harness.window.get_all_by_label("sphere 2");
    choices.last().expect("a choice").click();
    harness.settle();
    let packs = [0, 1].map(|ball| harness.scene().objects[ball].color_pack.clone());
    assert_eq!(packs, ["sphere 2"; 2]);
}

#[test]
fn a_change_of_a_pack_is_for_the_packs_of_all() {
    let mut harness = EditorHarness::new();
    both_balls(&mut harness);
    let before = harness.scene().color_packs.clone();
    harness.type_into("phong", "64");
    for name in ["sphere 1", "sphere 2"] {
        let pack = &harness.scene().color_packs[name];
        assert_eq!(pack.phong_exponent, 64.0, "{name}");
        assert_eq!(pack.diffuse, before[name].diffuse, "{name}");
    }
    assert_eq!(harness.scene().color_packs["plane"], before["plane"]);
    // Exactly the differing properties are listed.
    harness
        .window
        .get_by_label("Not the same for all: center, radius, color pack, ambient, diffuse");
    // Editing one channel changes only that channel of the others; a pasted colour is set for all.
    harness.type_into("ambient red", "10");
    for name in ["sphere 1", "sphere 2"] {
        let own = before[name].ambient;
        let pack = &harness.scene().color_packs[name];
        assert_eq!(pack.ambient, DVec3::new(10.0, own.y, own.z), "{name}");
        assert_eq!(pack.diffuse, before[name].diffuse, "{name}");
    }
    harness.type_into("color green", "20");
    for name in ["sphere 1", "sphere 2"] {
        let own = before[name].diffuse;
        let pack = &harness.scene().color_packs[name];
        assert_eq!(pack.diffuse, DVec3::new(own.x, 20.0, own.z), "{name}");
        assert_eq!(pack.ambient, pack.diffuse, "{name}");
    }
    harness.type_into("specular red", "1, 2, 3");
    for name in ["sphere 1", "sphere 2"] {
        let pack = &harness.scene().color_packs[name];
        assert_eq!(pack.specular, DVec3::new(1.0, 2.0, 3.0), "{name}");
    }
}

#[test]
fn several_get_packs_of_their_own_and_the_last_that_shares_one_keeps_it() {
    let mut harness = EditorHarness::new();
    harness.click("Triangle 1");
    harness.click_with(Modifiers::SHIFT, "Triangle 6");
    harness.click("Make unique");
    let triangles = || harness.scene().objects.iter().skip(2).take(6);
    let packs: Vec<_> = triangles()
        .map(|triangle| triangle.color_pack.as_str())
        .collect();
    let copies = (2..=6).map(|number| format!("tetrahedron {number}"));
    let expected: Vec<_> = copies.chain(["tetrahedron".to_owned()]).collect();
    assert_eq!(packs, expected);
    let step = harness.editor().undo_label().map(str::to_owned);
    harness.click("Make unique");
    assert_eq!(harness.editor().undo_label(), step.as_deref(), "they are");
}

#[test]
fn several_packs_are_changed_as_one() {
    let mut harness = EditorHarness::new();
    harness.click("sphere 1");
    harness.click_with(CTRL, "plane");
    assert_eq!(
        harness.editor().selection().indices(ItemKind::Pack).len(),
        2
    );
    harness.type_into("phong", "64");
    for (name, exponent) in [("sphere 1", 64.0), ("plane", 64.0)] {
        let pack = &harness.scene().color_packs[name];
        assert_eq!(pack.phong_exponent, exponent, "{name}");
    }
    assert_ne!(harness.scene().color_packs["sphere 2"].phong_exponent, 64.0);
}

#[test]
fn triangles_that_are_dragged_together_stay_as_they_are() {
    let mut harness = EditorHarness::new();
    harness.click("Triangle 1");
    harness.click_with(Modifiers::SHIFT, "Triangle 6");
    assert_eq!(harness.editor().selection().items().len(), 6);
    harness.drag("b x", 20.0);
    let by = center(harness.scene(), 2) - center(&Scene::demo(), 2);
    assert!(by.x > 1.0, "{by}");
    for object in 2..8 {
        let bounds = |scene: &Scene| scene.objects[object].shape.bounds();
        let (before, after) = (bounds(&Scene::demo()), bounds(harness.scene()));
        let (Some((low, high)), Some((less, more))) = (before, after) else {
            panic!("they end");
        };
        assert!((less - low - by).length() < 1e-9 && (more - high - by).length() < 1e-9);
    }
}

#[test]
fn a_sum_may_be_typed() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.type_into("radius", "(2 + 1,5) * 4");
    assert_eq!(radius(harness.scene(), 0), 14.0);
    harness.type_into("radius", "7 *");
    harness.assert_says("“7 *” is not a number");
    assert_eq!(radius(harness.scene(), 0), 14.0);
}

#[test]
fn bookmarks_have_names_of_their_own() {
    let mut harness = EditorHarness::new();
    harness.press(CTRL, Key::B);
    harness.press(CTRL, Key::B);
    harness.type_name("bookmark 2", "View 1");
    let names = harness.scene().bookmarks.iter();
    let names: Vec<&str> = names.map(|bookmark| &*bookmark.name).collect();
    assert_eq!(names, ["View 1", "View 2"]);
    harness.type_name("bookmark 2", "Front");
    assert_eq!(harness.scene().bookmarks[1].name, "Front");
}
