//! The samples of a tile that its pixels share, and when a cell between them is subdivided.

use super::samples::{Samples, Traced};
use super::thresholds::{EDGE_ERROR, FINEST, NEAR};
use super::tile::{Tile, TileColors};
use crate::scene::MAX_HALVINGS;
use crate::simd::{Real, SimdFloat};

/// Points of the finest grid in a pixel.
const POINTS: usize = FINEST * FINEST;

/// The place of each point of a pixel, row by row, among those of the pixel: what fewer halvings reach comes first, so
/// that what is looked at together is together in the cache.
const PLACES: [u8; POINTS] = {
    let mut places = [0; POINTS];
    let (mut next, mut step) = (0, FINEST);
    while step > 0 {
        let mut point = 0;
        while point < POINTS {
            let (x, y) = (point % FINEST, point / FINEST);
            let is_reached = x % step == 0 && y % step == 0;
            let was_reached = step < FINEST && x % (2 * step) == 0 && y % (2 * step) == 0;
            if is_reached && !was_reached {
                places[point] = next as u8;
                next += 1;
            }
            point += 1;
        }
        step /= 2;
    }
    places
};

/// What was seen at a point.
#[derive(Clone, Copy, Debug)]
struct Sample<R> {
    /// Red, green and blue, and what is near: one row, so that they are handled in step.
    values: [R; 4],
    signature: u32,
}

impl<R: Real> Sample<R> {
    #[inline(always)]
    fn of(traced: &Traced<R>, index: usize) -> Self {
        let [red, green, blue] = traced.channels();
        Self {
            values: [red[index], green[index], blue[index], traced.near[index]],
            signature: traced.signature[index],
        }
    }
}

/// Samples on the finest grid of a tile that are shared by the cells around them.
#[derive(Debug)]
pub struct Lattice<R> {
    /// Pixels from one row to the next, with one at the end of each that has corners alone.
    stride: usize,
    /// 1 + the index of each point's sample, 0 where there is none; pixel by pixel.
    indices: Vec<u32>,
    /// Column and row of the points that have a sample, in order of their samples.
    points: Vec<[u16; 2]>,
    samples: Vec<Sample<R>>,
}

/// A square between samples: its upper left corner on the finest grid, its side, and its samples.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Columns of the finest grid from the left.
    pub x: u16,
    /// Rows of the finest grid from the top.
    pub y: u16,
    /// Steps of the finest grid.
    side: u16,
    /// The samples at its corners: upper left and right, lower left and right.
    corners: [u32; 4],
}

impl Cell {
    /// A pixel of a tile, whose samples [`Lattice::start`] finds.
    pub fn pixel(column: usize, row: usize) -> Self {
        Self {
            x: (column * FINEST) as u16,
            y: (row * FINEST) as u16,
            side: FINEST as u16,
            corners: [0; 4],
        }
    }
}

/// The largest difference of four numbers.
#[inline(always)]
pub fn range<L: SimdFloat>(a: L, b: L, c: L, d: L) -> L {
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

    /// The contrast of the corners of a cell above which its inside must be looked at, by whether they see
    /// the same. It must be as well where something thin is near: corners say nothing of what passes between them,
    /// whether they see the same, others of the same kind, or neither.
    #[inline(always)]
    pub fn contrast(self, is_same: bool) -> R {
        if is_same {
            self.contrast
        } else {
            self.edge_contrast
        }
    }
}

impl<R: Real> Lattice<R> {
    /// No samples.
    pub fn new() -> Self {
        Self {
            stride: 0,
            indices: Vec::new(),
            points: Vec::new(),
            samples: Vec::new(),
        }
    }

    /// Forgets the tile before, and starts with the corners of these pixels, among those of all.
    #[inline(always)]
    pub fn start(&mut self, tile: &Tile, corners: &Traced<R>, pixels: &mut [Cell]) {
        for &[x, y] in &self.points {
            let point = self.point(x.into(), y.into());
            self.indices[point] = 0;
        }
        self.points.clear();
        self.stride = tile.width() + 1;
        let points = self.stride * (tile.rows.len() + 1) * POINTS;
        if self.indices.len() < points {
            self.indices.resize(points, 0);
        }
        self.samples.clear();
        for pixel in pixels {
            let (left, top) = (pixel.x as usize, pixel.y as usize);
            let (right, bottom) = (left + FINEST, top + FINEST);
            let places = [(left, top), (right, top), (left, bottom), (right, bottom)];
            for (corner, (x, y)) in pixel.corners.iter_mut().zip(places) {
                *corner = self.want(x, y);
                if *corner as usize == self.samples.len() {
                    let number = y / FINEST * self.stride + x / FINEST;
                    self.samples.push(Sample::of(corners, number));
                }
            }
        }
    }

