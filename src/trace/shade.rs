//! The colours that come back along rays: ambient, diffuse, specular, shadows and mirrors.
//!
//! Rays that travel in step may hit different things: each thing that was hit is shaded for its own
//! rays, and the results are put together.

use super::cull::{Candidates, LightCandidates};
use super::hit::{Hit, NOTHING, Paths, Start, blocked, refine};
use super::mesh::EDGE_CONTRAST;
use super::packet::{Mark, Packet, RayCone};
use super::thin::{Footprint, thin_distance};
use super::{Ray, Rays};
use crate::plan::{Plan, PointLight, RayOrigin, Surface};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// How packets are painted.
pub struct Shader<'a, L: SimdFloat> {
    /// The lanes.
    pub token: L::Token,
    /// The plan.
    pub plan: &'a Plan<L::Real>,
    /// Whether mirrors send rays on.
    pub may_mirror: bool,
}

/// Rays that a mirror sends on.
pub struct Mirrored<L: SimdFloat> {
    /// Where there are some.
    pub where_: L::Mask,
    /// What their colours are multiplied by.
    pub filter: Vec3<L>,
    /// The rays.
    pub paths: Paths<L>,
    /// How wide a pixel is along them, where marks are wanted.
    pub trail: Option<RayCone<L>>,
}

/// The hits on one primitive.
struct Spot<'a, L: SimdFloat> {
    hit: Hit<L>,
    surface: &'a Surface<L::Real>,
    /// The rays that made them.
    here: L::Mask,
    /// Where those came from.
    view: Vec3<L>,
    /// How large a pixel is here, where marks are wanted.
    footprint: Option<Footprint<L>>,
}

