//! What a new thing is called, and where it stands.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use crate::scene::{Scene, Shape};

/// `wanted`, or the first of `BASE 1`, `BASE 2`, … that is not taken, where BASE is `wanted`
/// without its number.
fn free_name(wanted: &str, is_taken: impl Fn(&str) -> bool) -> String {
    if !is_taken(wanted) {
        return wanted.to_owned();
    }
    let base = base(wanted);
    let mut numbered = (1_u64..).map(|number| format!("{base} {number}"));
    numbered.find(|name| !is_taken(name)).unwrap_or_default()
}

/// A name without its number.
fn base(name: &str) -> &str {
    let base = name
        .trim_end_matches(|c: char| c.is_ascii_digit())
        .trim_end();
    if base.is_empty() { name } else { base }
}

/// A name for an object that no other has, like the one that is wanted.
pub fn free_object_name(scene: &Scene, wanted: &str) -> String {
    free_name(wanted, |name| {
        scene.objects.iter().any(|object| object.name == name)
    })
}

/// A name for a light that no other has, like the one that is wanted.
pub fn free_light_name(scene: &Scene, wanted: &str) -> String {
    free_name(wanted, |name| {
        scene.lights.iter().any(|light| light.name == name)
    })
}

/// A name for a pack that no other has, like the one that is wanted.
pub fn free_pack_name(scene: &Scene, wanted: &str) -> String {
    free_name(wanted, |name| scene.color_packs.contains_key(name))
}

/// A name for a group that no other has, like the one that is wanted.
pub fn free_group_name(scene: &Scene, wanted: &str) -> String {
    free_name(wanted, |name| {
        scene.objects.iter().any(|object| object.group == name)
    })
}

/// A name that no bookmark has.
pub fn free_bookmark_name(scene: &Scene) -> String {
    free_name("View 1", |name| {
        scene.bookmarks.iter().any(|bookmark| bookmark.name == name)
    })
}

/// Names that are taken, for many new things at once.
#[derive(Debug)]
pub struct Taken {
    names: HashSet<String>,
    /// For names without their numbers the number to go on with.
    next: HashMap<String, u64>,
}

impl Taken {
    /// These are taken.
    pub fn new<'a>(names: impl Iterator<Item = &'a String>) -> Self {
        Self {
            names: names.cloned().collect(),
            next: HashMap::new(),
        }
    }

    /// The name that is wanted, or one like it that is free; it is then taken.
    pub fn take(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_owned();
        if self.names.contains(wanted) {
            let base = base(wanted);
            let next = self.next.entry(base.to_owned()).or_insert(1);
            while self.names.contains(&name) {
                name = format!("{base} {next}");
                *next += 1;
            }
        }
        self.names.insert(name.clone());
        name
    }
}

/// From a shape to where its copy stands: two things in one place would shadow each other.
pub fn copy_offset(scene: &Scene, shape: &Shape) -> DVec3 {
    if let Some((low, high)) = shape.bounds() {
        return DVec3::new((high - low).abs().max_element(), 0.0, 0.0);
    }
    let normal = shape
        .endless_plane()
        .and_then(|(_, normal)| normal.try_normalize());
    let extent = scene
        .bounds()
        .map_or(1.0, |(low, high)| (high - low).length());
    normal.map_or(DVec3::ZERO, |normal| normal * (extent / 20.0))
}
