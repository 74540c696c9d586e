//! Rays that have just started, and what they start on.

use crate::primitive::{Primitive, Ray};
use crate::scene::Methods;
use crate::simd::{Mask as _, Real, SimdFloat};

/// Rays and the primitives that they start on, which they must not meet where they start.
#[derive(Clone, Copy, Debug)]
pub struct Paths<L> {
    /// The rays.
    pub rays: Ray<L>,
    /// What they start on.
    pub ignored: IgnoredPrimitive<L>,
}

/// The primitives that rays start on.
#[derive(Clone, Copy, Debug)]
pub struct IgnoredPrimitive<L> {
    /// The number in each lane; [`NOTHING`] for none.
    numbers: L,
    /// The one number in a list that all of them may be, [`UNLISTED`] if none is; `None` where they differ.
    listed: Option<usize>,
}

/// A number that no list has.
const UNLISTED: usize = usize::MAX;

/// The number of no primitive.
pub const NOTHING: f64 = -1.0;

/// A number of a primitive as the kernels count.
#[inline(always)]
pub fn real<R: Real>(number: usize) -> R {
    R::from_f64(number as f64)
}

impl<L: SimdFloat> IgnoredPrimitive<L> {
    /// None.
    #[inline(always)]
    pub fn nothing(token: L::Token) -> Self {
        Self::in_tree(L::splat(token, L::Real::from_f64(NOTHING)))
    }

    /// All rays that count start on the primitive of this number, which is that in their lanes.
    #[inline(always)]
    pub fn listed(number: usize, numbers: L) -> Self {
        Self {
            numbers,
            listed: Some(number),
        }
    }

    /// Each ray starts on the primitive whose number is in its lane, and which stands in a tree.
    #[inline(always)]
    pub fn in_tree(numbers: L) -> Self {
        Self::listed(UNLISTED, numbers)
    }

    /// This, or none. Field by field: the whole of it would be copied with what is between its fields, for which
    /// the processor waits.
    #[inline(always)]
    pub fn only_if(self, is_so: bool) -> Self {
        let none = Self::nothing(self.numbers.token());
        Self {
            numbers: if is_so { self.numbers } else { none.numbers },
            listed: if is_so { self.listed } else { none.listed },
        }
    }

    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn over(self, mask: L::Mask, other: Self) -> Self {
        Self {
            numbers: L::select(mask, self.numbers, other.numbers),
            listed: self.listed.filter(|_| self.listed == other.listed),
        }
    }

    /// Where it is the primitive of this number.
    #[inline(always)]
    pub fn is(self, number: usize) -> L::Mask {
        self.numbers.same(self.numbers.like(real(number)))
    }

    /// The number in a list that all of them are, if they are one.
    #[inline(always)]
    pub fn shared(self) -> Option<usize> {
        self.listed.filter(|&number| number != UNLISTED)
    }
}

impl<L: SimdFloat> Paths<L> {
    /// How far the primitive of this number is; infinity for none, and where the rays start on it. Other
    /// than `LISTED`, it is written for all cases at once: what stands in a tree is tested in several places,
    /// and the compiler has each of them to work on.
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
        let own = self.ignored.is(number);
        if !P::IS_CURVED || own.any() {
            L::select(own, primitive.exit(rays), t)
        } else {
            t
        }
    }
}
