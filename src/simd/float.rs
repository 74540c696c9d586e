//! SIMD lanes: several real numbers computed in step, one for each ray.

use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use fearless_simd::{Select as _, Simd, SimdMask};

/// The greatest number of lanes on any processor.
pub const MAX_LANES: usize = 16;

/// A vector of real numbers of one type, computed in step.
///
/// Every operation is correctly rounded as defined by IEEE 754 in every lane, so a lane's result does not depend on
/// the number of lanes. A comparison with NaN is false.
pub trait SimdFloat:
    Copy
    + Send
    + 'static
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The type of one lane.
    type Real: Real;
    /// One truth value per lane.
    type Mask: Mask + Send;
    /// The proof that the processor supports these vectors.
    type Token: Copy;
    /// The number of lanes.
    const WIDTH: usize;
    /// Whether it is worthwhile to compile faster kernels for simple scenes in addition: only for vectors in single
    /// precision.
    const HAS_SIMPLE_KERNELS: bool;

    /// The same number in every lane.
    fn splat(token: Self::Token, value: Self::Real) -> Self;
    /// The proof that the processor supports these vectors, which every vector carries.
    fn token(self) -> Self::Token;
    /// Broadcasts a number to as many lanes as this vector has.
    #[inline(always)]
    fn like(self, value: Self::Real) -> Self {
        Self::splat(self.token(), value)
    }
    /// Broadcasts the nearest representable number to as many lanes as this vector has.
    #[inline(always)]
    fn like_f64(self, value: f64) -> Self {
        self.like(Self::Real::from_f64(value))
    }
    /// `number(i)` in lane i.
    fn from_fn(token: Self::Token, number: impl FnMut(usize) -> Self::Real) -> Self;
    /// Loads the first [`Self::WIDTH`] numbers of a slice, which must have as many.
    fn load(token: Self::Token, numbers: &[Self::Real]) -> Self;
    /// Does the same with numbers in single precision.
    fn load_singles(token: Self::Token, numbers: &[f32]) -> Self;
    /// Writes the lanes to the start of a slice, which must have room for them.
    fn store(self, numbers: &mut [Self::Real]);
    /// The number in one lane, `index` < [`Self::WIDTH`].
    fn lane(self, index: usize) -> Self::Real;
    /// Runs `work`, which must be `#[inline(always)]`, as a function of its own that is compiled for the
    /// processor's instructions: needed for recursion, which cannot be inlined.
    fn vectorize<T>(token: Self::Token, work: impl FnOnce() -> T) -> T;
    /// Square root; NaN below zero.
    fn sqrt(self) -> Self;
    /// Distance from zero.
    fn abs(self) -> Self;
    /// self < other.
    fn less(self, other: Self) -> Self::Mask;
    /// self ≤ other.
    fn at_most(self, other: Self) -> Self::Mask;
    /// self = other.
    fn same(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is set, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The smallest lane; none may be NaN.
    fn least(self) -> Self::Real;
    /// The largest lane; none may be NaN.
    fn greatest(self) -> Self::Real;

    /// The smaller number; `other` where either is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.less(other), self, other)
    }

    /// The larger number; `other` where either is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.less(self), self, other)
    }
}

/// A real number type for kernels: `f32` for speed, `f64` as the reference. By itself it is a vector of one lane.
pub trait Real:
    SimdFloat<Real = Self, Mask = bool, Token = ()> + Default + PartialOrd + Send + Sync + 'static
{
    /// Largest relative error of one rounding, `u` in error bounds (2⁻²⁴ for `f32`).
    const UNIT_ROUNDOFF: Self;
    /// Positive infinity: the `t` of a ray that hits nothing.
    const INFINITY: Self;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Its name in Rust.
    const NAME: &'static str;
    /// Whether results that rounding may have decided are computed again in double precision.
    const IS_FILTERED: bool;

    /// The nearest representable number.
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision (exact).
    fn to_f64(self) -> f64;
    /// Converts a number from single precision (exact).
    #[inline(always)]
    fn from_single(number: f32) -> Self {
        Self::from_f64(number.into())
    }
    /// The nearest integer, ties to even; for 0 ≤ self < 2²².
    fn nearest(self) -> u32;
}

