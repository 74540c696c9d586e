//! The outliner: filtering, hiding, renaming, adding.

use egui::{Key, Modifiers, MouseWheelUnit, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use glint::scene::{Document, Scene, Shape, Sphere};

use super::tools::{click, drop_at, hover, pull};
use crate::harness::{CTRL, EditorHarness};

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
    harness.type_text("Sphere of glass");
    harness.press(Modifiers::NONE, Key::Enter);
    assert_eq!(harness.scene().objects[1].name, "Sphere of glass");
    harness.press(Modifiers::COMMAND, Key::D);
    assert_eq!(harness.scene().objects.len(), 10);
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(harness.scene().objects.len(), 9);
}

#[test]
fn a_name_that_is_left_as_it_was_is_left_by_a_drag_in_the_picture() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    harness.window.get_by_label("new name");
    let middle = harness.view().center();
    let (to, none) = (middle + egui::vec2(60.0, 20.0), Modifiers::NONE);
    pull(&mut harness, middle, to, PointerButton::Secondary, none);
    drop_at(&mut harness, to, PointerButton::Secondary, none);
    assert!(harness.window.query_by_label("new name").is_none());
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(harness.scene().objects[0].name, "Sphere 2");
}

#[test]
fn where_groups_are_not_listed_nothing_is_dragged_into_one() {
    let mut scene = Scene::demo();
    scene.objects[1].group = "pair".to_owned();
    scene.objects[2].group = "pair".to_owned();
    let mut harness = EditorHarness::on(scene.clone());
    harness.window.get_by_label("Filter").focus();
    harness.window.get_by_label("Filter").type_text("sphere");
    harness.settle();
    let drag = |harness: &mut EditorHarness| {
        let row = |name: &str| harness.middle_of(name);
        let (from, to) = (row("Sphere 1"), row("Sphere 2") + egui::vec2(0.0, 4.0));
        pull(harness, from, to, PointerButton::Primary, Modifiers::NONE);
        drop_at(harness, to, PointerButton::Primary, Modifiers::NONE);
    };
    drag(&mut harness);
    assert_eq!(harness.scene(), &scene);
    // Without the filter, the same drag moves it there.
    harness.window.get_by_label("Filter").focus();
    harness.press(CTRL, Key::A);
    harness.press(Modifiers::NONE, Key::Backspace);
    drag(&mut harness);
    assert_eq!(harness.scene().objects[1].name, "Sphere 1");
    assert_eq!(harness.scene().objects[1].group, "pair");
}

#[test]
fn arrows_walk_from_row_to_row_and_turn_no_camera_meanwhile() {
    let mut harness = EditorHarness::new();
    let camera = harness.scene().camera.clone();
    // With the pointer over the list, after a click there.
    let row = harness.middle_of("Sphere 1");
    click(&mut harness, row, Modifiers::NONE);
    assert_eq!(harness.selected(), ["Sphere 1"]);
    harness.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(harness.selected(), ["Sphere 2"]);
    harness.press(Modifiers::NONE, Key::ArrowUp);
    harness.press(Modifiers::NONE, Key::ArrowUp);
    assert_eq!(harness.selected(), ["Light 2"], "over the title of a list");
    // With the keyboard only, from the focused row: to the next row, and not to an eye button.
    let picture = harness.view().center();
    hover(&mut harness, picture);
    harness.window.get_by_label("Sphere 1").focus();
    harness.settle();
    harness.press(Modifiers::NONE, Key::ArrowDown);
    harness.press(Modifiers::NONE, Key::ArrowDown);
    assert!(harness.window.get_by_label("Triangle 1").is_focused());
    assert_eq!(harness.selected(), ["Triangle 1"]);
    assert_eq!(harness.scene().camera, camera);
}

