//! Ray against triangle. Both sides are hit.

mod curved;

mod vertex;

mod slicing;

mod packed;

mod watertight;

mod weak;

mod in_doubt;

pub use curved::{CornerNormals, Curved};
use in_doubt::watertight_in_doubt;
use packed::SHARES_PER_UNIT;
pub use packed::{Culling, PackedTriangle, Tip};
pub use slicing::Slicing;
pub use vertex::Vertex;
use watertight::{Passing, Shear, watertight};

use glam::DVec3;

use super::ball::Ball;
use super::blur::Blur;
use super::bounding_box::BoundingBox;
use super::kind::{Approach, Packing, Primitive, SurfacePoint};
use super::projector::{Projector, Rectangle};
use super::ray::Ray;
use crate::mesh::position_key;
use crate::scene::{Methods, Triangle, TriangleMethod};
use crate::simd::{Real, SimdFloat, Vec3};

/// Factor by which a triangle counts as wider at its tips: things that are narrow all along are looked for up to a
/// width of 2 pixels; for tips, 1.1 pixels are enough, with a third fewer rays for them.
const WIDER_AT_TIPS: f64 = 2.0 / 1.1;

/// What is needed of a triangle where it is hit; each ray may have a different triangle.
#[derive(Clone, Copy, Debug)]
pub struct Flat<L: SimdFloat> {
    /// A corner.
    pub corner: Vec3<L>,
    /// Unit normal.
    pub normal: Vec3<L>,
    /// 1 if it shares a corner with another triangle, otherwise 0.
    pub in_mesh: L,
    /// The length of its longest edge.
    pub longest: L,
}

impl<L: SimdFloat> Flat<L> {
    /// Refines the hits at distance `t` onto the surface.
    #[inline(always)]
    pub fn refine(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let normal = self.normal;
        let point = rays.at(t);
        let point = point - normal * normal.dot(point - self.corner);
        // Neighbours in a mesh meet the triangle at its edges, so the slack covers the error of the computed point:
        // up to 4u·(|p| + |o| + t).
        let reach = point.max_abs() + rays.origin.max_abs() + t;
        let roundings = t.like(L::Real::UNIT_ROUNDOFF * L::Real::from_f64(4.0));
        // For rays that hit nothing, infinity times 0 is NaN.
        let slack = L::select(
            t.like(L::Real::ZERO).less(self.in_mesh),
            reach * roundings,
            self.in_mesh,
        );
        SurfacePoint {
            point,
            normal,
            curvature: t.like(L::Real::ZERO),
            slack,
            size: point.max_abs() + self.longest,
        }
    }
}

impl<R: Real> PackedTriangle<R> {
    /// The width of the mesh here for somebody who looks along these directions: at most that of a plate with these
    /// two widths.
    #[inline(always)]
    fn width_from<L: SimdFloat<Real = R>>(&self, directions: Vec3<L>) -> L {
        let cosine = directions.dot(directions.like(self.normal)).abs();
        cosine.like(self.thickness) + cosine.like(self.wider) * cosine
    }
}

impl<R: Real> Primitive<R> for PackedTriangle<R> {
    type Description = Triangle;
    type Prepared<L: SimdFloat<Real = R>> = Shear<L>;

    fn pack(description: &Triangle, material: u32, packing: &Packing) -> Option<Self> {
        let corners = description.corners();
        let is_shared = |point: &DVec3| packing.corner_users.get(&position_key(*point)) > Some(&1);
        let is_of_solid = packing.faces_of_solids.contains(&corners.map(position_key));
        Some(Self {
            corners: corners.map(|corner| Vec3::from_dvec3(corner - packing.centre)),
            in_mesh: corners.iter().any(is_shared),
            tip: Tip::Narrow,
            culling: if is_of_solid {
                Culling::Far
            } else {
                Culling::Nothing
            },
            material,
            // Its measures do not depend on where it is.
            ..Self::of_mesh(corners)?
        })
    }

    fn rectangle(description: &Triangle, projector: &Projector) -> Option<Rectangle> {
        Some(projector.triangle(description.corners()))
    }

    fn ball(&self) -> Option<Ball> {
        Some(Ball::around_triangle(self.corners.map(Vec3::to_dvec3)))
    }

    fn bounds(&self) -> Option<BoundingBox<R>> {
        Some(BoundingBox::around(&self.corners))
    }

