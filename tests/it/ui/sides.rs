//! Groups, dragging of color packs, bookmarks, and the order in which Tab visits the panels.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec3;
use glint::editor::Item;
use glint::scene::{ColorPack, Document, Scene, Sphere};

use super::tools::{button, center, click, drop_at, hover, place, pull};
use crate::harness::{CTRL, EditorHarness};

const NONE: Modifiers = Modifiers::NONE;

fn text(scene: Scene) -> String {
    let header = String::new();
    Document { header, scene }.to_text().expect("a text")
}

fn carry(harness: &mut EditorHarness, from: Pos2, to: Pos2) {
    pull(harness, from, to, PointerButton::Primary, NONE);
    drop_at(harness, to, PointerButton::Primary, NONE);
}

#[test]
fn a_group_is_listed_hidden_renamed_and_moved_as_one() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.window.event(Event::ModifiersChanged(CTRL));
    let second = harness.middle_of("Sphere 2");
    hover(&mut harness, second);
    button(&mut harness, second, PointerButton::Primary, true, CTRL);
    button(&mut harness, second, PointerButton::Primary, false, CTRL);
    harness.window.event(Event::ModifiersChanged(NONE));
    harness.settle();
    harness.press(CTRL, Key::G);
    let groups = |harness: &EditorHarness| -> Vec<String> {
        let objects = harness.scene().objects.iter();
        objects.take(3).map(|object| object.group.clone()).collect()
    };
    assert_eq!(groups(&harness), ["Group 1", "Group 1", ""]);
    harness.click("Hide Group 1");
    let seen = |harness: &EditorHarness| {
        let objects = harness.scene().objects.iter();
        objects.filter(|object| object.visible).count()
    };
    assert_eq!(seen(&harness), 7);
    assert_eq!(harness.editor().undo_label(), Some("Hide Group 1"));
    harness.click("Show Group 1");
    assert_eq!(seen(&harness), 9);
    harness.click("Fold Group 1");
    assert!(harness.window.query_by_label("Sphere 2").is_none());
    harness.click("Unfold Group 1");
    // One click selects both members; Shift or Ctrl adds them to the selection, and Ctrl again removes them.
    harness.click("Sphere 1");
    harness.click("Group 1");
    assert_eq!(harness.editor().selection().items().len(), 2);
    harness.click("Triangle 1");
    for (modifiers, count) in [(Modifiers::SHIFT, 3), (CTRL, 1), (CTRL, 3)] {
        let group = harness.middle_of("Group 1");
        click(&mut harness, group, modifiers);
        assert_eq!(harness.editor().selection().items().len(), count);
    }
    let at = harness.middle_of("Group 1");
    (0..60).for_each(|_| harness.window.step());
    for _ in 0..2 {
        harness.window.drag_at(at);
        harness.window.drop_at(at);
    }
    harness.settle();
    harness.type_text("Balls");
    harness.press(NONE, Key::Enter);
    assert_eq!(groups(&harness), ["Balls", "Balls", ""]);
    // The key renames groups, too.
    harness.click("Balls");
    harness.press(NONE, Key::F2);
    harness.type_text("Toys");
    harness.press(NONE, Key::Enter);
    assert_eq!(groups(&harness), ["Toys", "Toys", ""]);
    harness.press(CTRL, Key::Z);
    // Renaming does not merge two groups.
    harness.click("Triangle 1");
    harness.click_with(Modifiers::SHIFT, "Triangle 2");
    harness.press(CTRL, Key::G);
    harness.type_name("group", "Balls");
    harness.assert_says("There is another group named “Balls”");
    assert_eq!(groups(&harness), ["Balls", "Balls", "Group 1"]);
    harness.click("Dismiss");
    // A folded group stays folded when it is renamed.
    harness.click("Fold Group 1");
    harness.click("Group 1");
    harness.press(NONE, Key::F2);
    harness.type_text("Balls");
    harness.press(NONE, Key::Enter);
    harness.window.get_by_label("Unfold Group 1");
    harness.window.get_by_label("Fold Balls");
    harness.click("Dismiss");
    harness.press(CTRL, Key::Z);
    // An object dropped on a group's row becomes a member.
    let (from, to) = (harness.middle_of("Plane"), harness.middle_of("Balls"));
    carry(&mut harness, from, to);
    let plane = harness.scene().objects.iter();
    let mut plane = plane.filter(|object| object.name == "Plane");
    assert_eq!(plane.next().expect("the plane").group, "Balls");
    // The file stores it.
    let written = text(harness.scene().clone());
    let read = Document::from_text(&written).expect("a scene").scene;
    assert_eq!(&read, harness.scene());
    harness.click("Balls");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::G);
    assert!(harness.scene().objects.iter().all(|o| o.group.is_empty()));
}

