//! Which picture of a scene is asked for.

use crate::scene::{Accelerator, Methods, Precision, Projection, Sampling, Scene};
use crate::simd::Level;

/// Which picture of a scene is asked for.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest {
    /// Width in pixels, ≥ 1.
    pub width: u32,
    /// Height in pixels, ≥ 1.
    pub height: u32,
    /// Takes the place of the camera's own projection.
    pub projection: Option<Projection>,
    /// The real type of the kernel.
    pub precision: Precision,
    /// The formulas of the kernel.
    pub methods: Methods,
    /// How edges are smoothed.
    pub sampling: Sampling,
    /// How primitives are found.
    pub accelerator: Accelerator,
    /// Whether parts of the model that the scene does not need are left out.
    pub model: Model,
    /// The lanes of the kernel; the widest that there are if `None`.
    pub level: Option<Level>,
}

impl RenderRequest {
    /// The still picture that the scene itself asks for.
    pub fn still(scene: &Scene) -> Self {
        Self::of(scene, scene.render.width, scene.render.height)
    }

    /// The picture that the scene itself asks for, in another size.
    pub fn of(scene: &Scene, width: u32, height: u32) -> Self {
        let render = &scene.render;
        Self {
            precision: render.precision,
            methods: render.methods(),
            sampling: render.antialias,
            accelerator: render.accelerator,
            ..Self::sized(width, height)
        }
    }

    /// A quick picture of another size, sampled at the pixels' centres.
    pub fn sized(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            projection: None,
            precision: Precision::Auto,
            methods: Methods::default(),
            sampling: Sampling::Centres,
            accelerator: Accelerator::Auto,
            model: Model::Needed,
            level: None,
        }
    }
}

/// How much of the image model is computed. All show the same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// What the scene needs.
    #[default]
    Needed,
    /// What the scene needs, with every primitive tested for every ray: what culling is measured against.
    Unculled,
    /// Everything, needed or not, and unculled: what the rules of the plan are measured against.
    Everything,
}
