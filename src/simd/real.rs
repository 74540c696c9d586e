//! The real number of a kernel.

use super::SimdFloat;

/// A real number that kernels compute in: `f32` for speed, `f64` as the reference. By itself it is
/// one lane.
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

    /// The nearest representable number.
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision (exact).
    fn to_f64(self) -> f64;
    /// The nearest whole number, of two the even one; for 0 ≤ self < 2²².
    fn nearest(self) -> u32;
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
            fn nearest(self) -> u32 {
                // So far from zero, the last bit of the mantissa is worth one. A cast would not be
                // done for many numbers in step.
                (self + (1_u64 << (<$type>::MANTISSA_DIGITS - 1)) as $type).to_bits() as u32
                    & 0x7F_FFFF
            }
        }
    };
}

real!(f32, "f32");
real!(f64, "f64");
