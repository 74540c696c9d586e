//! Ray against disc. Both sides are hit.

use super::ball::Ball;
use super::blur::Blur;
use super::bounding_box::BoundingBox;
use super::kind::{Approach, Packing, Primitive, SurfacePoint};
use super::projector::{Projector, Rectangle};
use super::ray::Ray;
use crate::scene::{Disc, Methods, unit};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// A flat disc: the points p with normal · (p - center) = 0 and |p - center| ≤ radius.
#[derive(Clone, Copy, Debug)]
pub struct PackedDisc<R> {
    /// The centre.
    pub center: Vec3<R>,
    /// Unit normal.
    pub normal: Vec3<R>,
    /// > 0.
    pub radius: R,
    /// Index of its material.
    pub material: u32,
}

impl<R: Real> Primitive<R> for PackedDisc<R> {
    type Description = Disc;
    type Prepared<L: SimdFloat<Real = R>> = ();

    fn pack(description: &Disc, material: u32, packing: &Packing) -> Option<Self> {
        let normal = unit(description.normal)?;
        Some(Self {
            center: Vec3::from_dvec3(description.center - packing.centre),
            normal: Vec3::from_dvec3(normal),
            radius: R::from_f64(description.radius),
            material,
        })
    }

    fn rectangle(description: &Disc, projector: &Projector) -> Option<Rectangle> {
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
        Some((self.normal, self.radius + self.radius))
    }

    fn material(&self) -> u32 {
        self.material
    }

    /// Seen edge-on, it has no width.
    fn thickness(&self) -> R {
        R::ZERO
    }

    fn reach(&self) -> (Vec3<R>, R) {
        (self.center, self.radius)
    }

    #[inline(always)]
    fn prepare<L: SimdFloat<Real = R>>(_directions: Vec3<L>) {}

