//! What is copied and pasted: the text of a scene with nothing else in it.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::ops::Range;

use glam::DVec3;
use indexmap::IndexMap;

use super::adding::step_of_light;
use super::arrange::{Arrangement, arrange};
use super::item::{Item, ItemKind};
use super::names::{Spot, step_aside, way_past};
use super::selection::Selection;
use crate::scene::{
    ColorPack, Document, List, Names, Owner, Owners, Scene, SceneError, Track, header, names_field,
    without_number,
};

/// How deep a row is, as a share of its length, whose copy stands before it.
const THINNEST: f64 = 0.05;

/// The selected things alone, with the packs that they wear and the keys of their values.
pub fn excerpt(scene: &Scene, selected: &Selection) -> Scene {
    let of = |kind| selected.places(kind).into_iter();
    let objects = of(ItemKind::Object).filter_map(|index| scene.objects.get(index).cloned());
    let lights = of(ItemKind::Light).filter_map(|index| scene.lights.get(index).cloned());
    let mut part = Scene {
        objects: objects.collect(),
        lights: lights.collect(),
        ..Scene::empty()
    };
    let worn = part.worn_packs();
    let chosen: HashSet<usize> = of(ItemKind::Pack).collect();
    let packs = scene.color_packs.iter().enumerate();
    let packs =
        packs.filter(|(place, (name, _))| worn.contains(name.as_str()) || chosen.contains(place));
    let packs: IndexMap<String, ColorPack> = packs
        .map(|(_, (name, pack))| (name.clone(), pack.clone()))
        .collect();
    *part.packs_mut() = packs;
    part.animation_mut().tracks = tracks_of(&part, scene);
    part
}

/// What moves the things of a part in the scene that it is from.
fn tracks_of(part: &Scene, scene: &Scene) -> Vec<Track> {
    let owners = Owners::of(
        part,
        scene.animation.tracks.iter().map(|track| &track.target),
    );
    let tracks = scene.animation.tracks.iter();
    let own = tracks.filter(|track| owners.index(&track.target).is_some());
    own.cloned().collect()
}

/// What a text means that is pasted into a scene: the text of a scene, or of objects, of lights, or of packs. Packs
/// that objects wear are looked up in the scene.
///
/// # Errors
/// [`SceneError::Refused`]: why it is neither; places are those of the whole that the text is part of.
pub fn read(text: &str, scene: &Scene) -> Result<Scene, SceneError> {
    let text = text.trim().trim_end_matches(',');
    let body = &text[header(text).len()..];
    let word = body.split(|c: char| !c.is_alphanumeric()).next();
    if body.starts_with('"') {
        let whole =
            format!("Scene(version: 1, color_packs: {{\n{text}\n}}, objects: [], lights: [])");
        return Document::from_text(&whole).map(|document| document.scene);
    }
    if !matches!(word, Some("Object" | "Light")) {
        let mut read = Document::from_text(text)?.scene;
        // What a scene leaves out is that of the demo, which nobody has written here.
        if !names_field(text, "lights") {
            read.lights = List::new();
        }
        if !names_field(text, "objects") {
            read.objects = List::new();
        }
        if names_field(text, "color_packs") {
            return Ok(read);
        }
        return Ok(excerpt(&read, &Selection::all(Item::everything(&read))));
    }
    let mut packs = String::new();
    for name in scene.color_packs.keys() {
        let _ = write!(packs, "{name:?}: ColorPack(),");
    }
    let (objects, lights) = if word == Some("Object") {
        (text, "")
    } else {
        ("", text)
    };
    let whole = format!(
        "Scene(version: 1, color_packs: {{{packs}}}, objects: [\n{objects}\n], lights: [{lights}])"
    );
    let mut read = Document::from_text(&whole)?.scene;
    // The scene has them as they are.
    read.color_packs = scene.color_packs.clone();
    Ok(excerpt(&read, &Selection::all(Item::everything(&read))))
}