#[test]
fn in_the_picture_a_click_takes_a_group_and_another_one_goes_inside() {
    let mut scene = Scene::demo();
    for ball in 0..2 {
        scene.objects[ball].group = "Balls".to_owned();
    }
    let mut harness = EditorHarness::on(scene);
    let [ball, other] = [0, 1].map(|index| place(&harness, center(harness.scene(), index)));
    let count = |harness: &EditorHarness| harness.editor().selection().items().len();
    harness.click("Plane");
    for (at, expected) in [(ball, 2), (ball, 1), (other, 1)] {
        click(&mut harness, at, NONE);
        assert_eq!(count(&harness), expected);
    }
    harness.click("Plane");
    click(&mut harness, ball, Modifiers::SHIFT);
    assert_eq!(count(&harness), 3, "all of it besides");
    // A double click counts as two clicks.
    harness.click("Plane");
    (0..60).for_each(|_| harness.window.step());
    for _ in 0..2 {
        harness.click_at(ball);
    }
    assert_eq!(count(&harness), 1);
    // A drag moves the whole group.
    harness.click("Plane");
    let before = [0, 1].map(|index| center(harness.scene(), index));
    carry(&mut harness, ball, ball + vec2(30.0, 0.0));
    let after = [0, 1].map(|index| center(harness.scene(), index));
    let by = [0, 1].map(|index| after[index] - before[index]);
    assert!(
        by[0].length() > 1.0 && (by[0] - by[1]).length() < 1e-9,
        "{by:?}"
    );
}

#[test]
fn packs_are_dragged_onto_rows_and_into_the_picture() {
    let mut harness = EditorHarness::new();
    let pack =
        |harness: &EditorHarness, index: usize| harness.scene().objects[index].color_pack.clone();
    assert_eq!(pack(&harness, 0), "sphere 1");
    let (from, to) = (harness.middle_of("plane"), harness.middle_of("Sphere 1"));
    carry(&mut harness, from, to);
    assert_eq!(pack(&harness, 0), "plane");
    assert_eq!(harness.editor().undo_label(), Some("Assign plane"));
    let to = place(&harness, center(harness.scene(), 1));
    carry(&mut harness, from, to);
    assert_eq!(pack(&harness, 1), "plane");
    assert_eq!(pack(&harness, 0), "plane");
    // A light's marker can be given a color pack as well.
    let to = harness.middle_of("Light 1");
    carry(&mut harness, from, to);
    let marker = harness.scene().lights[0].marker.as_ref();
    assert_eq!(marker.expect("a marker").color_pack, "plane");
}

#[test]
fn equal_packs_become_one() {
    let mut scene = Scene::demo();
    let twin: ColorPack = scene.color_packs["sphere 1"].clone();
    scene.packs_mut().insert("twin".to_owned(), twin);
    scene.objects[1].color_pack = "twin".to_owned();
    let mut harness = EditorHarness::on(scene.clone());
    harness.choose("Edit", "Merge equal packs");
    assert!(!harness.scene().color_packs.contains_key("twin"));
    assert_eq!(harness.scene().objects[1].color_pack, "sphere 1");
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene(), &scene);
}

#[test]
fn a_bookmark_is_a_view_to_come_back_to() {
    let mut harness = EditorHarness::new();
    let before = harness.scene().camera.clone();
    harness.press(CTRL, Key::B);
    harness.press(CTRL, Key::Num7);
    assert_ne!(harness.scene().camera, before);
    harness.choose("View", "Bookmarked views");
    harness.click("View 1");
    assert_eq!(harness.scene().camera, before);
    // It is stored in the file, and listed in the inspector of the camera.
    harness.type_name("bookmark 1", "Front");
    assert_eq!(harness.scene().bookmarks[0].name, "Front");
    let written = text(harness.scene().clone());
    let read = Document::from_text(&written).expect("a scene").scene;
    assert_eq!(&read, harness.scene());
    harness.click("Remove Front");
    assert!(harness.scene().bookmarks.is_empty());
}

