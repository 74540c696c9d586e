use std::collections::HashSet;
use std::sync::Arc;

use glam::DVec3;

use super::action::STEP;
use super::*;
use crate::mesh::Triangles;
use crate::scene::{
    Animation, Camera, Document, Easing, Interpolation, Key, Mesh, MeshSource, Object, Scene,
    Shape, Sphere, Target, Track, Value, check,
};
use proptest::prelude::*;

fn radius_edit(editor: &Editor, radius: f64) -> Action {
    let mut object = editor.scene().objects[0].clone();
    if let Shape::Sphere(Sphere { radius: r, .. }) = &mut object.shape {
        *r = radius;
    }
    Action::Edit(Edit::object(0, object, "radius"))
}

fn steps(editor: &mut Editor) -> usize {
    let mut count = 0;
    while editor.undo_label().is_some() {
        editor.apply(Action::Undo);
        count += 1;
    }
    count
}

#[test]
fn a_drag_is_one_step_and_two_drags_are_two() {
    let mut editor = Editor::demo();
    for radius in [51.0, 52.0, 53.0] {
        let action = radius_edit(&editor, radius);
        editor.apply(action);
    }
    editor.end_gesture();
    let action = radius_edit(&editor, 60.0);
    editor.apply(action);
    assert_eq!(editor.undo_label(), Some("Sphere 1: radius"));
    editor.apply(Action::Undo);
    assert_eq!(
        editor.scene().objects[0].shape,
        Shape::Sphere(Sphere {
            center: DVec3::new(125.0, 50.0, -150.0),
            radius: 53.0
        })
    );
    assert_eq!(steps(&mut editor), 1);
    assert!(!editor.is_dirty(), "undone to the saved state");
}

#[test]
fn renaming_what_has_no_keys_leaves_the_animation_shared() {
    let mut editor = Editor::demo();
    let before = Arc::clone(&editor.scene().animation);
    for item in [Item::object(0), Item::light(0)] {
        editor.apply(Action::Edit(Edit::Rename(
            item,
            format!("New {}", item.index),
        )));
        assert!(Arc::ptr_eq(&before, &editor.scene().animation));
    }
}

#[test]
fn hiding_leaves_keys_alone_and_joining_takes_them_along() {
    let mut editor = Editor::demo();
    editor.apply(Action::Edit(Edit::Join(vec![2, 3, 4])));
    let mesh = &editor.scene().objects[2];
    let (name, place) = (mesh.name.clone(), mesh.shape.position());
    let moves = Target::ObjectPosition(name.clone());
    let turns = Target::ObjectRotation(name);
    let further = place + DVec3::X * 10.0;
    let mut animation = Animation::default();
    for (target, time, point) in [
        (&moves, 0.0, place),
        (&moves, 2.0, further),
        (&turns, 0.0, DVec3::ZERO),
        (&turns, 2.0, DVec3::Y * 90.0),
    ] {
        animation = animation.with_value(target, time, Value::Point(point));
    }
    editor.apply(Action::Edit(Edit::animation(animation, "Keys")));
    editor.apply(Action::Time(Time::Seek(1.0)));
    let before = editor.scene().animation.clone();
    let hide = Edit::visible(editor.shown(), Item::object(2), false).expect("an object");
    editor.apply(Action::Edit(hide));
    assert!(!editor.scene().objects[2].visible);
    assert_eq!(editor.scene().animation, before);
    assert_eq!(editor.scene().objects[2].shape.position(), place);

    // Joined or split, things stay in the place that is shown, and the loss of keys is reported.
    editor.apply(Action::Edit(
        Edit::visible(editor.shown(), Item::object(2), true).expect("one"),
    ));
    let bounds = editor.shown().objects_bounds().expect("objects");
    let stays = |editor: &Editor| {
        let new = editor.shown().objects_bounds().expect("objects");
        (new.0 - bounds.0).length() < 1e-9 && (new.1 - bounds.1).length() < 1e-9
    };
    editor.apply(Action::Edit(Edit::Separate(2)));
    assert!(stays(&editor) && editor.scene().animation.tracks.is_empty());
    let said = editor.messages.last().expect("a message");
    assert!(
        said.text.contains("position") && said.text.contains("rotation"),
        "{said:?}"
    );
    editor.apply(Action::Undo);
    editor.apply(Action::Edit(Edit::Join(vec![2, 3])));
    assert!(stays(&editor));
    let scene = editor.scene();
    let tracks = &scene.animation.tracks;
    assert_eq!((tracks.len(), tracks[0].keys.len()), (1, 2));
    let place = scene.objects[2].shape.position();
    for (key, there) in tracks[0]
        .keys
        .iter()
        .zip([-5.0, 5.0].map(|x| place + DVec3::X * x))
    {
        let Value::Point(key) = key.value else {
            panic!("a place");
        };
        assert!((key - there).length() < 1e-9, "{key} {there}");
    }
}

