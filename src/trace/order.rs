//! Sorting of hits so that those of a packet are close together: neighbours in the picture may be far apart in the
//! scene, and their shadow rays then have little in common.

use super::beam::Bounds;
use super::doubt::Uncertainty;
use super::intersect::{Kernel, Nearest};
use super::packet::Packet;
use super::paths::NO_PRIMITIVE;
use super::samples::Samples;
use crate::primitive::{BoundingBox, Ray};
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

/// Cells along each axis of the box around all hits.
const CELLS: f64 = 16.0;
/// Bits of a key: four per axis, and two for the kind of hit.
const KEY_BITS: u32 = 14;
/// Number of keys that a pass of sorting tells apart.
const BUCKETS: usize = 1 << (KEY_BITS / 2);

/// The bits of each cell number along an axis, moved three apart.
const MORTON_BITS: [u16; CELLS as usize] = {
    let mut morton = [0; CELLS as usize];
    let mut cell = 0;
    while cell < morton.len() {
        let bits = cell as u16;
        morton[cell] = bits & 1 | (bits & 2) << 2 | (bits & 4) << 4 | (bits & 8) << 6;
        cell += 1;
    }
    morton
};

/// Hits count as scattered if their distances within a packet differ, on average, by more than this share of the
/// range in the whole tile; on a surface it is a quarter.
const SCATTERED_SHARE: f64 = 0.4;

/// The hits of each sample, and the order of the samples. The memory is reused.
#[derive(Debug, Default)]
pub struct Order<R> {
    /// Distances of the hits.
    t: Vec<R>,
    /// Numbers of the primitives that were hit.
    number: Vec<R>,
    /// 1 where the hit is in doubt, else 0.
    doubt: Vec<R>,
    /// Places of the hits, in cells.
    cells: [Vec<R>; 3],
    keys: Vec<u16>,
    /// For each lane of the sorted packets, the index of its sample; empty if packets are in the order of the
    /// samples.
    pub samples: Vec<u32>,
    scratch: Vec<u32>,
}

impl<R: Real> Order<R> {
    /// Removes all samples.
    pub fn clear(&mut self) {
        self.samples.clear();
        self.t.clear();
        self.number.clear();
        self.doubt.clear();
        self.cells.iter_mut().for_each(Vec::clear);
    }

    /// Regroups the hits of camera rays into packets whose hits are close together, if they are scattered.
    #[inline(always)]
    pub fn regroup_hits<L: SimdFloat<Real = R>, const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        (packets, uncertainties): (&mut [Packet<L>], &mut [Uncertainty<L>]),
        samples: &Samples<R>,
    ) {
        let Some((_, first)) = kernel.geometry() else {
            return;
        };
        if !is_scattered(kernel, packets) {
            return;
        }
        let bounding_box = bounds_of(kernel, packets).bounding_box();
        let (zero, one) = (kernel.splat(0.0), kernel.splat(1.0));
        for Packet { rays, nearest, .. } in &*packets {
            self.add(
                (nearest.t, nearest.number),
                rays.at(nearest.t),
                &bounding_box,
            );
        }
        for Uncertainty { doubt, .. } in &*uncertainties {
            push(&mut self.doubt, L::select(*doubt, one, zero));
        }
        self.compute_order(samples.count, first);
        let count = kernel.splat(samples.count as f64);
        for (index, packet) in packets.iter_mut().enumerate() {
            let first = index * L::WIDTH;
            let x = self.gather(kernel.token, &samples.x, first);
            let y = self.gather(kernel.token, &samples.y, first);
            let (origin, direction) = kernel.plan.view.rays(x, y);
            packet.rays = Ray { origin, direction };
            packet.nearest = Nearest {
                t: self.gather(kernel.token, &self.t, first),
                number: self.gather(kernel.token, &self.number, first),
            };
            packet.active = self.numbers::<L>(kernel.token, first).less(count);
        }
        for (index, uncertainty) in uncertainties.iter_mut().enumerate() {
            let doubt: L = self.gather(kernel.token, &self.doubt, index * L::WIDTH);
            uncertainty.doubt = zero.less(doubt);
        }
    }

    /// Adds the hits of a packet; `bounding_box` is the box around all hits.
    #[inline(always)]
    fn add<L: SimdFloat<Real = R>>(
        &mut self,
        (t, number): (L, L),
        point: Vec3<L>,
        bounding_box: &BoundingBox<R>,
    ) {
        let size = bounding_box.high - bounding_box.low;
        let longest = size.x.max(size.y).max(size.z);
        let zero = t.like(R::ZERO);
        let last = t.like_f64(CELLS - 1.0);
        let per_cell = if R::ZERO < longest {
            R::from_f64(CELLS) / longest
        } else {
            R::ZERO
        };
        let off = point - point.like(bounding_box.low);
        for (cells, off) in self.cells.iter_mut().zip([off.x, off.y, off.z]) {
            push(cells, (off * t.like(per_cell)).max(zero).min(last));
        }
        push(&mut self.t, t);
        push(&mut self.number, number);
    }

    /// Computes the order: hits on primitives in lists first, since all hits of a packet that are alike are lit
    /// together; then hits in the tree, whose first number is given, cell by cell along a space-filling curve
    /// (Morton, "A computer oriented geodetic data base and a new technique in file sequencing", IBM, 1966); then
    /// misses.
    fn compute_order(&mut self, count: usize, first: usize) {
        self.keys.clear();
        let first = R::from_f64(first as f64);
        for sample in 0..self.number.len() {
            let [x, y, z] = &self.cells;
            let bits =
                |cells: &[R]| MORTON_BITS[cells[sample].nearest() as usize % MORTON_BITS.len()];
            let (x, y, z) = (bits(x), bits(y), bits(z));
            let number = self.number[sample];
            let group = match number {
                _ if sample >= count || number == R::from_f64(NO_PRIMITIVE) => 2,
                number if number < first => 0,
                _ => 1,
            };
            self.keys
                .push(group << (KEY_BITS - 2) | z << 2 | y << 1 | x);
        }
        let all = 0..self.keys.len() as u32;
        self.samples.clear();
        self.samples.extend(all);
        for pass in 0..2 {
            self.sort_by_half(pass * (KEY_BITS / 2));
        }
    }

    /// Sorts the samples by half of the bits of their keys; samples with equal bits keep their order.
    fn sort_by_half(&mut self, shift: u32) {
        let bucket = |key: u16| (key >> shift) as usize & (BUCKETS - 1);
        let mut starts = [0_u32; BUCKETS + 1];
        for &key in &self.keys {
            starts[bucket(key) + 1] += 1;
        }
        for index in 0..BUCKETS {
            starts[index + 1] += starts[index];
        }
        self.scratch.clear();
        self.scratch.resize(self.samples.len(), 0);
        for &sample in &self.samples {
            let start = &mut starts[bucket(self.keys[sample as usize])];
            self.scratch[*start as usize] = sample;
            *start += 1;
        }
        std::mem::swap(&mut self.samples, &mut self.scratch);
    }

    /// Returns the sample indices of the lanes of a packet that begins at `first`.
    #[inline(always)]
    fn numbers<L: SimdFloat<Real = R>>(&self, token: L::Token, first: usize) -> L {
        let mut lanes = [R::ZERO; MAX_LANES];
        for (lane, &sample) in lanes.iter_mut().zip(&self.samples[first..first + L::WIDTH]) {
            *lane = R::from_f64(f64::from(sample));
        }
        L::load(token, &lanes)
    }

    /// Returns the values of a column for the lanes of a packet that begins at `first`.
    #[inline(always)]
    fn gather<L: SimdFloat<Real = R>>(&self, token: L::Token, column: &[R], first: usize) -> L {
        let mut lanes = [R::ZERO; MAX_LANES];
        for (lane, &sample) in lanes.iter_mut().zip(&self.samples[first..first + L::WIDTH]) {
            *lane = column[sample as usize];
        }
        L::load(token, &lanes)
    }
}

