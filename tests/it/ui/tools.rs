//! Mouse tools in the picture: clicks, handles, and the camera.

use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, ViewportCommand, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::DVec3;
use glint::editor::{Item, Selection};
use glint::scene::{Disc, Projection, Scene, Shape, Sphere, Triangle};

use crate::harness::{CTRL, EditorHarness, radius};
use crate::timeline::animation;

const SHIFT: Modifiers = Modifiers::SHIFT;
const NONE: Modifiers = Modifiers::NONE;

/// Screen position of a point of the scene.
pub fn place(harness: &EditorHarness, point: DVec3) -> Pos2 {
    let view = harness.view();
    let framing = harness.scene().camera.framing().expect("a basis");
    let [x, y] = framing.project(point).expect("in front");
    view.center() + vec2(x as f32, -y as f32) * view.height()
}

pub fn button(
    harness: &mut EditorHarness,
    at: Pos2,
    button: PointerButton,
    pressed: bool,
    modifiers: Modifiers,
) {
    harness.window.event(Event::ModifiersChanged(modifiers));
    harness.window.event(Event::PointerButton {
        pos: at,
        button,
        pressed,
        modifiers,
    });
    harness.window.step();
}

pub fn hover(harness: &mut EditorHarness, at: Pos2) {
    harness.window.event(Event::PointerMoved(at));
    harness.window.step();
}

pub fn click(harness: &mut EditorHarness, at: Pos2, modifiers: Modifiers) {
    // Two clicks must not be taken for a double click.
    (0..60).for_each(|_| harness.window.step());
    hover(harness, at);
    button(harness, at, PointerButton::Primary, true, modifiers);
    button(harness, at, PointerButton::Primary, false, modifiers);
    harness.window.event(Event::ModifiersChanged(NONE));
    harness.settle();
}

/// Presses at one position and moves to another in steps.
pub fn pull(
    harness: &mut EditorHarness,
    from: Pos2,
    to: Pos2,
    with: PointerButton,
    modifiers: Modifiers,
) {
    hover(harness, from);
    button(harness, from, with, true, modifiers);
    for part in 1..=6 {
        hover(harness, from + (to - from) * (part as f32 / 6.0));
    }
}

pub fn drop_at(harness: &mut EditorHarness, at: Pos2, with: PointerButton, modifiers: Modifiers) {
    button(harness, at, with, false, modifiers);
    harness.window.event(Event::ModifiersChanged(NONE));
    harness.settle();
}

pub fn drag(
    harness: &mut EditorHarness,
    from: Pos2,
    to: Pos2,
    with: PointerButton,
    modifiers: Modifiers,
) {
    pull(harness, from, to, with, modifiers);
    drop_at(harness, to, with, modifiers);
}

pub fn center(scene: &Scene, object: usize) -> DVec3 {
    scene.objects[object].shape.position()
}

#[test]
fn a_click_selects_what_is_seen_there() {
    let mut harness = EditorHarness::new();
    let ball = place(&harness, center(harness.scene(), 0));
    click(&mut harness, ball, NONE);
    assert_eq!(harness.selected(), ["Sphere 1"]);
    assert_eq!(
        *harness.editor().selection(),
        Selection::from(Item::object(0))
    );
    let lamp = place(&harness, harness.scene().lights[0].position);
    click(&mut harness, lamp, SHIFT);
    assert_eq!(harness.selected(), ["Sphere 1", "Light 1"]);
    click(&mut harness, ball, SHIFT);
    assert_eq!(harness.selected(), ["Light 1"]);
    let sky = place(&harness, DVec3::new(60.0, 190.0, -300.0));
    click(&mut harness, sky, NONE);
    assert_eq!(*harness.editor().selection(), Selection::Camera);
    assert_eq!(harness.scene(), &Scene::demo(), "to look changes nothing");
    assert!(!harness.editor().is_dirty());
}