#[test]
fn colors_that_joining_loses_are_said_until_it_is_undone() {
    let mut editor = Editor::demo();
    editor.apply(Action::Edit(Edit::MakePacksUnique(vec![3])));
    editor.end_gesture();
    editor.apply(Action::Edit(Edit::Join(vec![2, 3])));
    let said = editor.messages.last().expect("a message");
    assert_eq!(
        (said.text.as_str(), said.about),
        (
            "Join 2 objects: all of it uses tetrahedron now, including what used tetrahedron 2",
            STEP
        )
    );
    editor.apply(Action::Undo);
    let said = editor.messages.last().expect("a message");
    assert_eq!((said.text.as_str(), said.about), ("", STEP));
}

#[test]
fn an_invalid_edit_changes_nothing_and_says_why() {
    let mut editor = Editor::demo();
    let action = radius_edit(&editor, -1.0);
    editor.apply(action);
    assert_eq!(**editor.scene(), Scene::demo());
    assert_eq!(editor.undo_label(), None);
    assert_eq!(
        editor.messages[0].text,
        "Sphere 1: radius: radius must be greater than 0, found -1"
    );
}

#[test]
fn a_pack_in_use_stays_and_a_renamed_one_is_followed() {
    let mut editor = Editor::demo();
    editor.apply(Action::Edit(Edit::Delete(vec![Item::pack(2)])));
    assert!(
        editor.messages[0]
            .text
            .contains("is used by Triangle 1, Triangle 2")
    );
    editor.apply(Action::Edit(Edit::Rename(
        Item::pack(2),
        "glass".to_owned(),
    )));
    assert_eq!(editor.scene().objects[3].color_pack, "glass");
    assert_eq!(Item::users_of_pack(editor.scene(), "glass").count(), 6);
}

#[test]
fn lights_beside_each_other_are_so_anywhere() {
    let mut scene = Scene::demo();
    for light in scene.lights.iter_mut() {
        light.marker.as_mut().expect("a marker").radius = 1e-9;
    }
    let mut editor = Editor::demo();
    let place = DVec3::splat(1e9);
    for index in 0..2 {
        let light = scene.lights[index].clone();
        editor.apply(Action::Edit(Edit::Light(index, light, "marker")));
    }
    for _ in 0..3 {
        editor.apply(Action::Edit(Edit::AddLight(place)));
    }
    let lights = editor.scene().lights.iter().skip(2);
    let across: Vec<f64> = lights.map(|light| light.position.x).collect();
    assert!(
        across.len() == 3 && across.is_sorted_by(|a, b| a < b),
        "{across:?}"
    );
}

#[test]
fn a_unique_pack_leaves_the_others_alone() {
    let mut editor = Editor::demo();
    editor.apply(Action::Edit(Edit::MakePacksUnique(vec![2])));
    let scene = editor.scene();
    assert_eq!(scene.objects[2].color_pack, "tetrahedron 2");
    assert_eq!(
        scene.color_packs["tetrahedron 2"],
        scene.color_packs["tetrahedron"]
    );
    assert_eq!(Item::users_of_pack(scene, "tetrahedron").count(), 5);
    // Of all that share it, one keeps it.
    editor.apply(Action::Edit(Edit::MakePacksUnique((0..8).collect())));
    let scene = editor.scene();
    let packs: HashSet<&str> = scene
        .objects
        .iter()
        .map(|object| &*object.color_pack)
        .collect();
    assert_eq!(packs.len(), 9, "{packs:?}");
    let order: Vec<&String> = scene.color_packs.keys().collect();
    assert_eq!(
        order[2..6],
        [
            "tetrahedron",
            "tetrahedron 3",
            "tetrahedron 4",
            "tetrahedron 5"
        ]
    );
}