impl<L: SimdFloat> Shader<'_, L> {
    /// Colours what the packet has met, and marks it if a mark is wanted, by what is `thin`. Gives the
    /// rays that mirrors send on.
    #[inline(always)]
    pub fn paint(
        &self,
        packet: &mut Packet<L>,
        start: Start<L>,
        mut mark: Option<&mut Mark<L>>,
        thin: &Candidates,
        shadows: &[LightCandidates],
        rays: &mut Rays,
    ) -> Option<Mirrored<L>> {
        let (token, plan) = (self.token, self.plan);
        let mut mirrored: Option<Mirrored<L>> = None;
        if let Some(mark) = &mut mark {
            let paths = Paths {
                rays: packet.rays,
                start,
            };
            mark.near = thin_distance(token, plan, thin, &paths, mark.trail, packet.near.t);
        }
        let nothing = L::splat(token, L::Real::from_f64(NOTHING));
        let mut left = (nothing.less(packet.near.number) & packet.active).bits();
        while left != 0 {
            let number = packet.near.number.lane(left.trailing_zeros() as usize);
            let here = packet.near.number.same(L::splat(token, number)) & packet.active;
            left &= !here.bits();
            let mut hit = refine(token, plan, &packet.rays, packet.near.t, number);
            let material = &plan.materials[hit.material as usize];
            let mut color = Vec3::broadcast(token, material.base);
            if let Some(surface) = &material.surface {
                let view = packet.rays.direction;
                // Both sides of everything are lit: the normal faces the viewer.
                let away = L::splat(token, L::Real::ZERO).less(hit.normal.dot(view));
                hit.normal = Vec3::select(away, -hit.normal, hit.normal);
                let footprint = match &mark {
                    None => None,
                    Some(mark) => {
                        let cosine = hit.normal.dot(view);
                        Some(Footprint::new(
                            token,
                            mark.trail,
                            packet.near.t,
                            cosine,
                            hit.radius,
                        ))
                    }
                };
                let spot = Spot {
                    hit,
                    surface,
                    here,
                    view,
                    footprint,
                };
                for (index, (light, shadows)) in plan.lights.iter().zip(shadows).enumerate() {
                    color =
                        color + self.light(mark.as_deref_mut(), &spot, index, light, shadows, rays);
                }
                if let Some(filter) = surface.mirror.filter(|_| self.may_mirror) {
                    mirrored = Some(join(token, mirrored, self.mirror(&spot, filter)));
                }
            }
            packet.color = Vec3::select(here, color, packet.color);
        }
        mirrored
    }

    /// r = d - 2(d·n)n
    #[inline(always)]
    fn mirror(&self, spot: &Spot<L>, filter: Vec3<L::Real>) -> Mirrored<L> {
        let along = spot.view.dot(spot.hit.normal);
        let direction = spot.view - spot.hit.normal * (along + along);
        let paths = spot.hit.leave(self.token, self.plan.departure, direction);
        Mirrored {
            where_: spot.here,
            filter: Vec3::broadcast(self.token, filter),
            paths,
            trail: spot.footprint.as_ref().map(Footprint::mirrored),
        }
    }

    /// What one light adds: intensity · (n·l · diffuse + (n·h)^p · specular), if nothing is between.
    #[inline(always)]
    fn light(
        &self,
        mark: Option<&mut Mark<L>>,
        spot: &Spot<L>,
        index: usize,
        light: &PointLight<L::Real>,
        shadows: &LightCandidates,
        rays: &mut Rays,
    ) -> Vec3<L> {
        let (token, plan, hit) = (self.token, self.plan, &spot.hit);
        let zero = L::splat(token, L::Real::ZERO);
        let one = L::splat(token, L::Real::ONE);
        let dark = Vec3::splat(zero);
        let to_light = Vec3::broadcast(token, light.position) - hit.point;
        let distance = to_light.length();
        // A light in the surface has no direction: NaN is not above zero, and it adds nothing.
        let l = to_light * (one / distance);
        let cosine = hit.normal.dot(l);
        let lit_side = spot.here & zero.less(cosine);
        let facing = if plan.shadows_behind {
            spot.here
        } else {
            lit_side
        };
        if !facing.any() {
            return dark;
        }
        rays.shadow += u64::from(facing.bits().count_ones());
        let mut mark = mark.zip(spot.footprint.as_ref());
        let mut lit = lit_side;
        if !shadows.casters.is_empty() {
            let paths = hit.leave(token, plan.departure, l);
            let reach = match plan.departure {
                RayOrigin::AtHit | RayOrigin::Roundings => distance,
                RayOrigin::Along(start) => distance - L::splat(token, start),
            };
            if let Some((mark, footprint)) = &mut mark {
                let trail = footprint.shadow(token);
                let near = thin_distance(token, plan, &shadows.thin, &paths, trail, reach);
                // Of light that nobody sees, the shadow is not seen either.
                let diffuse = spot.surface.diffuse;
                let brightest = (diffuse.x + diffuse.y + diffuse.z) * light.intensity;
                let visible = L::splat(token, L::Real::from_f64(EDGE_CONTRAST))
                    .less(cosine * L::splat(token, brightest));
                mark.near = L::select(facing & visible, near.min(mark.near), mark.near);
            }
            if shadows.is_umbra {
                return dark;
            }
            lit = lit & !blocked(token, plan, &shadows.casters, &paths, reach, facing);
            if !lit.any() {
                return dark;
            }
        }
        let matte = Vec3::broadcast(token, spot.surface.diffuse) * cosine;
        let exponent = spot.surface.exponent;
        let half = l - spot.view;
        let highlight = exponent.highlight(token, hit.normal, half);
        let color = matte + Vec3::broadcast(token, spot.surface.specular) * highlight;
        if let Some((mark, footprint)) = mark {
            let bit = L::splat(
                token,
                L::Real::from_f64(f64::from(1_u32 << (index % LIGHT_BITS))),
            );
            mark.lit = L::select(lit, mark.lit + bit, mark.lit);
            if let Some(size) = exponent.size() {
                let off = (hit.normal - half * (one / half.length())).length();
                let near = footprint.highlight_distance(token, size, off, distance);
                mark.near = L::select(lit, near.min(mark.near), mark.near);
            }
        }
        Vec3::select(lit, color * L::splat(token, light.intensity), dark)
    }
}

/// Lights that a mark tells apart: sums of so many powers of two are exact in any real type.
const LIGHT_BITS: usize = 20;

/// Puts the rays of several mirrors into one row.
#[inline(always)]
fn join<L: SimdFloat>(
    token: L::Token,
    before: Option<Mirrored<L>>,
    new: Mirrored<L>,
) -> Mirrored<L> {
    let Some(before) = before else { return new };
    let is_new = new.where_;
    let rays = Ray {
        origin: Vec3::select(is_new, new.paths.rays.origin, before.paths.rays.origin),
        direction: Vec3::select(
            is_new,
            new.paths.rays.direction,
            before.paths.rays.direction,
        ),
    };
    let start = new.paths.start.over(token, is_new, before.paths.start);
    Mirrored {
        where_: before.where_ | is_new,
        filter: Vec3::select(is_new, new.filter, before.filter),
        paths: Paths { rays, start },
        trail: match (new.trail, before.trail) {
            (Some(new), Some(before)) => Some(RayCone {
                width: L::select(is_new, new.width, before.width),
                spread: L::select(is_new, new.spread, before.spread),
            }),
            _ => None,
        },
    }
}
