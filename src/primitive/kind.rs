//! The interface of all kinds of primitives. Kernels are generic over it, so that each scan is compiled separately
//! for each kind.

use std::collections::{HashMap, HashSet};
use std::fmt::Debug;

use glam::DVec3;

use super::ball::Ball;
use super::blur::Blur;
use super::bounding_box::BoundingBox;
use super::projector::{Projector, Rectangle};
use super::ray::Ray;
use crate::scene::{Describe, Methods};
use crate::simd::{Real, SimdFloat, Vec3};

/// The bits of a corner's coordinates, see [`crate::mesh::position_key`].
pub type Corner = [u64; 3];

/// What packing needs to know about the scene.
pub struct Packing<'a> {
    /// The origin of packed coordinates.
    pub centre: DVec3,
    /// How many visible triangles meet at each corner.
    pub corner_users: &'a HashMap<Corner, usize>,
    /// The corners of the visible triangles that are faces of closed convex solids.
    pub faces_of_solids: &'a HashSet<[Corner; 3]>,
    /// Computes rectangles in the picture; `None` if nothing may be left out.
    pub projector: Option<&'a Projector>,
}

/// A refined hit.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint<L: SimdFloat> {
    /// The point on the surface.
    pub point: Vec3<L>,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3<L>,
    /// One over the radius of curvature of the surface; 0 if it is flat.
    pub curvature: L,
    /// Upper bound of the point's error along the normal: 0, or a few roundings where it matters. A number even
    /// where there is none, instead of an `Option`: the compiler multiplies by it in either case, and what it would
    /// find there otherwise may be a subnormal number, which slows the processor down.
    pub slack: L,
    /// Roughly the largest number in the computation of the point: a coordinate, or a dimension of the primitive.
    /// The point is off by a few roundings of that, however near it is.
    pub size: L,
}

/// How close rays come to a primitive.
#[derive(Clone, Copy, Debug)]
pub struct Approach<L> {
    /// Distance along the rays from which on the primitive is about this close. Something round or pointed may
    /// begin slightly earlier where rays pass beside it.
    pub from: L,
    /// Distance along the rays up to which it is.
    pub to: L,
    /// Distance of the primitive from the rays, in scene units; at most 0 for rays through it.
    pub distance: L,
    /// Its smallest width as seen along the rays, in scene units.
    pub size: L,
}

/// A primitive, packed for the kernels.
pub trait Primitive<R: Real>: Copy + Debug + Send + Sync {
    /// Its description in the scene.
    type Description: Describe;
    /// Data that its test derives from ray directions, computed once for all primitives of the kind.
    type Prepared<L: SimdFloat<Real = R>>: Copy;

    /// Whether rays that start on it can hit it again elsewhere, see [`Self::exit`].
    const IS_CURVED: bool = false;

    /// Whether it is unbounded.
    const IS_ENDLESS: bool = false;

    /// Packs a description; `None` if no ray can hit it.
    fn pack(description: &Self::Description, material: u32, packing: &Packing) -> Option<Self>;

    /// Its rectangle in the picture; `None` if unbounded.
    fn rectangle(description: &Self::Description, projector: &Projector) -> Option<Rectangle>;

    /// A ball around it; `None` if unbounded.
    fn ball(&self) -> Option<Ball>;

    /// The box around it; `None` if unbounded.
    fn bounds(&self) -> Option<BoundingBox<R>>;

    /// Index of its material.
    fn material(&self) -> u32;

    /// The smallest width that rays can see of it, in scene units; infinity for what is never narrower than a
    /// pixel.
    fn thickness(&self) -> R;

    /// Returns where it is on the far side of a solid for an observer looking along `sight`, so that it may have
    /// been left out; `None` if it never is.
    #[inline(always)]
    fn is_far<L: SimdFloat<Real = R>>(&self, _sight: Vec3<L>) -> Option<L::Mask> {
        None
    }

    /// The width with which it blocks light from these directions: zero where it may have been left out as an
    /// occluder.
    #[inline(always)]
    fn blocking_width<L: SimdFloat<Real = R>>(&self, directions: Vec3<L>) -> L {
        directions.x.like(self.thickness())
    }

    /// The unit normal and the extent of a flat primitive; `None` for others. A curved one counts as flat as far as
    /// it hardly turns; the normal is then 0, as there is no single one.
    fn flat(&self) -> Option<(Vec3<R>, R)> {
        None
    }

    /// Returns whether its outline is its own: no other part of the same thing continues beyond it.
    #[inline(always)]
    fn has_outline(&self) -> bool {
        !Self::IS_ENDLESS
    }

    /// A point of it, and the radius around that point within which all of it lies.
    fn reach(&self) -> (Vec3<R>, R);

    /// Derives the data of the test from unit directions.
    fn prepare<L: SimdFloat<Real = R>>(directions: Vec3<L>) -> Self::Prepared<L>;

    /// The smallest t > 0 at which the rays hit it; infinity for a miss.
    fn intersect<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        methods: &Methods,
    ) -> L;

    /// The same, with the distance from which on blurred rays may or may not hit it: infinity if the result is
    /// certain. Returns `None` if no wanted ray hits it; the values of unwanted rays are arbitrary.
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        methods: &Methods,
        blur_where_wanted: (&Blur<L>, L::Mask),
    ) -> Option<(L, L)>;

    /// The distance at which rays that start on it hit it again; infinity for flat primitives.
    #[inline(always)]
    fn exit<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>) -> L {
        rays.origin.x.like(R::INFINITY)
    }

    /// Refines the hits at distance `t` onto the surface.
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L>;

    /// Returns how close rays come to it; `None` if `matters` rejects a preliminary result whose distance may be
    /// too short.
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>>;

    /// How far behind the end of rays it may begin and still be close to them, for pixels of this width.
    #[inline(always)]
    fn margin<L: SimdFloat<Real = R>>(&self, width: L) -> L {
        width
    }

    /// [`Self::intersect`] for a single test, including the preparation.
    #[inline(always)]
    fn intersect_single<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, methods: &Methods) -> L {
        self.intersect(rays, &Self::prepare(rays.direction), methods)
    }
}