#[test]
fn what_is_added_wears_no_pack_that_was_made_for_later() {
    let mut editor = Editor::demo();
    editor.apply(Action::Edit(Edit::AddPack));
    let new = editor.scene().color_packs.len() - 1;
    let (name, pack) = editor
        .scene()
        .color_packs
        .get_index(new)
        .expect("it is new");
    let (name, mut mirror) = (name.clone(), pack.clone());
    let add = |editor: &mut Editor| {
        let shape = Shape::examples(DVec3::ZERO, 10.0)[0].clone();
        editor.apply(Action::Edit(Edit::AddObject(shape.kind(), shape)));
        let added = editor.scene().objects.last().expect("it is added");
        added.color_pack.clone()
    };
    assert_eq!(add(&mut editor), name, "nobody has changed it");
    editor.apply(Action::Undo);
    mirror.reflective = true;
    editor.apply(Action::Edit(Edit::Pack(new, mirror, "reflective")));
    assert_ne!(add(&mut editor), name);
}

#[test]
fn what_is_not_there_does_not_move() {
    let mut editor = Editor::demo();
    for _ in 0..2 {
        editor.apply(Action::Edit(Edit::Delete(vec![Item::light(0)])));
    }
    editor.apply(Action::Edit(Edit::Move(vec![Item::light(0)], 0)));
    assert!(editor.scene().lights.is_empty());
}

#[test]
fn several_packs_move_together_and_stay_selected() {
    let mut editor = Editor::demo();
    let items = vec![Item::pack(3), Item::pack(0)];
    editor.apply(Action::Select(Selection::all(items.clone())));
    editor.apply(Action::Edit(Edit::Move(items, 2)));
    let names: Vec<_> = editor.scene().color_packs.keys().collect();
    assert_eq!(
        names,
        ["sphere 2", "tetrahedron", "sphere 1", "plane", "light"]
    );
    assert_eq!(editor.selection().items(), [Item::pack(3), Item::pack(2)]);
    assert_eq!(editor.undo_label(), Some("Move 2 items"));
}

#[test]
fn high_res_ends_with_the_next_change() {
    let mut editor = Editor::demo();
    editor.apply(Action::Show(Mode::HighRes));
    editor.apply(Action::Edit(Edit::Ambient(0.25)));
    assert_eq!(editor.mode, Mode::Live);
}

fn any_edit() -> impl Strategy<Value = Action> {
    let item = (0..3_u8, 0..12_usize).prop_map(|(kind, index)| match kind {
        0 => Item::light(index),
        1 => Item::object(index),
        _ => Item::pack(index),
    });
    prop_oneof![
        (0.0..1.0_f64).prop_map(Edit::Ambient),
        any::<bool>().prop_map(Edit::LightVisualization),
        Just(Edit::AddPack),
        Just(Edit::AddLight(DVec3::new(1.0, 2.0, 3.0))),
        (0..5_usize).prop_map(|kind| {
            let shape = Shape::examples(DVec3::ZERO, 10.0)[kind].clone();
            Edit::AddObject(shape.kind(), shape)
        }),
        prop::collection::vec(item.clone(), 1..4).prop_map(Edit::Delete),
        item.clone().prop_map(Edit::Duplicate),
        (prop::collection::vec(item, 1..4), 0..12_usize)
            .prop_map(|(items, to)| Edit::Move(items, to)),
        prop::collection::vec(0..12_usize, 1..4).prop_map(Edit::MakePacksUnique),
    ]
    .prop_map(Action::Edit)
}

proptest! {
    #[test]
    fn any_edits_leave_a_valid_scene_and_are_undone_to_the_start(edits in prop::collection::vec(any_edit(), 1..30)) {
        let mut editor = Editor::demo();
        for edit in edits {
            editor.apply(edit);
            editor.end_gesture();
            prop_assert_eq!(check(editor.scene()), Ok(()));
        }
        let end = Scene::clone(editor.scene());
        let count = steps(&mut editor);
        prop_assert_eq!(&**editor.scene(), &Scene::demo());
        for _ in 0..count {
            editor.apply(Action::Redo);
        }
        prop_assert_eq!(&**editor.scene(), &end);
    }
}

