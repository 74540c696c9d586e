//! Where pixels are sampled, and how the samples become the pixel's colour.

use std::ops::Range;

use super::candidates::Candidates;
use super::engine::Engine;
use super::faces::may_hide_face;
use super::lattice::range;
use super::limits::Limits;
use super::messages::EdgeMessages;
use super::refinement::Refinement;
use super::samples::{EdgeDetail, OBJECT_BITS, Samples, Traced};
use super::shadows::{may_leave_gap, may_swap_lights};
use super::thresholds::FARTHEST_CORNER;
use super::tile::{Tile, TileColors};
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat};

/// Number of crowded pixels that are traced at once.
const PIXELS_PER_BATCH: usize = 64;

/// Steps per pixel to which places are rounded: single precision can represent them anywhere in a picture of 16,384
/// pixels, so that both precisions trace the same rays.
const ROUNDING_STEPS: f64 = 512.0;

/// Rounds a place in a pixel to one that both precisions can represent.
fn round_to_steps(coordinate: f64) -> f64 {
    (coordinate * ROUNDING_STEPS).round() / ROUNDING_STEPS
}

/// Samples the pixels of tiles; its buffers are reused.
pub struct Sampler<L: SimdFloat> {
    /// Whether packets cover squares, as they should where they see many small things.
    in_squares: bool,
    /// Horizontal places of the samples in a row, and vertical places of the rows.
    columns: Vec<L::Real>,
    rows: Vec<L::Real>,
    /// For each traced sample its index in the tile, counted row by row, if packets cover squares.
    order: Vec<u32>,
    /// The results in that order.
    unsorted: Traced<L::Real>,
    samples: Samples<L::Real>,
    traced: Traced<L::Real>,
    /// The results at the corners of the pixels of a tile.
    corners: Traced<L::Real>,
    refinement: Refinement<L::Real>,
}

impl<L: SimdFloat> Sampler<L> {
    /// Creates a sampler. Whether packets cover squares changes the cost of a picture, not its content.
    pub fn new(in_squares: bool) -> Self {
        Self {
            in_squares,
            columns: Vec::new(),
            rows: Vec::new(),
            order: Vec::new(),
            unsorted: Traced::default(),
            samples: Samples::default(),
            traced: Traced::default(),
            corners: Traced::default(),
            refinement: Refinement::default(),
        }
    }

