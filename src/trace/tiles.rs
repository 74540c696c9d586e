//! The tile loop: which pixels are traced, by which thread, and when to stop.

use std::sync::atomic::Ordering;

use rayon::iter::{IndexedParallelIterator as _, ParallelIterator as _};
use rayon::slice::ParallelSliceMut as _;

use super::shade::camera_color;
use super::{Ray, Rays, Watch};
use crate::lanes::{Real, Vec3};
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
        Self {
            width: picture.width as usize,
            height: picture.height as usize,
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

    /// The real type and how many of it are computed in step, for example `f32×1`.
    pub fn lanes(&self) -> &'static str {
        match self.kernel {
            Kernel::Single(_) => f32::NAME,
            Kernel::Double(_) => f64::NAME,
        }
    }

    /// Traces the pixels of `grid` into `pixels` (row by row from the top, `width × height`),
    /// on the threads of the current rayon pool. `store` turns linear colour (0–1) into a pixel.
    ///
    /// The colours do not depend on the number of threads or on what was traced before.
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

    fn pass_of<R: Real, P: Send>(
        &self,
        plan: &Plan<R>,
        pixels: &mut [P],
        grid: Grid,
        watch: &Watch,
        store: impl Fn([f64; 3]) -> P + Sync,
    ) -> Option<Rays> {
        let bands = pixels
            .par_chunks_mut(self.width * TILE)
            .with_max_len(1)
            .enumerate();
        bands
            .map(|(index, rows)| {
                let mut rays = Rays::default();
                for left in (0..self.width).step_by(TILE) {
                    let columns = left..(left + TILE).min(self.width);
                    self.tile(
                        plan,
                        rows,
                        index * TILE,
                        columns,
                        grid,
                        watch,
                        &store,
                        &mut rays,
                    )?;
                }
                Some(rays)
            })
            .try_reduce(Rays::default, |a, b| Some(a + b))
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "one call site, in the loop above"
    )]
    fn tile<R: Real, P>(
        &self,
        plan: &Plan<R>,
        rows: &mut [P],
        top: usize,
        columns: std::ops::Range<usize>,
        grid: Grid,
        watch: &Watch,
        store: &impl Fn([f64; 3]) -> P,
        rays: &mut Rays,
    ) -> Option<()> {
        for (row, line) in rows.chunks_mut(self.width).enumerate() {
            let y = top + row;
            if !y.is_multiple_of(grid.step) {
                continue;
            }
            if watch.stop.load(Ordering::Relaxed) {
                return None;
            }
            let before = rays.camera;
            for x in grid.row_pixels(y, columns.start, columns.end) {
                line[x] = store(pixel_color(plan, x, y, rays).to_f64().to_array());
            }
            watch
                .pixels
                .fetch_add(rays.camera - before, Ordering::Relaxed);
        }
        Some(())
    }
}

/// Colour at the centre of a pixel.
fn pixel_color<R: Real>(plan: &Plan<R>, x: usize, y: usize, rays: &mut Rays) -> Vec3<R> {
    let centre = |index: usize| R::from_f64(index as f64 + 0.5);
    let (origin, direction) = plan.view.ray(centre(x), centre(y));
    camera_color(plan, Ray { origin, direction }, rays)
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
