//! Where an edge crosses a side of a cell: it is searched for between two samples that see different things.

use super::cell::Cell;
use super::lattice::{CornerSample, Lattice};
use super::messages::{ABOVE, BELOW, LEFT, RIGHT};
use crate::simd::Real;

/// What is seen on one side of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeSide<R> {
    /// What a corner there has seen.
    pub seen: CornerSample<R>,
    /// How far other colours of it may be from that, summed over the channels.
    pub limit: R,
}

impl<R: Real> EdgeSide<R> {
    /// Whether a sample has seen it.
    #[inline(always)]
    pub fn is_in(&self, sample: &CornerSample<R>) -> bool {
        sample.signature == self.seen.signature && contrast(sample, &self.seen) <= self.limit
    }
}

/// The difference of what two samples have seen, summed over the channels.
#[inline(always)]
pub fn contrast<R: Real>(a: &CornerSample<R>, b: &CornerSample<R>) -> R {
    let mut sum = R::ZERO;
    for (&a, &b) in a.values.iter().zip(&b.values).take(3) {
        sum = sum + (a - b).abs();
    }
    sum
}

/// A place in a cell, in steps of the finest grid.
pub type Place = [f64; 2];

/// Where an edge crosses a side of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The corner on its first side, on the finest grid.
    corner: [u16; 2],
    /// 0 for a side along a row, 1 for one along a column.
    pub axis: usize,
    /// Whether the side goes on to the left, or upwards.
    pub is_back: bool,
    /// The steps from the corner that the edge is beyond.
    pub low: u16,
    /// And those that it is before.
    pub high: u16,
    /// It need not be known within less.
    enough: u16,
    /// The samples there.
    pub seen: [u32; 2],
    /// Those between them that are wanted.
    inside: [u32; 3],
}

impl Crossing {
    /// Somewhere on the side of a cell that goes from a corner along an axis.
    pub fn new(cell: &Cell, (corner, axis): (usize, usize), enough: u16) -> Self {
        let place = |from: u16, axis: usize| from + (corner >> axis & 1) as u16 * cell.side;
        Self {
            corner: [place(cell.x, 0), place(cell.y, 1)],
            axis,
            is_back: corner >> axis & 1 == 1,
            low: 0,
            high: cell.side,
            enough,
            seen: [cell.corners[corner], cell.corners[corner ^ (1 << axis)]],
            inside: [0; 3],
        }
    }

    /// The side of the cell that it is on, as a bit.
    pub fn side(&self, cell: &Cell) -> u8 {
        let [x, y] = self.corner;
        match (self.axis, x == cell.x, y == cell.y) {
            (0, _, true) => ABOVE,
            (0, _, false) => BELOW,
            (_, true, _) => LEFT,
            (_, false, _) => RIGHT,
        }
    }

    /// So many steps from the corner.
    fn point(&self, steps: u16) -> [u16; 2] {
        let mut point = self.corner;
        let place = &mut point[self.axis];
        *place = if self.is_back {
            *place - steps
        } else {
            *place + steps
        };
        point
    }

    /// Whether it is known well enough.
    pub fn is_found(&self) -> bool {
        self.high - self.low <= self.enough
    }

    /// The points where the edge is looked for next: the steps from the corner to the first, and between them.
    fn step(&self) -> u16 {
        let quarter = (self.high - self.low) / 4;
        if quarter < self.enough {
            (self.high - self.low) / 2
        } else {
            quarter
        }
    }

    /// Wants the samples that are between what is known.
    pub fn want<R: Real>(&mut self, lattice: &mut Lattice<R>) {
        if self.is_found() {
            return;
        }
        let (step, mut at) = (self.step(), self.low);
        for inside in 0..self.inside.len() {
            at += step;
            if at >= self.high {
                break;
            }
            let [x, y] = self.point(at);
            self.inside[inside] = lattice.want(x, y);
        }
    }

    /// Takes what was seen there; false unless that is the first thing, and then the second.
    pub fn narrow<R: Real>(
        &mut self,
        lattice: &Lattice<R>,
        [first, second]: &[EdgeSide<R>; 2],
    ) -> bool {
        if self.is_found() {
            return true;
        }
        let (step, mut at, end) = (self.step(), self.low, self.high);
        let mut is_beyond = false;
        for index in self.inside {
            at += step;
            if at >= end {
                break;
            }
            let seen = lattice.sample(index);
            if second.is_in(seen) {
                if !is_beyond {
                    (self.high, self.seen[1]) = (at, index);
                }
                is_beyond = true;
            } else if first.is_in(seen) && !is_beyond {
                (self.low, self.seen[0]) = (at, index);
            } else {
                return false;
            }
        }
        true
    }

    /// How many steps from the corner the edge is.
    pub fn distance(&self) -> f64 {
        f64::from(self.low + self.high) * 0.5
    }

    /// Where the edge is, on the finest grid.
    pub fn place(&self) -> Place {
        let mut place = self.corner.map(f64::from);
        place[self.axis] += if self.is_back {
            -self.distance()
        } else {
            self.distance()
        };
        place
    }
}
