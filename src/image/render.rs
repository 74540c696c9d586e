//! From a scene to a picture: the one way.

use std::time::Duration;

use super::buffer::{Image, LinearImage, Raster};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::{Pass, Pixel, Rays, RenderControl, Tracer};

/// What a picture cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderCost {
    /// Wall time, planning included and pauses not.
    pub time: Duration,
    /// Rays traced.
    pub rays: Rays,
    /// The kernel's real type and width, see [`Tracer::lanes`].
    pub lanes: String,
}

/// Traces a whole picture on the current rayon pool: the one way from a scene to pixels.
/// `None` if `control` said stop.
pub fn render(
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<(Image, RenderCost)> {
    let mut image = Image::new(request.width as usize, request.height as usize);
    let cost = render_into(&mut image, &mut Planner::default(), scene, request, control)?;
    Some((image, cost))
}

/// [`render`] over an older picture, whose memory it takes, with what was planned for it.
pub fn render_into(
    image: &mut Image,
    planner: &mut Planner,
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<RenderCost> {
    render_pixels(image, planner, scene, request, control)
}

/// [`render_into`] for the light itself.
pub fn render_light_into(
    image: &mut LinearImage,
    planner: &mut Planner,
    scene: &Scene,
    request: &RenderRequest,
    control: &RenderControl,
) -> Option<RenderCost> {
    render_pixels(image, planner, scene, request, control)
}

// Not public: the tracer's kernels are compiled here, once, and not by everyone who calls them.
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