    fn flat(&self) -> Option<(Vec3<R>, R)> {
        Some((self.normal, self.longest))
    }

    fn material(&self) -> u32 {
        self.material
    }

    fn thickness(&self) -> R {
        if self.tip == Tip::Nowhere {
            self.thickness
        } else {
            R::ZERO
        }
    }

    #[inline(always)]
    fn is_far<L: SimdFloat<Real = R>>(&self, sight: Vec3<L>) -> Option<L::Mask> {
        let zero = sight.x.like(R::ZERO);
        match self.culling {
            Culling::Far => Some(zero.less(sight.dot(sight.like(self.normal)))),
            _ => None,
        }
    }

    fn has_outline(&self) -> bool {
        self.tip == Tip::Narrow && !self.in_mesh
    }

    #[inline(always)]
    fn blocking_width<L: SimdFloat<Real = R>>(&self, directions: Vec3<L>) -> L {
        let zero = directions.x.like(R::ZERO);
        let thickness = self.width_from(directions);
        let is_left_out = match self.culling {
            Culling::Nothing => return thickness,
            Culling::Lit => zero.less(directions.dot(directions.like(self.normal))),
            Culling::Far => directions.dot(directions.like(self.normal)).less(zero),
        };
        L::select(is_left_out, zero, thickness)
    }

    fn reach(&self) -> (Vec3<R>, R) {
        let [a, b, c] = self.corners;
        (a, (b - a).length().max((c - a).length()))
    }

    #[inline(always)]
    fn prepare<L: SimdFloat<Real = R>>(directions: Vec3<L>) -> Shear<L> {
        Shear::new(directions)
    }

    #[inline(always)]
    fn intersect<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        shear: &Shear<L>,
        methods: &Methods,
    ) -> L {
        match methods.triangle {
            TriangleMethod::Watertight => watertight(rays, shear, self),
            weak => weak::weak(rays, self, weak),
        }
    }

    #[inline(always)]
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        shear: &Shear<L>,
        methods: &Methods,
        blur: (&Blur<L>, L::Mask),
    ) -> Option<(L, L)> {
        if methods.triangle == TriangleMethod::Watertight {
            return watertight_in_doubt(rays, shear, self, blur);
        }
        let infinity = rays.origin.x.like(R::INFINITY);
        Some((self.intersect(rays, shear, methods), infinity))
    }

    #[inline(always)]
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L> {
        let in_mesh = if self.in_mesh { R::ONE } else { R::ZERO };
        let flat = Flat {
            corner: rays.origin.like(self.corners[0]),
            normal: rays.origin.like(self.normal),
            in_mesh: t.like(in_mesh),
            longest: t.like(self.longest),
        };
        flat.refine(rays, t)
    }

    #[inline(always)]
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        shear: &Shear<L>,
        matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>> {
        let [a, b, c] = self.corners;
        let a = shear.apply(rays.origin.like(a) - rays.origin);
        let b = shear.apply(rays.origin.like(b) - rays.origin);
        let c = shear.apply(rays.origin.like(c) - rays.origin);
        let (t, u, v) = (a[2] * shear.z, b[2] * shear.z, c[2] * shear.z);
        let mut size = self.width_from(rays.direction);
        let mut rough_size = match self.tip {
            Tip::Narrow => t.like(R::ZERO),
            _ => size,
        };
        if let Tip::Round(corner, share) = self.tip {
            let width = rays.distance_to(self.corners[corner as usize]);
            let share = f64::from(share) / SHARES_PER_UNIT;
            size = size.min(width * width.like_f64(share * WIDER_AT_TIPS));
            rough_size = size;
        }
        let rough = Approach {
            from: t.min(u).min(v),
            to: t.max(u).max(v),
            distance: shear.min_distance([a, b, c]),
            size: rough_size,
        };
        if !matters(&rough) {
            return None;
        }
        let Passing {
            inside,
            nearest,
            second,
            nearest_at,
        } = shear.passing([a, b, c]);
        if self.tip == Tip::Narrow {
            // Near one edge, the width there is about the extra distance to the next edge.
            let width = second - nearest;
            size = size.min(width * width.like_f64(WIDER_AT_TIPS));
        }
        Some(Approach {
            from: nearest_at,
            to: nearest_at,
            distance: L::select(inside, -nearest, nearest),
            size,
        })
    }
}

#[cfg(test)]
mod tests;
