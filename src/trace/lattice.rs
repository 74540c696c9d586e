//! The samples of a tile that its pixels share, and when a cell between them is subdivided.

use super::samples::{Samples, Traced};
use super::thresholds::{EDGE_ERROR, FINEST, NEAR};
use super::tile::{Tile, TileColors};
use crate::scene::MAX_HALVINGS;
use crate::simd::{Real, SimdFloat};

/// Samples on the finest grid of a tile that are shared by the cells around them.
#[derive(Debug)]
pub struct Lattice<R> {
    /// Points from one row of the grid to the next.
    stride: usize,
    /// 1 + the index of each point's sample, 0 where there is none.
    indices: Vec<u32>,
    /// The points that have a sample, in order of their samples.
    points: Vec<u32>,
    colors: [Vec<R>; 3],
    signature: Vec<u32>,
    near: Vec<R>,
}

/// A square between samples: its upper left corner on the finest grid, and its side.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Columns of the finest grid from the left.
    pub x: u16,
    /// Rows of the finest grid from the top.
    pub y: u16,
    /// Steps of the finest grid.
    pub side: u16,
}

/// The largest difference of four numbers.
#[inline(always)]
pub fn range<R: Real>(a: R, b: R, c: R, d: R) -> R {
    a.max(b).max(c.max(d)) - a.min(b).min(c.min(d))
}

/// When cells are subdivided.
#[derive(Clone, Copy, Debug)]
pub struct Limits<R> {
    /// Difference of the corners of a cell, summed over the channels, above which it is subdivided.
    contrast: R,
    /// The same, times the side of the cell in pixels, where they see different things.
    edge_contrast: R,
    /// How often a pixel is subdivided, not counting the last time.
    depth: u32,
}

impl<R: Real> Limits<R> {
    /// With these limits for cells whose corners see the same.
    pub fn new(contrast: f64, depth: u32) -> Self {
        Self {
            contrast: R::from_f64(contrast),
            edge_contrast: R::from_f64(contrast.min(EDGE_ERROR)),
            depth: depth.min(MAX_HALVINGS),
        }
    }

    /// For cells of a side in pixels: the smaller they are, the more their corners may differ.
    #[inline(always)]
    fn at(self, side: R) -> Self {
        let edge_contrast = self.edge_contrast / side;
        Self {
            contrast: self.contrast.max(edge_contrast),
            edge_contrast,
            ..self
        }
    }

    /// How often a pixel is subdivided at most.
    pub fn finest_depth(self) -> u32 {
        self.depth + 1
    }

    /// Whether the inside of a cell must be looked at, by the contrast of its corners, whether they
    /// see the same, and whether something thin is near.
    #[inline(always)]
    pub fn want_more(self, contrast: R, is_same: bool, is_near: bool) -> bool {
        let limit = if is_same {
            self.contrast
        } else {
            self.edge_contrast
        };
        let differs = contrast > limit;
        // Corners that see the same say nothing of what passes between them.
        (is_near & is_same) | differs
    }
}

impl<R: Real> Lattice<R> {
    /// No samples.
    pub fn new() -> Self {
        Self {
            stride: 0,
            indices: Vec::new(),
            points: Vec::new(),
            colors: [Vec::new(), Vec::new(), Vec::new()],
            signature: Vec::new(),
            near: Vec::new(),
        }
    }

    /// Forgets the tile before, and starts with the corners of the pixels.
    pub fn start(&mut self, tile: &Tile, corners: &Traced<R>) {
        for &point in &self.points {
            self.indices[point as usize] = 0;
        }
        self.points.clear();
        self.stride = tile.width() * FINEST + 1;
        let points = self.stride * (tile.rows.len() * FINEST + 1);
        if self.indices.len() < points {
            self.indices.resize(points, 0);
        }
        for row in 0..=tile.rows.len() {
            for column in 0..=tile.width() {
                self.want(column * FINEST, row * FINEST);
            }
        }
        for channel in &mut self.colors {
            channel.clear();
        }
        self.signature.clear();
        self.near.clear();
        self.take_results(corners);
    }

