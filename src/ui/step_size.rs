//! The step size of dragged lengths, which depends on the size of the scene.

use egui::{Context, Id};

use crate::scene::{List, Object, Scene};

/// Least change of a length per point of a drag, as a share of the scene's extent.
const EXTENT_SHARE: f64 = 1e-4;
/// Upper limit of that change, and its value in a scene without extent, in world units.
pub const MAX_STEP: f64 = 0.01;

/// Keeps the step size up to date with the edited scene.
#[derive(Default)]
pub struct StepSize {
    objects: Option<List<Object>>,
}

impl StepSize {
    /// Computes the step size of the scene again if its objects have changed.
    pub fn update(&mut self, ctx: &Context, scene: &Scene) {
        let is_known = |objects: &List<Object>| objects.is_same(&scene.objects);
        if self.objects.as_ref().is_some_and(is_known) {
            return;
        }
        self.objects = Some(scene.objects.clone());
        let bounds = scene.surroundings();
        let size = bounds.map(|(low, high)| (high - low).length());
        let step_size = size.map_or(MAX_STEP, |size| (size * EXTENT_SHARE).min(MAX_STEP));
        ctx.data_mut(|data| data.insert_temp(id(), step_size));
    }
}

/// Returns the least change of a length per point of a drag: finer for a scene in metres than in millimetres.
pub fn step_size(ctx: &Context) -> f64 {
    let known = ctx.data(|data| data.get_temp(id()));
    known
        .filter(|step_size| *step_size > 0.0)
        .unwrap_or(MAX_STEP)
}

fn id() -> Id {
    Id::unique("step size of the scene")
}
