//! Copy and paste: the clipboard holds the text of a scene with nothing else in it.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::ops::Range;

use glam::DVec3;
use indexmap::IndexMap;

use super::adding::light_copy_step;
use super::arrange::{Arrangement, arrange};
use super::item::{Item, ItemKind};
use super::names::{Spot, offset_to_free_place, shape_copy_step};
use super::selection::Selection;
use crate::scene::{
    ColorPack, Document, List, Names, Owner, Owners, Scene, SceneError, Track, header, names_field,
};

/// Least depth (z) of a row of objects, as a share of its length (x), for its copy to be placed in front of it.
const MIN_ROW_DEPTH_SHARE: f64 = 0.05;

/// Returns a scene of the selected things alone, with the color packs that they use and the tracks that animate them.
pub fn excerpt(scene: &Scene, selected: &Selection) -> Scene {
    let indices_of = |kind| selected.indices(kind).into_iter();
    let objects =
        indices_of(ItemKind::Object).filter_map(|index| scene.objects.get(index).cloned());
    let lights = indices_of(ItemKind::Light).filter_map(|index| scene.lights.get(index).cloned());
    let mut part = Scene {
        objects: objects.collect(),
        lights: lights.collect(),
        ..Scene::empty()
    };
    let used = part.used_packs();
    let chosen: HashSet<usize> = indices_of(ItemKind::Pack).collect();
    let packs = scene.color_packs.iter().enumerate();
    let packs =
        packs.filter(|(index, (name, _))| used.contains(name.as_str()) || chosen.contains(index));
    let packs: IndexMap<String, ColorPack> = packs
        .map(|(_, (name, pack))| (name.clone(), pack.clone()))
        .collect();
    *part.packs_mut() = packs;
    part.animation_mut().tracks = tracks_of(&part, scene);
    part
}

/// Returns the tracks of `scene` that animate things in `part`, an excerpt of it.
fn tracks_of(part: &Scene, scene: &Scene) -> Vec<Track> {
    let owners = Owners::of(
        part,
        scene.animation.tracks.iter().map(|track| &track.target),
    );
    let tracks = scene.animation.tracks.iter();
    let owned = tracks.filter(|track| owners.index(&track.target).is_some());
    owned.cloned().collect()
}

/// Parses a text pasted into a scene: the text of a scene, or of objects, lights or color packs. Color packs that
/// objects use are looked up in the scene.
///
/// # Errors
/// [`SceneError::Refused`]: why the text is none of these; positions refer to the complete scene text that the pasted
/// text is wrapped in.
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
        // Fields that a scene text omits default to those of the demo scene, which nobody has written here.
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
    // The color packs as they are in the scene.
    read.color_packs = scene.color_packs.clone();
    Ok(excerpt(&read, &Selection::all(Item::everything(&read))))
}