#[test]
fn a_click_in_what_plays_stops_it_and_selects() {
    let mut harness = animation(&[(0.0, 0.0), (20.0, 0.0)]);
    let ball = place(&harness, center(harness.scene(), 0));
    harness.window.key_press(Key::G);
    (0..20).for_each(|_| harness.window.step());
    assert!(harness.editor().timeline().is_playing);
    click(&mut harness, ball, NONE);
    assert!(!harness.editor().timeline().is_playing);
    assert_eq!(harness.selected(), ["Sphere 1"]);
}

#[test]
fn alt_click_selects_what_is_behind() {
    let mut harness = EditorHarness::new();
    // Sphere 2 is in front of Sphere 1, and the floor is behind both.
    let [front, back] = [1, 0].map(|object| place(&harness, center(harness.scene(), object)));
    let at = front + (back - front) * 0.41;
    for expected in ["Sphere 1", "Plane", "Sphere 2", "Sphere 1"] {
        click(&mut harness, at, Modifiers::ALT);
        assert_eq!(harness.selected(), [expected]);
    }
}

#[test]
fn alt_click_selects_what_is_behind_a_whole_group() {
    let mut scene = Scene::demo();
    for ball in 0..2 {
        scene.objects[ball].group = "g".to_owned();
    }
    let mut harness = EditorHarness::on(scene);
    let [front, back] = [1, 0].map(|object| place(&harness, center(harness.scene(), object)));
    let at = front + (back - front) * 0.41;
    click(&mut harness, at, Modifiers::ALT);
    assert_eq!(harness.selected(), ["Plane"]);
    click(&mut harness, at, Modifiers::ALT);
    assert_eq!(harness.selected(), ["Sphere 1", "Sphere 2"]);
}

#[test]
fn a_body_is_dragged_in_one_step_and_escape_takes_it_back() {
    let mut harness = EditorHarness::new();
    let before = center(harness.scene(), 0);
    let from = place(&harness, before);
    let to = from + vec2(60.0, -30.0);
    drag(&mut harness, from, to, PointerButton::Primary, NONE);
    assert_eq!(harness.selected(), ["Sphere 1"]);
    let after = center(harness.scene(), 0);
    assert!(
        (place(&harness, after) - to).length() < 25.0,
        "it follows the pointer, which holds it in front of its middle"
    );
    assert_eq!(harness.scene().camera, Scene::demo().camera);
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene(), &Scene::demo());

    pull(&mut harness, from, to, PointerButton::Primary, NONE);
    assert_ne!(harness.scene(), &Scene::demo());
    harness.press(NONE, Key::Escape);
    assert_eq!(harness.scene(), &Scene::demo());
    drop_at(&mut harness, to, PointerButton::Primary, NONE);
    assert_eq!(harness.scene(), &Scene::demo());
    assert_eq!(harness.editor().undo_label(), None);
    assert_eq!(harness.selected(), ["Sphere 1"]);

    drag(&mut harness, from, to, PointerButton::Primary, SHIFT);
    let level = center(harness.scene(), 0);
    assert_eq!(level.y, before.y);
    assert_ne!(level, before);
}

#[test]
fn what_is_dragged_across_the_line_of_sight_is_not_rounded_along_it() {
    let mut scene = Scene::demo();
    scene.camera.projection = Projection::Orthographic;
    scene.camera.orthographic_height = 1000.0;
    scene.camera.position = DVec3::new(0.0, 900.0, 0.0);
    (scene.camera.look_at, scene.camera.up) = (DVec3::NEG_Y, DVec3::NEG_Z);
    let ball = Sphere {
        center: DVec3::new(0.0, 55.25, 0.0),
        radius: 50.0,
    };
    scene.objects[0].shape = ball.into();
    let mut harness = EditorHarness::on(scene);
    let from = place(&harness, ball.center);
    let to = from + vec2(60.0, -31.0);
    drag(&mut harness, from, to, PointerButton::Primary, NONE);
    let now = center(harness.scene(), 0);
    assert!(now.x > 10.0 && now.x == now.x.round(), "{now}");
    assert_eq!(now.y, 55.25);
}

