//! Ray against sphere.

use super::ball::Ball;
use super::blur::Blur;
use super::bounding_box::BoundingBox;
use super::kind::{Approach, Packing, Primitive, SurfacePoint};
use super::projector::{Projector, Rectangle};
use super::ray::Ray;
use crate::scene::{Methods, Sphere, SphereMethod};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub struct PackedSphere<R> {
    /// The centre.
    pub center: Vec3<R>,
    /// > 0.
    pub radius: R,
    /// Index of its material.
    pub material: u32,
}

/// Part of its radius within which a sphere counts as flat: it turns by as many radians there. With it, shadows at
/// the horizon are found where a sphere of the size of the Earth is the ground.
const FLAT_PART: f64 = 1.0 / 64.0;

/// Distances along the ray to where its line enters and leaves a sphere; NaN if it misses.
type Roots<L> = (L, L);

/// What is needed of a sphere where it is hit; each ray may have a different sphere.
#[derive(Clone, Copy, Debug)]
pub struct Round<L: SimdFloat> {
    /// The centre.
    pub center: Vec3<L>,
    /// > 0.
    pub radius: L,
    /// One over the radius.
    pub curvature: L,
}

impl<L: SimdFloat> Round<L> {
    /// Refines the hits at distance `t` onto the surface.
    #[inline(always)]
    pub fn refine(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let Self {
            center,
            radius,
            curvature,
        } = *self;
        let outwards = rays.at(t) - center;
        // 1/|p - c| by one step of Newton's method from 1/R, which is close to it.
        let approximate = outwards * curvature;
        let correction = t.like_f64(1.5) - approximate.dot(approximate) * t.like_f64(0.5);
        let normal = approximate * correction;
        SurfacePoint {
            point: center + normal * radius,
            normal,
            curvature,
            slack: t.like(L::Real::ZERO),
            size: center.max_abs() + radius,
        }
    }
}

impl<R: Real> Primitive<R> for PackedSphere<R> {
    type Description = Sphere;
    type Prepared<L: SimdFloat<Real = R>> = ();
    const IS_CURVED: bool = true;

    fn pack(description: &Sphere, material: u32, packing: &Packing) -> Option<Self> {
        Some(Self {
            center: Vec3::from_dvec3(description.center - packing.centre),
            radius: R::from_f64(description.radius),
            material,
        })
    }

    fn rectangle(description: &Sphere, projector: &Projector) -> Option<Rectangle> {
        Some(projector.ball(description.center, description.radius))
    }

    fn ball(&self) -> Option<Ball> {
        Some(Ball {
            center: self.center.to_dvec3(),
            radius: self.radius.to_f64(),
        })
    }

    fn bounds(&self) -> Option<BoundingBox<R>> {
        Some(BoundingBox::around_ball(self.center, self.radius))
    }

    fn flat(&self) -> Option<(Vec3<R>, R)> {
        Some((Vec3::splat(R::ZERO), self.radius * R::from_f64(FLAT_PART)))
    }

    fn material(&self) -> u32 {
        self.material
    }

    fn thickness(&self) -> R {
        self.radius + self.radius
    }

    fn reach(&self) -> (Vec3<R>, R) {
        (self.center, self.radius)
    }

    #[inline(always)]
    fn prepare<L: SimdFloat<Real = R>>(_directions: Vec3<L>) {}

    #[inline(always)]
    fn intersect<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, (): &(), methods: &Methods) -> L {
        let x = rays.origin - rays.origin.like(self.center);
        let radius = x.x.like(self.radius);
        let (near, far) = match methods.sphere {
            SphereMethod::Stable => stable(x, rays.direction, radius),
            SphereMethod::Classic => classic(x, rays.direction, radius),
        };
        first_ahead(near, far)
    }

    /// Undecided for rays that graze the sphere, where R² - |x + b·d|² is off by at most (2R + w)·w for rays that
    /// are off by w, and for rays that start on it.
    #[inline(always)]
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        (): &(),
        methods: &Methods,
        (blur, wanted): (&Blur<L>, L::Mask),
    ) -> Option<(L, L)> {
        let x = rays.origin - rays.origin.like(self.center);
        let (zero, infinity) = (x.x.like(R::ZERO), x.x.like(R::INFINITY));
        if methods.sphere == SphereMethod::Classic {
            return Some((self.intersect(rays, &(), methods), infinity));
        }
        let radius = x.x.like(self.radius);
        let (b, inside) = perpendicular(x, rays.direction, radius);
        let square_of = |width: L| width * (radius + radius + width);
        // Rays that come near the sphere can hit it only within a radius of the distance `b`.
        let width = blur.around(b.abs(), radius);
        let bound = square_of(width);
        let passes_by = inside.less(-bound);
        if !(wanted & !passes_by).any() {
            return None;
        }
        let half_chord = inside.sqrt();
        let distance = first_ahead(b - half_chord, b + half_chord);
        let grazes = inside.abs().at_most(bound);
        let starts_on_it = (b * b - inside).abs().at_most(square_of(blur.at(radius))) & !passes_by;
        if !(wanted & (grazes | starts_on_it)).any() {
            return Some((distance, infinity));
        }
        let around = BoundingBox::around_ball(self.center, self.radius);
        let entry = around.entry(rays, width);
        let undecided_from = L::select(grazes, entry, infinity);
        Some((distance, L::select(starts_on_it, zero, undecided_from)))
    }

    /// t = -2·d·(p - c), or infinity. The root at t = 0 is the start itself and never counts, however
    /// it is rounded.
    #[inline(always)]
    fn exit<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>) -> L {
        let outwards = rays.origin - rays.origin.like(self.center);
        let half = -rays.direction.dot(outwards);
        let zero = half.like(R::ZERO);
        L::select(zero.less(half), half + half, half.like(R::INFINITY))
    }

    /// p = c + (p - c)·R/|p - c|: the point is then off by a few roundings of R, whatever the length of the ray.
    /// The normal points outwards.
    #[inline(always)]
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let round = Round {
            center: rays.origin.like(self.center),
            radius: t.like(self.radius),
            curvature: t.like(R::ONE / self.radius),
        };
        round.refine(rays, t)
    }

    #[inline(always)]
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        (): &(),
        _matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>> {
        let x = rays.origin - rays.origin.like(self.center);
        let along = -rays.direction.dot(x);
        let distance = (x + rays.direction * along).length();
        Some(Approach {
            from: along,
            to: along,
            distance: distance - along.like(self.radius),
            size: along.like(self.thickness()),
        })
    }

    /// A sphere begins before its centre.
    #[inline(always)]
    fn margin<L: SimdFloat<Real = R>>(&self, width: L) -> L {
        width.like(self.thickness())
    }
}