    /// Makes sure that there will be a sample at a point of the grid.
    #[inline(always)]
    fn want(&mut self, x: usize, y: usize) {
        let point = y * self.stride + x;
        if self.indices[point] == 0 {
            self.points.push(point as u32);
            self.indices[point] = self.points.len() as u32;
        }
    }

    /// `samples` become those that are wanted and not there yet.
    #[inline(always)]
    pub fn wanted_samples<L: SimdFloat<Real = R>>(&self, tile: &Tile, samples: &mut Samples<R>) {
        samples.clear();
        let step = 1.0 / FINEST as f64;
        for &point in &self.points[self.signature.len()..] {
            let (x, y) = (point as usize % self.stride, point as usize / self.stride);
            samples.push(
                R::from_f64(tile.columns.start as f64 + x as f64 * step),
                R::from_f64(tile.rows.start as f64 + y as f64 * step),
            );
        }
        samples.pad(L::WIDTH);
    }

    /// Adds what was seen at the points that were wanted last.
    pub fn take_results(&mut self, traced: &Traced<R>) {
        for (all, new) in self.colors.iter_mut().zip(traced.channels()) {
            all.extend_from_slice(&new[..traced.count]);
        }
        self.signature
            .extend_from_slice(&traced.signature[..traced.count]);
        self.near.extend_from_slice(&traced.near[..traced.count]);
    }

    /// The samples at the corners of a cell.
    #[inline(always)]
    pub fn corners(&self, cell: Cell) -> [usize; 4] {
        let Cell { x, y, side } = cell;
        let at = |x: u16, y: u16| self.indices[y as usize * self.stride + x as usize] as usize - 1;
        [
            at(x, y),
            at(x + side, y),
            at(x, y + side),
            at(x + side, y + side),
        ]
    }

    /// Whether the inside of a cell must be looked at.
    #[inline(always)]
    pub fn is_split(&self, cell: Cell, corners: [usize; 4], depth: u32, limits: Limits<R>) -> bool {
        let first = self.signature[corners[0]];
        let is_same = corners
            .iter()
            .all(|&corner| self.signature[corner] == first);
        let reach = R::from_f64(NEAR / FINEST as f64 * f64::from(cell.side));
        let is_near = corners.iter().any(|&corner| self.near[corner] < reach);
        let mut contrast = R::ZERO;
        for channel in &self.colors {
            let [a, b, c, d] = corners.map(|corner| channel[corner]);
            contrast = contrast + range(a, b, c, d);
        }
        let side = R::from_f64(f64::from(cell.side) / FINEST as f64);
        depth < limits.finest_depth() && limits.at(side).want_more(contrast, is_same, is_near)
    }

    /// Adds the mean of a cell's corners to its pixel, by its area.
    #[inline(always)]
    pub fn accumulate(
        &self,
        cell: Cell,
        corners: [usize; 4],
        pixel: usize,
        colors: &mut TileColors<R>,
    ) {
        let side = f64::from(cell.side) / FINEST as f64;
        let share = R::from_f64(side * side / 4.0);
        for (sum, channel) in colors.channels.iter_mut().zip(&self.colors) {
            let [a, b, c, d] = corners.map(|corner| channel[corner]);
            sum[pixel] = sum[pixel] + ((a + b) + (c + d)) * share;
        }
    }

    /// Puts the four quarters of a cell into `cells`, and wants their corners.
    #[inline(always)]
    pub fn subdivide(&mut self, cell: Cell, cells: &mut Vec<Cell>) {
        let side = cell.side / 2;
        for (right, down) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            cells.push(Cell {
                x: cell.x + right * side,
                y: cell.y + down * side,
                side,
            });
        }
        for down in 0..3 {
            for right in 0..3 {
                self.want(
                    (cell.x + right * side) as usize,
                    (cell.y + down * side) as usize,
                );
            }
        }
    }
}
