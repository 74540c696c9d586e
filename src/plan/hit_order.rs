//! How hits are put into packets.

use super::request::RenderRequest;
use crate::scene::Sampling;

/// With fewer pixels than this for each thing in a tree, neighbours in the picture are seldom neighbours in the scene.
const PIXELS_IN_ORDER: u64 = 128;

/// How hits are put into packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitOrder {
    /// As the samples are.
    OfSamples,
    /// Those together that are close to each other: there are many things and few pixels see the same, or samples are
    /// taken along edges.
    OfPlaces,
}

impl HitOrder {
    /// That of a picture of so many things in a tree.
    pub fn of(things: usize, request: &RenderRequest) -> Self {
        let is_smooth = matches!(request.sampling, Sampling::Adaptive { .. });
        if is_smooth || things as u64 * PIXELS_IN_ORDER > request.pixels() {
            Self::OfPlaces
        } else {
            Self::OfSamples
        }
    }
}
