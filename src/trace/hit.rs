//! The nearest hit among some primitives, and whether anything stands in a ray's way.

use super::cull::Candidates;
use super::triangle::Shear;
use super::{Ray, plane, sphere, triangle};
use crate::plan::{Plan, RayOrigin};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// Rays and the primitives that they start on, which they must not meet where they start.
#[derive(Clone, Copy, Debug)]
pub struct Paths<L> {
    /// The rays.
    pub rays: Ray<L>,
    /// What they start on.
    pub start: Start<L>,
}

/// The primitives that rays start on.
#[derive(Clone, Copy, Debug)]
pub enum Start<L> {
    /// None.
    Nowhere,
    /// The one of this number, all of them.
    On(usize),
    /// Those of these numbers, [`NOTHING`] for none.
    Each(L),
}

impl<L: SimdFloat> Start<L> {
    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn over(self, token: L::Token, mask: L::Mask, other: Self) -> Self {
        match (self, other) {
            (Self::Nowhere, Self::Nowhere) => self,
            (Self::On(this), Self::On(other)) if this == other => self,
            _ => Self::Each(L::select(mask, self.numbers(token), other.numbers(token))),
        }
    }

    /// Where it is the primitive of this number.
    #[inline(always)]
    pub fn is(self, token: L::Token, number: usize) -> L::Mask {
        self.numbers(token).same(L::splat(token, real(number)))
    }

    #[inline(always)]
    fn numbers(self, token: L::Token) -> L {
        match self {
            Self::Nowhere => L::splat(token, L::Real::from_f64(NOTHING)),
            Self::On(number) => L::splat(token, real(number)),
            Self::Each(numbers) => numbers,
        }
    }
}

/// The nearest primitives.
#[derive(Clone, Copy, Debug)]
pub struct Nearest<L> {
    /// How far; infinity for nothing.
    pub t: L,
    /// Number of the primitive, see [`Numbers`]; [`NOTHING`] for nothing.
    pub number: L,
}

/// The number of no primitive.
pub const NOTHING: f64 = -1.0;

/// One number for every primitive, exact in any real type: spheres, then planes, then triangles.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    planes: usize,
    triangles: usize,
}

impl Numbers {
    /// The numbers of a plan.
    #[inline(always)]
    pub fn of<R: Real>(plan: &Plan<R>) -> Self {
        let planes = plan.spheres.len();
        Self {
            planes,
            triangles: planes + plan.planes.len(),
        }
    }
}

#[inline(always)]
fn real<R: Real>(number: usize) -> R {
    R::from_f64(number as f64)
}

/// The nearest primitives along the paths.
#[inline(always)]
pub fn nearest<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: &Candidates,
    paths: &Paths<L>,
) -> Nearest<L> {
    let numbers = Numbers::of(plan);
    let infinity = L::splat(token, L::Real::INFINITY);
    let nothing = L::splat(token, L::Real::from_f64(NOTHING));
    let mut best = Nearest {
        t: infinity,
        number: nothing,
    };
    for &index in &among.spheres {
        let t = sphere_distance(token, plan, paths, index as usize);
        offer(token, &mut best, t, index as usize);
    }
    for &index in &among.planes {
        let number = numbers.planes + index as usize;
        let t = plane_distance(token, plan, paths, index as usize, number);
        offer(token, &mut best, t, number);
    }
    if !among.triangles.is_empty() {
        let shear = Shear::new(token, paths.rays.direction);
        for &index in &among.triangles {
            let number = numbers.triangles + index as usize;
            let t = triangle_distance(token, plan, paths, &shear, index as usize, number);
            offer(token, &mut best, t, number);
        }
    }
    best
}

#[inline(always)]
fn offer<L: SimdFloat>(token: L::Token, best: &mut Nearest<L>, t: L, number: usize) {
    let closer = t.less(best.t);
    best.t = L::select(closer, t, best.t);
    best.number = L::select(closer, L::splat(token, real(number)), best.number);
}

/// Where a primitive that casts shadows meets the paths before `distance`; looked for only where
/// `wanted`.
#[inline(always)]
pub fn blocked<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: &Candidates,
    paths: &Paths<L>,
    distance: L,
    wanted: L::Mask,
) -> L::Mask {
    let numbers = Numbers::of(plan);
    let mut free = wanted;
    for &index in &among.spheres {
        let t = sphere_distance(token, plan, paths, index as usize);
        free = free & !t.less(distance);
        if !free.any() {
            return wanted;
        }
    }
    for &index in &among.planes {
        let number = numbers.planes + index as usize;
        let t = plane_distance(token, plan, paths, index as usize, number);
        free = free & !t.less(distance);
    }
    if !among.triangles.is_empty() {
        let shear = Shear::new(token, paths.rays.direction);
        for &index in &among.triangles {
            let number = numbers.triangles + index as usize;
            let t = triangle_distance(token, plan, paths, &shear, index as usize, number);
            free = free & !t.less(distance);
            if !free.any() {
                return wanted;
            }
        }
    }
    wanted & !free
}

#[inline(always)]
fn sphere_distance<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    paths: &Paths<L>,
    index: usize,
) -> L {
    let sphere = &plan.spheres[index];
    match paths.start {
        Start::On(start) if start == index => sphere::leave(token, &paths.rays, sphere),
        Start::Nowhere | Start::On(_) => {
            sphere::intersect(token, plan.methods.sphere, &paths.rays, sphere)
        }
        Start::Each(start) => {
            let t = sphere::intersect(token, plan.methods.sphere, &paths.rays, sphere);
            let own = start.same(L::splat(token, real(index)));
            if own.any() {
                L::select(own, sphere::leave(token, &paths.rays, sphere), t)
            } else {
                t
            }
        }
    }
}

