//! The colours that come back along rays: ambient, diffuse, specular, shadows and mirrors.
//!
//! Rays that travel in step may hit different things: each thing that was hit is shaded for its own
//! rays, and the results are put together.

use super::cull::Casters;
use super::hit::{Among, Hit, NOTHING, Nearest, Paths, blocked, nearest, refine};
use super::{Ray, Rays};
use crate::lanes::{Lane, Mask as _, Real, Vec3};
use crate::plan::{Light, Plan, RayOffset, Surface};

/// What the rays of a tile have in common.
#[derive(Clone, Copy)]
pub struct Surroundings<'a, R> {
    /// The plan.
    pub plan: &'a Plan<R>,
    /// What may cast shadows here, by light; empty where that is `everything`.
    pub casters: &'a [Casters],
    /// What may be met and cast shadows anywhere: for mirrored rays.
    pub everything: &'a Casters,
    /// All spheres and triangles, markers included.
    pub all: Among<'a>,
}

/// Rays that a mirror sends on.
struct Mirrored<L: Lane> {
    where_: L::Mask,
    filter: Vec3<L>,
    paths: Paths<L>,
}

/// The linear colours (0–1 per channel) that the rays bring back, where `active`.
#[inline(always)]
pub fn colors<L: Lane>(
    token: L::Token,
    around: Surroundings<L::Real>,
    path: &Ray<L>,
    near: Nearest<L>,
    active: L::Mask,
    bounces: u32,
    rays: &mut Rays,
) -> Vec3<L> {
    let plan = around.plan;
    let mut total = Vec3::broadcast(token, plan.background);
    let mut mirrored: Option<Mirrored<L>> = None;
    let hit = L::splat(token, L::Real::from_f64(NOTHING)).less(near.number) & active;
    let mut left = hit.bits();
    while left != 0 {
        let number = near.number.lane(left.trailing_zeros() as usize);
        let here = near.number.same(L::splat(token, number)) & active;
        left &= !here.bits();
        let mut hit = refine(token, plan, path, near.t, number);
        let material = &plan.materials[hit.material as usize];
        let mut color = Vec3::broadcast(token, material.base);
        if let Some(surface) = &material.surface {
            // Both sides of everything are lit: the normal faces the viewer.
            let away = L::splat(token, L::Real::ZERO).less(hit.normal.dot(path.direction));
            hit.normal = Vec3::select(away, -hit.normal, hit.normal);
            for (index, light) in plan.lights.iter().enumerate() {
                let among = around
                    .casters
                    .get(index)
                    .unwrap_or(around.everything)
                    .among();
                let added = light_color(
                    token,
                    plan,
                    among,
                    &hit,
                    surface,
                    light,
                    path.direction,
                    here,
                    rays,
                );
                color = color + added;
            }
            if let Some(filter) = surface.mirror.filter(|_| bounces < plan.reflection_limit) {
                let new = mirror(token, plan, &hit, path.direction, filter, here);
                mirrored = Some(join(mirrored, new));
            }
        }
        total = Vec3::select(here, color, total);
    }
    if let Some(Mirrored {
        where_,
        filter,
        paths,
    }) = mirrored
    {
        rays.reflected += u64::from(where_.bits().count_ones());
        let seen = bounce(token, around, &paths, where_, bounces + 1, rays);
        total = Vec3::select(where_, total + filter.filter(seen), total);
    }
    let (zero, one) = (
        L::splat(token, L::Real::ZERO),
        L::splat(token, L::Real::ONE),
    );
    total.clamp(zero, one)
}

/// The colours that mirrored rays bring back. A function of its own, because it calls itself
/// through [`colors`].
fn bounce<L: Lane>(
    token: L::Token,
    around: Surroundings<L::Real>,
    paths: &Paths<L>,
    active: L::Mask,
    bounces: u32,
    rays: &mut Rays,
) -> Vec3<L> {
    L::in_step(
        token,
        #[inline(always)]
        || {
            let near = nearest(token, around.plan, around.all, paths);
            let around = Surroundings {
                casters: &[],
                ..around
            };
            colors(token, around, &paths.rays, near, active, bounces, rays)
        },
    )
}

/// r = d - 2(d·n)n
#[inline(always)]
fn mirror<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    hit: &Hit<L>,
    direction: Vec3<L>,
    filter: Vec3<L::Real>,
    here: L::Mask,
) -> Mirrored<L> {
    let along = direction.dot(hit.normal);
    let paths = hit.leave(
        token,
        plan.methods.offset,
        direction - hit.normal * (along + along),
    );
    Mirrored {
        where_: here,
        filter: Vec3::broadcast(token, filter),
        paths,
    }
}

/// Puts the rays of several mirrors into one row.
#[inline(always)]
fn join<L: Lane>(before: Option<Mirrored<L>>, new: Mirrored<L>) -> Mirrored<L> {
    let Some(before) = before else { return new };
    let is_new = new.where_;
    let start = match (before.paths.start, new.paths.start) {
        (Some(old), Some(new)) => Some(L::select(is_new, new, old)),
        _ => None,
    };
    let rays = Ray {
        origin: Vec3::select(is_new, new.paths.rays.origin, before.paths.rays.origin),
        direction: Vec3::select(
            is_new,
            new.paths.rays.direction,
            before.paths.rays.direction,
        ),
    };
    Mirrored {
        where_: before.where_ | is_new,
        filter: Vec3::select(is_new, new.filter, before.filter),
        paths: Paths { rays, start },
    }
}

/// What one light adds: intensity · (n·l · diffuse + (n·h)^p · specular), if nothing is between.
#[inline(always)]
#[expect(
    clippy::too_many_arguments,
    reason = "one call site, in the loop over lights"
)]
fn light_color<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: Among,
    hit: &Hit<L>,
    surface: &Surface<L::Real>,
    light: &Light<L::Real>,
    view: Vec3<L>,
    here: L::Mask,
    rays: &mut Rays,
) -> Vec3<L> {
    let zero = L::splat(token, L::Real::ZERO);
    let one = L::splat(token, L::Real::ONE);
    let dark = Vec3::splat(zero);
    let to_light = Vec3::broadcast(token, light.position) - hit.point;
    let distance = to_light.length();
    // A light in the surface has no direction: NaN is not above zero, and it adds nothing.
    let l = to_light * (one / distance);
    let cosine = hit.normal.dot(l);
    let lit = here & zero.less(cosine);
    if !lit.any() {
        return dark;
    }
    rays.shadow += u64::from(lit.bits().count_ones());
    let paths = hit.leave(token, plan.methods.offset, l);
    let reach = match plan.methods.offset {
        RayOffset::Robust => distance,
        RayOffset::Fixed(start) => distance - L::splat(token, L::Real::from_f64(start)),
    };
    let lit = lit & !blocked(token, plan, among, &paths, reach, lit);
    if !lit.any() {
        return dark;
    }
    let matte = Vec3::broadcast(token, surface.diffuse) * cosine;
    let half = l - view;
    // Light from straight ahead has no half-vector: NaN to any power is no highlight.
    let h = half * (one / half.length());
    let off_peak = hit.normal - h;
    let half_square = off_peak.dot(off_peak) * L::splat(token, L::Real::from_f64(0.5));
    let highlight = surface
        .exponent
        .power(token, hit.normal.dot(h), half_square);
    let color = matte + Vec3::broadcast(token, surface.specular) * highlight;
    Vec3::select(lit, color * L::splat(token, light.intensity), dark)
}
