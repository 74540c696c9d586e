//! What the kernels write as colour.

use crate::scene::{Aspect, Camera, Projection, Scene};
use crate::simd::Real;

/// What the kernels write as colour; see [`Aspect`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Show<R> {
    /// The light of the scene.
    Light,
    /// Normals facing the viewer: each axis from -1 to 1 as a channel from 0 to 1.
    Normals,
    /// Distances: 1 at `nearest`, decreasing by `per_length` per unit of length.
    Depth {
        /// Distance at which the scene can begin.
        nearest: R,
        /// One over the distance from there to where the scene can end.
        per_length: R,
    },
    /// This value for each light that reaches the point.
    Shadows(R),
    /// The light that mirrors add where they are seen.
    Mirrors,
    /// The number of rays per pixel, averaged over each tile.
    Cost,
    /// The picture darkened, with the samples that are traced again in white.
    Retraced,
}

/// Depth range of a scene without bounded objects, in distances from the eye to the origin.
const DEFAULT_DEPTH: f64 = 4.0;

impl<R: Real> Show<R> {
    /// Returns what the kernels write for an aspect of a scene.
    pub fn new(aspect: Aspect, scene: &Scene, projection: Projection) -> Self {
        match aspect {
            Aspect::Normals => Self::Normals,
            Aspect::Depth => {
                let (nearest, farthest) = depth_range(scene, projection);
                Self::Depth {
                    nearest: R::from_f64(nearest),
                    per_length: R::from_f64(1.0 / (farthest - nearest)),
                }
            }
            Aspect::Shadows => {
                let shining = scene.visible_lights();
                Self::Shadows(R::from_f64(1.0 / shining.count().max(1) as f64))
            }
            Aspect::Mirrors => Self::Mirrors,
            Aspect::Cost => Self::Cost,
            Aspect::Retraced => Self::Retraced,
            Aspect::All
            | Aspect::Ambient
            | Aspect::Diffuse
            | Aspect::Specular
            | Aspect::WithoutMirrors
            | Aspect::Clay
            | Aspect::Objects => Self::Light,
        }
    }
}

/// The least and greatest distance of the scene from the camera, by the ball around its bounded objects.
fn depth_range(scene: &Scene, projection: Projection) -> (f64, f64) {
    let Camera { position, .. } = scene.camera;
    let Some((low, high)) = scene.objects_bounds() else {
        return (0.0, (position.length() * DEFAULT_DEPTH).max(1.0));
    };
    let (middle, radius) = (low.midpoint(high), low.distance(high) / 2.0);
    let distance = match projection {
        Projection::Perspective => position.distance(middle),
        Projection::Orthographic => (middle - position).dot(scene.camera.forward()),
    };
    let nearest = (distance - radius).max(0.0);
    (
        nearest,
        (distance + radius).max(nearest + f64::MIN_POSITIVE.max(radius)),
    )
}