#[test]
fn tab_goes_from_the_outliner_through_the_picture_to_the_inspector_and_the_timeline() {
    let mut harness = EditorHarness::new();
    harness.window.get_by_label("Filter").focus();
    harness.settle();
    let view = harness.view();
    let mut places: Vec<&str> = Vec::new();
    for _ in 0..160 {
        let focused = harness.window.root().children_recursive();
        let focused = focused.into_iter().find(egui_kittest::Node::is_focused);
        let rect = focused.map(|node| node.rect());
        let place = match rect {
            Some(rect) if rect.top() >= view.bottom() => "timeline",
            Some(rect) if rect.right() <= view.left() + 1.0 && rect.top() > 24.0 => "outliner",
            Some(rect) if rect == view => "picture",
            Some(rect) if rect.left() >= view.right() && rect.top() > 24.0 => "inspector",
            _ => "elsewhere",
        };
        if places.last() != Some(&place) {
            places.push(place);
        }
        if place == "timeline" {
            break;
        }
        harness.window.key_press(Key::Tab);
        harness.window.step();
        harness.window.step();
    }
    let met: Vec<&str> = places.into_iter().filter(|p| *p != "elsewhere").collect();
    assert_eq!(met, ["outliner", "picture", "inspector", "timeline"]);
}

#[test]
fn what_a_number_means_is_told_beside_the_panel_and_not_while_it_is_dragged() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let radius = |role| harness.window.get_by_role_and_label(role, "radius").rect();
    let (field, column) = (radius(Role::SpinButton).center(), radius(Role::Label));
    let hint = "In world units, greater than 0";
    hover(&mut harness, field);
    (0..60).for_each(|_| harness.window.step());
    let shown = harness.window.get_by_label_contains(hint).rect();
    assert!(shown.right() <= column.left(), "{shown:?} {column:?}");
    button(&mut harness, field, PointerButton::Primary, true, NONE);
    harness.window.step();
    assert!(!harness.sees(hint));
    button(&mut harness, field, PointerButton::Primary, false, NONE);
}

#[test]
fn an_error_goes_when_the_same_is_tried_again() {
    let mut harness = EditorHarness::new();
    harness
        .window
        .input_mut()
        .events
        .push(Event::Paste("nonsense".to_owned()));
    harness.settle();
    harness.assert_says("The clipboard holds no");
    let light = r#"Light(name: "l", position: (1, 2, 3))"#;
    harness
        .window
        .input_mut()
        .events
        .push(Event::Paste(light.to_owned()));
    harness.settle();
    assert_eq!(harness.scene().lights.len(), 3);
    let told = harness
        .window
        .query_by_label_contains("The clipboard holds no");
    assert!(told.is_none());
}

#[test]
fn in_a_narrow_window_the_timeline_has_a_menu() {
    let mut harness = EditorHarness::new();
    let rate = "frames per second";
    let menu = "More timeline settings";
    harness.window.get_by_label(rate);
    assert!(harness.window.query_by_label(menu).is_none());
    harness.window.set_size(egui::vec2(1000.0, 700.0));
    harness.settle();
    assert!(harness.window.query_by_label(rate).is_none());
    harness.click(menu);
    harness.type_into(rate, "30");
    assert_eq!(harness.scene().animation.frames_per_second, 30.0);
}

#[test]
fn what_is_typed_counts_though_the_field_shows_less_of_it() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    for typed in [1234.56, 1234.62, 12_345_678.0, 12_300_000.0] {
        harness.type_into("center x", &typed.to_string());
        assert_eq!(center(harness.scene(), 0).x, typed);
    }
}

