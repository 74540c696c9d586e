//! What hits are made of that are lit as one.

use super::footprint::Footprint;
use super::mixed_materials::MixedMaterials;
use super::thresholds::EDGE_CONTRAST;
use crate::plan::{Plan, PointLight, Surface};
use crate::simd::{SimdFloat, Vec3};

/// What hits are made of.
#[derive(Clone, Copy)]
pub enum HitMaterial<'a, L: SimdFloat> {
    /// One material.
    One(&'a Surface<L::Real>),
    /// Seldom, and never without a tree.
    Several(&'a MixedMaterials<L>),
}

impl<L: SimdFloat> HitMaterial<'_, L> {
    /// The highlights, see [`crate::simd::Exponent::highlight`]; `None` where nothing has any.
    #[inline(always)]
    pub fn highlight(&self, normal: Vec3<L>, half: Vec3<L>) -> Option<L> {
        match self {
            // No closure: it may be compiled by itself, without vectors.
            Self::One(surface) => Some(surface.exponent?.highlight(normal, half)),
            Self::Several(mixed) => Some(mixed.highlight(normal, half)),
        }
    }

    /// Which of the hits have highlights.
    #[inline(always)]
    pub fn shiny(&self, here: L::Mask) -> Option<L::Mask> {
        match self {
            Self::One(Surface { exponent: None, .. }) => None,
            Self::One(_) => Some(here),
            Self::Several(mixed) => mixed.shiny,
        }
    }

    /// Whether some highlight may be smaller than a pixel.
    pub fn is_sharp(&self) -> bool {
        match self {
            Self::One(surface) => surface.size_of_highlight().is_some(),
            Self::Several(mixed) => mixed.is_any_sharp(),
        }
    }

    /// How many pixels away a highlight is, see [`Footprint::highlight_distance`].
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

    /// The brightest that light of intensity 1 makes what is matte of it.
    #[inline(always)]
    pub fn brightness(&self, plan: &Plan<L::Real>, like: L) -> L {
        match self {
            Self::One(surface) => like.like(surface.brightness()),
            Self::Several(mixed) => mixed.brightness(plan, like),
        }
    }

    /// Where a light is seen that arrives with these cosines, the middle between it and the viewer being `half`: also
    /// where it is so in its highlight alone.
    ///
    /// Apart: few packets need it, and the others are quicker without. Of a copy: what the shading has in registers would
    /// be in memory if a part of it had an address.
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
                    .less(glow * cosine.like(light.intensity))
            },
        )
    }
}
