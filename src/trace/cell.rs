//! Cells: squares between samples, which are pixels or parts of them.

use super::samples::EdgeDetail;
use super::thresholds::PIXEL_STEPS;
use super::tile::TileColors;
use crate::simd::Real;

/// A square between samples: its upper left corner on the finest grid, its side, and its samples.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Steps of the finest grid from the left edge of the tile.
    pub x: u16,
    /// Steps of the finest grid from the upper edge of the tile.
    pub y: u16,
    /// Length of its side in steps of the finest grid.
    pub side: u16,
    /// What was looked for at its corners, or at those of the cell that it is a part of.
    pub detail: EdgeDetail,
    /// Whether lights may swap in it or in a cell that it is a part of, see [`super::shadows`].
    pub swaps_lights: bool,
    /// Whether it may show a mesh face that no corner is on, or light between two such faces.
    pub may_hide_face: bool,
    /// Indices of the samples at its corners: upper left and right, lower left and right.
    pub corners: [u32; 4],
}

impl Cell {
    /// A pixel of a tile, whose samples are not known yet.
    pub fn pixel(column: usize, row: usize, may_hide_face: bool) -> Self {
        Self {
            x: (column * PIXEL_STEPS) as u16,
            y: (row * PIXEL_STEPS) as u16,
            side: PIXEL_STEPS as u16,
            detail: EdgeDetail::Thin,
            swaps_lights: false,
            may_hide_face,
            corners: [0; 4],
        }
    }

    /// The same cell, at whose corners nothing but signatures was looked for: neither what may slip between
    /// samples, nor the shadows and faces that end near them.
    pub fn signatures_only(self) -> Self {
        Self {
            detail: EdgeDetail::Signatures,
            ..self
        }
    }

    /// Row and column of the pixel that contains it.
    pub fn row_and_column(&self) -> [usize; 2] {
        [self.y, self.x].map(|place| usize::from(place) / PIXEL_STEPS)
    }

    /// Index of the pixel that contains it, with `stride` pixels per row.
    #[inline(always)]
    pub fn pixel_in(&self, stride: usize) -> usize {
        self.y as usize / PIXEL_STEPS * stride + self.x as usize / PIXEL_STEPS
    }

    /// Its corners on the finest grid: upper left and right, lower left and right.
    pub fn corner_points(&self) -> [(u16, u16); 4] {
        let (left, top) = (self.x, self.y);
        let (right, bottom) = (left + self.side, top + self.side);
        [(left, top), (right, top), (left, bottom), (right, bottom)]
    }

    /// Length of its side in pixels.
    #[inline(always)]
    pub fn width(&self) -> f64 {
        f64::from(self.side) / PIXEL_STEPS as f64
    }

    /// Adds its colour (red, green, blue, and a number that is ignored), weighted by its area, to its pixel.
    #[inline(always)]
    pub fn add_color<R: Real>(&self, color: [R; 4], colors: &mut TileColors<R>) {
        let pixel = self.pixel_in(colors.stride);
        let area = R::from_f64(self.width() * self.width());
        for (sum, color) in colors.channels.iter_mut().zip(color) {
            sum[pixel] = sum[pixel] + color * area;
        }
    }
}