#[test]
fn keys_do_nothing_while_a_row_is_carried() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    (0..60).for_each(|_| harness.window.step());
    let count = harness.scene().objects.len();
    let (from, to) = (
        harness.middle_of("Sphere 2"),
        harness.middle_of("Triangle 4") + egui::vec2(0.0, 4.0),
    );
    pull(&mut harness, from, to, PointerButton::Primary, NONE);
    harness.window.key_press(Key::Delete);
    (0..3).for_each(|_| harness.window.step());
    drop_at(&mut harness, to, PointerButton::Primary, NONE);
    let objects = &harness.scene().objects;
    assert_eq!(objects.len(), count, "the key was not heard");
    let there = objects.iter().position(|object| object.name == "Sphere 2");
    assert_eq!(objects[there.expect("it") - 1].name, "Triangle 4");
}

#[test]
fn rows_are_dragged_out_of_groups_and_into_them_and_groups_go_with_all_members() {
    let mut scene = Scene::demo();
    for index in [0, 3] {
        scene.objects[index].group = "Balls".to_owned();
    }
    let members: Vec<String> = [0, 3].map(|index| scene.objects[index].name.clone()).into();
    let mut harness = EditorHarness::on(scene.clone());
    let names = |harness: &EditorHarness, group: &str| -> Vec<String> {
        let objects = harness.scene().objects.iter();
        let own = objects.filter(|object| object.group == group);
        own.map(|object| object.name.clone()).collect()
    };
    let half = |harness: &EditorHarness, name: &str, share: f32| {
        let row = harness.window.get_by_label(name).rect();
        pos2(row.center().x, row.top() + share * row.height())
    };
    // Below a row that is in no group: it leaves its own group, which stays where it was.
    let (from, to) = (
        harness.middle_of(&members[0]),
        half(&harness, "Triangle 4", 0.8),
    );
    carry(&mut harness, from, to);
    assert_eq!(names(&harness, "Balls"), members[1..]);
    let objects = &harness.scene().objects;
    assert_eq!(objects[0].name, members[1], "the group is first");
    let there = objects.iter().position(|object| object.name == members[0]);
    assert_eq!(objects[there.expect("it") - 1].name, "Triangle 4");
    let item = harness.editor().selection().item();
    assert_eq!(item, there.map(Item::object), "it is what is selected");
    // Back again, above the remaining member.
    let (from, to) = (
        harness.middle_of(&members[0]),
        half(&harness, &members[1], 0.2),
    );
    carry(&mut harness, from, to);
    assert_eq!(names(&harness, "Balls"), members);
    // The group itself, below a row; it cannot be dropped within another group.
    let (from, to) = (
        harness.middle_of("Balls"),
        half(&harness, "Triangle 4", 0.8),
    );
    carry(&mut harness, from, to);
    assert_eq!(names(&harness, "Balls"), members);
    let objects = &harness.scene().objects;
    let there = objects.iter().position(|object| object.name == members[0]);
    assert_eq!(objects[there.expect("it") - 1].name, "Triangle 4");
    // Above a group, on the edge of its row.
    let (from, to) = (
        harness.middle_of("Triangle 1"),
        half(&harness, "Balls", 0.1),
    );
    carry(&mut harness, from, to);
    let objects = &harness.scene().objects;
    let there = objects
        .iter()
        .position(|object| object.name == "Triangle 1");
    assert_eq!(objects[there.expect("it") + 1].name, members[0]);
    assert_eq!(names(&harness, "Balls"), members);
    // A light is moved above or below another.
    let (from, to) = (harness.middle_of("Light 1"), half(&harness, "Light 2", 0.2));
    let before = harness.scene().clone();
    carry(&mut harness, from, to);
    assert_eq!(harness.scene(), &before, "it stands there");
    let (from, to) = (harness.middle_of("Light 1"), half(&harness, "Light 2", 0.8));
    carry(&mut harness, from, to);
    assert_eq!(harness.scene().lights[0].name, "Light 2");
}

#[test]
fn tab_goes_from_a_value_to_the_next_one() {
    let mut harness = EditorHarness::new();
    harness.click("Picture");
    harness.put_cursor_into("width");
    for (text, key) in [("900", Key::Tab), ("700", Key::Enter)] {
        harness.type_text(text);
        harness.press(NONE, key);
    }
    let render = &harness.scene().render;
    assert_eq!((render.width, render.height), (900, 700));
}

