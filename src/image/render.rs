//! From a scene to a picture: the one way.

use std::time::{Duration, Instant};

use super::buffer::Image;
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::{Pass, Rays, RenderControl, Tracer};

/// What a picture cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderCost {
    /// Wall time, planning included.
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
    let start = Instant::now();
    let tracer = Tracer::planned(scene, request, planner);
    image.resize(tracer.width(), tracer.height());
    let rays = image.trace(&tracer, Pass::Whole, control)?;
    Some(RenderCost {
        time: start.elapsed(),
        rays,
        lanes: tracer.lanes(),
    })
}
