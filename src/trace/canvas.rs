//! The destination of pixel colours. The code that traces does not know the pixel format, so that it is compiled
//! once for all formats.

use std::ops::Range;

use super::tile::{Grid, Pixel, Tile};
use crate::simd::{Level, SimdFloat, SimdReal, WithSimd};

/// Receives the colours of the pixels of a part of the picture.
pub trait Canvas<R> {
    /// Sets all pixels of a tile, row by row; `stride` is the distance between the rows of `channels`.
    fn fill(&mut self, tile: &Tile, stride: usize, channels: [&[R]; 3]);

    /// Sets the pixels of a tile that belong to a pass, in their order.
    fn scatter(&mut self, tile: &Tile, grid: Grid, channels: [&[R]; 3]);

    /// Sets one pixel.
    fn set(&mut self, column: usize, row: usize, color: [R; 3]);
}

/// The pixels of a part of the picture, all in one format.
#[derive(Debug)]
pub struct Pixels<'a, P> {
    /// The part of the picture.
    pub place: Tile,
    /// The rows of its pixels.
    pub rows: Vec<&'a mut [P]>,
    /// Instruction set with which colours are converted to pixels.
    pub level: Level,
}

impl<R: SimdReal, P: Pixel> Canvas<R> for Pixels<'_, P> {
    fn fill(&mut self, tile: &Tile, stride: usize, channels: [&[R]; 3]) {
        let [left, top] = [self.place.columns.start, self.place.rows.start];
        self.level.run(FillRows {
            rows: &mut self.rows[tile.rows.start - top..tile.rows.end - top],
            columns: tile.columns.start - left..tile.columns.end - left,
            stride,
            channels,
        });
    }

    fn scatter(&mut self, tile: &Tile, grid: Grid, [red, green, blue]: [&[R]; 3]) {
        for (index, (column, row)) in grid.pixels(tile).enumerate() {
            self.set(column, row, [red[index], green[index], blue[index]]);
        }
    }

    fn set(&mut self, column: usize, row: usize, [red, green, blue]: [R; 3]) {
        let [left, top] = [self.place.columns.start, self.place.rows.start];
        self.rows[row - top][column - left] = P::of(red, green, blue);
    }
}

/// Columns of rows of pixels, and the colours that they are set to.
struct FillRows<'a, 'b, R, P> {
    rows: &'a mut [&'b mut [P]],
    columns: Range<usize>,
    stride: usize,
    channels: [&'a [R]; 3],
}

impl<R: SimdReal, P: Pixel> WithSimd<R> for FillRows<'_, '_, R, P> {
    type Output = ();

    /// Uses no lanes explicitly: the compiler vectorises the loop with the instructions that are enabled here.
    #[inline(always)]
    fn run<L: SimdFloat<Real = R>>(self, _: L::Token) {
        let [red, green, blue] = self.channels;
        for (row, pixels) in self.rows.iter_mut().enumerate() {
            let pixels = &mut pixels[self.columns.clone()];
            let part = row * self.stride..row * self.stride + pixels.len();
            let channels = red[part.clone()]
                .iter()
                .zip(&green[part.clone()])
                .zip(&blue[part]);
            for (pixel, ((&red, &green), &blue)) in pixels.iter_mut().zip(channels) {
                *pixel = P::of(red, green, blue);
            }
        }
    }
}
