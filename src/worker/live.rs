//! Tracing of a live picture: coarse first, finer while there is time, smooth edges last, as a job of their own that
//! waits for questions: a drag begins with one.

use std::time::Instant;

use super::budget::Budget;
use super::frame_pool::FramePool;
use super::jobs::{Frame, LiveJob, Pace};
use super::shared::Shared;
use crate::image::{Image, RenderCost};
use crate::scene::Sampling;
use crate::trace::{Grid, Pass, Rays, RenderControl, Tracer};

/// A live picture being traced: first a coarse pass that always completes, so that there is always something new to
/// show; then finer ones until a newer job arrives; smooth edges last.
pub struct Live<'a> {
    /// Receives the finished passes.
    pub shared: &'a Shared,
    /// The request.
    pub job: &'a LiveJob,
    /// The tracer, planned for the request.
    pub tracer: Tracer,
    /// Provides the memory of earlier pictures.
    pub frame_pool: &'a mut FramePool,
}

impl Live<'_> {
    /// Traces the centre of every pixel once, in passes from coarse to fine; `None` if it was stopped.
    pub fn trace_centres(
        &mut self,
        control: &RenderControl,
        budget: &mut Budget,
        start: Instant,
    ) -> Option<()> {
        let mut image = self.canvas();
        // Planning does not count towards the cost of a pixel.
        let traced_from = Instant::now();
        let first = match self.job.pace {
            Pace::Within(time) => budget.choose(image.width, image.height, time),
            Pace::Whole => 1,
        };
        let mut rays = Rays::default();
        let mut grid = Grid {
            step: first,
            coarser: None,
        };
        loop {
            let is_first = grid.step == first;
            let control = if is_first {
                &self.shared.until_quit
            } else {
                control
            };
            let new = image.trace(&self.tracer, Pass::Centres(grid), control)?;
            rays += new;
            if is_first {
                budget.learn(new.camera, traced_from.elapsed());
            }
            if grid.step == 1 {
                break;
            }
            let thin = image.decimated(grid.step);
            self.publish(thin, grid.step, rays, Sampling::Centres, start);
            grid = Grid {
                step: grid.step / 2,
                coarser: Some(grid.step),
            };
        }
        self.publish(image, 1, rays, Sampling::Centres, start);
        Some(())
    }

    /// Traces the picture with smooth edges; `None` if it was stopped.
    pub fn smooth(&mut self, control: &RenderControl, start: Instant) -> Option<()> {
        let mut image = self.canvas();
        let rays = image.trace(&self.tracer, Pass::Whole, control)?;
        self.publish(image, 1, rays, self.job.request.sampling, start);
        Some(())
    }

    fn canvas(&mut self) -> Image {
        self.frame_pool
            .canvas(self.tracer.width(), self.tracer.height())
    }

    fn publish(
        &mut self,
        image: Image,
        step: usize,
        rays: Rays,
        sampling: Sampling,
        start: Instant,
    ) {
        let time = start.elapsed();
        self.shared.publish(Frame {
            revision: self.job.revision,
            image: self.frame_pool.hand_out(image),
            full_size: (self.tracer.width(), self.tracer.height()),
            step,
            sampling,
            is_still: false,
            region: None,
            cost: RenderCost {
                time,
                rays,
                lanes: self.tracer.lanes(),
            },
        });
    }
}
