//! The tile loop: which pixels are traced, by which thread, and when to stop.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::time::{Duration, Instant};

use rayon::iter::{IndexedParallelIterator as _, IntoParallelIterator as _, ParallelIterator as _};
use rayon::slice::ParallelSliceMut as _;

use super::band::Band;
use super::candidates::Candidates;
use super::canvas::Pixels;
use super::control::RenderControl;
use super::messages::{BandMessages, EdgeMessages};
use super::retrace::DoublePrecision;
use super::stats::Rays;
use super::threads::Threads;
use super::tile::{Grid, Pass, Pixel, Tile};
use super::workspace_pool::WorkspacePool;
use crate::plan::{Plan, Planner, Region, RenderRequest, Show, is_double, is_filtered};
use crate::scene::{Aspect, Sampling, Scene};
use crate::simd::{Level, SimdReal};

/// Side of a tile in pixels if there is little to see. Large enough that the bookkeeping does not show, small enough
/// that the rays of a tile stay in the cache and that threads end together.
const LARGE_TILE: usize = 32;
/// Side of a tile if there is much to see: each tile then sees less of it.
const SMALL_TILE: usize = 16;
/// Side of a tile if the cost of tiles is shown.
const COST_TILE: usize = 8;
/// Pixels per bounded primitive below which there is much to see.
const PIXELS_PER_PRIMITIVE: u64 = 16_384;

/// Pixels per bounded primitive below which packets cover squares: a row of sixteen pixels sees more than a square
/// of them, but sorting them takes time, too.
const PIXELS_IN_SQUARES: u64 = 128;

/// Least number of pieces of a picture per thread, if there are that many tiles. The most expensive piece of a mesh
/// of a million faces takes 20 times as long as others: with an eighth as many pieces, 16 threads wait for the last
/// of them a fifth of their time, and 64 threads half of it.
const PIECES_PER_THREAD: usize = 128;

/// Most pixels of a strip: 16 MB as levels, or 48 MB as light. Smaller pictures are one strip.
const MAX_STRIP_PIXELS: usize = 1 << 22;
/// The rows of a strip are a multiple of this: an EXR file is written in squares with this side, and a square is
/// asked for row by row.
const EXR_SQUARE: usize = 64;

/// A picture of a scene, planned in the real type that it needs.
#[derive(Debug)]
pub struct Tracer {
    width: usize,
    height: usize,
    /// Side of a tile in pixels.
    tile: usize,
    in_squares: bool,
    /// Rows of a strip.
    strip_rows: usize,
    /// The part that is traced; `None` for all of the picture.
    region: Option<Region>,
    sampling: Sampling,
    level: Level,
    plan: AnyPlan,
    /// Traces samples again that single precision leaves in doubt.
    retracer: Option<DoublePrecision>,
    workspace_pool: WorkspacePool,
}

#[derive(Debug)]
enum AnyPlan {
    Single(Box<Plan<f32>>),
    Double(Box<Plan<f64>>),
}

impl AnyPlan {
    /// The number of bounded primitives.
    fn bounded(&self) -> u64 {
        let count = match self {
            Self::Single(plan) => plan.bounded(),
            Self::Double(plan) => plan.bounded(),
        };
        count as u64
    }
}

impl Tracer {
    /// Plans `request` of `scene`, which must pass [`crate::scene::check`].
    pub fn new(scene: &Scene, request: &RenderRequest) -> Self {
        Self::planned(scene, request, &mut Planner::default())
    }

