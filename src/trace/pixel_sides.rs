//! The sides of the pixels of a tile: across which of them a sample may still reveal something to an adjacent
//! pixel.

use std::sync::atomic::Ordering;

use super::cell::Cell;
use super::messages::{ABOVE, ALL, BELOW, EdgeMessages, LEFT, RIGHT};
use super::thresholds::PIXEL_STEPS;
use super::tile::Tile;

/// For the pixels of a tile and those around it, the sides from which they need no more messages.
#[derive(Debug, Default)]
pub struct PixelSides {
    /// For each pixel, the bits of the sides from which nothing more is to be learnt; row by row, with a margin of
    /// the pixels around the tile.
    known: Vec<u8>,
    /// Entries per row of `known`.
    stride: usize,
    /// Row and column of the first pixel of the tile.
    first: [usize; 2],
}

/// A side shared by two pixels.
pub struct Side {
    /// Its end points on the finest grid.
    pub ends: [[u16; 2]; 2],
    /// Indices of the two adjacent pixels, each with the bit of this side in it; `None` for one that needs no
    /// messages from it.
    pub notified_pixels: [Option<(usize, u8)>; 2],
}

impl PixelSides {
    /// Loads what the pixels of a tile know. Nothing is loaded for the pixels around it, although messages for them
    /// may exist.
    pub fn start(&mut self, tile: &Tile, messages: &EdgeMessages) {
        let (width, height) = (tile.width(), tile.rows.len());
        self.stride = width + 2;
        self.first = [tile.rows.start, tile.columns.start];
        self.known.clear();
        self.known.resize(self.stride * (height + 2), 0);
        // There are no pixels to notify beyond the edges.
        let before = tile.rows.start.checked_sub(1);
        if !before.is_some_and(|row| messages.has_row(row)) {
            self.known[..self.stride].fill(ALL);
        }
        if !messages.has_row(tile.rows.end) {
            self.known[self.stride * (height + 1)..].fill(ALL);
        }
        let rows = self.known.chunks_exact_mut(self.stride).skip(1);
        for (row, known) in tile.rows.clone().zip(rows) {
            if tile.columns.start == 0 {
                known[0] = ALL;
            }
            if tile.columns.end == messages.width() {
                known[width + 1] = ALL;
            }
            let messages = messages.known_sides(row, &tile.columns);
            for (known, messages) in known[1..=width].iter_mut().zip(messages) {
                *known = messages.load(Ordering::Relaxed);
            }
        }
    }

    /// Stores what the pixels of the tile know for later passes.
    pub fn finish(&self, tile: &Tile, messages: &EdgeMessages) {
        let rows = self.known.chunks_exact(self.stride).skip(1);
        for (row, known) in tile.rows.clone().zip(rows) {
            let messages = messages.known_sides(row, &tile.columns);
            for (&known, messages) in known[1..].iter().zip(messages) {
                if known != 0 {
                    messages.store(known, Ordering::Relaxed);
                }
            }
        }
    }

    /// Notes that nothing more is to be learnt from some sides of a cell, if the cell is a pixel.
    #[inline(always)]
    pub fn note(&mut self, cell: &Cell, sides: u8) {
        if usize::from(cell.side) == PIXEL_STEPS {
            let index = self.index_of([cell.x, cell.y]);
            self.known[index] |= sides;
        }
    }

    /// Returns the pixel side that a grid point lies on; `None` for a pixel's corner, a point inside a pixel, and a
    /// side from which neither pixel needs messages.
    #[inline(always)]
    pub fn side_of(&self, [x, y]: [u16; 2]) -> Option<Side> {
        let step = PIXEL_STEPS as u16;
        let (is_on_column, is_on_row) = (x % step == 0, y % step == 0);
        if is_on_column == is_on_row {
            return None;
        }
        let behind = self.index_of([x, y]);
        let (before, end, start) = if is_on_column {
            (behind - 1, RIGHT, LEFT)
        } else {
            (behind - self.stride, BELOW, ABOVE)
        };
        let needs_messages =
            |index: usize, side: u8| (self.known[index] & side == 0).then_some((index, side));
        let notified_pixels = [needs_messages(before, end), needs_messages(behind, start)];
        if notified_pixels == [None; 2] {
            return None;
        }
        let (left, top) = (x / step * step, y / step * step);
        let other = if is_on_column {
            [left, top + step]
        } else {
            [left + step, top]
        };
        Some(Side {
            ends: [[left, top], other],
            notified_pixels,
        })
    }