    /// Traces the centres of these pixels (column, row) and returns the results in the same order, followed by
    /// padding.
    #[inline(always)]
    pub fn centres<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        pixels: impl Iterator<Item = (usize, usize)>,
    ) -> &Traced<L::Real> {
        let centre = |index: usize| L::Real::from_f64(index as f64 + 0.5);
        self.samples.clear();
        for (column, row) in pixels {
            self.samples.push(centre(column), centre(row));
        }
        self.samples.pad(L::WIDTH);
        engine.trace(
            &self.samples,
            candidates,
            EdgeDetail::Ignored,
            &mut self.traced,
        );
        &self.traced
    }

    /// Traces each pixel of a tile at (`x`, `y`) from its upper left corner and returns the results row by row,
    /// followed by padding.
    #[inline(always)]
    pub fn one_per_pixel<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        (x, y): (f64, f64),
    ) -> &Traced<L::Real> {
        let pixels = (tile.columns.clone(), tile.rows.clone());
        self.trace(engine, candidates, pixels, ((x, y), EdgeDetail::Ignored));
        &self.traced
    }

    /// Traces a sample at (`x`, `y`) in each pixel; the results are in `traced`, row by row.
    #[inline(always)]
    fn trace<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        (columns, rows): (Range<usize>, Range<usize>),
        ((x, y), edges): ((f64, f64), EdgeDetail),
    ) {
        let coordinate =
            |index: usize, off: f64| L::Real::from_f64(index as f64 + round_to_steps(off));
        self.columns.clear();
        self.columns
            .extend(columns.map(|column| coordinate(column, x)));
        if TREE && self.in_squares && candidates.has_geometry {
            self.rows.clear();
            self.rows.extend(rows.map(|row| coordinate(row, y)));
            self.samples
                .set_grid_in_squares(&self.columns, &self.rows, &mut self.order);
            self.samples.pad(L::WIDTH);
            engine.trace(&self.samples, candidates, edges, &mut self.unsorted);
            self.traced.take_sorted(&self.unsorted, &self.order);
        } else {
            self.samples
                .set_grid(&self.columns, rows.map(|row| coordinate(row, y)));
            self.samples.pad(L::WIDTH);
            engine.trace(&self.samples, candidates, edges, &mut self.traced);
        }
    }

    /// Sets `colors` to the means of `side × side` samples in each pixel, each in the middle of its part, see
    /// [`round_to_steps`].
    #[inline(always)]
    pub fn grid<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        side: u32,
        colors: &mut TileColors<L::Real>,
    ) {
        colors.clear(tile.width(), tile.width() * tile.rows.len());
        let share = L::Real::from_f64(1.0 / f64::from(side * side));
        let middle = |part: u32| (f64::from(part) + 0.5) / f64::from(side);
        for part in 0..side * side {
            let position = (middle(part % side), middle(part / side));
            let traced = self.one_per_pixel(engine, candidates, tile, position);
            for (sum, new) in colors.channels.iter_mut().zip(traced.channels()) {
                for (sum, new) in sum.iter_mut().zip(new) {
                    *sum = *sum + *new * share;
                }
            }
        }
    }

    /// Sets `colors` to the means of pixels, which are subdivided as long as their corners differ; neighbours share
    /// corners.
    ///
    /// Whitted, "An improved illumination model for shaded display", CACM 23(6), 1980; here corners are told apart
    /// by the things that were hit and lit as well as by their colours.
    #[inline(always)]
    pub fn adaptive<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        (limits, messages): (Limits<L::Real>, &EdgeMessages),
        colors: &mut TileColors<L::Real>,
    ) {
        self.trace_corners(engine, candidates, tile);
        self.average_and_select(engine.token(), tile, limits, colors);
        let corners = (&self.corners, messages);
        if !self.refinement.start(tile, corners, limits, colors) {
            return;
        }
        // Thin things are searched for once more, in the middles of pixels and of their sides. What is thinner than
        // the quarters of pixels is hit by some sample nearby, or shows too little. If nothing thin is near the
        // corners of a pixel, there is none in it either.
        self.refinement.divide_near_thin();
        self.trace_requested(engine, candidates, tile, EdgeDetail::Thin);
        self.refinement.divide();
        self.trace_requested(engine, candidates, tile, EdgeDetail::Borders);
        // And so is light between shadows.
        self.refinement.divide_gaps(limits);
        self.trace_requested(engine, candidates, tile, EdgeDetail::Borders);
        self.refine(engine, candidates, tile, (limits, messages), colors);
    }

    /// Sets the colours of the pixels that have received a message, by row and column in the picture, and of those
    /// that get messages from them.
    pub fn notified_pixels<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        (limits, messages, pixels): (Limits<L::Real>, &EdgeMessages, &[[usize; 2]]),
        colors: &mut TileColors<L::Real>,
    ) {
        self.trace_corners(engine, candidates, tile);
        let stride = tile.width() + 1;
        colors.resize(stride, stride * tile.rows.len());
        let corners = (&self.corners, messages);
        self.refinement
            .start_notified(tile, corners, pixels, colors);
        self.refine(engine, candidates, tile, (limits, messages), colors);
    }

    /// The pixels of the last tile that have received a message, by row and column in it.
    pub fn notified(&self) -> &[[usize; 2]] {
        self.refinement.notified()
    }

    /// Traces a sample at each corner of the pixels of a tile.
    #[inline(always)]
    fn trace_corners<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
    ) {
        let columns = tile.columns.start..tile.columns.end + 1;
        let rows = tile.rows.start..tile.rows.end + 1;
        self.trace(
            engine,
            candidates,
            (columns, rows),
            ((0.0, 0.0), EdgeDetail::Thin),
        );
        std::mem::swap(&mut self.traced, &mut self.corners);
    }

    /// Examines cells until all are known.
    #[inline(always)]
    fn refine<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        (limits, messages): (Limits<L::Real>, &EdgeMessages),
        colors: &mut TileColors<L::Real>,
    ) {
        loop {
            while self.refinement.request_samples() {
                self.trace_requested(engine, candidates, tile, EdgeDetail::Signatures);
                self.refinement.evaluate_samples(limits, colors);
            }
            let corners = (&self.corners, messages);
            if engine.is_stopped() {
                return;
            }
            if !self.refinement.exchange_messages(tile, corners, colors) {
                break;
            }
        }
        if !self.refinement.crowded().is_empty() {
            self.fill_crowded(engine, candidates, tile, limits, colors);
        }
    }

    /// Sets crowded pixels to the means of samples all over them, on a Fibonacci lattice (Zaremba, "Good lattice
    /// points, discrepancy, and numerical integration", Ann. Mat. Pura Appl. 73, 1966).
    #[inline(never)]
    fn fill_crowded<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        limits: Limits<L::Real>,
        colors: &mut TileColors<L::Real>,
    ) {
        let (count, step) = limits.spread_out();
        let share = L::Real::from_f64(1.0 / count as f64);
        let coordinate = |pixel: usize, part: usize| {
            let part = (part as f64 + 0.5) / count as f64;
            L::Real::from_f64(pixel as f64 + round_to_steps(part))
        };
        for pixels in self.refinement.crowded().chunks(PIXELS_PER_BATCH) {
            self.samples.clear();
            for &[row, column] in pixels {
                let (x, y) = (tile.columns.start + column, tile.rows.start + row);
                for part in 0..count {
                    self.samples
                        .push(coordinate(x, part), coordinate(y, part * step % count));
                }
            }
            self.samples.pad(L::WIDTH);
            engine.trace(
                &self.samples,
                candidates,
                EdgeDetail::Ignored,
                &mut self.traced,
            );
            for (number, &[row, column]) in pixels.iter().enumerate() {
                let pixel_samples = number * count..(number + 1) * count;
                let pixel = row * colors.stride + column;
                for (mean, traced) in colors.channels.iter_mut().zip(self.traced.channels()) {
                    let sum = traced[pixel_samples.clone()].iter();
                    let sum = sum.fold(L::Real::ZERO, |sum, &one| sum + one);
                    mean[pixel] = sum * share;
                }
            }
        }
    }

    /// Traces the samples that were requested and have no result yet.
    #[inline(always)]
    fn trace_requested<const TREE: bool>(
        &mut self,
        engine: &mut Engine<L, TREE>,
        candidates: &Candidates,
        tile: &Tile,
        edges: EdgeDetail,
    ) {
        self.refinement.requested_samples(tile, &mut self.samples);
        self.samples.pad(L::WIDTH);
        if self.samples.count > 0 {
            engine.trace(&self.samples, candidates, edges, &mut self.traced);
            self.refinement.take_results(&self.traced);
        }
    }

    /// Sets every pixel to the mean of its corners, and notes the pixels to subdivide. Most pictures are smooth
    /// nearly everywhere, so this is most of the cost of smoothing: one loop over the whole tile, with one entry at
    /// the end of each row that is not a pixel.
    #[inline(always)]
    fn average_and_select(
        &mut self,
        token: L::Token,
        tile: &Tile,
        limits: Limits<L::Real>,
        colors: &mut TileColors<L::Real>,
    ) {
        let (width, stride) = (tile.width(), tile.width() + 1);
        let length = stride * tile.rows.len() - 1;
        colors.resize(stride, length.next_multiple_of(L::WIDTH));
        self.corners.lengthen(L::WIDTH);
        self.refinement.clear();
        let quarter = L::splat(token, L::Real::from_f64(0.25));
        let reach = quarter.like_f64(FARTHEST_CORNER);
        let has_faces = !self.corners.faces.is_empty();
        let has_shadows = self.corners.shadows.iter().any(|&shadows| shadows != 0);
        for first in (0..length).step_by(L::WIDTH) {
            let mut contrast = quarter.like(L::Real::ZERO);
            for (means, traced) in colors.channels.iter_mut().zip(self.corners.channels()) {
                let [a, b, c, d] = corners_at::<L>(token, traced, first, stride);
                (((a + b) + (c + d)) * quarter).store(&mut means[first..]);
                contrast = contrast + range(a, b, c, d);
            }
            let mut limit = [L::Real::ZERO; MAX_LANES];
            let signatures_at = |from: usize| &self.corners.signature[from..from + L::WIDTH];
            let (a, b) = (signatures_at(first), signatures_at(first + 1));
            let (c, d) = (
                signatures_at(first + stride),
                signatures_at(first + stride + 1),
            );
            for lane in 0..L::WIDTH {
                let diff = (a[lane] ^ b[lane]) | (a[lane] ^ c[lane]) | (a[lane] ^ d[lane]);
                limit[lane] = if diff & OBJECT_BITS == 0 {
                    limits.contrast(diff == 0)
                } else {
                    -L::Real::ONE
                };
            }
            if has_shadows {
                let shadows_at = |from: usize| &self.corners.shadows[from..from + L::WIDTH];
                let (a, b) = (shadows_at(first), shadows_at(first + 1));
                let (c, d) = (shadows_at(first + stride), shadows_at(first + stride + 1));
                for lane in 0..L::WIDTH {
                    let shadows = [a[lane], b[lane], c[lane], d[lane]];
                    limit[lane] = if may_leave_gap(shadows) | may_swap_lights(shadows) {
                        -L::Real::ONE
                    } else {
                        limit[lane]
                    };
                }
            }
            let [a, b, c, d] = corners_at::<L>(token, &self.corners.thin_distance, first, stride);
            let is_near_thin = a.min(b).min(c.min(d)).less(reach);
            let to_divide = is_near_thin | L::load(token, &limit).less(contrast);
            let mut remaining = to_divide.bits();
            let may_hide = if has_faces {
                may_hide_at(&self.corners.faces, (first, stride), L::WIDTH)
            } else {
                0
            };
            remaining |= may_hide;
            while remaining != 0 {
                let lane = remaining.trailing_zeros() as usize;
                let index = first + lane;
                remaining &= remaining - 1;
                let (column, row) = (index % stride, index / stride);
                if column == width || row >= tile.rows.len() {
                    continue;
                }
                self.refinement.add(column, row, may_hide >> lane & 1 == 1);
            }
        }
    }
}

/// Returns the values at the corners of cells, from `first` on: upper left and right, lower left and right.
#[inline(always)]
fn corners_at<L: SimdFloat>(
    token: L::Token,
    traced: &[L::Real],
    first: usize,
    stride: usize,
) -> [L; 4] {
    let at = |from: usize| L::load(token, &traced[from..]);
    let below = first + stride;
    [at(first), at(first + 1), at(below), at(below + 1)]
}

/// Returns which of `count` cells, from `first` on, may show a face of a mesh, or light between two, that no corner
/// has seen; bit by bit.
fn may_hide_at(faces: &[u64], (first, stride): (usize, usize), count: usize) -> u64 {
    let above = &faces[first..=first + count];
    let below = &faces[first + stride..=first + stride + count];
    // Most cells are on a single face: checked in step.
    let diff = |row: &[u64]| row.iter().fold(0, |all, face| all | (face ^ above[0]));
    if diff(above) | diff(below) == 0 {
        return 0;
    }
    let mut may_hide = 0;
    for cell in 0..count {
        let corners = [above[cell], above[cell + 1], below[cell], below[cell + 1]];
        may_hide |= u64::from(may_hide_face(corners)) << cell;
    }
    may_hide
}