    /// The number of a point of the grid.
    #[inline(always)]
    fn point(&self, x: usize, y: usize) -> usize {
        let pixel = y / FINEST * self.stride + x / FINEST;
        pixel * POINTS + PLACES[y % FINEST * FINEST + x % FINEST] as usize
    }

    /// Makes sure that there will be a sample at a point of the grid: its index.
    #[inline(always)]
    fn want(&mut self, x: usize, y: usize) -> u32 {
        let point = self.point(x, y);
        let index = &mut self.indices[point];
        if *index == 0 {
            self.points.push([x as u16, y as u16]);
            *index = self.points.len() as u32;
        }
        *index - 1
    }

    /// `samples` become those that are wanted and not there yet.
    #[inline(always)]
    pub fn wanted_samples<L: SimdFloat<Real = R>>(&self, tile: &Tile, samples: &mut Samples<R>) {
        samples.clear();
        let step = 1.0 / FINEST as f64;
        for &[x, y] in &self.points[self.samples.len()..] {
            samples.push(
                R::from_f64(tile.columns.start as f64 + f64::from(x) * step),
                R::from_f64(tile.rows.start as f64 + f64::from(y) * step),
            );
        }
        samples.pad(L::WIDTH);
    }

    /// Adds what was seen at the points that were wanted last.
    #[inline(always)]
    pub fn take_results(&mut self, traced: &Traced<R>) {
        let new = (0..traced.count).map(|index| Sample::of(traced, index));
        self.samples.extend(new);
    }

    /// The samples at the corners of a cell. Written out: mapping an array is a call there.
    #[inline(always)]
    fn corners(&self, cell: &Cell) -> [&Sample<R>; 4] {
        let [a, b, c, d] = cell.corners;
        let at = |corner: u32| &self.samples[corner as usize];
        [at(a), at(b), at(c), at(d)]
    }

    /// Whether the inside of a cell must be looked at.
    #[inline(always)]
    pub fn is_split(&self, cell: &Cell, depth: u32, limits: Limits<R>) -> bool {
        let [a, b, c, d] = self.corners(cell);
        let differing =
            (a.signature ^ b.signature) | (a.signature ^ c.signature) | (a.signature ^ d.signature);
        let (mut least, mut ranges) = ([R::ZERO; 4], [R::ZERO; 4]);
        for index in 0..4 {
            let (a, b) = (a.values[index], b.values[index]);
            let (c, d) = (c.values[index], d.values[index]);
            least[index] = a.min(b).min(c.min(d));
            ranges[index] = range(a, b, c, d);
        }
        let contrast = ranges[0] + ranges[1] + ranges[2];
        let side = f64::from(cell.side) / FINEST as f64;
        let is_near = least[3] < R::from_f64(NEAR * side);
        let limit = limits.at(R::from_f64(side)).contrast(differing == 0);
        depth < limits.finest_depth() && (is_near || contrast > limit)
    }

    /// Adds the mean of a cell's corners to its pixel, by its area.
    #[inline(always)]
    pub fn accumulate(&self, cell: &Cell, pixel: usize, colors: &mut TileColors<R>) {
        let side = f64::from(cell.side) / FINEST as f64;
        let share = R::from_f64(side * side / 4.0);
        let [a, b, c, d] = self.corners(cell);
        let mut part = [R::ZERO; 4];
        for (index, part) in part.iter_mut().enumerate() {
            let upper = a.values[index] + b.values[index];
            let lower = c.values[index] + d.values[index];
            *part = (upper + lower) * share;
        }
        for (sum, part) in colors.channels.iter_mut().zip(part) {
            sum[pixel] = sum[pixel] + part;
        }
    }

    /// Puts the four quarters of a cell into `cells`, and wants their corners.
    #[inline(always)]
    pub fn subdivide(&mut self, cell: &Cell, cells: &mut Vec<Cell>) {
        let half = cell.side / 2;
        let (left, top) = (cell.x as usize, cell.y as usize);
        let (middle, centre) = (left + half as usize, top + half as usize);
        let (right, bottom) = (middle + half as usize, centre + half as usize);
        let [a, b, c, d] = cell.corners;
        let above = self.want(middle, top);
        let before = self.want(left, centre);
        let inside = self.want(middle, centre);
        let behind = self.want(right, centre);
        let below = self.want(middle, bottom);
        let quarter = |x: usize, y: usize, corners: [u32; 4]| Cell {
            x: x as u16,
            y: y as u16,
            side: half,
            corners,
        };
        cells.extend([
            quarter(left, top, [a, above, before, inside]),
            quarter(middle, top, [above, b, inside, behind]),
            quarter(left, centre, [before, inside, c, below]),
            quarter(middle, centre, [inside, behind, below, d]),
        ]);
    }
}