#[inline(always)]
fn plane_distance<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    paths: &Paths<L>,
    index: usize,
    number: usize,
) -> L {
    let t = plane::intersect(token, &paths.rays, &plan.planes[index]);
    without_start(token, paths, number, t)
}

#[inline(always)]
fn triangle_distance<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    paths: &Paths<L>,
    shear: &Shear<L>,
    index: usize,
    number: usize,
) -> L {
    let triangle = &plan.triangles[index];
    let t = triangle::intersect(token, plan.methods.triangle, &paths.rays, shear, triangle);
    without_start(token, paths, number, t)
}

/// A flat primitive is never met again by a ray that starts on it.
#[inline(always)]
fn without_start<L: SimdFloat>(token: L::Token, paths: &Paths<L>, number: usize, t: L) -> L {
    let infinity = L::splat(token, L::Real::INFINITY);
    match paths.start {
        Start::On(start) if start == number => infinity,
        Start::Nowhere | Start::On(_) => t,
        Start::Each(start) => L::select(start.same(L::splat(token, real(number))), infinity, t),
    }
}

/// Hits on one primitive, refined.
#[derive(Clone, Copy, Debug)]
pub struct Hit<L: SimdFloat> {
    /// On the surface.
    pub point: Vec3<L>,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3<L>,
    /// Index into [`Plan::materials`].
    pub material: u32,
    /// Number of the primitive.
    pub number: usize,
    /// Radius of curvature of the surface; infinity if it is flat.
    pub radius: L::Real,
    /// How far the point may be off along the normal: 0, or a few roundings where it matters. A
    /// number even where there is none: the compiler multiplies with it in either case, and what it
    /// would find in its place may be a number so small that the processor stumbles over it.
    pub slack: L,
}

/// The hits at `t` on the primitive of this number.
#[inline(always)]
pub fn refine<L: SimdFloat>(
    token: L::Token,
    plan: &Plan<L::Real>,
    rays: &Ray<L>,
    t: L,
    number: L::Real,
) -> Hit<L> {
    let numbers = Numbers::of(plan);
    let number = number.to_f64() as usize;
    let index = number;
    if index < numbers.planes {
        let sphere = &plan.spheres[index];
        let (point, normal) = sphere::refine(token, rays, sphere, t);
        return Hit {
            point,
            normal,
            material: sphere.material,
            number,
            radius: sphere.radius,
            slack: L::splat(token, L::Real::ZERO),
        };
    }
    if index < numbers.triangles {
        let plane = &plan.planes[index - numbers.planes];
        let point = plane::refine(token, rays, plane, t);
        let normal = Vec3::broadcast(token, plane.normal);
        return Hit {
            point,
            normal,
            material: plane.material,
            number,
            radius: L::Real::INFINITY,
            slack: L::splat(token, L::Real::ZERO),
        };
    }
    let triangle = &plan.triangles[index - numbers.triangles];
    let point = triangle::refine(token, rays, triangle, t);
    // The neighbours in a mesh meet the triangle at its edges: 4u·(|p| + |o| + t) is what the
    // computation of the point can be off by.
    let slack = if triangle.in_mesh {
        let reach = point.max_abs() + rays.origin.max_abs() + t;
        reach * L::splat(token, L::Real::UNIT_ROUNDOFF * L::Real::from_f64(4.0))
    } else {
        L::splat(token, L::Real::ZERO)
    };
    let normal = Vec3::broadcast(token, triangle.normal);
    Hit {
        point,
        normal,
        material: triangle.material,
        number,
        radius: L::Real::INFINITY,
        slack,
    }
}

/// 256 roundings of each coordinate in the direction of the normal, and 1/65536 of a unit near zero.
///
/// Wächter and Binder, "A fast and robust method for avoiding self-intersection", Ray Tracing Gems
/// (2019), ch. 6; with 2u·|p| in place of the step to the next number, which is at most twice that.
#[inline(always)]
fn roundings_along<L: SimdFloat>(token: L::Token, point: Vec3<L>, normal: Vec3<L>) -> Vec3<L> {
    let roundings = L::splat(
        token,
        L::Real::UNIT_ROUNDOFF * L::Real::from_f64(2.0 * 256.0),
    );
    let near = L::splat(token, L::Real::from_f64(1.0 / 32.0));
    let least = L::splat(token, L::Real::from_f64(1.0 / 65536.0));
    let (x, y, z) = (point.x.abs(), point.y.abs(), point.z.abs());
    Vec3::new(
        normal.x * L::select(x.less(near), least, x * roundings),
        normal.y * L::select(y.less(near), least, y * roundings),
        normal.z * L::select(z.less(near), least, z * roundings),
    )
}

impl<L: SimdFloat> Hit<L> {
    /// The paths that leave the hits in unit directions on the side that the normal points to.
    #[inline(always)]
    pub fn leave(
        &self,
        token: L::Token,
        departure: RayOrigin<L::Real>,
        direction: Vec3<L>,
    ) -> Paths<L> {
        let (origin, start) = match departure {
            RayOrigin::AtHit => (
                self.point + self.normal * self.slack,
                Start::On(self.number),
            ),
            RayOrigin::Along(distance) => {
                let distance = L::splat(token, distance);
                (self.point + direction * distance, Start::Nowhere)
            }
            RayOrigin::Roundings => (
                self.point + roundings_along(token, self.point, self.normal),
                Start::Nowhere,
            ),
        };
        Paths {
            rays: Ray { origin, direction },
            start,
        }
    }
}