#[test]
fn an_arrow_moves_along_its_axis_and_takes_typed_values() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let before = center(harness.scene(), 0);
    let unit = harness.view().height();
    let camera = &harness.scene().camera;
    let depth = (before - camera.position).dot(camera.look_at.normalize());
    // Half way along the arrow, which is 76 points long.
    let length = depth / camera.projection_distance / f64::from(unit) * 76.0;
    let from = place(&harness, before + DVec3::Y * length * 0.6);
    let to = place(&harness, before + DVec3::Y * (length * 0.6 + 30.0)) + vec2(9.0, 0.0);
    drag(&mut harness, from, to, PointerButton::Primary, NONE);
    let moved = center(harness.scene(), 0) - before;
    assert!(
        moved.x == 0.0 && moved.z == 0.0 && (moved.y - 30.0).abs() < 2.0,
        "{moved}"
    );
    assert_eq!(harness.editor().undo_label(), Some("Sphere 1: move"));
    harness.press(CTRL, Key::Z);

    drag(&mut harness, from, to, PointerButton::Primary, CTRL);
    assert_eq!(center(harness.scene(), 0).y % 10.0, 0.0);
    harness.press(CTRL, Key::Z);

    pull(&mut harness, from, to, PointerButton::Primary, NONE);
    harness.window.event(Event::Text("12.5".to_owned()));
    harness.window.step();
    harness.press(NONE, Key::Enter);
    drop_at(&mut harness, to, PointerButton::Primary, NONE);
    assert_eq!(center(harness.scene(), 0) - before, DVec3::Y * 12.5);
    harness.press(CTRL, Key::Z);

    // A decimal comma is accepted; text that is no number moves nothing and does not end the drag.
    pull(&mut harness, from, to, PointerButton::Primary, NONE);
    harness.window.event(Event::Text("-".to_owned()));
    harness.window.step();
    harness.press(NONE, Key::Enter);
    harness.window.event(Event::Text("1,5".to_owned()));
    harness.window.step();
    harness.press(NONE, Key::Enter);
    drop_at(&mut harness, to, PointerButton::Primary, NONE);
    assert_eq!(center(harness.scene(), 0) - before, DVec3::Y * -1.5);
}

#[test]
fn an_arrow_over_a_normal_moves_and_a_normal_turns_from_where_it_is() {
    let upright = DVec3::Y;
    for normal in [upright, DVec3::new(-0.6, 0.8, 0.0)] {
        let mut scene = Scene::demo();
        let middle = center(&scene, 0);
        scene.objects[0].shape = Disc {
            center: middle,
            normal,
            radius: 2.0,
        }
        .into();
        let mut harness = EditorHarness::on(scene);
        harness.click("Sphere 1");
        let unit = harness.view().height();
        let camera = &harness.scene().camera;
        let depth = (middle - camera.position).dot(camera.look_at.normalize());
        let length = depth / camera.projection_distance / f64::from(unit) * 76.0;
        let from = place(&harness, middle + normal * length * 0.6);
        let to = from + vec2(0.0, -8.0);
        drag(&mut harness, from, to, PointerButton::Primary, NONE);
        let Shape::Disc(disc) = &harness.scene().objects[0].shape else {
            panic!("a disc");
        };
        if normal == upright {
            assert!(disc.center.y > middle.y && disc.normal == normal);
        } else {
            let turned = disc.normal.angle_between(normal).to_degrees();
            assert!(
                disc.center == middle && 0.0 < turned && turned < 20.0,
                "{turned}"
            );
        }
    }
}