    /// t = n·(c - o) / n·d as for a plane, where |o + t·d - c|² ≤ r². Computed relative to the centre, so that it
    /// is as exact for a distant disc as for a nearby one. A ray parallel to the disc divides by zero, and the
    /// comparison fails.
    #[inline(always)]
    fn intersect<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, (): &(), _methods: &Methods) -> L {
        let normal = rays.origin.like(self.normal);
        let from_center = rays.origin - rays.origin.like(self.center);
        let t = -normal.dot(from_center) / normal.dot(rays.direction);
        let hit_offset = from_center + rays.direction * t;
        let is_inside = hit_offset
            .dot(hit_offset)
            .at_most(t.like(self.radius * self.radius));
        let is_ahead = t.like(R::ZERO).less(t);
        L::select(is_inside & is_ahead, t, t.like(R::INFINITY))
    }

    /// Undecided for rays that pass near the rim (the more oblique they are, the farther off their hits may be),
    /// that run along the disc, or that start on it.
    #[inline(always)]
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        (): &(),
        methods: &Methods,
        (blur, wanted): (&Blur<L>, L::Mask),
    ) -> Option<(L, L)> {
        let normal = rays.origin.like(self.normal);
        let from_center = rays.origin - rays.origin.like(self.center);
        let radius = from_center.x.like(self.radius);
        let b = -rays.direction.dot(from_center);
        let perpendicular = from_center + rays.direction * b;
        let width = blur.around(b.abs(), radius);
        let reach = radius + width;
        let comes_near = perpendicular.dot(perpendicular).at_most(reach * reach);
        if !(wanted & comes_near).any() {
            return None;
        }
        let infinity = b.like(R::INFINITY);
        let (height, speed) = (normal.dot(from_center), normal.dot(rays.direction));
        let hit_offset = from_center - rays.direction * (height / speed);
        let rim_shift = width / speed.abs();
        let bound = rim_shift * (radius + radius + rim_shift);
        let passes_rim = (hit_offset.dot(hit_offset) - radius * radius)
            .abs()
            .at_most(bound);
        let is_undecided = passes_rim | speed.abs().at_most(blur.spread.abs());
        let is_undecided = comes_near & (is_undecided | height.abs().at_most(blur.at(radius)));
        let distance = self.intersect(rays, &(), methods);
        if !(wanted & is_undecided).any() {
            return Some((distance, infinity));
        }
        let around = BoundingBox::around_ball(self.center, self.radius);
        let entry = around.entry(rays, width);
        Some((distance, L::select(is_undecided, entry, infinity)))
    }

    #[inline(always)]
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let normal = rays.origin.like(self.normal);
        let point = rays.at(t);
        let height = normal.dot(point - rays.origin.like(self.center));
        SurfacePoint {
            point: point - normal * height,
            normal,
            curvature: t.like(R::ZERO),
            slack: t.like(R::ZERO),
            size: point.max_abs() + t.like(self.radius),
        }
    }

    /// Seen along the ray, the disc is an ellipse with half-axes r and r·|n·d|. With f = √((a/B)² + (b/A)²), which
    /// is 1 on an ellipse and changes by at most 1/B per length, (f - 1)·B is at most the distance from it, and so
    /// is the distance from the circle of radius r. `from` and `to` are the ends of the chord that the ray passes
    /// over, not those of the whole disc: for rays that end before the chord, the disc is not there, and they need
    /// not hit the box around it.
    #[inline(always)]
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        (): &(),
        _matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>> {
        let normal = rays.origin.like(self.normal);
        let x = rays.origin - rays.origin.like(self.center);
        let radius = x.x.like(self.radius);
        let along = -rays.direction.dot(x);
        let offset = x + rays.direction * along;
        let cosine = normal.dot(rays.direction);
        let square = offset.dot(offset);
        // The component along the short axis, in the direction of the normal's component across the ray.
        let sine_square = (cosine.like(R::ONE) - cosine * cosine).max(cosine.like(R::ZERO));
        let short_part = offset.dot(normal);
        let zero = along.like(R::ZERO);
        let is_tilted = zero.less(sine_square);
        // Rounding magnifies a small component, but a component is at most the whole.
        let short_square =
            L::select(is_tilted, short_part * short_part / sine_square, zero).min(square);
        let long_square = square - short_square;
        let by_ellipse =
            (short_square + long_square * cosine * cosine).sqrt() - radius * cosine.abs();
        let by_circle = square.sqrt() - radius;
        let half_chord = ((radius * radius - long_square).max(zero) * sine_square).sqrt();
        Some(Approach {
            from: along - half_chord,
            to: along + half_chord,
            distance: by_ellipse.max(by_circle),
            size: (radius + radius) * cosine.abs(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from)
    }

    fn disc(normal: DVec3, radius: f64) -> PackedDisc<f64> {
        PackedDisc {
            center: Vec3::splat(0.0),
            normal: Vec3::from_dvec3(normal),
            radius,
            material: 0,
        }
    }

    proptest! {
        #[test]
        fn what_is_aimed_at_inside_is_hit_and_beside_is_missed(normal in vector(), along in vector(), eye in vector(), share in 0.0..2.0_f64) {
            let Some(normal) = normal.try_normalize() else { return Ok(()) };
            let Some(along) = normal.cross(along).try_normalize() else { return Ok(()) };
            prop_assume!((share - 1.0).abs() > 1e-6);
            let (target, eye) = (along * (share * 0.7), eye * 5.0);
            let Some(direction) = (target - eye).try_normalize() else { return Ok(()) };
            prop_assume!(normal.dot(direction).abs() > 1e-3);
            let ray = Ray { origin: Vec3::from_dvec3(eye), direction: Vec3::from_dvec3(direction) };
            let t: f64 = disc(normal, 0.7).intersect_single(&ray, &Methods::default());
            prop_assert_eq!(t.is_finite(), share < 1.0);
            if t.is_finite() {
                prop_assert!((ray.at(t).to_dvec3() - target).length() < 1e-9);
            }
        }

        /// No point of the disc is closer to the ray than the approach says, and a ray that is outside according to
        /// it misses.
        #[test]
        fn the_distance_is_never_overstated(normal in vector(), eye in vector(), direction in vector(), angle in 0.0..6.3_f64, share in 0.0..1.0_f64) {
            let (Some(normal), Some(direction)) = (normal.try_normalize(), direction.try_normalize()) else { return Ok(()) };
            let Some(along) = normal.cross(DVec3::new(0.3, 0.5, -0.8)).try_normalize() else { return Ok(()) };
            let across = normal.cross(along);
            let ray = Ray::<f64> { origin: Vec3::from_dvec3(eye * 3.0), direction: Vec3::from_dvec3(direction) };
            let target = disc(normal, 0.6);
            let approach = target.approach(&ray, &(), |_| true).expect("asked for");
            let point = (along * angle.cos() + across * angle.sin()) * (0.6 * share.sqrt());
            let off = point - eye * 3.0;
            let beside = (off - direction * off.dot(direction)).length();
            prop_assert!(approach.distance <= beside + 1e-9, "{} {}", approach.distance, beside);
            // `from` and `to` are on the rim: for a ray through a point of the disc, that point is between them,
            // and they are no farther apart than its chord.
            let through = Ray::<f64> { origin: Vec3::from_dvec3(point - direction * 2.0), ..ray };
            let chord = target.approach(&through, &(), |_| true).expect("asked for");
            prop_assert!(chord.from - 1e-6 <= 2.0 && 2.0 <= chord.to + 1e-6, "{chord:?}");
            let sine = (1.0 - normal.dot(direction).powi(2)).sqrt();
            prop_assert!(chord.to - chord.from <= 1.2 * sine + 1e-9, "{chord:?}");
            if target.intersect_single(&ray, &Methods::default()).is_finite() {
                prop_assert!(approach.distance <= 1e-9, "a hit is inside: {}", approach.distance);
            }
        }
    }

    /// Nearly face-on and far away, single precision turns a small lean into a large one.
    #[test]
    fn rounding_pushes_no_hit_out_of_a_far_disc() {
        let eye = DVec3::new(0.0, 0.0, 1000.0);
        for step in 0..8000_u32 {
            let tilt = 10.0_f64.powf(-4.0 + 3.0 * f64::from(step / 400) / 20.0);
            let turned = DVec3::X.rotate_axis(DVec3::Z, f64::from(step) * 0.7);
            let normal = turned * tilt.sin() + DVec3::Z * tilt.cos();
            let share = f64::from(step % 20) / 20.0;
            let aside = DVec3::X.rotate_axis(DVec3::Z, f64::from(step) * 2.399) * share;
            let target = aside - DVec3::Z * (aside.dot(normal) / normal.z);
            let ray = Ray::<f32> {
                origin: Vec3::from_dvec3(eye),
                direction: Vec3::from_dvec3((target - eye).normalize()),
            };
            let disc = PackedDisc {
                center: Vec3::splat(0.0),
                normal: Vec3::from_dvec3(normal),
                radius: 1.0,
                material: 0,
            };
            let distance = disc
                .approach(&ray, &(), |_| true)
                .expect("asked for")
                .distance;
            assert!(distance <= 1e-3, "{distance} outside, tilted by {tilt}");
        }
    }

    #[test]
    fn edge_on_and_behind_are_misses() {
        let ray = |x: f32, y: f32| Ray {
            origin: Vec3::new(-2.0, y, 0.0),
            direction: Vec3::new(x, 0.0, 0.0),
        };
        let lying = PackedDisc {
            center: Vec3::splat(0.0),
            normal: Vec3::new(0.0, 1.0, 0.0),
            radius: 1.0_f32,
            material: 0,
        };
        let intersect = |ray: Ray<f32>| lying.intersect_single(&ray, &Methods::default());
        assert_eq!(intersect(ray(1.0, 0.0)), f32::INFINITY, "0/0");
        assert_eq!(intersect(ray(1.0, 0.5)), f32::INFINITY);
        let standing = PackedDisc {
            normal: Vec3::new(1.0, 0.0, 0.0),
            ..lying
        };
        let intersect = |ray: Ray<f32>| standing.intersect_single(&ray, &Methods::default());
        assert_eq!(intersect(ray(1.0, 0.5)), 2.0);
        assert_eq!(intersect(ray(-1.0, 0.5)), f32::INFINITY);
    }
}
