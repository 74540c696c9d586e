//! How hits are grouped into packets.

use super::request::RenderRequest;
use crate::scene::Sampling;

/// Number of pixels per object of the tree below which neighbours in the picture are rarely neighbours in the
/// scene.
const PIXELS_IN_ORDER: u64 = 128;

/// How hits are grouped into packets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitOrder {
    /// In the order of the samples.
    BySample,
    /// By proximity of the hits: for many objects, of which few pixels see the same one, and for samples along
    /// edges.
    ByPosition,
}

impl HitOrder {
    /// Chooses the order for a picture with this many objects in the tree.
    pub fn of(members: usize, request: &RenderRequest) -> Self {
        let is_smooth = matches!(request.sampling, Sampling::Adaptive { .. });
        if is_smooth || members as u64 * PIXELS_IN_ORDER > request.pixels() {
            Self::ByPosition
        } else {
            Self::BySample
        }
    }
}
