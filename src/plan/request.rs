//! The picture of a scene that is requested.

use std::ops::Range;

use crate::scene::{Accelerator, Aspect, Camera, Methods, Precision, Projection, Sampling, Scene};
use crate::simd::Level;

/// The picture of a scene that is requested.
#[derive(Clone, Copy, Debug)]
pub struct RenderRequest {
    /// Width in pixels, ≥ 1.
    pub width: u32,
    /// Height in pixels, ≥ 1.
    pub height: u32,
    /// Overrides the camera's own projection.
    pub projection: Option<Projection>,
    /// The real type of the kernel.
    pub precision: Precision,
    /// The formulas of the kernel.
    pub methods: Methods,
    /// How edges are antialiased.
    pub sampling: Sampling,
    /// How the primitives that a ray hits are found.
    pub accelerator: Accelerator,
    /// Whether parts of the image model that the scene does not need are left out.
    pub model: Model,
    /// The aspect of the light to show, where the scene alone does not determine it; see [`Aspect::of`].
    pub aspect: Aspect,
    /// The part of the picture that is traced, in whole tiles; all of it if `None`.
    pub region: Option<Region>,
    /// The SIMD level of the kernel; the widest available if `None`.
    pub level: Option<Level>,
}

impl RenderRequest {
    /// The number of pixels of the picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The projection of the picture.
    pub fn projection_of(&self, camera: &Camera) -> Projection {
        self.projection.unwrap_or(camera.projection)
    }

    /// Returns whether the rays of the picture are parallel.
    pub fn is_parallel(&self, camera: &Camera) -> bool {
        self.projection_of(camera) == Projection::Orthographic
    }

    /// The still picture that the scene's own settings describe.
    pub fn still(scene: &Scene) -> Self {
        Self::of(scene, scene.render.width, scene.render.height)
    }

    /// The picture of the scene's own settings, in this size.
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

    /// A quick picture of a given size, sampled at pixel centres.
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
    /// First column, and one past the last.
    pub columns: (usize, usize),
    /// First row, and one past the last.
    pub rows: (usize, usize),
}

impl Region {
    /// The number of pixels.
    pub fn pixels(self) -> usize {
        (self.columns.1 - self.columns.0) * (self.rows.1 - self.rows.0)
    }

    /// Returns whether any pixel of these columns and rows is in the region.
    pub fn meets(&self, columns: &Range<usize>, rows: &Range<usize>) -> bool {
        let (left, right) = self.columns;
        let (top, bottom) = self.rows;
        columns.start < right && left < columns.end && rows.start < bottom && top < rows.end
    }
}

/// How much of the image model is computed. All variants show the same picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// Only what the scene needs.
    #[default]
    Needed,
    /// What the scene needs, in the scene's own coordinates instead of those relative to its middle: the baseline
    /// for measuring rebasing.
    Unrebased,
    /// What the scene needs, with every primitive tested for every ray: the baseline for measuring culling.
    Unculled,
    /// Everything, needed or not, and without culling: the baseline for measuring the rules of the plan.
    Everything,
}