/// The roots by the discriminant R² - |x + b·d|² with b = -d·x: the square of the ray's distance from the centre is
/// not a difference of large numbers. Needs |d| = 1.
///
/// Haines, Günther and Akenine-Möller, "Precision improvements for ray/sphere intersection", Ray
/// Tracing Gems (2019), ch. 7.
#[inline(always)]
fn stable<L: SimdFloat>(x: Vec3<L>, d: Vec3<L>, radius: L) -> Roots<L> {
    let (b, inside) = perpendicular(x, d, radius);
    let half_chord = inside.sqrt();
    (b - half_chord, b + half_chord)
}

/// The distance b = -d·x along the ray to the point nearest to the centre, and the discriminant R² - |x + b·d|²,
/// which is negative for a miss.
#[inline(always)]
fn perpendicular<L: SimdFloat>(x: Vec3<L>, d: Vec3<L>, radius: L) -> (L, L) {
    let b = -d.dot(x);
    let perpendicular = x + d * b;
    (b, radius * radius - perpendicular.dot(perpendicular))
}

/// The smaller positive root; infinity if there is none.
#[inline(always)]
fn first_ahead<L: SimdFloat>(near: L, far: L) -> L {
    let zero = near.like(L::Real::ZERO);
    let behind = L::select(zero.less(far), far, near.like(L::Real::INFINITY));
    L::select(zero.less(near), near, behind)
}

