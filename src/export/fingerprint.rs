//! What tells whether a frame that is there shows what it shall.

use std::collections::HashSet;
use std::sync::Arc;

use indexmap::IndexMap;

use super::error::ExportError;
use super::manifest::Hash;
use crate::image::Format;
use crate::scene::{Packs, Scene};

/// A hash of everything that decides a frame's bytes: what is seen in it, how it is traced, the format and the version
/// of the program.
///
/// # Errors
/// [`ExportError::Unwritable`], for a scene that has no text.
pub fn fingerprint(shown: &Scene, format: Format) -> Result<Hash, ExportError> {
    let text = ron::to_string(&bare(shown))?;
    let mut hasher = blake3::Hasher::new();
    hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
    hasher.update(format.ending().as_bytes());
    hasher.update(text.as_bytes());
    Ok(hasher.finalize())
}

/// The same picture, whatever its things are called, and without those that are not in it.
fn bare(shown: &Scene) -> Scene {
    let mut bare = Scene {
        animation: Arc::default(),
        bookmarks: Vec::new(),
        ..shown.abridged()
    };
    bare.objects.retain(|object| object.visible);
    bare.lights.retain(|light| light.visible);
    for index in 0..bare.objects.len() {
        let object = &mut bare.objects[index];
        (object.name, object.group) = (String::new(), String::new());
    }
    for index in 0..bare.lights.len() {
        bare.lights[index].name.clear();
    }
    number_packs(&mut bare);
    bare
}

/// Numbers in place of the names of the packs that are worn; the others go.
fn number_packs(scene: &mut Scene) {
    let worn: HashSet<String> = scene.worn_packs().into_iter().map(str::to_owned).collect();
    scene.packs_mut().retain(|name, _| worn.contains(name));
    let numbers = (0..scene.color_packs.len()).map(|number| number.to_string());
    let packs: IndexMap<_, _> = numbers.zip(scene.color_packs.values().cloned()).collect();
    let named = std::mem::replace(&mut scene.color_packs, Packs::from(packs));
    let numbered = scene.color_packs.clone();
    scene.wear_instead(|name| {
        let (number, _) = numbered.get_index(named.get_index_of(name)?)?;
        Some(number)
    });
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::scene::{ColorPack, Object, Sphere};

    #[test]
    fn what_is_not_seen_decides_nothing_and_what_is_does() {
        let print = |change: &dyn Fn(&mut Scene)| {
            let mut scene = Scene::demo();
            change(&mut scene);
            fingerprint(&scene, Format::Png).expect("it has a text")
        };
        let same = print(&|_| {});
        let hidden = |scene: &mut Scene| {
            let center = DVec3::new(100.0, 50.0, -100.0);
            let mut ball = Object::new(
                "Ball",
                "ball",
                Sphere {
                    center,
                    radius: 9.0,
                },
            );
            ball.visible = false;
            scene.objects.insert(0, ball);
            scene
                .packs_mut()
                .shift_insert(0, "ball".to_owned(), ColorPack::default());
        };
        let unseen: [&dyn Fn(&mut Scene); 4] = [
            &|scene| scene.objects[0].name = "Planet".to_owned(),
            &|scene| scene.objects[3].group = "pyramid".to_owned(),
            &hidden,
            &|scene| {
                let packs = scene.packs_mut();
                let pack = packs.shift_remove("plane").expect("it is there");
                packs.shift_insert(3, "floor".to_owned(), pack);
                scene.wear_instead(|name| (name == "plane").then_some("floor"));
            },
        ];
        for (number, change) in unseen.iter().enumerate() {
            assert_eq!(print(change), same, "{number}");
        }
        let seen: [&dyn Fn(&mut Scene); 5] = [
            &|scene| {
                hidden(scene);
                scene.objects[0].visible = true;
            },
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
