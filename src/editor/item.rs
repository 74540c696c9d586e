//! Entries of the scene's lists.

use crate::scene::Scene;

/// A list of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// [`Scene::lights`].
    Light,
    /// [`Scene::objects`].
    Object,
    /// [`Scene::color_packs`].
    Pack,
}

/// One entry of a list of the scene, by its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Item {
    /// Which list.
    pub kind: Kind,
    /// Place in the list, from 0.
    pub index: usize,
}

impl Item {
    /// The object in this place.
    pub const fn object(index: usize) -> Self {
        Self {
            kind: Kind::Object,
            index,
        }
    }

    /// The light in this place.
    pub const fn light(index: usize) -> Self {
        Self {
            kind: Kind::Light,
            index,
        }
    }

    /// The pack in this place.
    pub const fn pack(index: usize) -> Self {
        Self {
            kind: Kind::Pack,
            index,
        }
    }

    /// Its name, if the scene has it.
    pub fn name(self, scene: &Scene) -> Option<&str> {
        match self.kind {
            Kind::Light => scene
                .lights
                .get(self.index)
                .map(|light| light.name.as_str()),
            Kind::Object => scene
                .objects
                .get(self.index)
                .map(|object| object.name.as_str()),
            Kind::Pack => scene
                .color_packs
                .get_index(self.index)
                .map(|(name, _)| name.as_str()),
        }
    }
}
