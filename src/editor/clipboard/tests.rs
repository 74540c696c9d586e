use super::*;
use crate::editor::edit::Edit;
use crate::scene::{Sphere, Target, check};

#[test]
fn a_copy_of_a_whole_group_is_one_of_its_own() {
    let mut scene = Scene::demo();
    let members: Vec<usize> = (0..3).collect();
    Edit::Group(members.clone(), "Group 1".to_owned())
        .apply(&mut scene)
        .expect("grouped");
    let groups = |scene: &Scene, from: usize| -> Vec<String> {
        scene
            .objects
            .iter()
            .skip(from)
            .map(|o| o.group.clone())
            .collect()
    };
    let all = excerpt(
        &scene,
        &Selection::all(members.into_iter().map(Item::object)),
    );
    for group in ["Group 2", "Group 3"] {
        let copies = paste(&mut scene, &all);
        // Behind their originals, which are the first group.
        assert_eq!(copies, [3, 4, 5].map(Item::object));
        assert_eq!(groups(&scene, 3)[..3], [group; 3]);
    }
    let one = excerpt(&scene, &Selection::all([Item::object(1)]));
    assert_eq!(paste(&mut scene, &one), [Item::object(2)]);
    assert_eq!(
        groups(&scene, 0)[..5],
        ["Group 1", "Group 1", "Group 1", "Group 1", "Group 3"]
    );
    // If the original is gone, the copy goes behind its group.
    scene.objects.remove(1);
    assert_eq!(paste(&mut scene, &one), [Item::object(3)]);
    // Objects of other names from a group of the same name are another group.
    let mut other = all.clone();
    for object in other.objects.iter_mut() {
        object.name.push_str(" elsewhere");
    }
    let last = scene.objects.len();
    paste(&mut scene, &other);
    assert_eq!(groups(&scene, last), ["Group 4"; 3]);
}

#[test]
fn copies_of_a_row_stand_before_it_and_those_of_anything_else_beside_it() {
    for (apart, deep, along_z) in [(100.0, 10.0, true), (100.0, 2.0, false), (0.0, 10.0, false)] {
        let mut scene = Scene::demo();
        let room = DVec3::splat(400.0);
        scene.camera = scene.camera.around(1.0, (-room, room));
        for place in [0, 1] {
            let center = DVec3::new(apart * place as f64, 0.0, 0.0);
            let radius = deep / 2.0;
            scene.objects[place].shape = Sphere { center, radius }.into();
        }
        let selected = Selection::all([0, 1].map(Item::object));
        let part = excerpt(&scene, &selected);
        let offset = paste_offset(&scene, &part);
        assert_eq!(offset.z > 0.0, along_z, "{offset}");
        assert_eq!(offset.x > 0.0, !along_z, "{offset}");
    }
}

#[test]
fn copies_are_in_the_picture_if_there_is_room() {
    let scene = Scene::demo();
    for copied in [vec![0, 1], (2..8).collect()] {
        let part = excerpt(
            &scene,
            &Selection::all(copied.into_iter().map(Item::object)),
        );
        let (low, high) = part.objects_bounds().expect("bounds");
        let offset = paste_offset(&scene, &part);
        assert!(
            is_in_picture(&scene, low.midpoint(high) + offset),
            "{offset}"
        );
    }
}

#[test]
fn what_is_copied_is_pasted_beside_it_with_its_packs() {
    let mut scene = Scene::demo();
    let selected = Selection::all([Item::object(1), Item::light(0), Item::object(0)]);
    let part = excerpt(&scene, &selected);
    let document = Document::of(part.clone());
    let text = document.to_text().expect("a text");
    let found = read(&text, &scene).expect("a scene");
    assert_eq!(found, part);
    let packs = scene.color_packs.clone();
    paste(&mut scene, &found);
    assert_eq!((scene.objects.len(), scene.lights.len()), (11, 3));
    assert_eq!(scene.color_packs, packs);
    assert_eq!(scene.objects[2].name, "Sphere 3");
    assert_ne!(scene.objects[2].shape, scene.objects[0].shape);
    assert_eq!(check(&scene), Ok(()));
    // In another scene, the color packs are added as well.
    let mut other = Scene::empty();
    paste(&mut other, &part);
    assert_eq!((other.objects.len(), check(&other)), (2, Ok(())));
}

#[test]
fn a_pack_of_another_colour_is_pasted_once_and_one_alone_as_a_copy() {
    let mut scene = Scene::demo();
    let part = excerpt(&scene, &Selection::all([Item::object(0)]));
    let name = scene.objects[0].color_pack.clone();
    let packs = scene.color_packs.len();
    scene.packs_mut()[&name].phong_exponent = 3.0;
    for _ in 0..3 {
        paste(&mut scene, &part);
    }
    assert_eq!(scene.color_packs.len(), packs + 1);
    assert_eq!(check(&scene), Ok(()));
    let alone = excerpt(&scene, &Selection::all([Item::pack(0)]));
    let copies = paste(&mut scene, &alone);
    assert_eq!(copies, [Item::pack(packs + 1)]);
    assert_eq!(scene.color_packs[packs + 1], scene.color_packs[0]);
}

#[test]
fn keys_of_values_are_copied_with_what_they_move() {
    let mut scene = Scene::demo();
    let (ball, lamp) = (scene.objects[0].name.clone(), scene.lights[0].name.clone());
    let places = [
        Target::ObjectPosition(ball),
        Target::LightPosition(lamp.clone()),
    ];
    let others = [Target::LightIntensity(lamp), Target::AmbientIntensity];
    for target in places.iter().chain(&others) {
        let value = target.get(&scene).expect("a value");
        let animation = scene.animation.with_value(target, 1.0, value);
        scene.animation = animation.into();
    }
    let selected = Selection::all([Item::object(0), Item::light(0)]);
    let part = excerpt(&scene, &selected);
    assert_eq!(part.animation.tracks.len(), 3);
    let document = Document::of(part);
    let text = document.to_text().expect("a text");
    let found = read(&text, &scene).expect("a scene");
    paste(&mut scene, &found);
    assert_eq!(check(&scene), Ok(()));
    assert_eq!(scene.animation.tracks.len(), 4 + 3);
    // The keys are offset as far as what they move.
    for track in &scene.animation.tracks {
        assert_eq!(Some(track.keys[0].value), track.target.get(&scene));
    }
    // A duplicate gets copies of the tracks, too.
    for item in [Item::object(0), Item::light(0)] {
        let copied = Edit::Duplicate(item).apply(&mut scene);
        assert!(copied.is_ok());
    }
    assert_eq!(scene.animation.tracks.len(), 4 + 3 + 3);
    for track in &scene.animation.tracks {
        assert_eq!(Some(track.keys[0].value), track.target.get(&scene));
    }
}

#[test]
fn objects_and_lights_can_be_written_by_hand() {
    let scene = Scene::demo();
    let ball =
        r#"Object(name: "b", color_pack: "plane", shape: Sphere(center: (0, 1, 2), radius: 3)),"#;
    let found = read(
        &format!("{ball}\n{ball}").replacen("\"b\"", "\"a\"", 1),
        &scene,
    );
    let found = found.expect("objects");
    assert_eq!(found.objects.len(), 2);
    assert_eq!(
        found.color_packs.get("plane"),
        scene.color_packs.get("plane")
    );
    let light = read(r#"Light(name: "l", position: (1, 2, 3))"#, &scene);
    assert_eq!(light.expect("a light").lights.len(), 1);
    assert!(read("Object(name: 3)", &scene).is_err());
    assert!(read("hello", &scene).is_err());
}