#[test]
fn what_is_taken_back_or_done_again_is_selected() {
    let mut editor = Editor::demo();
    let select = |item: Item| Action::Select(Selection::all([item]));
    editor.apply(select(Item::object(1)));
    editor.apply(Action::Edit(Edit::Duplicate(Item::object(1))));
    editor.end_gesture();
    for other in [Item::object(5), Item::light(0)] {
        editor.apply(select(other));
        editor.apply(Action::Undo);
        assert_eq!(editor.selection().item(), Some(Item::object(1)));
        editor.apply(Action::Redo);
        assert_eq!(editor.selection().item(), Some(Item::object(2)));
    }
}

#[test]
fn copies_stand_beside_each_other_however_they_were_made() {
    let mut scene = Scene::demo();
    scene.objects[0].shape = Sphere {
        center: DVec3::new(34.7, 0.0, 0.0),
        radius: 6.8,
    }
    .into();
    let mut editor = Editor::demo();
    let edit = Edit::object(0, scene.objects[0].clone(), "center");
    editor.apply(Action::Edit(edit));
    for place in [0, 1, 0] {
        // A copy of a copy is rounded differently from the second copy of the original.
        editor.apply(Action::Edit(Edit::Duplicate(Item::object(place))));
    }
    for _ in 0..3 {
        editor.apply(Action::Edit(Edit::Duplicate(Item::light(0))));
    }
    let scene = editor.scene();
    let balls = scene.objects.iter().take(4);
    let mut places: Vec<f64> = balls.map(|object| object.shape.middle().x).collect();
    places.sort_by(f64::total_cmp);
    assert!(
        places.windows(2).all(|pair| pair[1] - pair[0] > 1.0),
        "{places:?}"
    );
    let mut lights: Vec<f64> = scene.lights.iter().map(|light| light.position.x).collect();
    lights.sort_by(f64::total_cmp);
    assert!(
        lights.windows(2).all(|pair| pair[1] - pair[0] > 1.0),
        "{lights:?}"
    );
}

#[test]
fn what_is_selected_is_followed_by_its_name() {
    let mut editor = Editor::demo();
    let names = |editor: &Editor| -> Vec<String> {
        let items = editor.selection().items().iter();
        let names = items.filter_map(|item| item.name(editor.scene()));
        names.map(str::to_owned).collect()
    };
    let three = [Item::object(8), Item::object(4), Item::object(3)];
    editor.apply(Action::Select(Selection::all(three)));
    editor.apply(Action::Edit(Edit::Delete(vec![Item::object(0)])));
    assert_eq!(names(&editor), ["Plane", "Triangle 3", "Triangle 2"]);
    editor.apply(Action::Edit(Edit::Delete(vec![Item::object(3)])));
    assert_eq!(names(&editor), ["Plane", "Triangle 2"]);
    assert_eq!(editor.selection().item(), Some(Item::object(2)));
    let renamed = Edit::Rename(Item::object(2), "Roof".to_owned());
    editor.apply(Action::Edit(renamed));
    assert_eq!(names(&editor), ["Plane", "Roof"]);
    // What an edit creates becomes the only selection, even at the index of something that was selected.
    editor.apply(Action::Edit(Edit::Join(vec![2, 3])));
    assert_eq!(names(&editor), ["Roof"]);
    editor.apply(Action::Undo);
    assert_eq!(names(&editor), ["Plane", "Roof"]);
}

