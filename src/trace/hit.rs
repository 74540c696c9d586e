//! The nearest hit among some primitives, and whether anything stands in a ray's way.

use super::triangle::Shear;
use super::{Ray, plane, sphere, triangle};
use crate::lanes::{Lane, Mask as _, Real, Vec3};
use crate::plan::{Plan, Plane, RayOffset};

/// The primitives that are worth testing, by their places in the plan's lists. Planes always are.
#[derive(Clone, Copy, Debug)]
pub struct Among<'a> {
    /// Places in [`Plan::spheres`].
    pub spheres: &'a [u32],
    /// Places in [`Plan::triangles`].
    pub triangles: &'a [u32],
}

/// Rays and the primitives that they start on, which they must not meet where they start.
#[derive(Clone, Copy, Debug)]
pub struct Paths<L> {
    /// The rays.
    pub rays: Ray<L>,
    /// Numbers of the primitives, [`NOTHING`] for none; `None` if that is so for all.
    pub start: Option<L>,
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
pub fn nearest<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: Among,
    paths: &Paths<L>,
) -> Nearest<L> {
    let numbers = Numbers::of(plan);
    let infinity = L::splat(token, L::Real::INFINITY);
    let nothing = L::splat(token, L::Real::from_f64(NOTHING));
    let mut best = Nearest {
        t: infinity,
        number: nothing,
    };
    for &index in among.spheres {
        let number = L::splat(token, real(index as usize));
        let t = sphere_distance(token, plan, paths, index as usize, number);
        offer(&mut best, t, number);
    }
    for (index, plane) in plan.planes.iter().enumerate() {
        let number = L::splat(token, real(numbers.planes + index));
        offer(
            &mut best,
            plane_distance(token, paths, plane, number),
            number,
        );
    }
    if !among.triangles.is_empty() {
        let shear = Shear::new(token, paths.rays.direction);
        for &index in among.triangles {
            let number = L::splat(token, real(numbers.triangles + index as usize));
            let t = triangle_distance(token, plan, paths, &shear, index as usize, number);
            offer(&mut best, t, number);
        }
    }
    best
}

#[inline(always)]
fn offer<L: Lane>(best: &mut Nearest<L>, t: L, number: L) {
    let closer = t.less(best.t);
    best.t = L::select(closer, t, best.t);
    best.number = L::select(closer, number, best.number);
}

/// Where a primitive that casts shadows meets the paths before `distance`; looked for only where
/// `wanted`.
#[inline(always)]
pub fn blocked<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    among: Among,
    paths: &Paths<L>,
    distance: L,
    wanted: L::Mask,
) -> L::Mask {
    let numbers = Numbers::of(plan);
    let mut free = wanted;
    for &index in among.spheres {
        let number = L::splat(token, real(index as usize));
        let t = sphere_distance(token, plan, paths, index as usize, number);
        free = free & !t.less(distance);
        if !free.any() {
            return wanted;
        }
    }
    if plan.planes_cast {
        for (index, plane) in plan.planes.iter().enumerate() {
            let number = L::splat(token, real(numbers.planes + index));
            let t = plane_distance(token, paths, plane, number);
            free = free & !t.less(distance);
        }
    }
    if !among.triangles.is_empty() {
        let shear = Shear::new(token, paths.rays.direction);
        for &index in among.triangles {
            let number = L::splat(token, real(numbers.triangles + index as usize));
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
fn sphere_distance<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    paths: &Paths<L>,
    index: usize,
    number: L,
) -> L {
    let sphere = &plan.spheres[index];
    let t = sphere::intersect(token, plan.methods.sphere, &paths.rays, sphere);
    match paths.start {
        None => t,
        Some(start) => {
            let own = start.same(number);
            if own.any() {
                L::select(own, sphere::leave(token, &paths.rays, sphere), t)
            } else {
                t
            }
        }
    }
}

#[inline(always)]
fn plane_distance<L: Lane>(
    token: L::Token,
    paths: &Paths<L>,
    plane: &Plane<L::Real>,
    number: L,
) -> L {
    let t = plane::intersect(token, &paths.rays, plane);
    without_start(token, paths, number, t)
}

#[inline(always)]
fn triangle_distance<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    paths: &Paths<L>,
    shear: &Shear<L>,
    index: usize,
    number: L,
) -> L {
    let triangle = &plan.triangles[index];
    let t = triangle::intersect(token, plan.methods.triangle, &paths.rays, shear, triangle);
    without_start(token, paths, number, t)
}

/// A flat primitive is never met again by a ray that starts on it.
#[inline(always)]
fn without_start<L: Lane>(token: L::Token, paths: &Paths<L>, number: L, t: L) -> L {
    match paths.start {
        None => t,
        Some(start) => L::select(start.same(number), L::splat(token, L::Real::INFINITY), t),
    }
}

/// Hits on one primitive, refined.
#[derive(Clone, Copy, Debug)]
pub struct Hit<L> {
    /// On the surface.
    pub point: Vec3<L>,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3<L>,
    /// Index into [`Plan::materials`].
    pub material: u32,
    /// Number of the primitive.
    pub number: L,
    /// How far the point may be off along the normal: 0, or a few roundings where it matters.
    pub slack: Option<L>,
}

/// The hits at `t` on the primitive of this number.
#[inline(always)]
pub fn refine<L: Lane>(
    token: L::Token,
    plan: &Plan<L::Real>,
    rays: &Ray<L>,
    t: L,
    number: L::Real,
) -> Hit<L> {
    let numbers = Numbers::of(plan);
    let index = number.to_f64() as usize;
    let number = L::splat(token, number);
    if index < numbers.planes {
        let sphere = &plan.spheres[index];
        let (point, normal) = sphere::refine(token, rays, sphere, t);
        return Hit {
            point,
            normal,
            material: sphere.material,
            number,
            slack: None,
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
            slack: None,
        };
    }
    let triangle = &plan.triangles[index - numbers.triangles];
    let point = triangle::refine(token, rays, triangle, t);
    // The neighbours in a mesh meet the triangle at its edges: 4u·(|p| + |o| + t) is what the
    // computation of the point can be off by.
    let slack = if triangle.in_mesh {
        let reach = point.max_abs() + rays.origin.max_abs() + t;
        Some(reach * L::splat(token, L::Real::UNIT_ROUNDOFF * L::Real::from_f64(4.0)))
    } else {
        None
    };
    let normal = Vec3::broadcast(token, triangle.normal);
    Hit {
        point,
        normal,
        material: triangle.material,
        number,
        slack,
    }
}

impl<L: Lane> Hit<L> {
    /// The paths that leave the hits in unit directions on the side that the normal points to.
    #[inline(always)]
    pub fn leave(&self, token: L::Token, offset: RayOffset, direction: Vec3<L>) -> Paths<L> {
        let (origin, start) = match (offset, self.slack) {
            (RayOffset::Robust, None) => (self.point, Some(self.number)),
            (RayOffset::Robust, Some(slack)) => {
                (self.point + self.normal * slack, Some(self.number))
            }
            (RayOffset::Fixed(distance), _) => {
                let distance = L::splat(token, L::Real::from_f64(distance));
                (self.point + direction * distance, None)
            }
        };
        Paths {
            rays: Ray { origin, direction },
            start,
        }
    }
}
