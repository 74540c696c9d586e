//! Where secondary rays start.

use crate::scene::{RayOffset, Scene};
use crate::simd::Real;

/// [`RayOffset`] with lengths in scene units.
#[derive(Clone, Copy, Debug)]
pub enum RayOrigin<R> {
    /// At the hit, ignoring the primitive that was hit.
    AtHit,
    /// This far along the new ray.
    Along(R),
    /// 256 roundings along the normal.
    Roundings,
}

/// Returns where secondary rays start in a scene.
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