/// About another point, each of the rotation's keys would also need one of the position.
#[test]
fn a_mesh_whose_rotation_alone_is_keyed_turns_about_its_position() {
    let mut scene = Scene::demo();
    let corners = [[10, 10, 10], [12, 10, 10], [10, 12, 10], [10, 10, 12]];
    let points = corners.map(|corner| DVec3::from_array(corner.map(f64::from)));
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let mesh = Mesh {
        position: DVec3::new(500.0, 0.0, 0.0),
        ..Mesh::of(Triangles::new(points.to_vec(), faces).expect("a mesh"))
    };
    let (position, middle) = (mesh.position, mesh.position + 11.0);
    scene.objects.push(Object::new("Aside", "plane", mesh));
    let item = Item::object(scene.objects.len() - 1);
    let selection = Selection::Items(vec![item]);
    let pivot = |scene: &Scene| selection.pivot(scene).expect("a pivot");
    assert!(pivot(&scene).distance(middle) < 1e-9);
    let track = |target: fn(String) -> Target| Track {
        target: target("Aside".to_owned()),
        keys: Vec::new(),
    };
    scene.animation_mut().tracks = vec![track(Target::ObjectRotation)];
    assert_eq!(pivot(&scene), position);
    scene
        .animation_mut()
        .tracks
        .push(track(Target::ObjectPosition));
    assert!(pivot(&scene).distance(middle) < 1e-9);
}

#[test]
fn a_gesture_that_is_cancelled_takes_back_its_own_and_nothing_else() {
    let mut editor = Editor::demo();
    let ambient = |value: f64| Action::Edit(Edit::Ambient(value));
    editor.apply(ambient(0.1));
    editor.apply(Action::BeginGesture);
    editor.apply(Action::CancelGesture);
    assert_eq!(editor.scene().ambient_intensity, 0.1);
    editor.apply(ambient(0.2));
    editor.apply(ambient(0.3));
    editor.apply(Action::CancelGesture);
    assert_eq!(editor.scene().ambient_intensity, 0.1);
    editor.apply(Action::Undo);
    assert_eq!(editor.scene(), &std::sync::Arc::new(Scene::demo()));
}

#[test]
fn saved_elsewhere_a_scene_tells_what_it_follows_no_more_and_looks_for_what_is_missing() {
    let [here, there] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
    let mesh = "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n";
    std::fs::write(here.path().join("roof.obj"), mesh).expect("written");
    std::fs::write(there.path().join("late.obj"), mesh).expect("written");
    let text = r#"Scene(version: 1, color_packs: {"a": ColorPack()}, lights: [], objects: [
        Object(name: "roof", color_pack: "a", shape: Mesh(file: "roof.obj")),
        Object(name: "late", color_pack: "a", shape: Mesh(file: "late.obj")),
    ])"#;
    let path = here.path().join("s.ron");
    std::fs::write(&path, text).expect("written");
    let mut editor = Editor::demo();
    editor.replace(Document::load(&path).expect("a scene"), Some(path));
    assert_eq!(editor.scene().mesh_problems().count(), 1);
    editor.save(&there.path().join("s.ron")).expect("saved");
    let said = &editor.messages.last().expect("a message").text;
    let lost =
        "the contents of roof.obj are in the scene file now, because they are in another folder";
    assert!(said.contains(lost), "{said}");
    assert_eq!(editor.scene().mesh_problems().count(), 0);
    assert_eq!(editor.scene().mesh_paths().len(), 1);
    // Mesh files of a scene text without a file are looked for next to the first file that it is saved to.
    let mut pasted = Document::from_text(text).expect("a scene");
    pasted.scene.load_meshes(None);
    editor.replace(pasted, None);
    editor.save(&there.path().join("new.ron")).expect("saved");
    let problems: Vec<_> = editor
        .scene()
        .mesh_problems()
        .map(|(index, _)| index)
        .collect();
    assert_eq!(problems, [0]);
}

