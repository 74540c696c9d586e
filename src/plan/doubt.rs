//! How far rounding may displace rays, for plans in which samples that rounding may decide are traced again.

use super::pack::Plan;
use crate::primitive::Blur;
use crate::simd::Real;

impl<R: Real> Plan<R> {
    /// Returns whether samples that rounding may decide are looked for.
    pub fn is_doubted(&self) -> bool {
        R::ZERO < self.blur.spread
    }

    /// Turns on the search for such samples. Rays hit a mesh in coordinates relative to its middle: if that is far
    /// away, they are rounded there like numbers of its size.
    pub fn doubt(&mut self) {
        let meshes = self.geometry.iter().flat_map(|all| &all.meshes);
        let middles = meshes.map(|mesh| mesh.centre.max_abs());
        self.max_mesh_centre = middles.fold(R::ZERO, R::max);
        self.blur = Blur::of_size(self.view.farthest_start() + self.max_mesh_centre);
    }
}
