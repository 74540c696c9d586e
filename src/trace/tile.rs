//! A tile of the picture, and its colours.

use std::ops::Range;

use crate::simd::Real;

/// A rectangle of pixels.
#[derive(Clone, Debug)]
pub struct Tile {
    /// From left to right.
    pub columns: Range<usize>,
    /// From top to bottom.
    pub rows: Range<usize>,
}

impl Tile {
    /// Pixels in a row.
    pub fn width(&self) -> usize {
        self.columns.len()
    }
}

/// Linear red, green and blue of the pixels of a tile, row by row.
#[derive(Debug, Default)]
pub struct TileColors<R> {
    /// 0–1.
    pub channels: [Vec<R>; 3],
    /// Numbers from one row to the next.
    pub stride: usize,
}

impl<R: Real> TileColors<R> {
    /// Red, green and blue.
    pub fn channels(&self) -> [&[R]; 3] {
        self.channels.each_ref().map(Vec::as_slice)
    }

    /// Makes all pixels black.
    pub fn clear(&mut self, stride: usize, length: usize) {
        self.stride = stride;
        for channel in &mut self.channels {
            channel.clear();
            channel.resize(length, R::ZERO);
        }
    }
}
