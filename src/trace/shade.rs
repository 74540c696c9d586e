//! The colours that come back along rays: ambient, diffuse, specular, shadows and mirrors.
//!
//! Rays that travel in step may hit different things: each kind is lit, and each material coloured, for its own rays.

use super::candidates::{Candidates, Targets};
use super::cull::LightCandidates;
use super::doubt::{Doubt, DoubtScope, HitError, Uncertainty, is_filtered};
use super::footprint::Footprint;
use super::hit_material::HitMaterial;
use super::intersect::{Blocked, Kernel};
use super::mirrored::Mirrored;
use super::mixed_materials::{ArrivingLight, MixedMaterials};
use super::packet::{EdgeInfo, Packet};
use super::paths::{IgnoredPrimitive, NO_PRIMITIVE, Paths};
use super::shadows::light_bit;
use super::stats::Rays;
use super::surface::Hit;
use super::thin::ThinQuery;
use super::thresholds::EDGE_CONTRAST;
use super::walk::Stack;
use crate::plan::{PointLight, Show};
use crate::primitive::Blur;
use crate::simd::{Mask as _, SimdFloat, Vec3};

/// Shades packets.
pub struct Shader<'a, L: SimdFloat, const TREE: bool> {
    /// SIMD token and plan.
    pub kernel: Kernel<'a, L, TREE>,
    /// Whether the rays come from the camera.
    pub is_first: bool,
    /// Whether mirrors reflect rays.
    pub may_mirror: bool,
    /// Whether to look for things that may slip between samples.
    pub looks_for_thin: bool,
    /// Things that rays may hit or narrowly miss, and that may slip between samples.
    pub thin: &'a Candidates,
    /// For each light, what may block it.
    pub lights: &'a [LightCandidates],
    /// The same, if there may be gaps between two shadows, and these are looked for.
    pub gap_lights: Option<&'a [LightCandidates]>,
}

/// What is noted of a packet, if it is wanted: its edges and its uncertainty.
pub type Notes<'a, L> = (Option<&'a mut EdgeInfo<L>>, Option<&'a mut Uncertainty<L>>);

/// The hits of one packet on one primitive, or on several of a kind.
struct ShadingPoint<'a, L: SimdFloat> {
    hit: Hit<L>,
    material: HitMaterial<'a, L>,
    /// The directions of the rays.
    view: Vec3<L>,
    /// How large a pixel is at the hits, if edges are noted.
    footprint: Option<Footprint<L>>,
    /// How far the hits may be off, if doubts are noted.
    error: Option<HitError<L>>,
}

/// One of the plan's lights.
struct LightSource<'a, R> {
    index: usize,
    light: &'a PointLight<R>,
    candidates: &'a LightCandidates,
}

