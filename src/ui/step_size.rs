//! How fine the numbers of a scene are.

use egui::{Context, Id};

use crate::scene::{List, Object, Scene};

/// What a point of a drag changes a length by at least, as a share of the scene.
const SHARE: f64 = 1e-4;
/// The same in a scene of usual size, or without any, in world units.
pub const USUAL: f64 = 0.01;

/// Keeps the step size of what is edited.
#[derive(Default)]
pub struct StepSize {
    of: Option<List<Object>>,
}

impl StepSize {
    /// Takes the size of the scene, if its objects have changed.
    pub fn update(&mut self, ctx: &Context, scene: &Scene) {
        let is_known = |of: &List<Object>| of.is_same(&scene.objects);
        if self.of.as_ref().is_some_and(is_known) {
            return;
        }
        self.of = Some(scene.objects.clone());
        let bounds = scene.surroundings();
        let size = bounds.map(|(low, high)| (high - low).length());
        let step_size = size.map_or(USUAL, |size| (size * SHARE).min(USUAL));
        ctx.data_mut(|data| data.insert_temp(id(), step_size));
    }
}

/// What a point of a drag changes a length by at least: a scene in metres has finer numbers than one in millimetres.
pub fn step_size(ctx: &Context) -> f64 {
    let known = ctx.data(|data| data.get_temp(id()));
    known.filter(|step_size| *step_size > 0.0).unwrap_or(USUAL)
}

fn id() -> Id {
    Id::unique("step size of the scene")
}
