//! Which lanes the processor has, found out at run time.

use fearless_simd::{Simd, dispatch};

use super::lane::Wide;
use super::{Lane, Real};

/// A kind of processor, from one lane at a time to the widest vectors.
#[derive(Clone, Copy, Debug)]
pub enum Level {
    /// One number at a time, everywhere.
    Single,
    /// Vectors.
    Vectors(fearless_simd::Level),
}

/// Something to be done with lanes of any width.
pub trait Work<R: Real> {
    /// What it gives.
    type Output;
    /// Does it. Must be `#[inline(always)]`, as must be all that it calls in its inner loops:
    /// what is not inlined does not know the processor's instructions.
    fn run<L: Lane<Real = R>>(self, token: L::Token) -> Self::Output;
}

/// A real number that vectors exist of.
pub trait Vectored: Real {
    /// Does the work with vectors of this number.
    fn in_vectors<S: Simd, W: Work<Self>>(simd: S, work: W) -> W::Output;
    /// How many of this number a vector has.
    fn width<S: Simd>(simd: S) -> usize;
}

impl Vectored for f32 {
    #[inline(always)]
    fn in_vectors<S: Simd, W: Work<Self>>(simd: S, work: W) -> W::Output {
        work.run::<Wide<S, S::f32s>>(simd)
    }
    fn width<S: Simd>(_: S) -> usize {
        Wide::<S, S::f32s>::WIDTH
    }
}

impl Vectored for f64 {
    #[inline(always)]
    fn in_vectors<S: Simd, W: Work<Self>>(simd: S, work: W) -> W::Output {
        work.run::<Wide<S, S::f64s>>(simd)
    }
    fn width<S: Simd>(_: S) -> usize {
        Wide::<S, S::f64s>::WIDTH
    }
}

impl Level {
    /// The widest vectors of this processor.
    pub fn widest() -> Self {
        Self::Vectors(fearless_simd::Level::new())
    }

    /// Every level that this processor has, narrowest first, with its name.
    pub fn available() -> Vec<(&'static str, Self)> {
        let mut levels = vec![("single", Self::Single)];
        let widest = fearless_simd::Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            let narrower = [
                ("sse2", widest.as_sse2().map(fearless_simd::Level::Sse2)),
                (
                    "sse4.2",
                    widest.as_sse4_2().map(fearless_simd::Level::Sse4_2),
                ),
                ("avx2", widest.as_avx2().map(fearless_simd::Level::Avx2)),
                (
                    "avx512",
                    widest.as_avx512().map(fearless_simd::Level::Avx512),
                ),
            ];
            let found = narrower
                .into_iter()
                .filter_map(|(name, level)| Some((name, level?)));
            levels.extend(found.map(|(name, level)| (name, Self::Vectors(level))));
        }
        #[cfg(target_arch = "aarch64")]
        if let Some(neon) = widest.as_neon() {
            levels.push(("neon", Self::Vectors(fearless_simd::Level::Neon(neon))));
        }
        let _ = widest;
        levels
    }

    /// The level of this name, if this processor has it.
    pub fn named(name: &str) -> Option<Self> {
        Self::available()
            .into_iter()
            .find(|(known, _)| *known == name)
            .map(|(_, level)| level)
    }

    /// Does the work at this level.
    pub fn run<R: Vectored, W: Work<R>>(self, work: W) -> W::Output {
        match self {
            Self::Single => work.run::<R>(()),
            Self::Vectors(level) => dispatch!(level, simd => R::in_vectors(simd, work)),
        }
    }

    /// What `--stats` calls the lanes of this number, for example `f32×16`.
    pub fn lanes_of<R: Vectored>(self) -> String {
        let width = match self {
            Self::Single => 1,
            Self::Vectors(level) => dispatch!(level, simd => R::width(simd)),
        };
        format!("{}×{width}", R::NAME)
    }
}