#[test]
fn arrows_know_folded_groups_and_what_is_filtered() {
    let mut scene = Scene::demo();
    for index in [0, 1] {
        scene.objects[index].group = "Balls".to_owned();
    }
    let mut harness = EditorHarness::on(scene);
    harness.click("Fold Balls");
    let row = harness.middle_of("Balls");
    click(&mut harness, row, Modifiers::NONE);
    assert_eq!(harness.selected(), ["Sphere 1", "Sphere 2"]);
    harness.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(harness.selected(), ["Triangle 1"]);
    harness.press(Modifiers::NONE, Key::ArrowUp);
    assert_eq!(
        harness.selected(),
        ["Sphere 1", "Sphere 2"],
        "all of the group"
    );
    harness.press(Modifiers::NONE, Key::ArrowUp);
    assert_eq!(harness.selected(), ["Light 2"]);
    // Among the listed rows, wherever the selection was before.
    harness.window.get_by_label("Filter").focus();
    harness.window.get_by_label("Filter").type_text("triangle");
    harness.settle();
    harness.press(Modifiers::NONE, Key::Enter);
    let row = harness.middle_of("Triangle 3");
    click(&mut harness, row, Modifiers::NONE);
    harness.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(harness.selected(), ["Triangle 4"]);
}

#[test]
fn a_name_that_was_edited_is_not_edited_in_the_next_scene() {
    let mut harness = EditorHarness::new();
    let field = |harness: &EditorHarness| harness.window.query_by_label("new name").is_some();
    harness.click("Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    assert!(field(&harness));
    harness.drop_file("scenes/mirrors.ron".into());
    assert!(harness.editor().path().is_some() && !field(&harness));

    // Ctrl+Shift+E opens the exports even while a name is edited, which ends the editing.
    let name = harness.scene().objects[0].name.clone();
    harness.click(&name);
    harness.press(Modifiers::NONE, Key::F2);
    assert!(field(&harness));
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    assert!(
        harness
            .window
            .query_all_by_label("Start export")
            .next()
            .is_some()
    );
}

#[test]
fn everything_can_be_added() {
    let mut harness = EditorHarness::new();
    for (entry, count) in [("Add Sphere", 10), ("Add Plane", 11), ("Add Triangle", 12)] {
        harness.press_button("Add to scene");
        harness.click(entry);
        assert_eq!(harness.scene().objects.len(), count);
    }
    harness.press_button("Add to scene");
    harness.click("Add Light");
    assert_eq!(harness.scene().lights.len(), 3);
}

#[test]
fn a_scene_of_thousands_shows_only_the_rows_in_sight() {
    let mut scene = Scene::empty();
    for n in 0..3000_u32 {
        scene.objects.push(glint::scene::Object {
            name: format!("Ball {n} with a name that is rather longer than the panel is wide"),
            color_pack: "pack 1".to_owned(),
            shape: Shape::Sphere(Sphere {
                center: DVec3::new(f64::from(n), 0.0, 0.0),
                radius: 0.4,
            }),
            visible: n % 3 != 0,
            group: String::new(),
        });
    }
    scene.render.width = 40;
    let harness = EditorHarness::on(scene);
    let rows = harness.window.query_all_by_label_contains("Ball").count();
    assert!((10..200).contains(&rows), "{rows}");
    let picture = harness.window.get_by_label("Live view").rect();
    assert!(
        picture.left() > 200.0 && picture.right() < 980.0,
        "{picture:?}: panels keep their width"
    );
}

#[test]
fn a_name_that_is_edited_out_of_sight_is_left() {
    let mut scene = Scene::demo();
    for n in 0..300_u32 {
        let mut ball = scene.objects[0].clone();
        ball.name = format!("Ball {n}");
        scene.objects.push(ball);
    }
    let mut harness = EditorHarness::on(scene);
    harness.click("Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    harness.type_text("Other");
    let row = harness.middle_of("Plane");
    hover(&mut harness, row);
    let roll = |harness: &mut EditorHarness, lines: f32| {
        harness.turn_wheel(MouseWheelUnit::Line, lines);
        // The scrolling is animated.
        harness.window.run_steps(40);
        harness.settle();
    };
    let is_listed = |harness: &EditorHarness| harness.window.query_by_label("Triangle 1").is_some();
    roll(&mut harness, -100.0);
    assert!(!is_listed(&harness));
    roll(&mut harness, 100.0);
    assert!(is_listed(&harness));
    assert!(harness.window.query_by_label("new name").is_none());
    assert_eq!(harness.scene().objects[0].name, "Sphere 1");
}

#[test]
fn one_of_a_group_is_pulled_out_alone_and_its_row_pulls_all() {
    let mut scene = Scene::demo();
    for member in [0, 1, 2] {
        scene.objects[member].group = "three".to_owned();
    }
    let mut harness = EditorHarness::on(scene);
    harness.click("three");
    assert_eq!(harness.selected().len(), 3);
    let row = |harness: &EditorHarness, name: &str| harness.window.get_by_label(name).rect();
    let from = row(&harness, "Sphere 2").center();
    let to = row(&harness, "Plane").center_bottom() - egui::vec2(0.0, 2.0);
    pull(
        &mut harness,
        from,
        to,
        PointerButton::Primary,
        Modifiers::NONE,
    );
    drop_at(&mut harness, to, PointerButton::Primary, Modifiers::NONE);
    let groups = harness.scene().objects.iter();
    let members = groups.filter(|object| object.group == "three");
    let members: Vec<&str> = members.map(|object| object.name.as_str()).collect();
    assert_eq!(members, ["Sphere 1", "Triangle 1"]);
}

#[test]
fn what_wears_the_same_pack_is_selected_lights_too_and_the_rest_stays_so() {
    let mut harness = EditorHarness::new();
    let same_pack = |harness: &mut EditorHarness| {
        harness.press(CTRL, Key::K);
        harness.type_text("select all with this");
        harness.press(Modifiers::NONE, Key::Enter);
    };
    harness.click("Light 1");
    same_pack(&mut harness);
    assert_eq!(harness.selected(), ["Light 2", "Light 1"]);
    harness.click("Plane");
    let row = harness.middle_of("Triangle 2");
    click(&mut harness, row, Modifiers::SHIFT);
    let before = harness.selected().len();
    same_pack(&mut harness);
    let selected = harness.selected();
    assert!(
        selected.contains(&"Plane") && selected.contains(&"Triangle 6"),
        "{selected:?}"
    );
    assert!(selected.len() >= before.max(7), "{selected:?}");
}

#[test]
fn things_are_deleted_with_the_packs_that_they_wear() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.click_with(CTRL, "sphere 1");
    harness.press(Modifiers::NONE, Key::Delete);
    let scene = harness.scene();
    assert!(scene.objects.len() == 8 && !scene.color_packs.contains_key("sphere 1"));
    // Shift adds an item of another list.
    harness.click("Light 1");
    harness.click_with(Modifiers::SHIFT, "Sphere 2");
    assert_eq!(harness.editor().selection().items().len(), 2);
    harness.click("sphere 2");
    harness.click_with(CTRL, "tetrahedron");
    let packs = harness.scene().color_packs.len();
    harness.press(CTRL, Key::D);
    assert_eq!(harness.scene().color_packs.len(), packs + 2);
}

#[test]
fn lights_that_are_added_stand_beside_each_other() {
    let mut harness = EditorHarness::new();
    for _ in 0..3 {
        harness.choose("Add", "Add Light");
    }
    let lights = &harness.scene().lights;
    let places: Vec<DVec3> = lights.iter().map(|light| light.position).collect();
    for (place, own) in places.iter().enumerate() {
        assert!(!places[..place].contains(own), "{places:?}");
    }
}

#[test]
fn a_name_being_typed_is_saved_and_one_that_was_discarded_does_not_come_back() {
    let mut harness = EditorHarness::on(Scene::demo());
    let saved = harness.folder.path().join("given.ron");
    harness.click("Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    harness.type_text("Glass");
    harness.press(Modifiers::NONE, Key::Escape);
    harness.press(Modifiers::NONE, Key::F2);
    harness.press(Modifiers::NONE, Key::Enter);
    assert_eq!(harness.scene().objects[0].name, "Sphere 1");
    harness.press(Modifiers::NONE, Key::F2);
    harness.type_text("Glass");
    harness.press(CTRL, Key::S);
    let saved = Document::load(&saved).expect("saved").scene;
    assert_eq!(saved.objects[0].name, "Glass");
}
