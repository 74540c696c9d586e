//! Leaving primitives out before a ray is touched: those beside a tile, and those that cannot cast
//! a shadow into it. Whatever is left out would have been missed by every ray.

use std::ops::Range;

use super::hit::Among;
use crate::lanes::{Lane, Real, Vec3};
use crate::plan::{Extent, Plan, Screen};

/// Share by which balls are taken larger than computed, for the rounding of the kernel.
const CAUTION: f64 = 1e-3;

/// Spheres and triangles that are worth testing.
#[derive(Clone, Debug, Default)]
pub struct Casters {
    spheres: Vec<u32>,
    triangles: Vec<u32>,
}

impl Casters {
    /// Everything that casts shadows.
    pub fn all<R: Real>(plan: &Plan<R>) -> Self {
        Self {
            spheres: count(plan.casting_spheres),
            triangles: count(plan.triangles.len()),
        }
    }

    /// Everything there is, markers included.
    pub fn all_seen<R: Real>(plan: &Plan<R>) -> Self {
        Self {
            spheres: count(plan.spheres.len()),
            triangles: count(plan.triangles.len()),
        }
    }

    /// The lists.
    #[inline(always)]
    pub fn among(&self) -> Among<'_> {
        Among {
            spheres: &self.spheres,
            triangles: &self.triangles,
        }
    }

    /// Becomes those of `from` that a tile of these columns (or rows) can show.
    pub fn keep_seen(
        &mut self,
        from: &Self,
        screen: Option<&Screen>,
        pixels: &Range<usize>,
        axis: Axis,
    ) {
        let Some(screen) = screen else {
            return self.clone_from(from);
        };
        let meets = |extents: &(Extent, Extent)| match axis {
            Axis::Columns => extents.0.meets(pixels.start, pixels.end),
            Axis::Rows => extents.1.meets(pixels.start, pixels.end),
        };
        keep(&mut self.spheres, &from.spheres, |index| {
            meets(&screen.spheres[index])
        });
        keep(&mut self.triangles, &from.triangles, |index| {
            meets(&screen.triangles[index])
        });
    }

    /// Becomes those of `from` that can stand between a light and some point of a ball.
    pub fn keep_between<R: Real>(
        &mut self,
        from: &Self,
        plan: &Plan<R>,
        light: Vec3<R>,
        ball: &Ball,
    ) {
        let cone = Cone::new(light.to_f64(), ball);
        keep(&mut self.spheres, &from.spheres, |index| {
            let sphere = &plan.spheres[index];
            cone.meets(sphere.center.to_f64(), sphere.radius.to_f64())
        });
        keep(&mut self.triangles, &from.triangles, |index| {
            let ball = Ball::around(plan.triangles[index].corners.map(Vec3::to_f64));
            cone.meets(ball.center, ball.radius)
        });
    }
}

/// Direction of a range of pixels.
#[derive(Clone, Copy, Debug)]
pub enum Axis {
    /// From left to right.
    Columns,
    /// From top to bottom.
    Rows,
}

fn count(length: usize) -> Vec<u32> {
    (0..length as u32).collect()
}

fn keep(list: &mut Vec<u32>, from: &[u32], is_wanted: impl Fn(usize) -> bool) {
    list.clear();
    list.extend(
        from.iter()
            .copied()
            .filter(|&index| is_wanted(index as usize)),
    );
}

/// A ball around points.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    center: Vec3<f64>,
    radius: f64,
}

impl Ball {
    fn around(points: [Vec3<f64>; 3]) -> Self {
        let center = (points[0] + points[1] + points[2]) * (1.0 / 3.0);
        let radius = points.map(|point| (point - center).length());
        Self {
            center,
            radius: radius[0].max(radius[1]).max(radius[2]),
        }
    }
}

/// The box around the hits of a tile, lane by lane.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<L> {
    low: Vec3<L>,
    high: Vec3<L>,
}

