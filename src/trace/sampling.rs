//! Which places of a pixel are traced, and how their colours become the pixel's.

use std::ops::Range;

use super::cull::Lists;
use super::samples::{Samples, Traced};
use super::stage::Engine;
use crate::lanes::{Lane, Real};

/// How often a pixel is halved where there is an edge: to an eighth.
const DEPTH: u32 = 3;
/// How often where something thinner than two pixels is, or a strong edge: to a sixteenth.
const FINEST_DEPTH: u32 = 4;
/// Steps of the finest grid in a pixel.
const FINEST: usize = 1 << FINEST_DEPTH;
/// Difference of the corners of a cell, summed over the channels, above which it is halved.
const CONTRAST: f64 = 0.1;
/// The same from [`DEPTH`] on: an edge along the finest cells may move by half of one, and must not
/// show that.
const STRONG_CONTRAST: f64 = 0.6;
/// The same where the corners see different things: four levels of 255, which nobody sees.
pub const EDGE_CONTRAST: f64 = 4.0 / 255.0;
/// A thing can be in a cell without being nearer than this to a corner, in sides of the cell: half
/// its diagonal, and a little for the rounding.
const NEAR: f64 = 0.75;

/// A rectangle of pixels.
#[derive(Clone, Debug)]
pub struct Tile {
    /// From left to right.
    pub columns: Range<usize>,
    /// From top to bottom.
    pub rows: Range<usize>,
}

/// Linear red, green and blue of the pixels of a tile, row by row.
#[derive(Debug, Default)]
pub struct Colors<R> {
    channels: [Vec<R>; 3],
    /// Places from one row to the next.
    pub stride: usize,
}

/// What sampling leaves behind for the next tile to use again.
pub struct Sampler<L: Lane> {
    /// Places of the samples of a row.
    columns: Vec<L::Real>,
    samples: Samples<L::Real>,
    traced: Traced<L::Real>,
    /// Of the pixels of a tile.
    contrast: Vec<L::Real>,
    wanting: Vec<bool>,
    mesh: Mesh<L::Real>,
    cells: Vec<Cell>,
    split: Vec<Cell>,
}

/// Samples on the finest grid of a tile that are shared by the cells around them.
#[derive(Debug)]
struct Mesh<R> {
    /// Points from one row of the grid to the next.
    stride: usize,
    /// 1 + the place of each point's sample, 0 where there is none.
    places: Vec<u32>,
    /// The points that have a sample, in order of their samples.
    points: Vec<u32>,
    colors: [Vec<R>; 3],
    signature: Vec<u32>,
    near: Vec<R>,
}

/// A square between samples: its upper left corner on the finest grid, and its side.
#[derive(Clone, Copy, Debug)]
struct Cell {
    x: u16,
    y: u16,
    side: u16,
}

impl Tile {
    fn width(&self) -> usize {
        self.columns.len()
    }
}

impl<R: Real> Colors<R> {
    /// Red, green and blue.
    pub fn channels(&self) -> [&[R]; 3] {
        self.channels.each_ref().map(Vec::as_slice)
    }

    fn clear(&mut self, stride: usize, length: usize) {
        self.stride = stride;
        for channel in &mut self.channels {
            channel.clear();
            channel.resize(length, R::ZERO);
        }
    }
}

