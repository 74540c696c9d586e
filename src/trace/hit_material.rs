//! The materials of hits that are lit together.

use super::footprint::Footprint;
use super::mixed_materials::MixedMaterials;
use super::thresholds::EDGE_CONTRAST;
use crate::plan::{Plan, PointLight, Surface};
use crate::simd::{SimdFloat, Vec3};

/// The material of hits that are lit together.
#[derive(Clone, Copy)]
pub enum HitMaterial<'a, L: SimdFloat> {
    /// The same material for all of them.
    One(&'a Surface<L::Real>),
    /// Several materials: rare, and only in plans with a tree.
    Several(&'a MixedMaterials<L>),
}

impl<L: SimdFloat> HitMaterial<'_, L> {
    /// Returns the intensity of the highlight, see [`crate::simd::Exponent::highlight`]; `None` if no hit has one.
    #[inline(always)]
    pub fn highlight(&self, normal: Vec3<L>, half: Vec3<L>) -> Option<L> {
        match self {
            // No closure: it might be compiled as a function of its own, without vector instructions.
            Self::One(surface) => Some(surface.exponent?.highlight(normal, half)),
            Self::Several(mixed) => Some(mixed.highlight(normal, half)),
        }
    }

    /// Returns which of the hits have highlights; `None` if no material has any.
    #[inline(always)]
    pub fn shiny(&self, lanes: L::Mask) -> Option<L::Mask> {
        match self {
            Self::One(Surface { exponent: None, .. }) => None,
            Self::One(_) => Some(lanes),
            Self::Several(mixed) => mixed.shiny,
        }
    }

    /// Returns whether a highlight may be smaller than a pixel.
    pub fn is_sharp(&self) -> bool {
        match self {
            Self::One(surface) => surface.size_of_highlight().is_some(),
            Self::Several(mixed) => mixed.is_any_sharp(),
        }
    }

    /// Returns how many pixels away a highlight is, see [`Footprint::highlight_distance`].
    #[inline(always)]
    pub fn highlight_distance(&self, footprint: &Footprint<L>, off: L, light_distance: L) -> L {
        match self {
            Self::One(surface) => {
                let size = surface.size_of_highlight().unwrap_or_default();
                footprint.highlight_distance(size, off, light_distance)
            }
            Self::Several(mixed) => mixed.highlight_distance(footprint, off, light_distance),
        }
    }

    /// Returns the greatest matte brightness under a light of intensity 1, summed over the channels.
    #[inline(always)]
    pub fn brightness(&self, plan: &Plan<L::Real>, like: L) -> L {
        match self {
            Self::One(surface) => like.like(surface.brightness()),
            Self::Several(mixed) => mixed.brightness(plan, like),
        }
    }

    /// Returns where a light, with those around it, is bright enough to be seen, be it only in its highlight. Given are the cosine between
    /// normal and direction to the light, the normal, and a vector halfway between the directions to the light and
    /// to the viewer.
    ///
    /// Out of line: few packets need it, and the others are faster without it. Takes `self` by value: values that
    /// the shading keeps in registers would have to be in memory if a reference to a part of them were taken.
    #[cold]
    #[inline(never)]
    pub fn shows(
        self,
        plan: &Plan<L::Real>,
        light: &PointLight<L::Real>,
        (cosine, normal, half): (L, Vec3<L>, Vec3<L>),
    ) -> L::Mask {
        L::vectorize(
            cosine.token(),
            #[inline(always)]
            || {
                let glow = match self {
                    Self::One(surface) => {
                        let matte = cosine * cosine.like(surface.brightness());
                        match surface.exponent {
                            None => matte,
                            Some(exponent) => {
                                let gloss = cosine.like(surface.gloss());
                                matte + exponent.highlight(normal, half) * gloss
                            }
                        }
                    }
                    Self::Several(mixed) => mixed.glow(plan, (cosine, normal, half)),
                };
                cosine
                    .like_f64(EDGE_CONTRAST)
                    .less(glow * cosine.like(light.edge_intensity))
            },
        )
    }
}