macro_rules! real {
    ($type:ty, $name:literal, $is_filtered:literal) => {
        impl Real for $type {
            const UNIT_ROUNDOFF: Self = <$type>::EPSILON / 2.0;
            const INFINITY: Self = <$type>::INFINITY;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const NAME: &'static str = $name;
            const IS_FILTERED: bool = $is_filtered;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
            #[inline(always)]
            fn nearest(self) -> u32 {
                // At this magnitude, the last bit of the mantissa is worth one. A cast would not be vectorised.
                (self + (1_u64 << (<$type>::MANTISSA_DIGITS - 1)) as $type).to_bits() as u32
                    & 0x7F_FFFF
            }
        }
    };
}

real!(f32, "f32", true);
real!(f64, "f64", false);

/// One truth value per lane.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Bit i is lane i.
    fn bits(self) -> u64;
    /// Whether any lane is true.
    fn any(self) -> bool;
}

macro_rules! single_lane {
    ($type:ty) => {
        impl SimdFloat for $type {
            type Real = Self;
            type Mask = bool;
            type Token = ();
            const WIDTH: usize = 1;
            const HAS_SIMPLE_KERNELS: bool = false;

            #[inline(always)]
            fn splat((): (), value: Self) -> Self {
                value
            }
            #[inline(always)]
            fn token(self) {}
            #[inline(always)]
            fn from_fn((): (), mut number: impl FnMut(usize) -> Self) -> Self {
                number(0)
            }
            #[inline(always)]
            fn load((): (), numbers: &[Self]) -> Self {
                numbers[0]
            }
            #[inline(always)]
            fn load_singles((): (), numbers: &[f32]) -> Self {
                Self::from_single(numbers[0])
            }
            #[inline(always)]
            fn store(self, numbers: &mut [Self]) {
                numbers[0] = self;
            }
            #[inline(always)]
            fn lane(self, _: usize) -> Self {
                self
            }
            #[inline(always)]
            fn vectorize<T>((): (), work: impl FnOnce() -> T) -> T {
                call_out_of_line(work)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn at_most(self, other: Self) -> bool {
                self <= other
            }
            #[inline(always)]
            fn same(self, other: Self) -> bool {
                self == other
            }
            #[inline(always)]
            fn least(self) -> Self {
                self
            }
            #[inline(always)]
            fn greatest(self) -> Self {
                self
            }
            #[inline(always)]
            fn select(mask: bool, yes: Self, no: Self) -> Self {
                if mask { yes } else { no }
            }
        }
    };
}

single_lane!(f32);
single_lane!(f64);

impl Mask for bool {
    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self)
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

/// Runs the work as a function of its own. On targets whose instructions are enabled everywhere, nothing else keeps
/// it from being inlined at every call, and the kernels would take half as long again to compile.
#[inline(never)]
fn call_out_of_line<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// A vector register `V` of the processor type `S`.
#[derive(Clone, Copy, Debug)]
pub struct Wide<S, V> {
    vector: V,
    processor: PhantomData<S>,
}

/// The mask of a vector register.
#[derive(Clone, Copy, Debug)]
pub struct WideMask<S, M> {
    mask: M,
    processor: PhantomData<S>,
}

#[inline(always)]
fn wide<S, V>(vector: V) -> Wide<S, V> {
    Wide {
        vector,
        processor: PhantomData,
    }
}

#[inline(always)]
fn wide_mask<S, M>(mask: M) -> WideMask<S, M> {
    WideMask {
        mask,
        processor: PhantomData,
    }
}

macro_rules! wide_operation {
    ($trait:ident, $method:ident) => {
        impl<S: Simd, V: fearless_simd::SimdFloat<S>> $trait for Wide<S, V> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                wide($trait::$method(self.vector, other.vector))
            }
        }
    };
}