impl<L: Lane> Sampler<L> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            columns: Vec::new(),
            samples: Samples::default(),
            traced: Traced::default(),
            contrast: Vec::new(),
            wanting: Vec::new(),
            mesh: Mesh {
                stride: 0,
                places: Vec::new(),
                points: Vec::new(),
                colors: [Vec::new(), Vec::new(), Vec::new()],
                signature: Vec::new(),
                near: Vec::new(),
            },
            cells: Vec::new(),
            split: Vec::new(),
        }
    }

    /// The colours at the centres of these pixels (column, row), in their order, and some more.
    #[inline(always)]
    pub fn centres(
        &mut self,
        token: L::Token,
        engine: &mut Engine<L>,
        seen: &Lists,
        pixels: impl Iterator<Item = (usize, usize)>,
    ) -> &Traced<L::Real> {
        let centre = |index: usize| L::Real::from_f64(index as f64 + 0.5);
        self.samples.clear();
        for (column, row) in pixels {
            self.samples.push(centre(column), centre(row));
        }
        self.samples.seal(L::WIDTH);
        engine.trace(token, &self.samples, seen, false, &mut self.traced);
        &self.traced
    }

    /// The colours of all pixels of a tile at (`x`, `y`) in each, from its upper left corner, row by
    /// row, and some more.
    #[inline(always)]
    pub fn all(
        &mut self,
        token: L::Token,
        engine: &mut Engine<L>,
        seen: &Lists,
        tile: &Tile,
        (x, y): (f64, f64),
    ) -> &Traced<L::Real> {
        let place = |index: usize, off: f64| L::Real::from_f64(index as f64 + off);
        self.samples.clear();
        self.columns.clear();
        self.columns
            .extend(tile.columns.clone().map(|column| place(column, x)));
        for row in tile.rows.clone() {
            self.samples.push_row(&self.columns, place(row, y));
        }
        self.samples.seal(L::WIDTH);
        engine.trace(token, &self.samples, seen, false, &mut self.traced);
        &self.traced
    }

    /// The means of `side × side` samples in each pixel, each in the middle of its part.
    #[inline(always)]
    pub fn grid(
        &mut self,
        token: L::Token,
        engine: &mut Engine<L>,
        seen: &Lists,
        tile: &Tile,
        side: u32,
        colors: &mut Colors<L::Real>,
    ) {
        colors.clear(tile.width(), tile.width() * tile.rows.len());
        let share = L::Real::from_f64(1.0 / f64::from(side * side));
        let middle = |part: u32| (f64::from(part) + 0.5) / f64::from(side);
        for part in 0..side * side {
            let place = (middle(part % side), middle(part / side));
            let traced = self.all(token, engine, seen, tile, place);
            for (sum, new) in colors.channels.iter_mut().zip(traced.channels()) {
                for (sum, new) in sum.iter_mut().zip(new) {
                    *sum = *sum + *new * share;
                }
            }
        }
    }

    /// The means of pixels that are halved as long as their corners differ; corners are shared.
    ///
    /// Whitted, "An improved illumination model for shaded display", CACM 23(6), 1980; here with
    /// the things that were hit and lit, beside the colours, to tell the corners apart.
    #[inline(always)]
    pub fn adaptive(
        &mut self,
        token: L::Token,
        engine: &mut Engine<L>,
        seen: &Lists,
        tile: &Tile,
        colors: &mut Colors<L::Real>,
    ) {
        let corners = (tile.columns.start..=tile.columns.end, tile.rows.clone());
        self.samples.clear();
        self.columns.clear();
        let place = |index: usize| L::Real::from_f64(index as f64);
        self.columns.extend(corners.0.map(place));
        for row in corners.1.start..=corners.1.end {
            self.samples.push_row(&self.columns, place(row));
        }
        self.samples.seal(L::WIDTH);
        engine.trace(token, &self.samples, seen, true, &mut self.traced);
        self.judge(tile, colors);
        if self.split.is_empty() {
            return;
        }
        self.mesh.start(tile, &self.traced);
        for depth in 1..=FINEST_DEPTH {
            self.cells.clear();
            for &cell in &self.split {
                self.mesh.halve(cell, &mut self.cells);
            }
            self.mesh.sample(
                token,
                engine,
                seen,
                tile,
                &mut self.samples,
                &mut self.traced,
            );
            self.split.clear();
            for &cell in &self.cells {
                let corners = self.mesh.corners(cell);
                if self.mesh.is_split(cell, corners, depth) {
                    self.split.push(cell);
                } else {
                    let pixel = cell.y as usize / FINEST * colors.stride + cell.x as usize / FINEST;
                    self.mesh.pour(cell, corners, pixel, colors);
                }
            }
            if self.split.is_empty() {
                break;
            }
        }
    }

    /// The pixels by their corners alone, and which of them must be looked into. Most pictures are
    /// smooth nearly everywhere, so this is what their smoothing costs: one loop over the whole tile,
    /// with a pixel at the end of each row that is none.
    #[inline(always)]
    fn judge(&mut self, tile: &Tile, colors: &mut Colors<L::Real>) {
        let stride = tile.width() + 1;
        let length = stride * tile.rows.len() - 1;
        colors.clear(stride, length);
        self.contrast.clear();
        self.contrast.resize(length, L::Real::ZERO);
        let quarter = L::Real::from_f64(0.25);
        for (means, traced) in colors.channels.iter_mut().zip(self.traced.channels()) {
            let corners = corners_of(traced, stride, length);
            for ((mean, contrast), ((&a, &b), (&c, &d))) in
                means.iter_mut().zip(&mut self.contrast).zip(corners)
            {
                *mean = ((a + b) + (c + d)) * quarter;
                *contrast = *contrast + range(a, b, c, d);
            }
        }
        self.wanting.clear();
        let signatures = corners_of(&self.traced.signature, stride, length);
        for (((&a, &b), (&c, &d)), &contrast) in signatures.zip(&self.contrast) {
            let is_same = ((a ^ b) | (a ^ c) | (a ^ d)) == 0;
            self.wanting.push(wants_more(contrast, is_same, false));
        }
        let reach = L::Real::from_f64(NEAR);
        let nears = corners_of(&self.traced.near, stride, length);
        for (((&a, &b), (&c, &d)), wanting) in nears.zip(&mut self.wanting) {
            *wanting |= a.min(b).min(c.min(d)) < reach;
        }
        self.split.clear();
        for row in 0..tile.rows.len() {
            for column in 0..tile.width() {
                if self.wanting[row * stride + column] {
                    self.split.push(Cell {
                        x: (column * FINEST) as u16,
                        y: (row * FINEST) as u16,
                        side: FINEST as u16,
                    });
                    for channel in &mut colors.channels {
                        channel[row * stride + column] = L::Real::ZERO;
                    }
                }
            }
        }
    }
}

