//! Bounding balls of what a ray can hit, laid out so that several are tested at once.

use crate::primitive::{Ball, Kind, Primitive, Primitives, Visit};
use crate::simd::{MAX_LANES, Real};

/// Balls as one array per component, padded to whole packets with balls that nothing hits.
#[derive(Clone, Debug, Default)]
pub struct Balls<R> {
    /// x of the centres.
    pub x: Vec<R>,
    /// y of the centres.
    pub y: Vec<R>,
    /// z of the centres.
    pub z: Vec<R>,
    /// Radii; minus infinity for padding.
    pub radius: Vec<R>,
    /// The kinds of the primitives in the balls, and their indices in the lists of these kinds.
    pub primitives: Vec<(Kind, u32)>,
}

impl<R: Real> Balls<R> {
    /// The balls around all bounded primitives, in the order of their numbers.
    pub fn around(primitives: &Primitives<R>) -> Self {
        let mut all = Self::default();
        primitives.visit(&mut all);
        while !all.x.len().is_multiple_of(MAX_LANES) {
            all.push([0.0; 3], f64::NEG_INFINITY);
        }
        all
    }

    fn push(&mut self, [x, y, z]: [f64; 3], radius: f64) {
        self.x.push(R::from_f64(x));
        self.y.push(R::from_f64(y));
        self.z.push(R::from_f64(z));
        self.radius.push(R::from_f64(radius));
    }
}

impl<R: Real> Visit<R> for Balls<R> {
    fn visit<P: Primitive<R>>(&mut self, kind: Kind, primitives: &[P], _first: usize) {
        for (index, primitive) in (0..).zip(primitives) {
            if let Some(Ball { center, radius }) = primitive.ball() {
                self.push(center.to_array(), radius);
                self.primitives.push((kind, index));
            }
        }
    }
}
