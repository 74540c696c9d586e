//! Entries of the scene's lists.

use crate::scene::Scene;

/// A list of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ItemKind {
    /// [`Scene::lights`].
    Light,
    /// [`Scene::objects`].
    Object,
    /// [`Scene::color_packs`].
    Pack,
}

impl ItemKind {
    /// The number of items of this kind in the scene.
    pub fn count(self, scene: &Scene) -> usize {
        match self {
            Self::Light => scene.lights.len(),
            Self::Object => scene.objects.len(),
            Self::Pack => scene.color_packs.len(),
        }
    }
}

/// One entry of a list of the scene, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Item {
    /// The list.
    pub kind: ItemKind,
    /// Index in the list.
    pub index: usize,
}

impl Item {
    /// The object at this index.
    pub const fn object(index: usize) -> Self {
        Self {
            kind: ItemKind::Object,
            index,
        }
    }

    /// The light at this index.
    pub const fn light(index: usize) -> Self {
        Self {
            kind: ItemKind::Light,
            index,
        }
    }

    /// The color pack at this index.
    pub const fn pack(index: usize) -> Self {
        Self {
            kind: ItemKind::Pack,
            index,
        }
    }

    /// All lights and objects of a scene.
    pub fn everything(scene: &Scene) -> impl Iterator<Item = Self> + use<> {
        let lights = (0..scene.lights.len()).map(Self::light);
        lights.chain((0..scene.objects.len()).map(Self::object))
    }

    /// All lights whose marker uses a color pack, and all objects that use it.
    pub fn users_of_pack<'a>(scene: &'a Scene, pack: &'a str) -> impl Iterator<Item = Self> + 'a {
        let lights = scene.lights.iter().enumerate().filter(move |(_, light)| {
            let marker = light.marker.as_ref();
            marker.is_some_and(|marker| marker.color_pack == pack)
        });
        let objects = scene.objects.iter().enumerate();
        let objects = objects.filter(move |(_, object)| object.color_pack == pack);
        let lights = lights.map(|(index, _)| Self::light(index));
        lights.chain(objects.map(|(index, _)| Self::object(index)))
    }

    /// The name of the color pack of an object or of a light's marker; for a color pack, its own name.
    pub fn color_pack(self, scene: &Scene) -> Option<&str> {
        match self.kind {
            ItemKind::Light => Some(&scene.lights.get(self.index)?.marker.as_ref()?.color_pack),
            ItemKind::Object => Some(&scene.objects.get(self.index)?.color_pack),
            ItemKind::Pack => self.name(scene),
        }
    }

    /// The group that an object is in, if any.
    pub fn group(self, scene: &Scene) -> Option<&str> {
        let object = scene.objects.get(self.index);
        let group = &object.filter(|_| self.kind == ItemKind::Object)?.group;
        (!group.is_empty()).then_some(group)
    }

    /// Whether a light shines or an object is visible; `None` for color packs, and if there is no such item.
    pub fn is_visible(self, scene: &Scene) -> Option<bool> {
        match self.kind {
            ItemKind::Light => scene.lights.get(self.index).map(|light| light.visible),
            ItemKind::Object => scene.objects.get(self.index).map(|object| object.visible),
            ItemKind::Pack => None,
        }
    }

    /// The name of the item, if the scene has it.
    pub fn name(self, scene: &Scene) -> Option<&str> {
        Some(match self.kind {
            ItemKind::Light => &scene.lights.get(self.index)?.name,
            ItemKind::Object => &scene.objects.get(self.index)?.name,
            ItemKind::Pack => scene.color_packs.get_index(self.index)?.0,
        })
    }
}