#[test]
fn the_menu_is_about_what_is_there_also_where_that_is_not_known_yet() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 2");
    let at = place(&harness, center(harness.scene(), 0));
    hover(&mut harness, at);
    harness.turn_wheel(MouseWheelUnit::Line, 1.0);
    harness.window.step();
    button(&mut harness, at, PointerButton::Secondary, true, NONE);
    button(&mut harness, at, PointerButton::Secondary, false, NONE);
    harness.wait_for("what is there", |harness| harness.sees("Duplicate"));
    assert_eq!(harness.selected(), ["Sphere 1"]);
}

#[test]
fn a_projection_that_is_chosen_in_the_inspector_is_that_of_its_key() {
    let mut by_key = EditorHarness::new();
    by_key.press(NONE, Key::O);
    let mut harness = EditorHarness::new();
    harness.unfold("projection");
    harness.click("Orthographic");
    assert_eq!(harness.scene().camera, by_key.scene().camera);
}

#[test]
fn the_rim_of_a_ball_is_its_radius_and_corners_are_moved_one_by_one() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let middle = center(harness.scene(), 0);
    let camera = &harness.scene().camera;
    let basis = camera.basis().expect("a basis");
    // To the left, where there is no arrow.
    let side = (basis.x_axis * -1.0 + basis.y_axis * -0.5).normalize();
    let arm = middle - camera.position;
    let side = (side - arm * (side.dot(arm) / arm.length_squared())).normalize();
    let distance = arm.length();
    let rim = |radius: f64| {
        let nearer = arm * (radius * radius / distance / distance);
        middle - nearer + side * (radius * (1.0 - (radius / distance).powi(2)).sqrt())
    };
    let (from, to) = (place(&harness, rim(50.0)), place(&harness, rim(62.0)));
    drag(&mut harness, from, to, PointerButton::Primary, NONE);
    let found = radius(harness.scene(), 0);
    assert!((found - 62.0).abs() < 0.6, "{found}");
    assert_eq!(center(harness.scene(), 0), middle);

    harness.click("Triangle 2");
    let Shape::Triangle(Triangle { a, .. }) = harness.scene().objects[3].shape else {
        panic!("a triangle");
    };
    let from = place(&harness, a);
    drag(
        &mut harness,
        from,
        from + vec2(20.0, 12.0),
        PointerButton::Primary,
        NONE,
    );
    let Shape::Triangle(triangle) = harness.scene().objects[3].shape else {
        panic!("a triangle");
    };
    assert_ne!(triangle.a, a);
    assert!((place(&harness, triangle.a) - from - vec2(20.0, 12.0)).length() < 2.0);
    let Shape::Triangle(old) = Scene::demo().objects[3].shape else {
        panic!("a triangle");
    };
    assert_eq!((triangle.b, triangle.c), (old.b, old.c));
}

#[test]
fn several_are_moved_turned_copied_and_deleted_as_one() {
    let mut harness = EditorHarness::new();
    let (one, other) = (center(harness.scene(), 0), center(harness.scene(), 1));
    let both = [one, other].map(|point| place(&harness, point));
    click(&mut harness, both[0], NONE);
    click(&mut harness, both[1], SHIFT);
    assert_eq!(harness.selected(), ["Sphere 1", "Sphere 2"]);
    drag(
        &mut harness,
        both[1],
        both[1] + vec2(0.0, -40.0),
        PointerButton::Primary,
        NONE,
    );
    let moved = [
        center(harness.scene(), 0) - one,
        center(harness.scene(), 1) - other,
    ];
    assert!(
        (moved[0] - moved[1]).length() < 1e-9 && moved[0].length() > 1.0,
        "{moved:?}"
    );
    assert_eq!(harness.editor().undo_label(), Some("Move 2 items"));
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene(), &Scene::demo());
    assert_eq!(harness.selected(), ["Sphere 1", "Sphere 2"]);

    harness.press(CTRL, Key::D);
    assert_eq!(harness.selected(), ["Sphere 3", "Sphere 4"]);
    harness.press(NONE, Key::Delete);
    assert_eq!(harness.scene(), &Scene::demo());
    assert_eq!(*harness.editor().selection(), Selection::Camera);
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene().objects.len(), 11);
}

