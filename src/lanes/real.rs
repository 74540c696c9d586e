//! The real number of a kernel.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number that kernels compute in: `f32` for speed, `f64` as the reference.
///
/// Only operations that IEEE 754 rounds correctly are offered, so results are the same everywhere.
/// Comparisons are those of `PartialOrd`: a NaN compares false, and kernels are written so that it
/// then means "no hit".
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Largest relative error of one rounding, `u` in error bounds (2⁻²⁴ for `f32`).
    const UNIT_ROUNDOFF: Self;
    /// Positive infinity: the `t` of a ray that hits nothing.
    const INFINITY: Self;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// What `--stats` calls this instance, for example `f32×1`.
    const NAME: &'static str;

    /// The nearest representable number.
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision (exact).
    fn to_f64(self) -> f64;
    /// Square root, correctly rounded; NaN below zero.
    fn sqrt(self) -> Self;
    /// Distance from zero.
    fn abs(self) -> Self;
    /// The smaller of two numbers; the other one where one is NaN.
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers; the other one where one is NaN.
    fn max(self, other: Self) -> Self;
}

macro_rules! real {
    ($type:ty, $name:literal) => {
        impl Real for $type {
            const UNIT_ROUNDOFF: Self = <$type>::EPSILON / 2.0;
            const INFINITY: Self = <$type>::INFINITY;
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const NAME: &'static str = $name;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
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
            fn min(self, other: Self) -> Self {
                self.min(other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }
        }
    };
}

real!(f32, "f32×1");
real!(f64, "f64×1");
