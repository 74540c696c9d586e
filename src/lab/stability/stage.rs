//! Traces the small pictures that some maps are measured on.

use crate::image::LinearRgb;
use crate::lab::measure::trace_light;
use crate::plan::RenderRequest;
use crate::scene::Scene;
use crate::trace::{RenderControl, Tracer};

/// The light of a picture, row by row from the top.
pub fn light(scene: &Scene, request: &RenderRequest) -> Vec<LinearRgb> {
    let traced = trace_light(&Tracer::new(scene, request), &RenderControl::default());
    // Nothing stops it.
    traced.map_or(Vec::new(), |(light, _)| light)
}
