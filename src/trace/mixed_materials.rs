//! The materials of hits that are lit together, if there are several.
//!
//! Out-of-line functions: few packets need them, and a compiler that finds a loop over materials between the lights
//! computes everything that any material may need before it checks which ones there are.

use super::footprint::Footprint;
use crate::plan::{Material, Plan, Show, Surface};
use crate::simd::{Exponent, MAX_LANES, Real, SimdFloat, Vec3};

/// The light that arrives, summed over the lights.
pub struct ArrivingLight<L: SimdFloat> {
    /// Σ intensity · n·l, the factor of matte colours.
    pub matte: L,
    /// Σ intensity · (n·h)^p, the factor of highlight colours.
    pub highlight: L,
    /// Where rounding may decide whether some of it arrives.
    pub doubt: L::Mask,
}

impl<L: SimdFloat> ArrivingLight<L> {
    /// Returns what the light adds to the colour of a surface.
    #[inline(always)]
    pub fn color(&self, surface: &Surface<L::Real>, show: Show<L::Real>) -> Vec3<L> {
        if let Show::Shadows(_) = show {
            return Vec3::splat(self.matte);
        }
        let like = Vec3::splat(self.matte);
        like.like(surface.diffuse) * self.matte + like.like(surface.specular) * self.highlight
    }
}

/// Materials, and the hits on each.
pub struct MixedMaterials<L: SimdFloat> {
    /// The hits, and the index into [`crate::plan::Plan::materials`].
    materials: Vec<(L::Mask, u32)>,
    /// The hits, and the exponent of their highlights.
    exponents: Vec<(L::Mask, Exponent)>,
    /// Which hits have highlights; `None` before [`Self::set_base`].
    pub shiny: Option<L::Mask>,
}

impl<L: SimdFloat> MixedMaterials<L> {
    /// Creates an empty list with room for the materials of a packet.
    pub fn new() -> Self {
        Self {
            materials: Vec::with_capacity(MAX_LANES),
            exponents: Vec::with_capacity(MAX_LANES),
            shiny: None,
        }
    }

    /// Removes all materials.
    pub fn clear(&mut self) {
        self.materials.clear();
        self.exponents.clear();
        self.shiny = None;
    }

    /// Adds a material, and the hits on it.
    pub fn add(&mut self, lanes: L::Mask, material: u32) {
        self.materials.push((lanes, material));
    }

    /// Returns whether there is more than one material.
    pub fn are_several(&self) -> bool {
        self.materials.len() > 1
    }

