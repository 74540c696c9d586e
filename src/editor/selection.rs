//! The selection.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::item::{Item, ItemKind};
use crate::scene::{Keys, Object, Scene, Target};

/// The selected things, which the inspector shows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// The camera.
    #[default]
    Camera,
    /// Ambient intensity, background, light visualization.
    World,
    /// The size of the still picture, and how it is traced.
    Render,
    /// Items, at least one; the item selected last comes last.
    Items(Vec<Item>),
    /// Keys of the animation, at least one.
    Keys(Keys),
}

/// Result of [`Selection::keys`] if other things are selected.
static NO_KEYS: Keys = Keys::new();

impl From<Item> for Selection {
    fn from(item: Item) -> Self {
        Self::Items(vec![item])
    }
}

/// Selects the camera if there are no keys.
impl From<Keys> for Selection {
    fn from(keys: Keys) -> Self {
        if keys.is_empty() {
            Self::Camera
        } else {
            Self::Keys(keys)
        }
    }
}

impl Selection {
    /// The name of the selected group: all of its objects, at least two, and nothing else are selected.
    pub fn group<'a>(&self, scene: &'a Scene) -> Option<&'a str> {
        let are_several = self.items().len() > 1;
        are_several.then(|| self.whole_group(scene)).flatten()
    }

    /// Whether the selection is exactly one whole group, which may have a single member.
    pub fn is_group(&self, scene: &Scene) -> bool {
        self.whole_group(scene).is_some()
    }

    fn whole_group<'a>(&self, scene: &'a Scene) -> Option<&'a str> {
        let group = self.items().first()?.group(scene)?;
        let is_member = |item: &Item| item.group(scene) == Some(group);
        let members = scene.objects.iter().filter(|object| object.group == group);
        let is_whole = self.items().iter().all(is_member) && members.count() == self.items().len();
        is_whole.then_some(group)
    }

    /// Selects all objects of a group.
    pub fn of_group(scene: &Scene, group: &str) -> Self {
        let objects = scene.objects.iter().enumerate();
        let members = objects.filter(|(_, object)| object.group == group);
        Self::all(members.map(|(index, _)| Item::object(index)))
    }

    /// The selection after picking `items` in the picture: an object stands for its whole group, unless something in
    /// that group is selected already; then it stands for itself.
    #[must_use]
    pub fn picked(&self, scene: &Scene, items: &[Item]) -> Self {
        let group = |item: &Item| item.group(scene);
        let open: HashSet<&str> = self.items().iter().filter_map(group).collect();
        let closed = items.iter().filter_map(group);
        let closed: HashSet<&str> = closed.filter(|group| !open.contains(group)).collect();
        let stands_alone = |item: &&Item| group(item).is_none_or(|group| !closed.contains(group));
        let alone = items.iter().filter(stands_alone).copied();
        if closed.is_empty() {
            return Self::all(alone);
        }
        let objects = scene.objects.iter().enumerate();
        let members = objects.filter(|(_, object)| closed.contains(&*object.group));
        Self::all(alone.chain(members.map(|(index, _)| Item::object(index))))
    }

    /// The selection after toggling a thing of the picture: adds what [`Self::picked`] returns for it, or removes the
    /// thing if it was selected. If its whole group is selected along with other things, the whole group is removed.
    #[must_use]
    pub fn toggled_at(&self, scene: &Scene, item: Item) -> Self {
        let group = item.group(scene).map(|group| Self::of_group(scene, group));
        let is_proper_subset = |group: &Self| {
            let count = group.items().len();
            count < self.items().len() && self.has_all(group.items().iter().copied())
        };
        if let Some(group) = group.filter(is_proper_subset) {
            let members: HashSet<&Item> = group.items().iter().collect();
            return Self::all(
                self.items()
                    .iter()
                    .filter(|item| !members.contains(item))
                    .copied(),
            );
        }
        match self.picked(scene, &[item]).items() {
            [one] => self.toggled(*one),
            // A whole group is only picked if nothing of it was selected.
            all => Self::all(self.items().iter().chain(all).copied()),
        }
    }

    /// Selects these items, each of them once; the camera if there are none.
    pub fn all(items: impl IntoIterator<Item = Item>) -> Self {
        let mut all = Vec::new();
        let mut seen = HashSet::new();
        all.extend(items.into_iter().filter(|item| seen.insert(*item)));
        if all.is_empty() {
            Self::Camera
        } else {
            Self::Items(all)
        }
    }

    /// All selected items; the item selected last comes last.
    pub fn items(&self) -> &[Item] {
        match self {
            Self::Items(items) => items,
            _ => &[],
        }
    }

    /// The item selected last.
    pub fn item(&self) -> Option<Item> {
        self.items().last().copied()
    }

    /// All selected keys.
    pub fn keys(&self) -> &Keys {
        match self {
            Self::Keys(keys) => keys,
            _ => &NO_KEYS,
        }
    }

    /// The selected items of a kind; the item selected last comes last.
    pub fn of_kind(&self, kind: ItemKind) -> Vec<Item> {
        let of_this_kind = self.items().iter().filter(|item| item.kind == kind);
        of_this_kind.copied().collect()
    }

    /// Indices of the selected items of a kind, in ascending order.
    pub fn indices(&self, kind: ItemKind) -> Vec<usize> {
        let of_this_kind = self.of_kind(kind).into_iter();
        let mut indices: Vec<usize> = of_this_kind.map(|item| item.index).collect();
        indices.sort_unstable();
        indices
    }

    /// Whether the item is selected.
    pub fn has(&self, item: Item) -> bool {
        self.items().contains(&item)
    }

    /// Returns for each of `count` objects whether it is selected: faster than [`Self::has`] for many objects.
    pub fn object_marks(&self, count: usize) -> Vec<bool> {
        let mut marks = vec![false; count];
        for item in self.of_kind(ItemKind::Object) {
            if let Some(mark) = marks.get_mut(item.index) {
                *mark = true;
            }
        }
        marks
    }

    /// Whether all of these items are selected.
    pub fn has_all(&self, mut items: impl ExactSizeIterator<Item = Item>) -> bool {
        // The usual case: fewer items are selected.
        if self.items().len() < items.len() {
            return false;
        }
        let selected: HashSet<&Item> = self.items().iter().collect();
        items.all(|item| selected.contains(&item))
    }

    /// The mean position of all selected things that have one; `None` if there are none.
    pub fn middle(&self, scene: &Scene) -> Option<DVec3> {
        let middles = self.items().iter().filter_map(|item| match item.kind {
            ItemKind::Object => Some(scene.objects.get(item.index)?.shape.middle()),
            ItemKind::Light => Some(scene.lights.get(item.index)?.position),
            ItemKind::Pack => None,
        });
        let middles: Vec<DVec3> = middles.collect();
        (!middles.is_empty()).then(|| middles.iter().sum::<DVec3>() / middles.len() as f64)
    }

    /// The pivot about which the selected things that have a position are rotated together; a single object has its
    /// own.
    pub fn pivot(&self, scene: &Scene) -> Option<DVec3> {
        match self.only_placed() {
            Some(item) if item.kind == ItemKind::Object => {
                let Object { name, shape, .. } = scene.objects.get(item.index)?;
                let tracks = &scene.animation.tracks;
                let has = |target: Target| tracks.iter().any(|track| track.target == target);
                // Rotation keys turn a mesh about its position. About any other point, it would have to move as well,
                // which without keys of the position moves it at all times.
                let has_rotation_alone = has(Target::ObjectRotation(name.clone()))
                    && !has(Target::ObjectPosition(name.clone()));
                Some(if has_rotation_alone {
                    shape.position()
                } else {
                    shape.pivot()
                })
            }
            _ => self.middle(scene),
        }
    }

    /// The only selected item that has a position, if there is exactly one.
    pub fn only_placed(&self) -> Option<Item> {
        let mut placed = self
            .items()
            .iter()
            .filter(|item| item.kind != ItemKind::Pack);
        let first = placed.next().copied();
        first.filter(|_| placed.next().is_none())
    }

    /// The selection with `item` added, or removed if it was selected.
    #[must_use]
    pub fn toggled(&self, item: Item) -> Self {
        let others = self.items().iter().copied();
        let others = others.filter(|other| *other != item);
        let new = (!self.has(item)).then_some(item);
        Self::all(others.chain(new))
    }

    /// The selection without what is not in the scene. If any of several items is missing, only the last item is
    /// kept.
    #[must_use]
    pub fn within(self, scene: &Scene) -> Self {
        let exists = |item: &Item| item.name(scene).is_some();
        match self {
            Self::Items(items) if !items.iter().all(exists) => {
                Self::all(items.last().copied().filter(exists))
            }
            Self::Keys(mut keys) => {
                keys.retain(|place| scene.animation.time_and_pace_of(*place).is_some());
                keys.into()
            }
            other => other,
        }
    }

    /// The selection carried over to another state of the scene, by name; things that are missing there are dropped.
    /// If a name is gone, and the list has the same length, the thing is taken to be renamed at its index. Keys
    /// cannot be followed if their number or their tracks have changed: then the camera is selected.
    #[must_use]
    pub fn followed(&self, from: &Scene, to: &Scene) -> Self {
        if matches!(self, Self::Keys(_)) && !to.animation.has_same_keys_as(&from.animation) {
            return Self::Camera;
        }
        let stays = |item: &Item| item.name(from) == item.name(to);
        if self.items().iter().all(stays) {
            return self.clone();
        }
        let mut items_by_name: HashMap<(ItemKind, &str), Item> = HashMap::new();
        let packs = (0..to.color_packs.len()).map(Item::pack);
        for item in Item::everything(to).chain(packs) {
            if let Some(name) = item.name(to) {
                items_by_name.insert((item.kind, name), item);
            }
        }
        let same_length = |kind: ItemKind| kind.count(from) == kind.count(to);
        let followed = self.items().iter().filter_map(|item| {
            let name = item.name(from)?;
            let found = items_by_name.get(&(item.kind, name)).copied();
            found.or_else(|| same_length(item.kind).then_some(*item))
        });
        Self::all(followed)
    }
}
