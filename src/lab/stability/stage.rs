//! What maps are tried on: small scenes, and the light of small pictures of them.

use super::super::measure::trace_light;
use crate::image::LinearRgb;
use crate::plan::RenderRequest;
use crate::scene::{Object, Scene, Shape};
use crate::trace::{RenderControl, Tracer};

/// Something that is seen.
pub fn object(name: &str, color_pack: &str, shape: impl Into<Shape>) -> Object {
    Object {
        name: name.to_owned(),
        color_pack: color_pack.to_owned(),
        shape: shape.into(),
        visible: true,
        group: String::new(),
    }
}

/// The light of a picture, row by row from the top.
pub fn light(scene: &Scene, request: &RenderRequest) -> Vec<LinearRgb> {
    let traced = trace_light(&Tracer::new(scene, request), &RenderControl::default());
    // Nobody stops it.
    traced.map_or(Vec::new(), |(light, _)| light)
}
