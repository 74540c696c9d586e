//! Which color packs are used, and replacing some of them by others.

use std::collections::{HashMap, HashSet};

use super::material::ColorPack;
use super::names::without_number;
use super::whole::Scene;

impl Scene {
    /// Returns the names of the color packs that objects and markers use.
    pub fn used_packs(&self) -> HashSet<&str> {
        let markers = self.lights.iter().filter_map(|light| light.marker.as_ref());
        let markers = markers.map(|marker| marker.color_pack.as_str());
        let objects = self.objects.iter().map(|object| object.color_pack.as_str());
        objects.chain(markers).collect()
    }

    /// Yields the color packs that objects and markers use, with their names, in the order of the scene.
    pub fn packs_in_use(&self) -> impl Iterator<Item = (&String, &ColorPack)> {
        let used = self.used_packs();
        let packs = self.color_packs.iter();
        packs.filter(move |(name, _)| used.contains(name.as_str()))
    }

    /// Replaces the color pack of every object and marker for which `replacement` returns a name.
    pub fn replace_packs<'a>(&mut self, replacement: impl Fn(&str) -> Option<&'a str>) {
        // Element by element: unchanged elements stay shared with earlier undo states.
        for index in 0..self.objects.len() {
            if let Some(name) = replacement(&self.objects[index].color_pack) {
                name.clone_into(&mut self.objects[index].color_pack);
            }
        }
        for index in 0..self.lights.len() {
            let marker = self.lights[index].marker.as_ref();
            let name = marker.and_then(|marker| replacement(&marker.color_pack));
            if let Some(name) = name
                && let Some(marker) = &mut self.lights[index].marker
            {
                name.clone_into(&mut marker.color_pack);
            }
        }
    }

    /// Returns the name of a pack that is equal to `pack` and is called `name` or, if there is none, has a name that
    /// differs from it by a number alone.
    pub fn pack_like(&self, name: &str, pack: &ColorPack) -> Option<&str> {
        let exact = self.color_packs.get_key_value(name);
        let exact = exact.filter(|(_, existing)| *existing == pack);
        let is_alike = |(other, existing): &(&String, &ColorPack)| {
            *existing == pack && without_number(other) == without_number(name)
        };
        let found = exact.or_else(|| self.color_packs.iter().find(is_alike));
        found.map(|(name, _)| &**name)
    }

    /// Returns whether two objects look the same where their surfaces coincide. Smooth meshes never do, because
    /// their shading normals vary.
    pub fn look_alike(&self, one: usize, other: usize) -> bool {
        let (one, other) = (&self.objects[one], &self.objects[other]);
        one.color_pack == other.color_pack && !one.is_smooth() && !other.is_smooth()
    }

    /// Returns whether any two color packs are equal.
    pub fn has_equal_packs(&self) -> bool {
        let mut keys = HashSet::new();
        !self
            .color_packs
            .values()
            .all(|pack| keys.insert(pack.key()))
    }

    /// Removes every color pack that is equal to an earlier one, which replaces it.
    pub fn merge_equal_packs(&mut self) {
        let mut first_names = HashMap::new();
        let mut replacements = HashMap::new();
        for (name, pack) in self.color_packs.iter() {
            let first = *first_names.entry(pack.key()).or_insert(name);
            if first != name {
                replacements.insert(name.clone(), first.clone());
            }
        }
        if replacements.is_empty() {
            return;
        }
        self.packs_mut()
            .retain(|name, _| !replacements.contains_key(name));
        self.replace_packs(|name| replacements.get(name).map(String::as_str));
    }
}
