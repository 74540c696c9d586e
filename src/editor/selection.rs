//! What is selected.

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
