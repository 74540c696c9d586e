//! New things in a scene.

use glam::DVec3;

use super::item::Item;
use super::names::{free_light_name, free_object_name, free_pack_name};
use crate::scene::{ColorPack, Light, LightObj, Object, Scene, Shape, light_pack};

/// Colours that new things wear, one after the other: told apart from each other, and from a grey floor.
const COLORS: [[f64; 3]; 8] = [
    [226.0, 102.0, 82.0],
    [86.0, 142.0, 214.0],
    [240.0, 196.0, 92.0],
    [110.0, 176.0, 110.0],
    [160.0, 120.0, 204.0],
    [84.0, 184.0, 180.0],
    [238.0, 150.0, 84.0],
    [214.0, 200.0, 184.0],
];
/// The colour of floors.
const FLOOR: [f64; 3] = [196.0, 192.0, 186.0];
/// How large the marker of the first light is, as a share of the scene.
const MARKER_SHARE: f64 = 0.02;

/// Adds an object of this name, or one like it. It wears a pack of its own, or one that nothing wears: its colour is
/// changed without that of others.
pub fn add_object(scene: &mut Scene, name: &str, shape: Shape) -> Item {
    let name = free_object_name(scene, &format!("{name} 1"));
    let color_pack = free_pack(scene).unwrap_or_else(|| {
        let [red, green, blue] = match shape {
            Shape::Plane(_) => FLOOR,
            _ => COLORS[scene.color_packs.len() % COLORS.len()],
        };
        let color = DVec3::new(red, green, blue);
        let pack = ColorPack {
            ambient: color,
            diffuse: color,
            ..ColorPack::default()
        };
        insert_pack(scene, &name.to_lowercase(), pack).1
    });
    scene.objects.push(Object::new(name, color_pack, shape));
    Item::object(scene.objects.len() - 1)
}

/// Adds a light with a marker like those of the others.
pub fn add_light(scene: &mut Scene, position: DVec3) -> Item {
    let name = free_light_name(scene, "Light 1");
    let mut lights = scene.lights.iter();
    let like_others = lights.find_map(|light| Some(light.marker.as_ref()?.radius));
    let of_scene = || {
        let (low, high) = scene.objects_bounds()?;
        Some((high - low).length() * MARKER_SHARE).filter(|radius| *radius > 0.0)
    };
    let radius = like_others.or_else(of_scene);
    let radius = radius.unwrap_or(LightObj::default().radius);
    let color_pack = if scene.color_packs.contains_key("light") {
        "light".to_owned()
    } else {
        insert_pack(scene, "light", light_pack()).1
    };
    scene.lights.push(Light {
        name,
        position,
        intensity: 0.2,
        marker: Some(LightObj { radius, color_pack }),
        visible: true,
    });
    Item::light(scene.lights.len() - 1)
}

/// Adds a pack.
pub fn add_pack(scene: &mut Scene) -> Item {
    Item::pack(insert_pack(scene, "pack 1", ColorPack::default()).0)
}

/// A pack that nothing wears; not the one that is kept for lights.
fn free_pack(scene: &Scene) -> Option<String> {
    let worn = scene.worn_packs();
    let mut names = scene.color_packs.keys();
    let is_free = |name: &&String| *name != "light" && !worn.contains(name.as_str());
    names.find(is_free).cloned()
}

/// Puts a pack behind the others, under this name or one like it: its place and its name.
fn insert_pack(scene: &mut Scene, name: &str, pack: ColorPack) -> (usize, String) {
    let name = free_pack_name(scene, name);
    let (index, _) = scene.packs_mut().insert_full(name.clone(), pack);
    (index, name)
}