/// Adds everything in `pasted`: objects after the ones that they are copies of, everything else at the end of its
/// list. Color packs that the scene already has are reused for objects and lights; others are added under a free
/// name. Returns the new lights and objects, or the new color packs if nothing else is pasted.
pub fn paste(scene: &mut Scene, pasted: &Scene) -> Vec<Item> {
    let (lights, objects) = (scene.lights.len(), scene.objects.len());
    let first_pack = scene.color_packs.len();
    let are_only_packs = pasted.lights.is_empty() && pasted.objects.is_empty();
    let packs = paste_packs(scene, pasted, are_only_packs);
    if are_only_packs {
        return (first_pack..scene.color_packs.len())
            .map(Item::pack)
            .collect();
    }
    let to_scene_name = |name: &mut String| {
        if let Some(free) = packs.get(name) {
            name.clone_from(free);
        }
    };
    let offset = paste_offset(scene, pasted);
    // Names in this scene, by owner in the pasted one.
    let mut names = HashMap::new();
    let mut taken = Names::new(scene.objects.iter().map(|object| &*object.name));
    let groups = new_groups(scene, pasted);
    for object in &pasted.objects {
        let owner = Owner::Object(&object.name);
        let mut object = object.clone();
        to_scene_name(&mut object.color_pack);
        object.name = taken.take(&object.name);
        names.insert(owner, object.name.clone());
        object.shape = object.shape.moved(offset);
        if let Some(group) = groups.get(&object.group) {
            object.group.clone_from(group);
        }
        scene.objects.push(object);
    }
    let mut taken = Names::new(scene.lights.iter().map(|light| &*light.name));
    for light in &pasted.lights {
        let owner = Owner::Light(&light.name);
        let mut light = light.clone();
        light.position += offset;
        if let Some(marker) = &mut light.marker {
            to_scene_name(&mut marker.color_pack);
        }
        light.name = taken.take(&light.name);
        names.insert(owner, light.name.clone());
        scene.lights.push(light);
    }
    let tracks = pasted.animation.tracks.iter().filter_map(|track| {
        let name = names.get(&track.target.owner()?)?;
        Some(track.for_copy(name, offset))
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

/// Adds the pasted color packs that the scene does not have yet, or copies of all if `are_copies`; returns their
/// names in the scene by their pasted names. An equal pack is also reused if only its number differs: else every
/// paste would add another one.
fn paste_packs(scene: &mut Scene, pasted: &Scene, are_copies: bool) -> IndexMap<String, String> {
    let mut taken = Names::new(scene.color_packs.keys().map(String::as_str));
    let mut names = IndexMap::new();
    for (name, pack) in pasted.color_packs.iter() {
        let existing = scene.pack_like(name, pack).filter(|_| !are_copies);
        let existing = existing.map(str::to_owned);
        let name_in_scene = existing.unwrap_or_else(|| {
            let free = taken.take(name);
            scene.packs_mut().insert(free.clone(), pack.clone());
            free
        });
        names.insert(name.clone(), name_in_scene);
    }
    names
}

/// Returns the arrangement that moves the `new` objects from the end of the list to behind their originals (the
/// objects of the same names as the pasted ones) or behind their group, but not between the members of another group.
/// `None` if the scene has neither.
fn behind_originals(scene: &Scene, pasted: &Scene, new: Range<usize>) -> Option<Arrangement> {
    let names = pasted.objects.iter().map(|object| &*object.name);
    let names: HashSet<&str> = names.collect();
    let group = |index: usize| scene.objects[index].group.as_str();
    let own_group = group(new.clone().next()?);
    let last_of_group =
        |name: &str| (0..new.start).rfind(|index| !name.is_empty() && group(*index) == name);
    let original = (0..new.start).rfind(|index| names.contains(&*scene.objects[*index].name));
    let neighbor = original.or_else(|| last_of_group(own_group))?;
    let is_of_group = new.clone().all(|index| group(index) == group(neighbor));
    let group_end = last_of_group(group(neighbor)).filter(|_| !is_of_group);
    Some(Arrangement {
        objects: new.collect(),
        anchor: group_end.unwrap_or(neighbor),
        is_after: true,
        group: None,
    })
}

/// Returns new names, by old name, for pasted groups that become groups of their own: a whole group pasted once more,
/// or another group of the same name. A part of a group joins that group, and so does a single object in any case: it
/// may have been cut from there.
fn new_groups(scene: &Scene, pasted: &Scene) -> HashMap<String, String> {
    let scene_groups = members(scene);
    let mut taken = Names::new(scene_groups.keys().copied());
    let mut new = HashMap::new();
    for (group, pasted_members) in members(pasted) {
        let Some(scene_members) = scene_groups.get(group) else {
            continue;
        };
        let is_part =
            pasted_members.is_subset(scene_members) && pasted_members.len() < scene_members.len();
        if pasted_members.len() > 1 && !is_part {
            new.insert(group.to_owned(), taken.take(group));
        }
    }
    new
}

/// The groups of a scene, each with the names of its members.
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

/// Returns the offset from the originals to a free place: two things in one place would shadow each other. All pasted
/// things are offset alike.
fn paste_offset(scene: &Scene, pasted: &Scene) -> DVec3 {
    let step = match (pasted.objects.first(), pasted.objects_bounds()) {
        (None, _) => {
            let first = pasted.lights.first();
            first.map_or(DVec3::ZERO, |light| light_copy_step(scene, light))
        }
        // The copy of a row goes in front of it: at its end it might be outside the picture.
        (_, Some((low, high))) => {
            let size = high - low;
            let is_row = pasted.objects.len() > 1
                && size.x * MIN_ROW_DEPTH_SHARE < size.z
                && size.z < size.x;
            if is_row {
                DVec3::Z * size.z
            } else {
                DVec3::X * size.max_element()
            }
        }
        (Some(first), None) => shape_copy_step(scene, &first.shape),
    };
    let new: Vec<Spot> = Spot::all_of(pasted).collect();
    offset_to_free_place(scene, &new, (step, 0))
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
            let offset = paste_offset(&scene, &part);
            assert_eq!(offset.z > 0.0, along_z, "{offset}");
            assert_eq!(offset.x > 0.0, !along_z, "{offset}");
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
