//! The colour that comes back along a ray: ambient, diffuse, specular, shadows and mirrors.

use super::hit::{Hit, Path, Primitive, is_blocked, nearest};
use super::{Ray, Rays};
use crate::lanes::{Real, Vec3};
use crate::plan::{Light, Plan, Surface};

/// The linear colour (0–1 per channel) that a camera ray brings back.
pub fn camera_color<R: Real>(plan: &Plan<R>, ray: Ray<R>, rays: &mut Rays) -> Vec3<R> {
    rays.camera += 1;
    color(
        plan,
        &Path {
            ray,
            start: Primitive::Nothing,
        },
        0,
        rays,
    )
}

fn color<R: Real>(plan: &Plan<R>, path: &Path<R>, bounces: u32, rays: &mut Rays) -> Vec3<R> {
    let Some(mut hit) = nearest(plan, path) else {
        return plan.background;
    };
    let material = &plan.materials[hit.material as usize];
    let Some(surface) = &material.surface else {
        return material.base;
    };
    let direction = path.ray.direction;
    // Both sides of everything are lit: the normal faces the viewer.
    if hit.normal.dot(direction) > R::ZERO {
        hit.normal = -hit.normal;
    }
    let mut total = material.base;
    for light in &plan.lights {
        total = total + light_color(plan, &hit, surface, light, direction, rays);
    }
    if let Some(filter) = surface.mirror.filter(|_| bounces < plan.reflection_limit) {
        // r = d - 2(d·n)n
        let twice = direction.dot(hit.normal) * (R::ONE + R::ONE);
        let mirrored = hit.leave(plan, direction - hit.normal * twice);
        rays.reflected += 1;
        total = total + filter.filter(color(plan, &mirrored, bounces + 1, rays));
    }
    total.clamp(R::ZERO, R::ONE)
}

/// What one light adds: intensity · (n·l · diffuse + (n·h)^p · specular), if nothing is between.
fn light_color<R: Real>(
    plan: &Plan<R>,
    hit: &Hit<R>,
    surface: &Surface<R>,
    light: &Light<R>,
    view: Vec3<R>,
    rays: &mut Rays,
) -> Vec3<R> {
    let dark = Vec3::splat(R::ZERO);
    let to_light = light.position - hit.point;
    // A light in the surface has no direction: it adds nothing.
    let Some(l) = to_light.unit() else {
        return dark;
    };
    let cosine = hit.normal.dot(l);
    let faces_the_light = cosine > R::ZERO;
    if !faces_the_light {
        return dark;
    }
    let path = hit.leave(plan, l);
    rays.shadow += 1;
    if is_blocked(plan, &path, (light.position - path.ray.origin).length()) {
        return dark;
    }
    let matte = surface.diffuse * cosine;
    // Light from straight behind the eye's direction has no half-vector: no highlight.
    let highlight = match (l - view).unit() {
        None => dark,
        Some(h) => {
            let off_peak = hit.normal - h;
            let half_square = off_peak.dot(off_peak) * R::from_f64(0.5);
            surface.specular * surface.exponent.power(hit.normal.dot(h), half_square)
        }
    };
    (matte + highlight) * light.intensity
}