#[test]
fn a_frame_selects_what_is_seen_in_it() {
    let mut harness = EditorHarness::new();
    let view = harness.view();
    let (from, to) = (view.min + vec2(4.0, 4.0), view.max - vec2(4.0, 4.0));
    drag(&mut harness, from, to, PointerButton::Primary, SHIFT);
    let found = harness.selected();
    assert!(
        found.contains(&"Sphere 1") && found.contains(&"Light 1"),
        "{found:?}"
    );
    assert!(!found.contains(&"Plane"), "{found:?}");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn groups_come_whole_into_frames_and_go_whole_again() {
    let mut scene = Scene::demo();
    let mut triangles = Vec::new();
    for (index, object) in scene.objects.iter_mut().enumerate() {
        if matches!(object.shape, Shape::Triangle(_)) {
            object.group = "Tetrahedron".to_owned();
            triangles.push(Item::object(index));
        }
    }
    let group = Selection::all(triangles.iter().copied());
    let mut harness = EditorHarness::on(scene);
    let view = harness.view();
    let (from, to) = (view.min + vec2(4.0, 4.0), view.max - vec2(4.0, 4.0));
    drag(&mut harness, from, to, PointerButton::Primary, SHIFT);
    assert!(triangles.len() > 2);
    let selected = harness.editor().selection().clone();
    assert!(selected.has_all(triangles.iter().copied()), "{selected:?}");

    let scene = harness.scene().clone();
    let ball = Selection::from(Item::object(0));
    let both = ball.toggled_at(&scene, triangles[1]);
    assert_eq!(both.items().len(), triangles.len() + 1);
    assert_eq!(both.toggled_at(&scene, triangles[2]), ball);
    // Toggling a member of a group that is selected alone removes only that member.
    let without = group.toggled_at(&scene, triangles[2]);
    assert_eq!(without.items().len(), triangles.len() - 1);
}

#[test]
fn what_a_key_cannot_do_is_told() {
    let mut harness = EditorHarness::new();
    harness.press(NONE, Key::Delete);
    harness
        .window
        .get_by_label("Delete the selection: nothing is selected");
    harness.press(CTRL, Key::Z);
    harness.window.get_by_label("Undo: nothing to undo");
    assert!(!harness.sees("Delete the selection: nothing is selected"));
}

#[test]
fn the_camera_circles_pans_and_comes_nearer() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    let middle = center(harness.scene(), 0);
    let start = harness.scene().camera.clone();
    let at = place(&harness, middle);
    let sky = place(&harness, DVec3::new(60.0, 190.0, -300.0));
    drag(
        &mut harness,
        sky,
        sky + vec2(40.0, 15.0),
        PointerButton::Primary,
        NONE,
    );
    let circled = harness.scene().camera.clone();
    assert_ne!(circled.position, start.position);
    assert!(
        (place(&harness, middle) - at).length() < 1.0,
        "it is circled"
    );
    harness.press(CTRL, Key::Z);
    assert_eq!(harness.scene().camera, start);

    drag(
        &mut harness,
        at,
        at + vec2(40.0, 15.0),
        PointerButton::Middle,
        NONE,
    );
    assert_eq!(harness.scene().camera.look_at, start.look_at);
    assert!((place(&harness, middle) - at - vec2(40.0, 15.0)).length() < 12.0);
    harness.press(CTRL, Key::Z);

    harness.press(NONE, Key::F);
    let at = place(&harness, middle);
    let view = harness.view();
    assert!((at - view.center()).length() < 1.0);
    harness.press(NONE, Key::Home);
    harness.press(CTRL, Key::Num7);
    assert_eq!(harness.scene().camera.look_at, DVec3::NEG_Y);
    for _ in 0..3 {
        harness.press(CTRL, Key::Z);
    }
    assert_eq!(harness.scene().camera, start);
}