wide_operation!(Add, add);
wide_operation!(Sub, sub);
wide_operation!(Mul, mul);
wide_operation!(Div, div);

impl<S: Simd, V: fearless_simd::SimdFloat<S>> Neg for Wide<S, V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        wide(-self.vector)
    }
}

impl<S: Simd, V: fearless_simd::SimdFloat<S>> SimdFloat for Wide<S, V>
where
    V::Element: Real,
{
    type Real = V::Element;
    type Mask = WideMask<S, V::Mask>;
    type Token = S;
    const WIDTH: usize = V::LEN;
    const HAS_SIMPLE_KERNELS: bool = <V::Element as Real>::IS_FILTERED;

    #[inline(always)]
    fn splat(token: S, value: Self::Real) -> Self {
        wide(V::splat(token, value))
    }
    #[inline(always)]
    fn token(self) -> S {
        self.vector.token()
    }
    #[inline(always)]
    fn from_fn(token: S, number: impl FnMut(usize) -> Self::Real) -> Self {
        wide(V::from_fn(token, number))
    }
    #[inline(always)]
    fn load(token: S, numbers: &[Self::Real]) -> Self {
        wide(V::from_slice(token, &numbers[..V::LEN]))
    }
    #[inline(always)]
    fn load_singles(token: S, numbers: &[f32]) -> Self {
        // A loop, which is vectorised at high optimisation levels; in a closure, it would not be.
        let mut row = [V::Element::ZERO; MAX_LANES];
        for (entry, &number) in row.iter_mut().zip(&numbers[..V::LEN]) {
            *entry = V::Element::from_single(number);
        }
        wide(V::from_slice(token, &row[..V::LEN]))
    }
    #[inline(always)]
    fn store(self, numbers: &mut [Self::Real]) {
        self.vector.store_slice(&mut numbers[..V::LEN]);
    }
    #[inline(always)]
    fn lane(self, index: usize) -> Self::Real {
        self.vector.as_slice()[index]
    }
    #[inline(always)]
    fn vectorize<T>(token: S, work: impl FnOnce() -> T) -> T {
        call_out_of_line(move || token.vectorize(work))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        wide(self.vector.sqrt())
    }
    #[inline(always)]
    fn abs(self) -> Self {
        wide(self.vector.abs())
    }
    #[inline(always)]
    fn less(self, other: Self) -> Self::Mask {
        wide_mask(self.vector.simd_lt(other.vector))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Self::Mask {
        wide_mask(self.vector.simd_le(other.vector))
    }
    #[inline(always)]
    fn same(self, other: Self) -> Self::Mask {
        wide_mask(self.vector.simd_eq(other.vector))
    }
    #[inline(always)]
    fn least(self) -> Self::Real {
        self.vector.reduce_min()
    }
    #[inline(always)]
    fn greatest(self) -> Self::Real {
        self.vector.reduce_max()
    }
    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        wide(mask.mask.select(yes.vector, no.vector))
    }
}

macro_rules! mask_operation {
    ($trait:ident, $method:ident) => {
        impl<S: Simd, M: SimdMask<S>> $trait for WideMask<S, M> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                wide_mask($trait::$method(self.mask, other.mask))
            }
        }
    };
}

mask_operation!(BitAnd, bitand);
mask_operation!(BitOr, bitor);

impl<S: Simd, M: SimdMask<S>> Not for WideMask<S, M> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        wide_mask(!self.mask)
    }
}

impl<S: Simd, M: SimdMask<S>> Mask for WideMask<S, M> {
    #[inline(always)]
    fn bits(self) -> u64 {
        self.mask.to_bitmask()
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.mask.any_true()
    }
}