    /// Sets `color` to the colours that the materials have without light, or to `stand_in` if given. Returns which
    /// hits respond to light; `None` if none does.
    #[inline(never)]
    pub fn set_base(
        &mut self,
        materials: &[Material<L::Real>],
        stand_in: Option<Vec3<L>>,
        color: &mut Vec3<L>,
    ) -> Option<L::Mask> {
        L::vectorize(
            color.x.token(),
            #[inline(always)]
            || {
                let mut lit: Option<L::Mask> = None;
                let mut shiny = color.x.less(color.x);
                for &(lanes, material) in &self.materials {
                    let Material { base, surface } = &materials[material as usize];
                    let base = stand_in.unwrap_or(color.like(*base));
                    *color = Vec3::select(lanes, base, *color);
                    let Some(surface) = surface else { continue };
                    lit = match lit {
                        Some(lit) => Some(lit | lanes),
                        None => Some(lanes),
                    };
                    let Some(exponent) = surface.exponent else {
                        continue;
                    };
                    shiny = shiny | lanes;
                    let mut known = self.exponents.iter_mut();
                    match known.find(|(_, other)| *other == exponent) {
                        Some((known_lanes, _)) => *known_lanes = *known_lanes | lanes,
                        None => self.exponents.push((lanes, exponent)),
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
        materials.filter_map(|(lanes, material)| {
            let surface = plan.materials[*material as usize].surface.as_ref()?;
            Some((*lanes, surface))
        })
    }

    /// Adds the arriving light to the colours.
    #[inline(never)]
    pub fn color(&self, plan: &Plan<L::Real>, arriving: &ArrivingLight<L>, color: &mut Vec3<L>) {
        L::vectorize(
            color.x.token(),
            #[inline(always)]
            || {
                for (lanes, surface) in self.surfaces(plan) {
                    let light = arriving.color(surface, plan.show);
                    *color = Vec3::select(lanes, *color + light, *color);
                }
            },
        );
    }

    /// Returns where there are mirrors, and the factors that their images are multiplied by.
    #[inline(never)]
    pub fn mirror(&self, plan: &Plan<L::Real>, like: L) -> Option<(L::Mask, Vec3<L>)> {
        L::vectorize(
            like.token(),
            #[inline(always)]
            || {
                let mut mirrors: Option<(L::Mask, Vec3<L>)> = None;
                for (lanes, surface) in self.surfaces(plan) {
                    let Some(filter) = surface.mirror else {
                        continue;
                    };
                    let filter = Vec3::splat(like).like(filter);
                    mirrors = Some(match mirrors {
                        None => (lanes, filter),
                        Some((known_lanes, other)) => {
                            (lanes | known_lanes, Vec3::select(lanes, filter, other))
                        }
                    });
                }
                mirrors
            },
        )
    }

    /// Returns the matte brightness: the sum of the channels of the matte colours.
    #[inline(never)]
    pub fn brightness(&self, plan: &Plan<L::Real>, like: L) -> L {
        L::vectorize(
            like.token(),
            #[inline(always)]
            || {
                let mut brightness = like;
                for (lanes, surface) in self.surfaces(plan) {
                    brightness = L::select(lanes, like.like(surface.brightness()), brightness);
                }
                brightness
            },
        )
    }

    /// Returns what light of intensity 1 adds, summed over the channels, see
    /// [`super::hit_material::HitMaterial::shows`].
    #[inline(never)]
    pub fn glow(&self, plan: &Plan<L::Real>, (cosine, normal, half): (L, Vec3<L>, Vec3<L>)) -> L {
        L::vectorize(
            cosine.token(),
            #[inline(always)]
            || {
                let zero = cosine.like(L::Real::ZERO);
                let mut gloss = zero;
                for (lanes, surface) in self.surfaces(plan) {
                    gloss = L::select(lanes, zero.like(surface.gloss()), gloss);
                }
                cosine * self.brightness(plan, zero) + self.highlight(normal, half) * gloss
            },
        )
    }

    /// Returns each ray's highlight, see [`Exponent::highlight`].
    #[inline(never)]
    pub fn highlight(&self, normal: Vec3<L>, half: Vec3<L>) -> L {
        L::vectorize(
            normal.x.token(),
            #[inline(always)]
            || {
                let mut highlights = normal.x.like(L::Real::ZERO);
                for (lanes, exponent) in &self.exponents {
                    let highlight = exponent.highlight(normal, half);
                    highlights = L::select(*lanes, highlight, highlights);
                }
                highlights
            },
        )
    }

    /// Returns how many pixels away each ray's highlight is, if it may be smaller than a pixel; see
    /// [`Footprint::highlight_distance`].
    #[inline(never)]
    pub fn highlight_distance(&self, footprint: &Footprint<L>, off: L, light_distance: L) -> L {
        L::vectorize(
            off.token(),
            #[inline(always)]
            || {
                let mut distance = off.like(L::Real::INFINITY);
                for (lanes, exponent) in &self.exponents {
                    if let Some(size) = exponent.size() {
                        let near = footprint.highlight_distance(size, off, light_distance);
                        distance = L::select(*lanes, near, distance);
                    }
                }
                distance
            },
        )
    }

    /// Returns whether a highlight may be smaller than a pixel.
    pub fn is_any_sharp(&self) -> bool {
        let mut exponents = self.exponents.iter();
        exponents.any(|(_, exponent)| exponent.size().is_some())
    }
}
