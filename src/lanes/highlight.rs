//! The power of a Phong highlight, max(0, n·h)^p, without the rounding that a large p magnifies.

use super::{Lane, Real};

/// Largest whole exponent that is raised by repeated squaring; its relative error is below p·u.
const LARGEST_SQUARED: f64 = 256.0;

/// A Phong exponent, made ready: how (n·h)^p is best computed depends on p alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exponent {
    /// A small whole number: repeated squaring, exact operations only.
    Whole(u32),
    /// Anything else: exp(p·log1p(-w)) with w = |n - h|²/2 = 1 - n·h.
    ///
    /// n·h near 1 has lost what a large p needs, w has not: at p = 10⁶ the single-precision power
    /// is off by 43 levels of 255, this form by 0.01.
    Real(f64),
}

impl Exponent {
    /// Chooses the form for the exponent `p` ≥ 0.
    pub fn new(p: f64) -> Self {
        if p.fract() == 0.0 && p <= LARGEST_SQUARED {
            Self::Whole(p as u32)
        } else {
            Self::Real(p)
        }
    }

    /// max(0, n·h)^p, given n·h and w = |n - h|²/2 of unit vectors n and h. NaN counts as 0.
    #[inline(always)]
    pub fn power<L: Lane>(self, token: L::Token, n_dot_h: L, w: L) -> L {
        let zero = L::splat(token, L::Real::ZERO);
        match self {
            Self::Whole(p) => whole_power(token, n_dot_h.max(zero), p),
            Self::Real(p) => L::from_fn(token, |lane| {
                if n_dot_h.lane(lane) > L::Real::ZERO {
                    L::Real::from_f64(libm::exp(p * libm::log1p(-w.lane(lane).to_f64())))
                } else {
                    L::Real::ZERO
                }
            }),
        }
    }
}

#[inline(always)]
fn whole_power<L: Lane>(token: L::Token, base: L, mut exponent: u32) -> L {
    let (mut result, mut square) = (L::splat(token, L::Real::ONE), base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * square;
        }
        square = square * square;
        exponent >>= 1;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Vec3;

    /// Worst difference to the exact power over half-vectors around the peak, in levels of 255.
    fn worst_level(p: f64, power: impl Fn(Vec3<f32>, Vec3<f32>) -> f32) -> f64 {
        let n = Vec3::new(0.36_f64, 0.48, 0.8);
        let across = Vec3::new(0.8_f64, -0.6, 0.0);
        (0..400)
            .map(|i| {
                let angle = 4.0 / p.sqrt() * f64::from(i) / 400.0;
                let h = n * angle.cos() + across * angle.sin();
                let exact = angle.cos().max(0.0).powf(p);
                let got = power(Vec3::from_f64(n), Vec3::from_f64(h));
                (f64::from(got) - exact).abs() * 255.0
            })
            .fold(0.0, f64::max)
    }

    fn ours(p: f64) -> f64 {
        worst_level(p, |n, h| {
            let d = n - h;
            Exponent::new(p).power((), n.dot(h), d.dot(d) * 0.5)
        })
    }

    #[test]
    fn highlights_stay_within_half_a_level_up_to_a_million() {
        for p in [0.5, 1.0, 16.0, 100.5, 256.0, 257.0, 1e4, 1e5, 1e6] {
            assert!(ours(p) <= 0.5, "p = {p}: {} levels", ours(p));
        }
        let plain = worst_level(1e6, |n, h| n.dot(h).max(0.0).powf(1e6_f64 as f32));
        assert!(
            plain > 5.0,
            "the plain power must fail at 1e6, or this test has no power: {plain}"
        );
    }

    #[test]
    fn zero_is_flat_and_the_dark_side_is_dark() {
        assert_eq!(Exponent::new(0.0).power((), 0.3_f32, 0.7), 1.0);
        for p in [16.0, 16.5, 1e4] {
            assert_eq!(Exponent::new(p).power((), -0.99_f32, 1.99), 0.0);
        }
    }
}
