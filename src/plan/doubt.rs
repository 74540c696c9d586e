//! How far rays may be beside their place in a plan whose pictures tell what rounding may decide.

use super::pack::Plan;
use crate::primitive::Blur;
use crate::simd::Real;

impl<R: Real> Plan<R> {
    /// Whether what rounding may decide is told.
    pub fn is_doubted(&self) -> bool {
        R::ZERO < self.blur.spread
    }

    /// From now on it is. Rays meet a mesh in coordinates that count from its own middle: where that is far away they
    /// are rounded there as numbers of its size are.
    pub fn doubt(&mut self) {
        let meshes = self.geometry.iter().flat_map(|all| &all.meshes);
        let middles = meshes.map(|mesh| mesh.centre.max_abs());
        self.farthest_middle = middles.fold(R::ZERO, R::max);
        self.blur = Blur::of_size(self.view.farthest_start() + self.farthest_middle);
    }
}