#[test]
fn undo_is_heard_beside_a_popup_which_stays() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let before = harness.scene().clone();
    harness.type_into("radius", "30");
    harness.click("color swatch");
    let is_open = |harness: &EditorHarness| egui::Popup::is_any_open(&harness.window.ctx);
    assert!(is_open(&harness) && harness.scene() != &before);
    harness.press(CTRL, Key::Z);
    assert!(is_open(&harness));
    assert_eq!(harness.scene(), &before);
    // Other keys than undo and redo have no effect until the popup is closed.
    harness.press(NONE, Key::O);
    assert_eq!(harness.scene(), &before);
}

#[test]
fn letters_and_buttons_are_larger_and_smaller_by_keys() {
    let mut harness = EditorHarness::new();
    let zoom = |harness: &EditorHarness| harness.window.ctx.zoom_factor();
    harness.press(CTRL, Key::Plus);
    assert!(zoom(&harness) > 1.05);
    harness.press(CTRL, Key::Minus);
    harness.press(CTRL, Key::Minus);
    assert!(zoom(&harness) < 0.95);
    harness.choose("View", "Text and buttons");
    harness.click("Default size");
    assert_eq!(zoom(&harness), 1.0);
}

#[test]
fn copies_stand_beside_each_other_and_are_told_where_nobody_sees_them() {
    let mut scene = Scene::demo();
    let ball = Sphere {
        center: DVec3::new(-600.0, 50.0, -300.0),
        radius: 50.0,
    };
    scene.objects[1].shape = ball.into();
    let mut harness = EditorHarness::on(scene);
    let places = |harness: &EditorHarness, name: &str| {
        let objects = harness.scene().objects.iter();
        let own = objects.filter(|object| object.name.starts_with(name));
        let mut places: Vec<f64> = own.map(|object| object.shape.middle().x).collect();
        places.sort_by(f64::total_cmp);
        places
    };
    for _ in 0..2 {
        harness.click("Sphere 1");
        harness.press(CTRL, Key::D);
        // Otherwise two clicks in a row would be a double click on its name.
        (0..60).for_each(|_| harness.window.step());
    }
    let found = places(&harness, "Sphere");
    assert_eq!(found, [-600.0, 125.0, 225.0, 325.0]);
    let told = "The copy is outside the picture";
    assert!(!harness.sees(told));
    harness.click("Sphere 2");
    harness.press(CTRL, Key::D);
    harness.assert_says(told);
}

#[test]
fn shift_selects_what_is_listed_between_two_rows() {
    let mut scene = Scene::demo();
    for index in [0, 3] {
        scene.objects[index].group = "Balls".to_owned();
    }
    // Listed: Balls (Sphere 1, Triangle 2), Sphere 2, Triangle 1, Triangle 3.
    let mut harness = EditorHarness::on(scene);
    let selected = |harness: &EditorHarness| -> Vec<String> {
        let items = harness.editor().selection().items().iter();
        let names = items.filter_map(|item| item.name(harness.scene()));
        names.map(str::to_owned).collect()
    };
    let mut range = |from: &str, to: &str| {
        let (from, to) = (harness.middle_of(from), harness.middle_of(to));
        click(&mut harness, from, NONE);
        click(&mut harness, to, Modifiers::SHIFT);
        selected(&harness)
    };
    assert_eq!(range("Triangle 2", "Sphere 2"), ["Triangle 2", "Sphere 2"]);
    let three = ["Triangle 1", "Sphere 2", "Triangle 3"];
    let mut found = range("Sphere 2", "Triangle 3");
    found.sort_by_key(|name| three.iter().position(|one| one == name));
    assert_eq!(found, three);
}

#[test]
fn packs_are_put_above_and_below_others() {
    let mut harness = EditorHarness::new();
    let before: Vec<String> = harness.scene().color_packs.keys().cloned().collect();
    let row = harness.window.get_by_label("sphere 1").rect();
    let (from, to) = (
        harness.middle_of("plane"),
        pos2(row.center().x, row.top() + 3.0),
    );
    carry(&mut harness, from, to);
    assert_eq!(
        harness.scene().color_packs.keys().next().expect("one"),
        "plane"
    );
    assert!(harness.editor().is_dirty());
    harness.press(CTRL, Key::Z);
    let after: Vec<String> = harness.scene().color_packs.keys().cloned().collect();
    assert_eq!(after, before);
}
