//! The tile loop: which pixels are traced, by which thread, and when to stop.

use std::ops::Range;
use std::sync::atomic::Ordering;

use rayon::iter::{IndexedParallelIterator as _, ParallelIterator as _};
use rayon::slice::ParallelSliceMut as _;

use super::cull::{Axis, Bounds, Casters};
use super::hit::{Nearest, Paths, nearest};
use super::shade::{Surroundings, colors};
use super::{Ray, Rays, Watch};
use crate::lanes::{Lane, Level, Real as _, Vectored, Work};
use crate::plan::{Picture, Plan, Precision, needs_double};
use crate::scene::Scene;

/// Side of a tile in pixels. Small enough that the primitives of a tile stay in the cache and that
/// threads end together, large enough that the bookkeeping does not show.
pub const TILE: usize = 16;

/// The pixels of one pass over a picture: those whose x and y are multiples of `step`, without
/// those of the coarser pass before. Passes with steps 8, 4, 2, 1 trace every pixel exactly once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Distance of neighbours in pixels, ≥ 1.
    pub step: usize,
    /// Step of the pass before, a multiple of `step`.
    pub coarser: Option<usize>,
}

impl Grid {
    /// Every pixel.
    pub const ALL: Self = Self {
        step: 1,
        coarser: None,
    };

    fn row_pixels(self, row: usize, from: usize, to: usize) -> impl Iterator<Item = usize> {
        let Self { step, coarser } = self;
        let first = from.next_multiple_of(step);
        let coarser_row = coarser.filter(|&coarser| row.is_multiple_of(coarser));
        let wanted = move |&x: &usize| coarser_row.is_none_or(|coarser| !x.is_multiple_of(coarser));
        (first..to).step_by(step).filter(wanted)
    }
}

/// A picture of a scene, planned for the real type it needs.
#[derive(Debug)]
pub struct Tracer {
    width: usize,
    height: usize,
    level: Level,
    kernel: Kernel,
}

#[derive(Debug)]
enum Kernel {
    Single(Box<Plan<f32>>),
    Double(Box<Plan<f64>>),
}