    /// Plans a picture after others: what `planner` has kept of these is reused.
    pub fn planned(scene: &Scene, request: &RenderRequest, planner: &mut Planner) -> Self {
        let level = request.level.unwrap_or_else(Level::widest);
        let is_double = is_double(scene, request);
        let is_filtered = !is_double && is_filtered(scene, request);
        if is_filtered {
            planner.pack_meshes(scene);
        }
        let Planner { single, double } = planner;
        let mut in_single = || Box::new(Plan::new(scene, request, single));
        let mut in_double = || Box::new(Plan::new(scene, request, double));
        let (plan, retracer) = if is_double {
            (AnyPlan::Double(in_double()), None)
        } else if is_filtered {
            let (mut plan, double_plan) = rayon::join(in_single, in_double);
            plan.doubt();
            (
                AnyPlan::Single(plan),
                Some(DoublePrecision::new(double_plan, level)),
            )
        } else {
            (AnyPlan::Single(in_single()), None)
        };
        let pixels = request.pixels();
        let is_sparse = plan.bounded() * PIXELS_PER_PRIMITIVE <= pixels;
        let side = if is_sparse { LARGE_TILE } else { SMALL_TILE };
        let (width, height) = (request.width as usize, request.height as usize);
        let strip_rows = MAX_STRIP_PIXELS / width.max(1) / EXR_SQUARE * EXR_SQUARE;
        Self {
            width,
            height,
            strip_rows: strip_rows.clamp(EXR_SQUARE, height.max(EXR_SQUARE)),
            tile: match (request.aspect, request.sampling) {
                (Aspect::Cost, _) => COST_TILE,
                // A tile has one more corner in a row than pixels: its corners fill whole packets.
                (_, Sampling::Adaptive { .. }) => side - 1,
                _ => side,
            },
            in_squares: plan.bounded() * PIXELS_IN_SQUARES > pixels,
            region: request.region,
            sampling: request.sampling,
            level,
            plan,
            retracer,
            workspace_pool: WorkspacePool::default(),
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The number of rows of a strip. Pixels send no messages to those of other strips, so that strips may be traced
    /// separately.
    pub fn strip(&self) -> usize {
        self.strip_rows
    }

    /// The real type and the number of lanes, for example `f32×16 avx2`.
    pub fn lanes(&self) -> String {
        match self.plan {
            AnyPlan::Single(_) => self.level.lanes_of::<f32>(),
            AnyPlan::Double(_) => self.level.lanes_of::<f64>(),
        }
    }

    /// Traces the pixels of `pass` into `pixels` (row by row from the top, `width × height`), on the threads of the
    /// current rayon pool.
    ///
    /// The colours do not depend on the number of threads or lanes, or on what was traced before. `None` if
    /// `control` is stopped; some pixels then still have their old colours.
    pub fn pass<P: Pixel>(
        &self,
        pixels: &mut [P],
        pass: Pass,
        control: &RenderControl,
    ) -> Option<Rays> {
        let strips = pixels.chunks_mut((self.strip_rows * self.width).max(1));
        let mut rays = Rays::default();
        for (index, pixels) in strips.enumerate() {
            rays += self.trace_rows(pixels, index * self.strip_rows, pass, control)?;
        }
        Some(rays)
    }

    /// Traces whole rows of the picture, from `first` on, into `pixels`; see [`Self::pass`]. If they are a strip of
    /// the picture, they are the same as in all of it.
    pub fn rows<P: Pixel>(
        &self,
        pixels: &mut [P],
        first: usize,
        control: &RenderControl,
    ) -> Option<Rays> {
        self.trace_rows(pixels, first, Pass::Whole, control)
    }

    fn trace_rows<P: Pixel>(
        &self,
        pixels: &mut [P],
        first: usize,
        pass: Pass,
        control: &RenderControl,
    ) -> Option<Rays> {
        match &self.plan {
            AnyPlan::Single(plan) => self.trace_pass(plan, pixels, first, pass, control),
            AnyPlan::Double(plan) => self.trace_pass(plan, pixels, first, pass, control),
        }
    }

    /// Returns the number of columns in a piece if `threads` threads trace `rows` rows: whole rows of tiles, if that
    /// is enough pieces for all threads to end at nearly the same time.
    fn piece_width(&self, rows: usize, threads: usize) -> usize {
        let bands = rows.div_ceil(self.tile).max(1);
        let pieces = (threads * PIECES_PER_THREAD).div_ceil(bands);
        self.width.div_ceil(self.tile).div_ceil(pieces).max(1) * self.tile
    }

    /// Returns the pieces that the picture is divided into for a number of threads.
    fn pieces(&self, threads: usize) -> impl Iterator<Item = Tile> {
        let piece_width = self.piece_width(self.height, threads);
        (0..self.height).step_by(self.tile).flat_map(move |top| {
            let starts = (0..self.width).step_by(piece_width);
            starts.map(move |left| Tile {
                columns: left..(left + piece_width).min(self.width),
                rows: top..(top + self.tile).min(self.height),
            })
        })
    }

    /// Measures how long each of the pieces takes that a number of threads would share, one after the other on this
    /// thread.
    pub fn time_pieces(&self, threads: usize) -> Vec<Duration> {
        match &self.plan {
            AnyPlan::Single(plan) => self.time_pieces_of(plan, threads),
            AnyPlan::Double(plan) => self.time_pieces_of(plan, threads),
        }
    }

    fn time_pieces_of<R: SimdReal>(&self, plan: &Plan<R>, threads: usize) -> Vec<Duration> {
        let candidates = Candidates::all_seen(plan);
        let samples = (Grid::ALL, self.sampling);
        let mut pixels = vec![[0.0_f32; 3]; self.width * self.tile];
        let messages = self.edge_messages(0..self.height, self.sampling);
        let time = |place: Tile| {
            let rows = pixels.chunks_mut(place.width());
            let rows = rows.take(place.rows.len()).collect();
            let since = Instant::now();
            // Never stopped.
            let control = RenderControl::default();
            let context = (BandMessages::all(&messages), &control);
            let _ = self.trace_piece((plan, &candidates), (place, rows), samples, context);
            since.elapsed()
        };
        self.pieces(threads).map(time).collect()
    }

    /// Traces a piece on this thread.
    fn trace_piece<R: SimdReal, P: Pixel>(
        &self,
        (plan, candidates): (&Plan<R>, &Candidates),
        (place, pixels): (Tile, Vec<&mut [P]>),
        (grid, sampling): (Grid, Sampling),
        (messages, control): (BandMessages, &RenderControl),
    ) -> Option<Rays> {
        // Outside of the kernel, which is left alone; pieces are short compared with any pause.
        control.wait_while_paused();
        let mut canvas = Pixels {
            place: place.clone(),
            rows: pixels,
            level: self.level,
        };
        self.level.run(Band {
            plan,
            candidates,
            tile: self.tile,
            in_squares: self.in_squares,
            region: self.region,
            place,
            canvas: &mut canvas,
            grid,
            sampling,
            messages,
            retracer: self.retracer.as_ref().map(|retracer| retracer as _),
            workspace_pool: &self.workspace_pool,
            control,
        })
    }

    fn trace_pass<R: SimdReal, P: Pixel>(
        &self,
        plan: &Plan<R>,
        pixels: &mut [P],
        first: usize,
        pass: Pass,
        control: &RenderControl,
    ) -> Option<Rays> {
        let candidates = Candidates::all_seen(plan);
        let (grid, sampling) = match pass {
            Pass::Whole => (Grid::ALL, self.sampling),
            Pass::Centres(grid) => (grid, Sampling::Centres),
        };
        let rows = pixels.len() / self.width.max(1);
        let mut messages = self.edge_messages(first..first + rows, sampling);
        let piece_width = self.piece_width(rows, Threads::current());
        let bands = pixels
            .par_chunks_mut(self.width * self.tile)
            .with_max_len(1)
            .enumerate();
        let trace = |(index, pixels): (usize, &mut [P])| {
            let top = first + index * self.tile;
            let rows = top..top + pixels.len() / self.width;
            let pieces = in_pieces(pixels, self.width, piece_width).into_par_iter();
            let pieces = pieces.enumerate().map(|(index, pixels)| {
                let left = index * piece_width;
                let place = Tile {
                    columns: left..(left + piece_width).min(self.width),
                    rows: rows.clone(),
                };
                let context = (BandMessages::all(&messages), control);
                self.trace_piece(
                    (plan, &candidates),
                    (place, pixels),
                    (grid, sampling),
                    context,
                )
            });
            pieces.try_reduce(Rays::default, |a, b| Some(a + b))
        };
        let mut rays = bands
            .map(trace)
            .try_reduce(Rays::default, |a, b| Some(a + b))?;
        loop {
            let received = messages.received();
            if received.is_empty() || plan.show == Show::Cost {
                return Some(rays);
            }
            let (received, targets) = ((&messages, received), (plan, &candidates));
            rays += self.pass_notified(targets, (pixels, first), received, control)?;
        }
    }

    /// Creates the exchange of messages between the pixels of these rows; an empty one if the sampling needs none.
    fn edge_messages(&self, rows: Range<usize>, sampling: Sampling) -> EdgeMessages {
        match sampling {
            Sampling::Adaptive { .. } => EdgeMessages::new(self.width, rows),
            Sampling::Centres | Sampling::Grid(_) => EdgeMessages::new(0, 0..0),
        }
    }

    /// Traces the pixels again that have received a message across the border of a tile.
    fn pass_notified<R: SimdReal, P: Pixel>(
        &self,
        targets: (&Plan<R>, &Candidates),
        (pixels, first): (&mut [P], usize),
        (messages, received): (&EdgeMessages, BTreeSet<[usize; 2]>),
        control: &RenderControl,
    ) -> Option<Rays> {
        let mut tiles: BTreeMap<[usize; 2], Vec<[usize; 2]>> = BTreeMap::new();
        for [row, column] in received {
            let tile = [(row - first) / self.tile, column / self.tile];
            tiles.entry(tile).or_default().push([row, column]);
        }
        let bands = pixels
            .par_chunks_mut(self.width * self.tile)
            .with_max_len(1);
        let trace = |(index, pixels): (usize, &mut [P])| {
            let top = first + index * self.tile;
            let rows = top..top + pixels.len() / self.width;
            let mut rays = Rays::default();
            for (&[_, tile_column], notified) in tiles.range([index, 0]..[index + 1, 0]) {
                let left = tile_column * self.tile;
                let place = Tile {
                    columns: left..(left + self.tile).min(self.width),
                    rows: rows.clone(),
                };
                let part = pixels.chunks_mut(self.width);
                let part = part.map(|row| &mut row[place.columns.clone()]).collect();
                let target = (place, part);
                let messages = BandMessages {
                    messages,
                    only_pixels: Some(notified),
                };
                let context = (messages, control);
                rays += self.trace_piece(targets, target, (Grid::ALL, self.sampling), context)?;
            }
            Some(rays)
        };
        let bands = bands.enumerate().map(trace);
        bands.try_reduce(Rays::default, |a, b| Some(a + b))
    }
}

/// Splits rows of `width` pixels into pieces of `piece_width` columns: for each, its part of every row.
fn in_pieces<P>(pixels: &mut [P], width: usize, piece_width: usize) -> Vec<Vec<&mut [P]>> {
    let mut pieces: Vec<Vec<&mut [P]>> = Vec::new();
    pieces.resize_with(width.div_ceil(piece_width), Vec::new);
    for row in pixels.chunks_mut(width) {
        for (piece, part) in pieces.iter_mut().zip(row.chunks_mut(piece_width)) {
            piece.push(part);
        }
    }
    pieces
}

#[cfg(test)]
mod tests;