#[test]
fn escape_leaves_one_thing_after_the_other() {
    let mut harness = EditorHarness::new();
    harness.click("Sphere 1");
    harness.press(NONE, Key::Escape);
    assert_eq!(*harness.editor().selection(), Selection::Camera);
    harness.press(NONE, Key::Escape);
    assert!(harness.window.query_by_label("Quit now").is_none());
    harness.assert_says("Esc once more asks whether to quit");
    harness.press(NONE, Key::Escape);
    harness.window.get_by_label("Quit now");
    harness.window.key_down(Key::Enter);
    for _ in 0..4 {
        harness.window.step();
        let mut windows = harness.window.output().viewport_output.values();
        assert!(!windows.any(|window| window.commands.contains(&ViewportCommand::Close)));
    }
    harness.window.key_up(Key::Enter);
    harness.settle();
    assert!(harness.window.query_by_label("Quit now").is_none());
}

#[test]
fn what_is_pasted_by_its_name_is_pasted() {
    let mut harness = EditorHarness::new();
    harness.press(CTRL, Key::K);
    harness.type_text("paste");
    harness.window.key_press(Key::Enter);
    harness.window.step();
    // The clipboard answers as soon as it is asked.
    let text = r#"Object(name: "New", color_pack: "plane", shape: Sphere(center: (120, 90, -80), radius: 9))"#;
    harness.window.event(Event::Paste(text.to_owned()));
    harness.settle();
    assert_eq!(harness.selected(), ["New"]);
}

#[test]
fn text_is_pasted_and_what_is_none_is_refused() {
    let mut harness = EditorHarness::new();
    let text = r#"Object(name: "New", color_pack: "plane", shape: Sphere(center: (120, 90, -80), radius: 9))"#;
    harness.window.event(Event::Paste(text.to_owned()));
    harness.settle();
    assert_eq!(harness.selected(), ["New"]);
    assert_eq!(radius(harness.scene(), 9), 9.0);
    // With a comment in front, and with a mesh whose file is missing.
    let text = r#"// mine
Object(name: "Gone", color_pack: "plane", shape: Mesh(file: "gone.ply"))"#;
    harness.window.event(Event::Paste(text.to_owned()));
    harness.settle();
    assert_eq!(harness.selected(), ["Gone"]);
    harness.assert_says("\"Gone\" is not in the picture");
    harness.click("Dismiss");
    harness.press(CTRL, Key::Z);
    harness.window.event(Event::Cut);
    harness.settle();
    assert_eq!(harness.scene(), &Scene::demo());
    harness
        .window
        .event(Event::Paste("half a sentence".to_owned()));
    harness.settle();
    harness.assert_says("The clipboard holds no objects or lights");
    assert_eq!(harness.scene(), &Scene::demo());
}

#[test]
fn the_head_of_an_arrow_comes_before_a_ring_through_it() {
    let mut scene = Scene::demo();
    let mut harness = EditorHarness::new();
    let middle = center(&scene, 0);
    let [at, above] = [middle, middle + DVec3::Y].map(|point| place(&harness, point));
    let Shape::Sphere(ball) = &mut scene.objects[0].shape else {
        panic!("a ball");
    };
    // As large as the arrow is long, so that its contour passes through the arrow's head.
    ball.radius = 76.0 / f64::from(at.y - above.y);
    let tip = place(&harness, middle + DVec3::Y * ball.radius);
    harness = EditorHarness::on(scene.clone());
    click(&mut harness, at, NONE);
    let up = vec2(0.0, -20.0);
    drag(&mut harness, tip, tip + up, PointerButton::Primary, NONE);
    assert_eq!(radius(harness.scene(), 0), radius(&scene, 0));
    assert!(center(harness.scene(), 0).y > middle.y);
    harness.press(CTRL, Key::Z);
    let step = harness.editor().undo_label().map(str::to_owned);
    pull(&mut harness, tip, tip + up, PointerButton::Primary, NONE);
    assert!(center(harness.scene(), 0).y > middle.y);
    hover(&mut harness, tip);
    drop_at(&mut harness, tip, PointerButton::Primary, NONE);
    assert_eq!(harness.scene(), &scene);
    assert_eq!(
        harness.editor().undo_label(),
        step.as_deref(),
        "nothing was done"
    );
}