impl Tracer {
    /// Plans `picture` of `scene`, which must pass [`crate::scene::check`].
    pub fn new(scene: &Scene, picture: &Picture) -> Self {
        let double = match picture.precision {
            Precision::Auto => needs_double(scene),
            Precision::Single => false,
            Precision::Double => true,
        };
        let kernel = if double {
            Kernel::Double(Box::new(Plan::new(scene, picture)))
        } else {
            Kernel::Single(Box::new(Plan::new(scene, picture)))
        };
        let (width, height) = (picture.width as usize, picture.height as usize);
        let level = picture.level.unwrap_or_else(Level::widest);
        Self {
            width,
            height,
            level,
            kernel,
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

    /// The real type and how many of it are computed in step, for example `f32×16`.
    pub fn lanes(&self) -> String {
        match self.kernel {
            Kernel::Single(_) => self.level.lanes_of::<f32>(),
            Kernel::Double(_) => self.level.lanes_of::<f64>(),
        }
    }

    /// Traces the pixels of `grid` into `pixels` (row by row from the top, `width × height`),
    /// on the threads of the current rayon pool. `store` turns linear colour (0–1) into a pixel.
    ///
    /// The colours do not depend on the number of threads or lanes, or on what was traced before.
    /// `None` if `watch` said stop; some pixels are then still the old ones.
    pub fn pass<P: Send>(
        &self,
        pixels: &mut [P],
        grid: Grid,
        watch: &Watch,
        store: impl Fn([f64; 3]) -> P + Sync,
    ) -> Option<Rays> {
        match &self.kernel {
            Kernel::Single(plan) => self.pass_of(plan, pixels, grid, watch, store),
            Kernel::Double(plan) => self.pass_of(plan, pixels, grid, watch, store),
        }
    }

    fn pass_of<R: Vectored, P: Send>(
        &self,
        plan: &Plan<R>,
        pixels: &mut [P],
        grid: Grid,
        watch: &Watch,
        store: impl Fn([f64; 3]) -> P + Sync,
    ) -> Option<Rays> {
        let seen = Casters::all_seen(plan);
        let casting = Casters::all(plan);
        let bands = pixels
            .par_chunks_mut(self.width * TILE)
            .with_max_len(1)
            .enumerate();
        bands
            .map(|(index, rows)| {
                let band = Band {
                    plan,
                    seen: &seen,
                    casting: &casting,
                    width: self.width,
                    top: index * TILE,
                    rows,
                    grid,
                    watch,
                    store: &store,
                };
                self.level.run(band)
            })
            .try_reduce(Rays::default, |a, b| Some(a + b))
    }
}

/// A row of tiles.
struct Band<'a, R, P, F> {
    plan: &'a Plan<R>,
    /// Everything that can be seen.
    seen: &'a Casters,
    /// Everything that casts shadows.
    casting: &'a Casters,
    width: usize,
    top: usize,
    rows: &'a mut [P],
    grid: Grid,
    watch: &'a Watch,
    store: &'a F,
}

/// Rays of pixels that are traced in step, and what they meet first.
#[derive(Clone, Copy)]
struct Packet<L: Lane> {
    path: Ray<L>,
    near: Nearest<L>,
    active: L::Mask,
    /// Place of its first pixel in the tile's list, and how many there are.
    first: usize,
    count: usize,
}

/// What tiles leave behind for the next one to use again.
struct Scratch<L: Lane> {
    in_band: Casters,
    in_tile: Casters,
    by_light: Vec<Casters>,
    /// Column, and row in the band, of each pixel of the tile.
    pixels: Vec<(usize, usize)>,
    /// Centres of the pixels, and some more to fill the last packet.
    x: Vec<L::Real>,
    y: Vec<L::Real>,
    packets: Vec<Packet<L>>,
    /// Red, green and blue of a packet.
    colors: [Vec<L::Real>; 3],
}

impl<L: Lane> Scratch<L> {
    fn new(lights: usize) -> Self {
        let room = TILE * TILE + L::WIDTH;
        let black = || vec![L::Real::ZERO; L::WIDTH];
        Self {
            in_band: Casters::default(),
            in_tile: Casters::default(),
            by_light: vec![Casters::default(); lights],
            pixels: Vec::with_capacity(TILE * TILE),
            x: Vec::with_capacity(room),
            y: Vec::with_capacity(room),
            packets: Vec::with_capacity(room / L::WIDTH),
            colors: [black(), black(), black()],
        }
    }

    /// Lists the pixels of a tile that a pass takes.
    fn list(&mut self, grid: Grid, top: usize, height: usize, columns: &Range<usize>) {
        self.pixels.clear();
        self.x.clear();
        self.y.clear();
        let centre = |index: usize| L::Real::from_f64(index as f64 + 0.5);
        for row in (0..height).filter(|row| (top + row).is_multiple_of(grid.step)) {
            for column in grid.row_pixels(top + row, columns.start, columns.end) {
                self.pixels.push((column, row));
                self.x.push(centre(column));
                self.y.push(centre(top + row));
            }
        }
        if let (Some(&x), Some(&y)) = (self.x.last(), self.y.last()) {
            let full = self.pixels.len().next_multiple_of(L::WIDTH);
            self.x.resize(full, x);
            self.y.resize(full, y);
        }
    }
}

impl<R: Vectored, P, F: Fn([f64; 3]) -> P> Work<R> for Band<'_, R, P, F> {
    type Output = Option<Rays>;

    #[inline(always)]
    fn run<L: Lane<Real = R>>(mut self, token: L::Token) -> Option<Rays> {
        let height = self.rows.len() / self.width.max(1);
        let mut scratch = Scratch::<L>::new(self.plan.lights.len());
        let rows = self.top..self.top + height;
        scratch
            .in_band
            .keep_seen(self.seen, self.plan.screen.as_ref(), &rows, Axis::Rows);
        let mut rays = Rays::default();
        for left in (0..self.width).step_by(TILE) {
            let columns = left..(left + TILE).min(self.width);
            self.tile(token, &mut scratch, &columns, height, &mut rays)?;
        }
        Some(rays)
    }
}

