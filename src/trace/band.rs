//! Traces the tiles that one thread takes, one after the other.

use std::sync::atomic::Ordering;

use super::candidates::Candidates;
use super::canvas::Canvas;
use super::control::RenderControl;
use super::engine::{Engine, Retracer, Workspace};
use super::heat::heat;
use super::intersect::Kernel;
use super::limits::Limits;
use super::messages::BandMessages;
use super::sampler::Sampler;
use super::stats::Rays;
use super::tile::{Grid, Tile, TileColors};
use super::workspace_pool::WorkspacePool;
use crate::plan::{Plan, Region, Show};
use crate::scene::Sampling;
use crate::simd::{SimdFloat, SimdReal, WithSimd};

/// A row of tiles, or a part of one.
pub struct Band<'a, R> {
    /// The scene and view to trace.
    pub plan: &'a Plan<R>,
    /// Everything that camera rays may hit.
    pub candidates: &'a Candidates,
    /// Side of a tile in pixels.
    pub tile: usize,
    /// Whether packets cover squares of pixels instead of rows.
    pub in_squares: bool,
    /// The part of the picture to trace; `None` for all of it.
    pub region: Option<Region>,
    /// The pixels of the picture that it covers.
    pub place: Tile,
    /// Receives the colours of its pixels.
    pub canvas: &'a mut dyn Canvas<R>,
    /// Which of its pixels are traced.
    pub grid: Grid,
    /// How the pixels are sampled.
    pub sampling: Sampling,
    /// The messages that its pixels get from adjacent ones.
    pub messages: BandMessages<'a>,
    /// Retraces doubtful samples in double precision, if they are retraced.
    pub retracer: Option<&'a dyn Retracer>,
    /// Scratch memory shared with other bands of the plan.
    pub workspace_pool: &'a WorkspacePool,
    /// Says when to stop, and counts pixels.
    pub control: &'a RenderControl,
}

/// Scratch memory of a band.
struct BandScratch<L: SimdFloat> {
    work: Workspace<L>,
    sampler: Sampler<L>,
    colors: TileColors<L::Real>,
    in_band: Candidates,
    in_tile: Candidates,
}

impl<L: SimdFloat> BandScratch<L> {
    fn new(in_squares: bool) -> Self {
        Self {
            work: Workspace::default(),
            sampler: Sampler::new(in_squares),
            colors: TileColors::default(),
            in_band: Candidates::default(),
            in_tile: Candidates::default(),
        }
    }
}

impl<R: SimdReal> WithSimd<R> for Band<'_, R> {
    type Output = Option<Rays>;

    #[inline(always)]
    fn run<L: SimdFloat<Real = R>>(self, token: L::Token) -> Option<Rays> {
        let is_simple = self.plan.geometry.is_none() && !self.plan.is_doubted();
        if L::HAS_SIMPLE_KERNELS && is_simple {
            self.trace::<L, false>(token)
        } else {
            self.trace::<L, true>(token)
        }
    }
}

impl<R: SimdReal> Band<'_, R> {
    #[inline(always)]
    fn trace<L: SimdFloat<Real = R>, const TREE: bool>(mut self, token: L::Token) -> Option<Rays> {
        if !self.place.is_in(self.region) {
            return Some(Rays::default());
        }
        let (plan, control) = (self.plan, self.control);
        let reused = self.workspace_pool.take::<BandScratch<L>>();
        let mut scratch = reused.unwrap_or_else(|| Box::new(BandScratch::new(self.in_squares)));
        let BandScratch {
            work,
            sampler,
            colors,
            in_band,
            in_tile,
        } = &mut *scratch;
        let kernel = Kernel { token, plan };
        let mut engine = Engine::<L, TREE>::new(kernel, work, control, self.retracer);
        in_band.keep_seen(self.candidates, plan, &self.place.rows, |seen| seen.rows);
        for left in self.place.columns.clone().step_by(self.tile) {
            let tile = Tile {
                columns: left..(left + self.tile).min(self.place.columns.end),
                rows: self.place.rows.clone(),
            };
            if !tile.is_in(self.region) {
                continue;
            }
            let before = engine.rays.total();
            in_tile.keep_seen(in_band, plan, &tile.columns, |seen| seen.columns);
            if plan.screen.is_some() {
                in_tile.drop_unseen_planes(self.plan, &tile);
            }
            let (stride, channels) = match self.sampling {
                Sampling::Centres if self.grid == Grid::ALL => {
                    let traced = sampler.one_per_pixel(&mut engine, in_tile, &tile, (0.5, 0.5));
                    (tile.width(), traced.channels())
                }
                Sampling::Centres => {
                    let traced = sampler.centres(&mut engine, in_tile, self.grid.pixels(&tile));
                    (1, traced.channels())
                }
                Sampling::Grid(side) => {
                    sampler.grid(&mut engine, in_tile, &tile, side, colors);
                    (colors.stride, colors.channels())
                }
                Sampling::Adaptive { contrast, depth } => {
                    let limits = Limits::new(contrast, depth);
                    let BandMessages {
                        messages,
                        only_pixels,
                    } = self.messages;
                    if let Some(only_pixels) = only_pixels {
                        let edge_context = (limits, messages, only_pixels);
                        sampler.notified_pixels(&mut engine, in_tile, &tile, edge_context, colors);
                        if engine.is_stopped() {
                            return None;
                        }
                        self.write_pixels(&tile, sampler.notified(), colors);
                        continue;
                    }
                    let edge_context = (limits, messages);
                    sampler.adaptive(&mut engine, in_tile, &tile, edge_context, colors);
                    (colors.stride, colors.channels())
                }
            };
            if engine.is_stopped() {
                return None;
            }
            let traced = if self.grid == Grid::ALL {
                self.canvas.fill(&tile, stride, channels);
                tile.width() * tile.rows.len()
            } else {
                self.canvas.scatter(&tile, self.grid, channels);
                self.grid.pixels(&tile).count()
            };
            control.pixels.fetch_add(traced as u64, Ordering::Relaxed);
            if plan.show == Show::Cost {
                self.fill_with_heat(&tile, engine.rays.total() - before);
            }
        }
        let rays = engine.rays;
        self.workspace_pool.put(scratch);
        Some(rays)
    }

    /// Fills a tile with the colour for the mean number of rays that its pixels took.
    fn fill_with_heat(&mut self, tile: &Tile, rays: u64) {
        let count = self.grid.pixels(tile).count().max(1);
        let color = heat::<R>(rays as f64 / count as f64);
        for (column, row) in self.grid.pixels(tile) {
            self.canvas.set(column, row, color);
        }
    }

    /// Overwrites some pixels of a tile, given by row and column in the tile.
    fn write_pixels(&mut self, tile: &Tile, pixels: &[[usize; 2]], colors: &TileColors<R>) {
        for &[row, column] in pixels {
            let index = row * colors.stride + column;
            let color = colors.channels().map(|channel| channel[index]);
            let (column, row) = (tile.columns.start + column, tile.rows.start + row);
            self.canvas.set(column, row, color);
        }
    }
}
