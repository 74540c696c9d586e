//! The vector instruction sets of the processor, detected at run time.

use fearless_simd::{Level as Vectors, Simd, f32x16, f64x8};

use super::float::Wide;
use super::{Real, SimdFloat};

/// An instruction set of the processor.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Its name in the option `--lanes`.
    pub name: &'static str,
    /// `None` for scalar code.
    vectors: Option<Vectors>,
}

/// Work that can be done with lanes of any width.
pub trait WithSimd<R: Real> {
    /// The result.
    type Output;
    /// Does the work. It must be `#[inline(always)]`, as must be all that it calls in inner loops: code that is not
    /// inlined is not compiled for the processor's instructions.
    fn run<L: SimdFloat<Real = R>>(self, token: L::Token) -> Self::Output;
}

/// A real number type with vectors. All processors use as many lanes as the widest register of any of them: a
/// packet that takes several instructions is still faster, by an eighth to a quarter, than packets of the
/// processor's own width.
pub trait SimdReal: Real {
    /// The number of lanes of its vectors.
    const LANES: usize;
    /// Does the work with vectors of this type.
    fn with_vectors<S: Simd, W: WithSimd<Self>>(simd: S, work: W) -> W::Output;
}

macro_rules! vectored {
    ($type:ty, $vector:ident, $width:literal) => {
        impl SimdReal for $type {
            const LANES: usize = $width;
            #[inline(always)]
            fn with_vectors<S: Simd, W: WithSimd<Self>>(simd: S, work: W) -> W::Output {
                work.run::<Wide<S, $vector<S>>>(simd)
            }
        }
    };
}

vectored!(f32, f32x16, 16);
vectored!(f64, f64x8, 8);

impl Level {
    /// The widest instruction set of this processor.
    pub fn widest() -> Self {
        Self::available().pop().unwrap_or(Self::SINGLE)
    }

    /// Scalar code, for any processor.
    pub const SINGLE: Self = Self {
        name: "single",
        vectors: None,
    };

    /// All levels that this processor has, narrowest first. There is none for SSE2 alone: its kernels would be a
    /// third of all, for processors from before 2011.
    pub fn available() -> Vec<Self> {
        let has = Vectors::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let found = [
            ("sse4.2", has.as_sse4_2().map(Vectors::Sse4_2)),
            ("avx2", has.as_avx2().map(Vectors::Avx2)),
            ("avx512", has.as_avx512().map(Vectors::Avx512)),
        ];
        #[cfg(target_arch = "aarch64")]
        let found = [("neon", has.as_neon().map(Vectors::Neon))];
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
        let found = [("vectors", Some(has))];
        let found = found.into_iter().filter_map(|(name, vectors)| {
            Some(Self {
                name,
                vectors: Some(vectors?),
            })
        });
        std::iter::once(Self::SINGLE).chain(found).collect()
    }

    /// Returns the level with this name, if this processor has it.
    pub fn named(name: &str) -> Option<Self> {
        Self::available()
            .into_iter()
            .find(|level| level.name == name)
    }

    /// Does the work at this level.
    pub fn run<R: SimdReal, W: WithSimd<R>>(self, work: W) -> W::Output {
        match self.vectors {
            None => work.run::<R>(()),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Some(Vectors::Avx512(simd)) => with_vectors(simd, work),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Some(Vectors::Avx2(simd)) => with_vectors(simd, work),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Some(Vectors::Sse4_2(simd)) => with_vectors(simd, work),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Some(_) => work.run::<R>(()),
            #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
            Some(level) => fearless_simd::dispatch!(level, simd => R::with_vectors(simd, work)),
        }
    }

    /// The name of the lanes for this type in the output of `--stats`, for example `f32×16 avx2`.
    pub fn lanes_of<R: SimdReal>(self) -> String {
        let width = self.vectors.map_or(1, |_| R::LANES);
        format!("{}×{width} {}", R::NAME, self.name)
    }
}

/// Does the work, compiled for the processor's instructions.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn with_vectors<S: Simd, R: SimdReal, W: WithSimd<R>>(simd: S, work: W) -> W::Output {
    simd.vectorize(
        #[inline(always)]
        || R::with_vectors(simd, work),
    )
}
