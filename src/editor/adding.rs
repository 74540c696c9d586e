//! Adding and duplicating objects, lights and color packs.

use std::collections::HashMap;

use glam::DVec3;
use indexmap::IndexMap;

use super::item::{Item, ItemKind};
use super::names::{
    Spot, copy_offset, free_light_name, free_object_name, free_pack_name, offset_to_free_place,
};
use crate::scene::{
    ColorPack, Light, LightObj, Names, Object, Owner, Packs, Scene, Shape, Track,
    default_intensity, light_pack,
};

/// Colours of new objects, used in turn: easy to tell from each other and from a grey floor.
const COLORS: [DVec3; 8] = [
    DVec3::new(226.0, 102.0, 82.0),
    DVec3::new(86.0, 142.0, 214.0),
    DVec3::new(240.0, 196.0, 92.0),
    DVec3::new(110.0, 176.0, 110.0),
    DVec3::new(160.0, 120.0, 204.0),
    DVec3::new(84.0, 184.0, 180.0),
    DVec3::new(238.0, 150.0, 84.0),
    DVec3::new(214.0, 200.0, 184.0),
];
/// The colour of floors.
const FLOOR_COLOR: DVec3 = DVec3::new(196.0, 192.0, 186.0);
/// Radius of the first light's marker, as a share of the diagonal of the objects' bounding box.
const MARKER_SHARE: f64 = 0.02;

/// Adds an object of this name, with a number. It gets a color pack of its own: a new one, or an unused one that was
/// never edited.
pub fn add_object(scene: &mut Scene, name: &str, shape: Shape) -> Item {
    let name = free_object_name(scene, &format!("{name} 1"));
    let colors = match shape {
        Shape::Plane(_) => &[FLOOR_COLOR][..],
        _ => &COLORS,
    };
    let color = rarest(scene, colors);
    let color_pack = free_pack(scene, colors)
        .unwrap_or_else(|| insert_pack(scene, &name.to_lowercase(), ColorPack::of_color(color)).1);
    if let Some(pack) = scene.packs_mut().get_mut(&color_pack)
        && *pack == ColorPack::default()
    {
        *pack = ColorPack::of_color(color);
    }
    scene.objects.push(Object::new(name, color_pack, shape));
    Item::object(scene.objects.len() - 1)
}

/// Adds a light with a marker like those of the other lights.
pub fn add_light(scene: &mut Scene, position: DVec3) -> Item {
    let name = free_light_name(scene, "Light 1");
    let radius = marker_radius(scene);
    let color_pack = if scene.color_packs.contains_key("light") {
        "light".to_owned()
    } else {
        insert_pack(scene, "light", light_pack()).1
    };
    let mut light = Light {
        name,
        position,
        intensity: default_intensity(),
        marker: Some(LightObj { radius, color_pack }),
        visible: true,
    };
    // Two lights in one place would look like one.
    let step = light_copy_step(scene, &light);
    light.position += offset_to_free_place(scene, &[Spot::light(position)], (step, 0));
    scene.lights.push(light);
    Item::light(scene.lights.len() - 1)
}

/// Returns the offset from a light to a copy beside it. Far from the origin, the radius of a marker may be below
/// rounding precision, hence the lower bound.
pub fn light_copy_step(scene: &Scene, light: &Light) -> DVec3 {
    let marker = light.marker.as_ref();
    let radius = marker.map_or_else(|| marker_radius(scene), |marker| marker.radius);
    DVec3::X * (4.0 * radius).max(light.position.x.abs() * 1e-9)
}

/// Returns the marker radius for a light that has no marker yet: that of another light's marker, or else in
/// proportion to the size of the scene.
pub fn marker_radius(scene: &Scene) -> f64 {
    let mut lights = scene.lights.iter();
    let of_another_light = lights.find_map(|light| Some(light.marker.as_ref()?.radius));
    let in_proportion = || {
        let (low, high) = scene.objects_bounds()?;
        Some((high - low).length() * MARKER_SHARE).filter(|radius| *radius > 0.0)
    };
    let radius = of_another_light.or_else(in_proportion);
    radius.unwrap_or(LightObj::default().radius)
}

/// Adds a color pack.
pub fn add_pack(scene: &mut Scene) -> Item {
    Item::pack(insert_pack(scene, "pack 1", ColorPack::default()).0)
}

/// Inserts a copy of an item after the original in its list; the copy of a light or object is placed beside the
/// original.
pub fn duplicate(scene: &mut Scene, item: Item) -> Option<Item> {
    let Item { kind, index } = item;
    match kind {
        ItemKind::Object => {
            let original = scene.objects.get(index)?.clone();
            let mut copy = original.clone();
            copy.name = free_object_name(scene, &copy.name);
            let offset = copy_offset(scene, &copy.shape);
            copy.shape = copy.shape.moved(offset);
            copy_tracks(scene, Owner::Object(&original.name), &copy.name, offset);
            scene.objects.insert(index + 1, copy);
        }
        ItemKind::Light => {
            let original = scene.lights.get(index)?.clone();
            let mut copy = original.clone();
            copy.name = free_light_name(scene, &copy.name);
            let step = light_copy_step(scene, &copy);
            let offset = offset_to_free_place(scene, &[Spot::light(copy.position)], (step, 1));
            copy.position += offset;
            copy_tracks(scene, Owner::Light(&original.name), &copy.name, offset);
            scene.lights.insert(index + 1, copy);
        }
        ItemKind::Pack => {
            let (name, pack) = scene.color_packs.get_index(index)?;
            let (name, pack) = (free_pack_name(scene, name), pack.clone());
            scene.packs_mut().shift_insert(index + 1, name, pack);
        }
    }
    Some(Item {
        kind,
        index: index + 1,
    })
}

