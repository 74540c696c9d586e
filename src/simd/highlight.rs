//! The power of a Phong highlight, max(0, n·h)^p, without the rounding error that a large p magnifies.
//!
//! It only uses additions, multiplications, divisions and square roots, so that every lane of every machine gives
//! the same bits. Errors are stated in levels of 255.

use super::{Real, SimdFloat, Vec3};

/// The largest exponent whose whole part is computed by repeated squaring, with a relative error below p·u.
const MAX_SQUARED: f64 = 256.0;
/// Number of square roots in [`logarithm`], and of squarings in [`exponential`].
const HALVINGS: u32 = 6;
/// Exponents below this give far less than one level.
const MIN_EXPONENT: f64 = -30.0;

/// A Phong exponent, prepared: the best way to compute (n·h)^p depends only on p.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponent {
    /// A small whole number: repeated squaring.
    Whole(u32),
    /// A small number: squaring for its whole part, exp(f·log(n·h)) for the fraction f.
    Mixed(u32, f64),
    /// A large number: exp(p·log1p(-w)) with w = |n - h|²/2 = 1 - n·h.
    ///
    /// Rounding n·h near 1 loses digits that a large p needs, but w keeps them: at p = 10⁶, the single-precision
    /// power is off by 43 levels, this form by less than 0.1.
    Large(f64),
}

impl Exponent {
    /// Chooses the form for the exponent `p` ≥ 0.
    pub fn new(p: f64) -> Self {
        if p > MAX_SQUARED {
            Self::Large(p)
        } else {
            Self::power(p)
        }
    }

    /// The plain power for any p: at 10⁶ it is off by 43 levels in single precision.
    pub fn power(p: f64) -> Self {
        if p.fract() == 0.0 {
            Self::Whole(p as u32)
        } else {
            Self::Mixed(p as u32, p.fract())
        }
    }

    /// The |n - h| at which the highlight has fallen to e^-½, if the highlight may be smaller than a pixel.
    pub fn size(self) -> Option<f64> {
        let p = match self {
            Self::Whole(p) => f64::from(p),
            Self::Mixed(whole, fraction) => f64::from(whole) + fraction,
            Self::Large(p) => p,
        };
        // Depends on p alone, not on the variant: the formula must not influence where samples are taken.
        (p > MAX_SQUARED).then(|| 1.0 / p.sqrt())
    }

    /// max(0, n·h)^p, where h is the unit vector along `half`; n·h counts as 0 if `half` has no direction. Off by at
    /// most 0.5 levels for p ≤ 10⁶.
    #[inline(always)]
    pub fn highlight<L: SimdFloat>(self, n: Vec3<L>, half: Vec3<L>) -> L {
        let zero = n.x.like(L::Real::ZERO);
        let (n_dot_half, half_square) = (n.dot(half).max(zero), half.dot(half));
        match self {
            // (n·h)² needs no square root.
            Self::Whole(p) if p.is_multiple_of(2) => {
                let square = (n_dot_half * n_dot_half / half_square).max(zero);
                whole_power(square, p / 2)
            }
            Self::Whole(p) => whole_power((n_dot_half / half_square.sqrt()).max(zero), p),
            Self::Mixed(whole, fraction) => {
                let base = (n_dot_half / half_square.sqrt()).max(zero);
                let exponent = base.like_f64(fraction) * logarithm(base);
                whole_power(base, whole) * exponential(exponent)
            }
            Self::Large(p) => {
                let off = n - half * (half_square.like(L::Real::ONE) / half_square.sqrt());
                let w = off.dot(off) * half_square.like_f64(0.5);
                let power = exponential(-w.like_f64(p) * negative_log1p(w));
                L::select(zero.less(n_dot_half), power, zero)
            }
        }
    }
}

#[inline(always)]
fn whole_power<L: SimdFloat>(base: L, mut exponent: u32) -> L {
    let (mut result, mut square) = (base.like(L::Real::ONE), base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * square;
        }
        square = square * square;
        exponent >>= 1;
    }
    result
}

/// -log1p(-w) = 2·artanh(w / (2 - w)) by the first terms of the series: relative error below 10⁻¹¹ for w ≤ 0.15.
/// For larger w, it is at least 0.15, which suffices for a large power to vanish.
#[inline(always)]
fn negative_log1p<L: SimdFloat>(w: L) -> L {
    let z = w / (w.like_f64(2.0) - w);
    artanh(z) * z.like_f64(2.0)
}

