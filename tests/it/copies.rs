//! Where copies are placed, and which groups they belong to.

use std::collections::HashSet;

use glam::DVec3;
use glint::editor::{Edit, Item, Selection, excerpt, marker_radius};
use glint::scene::{Scene, Shape};

fn paste(scene: &mut Scene, part: &Scene) -> Vec<Item> {
    let paste = Edit::Paste(Box::new(part.clone()), "Paste");
    paste.apply(scene).expect("pasted")
}

#[test]
fn no_copy_is_where_another_thing_is() {
    let mut scene = Scene::demo();
    let selected = [Item::object(0), Item::object(1), Item::light(0)];
    let part = excerpt(&scene, &Selection::all(selected));
    // The first object has been moved away, the second has not.
    let shape = scene.objects[0].shape.moved(DVec3::Y * 1000.0);
    scene.objects[0].shape = shape;
    for copies in 1..4 {
        assert_eq!(paste(&mut scene, &part).len(), 3);
        let objects = scene.objects.iter();
        let balls = objects.filter_map(|object| match &object.shape {
            Shape::Sphere(ball) => Some(ball.center),
            _ => None,
        });
        let lights = scene.lights.iter().map(|light| light.position);
        for (places, count) in [
            (balls.collect::<Vec<_>>(), 2 + 2 * copies),
            (lights.collect(), 2 + copies),
        ] {
            let bits = |place: &DVec3| place.to_array().map(f64::to_bits);
            let apart: HashSet<_> = places.iter().map(bits).collect();
            assert_eq!((places.len(), apart.len()), (count, count), "{places:?}");
        }
    }
}

#[test]
fn a_copy_of_a_light_is_as_far_aside_as_the_scene_is_large() {
    let mut scene = Scene::demo();
    for object in scene.objects.iter_mut() {
        object.shape = object.shape.scaled(DVec3::ZERO, 1e-3);
    }
    for light in scene.lights.iter_mut() {
        light.marker = None;
    }
    let part = excerpt(&scene, &Selection::from(Item::light(0)));
    let new = paste(&mut scene, &part);
    let aside = scene.lights[new[0].index].position - scene.lights[0].position;
    assert!(aside.x > 0.0 && aside.x < 0.1, "{aside}");
    assert!((aside.x - 4.0 * marker_radius(&scene)).abs() < 1e-9);
}

#[test]
fn members_of_another_group_of_the_same_name_are_a_group_of_their_own() {
    let mut scene = Scene::demo();
    let group = |scene: &mut Scene, members: &[usize]| {
        let edit = Edit::Group(members.to_vec(), "Group 1".to_owned());
        edit.apply(scene).expect("grouped");
    };
    let mut elsewhere = scene.clone();
    group(&mut scene, &[1, 2, 3]);
    group(&mut elsewhere, &[0, 1]);
    // One of them has the name of a member of the group there.
    let selected = Selection::all([0, 1].map(Item::object));
    for item in paste(&mut scene, &excerpt(&elsewhere, &selected)) {
        assert_eq!(scene.objects[item.index].group, "Group 2");
    }
}

#[test]
fn two_pasted_groups_stay_two() {
    let mut scene = Scene::demo();
    let group = |scene: &mut Scene, members: &[usize], name: &str| {
        let edit = Edit::Group(members.to_vec(), name.to_owned());
        edit.apply(scene).expect("grouped");
    };
    let mut elsewhere = scene.clone();
    group(&mut elsewhere, &[0, 1], "Group 1");
    group(&mut elsewhere, &[2, 3], "Group 2");
    group(&mut scene, &[4, 5], "Group 1");
    let selected = Selection::all((0..4).map(Item::object));
    let pasted = paste(&mut scene, &excerpt(&elsewhere, &selected));
    let groups = pasted.iter().map(|item| &*scene.objects[item.index].group);
    let groups: Vec<&str> = groups.collect();
    assert_eq!(groups, ["Group 3", "Group 3", "Group 2", "Group 2"]);
}
