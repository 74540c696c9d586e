//! What is selected.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::item::{Item, Kind};
use crate::scene::Scene;

/// What the inspector shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// The camera.
    #[default]
    Camera,
    /// Ambient intensity, background, light visualization.
    World,
    /// The still picture's size and reflections.
    Render,
    /// One entry of a list of the scene.
    Item(Item),
    /// The selected keys.
    Keys,
}

/// All that is selected.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selected {
    /// The camera.
    #[default]
    Camera,
    /// Ambient intensity, background, light visualization.
    World,
    /// The still picture's size and reflections.
    Render,
    /// Items, at least one: the one that the inspector shows comes last.
    Items(Vec<Item>),
    /// The keys that the timeline knows.
    Keys,
}

impl From<Selection> for Selected {
    fn from(selection: Selection) -> Self {
        match selection {
            Selection::Camera => Self::Camera,
            Selection::World => Self::World,
            Selection::Render => Self::Render,
            Selection::Item(item) => Self::Items(vec![item]),
            Selection::Keys => Self::Keys,
        }
    }
}

impl Selected {
    /// The group that is selected: all of its objects, of which there are several, and nothing else.
    pub fn group<'a>(&self, scene: &'a Scene) -> Option<&'a str> {
        let group_of = |item: &Item| {
            let objects = scene.objects.get(item.index);
            let object = objects.filter(|_| item.kind == Kind::Object)?;
            Some(object.group.as_str()).filter(|group| !group.is_empty())
        };
        let [first, _, ..] = self.items() else {
            return None;
        };
        let group = group_of(first)?;
        let is_in_it = |item: &Item| group_of(item) == Some(group);
        let members = scene.objects.iter().filter(|object| object.group == group);
        let is_whole = self.items().iter().all(is_in_it) && members.count() == self.items().len();
        is_whole.then_some(group)
    }

    /// These, each of them once; the camera if there are none.
    pub fn all(items: impl IntoIterator<Item = Item>) -> Self {
        let mut all = Vec::new();
        let mut known = HashSet::new();
        all.extend(items.into_iter().filter(|item| known.insert(*item)));
        if all.is_empty() {
            Self::Camera
        } else {
            Self::Items(all)
        }
    }

    /// All items; the one that the inspector shows comes last.
    pub fn items(&self) -> &[Item] {
        match self {
            Self::Items(items) => items,
            _ => &[],
        }
    }

    /// The places of those of a kind, in ascending order.
    pub fn places(&self, kind: Kind) -> Vec<usize> {
        let own = self.items().iter().filter(|item| item.kind == kind);
        let mut places: Vec<usize> = own.map(|item| item.index).collect();
        places.sort_unstable();
        places
    }

    /// Whether it is among them.
    pub fn has(&self, item: Item) -> bool {
        self.items().contains(&item)
    }

    /// Whether all of these are among them.
    pub fn has_all(&self, items: impl ExactSizeIterator<Item = Item>) -> bool {
        // Mostly, fewer are selected.
        if self.items().len() < items.len() {
            return false;
        }
        let selected: HashSet<&Item> = self.items().iter().collect();
        let mut items = items;
        items.all(|item| selected.contains(&item))
    }

    /// The middle of all that have a place; `None` if nothing has.
    pub fn middle(&self, scene: &Scene) -> Option<DVec3> {
        let middles = self.items().iter().filter_map(|item| match item.kind {
            Kind::Object => Some(scene.objects.get(item.index)?.shape.middle()),
            Kind::Light => Some(scene.lights.get(item.index)?.position),
            Kind::Pack => None,
        });
        let middles: Vec<DVec3> = middles.collect();
        (!middles.is_empty()).then(|| middles.iter().sum::<DVec3>() / middles.len() as f64)
    }

    /// The same with `item`, or without it if it was among them.
    #[must_use]
    pub fn toggled(&self, item: Item) -> Self {
        let others = self.items().iter().copied();
        let others = others.filter(|other| *other != item);
        let new = (!self.has(item)).then_some(item);
        Self::all(others.chain(new))
    }

    /// The same things in another state of the scene, by their names; without those that are not there. A
    /// thing of another name in the same place is the same, if the old name is gone.
    #[must_use]
    pub fn followed(&self, from: &Scene, to: &Scene) -> Self {
        let stays = |item: &Item| item.name(from) == item.name(to);
        if self.items().iter().all(stays) {
            return self.clone();
        }
        let mut places: HashMap<(Kind, &str), Item> = HashMap::new();
        let packs = (0..to.color_packs.len()).map(Item::pack);
        for item in Item::everything(to).chain(packs) {
            if let Some(name) = item.name(to) {
                places.insert((item.kind, name), item);
            }
        }
        let same_length = |kind: Kind| kind.count(from) == kind.count(to);
        let followed = self.items().iter().filter_map(|item| {
            let name = item.name(from)?;
            let found = places.get(&(item.kind, name)).copied();
            found.or_else(|| same_length(item.kind).then_some(*item))
        });
        Self::all(followed)
    }

    /// What the inspector shows of it.
    pub fn selection(&self) -> Selection {
        match self {
            Self::Camera => Selection::Camera,
            Self::World => Selection::World,
            Self::Render => Selection::Render,
            Self::Items(items) => items
                .last()
                .copied()
                .map_or_else(Selection::default, Selection::Item),
            Self::Keys => Selection::Keys,
        }
    }
}
