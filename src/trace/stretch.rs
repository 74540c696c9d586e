//! How far pixels stretch on surfaces at a grazing angle.

use super::intersect::Kernel;
use super::paths::real;
use super::thresholds::{GRAZING, GRAZING_ON_FLATS};
use crate::plan::FlatExtent;
use crate::primitive::Kind;
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns which of the primitives with these numbers are endless planes.
    #[inline(always)]
    fn are_planes(self, numbers: L) -> L::Mask {
        let first = self.plan.primitives.firsts()[Kind::Plane as usize];
        let end = first + self.plan.primitives.planes.len();
        let (first, end) = (numbers.like(real(first)), numbers.like(real(end)));
        first.at_most(numbers) & numbers.less(end)
    }

    /// Returns which of the primitives with these numbers may be flat, and so large that pixels of this width
    /// stretch farther on them than usual. Planes are not among them: pixels always do so on planes.
    #[inline(always)]
    fn may_be_large(self, numbers: L, width: L) -> L::Mask {
        let flats = self.plan.flats;
        let mut largest = numbers.like(flats.loose);
        if let Some((geometry, first)) = self.geometry() {
            let first = first + geometry.primitives.len();
            let in_meshes = numbers.like(real::<L::Real>(first)).at_most(numbers);
            largest = L::select(in_meshes, numbers.like(flats.in_meshes), largest);
        }
        width.less(largest * largest.like_f64(GRAZING)) & !self.are_planes(numbers)
    }

    /// Returns the normal of the primitive with a number and how far it goes at most, if it is flat; the normal of a
    /// round one is 0.
    #[inline(never)]
    fn flat_at(self, number: usize) -> Option<(Vec3<L::Real>, L::Real)> {
        match self.geometry() {
            Some((geometry, first)) if first <= number => geometry.flat_at(number - first),
            _ => self.plan.primitives.with(number, FlatExtent),
        }
    }

    /// Returns the cosine below which the primitives with these numbers do not stretch pixels of this width any
    /// further, given the cosine at which they are hit: flat ones stretch pixels over all of their extent.
    #[inline(always)]
    pub fn grazing(self, numbers: L, (cosine, width): (L, L)) -> L {
        let on_flats = self.splat(GRAZING_ON_FLATS);
        let mut grazing = L::select(self.are_planes(numbers), on_flats, self.splat(GRAZING));
        let is_slanted = cosine.abs().less(self.splat(GRAZING));
        let mut remaining = (is_slanted & self.may_be_large(numbers, width)).bits();
        while remaining != 0 {
            let number = numbers.lane(remaining.trailing_zeros() as usize);
            let lanes = numbers.same(numbers.like(number));
            remaining &= !lanes.bits();
            if let Some((_, extent)) = self.flat_at(number.to_f64() as usize) {
                grazing = L::select(lanes, least_cosine(width, extent), grazing);
            }
        }
        grazing
    }

    /// Returns an upper bound of the length of pixels of this width on the primitives with these numbers, where they
    /// were hit along these directions.
    #[inline(always)]
    pub fn max_length_on(self, numbers: L, (hit, directions, width): (L::Mask, Vec3<L>, L)) -> L {
        let usual_length = width * width.like_f64(1.0 / GRAZING);
        let mut length = L::select(hit, usual_length, self.splat(0.0));
        let flat = hit & (self.may_be_large(numbers, width) | self.are_planes(numbers));
        let mut remaining = flat.bits();
        while remaining != 0 {
            let number = numbers.lane(remaining.trailing_zeros() as usize);
            let lanes = numbers.same(numbers.like(number));
            remaining &= !lanes.bits();
            if let Some((normal, extent)) = self.flat_at(number.to_f64() as usize) {
                let cosine = directions.like(normal).dot(directions).abs();
                let stretched = width / cosine.max(least_cosine(width, extent));
                length = L::select(lanes & hit, stretched, length);
            }
        }
        length
    }
}

/// Returns the cosine below which pixels of a width do not stretch any further on something flat that goes so far.
#[inline(always)]
fn least_cosine<L: SimdFloat>(width: L, extent: L::Real) -> L {
    let full_cosine = width / width.like(extent);
    full_cosine
        .max(width.like_f64(GRAZING_ON_FLATS))
        .min(width.like_f64(GRAZING))
}