/// Adds everything in `pasted`, objects behind those that they are copies of, and the rest behind what is there: for
/// what wears packs, those that are there already are used; others get a name that is free. Returns the lights and
/// objects that are new, or the packs where nothing else is pasted.
pub fn paste(scene: &mut Scene, pasted: &Scene) -> Vec<Item> {
    let (lights, objects) = (scene.lights.len(), scene.objects.len());
    let before = scene.color_packs.len();
    let are_alone = pasted.lights.is_empty() && pasted.objects.is_empty();
    let packs = paste_packs(scene, pasted, are_alone);
    if are_alone {
        return (before..scene.color_packs.len()).map(Item::pack).collect();
    }
    let known = |name: &mut String| {
        if let Some(free) = packs.get(name) {
            name.clone_from(free);
        }
    };
    let by = way_aside(scene, pasted);
    // What they are called here.
    let mut names = HashMap::new();
    let mut taken = Names::new(scene.objects.iter().map(|object| &*object.name));
    let groups = new_groups(scene, pasted);
    for object in &pasted.objects {
        let own = Owner::Object(&object.name);
        let mut object = object.clone();
        known(&mut object.color_pack);
        object.name = taken.take(&object.name);
        names.insert(own, object.name.clone());
        object.shape = object.shape.moved(by);
        if let Some(group) = groups.get(&object.group) {
            object.group.clone_from(group);
        }
        scene.objects.push(object);
    }
    let mut taken = Names::new(scene.lights.iter().map(|light| &*light.name));
    for light in &pasted.lights {
        let own = Owner::Light(&light.name);
        let mut light = light.clone();
        light.position += by;
        if let Some(marker) = &mut light.marker {
            known(&mut marker.color_pack);
        }
        light.name = taken.take(&light.name);
        names.insert(own, light.name.clone());
        scene.lights.push(light);
    }
    let tracks = pasted.animation.tracks.iter().filter_map(|track| {
        let name = names.get(&track.target.owner()?)?;
        Some(track.for_copy(name, by))
    });
    let tracks: Vec<Track> = tracks.collect();
    if !tracks.is_empty() {
        scene.animation_mut().tracks.extend(tracks);
    }
    let lights = (lights..scene.lights.len()).map(Item::light);
    let objects = objects..scene.objects.len();
    let objects = match behind_originals(scene, pasted, objects.clone()) {
        Some(arrangement) => arrange(scene, arrangement),
        None => objects.map(Item::object).collect(),
    };
    lights.chain(objects).collect()
}

/// Adds packs, unless they are there already and no copy is wanted: what each is called in the scene. One may be there
/// under another number: with every paste there would be one more like it.
fn paste_packs(scene: &mut Scene, pasted: &Scene, are_copies: bool) -> IndexMap<String, String> {
    let mut taken = Names::new(scene.color_packs.keys().map(String::as_str));
    let mut names = IndexMap::new();
    for (name, pack) in pasted.color_packs.iter() {
        let is_same = |there: &(&String, &ColorPack)| {
            there.1 == pack && without_number(there.0) == without_number(name)
        };
        let own = scene.color_packs.get_key_value(name);
        let own = own.filter(|(_, there)| *there == pack);
        let there = own.or_else(|| scene.color_packs.iter().find(is_same));
        let there = there.filter(|_| !are_copies).map(|(name, _)| name.clone());
        let here = there.unwrap_or_else(|| {
            let free = taken.take(name);
            scene.packs_mut().insert(free.clone(), pack.clone());
            free
        });
        names.insert(name.clone(), here);
    }
    names
}

/// Puts new objects at the end of the list behind those of the same names in what is pasted, or behind their group; not
/// between the members of another one. `None` where there are none.
fn behind_originals(scene: &Scene, pasted: &Scene, new: Range<usize>) -> Option<Arrangement> {
    let names = pasted.objects.iter().map(|object| &*object.name);
    let names: HashSet<&str> = names.collect();
    let group = |index: usize| scene.objects[index].group.as_str();
    let own = group(new.clone().next()?);
    let last_in =
        |name: &str| (0..new.start).rfind(|index| !name.is_empty() && group(*index) == name);
    let original = (0..new.start).rfind(|index| names.contains(&*scene.objects[*index].name));
    let beside = original.or_else(|| last_in(own))?;
    let is_of_group = new.clone().all(|index| group(index) == group(beside));
    let around = last_in(group(beside)).filter(|_| !is_of_group);
    Some(Arrangement {
        objects: new.collect(),
        anchor: around.unwrap_or(beside),
        is_after: true,
        group: None,
    })
}