#[test]
fn everything_is_found_by_its_name() {
    let mut harness = EditorHarness::new();
    harness.press(CTRL, Key::K);
    harness.type_text("here 2");
    harness.press(NONE, Key::Enter);
    assert_eq!(harness.selected(), ["Sphere 2"]);
    harness.press(CTRL, Key::K);
    harness.type_text("ortho");
    harness.press(NONE, Key::Enter);
    assert_eq!(
        harness.scene().camera.projection,
        glint::scene::Projection::Orthographic
    );
    assert!(!harness.sees("Enter runs the"));
    // What is possible comes first: nothing is in a group yet.
    harness.click("Sphere 1");
    harness.press(CTRL, Key::K);
    harness.type_text("group");
    harness.press(NONE, Key::Enter);
    assert_eq!(harness.scene().objects[0].group, "Group 1");
    harness.press(CTRL, Key::Z);
    // The same for groups; a group is not grouped again.
    harness.click("Triangle 2");
    harness.click_with(CTRL, "Triangle 4");
    for _ in 0..2 {
        harness.press(CTRL, Key::G);
    }
    harness.click("Sphere 1");
    harness.press(CTRL, Key::K);
    harness.type_text("group 1");
    harness.press(NONE, Key::Enter);
    assert_eq!(harness.selected(), ["Triangle 2", "Triangle 4"]);
    // Synonyms are found, too.
    for (word, name) in [("add ball", "Sphere 3"), ("cube", "Box 1")] {
        harness.press(CTRL, Key::K);
        harness.type_text(word);
        harness.press(NONE, Key::Enter);
        assert_eq!(harness.selected(), [name]);
    }
    harness.press(CTRL, Key::K);
    harness.type_text("show clay");
    harness.press(NONE, Key::Enter);
    harness.window.get_by_label("Leave Clay");
}

#[test]
fn a_pixel_is_explained_and_parts_of_the_light_are_shown() {
    let mut harness = EditorHarness::new();
    let at = place(&harness, center(harness.scene(), 0));
    hover(&mut harness, at);
    button(&mut harness, at, PointerButton::Secondary, true, NONE);
    button(&mut harness, at, PointerButton::Secondary, false, NONE);
    harness.settle();
    harness.click("Why this colour");
    harness.wait_for("the reasons", |harness| {
        let term = harness.window.query_by_label("ambient intensity · ambient");
        term.is_some()
    });
    // The explanation follows the scene.
    let told = |harness: &EditorHarness| {
        let node = harness.window.get_by_label_contains("uses sphere 1, ");
        node.accesskit_node().value()
    };
    let before = told(&harness);
    harness.type_into("radius", "10");
    harness.wait_for("the reasons anew", |harness| told(harness) != before);
    harness.press(CTRL, Key::Z);
    harness.wait_for("those of before", |harness| told(harness) == before);
    harness.press(NONE, Key::Escape);
    let whole = harness.picture();
    harness.choose("View", "Show");
    harness.click("Clay");
    assert!(harness.picture() != whole);
    harness.window.get_by_label("Leave Clay");
    harness.press(NONE, Key::Escape);
    harness.press(NONE, Key::Escape);
    assert!(harness.picture() == whole);
    assert_eq!(harness.scene(), &Scene::demo());
}
