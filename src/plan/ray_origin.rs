//! Where rays start that go on from a hit.

use crate::scene::{RayOffset, Scene};
use crate::simd::Real;

/// [`RayOffset`] with its lengths in the scene's units.
#[derive(Clone, Copy, Debug)]
pub enum RayOrigin<R> {
    /// At the hit, ignoring the own primitive.
    AtHit,
    /// So far along the new ray.
    Along(R),
    /// 256 roundings along the normal.
    Roundings,
}

/// Where they start in a scene.
pub fn ray_origin<R: Real>(scene: &Scene, offset: RayOffset) -> RayOrigin<R> {
    let along = |distance| RayOrigin::Along(R::from_f64(distance));
    match offset {
        RayOffset::Robust => RayOrigin::AtHit,
        RayOffset::Fixed(distance) => along(distance),
        RayOffset::Relative(share) => {
            let diagonal = scene
                .bounds()
                .map_or(1.0, |(low, high)| (high - low).length());
            along(share * diagonal)
        }
        RayOffset::WachterBinder => RayOrigin::Roundings,
    }
}
