//! What hits are made of that are lit as one, where it is not one material.
//!
//! Functions of their own: few packets need them, and a compiler that finds a loop over materials between the
//! lights works out all that any of them may need before it looks which there are.

use super::footprint::Footprint;
use crate::plan::{Material, Plan, Show, Surface};
use crate::simd::{Exponent, MAX_LANES, Real, SimdFloat, Vec3};

/// The light that arrives, summed over the lights.
pub struct ArrivingLight<L: SimdFloat> {
    /// Σ intensity · n·l, what matte colours are multiplied by.
    pub matte: L,
    /// Σ intensity · (n·h)^p, what the colours of highlights are multiplied by.
    pub highlight: L,
    /// Where rounding may decide whether something of it does.
    pub doubt: L::Mask,
}

impl<L: SimdFloat> ArrivingLight<L> {
    /// What it adds to the colour of a surface.
    #[inline(always)]
    pub fn color(&self, surface: &Surface<L::Real>, show: Show<L::Real>) -> Vec3<L> {
        if let Show::Shadows(_) = show {
            return Vec3::splat(self.matte);
        }
        let like = Vec3::splat(self.matte);
        like.like(surface.diffuse) * self.matte + like.like(surface.specular) * self.highlight
    }
}

/// Materials, and where they are.
pub struct MixedMaterials<L: SimdFloat> {
    /// Each with its index into [`crate::plan::Plan::materials`].
    materials: Vec<(L::Mask, u32)>,
    /// The exponents of highlights.
    exponents: Vec<(L::Mask, Exponent)>,
    /// Where there are any; known with the base colours.
    pub shiny: Option<L::Mask>,
}

impl<L: SimdFloat> MixedMaterials<L> {
    /// None, and room for those of a packet.
    pub fn new() -> Self {
        Self {
            materials: Vec::with_capacity(MAX_LANES),
            exponents: Vec::with_capacity(MAX_LANES),
            shiny: None,
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.materials.clear();
        self.exponents.clear();
        self.shiny = None;
    }

    /// Adds hits on a material.
    pub fn add(&mut self, here: L::Mask, material: u32) {
        self.materials.push((here, material));
    }

    /// Whether there is more than one.
    pub fn are_several(&self) -> bool {
        self.materials.len() > 1
    }

    /// Sets the colours that the materials have without light, or those in their place. Where light falls on them,
    /// if anywhere.
    #[inline(never)]
    pub fn set_base(
        &mut self,
        materials: &[Material<L::Real>],
        instead: Option<Vec3<L>>,
        color: &mut Vec3<L>,
    ) -> Option<L::Mask> {
        L::vectorize(
            color.x.token(),
            #[inline(always)]
            || {
                let mut lit: Option<L::Mask> = None;
                let mut shiny = color.x.less(color.x);
                for &(here, material) in &self.materials {
                    let Material { base, surface } = &materials[material as usize];
                    let base = instead.unwrap_or(color.like(*base));
                    *color = Vec3::select(here, base, *color);
                    let Some(surface) = surface else { continue };
                    lit = match lit {
                        Some(lit) => Some(lit | here),
                        None => Some(here),
                    };
                    let Some(exponent) = surface.exponent else {
                        continue;
                    };
                    shiny = shiny | here;
                    let mut known = self.exponents.iter_mut();
                    match known.find(|(_, other)| *other == exponent) {
                        Some((others, _)) => *others = *others | here,
                        None => self.exponents.push((here, exponent)),
                    }
                }
                self.shiny = Some(shiny);
                lit
            },
        )
    }

    fn surfaces<'a>(
        &'a self,
        plan: &'a Plan<L::Real>,
    ) -> impl Iterator<Item = (L::Mask, &'a Surface<L::Real>)> {
        let materials = self.materials.iter();
        materials.filter_map(|(here, material)| {
            let surface = plan.materials[*material as usize].surface.as_ref()?;
            Some((*here, surface))
        })
    }

    /// Adds the light that arrives.
    #[inline(never)]
    pub fn color(&self, plan: &Plan<L::Real>, arriving: &ArrivingLight<L>, color: &mut Vec3<L>) {
        L::vectorize(
            color.x.token(),
            #[inline(always)]
            || {
                for (here, surface) in self.surfaces(plan) {
                    let light = arriving.color(surface, plan.show);
                    *color = Vec3::select(here, *color + light, *color);
                }
            },
        );
    }

    /// Where there are mirrors, and what their images are multiplied by.
    #[inline(never)]
    pub fn mirror(&self, plan: &Plan<L::Real>, like: L) -> Option<(L::Mask, Vec3<L>)> {
        L::vectorize(
            like.token(),
            #[inline(always)]
            || {
                let mut mirrors: Option<(L::Mask, Vec3<L>)> = None;
                for (here, surface) in self.surfaces(plan) {
                    let Some(filter) = surface.mirror else {
                        continue;
                    };
                    let filter = Vec3::splat(like).like(filter);
                    mirrors = Some(match mirrors {
                        None => (here, filter),
                        Some((others, other)) => (here | others, Vec3::select(here, filter, other)),
                    });
                }
                mirrors
            },
        )
    }

    /// The sum of the channels of the matte colours.
    #[inline(never)]
    pub fn brightness(&self, plan: &Plan<L::Real>, like: L) -> L {
        L::vectorize(
            like.token(),
            #[inline(always)]
            || {
                let mut brightness = like;
                for (here, surface) in self.surfaces(plan) {
                    brightness = L::select(here, like.like(surface.brightness()), brightness);
                }
                brightness
            },
        )
    }

    /// What light of intensity 1 adds, all channels together, see [`super::hit_material::HitMaterial::shows`].
    #[inline(never)]
    pub fn glow(&self, plan: &Plan<L::Real>, (cosine, normal, half): (L, Vec3<L>, Vec3<L>)) -> L {
        L::vectorize(
            cosine.token(),
            #[inline(always)]
            || {
                let zero = cosine.like(L::Real::ZERO);
                let mut gloss = zero;
                for (here, surface) in self.surfaces(plan) {
                    gloss = L::select(here, zero.like(surface.gloss()), gloss);
                }
                cosine * self.brightness(plan, zero) + self.highlight(normal, half) * gloss
            },
        )
    }

    /// Each ray's highlight, see [`Exponent::highlight`].
    #[inline(never)]
    pub fn highlight(&self, normal: Vec3<L>, half: Vec3<L>) -> L {
        L::vectorize(
            normal.x.token(),
            #[inline(always)]
            || {
                let mut highlights = normal.x.like(L::Real::ZERO);
                for (here, exponent) in &self.exponents {
                    let highlight = exponent.highlight(normal, half);
                    highlights = L::select(*here, highlight, highlights);
                }
                highlights
            },
        )
    }

    /// How many pixels away each ray's highlight is, if it may be smaller than a pixel; see
    /// [`Footprint::highlight_distance`].
    #[inline(never)]
    pub fn highlight_distance(&self, footprint: &Footprint<L>, off: L, light_distance: L) -> L {
        L::vectorize(
            off.token(),
            #[inline(always)]
            || {
                let mut distance = off.like(L::Real::INFINITY);
                for (here, exponent) in &self.exponents {
                    if let Some(size) = exponent.size() {
                        let near = footprint.highlight_distance(size, off, light_distance);
                        distance = L::select(*here, near, distance);
                    }
                }
                distance
            },
        )
    }

    /// Whether some highlight may be smaller than a pixel.
    pub fn is_any_sharp(&self) -> bool {
        let mut exponents = self.exponents.iter();
        exponents.any(|(_, exponent)| exponent.size().is_some())
    }
}