    /// Returns a pixel of the tile, by its row and column in the picture, as a cell with signatures only, see
    /// [`Cell::signatures_only`].
    pub fn cell_of(&self, [row, column]: [usize; 2]) -> Cell {
        let [top, left] = self.first;
        Cell::pixel(column - left, row - top, false).signatures_only()
    }

    /// Returns the row and the column in the picture of the pixel at an index, which must be in the picture.
    pub fn pixel(&self, index: usize) -> [usize; 2] {
        let [top, left] = self.first;
        [
            top + index / self.stride - 1,
            left + index % self.stride - 1,
        ]
    }

    /// Returns whether the pixel at an index is in the tile.
    pub fn is_inside(&self, index: usize) -> bool {
        let (row, column) = (index / self.stride, index % self.stride);
        let rows = self.known.len() / self.stride;
        0 < row && row + 1 < rows && 0 < column && column + 1 < self.stride
    }

    /// Index of the pixel to the lower right of a grid point.
    #[inline(always)]
    fn index_of(&self, [x, y]: [u16; 2]) -> usize {
        (usize::from(y) / PIXEL_STEPS + 1) * self.stride + usize::from(x) / PIXEL_STEPS + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_tell_the_pixels_beside_them_that_do_not_know_yet() {
        let step = PIXEL_STEPS as u16;
        let tile = Tile {
            columns: 4..7,
            rows: 0..2,
        };
        let messages = EdgeMessages::new(7, 0..4);
        messages.known_sides(0, &(6..7))[0].store(ALL, Ordering::Relaxed);
        let mut borders = PixelSides::default();
        borders.start(&tile, &messages);
        let notified_pixels = |borders: &PixelSides, point: [u16; 2]| {
            let side = borders.side_of(point)?;
            let pixels = side.notified_pixels.into_iter().flatten();
            Some(
                pixels
                    .map(|(index, side)| (borders.pixel(index), side))
                    .collect(),
            )
        };
        let between = [step, step + 5];
        let both: Vec<([usize; 2], u8)> = vec![([1, 4], RIGHT), ([1, 5], LEFT)];
        assert_eq!(notified_pixels(&borders, between), Some(both));
        let side = borders.side_of(between).expect("a side");
        assert_eq!(side.ends, [[step, step], [step, 2 * step]]);
        borders.note(&borders.cell_of([1, 5]), LEFT | ABOVE);
        assert_eq!(
            notified_pixels(&borders, between),
            Some(vec![([1, 4], RIGHT)])
        );
        borders.note(&borders.cell_of([1, 4]), ALL);
        assert_eq!(notified_pixels(&borders, between), None);
        assert_eq!(
            notified_pixels(&borders, [2 * step + 1, step]),
            Some(vec![([1, 6], ABOVE)])
        );
        // Across the tile's edge are pixels of others; beyond the edge of the picture, there are none.
        let (left, _) = borders
            .side_of([0, 1])
            .and_then(|side| side.notified_pixels[0])
            .expect("one");
        assert!(!borders.is_inside(left));
        assert_eq!(borders.pixel(left), [0, 3]);
        assert_eq!(notified_pixels(&borders, [3 * step, 1]), None);
        assert_eq!(
            notified_pixels(&borders, [1, 0]),
            Some(vec![([0, 4], ABOVE)])
        );
        assert_eq!(notified_pixels(&borders, [step, step]), None, "a corner");
        assert_eq!(notified_pixels(&borders, [1, 1]), None, "inside");
        borders.finish(&tile, &messages);
        let known = messages.known_sides(1, &(3..6)).iter();
        let known: Vec<u8> = known.map(|sides| sides.load(Ordering::Relaxed)).collect();
        assert_eq!(known, [0, ALL, LEFT | ABOVE]);
    }
}