impl<L: Lane> Bounds<L> {
    /// Around nothing.
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        let infinity = L::splat(token, L::Real::INFINITY);
        Self {
            low: Vec3::splat(infinity),
            high: Vec3::splat(-infinity),
        }
    }

    /// Takes the points in, where the mask is set.
    #[inline(always)]
    pub fn add(&mut self, mask: L::Mask, point: Vec3<L>) {
        self.low = Vec3::select(mask, self.low.min(point), self.low);
        self.high = Vec3::select(mask, self.high.max(point), self.high);
    }

    /// The ball around the box of all lanes; `None` if no point was taken in.
    #[inline(always)]
    pub fn ball(&self) -> Option<Ball> {
        let (mut low, mut high) = (self.low.lane(0).to_f64(), self.high.lane(0).to_f64());
        for lane in 1..L::WIDTH {
            low = low.min(self.low.lane(lane).to_f64());
            high = high.max(self.high.lane(lane).to_f64());
        }
        let radius = (high - low).length() * 0.5;
        radius.is_finite().then(|| Ball {
            center: (low + high) * 0.5,
            radius,
        })
    }
}

/// All lines from a point to the points of a ball.
struct Cone {
    apex: Vec3<f64>,
    axis: Vec3<f64>,
    length: f64,
    radius: f64,
    /// Height over the axis to distance along it of the nearest line: r / √(D² - r²); infinite
    /// inside the ball.
    slope: f64,
}

impl Cone {
    fn new(apex: Vec3<f64>, ball: &Ball) -> Self {
        let towards = ball.center - apex;
        let length = towards.length();
        let radius = ball.radius * (1.0 + CAUTION) + length * CAUTION * CAUTION;
        let square = length * length - radius * radius;
        let slope = if square > 0.0 {
            radius / square.sqrt()
        } else {
            f64::INFINITY
        };
        Self {
            apex,
            axis: towards * (1.0 / length),
            length,
            radius,
            slope,
        }
    }

    /// Whether a ball comes between: whether its distance from the hull of the apex and the ball,
    /// min over u in [0, 1] of |q - u·A| - u·r, is at most its radius.
    fn meets(&self, center: Vec3<f64>, radius: f64) -> bool {
        if self.slope.is_infinite() {
            return true;
        }
        let q = center - self.apex;
        let along = q.dot(self.axis);
        let height = (q.dot(q) - along * along).max(0.0).sqrt();
        let u = ((along + self.slope * height) / self.length).clamp(0.0, 1.0);
        let beyond = along - u * self.length;
        let gap = (beyond * beyond + height * height).sqrt() - u * self.radius;
        gap <= radius * (1.0 + CAUTION)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(scale: f64) -> impl Strategy<Value = Vec3<f64>> {
        prop::array::uniform3(-scale..scale).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn what_blocks_a_line_into_the_ball_is_kept(light in vector(10.0), center in vector(10.0), radius in 0.01..5.0_f64,
                                                    inside in vector(1.0), at in 0.0..1.0_f64, off in vector(1.0), size in 0.01..3.0_f64) {
            let ball = Ball { center, radius };
            let target = center + inside * (radius / inside.length().max(1.0));
            let on_line = light + (target - light) * at;
            let blocker = on_line + off * (size * 0.999 / off.length().max(1.0));
            prop_assert!(Cone::new(light, &ball).meets(blocker, size));
        }
    }

    #[test]
    fn what_is_far_aside_is_left_out() {
        let ball = Ball {
            center: Vec3::new(10.0, 0.0, 0.0),
            radius: 1.0,
        };
        let cone = Cone::new(Vec3::new(0.0, 0.0, 0.0), &ball);
        assert!(!cone.meets(Vec3::new(5.0, 3.0, 0.0), 1.0));
        assert!(!cone.meets(Vec3::new(-3.0, 0.0, 0.0), 1.0));
        assert!(!cone.meets(Vec3::new(14.0, 0.0, 0.0), 1.0));
        assert!(cone.meets(Vec3::new(5.0, 1.4, 0.0), 1.0));
    }
}