impl<L: SimdFloat, const TREE: bool> Shader<'_, L, TREE> {
    /// Returns whether rays look beside themselves for one of these thin things.
    #[inline(always)]
    fn looks_for(&self, thin: &Candidates) -> bool {
        self.looks_for_thin && !thin.is_empty()
    }

    /// Colours what the packet has hit, and notes its edges if they are wanted. Returns the rays that mirrors
    /// reflect.
    #[inline(always)]
    pub fn shade(
        &self,
        packet: &mut Packet<L>,
        (ignored, (mut edge, uncertainty)): (IgnoredPrimitive<L>, Notes<L>),
        mixed: &mut MixedMaterials<L>,
        (stack, rays): (&mut Stack<L::Real>, &mut Rays),
    ) -> Option<Mirrored<L>> {
        let kernel = self.kernel;
        let mut uncertainty = uncertainty.filter(|_| is_filtered::<L, TREE>());
        let mut mirrored: Option<Mirrored<L>> = None;
        // What is in doubt is traced again: nothing more is needed of it.
        let certain = match &uncertainty {
            Some(uncertainty) => packet.active & !uncertainty.doubt,
            None => packet.active,
        };
        if let Some(edge) = edge.as_mut().filter(|_| self.looks_for(self.thin)) {
            let paths = Paths {
                rays: packet.rays,
                ignored,
            };
            let query = ThinQuery {
                paths: &paths,
                active: certain,
                cone: edge.cone,
                in_meshes: edge.cone.widening(),
                spread: edge.cone.spread,
                reach: packet.nearest.t,
                is_to_light: false,
            };
            edge.thin_distance = kernel.thin_distance(self.thin, &query, stack);
        }

        // One turn for each primitive that was hit, for all rays that have hit it or others of its kind.
        let nothing = kernel.splat(NO_PRIMITIVE);
        let mut remaining = (nothing.less(packet.nearest.number) & certain).bits();
        while remaining != 0 {
            let mut hit = kernel.refine(&packet.rays, &packet.nearest, remaining, mixed);
            remaining &= !hit.lanes.bits();
            let stand_in = self.stand_in(packet, &hit);
            let Some(material) = self.material(packet, &mut hit, (stand_in, certain), mixed) else {
                continue;
            };
            let mut point = self.shading_point(packet, hit, material, (&edge, &uncertainty));
            if let Some(uncertainty) = uncertainty.as_deref_mut() {
                self.doubt_mirrors(&point, uncertainty);
                point.hit.lanes = point.hit.lanes & !uncertainty.doubt;
            }
            if stand_in.is_none() {
                let mut arriving = ArrivingLight {
                    matte: kernel.splat(0.0),
                    highlight: kernel.splat(0.0),
                    doubt: nothing.less(nothing),
                };
                for (index, light) in kernel.plan.lights.iter().enumerate() {
                    let light = LightSource {
                        index,
                        light,
                        candidates: &self.lights[index],
                    };
                    let edge = edge.as_deref_mut();
                    self.add_light(edge, &point, &light, &mut arriving, (stack, rays));
                }
                if let Some(uncertainty) = &mut uncertainty {
                    uncertainty.doubt = uncertainty.doubt | arriving.doubt;
                }
                if let (Some(lights), Some(edge)) = (self.gap_lights, &mut edge)
                    && let Some(footprint) = point.footprint
                {
                    let (hit, lit) = (point.hit, edge.lit);
                    let (at, view) = ((&hit, &footprint), (point.material, point.view));
                    edge.shadows = edge.shadows + kernel.shadows_at(lights, at, view, lit, stack);
                }
                match point.material {
                    HitMaterial::One(surface) => {
                        let color = packet.color + arriving.color(surface, kernel.plan.show);
                        packet.color = Vec3::select(point.hit.lanes, color, packet.color);
                    }
                    HitMaterial::Several(mixed) => {
                        mixed.color(kernel.plan, &arriving, &mut packet.color);
                    }
                }
            }
            if self.may_mirror
                && let Some(mirrors) = self.mirrors(&point)
            {
                let reflected = self.mirror(&point, mirrors);
                mirrored = Some(reflected.merged_with(mirrored));
            }
        }
        if kernel.plan.show == Show::Mirrors && self.is_first {
            let dark = Vec3::splat(kernel.splat(0.0));
            let met = nothing.less(packet.nearest.number);
            packet.color = Vec3::select(met, packet.color, dark);
        }
        if let (Some(mirrored), Some(uncertainty)) = (&mut mirrored, uncertainty) {
            mirrored.active = mirrored.active & !uncertainty.doubt;
        }
        mirrored.filter(|mirrored| mirrored.active.any())
    }

    /// Returns the colour to show instead of the light of a surface; `None` if that is shown.
    #[inline(always)]
    fn stand_in(&self, packet: &Packet<L>, hit: &Hit<L>) -> Option<Vec3<L>> {
        let kernel = self.kernel;
        match kernel.plan.show {
            Show::Mirrors if self.is_first => Some(Vec3::splat(kernel.splat(0.0))),
            Show::Light | Show::Shadows(_) | Show::Mirrors | Show::Cost | Show::Retraced => None,
            Show::Normals => {
                let normal = hit.surface.normal;
                let half = kernel.splat(0.5);
                let away = kernel.splat(0.0).less(normal.dot(packet.rays.direction));
                let normal = Vec3::select(away, -normal, normal);
                Some(normal * half + Vec3::splat(half))
            }
            Show::Depth {
                nearest,
                per_length,
            } => {
                let t = packet.nearest.t;
                let depth = (t - t.like(nearest)) * t.like(per_length);
                Some(Vec3::splat(kernel.splat(1.0) - depth))
            }
        }
    }

    /// Returns the hits with the footprint of a pixel. Both sides are lit: normals are turned to the viewer.
    #[inline(always)]
    fn shading_point<'a>(
        &self,
        packet: &Packet<L>,
        mut hit: Hit<L>,
        material: HitMaterial<'a, L>,
        (edge, uncertainty): (&Option<&mut EdgeInfo<L>>, &Option<&mut Uncertainty<L>>),
    ) -> ShadingPoint<'a, L> {
        let view = packet.rays.direction;
        let normal = hit.surface.normal;
        let along = normal.dot(view);
        let away = self.kernel.splat(0.0).less(along);
        hit.surface.normal = Vec3::select(away, -normal, normal);
        let error = match uncertainty {
            Some(rays) => Some(HitError::new(rays, (packet.nearest.t, along), &hit.surface)),
            None => None,
        };
        let footprint = match edge {
            Some(edge) => {
                let (cone, t) = (edge.cone, packet.nearest.t);
                let cosine = hit.surface.normal.dot(view);
                let at = (cosine, cone.width_at(t));
                let at = (t, cosine, self.kernel.grazing(packet.nearest.number, at));
                Some(Footprint::new(cone, at, hit.surface.curvature))
            }
            None => None,
        };
        ShadingPoint {
            hit,
            material,
            view,
            footprint,
            error,
        }
    }

    /// Returns the material of the hits, and keeps those that respond to light; `None` if none does. The packet gets
    /// the colours that they have without light, or `stand_in` if given.
    #[inline(always)]
    fn material<'a>(
        &'a self,
        packet: &mut Packet<L>,
        hit: &mut Hit<L>,
        (stand_in, certain): (Option<Vec3<L>>, L::Mask),
        mixed: &'a mut MixedMaterials<L>,
    ) -> Option<HitMaterial<'a, L>> {
        let materials = &self.kernel.plan.materials[..];
        if TREE && hit.is_mixed {
            hit.lanes = mixed.set_base(materials, stand_in, &mut packet.color)?;
            return Some(HitMaterial::Several(mixed));
        }
        let material = &materials[hit.material as usize];
        let color = stand_in.unwrap_or(Vec3::broadcast(self.kernel.token, material.base));
        hit.lanes = hit.lanes & certain;
        packet.color = Vec3::select(hit.lanes, color, packet.color);
        material.surface.as_ref().map(HitMaterial::One)
    }

    /// Returns where there are mirrors, and the factors that their images are multiplied by.
    #[inline(always)]
    fn mirrors(&self, point: &ShadingPoint<L>) -> Option<(L::Mask, Vec3<L>)> {
        match point.material {
            HitMaterial::One(surface) => {
                let filter = Vec3::broadcast(self.kernel.token, surface.mirror?);
                Some((point.hit.lanes, filter))
            }
            HitMaterial::Several(mixed) => mixed.mirror(self.kernel.plan, self.kernel.splat(0.0)),
        }
    }

    /// Notes the uncertainty of the rays that mirrors will reflect.
    #[inline(always)]
    fn doubt_mirrors(&self, point: &ShadingPoint<L>, uncertainty: &mut Uncertainty<L>) {
        if self.may_mirror
            && let Some(error) = &point.error
            && let Some((active, filter)) = self.mirrors(point)
        {
            let share = filter.x.max(filter.y).max(filter.z);
            error.note_reflection((active, share), uncertainty);
        }
    }

    /// r = d - 2(d·n)n, the direction of perfect reflection; Whitted, "An improved illumination model
    /// for shaded display", CACM 23(6), 1980.
    #[inline(always)]
    fn mirror(&self, point: &ShadingPoint<L>, (active, filter): (L::Mask, Vec3<L>)) -> Mirrored<L> {
        let normal = point.hit.surface.normal;
        let along = point.view.dot(normal);
        let direction = point.view - normal * (along + along);
        Mirrored {
            active,
            filter,
            paths: self.kernel.spawn(&point.hit, direction),
            cone: point.footprint.as_ref().map(Footprint::mirrored),
        }
    }

    /// Adds the light of one source: intensity · n·l and intensity · (n·h)^p, if nothing blocks it.
    ///
    /// Blinn, "Models of light reflection for computer synthesized pictures", SIGGRAPH 1977, with h halfway between
    /// the directions to the light and to the viewer.
    #[inline(always)]
    fn add_light(
        &self,
        edge: Option<&mut EdgeInfo<L>>,
        point: &ShadingPoint<L>,
        source: &LightSource<L::Real>,
        arriving: &mut ArrivingLight<L>,
        (stack, rays): (&mut Stack<L::Real>, &mut Rays),
    ) {
        let (kernel, hit) = (self.kernel, &point.hit);
        let (light, candidates) = (source.light, source.candidates);
        let (zero, one) = (kernel.splat(0.0), kernel.splat(1.0));

        // A light in the surface has no direction: NaN is not above zero, and it adds nothing. Nor does one
        // that is no higher above the surface than rounding may have lifted it.
        let to_light = hit.surface.point.like(light.position) - hit.surface.point;
        let distance = to_light.length();
        let shrink = one / distance;
        let l = to_light * shrink;
        let cosine = hit.surface.normal.dot(l);
        let lowest = if light.may_be_in_plane {
            kernel.min_lit_cosine(light, (l, distance), shrink)
        } else {
            zero
        };
        let lit_side = hit.lanes & lowest.less(cosine);
        let facing = if kernel.plan.shadows_behind {
            hit.lanes
        } else {
            lit_side
        };
        if let Some(error) = &point.error {
            // Also if nothing was found that may block it: what is found depends on the neighbouring rays.
            let mut doubt = facing & error.is_lost;
            if !light.may_be_on_surface {
                let shiny = point.material.shiny(hit.lanes);
                doubt =
                    doubt | cosine.abs().at_most(lowest) | error.grazes((cosine, shrink), shiny);
            }
            arriving.doubt = arriving.doubt | hit.lanes & doubt;
        }
        if !facing.any() {
            return;
        }

        // Shadows: what blocks the light, and thin things that narrowly miss the way to it.
        rays.shadow += u64::from(facing.bits().count_ones());
        let mut edge = edge.zip(point.footprint.as_ref());
        let mut lit = lit_side;
        if !candidates.casters.is_empty() || !candidates.thin.is_empty() {
            let (paths, reach) = kernel.towards(hit, light, (l, distance));
            let looks_for_thin = self.looks_for(&candidates.thin);
            let thin_search = edge.as_mut().filter(|_| looks_for_thin);
            let mut thin_width = None;
            if let Some((_, footprint)) = &thin_search {
                thin_width = Some(footprint.thin_width());
            }
            if candidates.is_umbra && thin_width.is_none() {
                return;
            }
            let shadow_query = (&paths, (reach, shrink), facing, thin_width);
            let blocked = self.shadow(point, source, shadow_query, (arriving, stack));
            if let Some((edge, footprint)) = thin_search {
                // Within the shadow of something wide, that of something thin is not visible.
                let unshadowed = facing & !blocked.by_thick;
                // If the light itself is not visible there, its shadow is not either.
                let brightness = point.material.brightness(kernel.plan, zero);
                let brightest = brightness * zero.like(light.edge_intensity);
                let mut visible = kernel.splat(EDGE_CONTRAST).less(cosine * brightest);
                let dim = unshadowed & lit_side & !visible;
                if dim.any() {
                    let vectors = (cosine, hit.surface.normal, l - point.view);
                    visible = visible | dim & point.material.shows(kernel.plan, light, vectors);
                }
                let query = ThinQuery {
                    paths: &paths,
                    active: unshadowed & visible,
                    cone: footprint.shadow(distance),
                    in_meshes: footprint.shadow_in_meshes(),
                    spread: footprint.spread(),
                    reach,
                    is_to_light: true,
                };
                let near = kernel.thin_distance(&candidates.thin, &query, stack);
                edge.thin_distance = near.min(edge.thin_distance);
            }
            lit = lit & !blocked.anywhere;
            if !lit.any() {
                return;
            }
        }

        if let Show::Shadows(share) = kernel.plan.show {
            let lighter = arriving.matte + distance.like(share);
            arriving.matte = L::select(lit, lighter, arriving.matte);
            return;
        }

        let intensity = distance.like(light.intensity);
        let matte = arriving.matte + cosine * intensity;
        arriving.matte = L::select(lit, matte, arriving.matte);
        let (normal, half) = (hit.surface.normal, l - point.view);
        if let Some(highlight) = point.material.highlight(normal, half) {
            let highlight = arriving.highlight + highlight * intensity;
            arriving.highlight = L::select(lit, highlight, arriving.highlight);
        }
        if let Some((edge, footprint)) = edge {
            let bit = kernel.splat(light_bit(source.index));
            edge.lit = L::select(lit, edge.lit + bit, edge.lit);
            if point.material.is_sharp() {
                let off = (normal - half * (one / half.length())).length();
                let near = point.material.highlight_distance(footprint, off, distance);
                edge.thin_distance =
                    L::select(lit, near.min(edge.thin_distance), edge.thin_distance);
            }
        }
    }

    /// Finds what stands between hits and a light, see [`Kernel::blocked`], and notes where that is in doubt.
    #[inline(always)]
    fn shadow(
        &self,
        point: &ShadingPoint<L>,
        source: &LightSource<L::Real>,
        (paths, (reach, shrink), facing, thin_width): (&Paths<L>, (L, L), L::Mask, Option<L>),
        (arriving, stack): (&mut ArrivingLight<L>, &mut Stack<L::Real>),
    ) -> Blocked<L> {
        let (kernel, light) = (self.kernel, source.light);
        let targets = Targets {
            candidates: &source.candidates.casters,
            entry_points: &source.candidates.entry_points,
            light: Some(light),
            culled_faces: &light.culled_faces,
        };
        let blur = match &point.error {
            None => Blur::splat(kernel.token, Blur::NONE),
            Some(error) => error.blur_to_light((reach, shrink)),
        };
        // The surface that a light is on does not block it.
        let scope = DoubtScope::of(point.error.is_some(), !light.may_be_on_surface);
        let doubt = Doubt::new(blur, scope);
        let wanted = (reach, facing, thin_width);
        let blocked = kernel.blocked(targets, (paths, doubt), wanted, stack);
        if point.error.is_some() {
            arriving.doubt = arriving.doubt | facing & blocked.doubt;
        }
        blocked
    }
}
