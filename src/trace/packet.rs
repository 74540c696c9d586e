//! Packets of rays, and what is noted of them.

use super::footprint::RayCone;
use super::intersect::{Kernel, Nearest};
use super::paths::{IgnoredPrimitive, NO_PRIMITIVE};
use crate::primitive::Ray;
use crate::simd::{Real, SimdFloat, Vec3};

/// Rays that are traced in step, what they hit and the colours that they bring back.
#[derive(Clone, Copy)]
pub struct Packet<L: SimdFloat> {
    /// The rays.
    pub rays: Ray<L>,
    /// Where there is a ray.
    pub active: L::Mask,
    /// What they hit first.
    pub nearest: Nearest<L>,
    /// Linear colours, 0–1.
    pub color: Vec3<L>,
}

/// Where mirrored rays come from.
#[derive(Clone, Copy)]
pub struct ReflectionParent<L: SimdFloat> {
    /// Index of the packet in the previous bounce.
    pub packet: usize,
    /// The primitives that they start on.
    pub ignored: IgnoredPrimitive<L>,
    /// The factors that their colours are multiplied by.
    pub filter: Vec3<L>,
}

/// What is known about the edges around samples.
#[derive(Clone, Copy, Debug)]
pub struct EdgeInfo<L> {
    /// The width of a pixel along the rays.
    pub cone: RayCone<L>,
    /// The sum of [`super::shadows::light_bit`] over the lights that shine on what was hit.
    pub lit: L,
    /// How many pixels away the nearest thing is that may slip between samples; infinity for none.
    pub thin_distance: L,
    /// The shadows that the hit is in and that end near it, see [`super::shadows`].
    pub shadows: L,
    /// The same for what is seen in the mirror that was hit.
    pub mirrored_shadows: L,
}

impl<L: SimdFloat> Packet<L> {
    /// Creates a packet of rays that have hit nothing yet.
    #[inline(always)]
    pub fn new<const TREE: bool>(kernel: Kernel<L, TREE>, rays: Ray<L>, active: L::Mask) -> Self {
        Self {
            rays,
            active,
            nearest: Nearest {
                t: kernel.infinity(),
                number: kernel.splat(NO_PRIMITIVE),
            },
            color: Vec3::broadcast(kernel.token, kernel.plan.background),
        }
    }
}

impl<L: SimdFloat> EdgeInfo<L> {
    /// Creates the information of rays that have hit nothing yet.
    #[inline(always)]
    pub fn new(cone: RayCone<L>) -> Self {
        Self {
            cone,
            lit: cone.width.like(L::Real::ZERO),
            thin_distance: cone.width.like(L::Real::INFINITY),
            shadows: cone.width.like(L::Real::ZERO),
            mirrored_shadows: cone.width.like(L::Real::ZERO),
        }
    }
}
