//! Tiles of the picture: which of their pixels are traced, and their colours.

use std::ops::Range;

use crate::plan::Region;
use crate::simd::Real;

/// A pixel format that colours are converted to.
pub trait Pixel: Send {
    /// Converts a linear colour, 0–1.
    fn of<R: Real>(red: R, green: R, blue: R) -> Self;
}

/// A rectangle of pixels.
#[derive(Clone, Debug)]
pub struct Tile {
    /// From left to right.
    pub columns: Range<usize>,
    /// From top to bottom.
    pub rows: Range<usize>,
}

impl Tile {
    /// Returns whether some of its pixels are in the region; `None` stands for the whole picture.
    pub fn is_in(&self, region: Option<Region>) -> bool {
        region.is_none_or(|region| region.meets(&self.columns, &self.rows))
    }

    /// The number of pixels in a row.
    pub fn width(&self) -> usize {
        self.columns.len()
    }
}

/// One pass over a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Every pixel, sampled as requested for the picture.
    Whole,
    /// The centres of some pixels.
    Centres(Grid),
}

/// The pixels of one pass over a picture: those whose x and y are multiples of `step`, without those of the
/// previous, coarser pass. Passes with steps 8, 4, 2, 1 trace every pixel exactly once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Distance of neighbours in pixels, ≥ 1.
    pub step: usize,
    /// Step of the previous pass, a multiple of `step`.
    pub coarser: Option<usize>,
}

impl Grid {
    /// Every pixel.
    pub const ALL: Self = Self {
        step: 1,
        coarser: None,
    };

    fn row_pixels(self, row: usize, from: usize, to: usize) -> impl Iterator<Item = usize> {
        let Self { step, coarser } = self;
        let first = from.next_multiple_of(step);
        let coarser_row = coarser.filter(|&coarser| row.is_multiple_of(coarser));
        let wanted = move |&x: &usize| coarser_row.is_none_or(|coarser| !x.is_multiple_of(coarser));
        (first..to).step_by(step).filter(wanted)
    }

    /// Returns the pixels of a tile (column, row) that belong to the pass, row by row.
    pub fn pixels(self, tile: &Tile) -> impl Iterator<Item = (usize, usize)> {
        let columns = tile.columns.clone();
        let rows = tile
            .rows
            .clone()
            .filter(move |row| row.is_multiple_of(self.step));
        rows.flat_map(move |row| {
            self.row_pixels(row, columns.start, columns.end)
                .map(move |column| (column, row))
        })
    }
}

/// Linear red, green and blue of the pixels of a tile, row by row.
#[derive(Debug, Default)]
pub struct TileColors<R> {
    /// 0–1.
    pub channels: [Vec<R>; 3],
    /// Distance from one row to the next in `channels`.
    pub stride: usize,
}

impl<R: Real> TileColors<R> {
    /// Red, green and blue.
    pub fn channels(&self) -> [&[R]; 3] {
        self.channels.each_ref().map(Vec::as_slice)
    }

    /// Makes room for `length` pixels, and keeps the colours of those that were there.
    pub fn resize(&mut self, stride: usize, length: usize) {
        self.stride = stride;
        for channel in &mut self.channels {
            channel.resize(length, R::ZERO);
        }
    }

    /// Makes a pixel black.
    #[inline(always)]
    pub fn blacken(&mut self, pixel: usize) {
        for channel in &mut self.channels {
            channel[pixel] = R::ZERO;
        }
    }

    /// Makes room for `length` pixels, all of them black.
    pub fn clear(&mut self, stride: usize, length: usize) {
        self.resize(stride, length);
        for channel in &mut self.channels {
            channel.fill(R::ZERO);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn nested_passes_take_every_pixel_once(width in 1..70_usize, height in 1..40_usize, side in 1..40_usize, levels in 0..5_u32) {
            let mut taken = vec![0_u32; width * height];
            let mut coarser = None;
            for level in (0..=levels).rev() {
                let grid = Grid { step: 1 << level, coarser };
                for top in (0..height).step_by(side) {
                    for left in (0..width).step_by(side) {
                        let (columns, rows) = (left..(left + side).min(width), top..(top + side).min(height));
                        for (x, y) in grid.pixels(&(Tile { columns, rows })) {
                            taken[y * width + x] += 1;
                        }
                    }
                }
                coarser = Some(grid.step);
            }
            prop_assert!(taken.iter().all(|&count| count == 1));
        }
    }
}
