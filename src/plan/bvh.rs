//! Balls around what a ray can meet, laid out so that several are tested in step.
//!
//! Few primitives are one flat list of balls. Many are sorted along a curve through space and
//! bundled, [`GROUP`] by [`GROUP`], under larger balls, those again, and so on.

use glam::DVec3;

use crate::primitive::Ball;
use crate::simd::Real;

/// How many balls are tested together: as many as the widest processor has lanes.
pub const GROUP: usize = 16;

/// Above so many, walking the tree costs less than testing every primitive's own ball.
pub const LARGEST_LIST: usize = 128;

/// Balls, component by component, filled up to whole groups with balls that nothing meets.
#[derive(Clone, Debug, Default)]
pub struct Balls<R> {
    /// x of the centres.
    pub x: Vec<R>,
    /// y of the centres.
    pub y: Vec<R>,
    /// z of the centres.
    pub z: Vec<R>,
    /// Minus infinity in a ball that nothing meets.
    pub radius: Vec<R>,
}

/// The balls around the primitives that end.
#[derive(Clone, Debug, Default)]
pub struct Bvh<R> {
    /// The primitives' own balls first; then, level by level, balls around [`GROUP`] of the level
    /// before, up to a single group.
    pub levels: Vec<Balls<R>>,
    /// The number of the primitive in each ball of the first level.
    pub members: Vec<u32>,
}

impl<R: Real> Bvh<R> {
    /// Builds a tree of the numbered balls if `is_tree`, else a flat list in their order.
    pub fn new(balls: &[(u32, Ball)], is_tree: bool) -> Self {
        let mut sorted = balls.to_vec();
        if is_tree {
            let keys = curve(balls);
            let mut order: Vec<usize> = (0..balls.len()).collect();
            order.sort_by_key(|&index| keys[index]);
            sorted = order.into_iter().map(|index| balls[index]).collect();
        }
        let members = sorted.iter().map(|&(member, _)| member).collect();
        let mut level: Vec<Ball> = sorted.into_iter().map(|(_, ball)| ball).collect();
        let mut levels = vec![Balls::of(&level)];
        while is_tree && level.len() > GROUP {
            level = level.chunks(GROUP).map(Ball::around_balls).collect();
            levels.push(Balls::of(&level));
        }
        Self { levels, members }
    }

    /// Whether it is more than a list.
    pub fn is_tree(&self) -> bool {
        self.levels.len() > 1
    }
}

impl<R: Real> Balls<R> {
    fn of(balls: &[Ball]) -> Self {
        let full = balls.len().next_multiple_of(GROUP);
        let column = |part: fn(&Ball) -> f64, filler: f64| {
            let mut column: Vec<R> = balls.iter().map(|ball| R::from_f64(part(ball))).collect();
            column.resize(full, R::from_f64(filler));
            column
        };
        Self {
            x: column(|ball| ball.center.x, 0.0),
            y: column(|ball| ball.center.y, 0.0),
            z: column(|ball| ball.center.z, 0.0),
            radius: column(|ball| ball.radius, f64::NEG_INFINITY),
        }
    }
}

/// The place of each ball's centre on a curve that fills the box around them, neighbours in space
/// mostly being neighbours on it (Morton 1966).
fn curve(balls: &[(u32, Ball)]) -> Vec<u64> {
    let (mut low, mut high) = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    for (_, ball) in balls {
        low = low.min(ball.center);
        high = high.max(ball.center);
    }
    let side = (high - low).abs().max_element().max(f64::MIN_POSITIVE);
    let last_cell = f64::from((1_u32 << CELL_BITS) - 1);
    let place = |(_, ball): &(u32, Ball)| {
        let cell = (ball.center - low) * (last_cell / side);
        cell.to_array()
            .iter()
            .enumerate()
            .fold(0, |key, (axis, part)| key | spread(*part as u64) << axis)
    };
    balls.iter().map(place).collect()
}

/// Bits of a cell's number along one axis.
const CELL_BITS: u32 = 20;

/// The bits of a cell's number with two zeros after each.
fn spread(cell: u64) -> u64 {
    (0..CELL_BITS).fold(0, |spread, bit| spread | (cell >> bit & 1) << (3 * bit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-50.0..50.0_f64).prop_map(DVec3::from)
    }

    proptest! {
        #[test]
        fn every_ball_lies_in_those_above_it(places in prop::collection::vec((vector(), 0.0..5.0_f64), 1..700)) {
            let balls: Vec<(u32, Ball)> = (0..).zip(places).map(|(number, (center, radius))| (number, Ball { center, radius })).collect();
            let bvh = Bvh::<f64>::new(&balls, true);
            let mut members = bvh.members.clone();
            members.sort_unstable();
            prop_assert_eq!(members, (0..balls.len() as u32).collect::<Vec<_>>());
            for (place, &member) in bvh.members.iter().enumerate() {
                let (_, own) = balls[member as usize];
                let mut place = place;
                for level in &bvh.levels[1..] {
                    place /= GROUP;
                    let center = DVec3::new(level.x[place], level.y[place], level.z[place]);
                    prop_assert!((own.center - center).length() + own.radius <= level.radius[place] * (1.0 + 1e-12));
                }
            }
            prop_assert!(bvh.levels.last().is_some_and(|top| top.x.len() == GROUP));
        }

    }
}
