//! Where the colours of pixels go: who traces them need not know what they are made of, and is compiled once for whatever
//! that is.

use std::ops::Range;

use super::tile::{Grid, Pixel, Tile};
use crate::plan::Region;
use crate::simd::{Level, SimdFloat, SimdReal, WithSimd};

/// Takes the colours of the pixels of a piece of the picture.
pub trait Canvas<R> {
    /// Takes those of all pixels of a tile, row by row, `stride` apart from row to row.
    fn fill(&mut self, tile: &Tile, stride: usize, channels: [&[R]; 3]);

    /// Takes those of the pixels of a tile that a pass takes, one after the other.
    fn scatter(&mut self, tile: &Tile, grid: Grid, channels: [&[R]; 3]);

    /// Takes that of one pixel.
    fn set(&mut self, column: usize, row: usize, color: [R; 3]);
}

/// The pixels of a piece, all of one kind.
#[derive(Debug)]
pub struct Pixels<'a, P> {
    /// Where it is in the picture.
    pub place: Region,
    /// Row by row.
    pub rows: Vec<&'a mut [P]>,
    /// Which vectors colours become pixels in.
    pub level: Level,
}

impl<P> Pixels<'_, P> {
    fn pixel(&mut self, column: usize, row: usize) -> &mut P {
        &mut self.rows[row - self.place.rows.0][column - self.place.columns.0]
    }
}

impl<R: SimdReal, P: Pixel> Canvas<R> for Pixels<'_, P> {
    fn fill(&mut self, tile: &Tile, stride: usize, channels: [&[R]; 3]) {
        let [left, top] = [self.place.columns.0, self.place.rows.0];
        self.level.run(Filled {
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
        *self.pixel(column, row) = P::of(red, green, blue);
    }
}

/// The pixels in some columns of rows, which become these colours.
struct Filled<'a, 'b, R, P> {
    rows: &'a mut [&'b mut [P]],
    columns: Range<usize>,
    stride: usize,
    channels: [&'a [R]; 3],
}

impl<R: SimdReal, P: Pixel> WithSimd<R> for Filled<'_, '_, R, P> {
    type Output = ();

    /// In no lanes by itself: the compiler makes many pixels in step with the instructions that it knows here.
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
