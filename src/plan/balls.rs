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
}

impl<R: Real> Balls<R> {
    /// Stores these balls in their order.
    pub fn new<'a>(balls: impl Iterator<Item = &'a Ball>) -> Self {
        let mut all = Self::default();
        for ball in balls {
            all.push(ball.center.to_array(), ball.radius);
        }
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

/// The bounding balls of all bounded primitives, with their numbers.
pub fn balls_of<R: Real>(primitives: &Primitives<R>) -> Vec<(u32, Ball)> {
    let mut balls = BallCollector(Vec::new());
    primitives.visit(&mut balls);
    balls.0
}

struct BallCollector(Vec<(u32, Ball)>);

impl<R: Real> Visit<R> for BallCollector {
    fn visit<P: Primitive<R>>(&mut self, _kind: Kind, primitives: &[P], first: usize) {
        let balls = primitives.iter().enumerate();
        let balls = balls.filter_map(|(index, primitive)| {
            let ball = primitive.ball()?;
            Some(((first + index) as u32, ball))
        });
        self.0.extend(balls);
    }
}