#[test]
fn what_loses_its_last_key_stays_as_it_is_seen() {
    let mut editor = Editor::demo();
    let (light, before) = {
        let light = &editor.scene().lights[0];
        (light.name.clone(), light.position)
    };
    let lamp = |time, x| Key {
        time,
        value: Value::Point(before + DVec3::X * x),
        interpolation: Interpolation::Linear,
        easing: Easing::default(),
    };
    let track = Track {
        target: Target::LightPosition(light),
        keys: vec![lamp(0.0, 0.0), lamp(2.0, 10.0)],
    };
    let animation = Animation {
        tracks: vec![track],
        ..Animation::default()
    };
    editor.apply(Action::Edit(Edit::animation(animation, "Keys")));
    editor.apply(Action::Time(Time::Seek(1.0)));
    let seen = editor.shown().lights[0].position;
    assert!(seen.distance(before) > 1.0);
    let keys = editor.scene().animation.all_keys();
    let first = keys.iter().copied().take(1).collect();
    let edit = Edit::delete_keys(&editor.scene().animation, &first);
    editor.apply(Action::Edit(edit));
    assert_eq!(editor.scene().lights[0].position, before, "one key is left");
    editor.apply(Action::Undo);
    editor.apply(Action::Edit(Edit::delete_keys(
        &editor.scene().animation,
        &keys,
    )));
    assert_eq!(editor.scene().animation.tracks, []);
    assert_eq!(editor.scene().lights[0].position, seen);
    assert_eq!(editor.shown().lights[0].position, seen);
    editor.apply(Action::Undo);
    assert_eq!(editor.scene().lights[0].position, before);
    assert_eq!(editor.shown().lights[0].position, seen);
}

#[test]
fn the_view_stays_when_the_camera_loses_its_last_key() {
    let mut editor = Editor::demo();
    let own = editor.scene().camera.clone();
    let at = |time: f64, x: f64| {
        let position = own.position + DVec3::X * x;
        Key::new(
            time,
            Camera {
                position,
                ..own.clone()
            },
        )
    };
    let animation = Animation {
        keys: vec![at(0.0, 5.0), at(2.0, 25.0)],
        ..Animation::default()
    };
    editor.apply(Action::Edit(Edit::animation(animation, "Keys")));
    editor.apply(Action::Time(Time::Seek(1.0)));
    for is_through in [false, true] {
        if editor.looks_through() != is_through {
            editor.apply(Action::Time(Time::LookThrough(is_through)));
        }
        let seen = editor.shown().camera.clone();
        assert_eq!(seen != own, is_through);
        let keys = editor.scene().animation.all_keys();
        let edit = Edit::delete_keys(&editor.scene().animation, &keys);
        editor.apply(Action::Edit(edit));
        assert_eq!(editor.scene().camera, seen);
        assert_eq!(editor.shown().camera, seen);
        editor.apply(Action::Undo);
        assert_eq!(editor.scene().camera, own);
    }
}

#[test]
fn the_view_stays_while_something_with_keys_is_selected() {
    let mut editor = Editor::demo();
    let light = editor.scene().lights[0].clone();
    let camera = |time: f64| Key::new(time, editor.scene().camera.clone());
    let animation = Animation {
        keys: vec![camera(0.0), camera(2.0)],
        ..Animation::default()
    };
    let target = Target::LightPosition(light.name);
    let animation = animation.with_value(&target, 0.0, Value::Point(light.position));
    editor.apply(Action::Edit(Edit::animation(animation, "Keys")));
    for (selected, looks_through) in [
        (Item::light(0), false),
        (Item::light(1), true),
        (Item::light(0), true),
    ] {
        editor.apply(Action::Select(selected.into()));
        editor.apply(Action::Time(Time::Seek(1.0)));
        // Who looks through the shot already goes on doing so.
        assert_eq!(editor.looks_through(), looks_through, "{selected:?}");
    }
}

#[test]
fn a_mesh_file_that_grows_out_of_the_world_is_not_taken_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = |size: &str| format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n");
    let write = |size| std::fs::write(folder.path().join("roof.obj"), mesh(size)).expect("written");
    write("9");
    let text = r#"Scene(version: 1, color_packs: {"a": ColorPack()}, lights: [], objects: [
        Object(name: "roof", color_pack: "a", shape: Mesh(file: "roof.obj", scale: (1e6, 1e6, 1e6))),
    ])"#;
    let path = folder.path().join("s.ron");
    std::fs::write(&path, text).expect("written");
    let mut editor = Editor::demo();
    editor.replace(Document::load(&path).expect("a scene"), Some(path));
    let reread = || MeshSource::read_anew(folder.path(), "roof.obj".to_owned());
    for (size, shown) in [("90", 90.0), ("9e7", 90.0), ("8", 8.0)] {
        write(size);
        editor.take_meshes(vec![reread()]);
        let (_, high) = editor.scene().objects[0].shape.bounds().expect("bounds");
        assert_eq!(high.x, shown * 1e6, "{size}");
    }
}