/// log(x) = 2⁶·log(x^(1/2⁶)) for 10⁻¹² ≤ x ≤ 1, off by at most 2⁷u in single precision and by 10⁻⁹ in double;
/// finite for smaller x.
#[inline(always)]
fn logarithm<L: SimdFloat>(x: L) -> L {
    let one = x.like(L::Real::ONE);
    let mut root = x;
    for _ in 0..HALVINGS {
        root = root.sqrt();
    }
    let z = (root - one) / (root + one);
    artanh(z) * z.like_f64(f64::from(2 << HALVINGS))
}

/// z + z³/3 + … + z¹³/13.
#[inline(always)]
fn artanh<L: SimdFloat>(z: L) -> L {
    let square = z * z;
    let mut sum = z.like_f64(1.0 / 13.0);
    let mut divisor = 11.0;
    while divisor > 0.0 {
        sum = sum * square + z.like_f64(1.0 / divisor);
        divisor -= 2.0;
    }
    sum * z
}

/// exp(x) = exp(x/2⁶)^(2⁶) for x ≤ 0 by the terms up to y¹¹ of Taylor's series; for x ≥ -20 the relative error is
/// below 2⁷u in single precision and below 10⁻¹² in double, for any the absolute error below 10⁻¹².
#[inline(always)]
fn exponential<L: SimdFloat>(x: L) -> L {
    let y = x.max(x.like_f64(MIN_EXPONENT)) * x.like_f64(1.0 / f64::from(1 << HALVINGS));
    let one = x.like(L::Real::ONE);
    let mut sum = one;
    let mut divisor = 11.0;
    while divisor > 0.0 {
        sum = sum * y * y.like_f64(1.0 / divisor) + one;
        divisor -= 1.0;
    }
    for _ in 0..HALVINGS {
        sum = sum * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Greatest difference from the exact power for half-vectors around the peak, in levels of 255.
    fn worst_level(p: f64, power: impl Fn(Vec3<f32>, Vec3<f32>) -> f32) -> f64 {
        let n = DVec3::new(0.36_f64, 0.48, 0.8);
        let across = DVec3::new(0.8_f64, -0.6, 0.0);
        (0..400)
            .map(|i| {
                let angle = 4.0 / p.sqrt() * f64::from(i) / 400.0;
                let h = n * angle.cos() + across * angle.sin();
                let exact = angle.cos().max(0.0).powf(p);
                let got = power(Vec3::from_dvec3(n), Vec3::from_dvec3(h));
                (f64::from(got) - exact).abs() * 255.0
            })
            .fold(0.0, f64::max)
    }

    fn worst_of_highlight(p: f64) -> f64 {
        worst_level(p, |n, h| Exponent::new(p).highlight(n, h))
    }

    #[test]
    fn highlights_stay_within_half_a_level_up_to_a_million() {
        for p in [
            0.05, 0.5, 1.0, 16.0, 16.9, 100.5, 255.5, 256.0, 256.5, 257.0, 1e3, 1e4, 1e5, 1e6,
        ] {
            assert!(
                worst_of_highlight(p) <= 0.5,
                "p = {p}: {} levels",
                worst_of_highlight(p)
            );
        }
        let plain = worst_level(1e6, |n, h| n.dot(h).max(0.0).powf(1e6_f64 as f32));
        assert!(
            plain > 5.0,
            "the plain power must fail at 1e6, or this test has no power: {plain}"
        );
    }

    #[test]
    fn the_reference_is_exact() {
        let n = DVec3::new(0.36_f64, 0.48, 0.8);
        let across = DVec3::new(0.8_f64, -0.6, 0.0);
        for p in [0.05, 0.5, 16.0, 17.0, 100.5, 257.0, 1e4, 1e6] {
            for i in 0..400 {
                let angle = (4.0 / f64::sqrt(p)).min(1.57) * f64::from(i) / 400.0;
                let half = (n * angle.cos() + across * angle.sin()) * 1.7;
                let error: f64 = Exponent::new(p)
                    .highlight(Vec3::<f64>::from_dvec3(n), Vec3::from_dvec3(half))
                    - angle.cos().powf(p);
                assert!(error.abs() < 1e-9, "p = {p}, angle {angle}: {error:e}");
            }
        }
    }

    #[test]
    fn zero_is_flat_and_the_dark_side_is_dark() {
        let n = Vec3::new(0.0_f32, 0.0, 1.0);
        let half = Vec3::new(0.954, 0.0, 0.3);
        assert_eq!(Exponent::new(0.0).highlight(n, half), 1.0);
        for p in [15.0, 16.0, 16.5, 1e4] {
            assert_eq!(Exponent::new(p).highlight(n, -half), 0.0);
            let nowhere = Vec3::splat(0.0);
            assert_eq!(
                Exponent::new(p).highlight(n, nowhere),
                0.0,
                "no half-vector"
            );
        }
    }
}
