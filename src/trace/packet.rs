//! Rays that travel in step, and what goes with them.

use super::Ray;
use super::hit::{NOTHING, Nearest, Start};
use crate::plan::Plan;
use crate::simd::{Real, SimdFloat, Vec3};

/// Rays that are traced in step, what they meet and what they bring back.
#[derive(Clone, Copy)]
pub struct Packet<L: SimdFloat> {
    /// The rays.
    pub rays: Ray<L>,
    /// Where there is a ray.
    pub active: L::Mask,
    /// What they meet first.
    pub near: Nearest<L>,
    /// Linear colours, 0–1.
    pub color: Vec3<L>,
}

/// Where mirrored rays come from.
#[derive(Clone, Copy)]
pub struct Link<L: SimdFloat> {
    /// Place of the packet in the stage before.
    pub parent: usize,
    /// What they start on.
    pub start: Start<L>,
    /// What their colours are multiplied by.
    pub filter: Vec3<L>,
}

/// How wide a pixel is: where the rays start, and how much wider at distance 1.
#[derive(Clone, Copy, Debug)]
pub struct RayCone<L> {
    /// Scene units.
    pub width: L,
    /// Scene units per scene unit.
    pub spread: L,
}

/// What samples know of their surroundings.
#[derive(Clone, Copy, Debug)]
pub struct Mark<L> {
    /// How wide a pixel is along the rays.
    pub trail: RayCone<L>,
    /// The sum of 2ⁱ over the lights i that shine on what was hit.
    pub lit: L,
    /// How many pixels away the next thing is that may slip between samples; infinity for none.
    pub near: L,
}

impl<L: SimdFloat> Packet<L> {
    /// Rays that have met nothing yet.
    #[inline(always)]
    pub fn new(token: L::Token, plan: &Plan<L::Real>, rays: Ray<L>, active: L::Mask) -> Self {
        Self {
            rays,
            active,
            near: Nearest {
                t: L::splat(token, L::Real::INFINITY),
                number: L::splat(token, L::Real::from_f64(NOTHING)),
            },
            color: Vec3::broadcast(token, plan.background),
        }
    }
}

impl<L: SimdFloat> Mark<L> {
    /// Of rays that have met nothing yet.
    #[inline(always)]
    pub fn new(token: L::Token, trail: RayCone<L>) -> Self {
        Self {
            trail,
            lit: L::splat(token, L::Real::ZERO),
            near: L::splat(token, L::Real::INFINITY),
        }
    }
}
