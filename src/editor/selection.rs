//! What is selected.

use std::collections::HashSet;

use super::item::Item;
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
    /// The selected keys of the camera.
    Keys,
}

impl Selection {
    /// The selection, or the camera if the scene has no such item.
    pub fn within(self, scene: &Scene) -> Self {
        match self {
            Self::Item(item) if item.name(scene).is_none() => Self::Camera,
            valid => valid,
        }
    }
}

/// The items that are selected: the one that the inspector shows comes last.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selected(Vec<Item>);

impl Selected {
    /// What `selection` is by itself.
    pub fn only(selection: Selection) -> Self {
        Self(match selection {
            Selection::Item(item) => vec![item],
            _ => Vec::new(),
        })
    }

    /// These, each of them once.
    pub fn all(items: impl IntoIterator<Item = Item>) -> Self {
        let mut all = Vec::new();
        let mut known = HashSet::new();
        all.extend(items.into_iter().filter(|item| known.insert(*item)));
        Self(all)
    }

    /// All items; the one that the inspector shows comes last.
    pub fn items(&self) -> &[Item] {
        &self.0
    }

    /// Whether it is among them.
    pub fn has(&self, item: Item) -> bool {
        self.0.contains(&item)
    }

    /// The same with `item`, or without it if it was among them.
    #[must_use]
    pub fn toggled(&self, item: Item) -> Self {
        let mut items = self.0.clone();
        match items.iter().position(|other| *other == item) {
            Some(place) => {
                items.remove(place);
            }
            None => items.push(item),
        }
        Self(items)
    }

    /// What the inspector shows of them.
    pub fn selection(&self) -> Selection {
        self.0
            .last()
            .copied()
            .map_or_else(Selection::default, Selection::Item)
    }
}