/// t = -d·x ± √((d·x)² - x·x + R²), the formula of the original program. Needs |d| = 1; loses all
/// digits of R² when the centre is more than 4096 radii away (single precision).
#[inline(always)]
fn classic<L: SimdFloat>(x: Vec3<L>, d: Vec3<L>, radius: L) -> Roots<L> {
    let dx = d.dot(x);
    let half_chord = (dx * dx - x.dot(x) + radius * radius).sqrt();
    (-dx - half_chord, -dx + half_chord)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    /// A ray from `ratio` radii away past a unit sphere at `miss` radii from its centre, turned by three angles so
    /// that no axis is special; and the exact entry distance.
    fn aimed(ratio: f64, miss: f64, turn: [f64; 3]) -> (Ray<f32>, PackedSphere<f32>, f64) {
        let d = DVec3::new(
            turn[0].cos() * turn[1].cos(),
            turn[1].sin(),
            turn[0].sin() * turn[1].cos(),
        );
        let side = d
            .cross(DVec3::new(turn[2].cos(), 0.3, turn[2].sin()))
            .try_normalize()
            .expect("not along d");
        let center = d * ratio + side * miss;
        let sphere = PackedSphere {
            center: Vec3::from_dvec3(center),
            radius: 1.0_f32,
            material: 0,
        };
        let ray = Ray {
            origin: Vec3::splat(0.0_f32),
            direction: Vec3::from_dvec3(d),
        };
        // The exact result for the rounded numbers that the kernel gets.
        let (c, d) = (
            sphere.center.to_dvec3(),
            ray.direction.to_dvec3().try_normalize().expect("unit"),
        );
        let b = d.dot(c);
        let across = c - d * b;
        let t = b - (1.0 - across.dot(across)).max(0.0).sqrt();
        (ray, sphere, t)
    }

    fn intersect(sphere: SphereMethod, ray: &Ray<f32>, target: &PackedSphere<f32>) -> f32 {
        let methods = Methods {
            sphere,
            ..Methods::default()
        };
        target.intersect_single(ray, &methods)
    }

    fn refined(ray: &Ray<f32>, sphere: &PackedSphere<f32>, t: f32) -> (Vec3<f32>, Vec3<f32>) {
        let SurfacePoint { point, normal, .. } = sphere.refine(ray, t);
        (point, normal)
    }

    fn turns(n: u32) -> [f64; 3] {
        [2.4, 1.7, 0.9].map(|speed| f64::from(n) * speed)
    }

    #[test]
    fn far_spheres_are_hit_and_missed_rightly_and_the_classic_formula_is_not() {
        let wrong = |method| {
            let tries = (0..2000).flat_map(|n| [0.5, 0.9, 1.1, 1.5].map(|miss| (n, miss)));
            tries
                .filter(|&(n, miss)| {
                    let (ray, sphere, _) = aimed(4096.0, miss, turns(n));
                    intersect(method, &ray, &sphere).is_finite() != (miss < 1.0)
                })
                .count()
        };
        assert_eq!(wrong(SphereMethod::Stable), 0);
        assert!(
            wrong(SphereMethod::Classic) > 800,
            "the classic formula fails at 4096 radii"
        );
    }

    #[test]
    fn the_stable_error_grows_with_distance_only() {
        for ratio in [1.5, 10.0, 100.0, 1e3, 1e4, 1e5] {
            let mut errors: Vec<f64> = (0..4000)
                .map(|n| {
                    let miss = 0.99 * f64::from(n % 97) / 97.0;
                    let (ray, sphere, exact) = aimed(ratio, miss, turns(n));
                    (f64::from(intersect(SphereMethod::Stable, &ray, &sphere)) - exact).abs()
                })
                .collect();
            errors.sort_by(f64::total_cmp);
            let u = f64::from(f32::UNIT_ROUNDOFF);
            assert!(
                errors[3995] <= 4.0 * u * (ratio + 2.0),
                "{ratio}: {:e}",
                errors[3995]
            );
        }
    }

    #[test]
    fn a_planet_is_hit_at_the_right_height() {
        for height in [1e-1, 1e-3, 1e-5, 1e-7_f64] {
            let radius = 1e6;
            let sphere = PackedSphere {
                center: Vec3::new(0.0_f32, 0.0, 0.0),
                radius: radius as f32,
                material: 0,
            };
            let y = (radius * (1.0 + height)) as f32;
            let direction = Vec3::from_dvec3(
                DVec3::new(0.3_f64, -0.9, 0.2)
                    .try_normalize()
                    .expect("unit"),
            );
            let ray = Ray {
                origin: Vec3::new(0.0, y, 0.0),
                direction,
            };
            let t = intersect(SphereMethod::Stable, &ray, &sphere);
            let (point, normal) = refined(&ray, &sphere, t);
            let on_surface = (point.to_dvec3().length() - radius).abs() / radius;
            assert!(
                on_surface <= 4.0 * f64::from(f32::UNIT_ROUNDOFF),
                "{height}: {on_surface:e}"
            );
            assert!((f64::from(normal.length()) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_sphere_at_nan_is_missed() {
        let sphere = PackedSphere {
            center: Vec3::new(0.0, 0.0, f32::NAN),
            radius: 1.0,
            material: 0,
        };
        let ray = Ray {
            origin: Vec3::splat(0.0),
            direction: Vec3::new(0.0, 0.0, 1.0),
        };
        for method in [SphereMethod::Stable, SphereMethod::Classic] {
            assert_eq!(intersect(method, &ray, &sphere), f32::INFINITY);
        }
    }

    proptest! {
        #[test]
        fn a_refined_hit_lies_on_the_surface(ratio in 1.1..1e4_f64, miss in 0.0..0.95_f64, turn in prop::array::uniform3(0.0..6.0_f64)) {
            let (ray, sphere, _) = aimed(ratio, miss, turn);
            let t = intersect(SphereMethod::Stable, &ray, &sphere);
            prop_assert!(t.is_finite());
            let (point, normal) = refined(&ray, &sphere, t);
            let off = ((point - sphere.center).to_dvec3().length() - 1.0).abs();
            prop_assert!(off <= 4.0 * f64::from(f32::UNIT_ROUNDOFF) * (1.0 + ratio), "{off:e}");
            prop_assert!(normal.dot(ray.direction) < 1e-3, "the entry faces the ray");
        }

        #[test]
        fn a_ray_from_the_surface_hits_only_the_far_side(turn in prop::array::uniform3(0.0..6.0_f64), d in prop::array::uniform3(-1.0..1.0_f64)) {
            let Some(d) = DVec3::from(d).try_normalize() else { return Ok(()) };
            let (ray, sphere, _) = aimed(3.0, 0.2, turn);
            let (point, normal) = refined(&ray, &sphere, intersect(SphereMethod::Stable, &ray, &sphere));
            let onwards = Ray { origin: point, direction: Vec3::from_dvec3(d) };
            let t = sphere.exit(&onwards);
            prop_assert_eq!(t.is_finite(), normal.dot(onwards.direction) < 0.0);
        }
    }
}