/// Copies the animation tracks of a light or object to its copy, which is offset by `offset`.
fn copy_tracks(scene: &mut Scene, owner: Owner, copy: &str, offset: DVec3) {
    let tracks = scene.animation.tracks.iter();
    let originals = tracks.filter(|track| track.target.owner() == Some(owner));
    let copies: Vec<Track> = originals
        .map(|track| track.for_copy(copy, offset))
        .collect();
    if !copies.is_empty() {
        scene.animation_mut().tracks.extend(copies);
    }
}

/// Gives each of the objects at these indices its own copy of its color pack, unless it is the only one that uses it.
pub fn make_packs_unique(scene: &mut Scene, objects: &[usize]) {
    let mut users: HashMap<String, usize> = HashMap::new();
    for item in Item::everything(scene) {
        if let Some(pack) = item.color_pack(scene) {
            *users.entry(pack.to_owned()).or_default() += 1;
        }
    }
    let mut names = Names::new(scene.color_packs.keys().map(String::as_str));
    let mut copies: HashMap<String, Vec<String>> = HashMap::new();
    for &index in objects {
        let Some(pack) = scene
            .objects
            .get(index)
            .map(|object| object.color_pack.clone())
        else {
            continue;
        };
        if let Some(others @ 2..) = users.get_mut(&pack) {
            *others -= 1;
            let copy = names.take(&pack);
            scene.objects[index].color_pack.clone_from(&copy);
            copies.entry(pack).or_default().push(copy);
        }
    }
    if copies.is_empty() {
        return;
    }
    let mut packs = IndexMap::new();
    for (name, pack) in scene.color_packs.iter() {
        packs.insert(name.clone(), pack.clone());
        let copies = copies.remove(name).unwrap_or_default();
        packs.extend(copies.into_iter().map(|copy| (copy, pack.clone())));
    }
    scene.color_packs = Packs::from(packs);
}

/// Returns the first of these colours that the fewest color packs have.
fn rarest(scene: &Scene, colors: &[DVec3]) -> DVec3 {
    let count = |color: &&DVec3| {
        let diffuse = ColorPack::of_color(**color).diffuse;
        let packs = scene.color_packs.values();
        packs.filter(|pack| pack.diffuse == diffuse).count()
    };
    colors.iter().min_by_key(count).copied().unwrap_or_default()
}

/// Returns the name of an unused color pack that nobody has edited: with a number in its name, and with the default
/// values, or with those of a new object's pack in one of these colours. Other unused ones are left alone: the user may
/// have made them for later.
fn free_pack(scene: &Scene, colors: &[DVec3]) -> Option<String> {
    let used = scene.used_packs();
    let new = colors.iter().copied().map(ColorPack::of_color);
    let new: Vec<ColorPack> = new.chain([ColorPack::default()]).collect();
    let mut packs = scene.color_packs.iter();
    let is_numbered = |name: &str| name.ends_with(|last: char| last.is_ascii_digit());
    let free = packs.find(|(name, pack)| {
        is_numbered(name) && !used.contains(name.as_str()) && new.contains(pack)
    });
    free.map(|(name, _)| name.clone())
}

/// Appends a color pack under this name, with a new number if it is taken; returns its index and its name.
fn insert_pack(scene: &mut Scene, name: &str, pack: ColorPack) -> (usize, String) {
    let name = free_pack_name(scene, name);
    let (index, _) = scene.packs_mut().insert_full(name.clone(), pack);
    (index, name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Sphere;

    fn pack_of<'a>(scene: &'a Scene, name: &str) -> &'a ColorPack {
        scene.color_packs.get(name).expect("there is one")
    }

    #[test]
    fn new_objects_have_different_colours_and_packs_with_names_of_their_own_stay() {
        let mut scene = Scene::empty();
        let gold = insert_pack(&mut scene, "gold", ColorPack::default()).1;
        let ball = Sphere {
            center: DVec3::ZERO,
            radius: 1.0,
        };
        let mut colors: Vec<DVec3> = Vec::new();
        for _ in 0..COLORS.len() {
            add_object(&mut scene, "Sphere", ball.into());
            let added = scene.objects.last().expect("it was added");
            assert_ne!(added.color_pack, gold);
            let color = pack_of(&scene, &added.color_pack).diffuse;
            assert!(!colors.contains(&color), "{color}");
            colors.push(color);
        }
        assert_eq!(*pack_of(&scene, &gold), ColorPack::default());
        assert!(scene.used_packs().contains("pack 1"), "nobody named it");
    }
}
