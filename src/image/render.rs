//! Pictures that are traced as a whole.

use std::time::Duration;

use super::buffer::{Image, LinearImage, Raster};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::{Pass, Pixel, Rays, RenderControl, Tracer};

/// The cost of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderCost {
    /// Wall time, including planning but not pauses.
    pub time: Duration,
    /// Rays traced.
    pub rays: Rays,
    /// The kernel's real type and width, see [`Tracer::lanes`].
    pub lanes: String,
}

/// Traces a whole picture on the current rayon pool. `None` if `control` was stopped.
pub fn render(
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<(Image, RenderCost)> {
    let mut image = Image::new(request.width as usize, request.height as usize);
    let cost = render_into(&mut image, &mut Planner::default(), scene, request, control)?;
    Some((image, cost))
}

/// Like [`render`], but reuses the memory of an older picture, and what `planner` has prepared.
pub fn render_into(
    image: &mut Image,
    planner: &mut Planner,
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<RenderCost> {
    render_pixels(image, planner, scene, request, control)
}

/// Like [`render_into`], for linear light.
pub fn render_light_into(
    image: &mut LinearImage,
    planner: &mut Planner,
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<RenderCost> {
    render_pixels(image, planner, scene, request, control)
}

// Not public, so that the tracer's kernels are compiled once here and not by every caller.
fn render_pixels<P: Pixel + Copy + Default>(
    image: &mut Raster<P>,
    planner: &mut Planner,
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<RenderCost> {
    let watch = control.stopwatch();
    let tracer = Tracer::planned(scene, request, planner);
    image.resize(tracer.width(), tracer.height());
    let rays = tracer.pass(&mut image.pixels, Pass::Whole, control)?;
    Some(RenderCost {
        time: watch.elapsed(),
        rays,
        lanes: tracer.lanes(),
    })
}
