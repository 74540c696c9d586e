//! Rays together with the primitives that they start on.

use crate::primitive::{Primitive, Ray};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Rays and the primitives that they start on, which they must not hit at their origins.
#[derive(Clone, Copy, Debug)]
pub struct Paths<L> {
    /// The rays.
    pub rays: Ray<L>,
    /// The primitives that they start on.
    pub ignored: IgnoredPrimitive<L>,
}

/// The primitives that rays start on.
#[derive(Clone, Copy, Debug)]
pub struct IgnoredPrimitive<L> {
    /// The number in each lane; [`NO_PRIMITIVE`] for none.
    numbers: L,
    /// The number of the listed primitive that all of them may start on, [`UNLISTED`] if none starts on one; `None`
    /// where they differ.
    listed: Option<usize>,
}

/// A number that no listed primitive has.
const UNLISTED: usize = usize::MAX;

/// The number that stands for no primitive.
pub const NO_PRIMITIVE: f64 = -1.0;

/// Converts the number of a primitive to the kernels' real type.
#[inline(always)]
pub fn real<R: Real>(number: usize) -> R {
    R::from_f64(number as f64)
}

impl<L: SimdFloat> IgnoredPrimitive<L> {
    /// No primitive for any ray.
    #[inline(always)]
    pub fn nothing(token: L::Token) -> Self {
        Self::in_tree(L::splat(token, L::Real::from_f64(NO_PRIMITIVE)))
    }

    /// The same listed primitive for all rays that count: `numbers` has its number in their lanes.
    #[inline(always)]
    pub fn listed(number: usize, numbers: L) -> Self {
        Self {
            numbers,
            listed: Some(number),
        }
    }

    /// For each ray the primitive in a tree whose number is in its lane.
    #[inline(always)]
    pub fn in_tree(numbers: L) -> Self {
        Self::listed(UNLISTED, numbers)
    }

    /// Returns `self` if `is_needed`, else no primitive. Field by field: as a whole it would be copied with the padding
    /// between its fields, and the processor would stall on that.
    #[inline(always)]
    pub fn only_if(self, is_needed: bool) -> Self {
        let none = Self::nothing(self.numbers.token());
        Self {
            numbers: if is_needed {
                self.numbers
            } else {
                none.numbers
            },
            listed: if is_needed { self.listed } else { none.listed },
        }
    }

    /// Returns `self` where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn select(self, mask: L::Mask, other: Self) -> Self {
        Self {
            numbers: L::select(mask, self.numbers, other.numbers),
            listed: self.listed.filter(|_| self.listed == other.listed),
        }
    }

    /// Returns where the rays start on the primitive with this number.
    #[inline(always)]
    pub fn starts_on(self, number: usize) -> L::Mask {
        self.numbers.same(self.numbers.like(real(number)))
    }

    /// Returns the number of the listed primitive that all rays start on, if they share one.
    #[inline(always)]
    pub fn shared(self) -> Option<usize> {
        self.listed.filter(|&number| number != UNLISTED)
    }
}

impl<L: SimdFloat> Paths<L> {
    /// Returns the distance of the primitive with this number; infinity where rays miss it. Where they start on it,
    /// it is the distance at which they hit it again. Without `LISTED`, the code is the same for all cases:
    /// primitives in a tree are tested in several places, each of which the compiler has to process.
    #[inline(always)]
    pub fn distance<const LISTED: bool, P: Primitive<L::Real>>(
        &self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        number: usize,
        methods: &Methods,
    ) -> L {
        let rays = &self.rays;
        if LISTED && let Some(start) = self.ignored.listed {
            return if start == number {
                primitive.exit(rays)
            } else {
                primitive.intersect(rays, prepared, methods)
            };
        }
        let t = primitive.intersect(rays, prepared, methods);
        let starts_here = self.ignored.starts_on(number);
        if !P::IS_CURVED || starts_here.any() {
            L::select(starts_here, primitive.exit(rays), t)
        } else {
            t
        }
    }
}
