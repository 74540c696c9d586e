//! Which picture of a scene is asked for.

use std::ops::Range;

use crate::scene::{Accelerator, Aspect, Camera, Methods, Precision, Projection, Sampling, Scene};
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
    /// What of the light is shown, where that is not the scene's to say; see [`Aspect::of`].
    pub aspect: Aspect,
    /// The part of the picture that is traced, in whole tiles; all of it if `None`.
    pub region: Option<Region>,
    /// The lanes of the kernel; the widest that there are if `None`.
    pub level: Option<Level>,
}

impl RenderRequest {
    /// How many pixels the picture has.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// How the picture is projected.
    pub fn projection_of(&self, camera: &Camera) -> Projection {
        self.projection.unwrap_or(camera.projection)
    }

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
            aspect: Aspect::All,
            region: None,
            level: None,
        }
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First column, and the one behind the last.
    pub columns: (usize, usize),
    /// First row, and the one behind the last.
    pub rows: (usize, usize),
}

impl Region {
    /// How many pixels it has.
    pub fn pixels(self) -> usize {
        (self.columns.1 - self.columns.0) * (self.rows.1 - self.rows.0)
    }

    /// Whether some pixel of these columns and rows is in it.
    pub fn meets(&self, columns: &Range<usize>, rows: &Range<usize>) -> bool {
        let (left, right) = self.columns;
        let (top, bottom) = self.rows;
        columns.start < right && left < columns.end && rows.start < bottom && top < rows.end
    }
}

/// How much of the image model is computed. All show the same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// What the scene needs.
    #[default]
    Needed,
    /// What the scene needs, in the scene's own coordinates and not in those around its middle: what rebasing is
    /// measured against.
    Unrebased,
    /// What the scene needs, with every primitive tested for every ray: what culling is measured against.
    Unculled,
    /// Everything, needed or not, and unculled: what the rules of the plan are measured against.
    Everything,
}
