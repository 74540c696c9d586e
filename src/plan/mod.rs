//! What the kernels want ready, recomputed from the scene on every edit: primitives packed by kind,
//! rebased around the scene's middle and narrowed to the kernel's real type, without what the
//! picture cannot show. No names, no file.

mod method;
mod pack;
mod precision;
mod screen;
mod view;
mod volumes;

pub use method::{Methods, RayOffset, SphereMethod, TriangleMethod};
pub use pack::{Light, Material, Plan, Plane, Sphere, Surface, Triangle};
pub use precision::{Precision, needs_double};
pub use screen::{Extent, Screen};
pub use view::View;
pub use volumes::{Ball, Balls, GROUP, Volumes};

use crate::lanes::Level;
use crate::scene::{Projection, Scene};

/// Which picture of a scene is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Picture {
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
    /// The lanes of the kernel; the widest that there are if `None`.
    pub level: Option<Level>,
}

impl Picture {
    /// The still picture that the scene itself asks for.
    pub fn still(scene: &Scene) -> Self {
        Self::sized(scene.render.width, scene.render.height)
    }

    /// A picture of another size, everything else as the scene asks.
    pub fn sized(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            projection: None,
            precision: Precision::Auto,
            methods: Methods::default(),
            sampling: Sampling::Centres,
            level: None,
        }
    }
}

/// Largest number of samples along a side of a pixel.
pub const MAX_GRID: u32 = 256;

/// Where in its pixels a picture is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Once, in the middle: edges are jagged.
    Centres,
    /// So many times so many (at most [`MAX_GRID`]), evenly.
    Grid(u32),
    /// At the corners, and inside where those differ.
    Adaptive,
}
