//! The tile loop: which pixels are traced, by which thread, and when to stop.

use std::ops::Range;
use std::sync::atomic::Ordering;

use rayon::iter::{IndexedParallelIterator as _, ParallelIterator as _};
use rayon::slice::ParallelSliceMut as _;

use super::candidates::{Candidates, Span};
use super::engine::Engine;
use super::heat::heat;
use super::intersect::Kernel;
use super::lattice::Limits;
use super::sampler::Sampler;
use super::stats::{Rays, RenderControl};
use super::tile::{Grid, Pass, Pixel, Tile, TileColors};
use crate::plan::{Plan, Planner, Region, RenderRequest, Show, is_double};
use crate::scene::{Aspect, Sampling, Scene};
use crate::simd::{Level, SimdFloat, SimdReal, WithSimd};

/// Side of a tile in pixels where there is little to see. Large enough that the bookkeeping does not
/// show, small enough that the rays of a tile stay in the cache and that threads end together.
const LARGE_TILE: usize = 32;
/// Side of a tile where there is much to see: it sees less of it.
const SMALL_TILE: usize = 16;
/// Side of a tile where the rays of each are shown.
const COST_TILE: usize = 8;
/// With fewer pixels than this for each bounded primitive, there is much to see.
const PIXELS_PER_PRIMITIVE: u64 = 16_384;

/// With fewer pixels than this for each, packets look at squares: what is seen in a row of sixteen pixels is
/// more than in a square of them, but to put them in order costs time too.
const PIXELS_IN_SQUARES: u64 = 128;

/// A picture of a scene, planned for the real type it needs.
#[derive(Debug)]
pub struct Tracer {
    width: usize,
    height: usize,
    /// Side of a tile.
    tile: usize,
    in_squares: bool,
    /// The part that is traced.
    region: Option<Region>,
    sampling: Sampling,
    level: Level,
    plan: PlanOf,
}

#[derive(Debug)]
enum PlanOf {
    Single(Box<Plan<f32>>),
    Double(Box<Plan<f64>>),
}

impl PlanOf {
    /// How many primitives have an end.
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

    /// The same after other pictures: what they need as well is not made again.
    pub fn planned(scene: &Scene, request: &RenderRequest, planner: &mut Planner) -> Self {
        let plan = if is_double(scene, request) {
            PlanOf::Double(Box::new(Plan::new(scene, request, &mut planner.double)))
        } else {
            PlanOf::Single(Box::new(Plan::new(scene, request, &mut planner.single)))
        };
        let pixels = request.pixels();
        let is_sparse = plan.bounded() * PIXELS_PER_PRIMITIVE <= pixels;
        Self {
            width: request.width as usize,
            height: request.height as usize,
            tile: match request.aspect {
                Aspect::Cost => COST_TILE,
                _ if is_sparse => LARGE_TILE,
                _ => SMALL_TILE,
            },
            in_squares: plan.bounded() * PIXELS_IN_SQUARES > pixels,
            region: request.region,
            sampling: request.sampling,
            level: request.level.unwrap_or_else(Level::widest),
            plan,
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

    /// The real type and how many of it are computed in step, for example `f32×16 avx2`.
    pub fn lanes(&self) -> String {
        match self.plan {
            PlanOf::Single(_) => self.level.lanes_of::<f32>(),
            PlanOf::Double(_) => self.level.lanes_of::<f64>(),
        }
    }

    /// Traces the pixels of `pass` into `pixels` (row by row from the top, `width × height`),
    /// on the threads of the current rayon pool.
    ///
    /// The colours do not depend on the number of threads or lanes, or on what was traced before.
    /// `None` if `control` said stop; some pixels are then still the old ones.
    pub fn pass<P: Pixel>(
        &self,
        pixels: &mut [P],
        pass: Pass,
        control: &RenderControl,
    ) -> Option<Rays> {
        self.trace_rows(pixels, 0, pass, control)
    }

    /// Traces whole rows of the picture, from `first` on, into `pixels`; see [`Self::pass`].
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
            PlanOf::Single(plan) => self.pass_of(plan, pixels, first, pass, control),
            PlanOf::Double(plan) => self.pass_of(plan, pixels, first, pass, control),
        }
    }

    fn pass_of<R: SimdReal, P: Pixel>(
        &self,
        plan: &Plan<R>,
        pixels: &mut [P],
        first: usize,
        pass: Pass,
        control: &RenderControl,
    ) -> Option<Rays> {
        let seen = Candidates::all_seen(plan);
        let (grid, sampling) = match pass {
            Pass::Whole => (Grid::ALL, self.sampling),
            Pass::Centres(grid) => (grid, Sampling::Centres),
        };
        let bands = pixels
            .par_chunks_mut(self.width * self.tile)
            .with_max_len(1)
            .enumerate();
        bands
            .map(|(index, pixels)| {
                let top = first + index * self.tile;
                let band = Band {
                    plan,
                    seen: &seen,
                    width: self.width,
                    tile: self.tile,
                    in_squares: self.in_squares,
                    region: self.region,
                    rows: top..top + pixels.len() / self.width,
                    pixels,
                    grid,
                    sampling,
                    control,
                };
                self.level.run(band)
            })
            .try_reduce(Rays::default, |a, b| Some(a + b))
    }
}

