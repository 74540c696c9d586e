//! The point where an edge crosses a side of a cell: a search between two samples that see different things.

use super::cell::Cell;
use super::lattice::{CornerSample, Lattice};
use super::messages::{ABOVE, BELOW, LEFT, RIGHT};
use crate::simd::Real;

/// What is seen on one side of an edge.
#[derive(Clone, Copy, Debug)]
pub struct EdgeSide<R> {
    /// The sample at a corner on that side.
    pub sample: CornerSample<R>,
    /// Greatest difference between its colour and others on that side, summed over the channels.
    pub limit: R,
}

impl<R: Real> EdgeSide<R> {
    /// Returns whether a sample sees the same.
    #[inline(always)]
    pub fn matches(&self, sample: &CornerSample<R>) -> bool {
        sample.signature == self.sample.signature && contrast(sample, &self.sample) <= self.limit
    }
}

/// The difference of the colours of two samples, summed over the channels.
#[inline(always)]
pub fn contrast<R: Real>(a: &CornerSample<R>, b: &CornerSample<R>) -> R {
    let mut sum = R::ZERO;
    for (&a, &b) in a.values.iter().zip(&b.values).take(3) {
        sum = sum + (a - b).abs();
    }
    sum
}

/// A point in a cell, in steps of the finest grid.
pub type CellPosition = [f64; 2];

/// The point where an edge crosses a side of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// The corner of the cell on the edge's first side, on the finest grid.
    corner: [u16; 2],
    /// 0 if the cell's side runs along a row, 1 if along a column.
    pub axis: usize,
    /// Whether the cell's side runs from the corner to the left or upwards.
    pub is_back: bool,
    /// Steps from the corner to the last sample before the edge.
    pub low: u16,
    /// Steps from the corner to the first sample beyond the edge.
    pub high: u16,
    /// The search ends once `high - low` is no more than this.
    tolerance: u16,
    /// Indices of the samples at `low` and `high`.
    pub samples: [u32; 2],
    /// Indices of the samples requested between them.
    inside: [u32; 3],
}

impl Crossing {
    /// Creates a search over the whole side of the cell that runs from `corner` along `axis`.
    pub fn new(cell: &Cell, (corner, axis): (usize, usize), tolerance: u16) -> Self {
        let coordinate = |from: u16, axis: usize| from + (corner >> axis & 1) as u16 * cell.side;
        Self {
            corner: [coordinate(cell.x, 0), coordinate(cell.y, 1)],
            axis,
            is_back: corner >> axis & 1 == 1,
            low: 0,
            high: cell.side,
            tolerance,
            samples: [cell.corners[corner], cell.corners[corner ^ (1 << axis)]],
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

    /// Returns the grid point at this number of steps from the corner.
    fn point(&self, steps: u16) -> [u16; 2] {
        let mut point = self.corner;
        let coordinate = &mut point[self.axis];
        *coordinate = if self.is_back {
            *coordinate - steps
        } else {
            *coordinate + steps
        };
        point
    }

    /// Returns whether the edge is located closely enough.
    pub fn is_found(&self) -> bool {
        self.high - self.low <= self.tolerance
    }

    /// Steps from `low` to the first point that is sampled next, and from each of these points to the next.
    fn step(&self) -> u16 {
        let quarter = (self.high - self.low) / 4;
        if quarter < self.tolerance {
            (self.high - self.low) / 2
        } else {
            quarter
        }
    }

    /// Requests samples between those that are known.
    pub fn request_samples<R: Real>(&mut self, lattice: &mut Lattice<R>) {
        if self.is_found() {
            return;
        }
        let (step, mut at) = (self.step(), self.low);
        for index in 0..self.inside.len() {
            at += step;
            if at >= self.high {
                break;
            }
            let [x, y] = self.point(at);
            self.inside[index] = lattice.request(x, y);
        }
    }

    /// Narrows the search by the requested samples; returns false unless they see the first thing and then the
    /// second.
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
            let sample = lattice.sample(index);
            if second.matches(sample) {
                if !is_beyond {
                    (self.high, self.samples[1]) = (at, index);
                }
                is_beyond = true;
            } else if first.matches(sample) && !is_beyond {
                (self.low, self.samples[0]) = (at, index);
            } else {
                return false;
            }
        }
        true
    }

    /// Steps from the corner to the edge.
    pub fn distance(&self) -> f64 {
        f64::from(self.low + self.high) * 0.5
    }

    /// The crossing, on the finest grid.
    pub fn position(&self) -> CellPosition {
        let mut position = self.corner.map(f64::from);
        position[self.axis] += if self.is_back {
            -self.distance()
        } else {
            self.distance()
        };
        position
    }
}