/// Returns the box around all hits, lane by lane.
#[inline(always)]
fn bounds_of<L: SimdFloat, const TREE: bool>(
    kernel: Kernel<L, TREE>,
    packets: &[Packet<L>],
) -> Bounds<L> {
    let mut bounds = Bounds::new(kernel.token);
    for Packet {
        rays,
        nearest,
        active,
        ..
    } in packets
    {
        let hit = nearest.t.less(kernel.infinity()) & *active;
        bounds.add(hit, rays.at(nearest.t));
    }
    bounds
}

/// Returns whether the distances of hits differ within packets nearly as much as in the whole tile.
#[inline(always)]
fn is_scattered<L: SimdFloat, const TREE: bool>(
    kernel: Kernel<L, TREE>,
    packets: &[Packet<L>],
) -> bool {
    let (infinity, zero) = (kernel.infinity(), kernel.splat(0.0));
    let (mut closest, mut farthest) = (infinity, zero);
    let (mut sum, mut count) = (L::Real::ZERO, L::Real::ZERO);
    for Packet {
        nearest, active, ..
    } in packets
    {
        let hit = nearest.t.less(infinity) & *active;
        if hit.any() {
            let near_end = L::select(hit, nearest.t, infinity);
            let far_end = L::select(hit, nearest.t, zero);
            sum = sum + (far_end.greatest() - near_end.least());
            count = count + L::Real::ONE;
            closest = closest.min(near_end);
            farthest = farthest.max(far_end);
        }
    }
    let range = farthest.greatest() - closest.least();
    range * count * L::Real::from_f64(SCATTERED_SHARE) < sum
}

#[inline(always)]
fn push<L: SimdFloat>(column: &mut Vec<L::Real>, numbers: L) {
    let first = column.len();
    column.resize(first + L::WIDTH, L::Real::ZERO);
    numbers.store(&mut column[first..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_are_sorted_by_what_they_are_and_where() {
        let mut order = Order::<f64>::default();
        let bounding_box = BoundingBox {
            low: Vec3::splat(0.0),
            high: Vec3::new(16.0, 16.0, 4.0),
        };
        // A miss, hits in two corners of the tree in turn, and one in the list.
        let hits = [
            (-1.0, 3.0),
            (7.0, 15.5),
            (8.0, 0.5),
            (7.0, 15.0),
            (9.0, 0.0),
            (2.0, 9.0),
        ];
        for (number, x) in hits {
            order.add((1.0, number), Vec3::new(x, 1.0, 1.0), &bounding_box);
        }
        order.compute_order(hits.len(), 5);
        assert_eq!(order.samples, [5, 2, 4, 1, 3, 0]);
        // The padding of the last packet counts as misses.
        order.compute_order(4, 5);
        assert_eq!(order.samples, [2, 1, 3, 4, 0, 5]);
    }
}