/// A row of tiles.
struct Band<'a, R, P> {
    plan: &'a Plan<R>,
    /// Everything that can be seen.
    seen: &'a Candidates,
    width: usize,
    tile: usize,
    in_squares: bool,
    region: Option<Region>,
    rows: Range<usize>,
    pixels: &'a mut [P],
    grid: Grid,
    sampling: Sampling,
    control: &'a RenderControl,
}

impl<R: SimdReal, P: Pixel> WithSimd<R> for Band<'_, R, P> {
    type Output = Option<Rays>;

    #[inline(always)]
    fn run<L: SimdFloat<Real = R>>(self, token: L::Token) -> Option<Rays> {
        if self.plan.geometry.is_some() {
            self.trace::<L, true>(token)
        } else {
            self.trace::<L, false>(token)
        }
    }
}

impl<R: SimdReal, P: Pixel> Band<'_, R, P> {
    #[inline(always)]
    fn trace<L: SimdFloat<Real = R>, const TREE: bool>(mut self, token: L::Token) -> Option<Rays> {
        let plan = self.plan;
        let mut engine = Engine::<L, TREE>::new(Kernel { token, plan }, &self.control.stop);
        let mut sampler = Sampler::new(self.in_squares);
        let mut colors = TileColors::default();
        let (mut in_band, mut in_tile) = (Candidates::default(), Candidates::default());
        let band = Tile {
            columns: 0..self.width,
            rows: self.rows.clone(),
        };
        if !band.is_in(self.region) {
            return Some(Rays::default());
        }
        in_band.keep_seen(self.seen, plan, &self.rows, Span::Rows);
        for left in (0..self.width).step_by(self.tile) {
            let tile = Tile {
                columns: left..(left + self.tile).min(self.width),
                rows: self.rows.clone(),
            };
            if !tile.is_in(self.region) {
                continue;
            }
            let before = engine.rays.total();
            in_tile.keep_seen(&in_band, plan, &tile.columns, Span::Columns);
            if plan.screen.is_some() {
                in_tile.drop_unseen_planes(self.plan, &tile);
            }
            let (stride, channels) = match self.sampling {
                Sampling::Centres if self.grid == Grid::ALL => {
                    let traced = sampler.all(&mut engine, &in_tile, &tile, (0.5, 0.5));
                    (tile.width(), traced.channels())
                }
                Sampling::Centres => {
                    let traced = sampler.centres(&mut engine, &in_tile, self.grid.pixels(&tile));
                    (1, traced.channels())
                }
                Sampling::Grid(side) => {
                    sampler.grid(&mut engine, &in_tile, &tile, side, &mut colors);
                    (colors.stride, colors.channels())
                }
                Sampling::Adaptive { contrast, depth } => {
                    let limits = Limits::new(contrast, depth);
                    sampler.adaptive(&mut engine, &in_tile, &tile, limits, &mut colors);
                    (colors.stride, colors.channels())
                }
            };
            if engine.is_stopped() {
                return None;
            }
            if self.grid == Grid::ALL {
                self.fill(&tile, stride, channels);
            } else {
                self.scatter(&tile, channels);
            }
            if plan.show == Show::Cost {
                self.fill_with_heat(&tile, engine.rays.total() - before);
            }
        }
        Some(engine.rays)
    }

    /// Writes how many rays each pixel of a tile took.
    fn fill_with_heat(&mut self, tile: &Tile, rays: u64) {
        let count = self.grid.pixels(tile).count().max(1);
        let [red, green, blue] = heat::<R>(rays as f64 / count as f64);
        for (column, row) in self.grid.pixels(tile) {
            self.pixels[(row - self.rows.start) * self.width + column] = P::of(red, green, blue);
        }
    }

    /// Writes the colours of a whole tile, `stride` apart from row to row.
    #[inline(always)]
    fn fill(&mut self, tile: &Tile, stride: usize, [red, green, blue]: [&[R]; 3]) {
        let width = tile.columns.len();
        for row in 0..tile.rows.len() {
            let from = row * self.width + tile.columns.start;
            let pixels = &mut self.pixels[from..from + width];
            let part = row * stride..row * stride + width;
            let channels = red[part.clone()]
                .iter()
                .zip(&green[part.clone()])
                .zip(&blue[part]);
            for (pixel, ((&red, &green), &blue)) in pixels.iter_mut().zip(channels) {
                *pixel = P::of(red, green, blue);
            }
        }
        self.control
            .pixels
            .fetch_add((width * tile.rows.len()) as u64, Ordering::Relaxed);
    }

    /// Writes the colours of those pixels of a tile that the pass takes.
    #[inline(always)]
    fn scatter(&mut self, tile: &Tile, [red, green, blue]: [&[R]; 3]) {
        let mut count = 0;
        for (index, (column, row)) in self.grid.pixels(tile).enumerate() {
            let pixel = P::of(red[index], green[index], blue[index]);
            self.pixels[(row - self.rows.start) * self.width + column] = pixel;
            count += 1;
        }
        self.control.pixels.fetch_add(count, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, AtomicU64};

    use super::*;
    use crate::scene::Accelerator;
    use crate::simd::Real;
    use crate::trace::Threads;

    impl Pixel for [u64; 3] {
        fn of<R: Real>(red: R, green: R, blue: R) -> Self {
            [red, green, blue].map(|channel| channel.to_f64().to_bits())
        }
    }

    #[test]
    fn tiles_of_any_size_give_the_same_bits() {
        let mut scene = Scene::demo();
        scene.render.reflection_limit = 3;
        for sampling in [Sampling::Centres, Sampling::Grid(2), Sampling::ADAPTIVE] {
            let pictures = [16, 8, 5, 32, 200].map(|tile| {
                let request = RenderRequest {
                    sampling,
                    ..RenderRequest::sized(171, 93)
                };
                let tracer = Tracer {
                    tile,
                    ..Tracer::new(&scene, &request)
                };
                let mut pixels = vec![[0_u64; 3]; 171 * 93];
                let rays = tracer.pass(&mut pixels, Pass::Whole, &RenderControl::default());
                assert!(rays.is_some());
                pixels
            });
            for other in &pictures[1..] {
                assert!(*other == pictures[0], "{sampling:?}");
            }
        }
    }

    #[test]
    fn packets_in_squares_give_the_same_bits() {
        let scene = Scene::demo();
        for (sampling, tile) in [(Sampling::Centres, 16), (Sampling::Grid(2), 13)] {
            let pictures = [false, true].map(|in_squares| {
                let request = RenderRequest {
                    sampling,
                    accelerator: Accelerator::Bvh,
                    ..RenderRequest::sized(83, 61)
                };
                let tracer = Tracer {
                    tile,
                    in_squares,
                    ..Tracer::new(&scene, &request)
                };
                let mut pixels = vec![[0_u64; 3]; 83 * 61];
                let rays = tracer.pass(&mut pixels, Pass::Whole, &RenderControl::default());
                (pixels, rays)
            });
            assert!(pictures[0] == pictures[1], "{sampling:?}");
        }
    }

    #[test]
    fn a_picture_in_pieces_has_the_same_bits() {
        let scene = Scene::demo();
        for sampling in [Sampling::Grid(2), Sampling::ADAPTIVE] {
            let request = RenderRequest {
                sampling,
                ..RenderRequest::sized(83, 61)
            };
            let (tracer, control) = (Tracer::new(&scene, &request), RenderControl::default());
            let mut whole = vec![[0_u64; 3]; 83 * 61];
            let rays = tracer.pass(&mut whole, Pass::Whole, &control);
            let mut pieces = Vec::new();
            let mut sum = Rays::default();
            for first in (0..61).step_by(7) {
                let mut piece = vec![[0_u64; 3]; 83 * (61 - first).min(7)];
                sum += tracer
                    .rows(&mut piece, first, &control)
                    .expect("not stopped");
                pieces.extend(piece);
            }
            assert!(pieces == whole, "{sampling:?}");
            if sampling == Sampling::Grid(2) {
                assert_eq!(Some(sum), rays);
            }
        }
    }

    /// Told to stop by the first pixel that is written.
    static FIRST: RenderControl = RenderControl {
        stop: AtomicBool::new(false),
        pixels: AtomicU64::new(0),
    };

    #[derive(Clone, Copy)]
    struct Stopping;

    impl Pixel for Stopping {
        fn of<R: Real>(_: R, _: R, _: R) -> Self {
            FIRST.stop.store(true, Ordering::Relaxed);
            Self
        }
    }

    #[test]
    fn a_stopped_pass_writes_no_tile_that_was_being_traced() {
        let (scene, side) = (Scene::demo(), 2048);
        let tracer = Tracer::new(&scene, &RenderRequest::sized(side, side));
        let mut pixels = vec![Stopping; (side * side) as usize];
        let threads = Threads::new(Some(3)).expect("threads");
        let rays = threads.run(|| tracer.pass(&mut pixels, Pass::Whole, &FIRST));
        assert_eq!(rays, None);
        let traced = FIRST.pixels.load(Ordering::Relaxed);
        // The tile that told to stop, and those that the other threads were writing meanwhile.
        let most = (3 * tracer.tile * tracer.tile) as u64;
        assert!(
            traced <= most,
            "{traced} pixels after the stop, {most} at most"
        );
    }
}