/// The corners of cells: upper left and right, lower left and right.
#[inline(always)]
fn corners_of<T>(
    values: &[T],
    stride: usize,
    cells: usize,
) -> impl Iterator<Item = ((&T, &T), (&T, &T))> {
    let at = |from: usize| &values[from..from + cells];
    let upper = at(0).iter().zip(at(1));
    upper.zip(at(stride).iter().zip(at(stride + 1)))
}

/// The largest difference of four numbers.
#[inline(always)]
fn range<R: Real>(a: R, b: R, c: R, d: R) -> R {
    a.max(b).max(c.max(d)) - a.min(b).min(c.min(d))
}

/// Whether the inside of a cell must be looked at, by the contrast of its corners, whether they see
/// the same, and whether something thin is near.
#[inline(always)]
fn wants_more<R: Real>(contrast: R, is_same: bool, is_near: bool) -> bool {
    // Corners that see the same say nothing of what passes between them.
    is_near & is_same | (contrast > R::from_f64(if is_same { CONTRAST } else { EDGE_CONTRAST }))
}

impl<R: Real> Mesh<R> {
    /// Forgets the tile before, and starts with the corners of the pixels.
    fn start(&mut self, tile: &Tile, corners: &Traced<R>) {
        for &point in &self.points {
            self.places[point as usize] = 0;
        }
        self.points.clear();
        self.stride = tile.width() * FINEST + 1;
        let points = self.stride * (tile.rows.len() * FINEST + 1);
        if self.places.len() < points {
            self.places.resize(points, 0);
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
        self.take(corners);
    }

    /// Adds what was seen at the points that were wanted last.
    fn take(&mut self, traced: &Traced<R>) {
        for (all, new) in self.colors.iter_mut().zip(traced.channels()) {
            all.extend_from_slice(&new[..traced.count]);
        }
        self.signature
            .extend_from_slice(&traced.signature[..traced.count]);
        self.near.extend_from_slice(&traced.near[..traced.count]);
    }

    /// Makes sure that there will be a sample at a point of the grid.
    #[inline(always)]
    fn want(&mut self, x: usize, y: usize) {
        let point = y * self.stride + x;
        if self.places[point] == 0 {
            self.points.push(point as u32);
            self.places[point] = self.points.len() as u32;
        }
    }

    /// Traces the samples that are wanted and not there yet.
    #[inline(always)]
    fn sample<L: Lane<Real = R>>(
        &mut self,
        token: L::Token,
        engine: &mut Engine<L>,
        seen: &Lists,
        tile: &Tile,
        samples: &mut Samples<R>,
        traced: &mut Traced<R>,
    ) {
        samples.clear();
        let step = 1.0 / FINEST as f64;
        for &point in &self.points[self.signature.len()..] {
            let (x, y) = (point as usize % self.stride, point as usize / self.stride);
            samples.push(
                R::from_f64(tile.columns.start as f64 + x as f64 * step),
                R::from_f64(tile.rows.start as f64 + y as f64 * step),
            );
        }
        samples.seal(L::WIDTH);
        engine.trace(token, samples, seen, true, traced);
        self.take(traced);
    }

    /// The samples at the corners of a cell.
    #[inline(always)]
    fn corners(&self, cell: Cell) -> [usize; 4] {
        let Cell { x, y, side } = cell;
        let at = |x: u16, y: u16| self.places[y as usize * self.stride + x as usize] as usize - 1;
        [
            at(x, y),
            at(x + side, y),
            at(x, y + side),
            at(x + side, y + side),
        ]
    }

    /// Whether the inside of a cell must be looked at.
    #[inline(always)]
    fn is_split(&self, cell: Cell, corners: [usize; 4], depth: u32) -> bool {
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
        if depth < DEPTH {
            wants_more(contrast, is_same, is_near)
        } else {
            depth < FINEST_DEPTH && (is_near || contrast > R::from_f64(STRONG_CONTRAST))
        }
    }

    /// Adds the mean of a cell's corners to its pixel, by its area.
    #[inline(always)]
    fn pour(&self, cell: Cell, corners: [usize; 4], pixel: usize, colors: &mut Colors<R>) {
        let side = f64::from(cell.side) / FINEST as f64;
        let share = R::from_f64(side * side / 4.0);
        for (sum, channel) in colors.channels.iter_mut().zip(&self.colors) {
            let [a, b, c, d] = corners.map(|corner| channel[corner]);
            sum[pixel] = sum[pixel] + ((a + b) + (c + d)) * share;
        }
    }

    /// Puts the four quarters of a cell into `cells`, and wants their corners.
    #[inline(always)]
    fn halve(&mut self, cell: Cell, cells: &mut Vec<Cell>) {
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