impl<R: Vectored, P, F: Fn([f64; 3]) -> P> Band<'_, R, P, F> {
    /// First what every ray meets, then, knowing where that is, the light that falls on it.
    #[inline(always)]
    fn tile<L: Lane<Real = R>>(
        &mut self,
        token: L::Token,
        scratch: &mut Scratch<L>,
        columns: &Range<usize>,
        height: usize,
        rays: &mut Rays,
    ) -> Option<()> {
        scratch.list(self.grid, self.top, height, columns);
        let Scratch {
            in_band,
            in_tile,
            by_light,
            pixels,
            x,
            y,
            packets,
            colors,
        } = scratch;
        in_tile.keep_seen(in_band, self.plan.screen.as_ref(), columns, Axis::Columns);
        packets.clear();
        let mut bounds = Bounds::new(token);
        for first in (0..pixels.len()).step_by(L::WIDTH) {
            let centres = (L::load(token, &x[first..]), L::load(token, &y[first..]));
            let count = (pixels.len() - first).min(L::WIDTH);
            packets.push(self.meet(token, centres, first, count, in_tile, &mut bounds));
        }
        // Where nothing may be left out, or nothing was hit, everything serves for every light.
        let ball = bounds.ball().filter(|_| self.plan.screen.is_some());
        let casters = match &ball {
            None => &[],
            Some(ball) => {
                for (casters, light) in by_light.iter_mut().zip(&self.plan.lights) {
                    casters.keep_between(self.casting, self.plan, light.position, ball);
                }
                &by_light[..]
            }
        };
        let around = Surroundings {
            plan: self.plan,
            casters,
            everything: self.casting,
            all: self.seen.among(),
        };
        for packet in packets.iter() {
            if self.watch.stop.load(Ordering::Relaxed) {
                return None;
            }
            self.paint(token, around, packet, pixels, colors, rays);
        }
        self.watch
            .pixels
            .fetch_add(pixels.len() as u64, Ordering::Relaxed);
        rays.camera += pixels.len() as u64;
        Some(())
    }

    /// What the rays through these centres meet first. Lanes behind the first `count` have no pixel.
    #[inline(always)]
    fn meet<L: Lane<Real = R>>(
        &self,
        token: L::Token,
        (x, y): (L, L),
        first: usize,
        count: usize,
        in_tile: &Casters,
        bounds: &mut Bounds<L>,
    ) -> Packet<L> {
        let (origin, direction) = self.plan.view.rays(token, x, y);
        let path = Ray { origin, direction };
        let paths = Paths {
            rays: path,
            start: None,
        };
        let near = nearest(token, self.plan, in_tile.among(), &paths);
        let infinity = L::splat(token, R::INFINITY);
        bounds.add(near.t.less(infinity), path.at(near.t));
        let lane_number = L::from_fn(token, |lane| R::from_f64(lane as f64));
        let active = lane_number.less(L::splat(token, R::from_f64(count as f64)));
        Packet {
            path,
            near,
            active,
            first,
            count,
        }
    }

    #[inline(always)]
    fn paint<L: Lane<Real = R>>(
        &mut self,
        token: L::Token,
        around: Surroundings<R>,
        packet: &Packet<L>,
        pixels: &[(usize, usize)],
        [red, green, blue]: &mut [Vec<R>; 3],
        rays: &mut Rays,
    ) {
        let Packet {
            path,
            near,
            active,
            first,
            count,
        } = packet;
        let color = colors(token, around, path, *near, *active, 0, rays);
        color.x.store(red);
        color.y.store(green);
        color.z.store(blue);
        for (lane, &(column, row)) in pixels[*first..first + count].iter().enumerate() {
            let color = [
                red[lane].to_f64(),
                green[lane].to_f64(),
                blue[lane].to_f64(),
            ];
            self.rows[row * self.width + column] = (self.store)(color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn nested_passes_take_every_pixel_once(width in 1..70_usize, height in 1..40_usize, levels in 0..5_u32) {
            let mut taken = vec![0_u32; width * height];
            let mut coarser = None;
            for level in (0..=levels).rev() {
                let grid = Grid { step: 1 << level, coarser };
                for y in (0..height).filter(|y| y % grid.step == 0) {
                    for left in (0..width).step_by(TILE) {
                        for x in grid.row_pixels(y, left, (left + TILE).min(width)) {
                            taken[y * width + x] += 1;
                        }
                    }
                }
                coarser = Some(grid.step);
            }
            prop_assert!(taken.iter().all(|&count| count == 1));
        }
    }
}
