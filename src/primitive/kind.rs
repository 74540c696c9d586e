//! What every kind of primitive can do. Kernels are generic over it, so that each scan is compiled for
//! its kind.

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

/// The bits of a corner's coordinates.
pub type Corner = [u64; 3];

/// What packing needs to know of the scene.
pub struct Packing<'a> {
    /// What coordinates are made relative to.
    pub centre: DVec3,
    /// How many visible triangles meet at each corner.
    pub corner_users: &'a HashMap<Corner, usize>,
    /// The corners of the visible triangles that are faces of closed convex solids.
    pub faces_of_solids: &'a HashSet<[Corner; 3]>,
    /// Where things are in the picture; `None` if nothing may be left out.
    pub projector: Option<&'a Projector>,
}

/// A refined hit.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint<L: SimdFloat> {
    /// On the surface.
    pub point: Vec3<L>,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3<L>,
    /// One over the radius of curvature of the surface; 0 if it is flat.
    pub curvature: L,
    /// How far the point may be off along the normal: 0, or a few roundings where it matters. A
    /// number even where there is none: the compiler multiplies with it in either case, and what it
    /// would find in its place may be a number so small that the processor stumbles over it.
    pub slack: L,
    /// The largest number, about, that the point was worked out from: a coordinate, or a measure of the primitive. It
    /// is a few roundings of that off, however near it is.
    pub size: L,
}

/// How close rays come to a primitive.
#[derive(Clone, Copy, Debug)]
pub struct Approach<L> {
    /// From where along the rays on it is about so close. What is round or pointed may begin a little before that where
    /// rays pass beside it.
    pub from: L,
    /// Up to where.
    pub to: L,
    /// How far from the rays it is, in scene units; not above 0 inside.
    pub distance: L,
    /// Its smallest measure as the rays see it, in scene units.
    pub size: L,
}

/// A primitive, packed for the kernels.
pub trait Primitive<R: Real>: Copy + Debug + Send + Sync {
    /// What it is in the scene.
    type Description: Describe;
    /// What its test needs of the directions of rays, computed once for all primitives of the kind.
    type Prepared<L: SimdFloat<Real = R>>: Copy;

    /// Whether rays that start on it can meet it again elsewhere, see [`Self::exit`].
    const IS_CURVED: bool = false;

    /// Whether it never ends.
    const IS_ENDLESS: bool = false;

    /// The packed form; `None` for what no ray can meet.
    fn pack(description: &Self::Description, material: u32, packing: &Packing) -> Option<Self>;

    /// Where it is in the picture; `None` for what never ends.
    fn rectangle(description: &Self::Description, projector: &Projector) -> Option<Rectangle>;

    /// A ball around it; `None` for what never ends.
    fn ball(&self) -> Option<Ball>;

    /// The box around it; `None` for what never ends.
    fn bounds(&self) -> Option<BoundingBox<R>>;

    /// Index of its material.
    fn material(&self) -> u32;

    /// The smallest measure that rays can see of it, in scene units; infinity for what is never narrower
    /// than a pixel.
    fn thickness(&self) -> R;

    /// Where it is the far side of a solid for who looks along these directions, and may have been left out; `None` if it
    /// never is.
    #[inline(always)]
    fn is_far<L: SimdFloat<Real = R>>(&self, _sight: Vec3<L>) -> Option<L::Mask> {
        None
    }

    /// How thick it is as what light of these directions is blocked by: nothing where it may have been left out before the
    /// light.
    #[inline(always)]
    fn breadth<L: SimdFloat<Real = R>>(&self, directions: Vec3<L>) -> L {
        directions.x.like(self.thickness())
    }

    /// The unit normal of what is flat, and how far that goes at most; `None` for what is not. What is round is flat as
    /// far as it hardly turns, and has no one normal there: it is 0.
    fn flat(&self) -> Option<(Vec3<R>, R)> {
        None
    }

    /// Whether it has an outline of its own, beside which nothing of the same thing goes on.
    #[inline(always)]
    fn has_outline(&self) -> bool {
        !Self::IS_ENDLESS
    }

    /// A point of it, and how far from there it reaches.
    fn reach(&self) -> (Vec3<R>, R);

    /// Whether this primitive alone hides all of `ball` from `light`; `false` may be wrong.
    fn hides(&self, _light: DVec3, _ball: &Ball) -> bool {
        false
    }

    /// What the test needs of unit directions.
    fn prepare<L: SimdFloat<Real = R>>(directions: Vec3<L>) -> Self::Prepared<L>;

    /// The smallest t > 0 at which the rays meet it; infinity where they do not.
    fn intersect<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        methods: &Methods,
    ) -> L;

    /// The same, and from where along rays that are so blurred it is undecided whether they meet it: infinity where
    /// that is decided. `None` if none does that is wanted; where one is not wanted, anything.
    fn intersect_in_doubt<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        methods: &Methods,
        blur_where_wanted: (&Blur<L>, L::Mask),
    ) -> Option<(L, L)>;

    /// Where rays that start on it meet it again; infinity for what is flat.
    #[inline(always)]
    fn exit<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>) -> L {
        rays.origin.x.like(R::INFINITY)
    }

    /// The hits at `t`, drawn onto the surface.
    fn refine<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, t: L) -> SurfacePoint<L>;

    /// How close rays come to it; `None` if `matters` says that this does not, of the same with a distance that may be
    /// too short.
    fn approach<L: SimdFloat<Real = R>>(
        &self,
        rays: &Ray<L>,
        prepared: &Self::Prepared<L>,
        matters: impl FnOnce(&Approach<L>) -> bool,
    ) -> Option<Approach<L>>;

    /// How far behind the end of rays it may begin and still be close to them, where a pixel is so wide.
    #[inline(always)]
    fn margin<L: SimdFloat<Real = R>>(&self, width: L) -> L {
        width
    }

    /// [`Self::intersect`] for a single test.
    #[inline(always)]
    fn meet<L: SimdFloat<Real = R>>(&self, rays: &Ray<L>, methods: &Methods) -> L {
        self.intersect(rays, &Self::prepare(rays.direction), methods)
    }
}
