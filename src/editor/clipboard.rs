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
    let owners = Owners::of(part, scene.animation.targets());
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
        "Scene(version: 1, color_packs: {{{packs}}}, objects: [\n{objects}\n], lights: [\n{lights}\n])"
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
    let (scene_groups, pasted_groups) = (members(scene), members(pasted));
    // The other pasted groups keep their names if they can.
    let mut taken = Names::new(scene_groups.keys().chain(pasted_groups.keys()).copied());
    let mut new = HashMap::new();
    for (group, pasted_members) in pasted_groups {
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
/// things are offset alike, bounded objects if possible so that their middle is in the picture.
fn paste_offset(scene: &Scene, pasted: &Scene) -> DVec3 {
    let new: Vec<Spot> = Spot::all_of(pasted).collect();
    let offset = |step: DVec3| offset_to_free_place(scene, &new, (step, 0));
    let (low, high) = match (pasted.objects.first(), pasted.objects_bounds()) {
        (None, _) => {
            let first = pasted.lights.first();
            return offset(first.map_or(DVec3::ZERO, |light| light_copy_step(scene, light)));
        }
        (Some(first), None) => return offset(shape_copy_step(scene, &first.shape)),
        (_, Some(bounds)) => bounds,
    };
    let size = high - low;
    let is_row =
        pasted.objects.len() > 1 && size.x * MIN_ROW_DEPTH_SHARE < size.z && size.z < size.x;
    let beside = DVec3::X * size.max_element();
    // The copy of a row goes in front of it: at its end it might be outside the picture.
    let first = if is_row { DVec3::Z * size.z } else { beside };
    let steps = [first, beside, -beside, DVec3::NEG_Z * size.z.max(size.x)];
    let middle = low.midpoint(high);
    let mut offsets = steps.into_iter().map(offset);
    let seen = offsets.find(|offset| is_in_picture(scene, middle + offset));
    seen.unwrap_or_else(|| offset(first))
}

/// Returns whether a point is in the picture, hidden or not.
fn is_in_picture(scene: &Scene, point: DVec3) -> bool {
    let framing = scene.camera.framing();
    let place = framing.and_then(|framing| framing.project(point));
    place.is_some_and(|[x, y]| x.abs() < scene.render.aspect_ratio() / 2.0 && y.abs() < 0.5)
}

#[cfg(test)]
mod tests;
