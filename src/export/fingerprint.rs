//! Fingerprints that tell whether an existing frame is up to date.

use std::collections::HashMap;
use std::sync::Arc;

use indexmap::IndexMap;

use super::error::ExportError;
use super::manifest::Hash;
use crate::image::Format;
use crate::scene::{Packs, Scene};

/// Changes when pictures do, also between two versions of the program.
const PICTURES: &[u8] = include_bytes!("../../tests/it/picture_hashes.txt");

/// Returns a hash of everything that determines the bytes of a frame: what is visible in it, how it is traced, the
/// format and the version of the program.
///
/// # Errors
/// [`ExportError::Unwritable`], for a scene that cannot be serialized.
pub fn fingerprint(shown: &Scene, format: Format) -> Result<Hash, ExportError> {
    let text = ron::to_string(&stripped(shown))?;
    let mut hasher = blake3::Hasher::new();
    hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
    hasher.update(PICTURES);
    hasher.update(format.ending().as_bytes());
    hasher.update(text.as_bytes());
    Ok(hasher.finalize())
}

/// Returns the scene without names and without what no frame shows. Hidden things stay: the number of things in a
/// scene may determine how it is traced.
fn stripped(shown: &Scene) -> Scene {
    let mut stripped = Scene {
        animation: Arc::default(),
        bookmarks: Vec::new(),
        ..shown.abridged()
    };
    for object in stripped.objects.iter_mut() {
        (object.name, object.group) = (String::new(), String::new());
    }
    for light in stripped.lights.iter_mut() {
        light.name.clear();
    }
    number_packs(&mut stripped);
    stripped
}

/// Replaces the names of color packs in use by numbers, and drops unused ones.
fn number_packs(scene: &mut Scene) {
    let (mut numbers, mut numbered) = (HashMap::new(), IndexMap::new());
    for (number, (name, pack)) in scene.packs_in_use().enumerate() {
        numbers.insert(name.clone(), number.to_string());
        numbered.insert(number.to_string(), pack.clone());
    }
    scene.color_packs = Packs::from(numbered);
    scene.replace_packs(|name| numbers.get(name).map(String::as_str));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ColorPack;

    #[test]
    fn names_and_unworn_packs_decide_nothing_and_what_is_seen_does() {
        let print = |change: &dyn Fn(&mut Scene)| {
            let mut scene = Scene::demo();
            change(&mut scene);
            fingerprint(&scene, Format::Png).expect("it has a text")
        };
        let same = print(&|_| {});
        let unseen: [&dyn Fn(&mut Scene); 4] = [
            &|scene| scene.objects[0].name = "Planet".to_owned(),
            &|scene| scene.objects[3].group = "pyramid".to_owned(),
            &|scene| {
                let packs = scene.packs_mut();
                packs.shift_insert(0, "ball".to_owned(), ColorPack::default());
            },
            &|scene| {
                let packs = scene.packs_mut();
                let pack = packs.shift_remove("plane").expect("it is there");
                packs.shift_insert(3, "floor".to_owned(), pack);
                scene.replace_packs(|name| (name == "plane").then_some("floor"));
            },
        ];
        for (number, change) in unseen.iter().enumerate() {
            assert_eq!(print(change), same, "{number}");
        }
        let seen: [&dyn Fn(&mut Scene); 4] = [
            &|scene| scene.objects[0].color_pack = "sphere 2".to_owned(),
            &|scene| scene.lights[0].visible = false,
            &|scene| scene.packs_mut()["plane"].reflective = false,
            &|scene| scene.camera.position.x += 1e-9,
        ];
        for (number, change) in seen.iter().enumerate() {
            assert_ne!(print(change), same, "{number}");
        }
    }
}
