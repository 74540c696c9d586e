//! What may slip between the samples of a pixel: primitives, and their shadows and mirror images,
//! that are narrower than two pixels. A sample that passes such a thing closely says so, and is then
//! not left alone.

use super::candidates::Candidates;
use super::footprint::{RayCone, pixels};
use super::intersect::{IgnoredPrimitive, Kernel, Paths};
use super::thresholds::SLIPPING;
use crate::primitive::{Approach, Kind, Primitive, Visit};
use crate::simd::SimdFloat;

impl<L: SimdFloat> Kernel<'_, L> {
    /// How many pixels away from the paths the nearest of the primitives is that are narrower there
    /// than [`SLIPPING`] pixels, before `reach`; infinity for none.
    #[inline(always)]
    pub fn thin_distance(
        self,
        among: &Candidates,
        paths: &Paths<L>,
        cone: RayCone<L>,
        reach: L,
    ) -> L {
        let mut scan = ThinScan {
            kernel: self,
            among,
            paths,
            cone,
            reach,
            best: self.infinity(),
        };
        self.plan.primitives.visit(&mut scan);
        scan.best
    }
}

struct ThinScan<'a, L: SimdFloat> {
    kernel: Kernel<'a, L>,
    among: &'a Candidates,
    paths: &'a Paths<L>,
    cone: RayCone<L>,
    reach: L,
    best: L,
}

impl<L: SimdFloat> Visit<L::Real> for ThinScan<'_, L> {
    #[inline(always)]
    fn visit<P: Primitive<L::Real>>(&mut self, kind: Kind, primitives: &[P], first: usize) {
        let among = self.among.of(kind);
        if among.is_empty() {
            return;
        }
        let rays = &self.paths.rays;
        let prepared = P::prepare(rays.direction);
        let (slipping, zero) = (self.kernel.splat(SLIPPING), self.kernel.splat(0.0));
        for &index in among {
            let primitive = &primitives[index as usize];
            let Approach {
                from,
                to,
                distance,
                size,
            } = primitive.approach(rays, &prepared);
            let width = self.cone.width_at(to);
            let is_before = from.less(self.reach + primitive.margin(width));
            let mut thin = size.less(width * slipping) & zero.less(to) & is_before;
            // A curved surface surrounds the rays that start on it.
            if P::IS_CURVED && !matches!(self.paths.ignored, IgnoredPrimitive::Nothing) {
                let number = first + index as usize;
                thin = thin & !self.paths.ignored.is(self.kernel.token, number);
            }
            self.best = self.best.min(pixels(thin, distance, width));
        }
    }
}
