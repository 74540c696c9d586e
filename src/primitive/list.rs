//! All primitives of a scene, one list per kind.

use super::disc::PackedDisc;
use super::kind::{Packing, Primitive};
use super::plane::PackedPlane;
use super::projector::Rectangle;
use super::sphere::PackedSphere;
use super::triangle::PackedTriangle;
use crate::scene::Shape;
use crate::simd::{Real, SimdFloat, Vec3};

/// Work on every list, compiled separately for each kind.
pub trait Visit<R: Real> {
    /// Works on one list; `first` is the number of its first primitive.
    fn visit<P: Primitive<R>>(&mut self, kind: Kind, primitives: &[P], first: usize);
}

/// Work on one primitive, compiled separately for each kind.
pub trait WithPrimitive<R: Real> {
    /// The result.
    type Output;
    /// Works on the primitive.
    fn run<P: Primitive<R>>(self, primitive: &P) -> Self::Output;
}

/// Work on one primitive and the prepared data of its test, compiled separately for each kind.
pub trait WithPrepared<L: SimdFloat> {
    /// Works on the primitive.
    fn run<P: Primitive<L::Real>>(&mut self, primitive: &P, prepared: &P::Prepared<L>);
}

/// Where a packed shape was stored.
#[derive(Clone, Copy, Debug)]
pub struct Packed {
    /// The kind, which determines the list.
    pub kind: Kind,
    /// The index in the list.
    pub index: usize,
    /// Its rectangle in the picture, if there is a projector and the shape is bounded.
    pub rectangle: Option<Rectangle>,
}

macro_rules! kinds {
    ($($kind:ident in $list:ident: $packed:ident),*) => {
        /// The kinds of primitives, in the order of their numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Kind {
            $(#[doc = concat!("See [`", stringify!($packed), "`].")] $kind),*
        }

        /// The number of kinds.
        pub const KINDS: usize = [$(Kind::$kind),*].len();

        /// All packed primitives, one list per kind. A primitive's number counts through the lists in
        /// the order of [`Kind`], and is exact in `f32` below 2²⁴.
        #[derive(Clone, Debug)]
        pub struct Primitives<R> {
            $(#[doc = concat!("Every [`", stringify!($packed), "`].")] pub $list: Vec<$packed<R>>,)*
            /// For each triangle, the first triangle of the component that it is part of, or `None` if it is one by
            /// itself; empty if all are.
            pub components: Vec<Option<u32>>,
        }

        /// Data derived from ray directions for the test of each kind.
        #[derive(Clone, Copy)]
        pub struct Prepared<L: SimdFloat> {
            $(#[doc = concat!("For [`", stringify!($packed), "`].")] pub $list: <$packed<L::Real> as Primitive<L::Real>>::Prepared<L>),*
        }

        impl<L: SimdFloat> Prepared<L> {
            /// Derives the data from unit directions.
            #[inline(always)]
            pub fn new(directions: Vec3<L>) -> Self {
                Self { $($list: $packed::<L::Real>::prepare(directions)),* }
            }
        }

        impl<R> Default for Primitives<R> {
            fn default() -> Self {
                Self { $($list: Vec::new(),)* components: Vec::new() }
            }
        }

        impl<R: Real> Primitives<R> {
            /// Packs a shape, unless no ray can hit it. Returns where it was stored.
            pub fn push(&mut self, shape: &Shape, material: u32, packing: &Packing) -> Option<Packed> {
                match shape {
                    $(Shape::$kind(description) => {
                        let index = self.$list.len();
                        self.$list.push($packed::pack(description, material, packing)?);
                        let to_rectangle = |projector| $packed::<R>::rectangle(description, projector);
                        Some(Packed {
                            kind: Kind::$kind,
                            index,
                            rectangle: packing.projector.and_then(to_rectangle),
                        })
                    }),*
                    // A mesh is many primitives, which are stored elsewhere.
                    Shape::Mesh(_) => None,
                }
            }

            /// The number of primitives of each kind.
            pub fn counts(&self) -> [usize; KINDS] {
                [$(self.$list.len()),*]
            }

            /// Visits the lists in order.
            #[inline(always)]
            pub fn visit(&self, visitor: &mut impl Visit<R>) {
                let mut first = 0;
                $(
                    visitor.visit(Kind::$kind, &self.$list, first);
                    first += self.$list.len();
                )*
                let _ = first;
            }

            /// Runs `work` on the primitive with this number.
            ///
            /// # Panics
            /// If there is no primitive of this number.
            #[inline(always)]
            pub fn with<W: WithPrimitive<R>>(&self, number: usize, work: W) -> W::Output {
                let mut index = number;
                $(
                    if index < self.$list.len() {
                        return work.run(&self.$list[index]);
                    }
                    index -= self.$list.len();
                )*
                unreachable!("there is no primitive {index} behind the last")
            }

            /// Runs `work` on the primitive with this number and its prepared data.
            ///
            /// # Panics
            /// If there is no primitive of this number.
            #[inline(always)]
            pub fn with_prepared<L: SimdFloat<Real = R>>(&self, number: usize, prepared: &Prepared<L>, work: &mut impl WithPrepared<L>) {
                let mut index = number;
                $(
                    if index < self.$list.len() {
                        return work.run(&self.$list[index], &prepared.$list);
                    }
                    index -= self.$list.len();
                )*
                unreachable!("there is no primitive {index} behind the last")
            }
        }
    };
}

kinds! {
    Plane in planes: PackedPlane,
    Sphere in spheres: PackedSphere,
    Triangle in triangles: PackedTriangle,
    Disc in discs: PackedDisc
}

impl<R: Real> Primitives<R> {
    /// The number of the first primitive of each kind.
    pub fn firsts(&self) -> [usize; KINDS] {
        let mut next = 0;
        self.counts().map(|count| {
            let first = next;
            next += count;
            first
        })
    }

    /// The number of the first primitive of the component that a primitive is part of: its own, if it is one by itself.
    #[inline(always)]
    pub fn component_of(&self, number: usize) -> usize {
        let first = self.firsts()[Kind::Triangle as usize];
        let index = number.checked_sub(first);
        let component = index.and_then(|index| *self.components.get(index)?);
        component.map_or(number, |component| first + component as usize)
    }

    /// The number of primitives.
    pub fn len(&self) -> usize {
        self.counts().iter().sum()
    }

    /// Returns whether there are no primitives.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of bounded primitives.
    pub fn bounded(&self) -> usize {
        self.len() - self.planes.len()
    }
}
