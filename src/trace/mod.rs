//! What runs per ray and per tile: one file per primitive with its competing formulas side by side,
//! shading, and the tile loop. Knows no scene, no file and no pixel format.
//!
//! A new primitive is a file here, a list in the plan and its lines in `hit.rs`.

mod beam;
mod cull;
mod hit;
mod mesh;
mod packet;
mod plane;
pub mod probe;
mod samples;
mod sampling;
mod shade;
pub mod sight;
mod sphere;
mod stage;
mod thin;
mod threads;
mod tiles;
mod triangle;

use std::sync::atomic::{AtomicBool, AtomicU64};

pub use threads::{PoolError, Threads};
pub use tiles::{Grid, Pass, Pixel, Tracer};

use crate::simd::{SimdFloat, Vec3};

/// Half-lines: origins and unit directions.
#[derive(Clone, Copy, Debug)]
pub struct Ray<L> {
    /// Where they start.
    pub origin: Vec3<L>,
    /// Where they go; of length 1.
    pub direction: Vec3<L>,
}

impl<L: SimdFloat> Ray<L> {
    /// The points `t` along.
    #[inline(always)]
    pub fn at(&self, t: L) -> Vec3<L> {
        self.origin + self.direction * t
    }
}

/// How many rays were traced, by what they were for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rays {
    /// From the camera.
    pub camera: u64,
    /// From a surface to a light.
    pub shadow: u64,
    /// From a mirror.
    pub reflected: u64,
}

impl Rays {
    /// All of them.
    pub fn total(self) -> u64 {
        self.camera + self.shadow + self.reflected
    }
}

impl std::ops::AddAssign for Rays {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl std::ops::Add for Rays {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            camera: self.camera + other.camera,
            shadow: self.shadow + other.shadow,
            reflected: self.reflected + other.reflected,
        }
    }
}

/// What a running trace and its caller tell each other.
#[derive(Debug, Default)]
pub struct RenderControl {
    /// Set by the caller to end the trace within a part of a tile.
    pub stop: AtomicBool,
    /// Pixels traced so far.
    pub pixels: AtomicU64,
}
