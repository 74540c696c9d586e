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
pub enum IgnoredPrimitive<L> {
    /// None.
    Nothing,
    /// All rays start on the primitive of this number.
    Shared(usize),
    /// Each ray starts on the primitive whose number is in its lane; [`NOTHING`] for none.
    Each(L),
}

/// The number of no primitive.
pub const NOTHING: f64 = -1.0;

/// A number of a primitive as the kernels count.
#[inline(always)]
pub fn real<R: Real>(number: usize) -> R {
    R::from_f64(number as f64)
}

impl<L: SimdFloat> IgnoredPrimitive<L> {
    /// This where the mask is set, `other` elsewhere.
    #[inline(always)]
    pub fn over(self, token: L::Token, mask: L::Mask, other: Self) -> Self {
        match (self, other) {
            (Self::Nothing, Self::Nothing) => self,
            (Self::Shared(this), Self::Shared(other)) if this == other => self,
            _ => Self::Each(L::select(mask, self.numbers(token), other.numbers(token))),
        }
    }

    /// Where it is the primitive of this number.
    #[inline(always)]
    pub fn is(self, token: L::Token, number: usize) -> L::Mask {
        self.numbers(token).same(L::splat(token, real(number)))
    }

    /// The number in each lane; [`NOTHING`] for none.
    #[inline(always)]
    pub fn numbers(self, token: L::Token) -> L {
        match self {
            Self::Nothing => L::splat(token, L::Real::from_f64(NOTHING)),
            Self::Shared(number) => L::splat(token, real(number)),
            Self::Each(numbers) => numbers,
        }
    }
}

impl<L: SimdFloat> Paths<L> {
    /// How far the primitive of this number is; infinity for none, and where the rays start on it.
    #[inline(always)]
    pub fn distance<P: Primitive<L::Real>>(
        &self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        number: usize,
        methods: &Methods,
    ) -> L {
        let rays = &self.rays;
        match self.ignored {
            IgnoredPrimitive::Shared(start) if start == number => primitive.exit(rays),
            IgnoredPrimitive::Nothing | IgnoredPrimitive::Shared(_) => {
                primitive.intersect(rays, prepared, methods)
            }
            IgnoredPrimitive::Each(_) => {
                self.distance_in_tree(primitive, prepared, number, methods)
            }
        }
    }

    /// The same, written for all cases at once: what stands in a tree is tested in several places, and the
    /// compiler has each of them to work on.
    #[inline(always)]
    pub fn distance_in_tree<P: Primitive<L::Real>>(
        &self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        number: usize,
        methods: &Methods,
    ) -> L {
        let rays = &self.rays;
        let t = primitive.intersect(rays, prepared, methods);
        let own = self.ignored.is(t.token(), number);
        if !P::IS_CURVED || own.any() {
            L::select(own, primitive.exit(rays), t)
        } else {
            t
        }
    }
}