/// What groups are called of which all is pasted once more, or that are others of the same name: each is a group of its
/// own. Some members of a group stay in it, and one alone in any case: it may have been cut out there.
fn new_groups(scene: &Scene, pasted: &Scene) -> HashMap<String, String> {
    let there = members(scene);
    let mut taken = Names::new(there.keys().copied());
    let mut new = HashMap::new();
    for (group, own) in members(pasted) {
        let Some(others) = there.get(group) else {
            continue;
        };
        let is_part = own.is_subset(others) && own.len() < others.len();
        if own.len() > 1 && !is_part {
            new.insert(group.to_owned(), taken.take(group));
        }
    }
    new
}

/// The groups of a scene, and the names of what is in them.
fn members(scene: &Scene) -> IndexMap<&str, HashSet<&str>> {
    let mut members: IndexMap<&str, HashSet<&str>> = IndexMap::new();
    for object in scene
        .objects
        .iter()
        .filter(|object| !object.group.is_empty())
    {
        members
            .entry(&object.group)
            .or_default()
            .insert(&object.name);
    }
    members
}

/// From where things were copied to where they do not stand in each other: two things in one place would
/// shadow each other. All of them go the same way.
fn way_aside(scene: &Scene, pasted: &Scene) -> DVec3 {
    let step = match (pasted.objects.first(), pasted.objects_bounds()) {
        (None, _) => {
            let first = pasted.lights.first();
            first.map_or(DVec3::ZERO, |light| step_of_light(scene, light))
        }
        // What stands in a row has its copy before it, and not where the picture ends.
        (_, Some((low, high))) => {
            let size = high - low;
            let is_row = pasted.objects.len() > 1 && size.x * THINNEST < size.z && size.z < size.x;
            if is_row {
                DVec3::Z * size.z
            } else {
                DVec3::X * size.max_element()
            }
        }
        (Some(first), None) => step_aside(scene, &first.shape),
    };
    let new: Vec<Spot> = Spot::all_of(pasted).collect();
    way_past(scene, &new, (step, 0))
}

#[cfg(test)]
mod tests {
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
            // Behind what they are copies of, which is the first group.
            assert_eq!(copies, [3, 4, 5].map(Item::object));
            assert_eq!(groups(&scene, 3)[..3], [group; 3]);
        }
        let one = excerpt(&scene, &Selection::all([Item::object(1)]));
        assert_eq!(paste(&mut scene, &one), [Item::object(2)]);
        assert_eq!(
            groups(&scene, 0)[..5],
            ["Group 1", "Group 1", "Group 1", "Group 1", "Group 3"]
        );
        // Where that is gone, behind its group.
        scene.objects.remove(1);
        assert_eq!(paste(&mut scene, &one), [Item::object(3)]);
        // What comes from elsewhere and has the same name is another group.
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
        for (apart, deep, along_z) in [(100.0, 10.0, true), (100.0, 2.0, false), (0.0, 10.0, false)]
        {
            let mut scene = Scene::demo();
            for place in [0, 1] {
                let center = DVec3::new(apart * place as f64, 0.0, 0.0);
                let radius = deep / 2.0;
                scene.objects[place].shape = Sphere { center, radius }.into();
            }
            let selected = Selection::all([0, 1].map(Item::object));
            let part = excerpt(&scene, &selected);
            let by = way_aside(&scene, &part);
            assert_eq!(by.z > 0.0, along_z, "{by}");
            assert_eq!(by.x > 0.0, !along_z, "{by}");
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
        // Elsewhere the packs come with it.
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
        // They are as far away as what they move.
        for track in &scene.animation.tracks {
            assert_eq!(Some(track.keys[0].value), track.target.get(&scene));
        }
        // A copy of one of them has them as well.
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
        let ball = r#"Object(name: "b", color_pack: "plane", shape: Sphere(center: (0, 1, 2), radius: 3)),"#;
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
}
