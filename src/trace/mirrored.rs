//! Rays that mirrors reflect.

use super::footprint::RayCone;
use super::paths::Paths;
use crate::primitive::Ray;
use crate::simd::{SimdFloat, Vec3};

/// Rays that one or several mirrors reflect.
pub struct Mirrored<L: SimdFloat> {
    /// Where there is a ray.
    pub active: L::Mask,
    /// The factors that their colours are multiplied by.
    pub filter: Vec3<L>,
    /// The rays.
    pub paths: Paths<L>,
    /// The width of a pixel along them, if edges are noted.
    pub cone: Option<RayCone<L>>,
}

impl<L: SimdFloat> Mirrored<L> {
    /// Merges these and the rays of other mirrors into one packet.
    #[inline(always)]
    #[must_use]
    pub fn merged_with(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        let new = self;
        let is_new = new.active;
        let (ours, theirs) = (new.paths, before.paths);
        let rays = Ray {
            origin: Vec3::select(is_new, ours.rays.origin, theirs.rays.origin),
            direction: Vec3::select(is_new, ours.rays.direction, theirs.rays.direction),
        };
        let ignored = ours.ignored.select(is_new, theirs.ignored);
        Self {
            active: before.active | is_new,
            filter: Vec3::select(is_new, new.filter, before.filter),
            paths: Paths { rays, ignored },
            cone: match (new.cone, before.cone) {
                (Some(new), Some(before)) => Some(RayCone {
                    width: L::select(is_new, new.width, before.width),
                    spread: L::select(is_new, new.spread, before.spread),
                }),
                _ => None,
            },
        }
    }
}
