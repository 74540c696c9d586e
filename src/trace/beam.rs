//! Beams of rays, and what they can meet. No ray in a beam hits anything that the beam does not meet: leaving it
//! out changes no pixel.

use glam::DVec3;

use crate::plan::Balls;
use crate::primitive::{Ball, BoundingBox, CAUTION, FAR_CAUTION, Ray};
use crate::simd::{Mask as _, Real, SimdFloat, Vec3};

/// Rays that start in a ball and go in directions within a cone, up to some distance.
#[derive(Clone, Copy, Debug)]
pub struct Beam<R> {
    origin: Vec3<R>,
    /// Radius of the ball in which the rays start.
    start_radius: R,
    axis: Vec3<R>,
    /// Sine of the angle between the axis and the outermost rays, which is less than 90°.
    sine: R,
    cosine: R,
    /// Greatest length of the rays.
    reach: R,
}

impl<R: Real> Beam<R> {
    /// Returns the beam from a point to all points of a ball; `None` if the point is in or nearly in the ball, so
    /// that the rays would go in all directions.
    pub fn to_ball(from: DVec3, ball: &Ball) -> Option<Self> {
        let towards = ball.center - from;
        let length = towards.length();
        let radius = ball.radius * (1.0 + CAUTION) + length * FAR_CAUTION;
        let sine = radius / length;
        (sine < 1.0).then(|| Self {
            origin: Vec3::from_dvec3(from),
            start_radius: R::ZERO,
            axis: Vec3::from_dvec3(towards * (1.0 / length)),
            sine: R::from_f64(sine),
            cosine: R::from_f64((1.0 - sine * sine).sqrt()),
            reach: R::from_f64(length + radius),
        })
    }

    /// Returns the beam of endless rays from a ball whose directions differ from `axis` by at most `chord` (the
    /// length of the difference of unit vectors); `None` if these directions do not fit in less than a half-space.
    pub fn from_ball(ball: &Ball, axis: DVec3, chord: f64) -> Option<Self> {
        let chord = chord * (1.0 + CAUTION) + FAR_CAUTION;
        let cosine = 1.0 - chord * chord * 0.5;
        (cosine > 0.0).then(|| Self {
            origin: Vec3::from_dvec3(ball.center),
            start_radius: R::from_f64(ball.radius),
            axis: Vec3::from_dvec3(axis),
            sine: R::from_f64((1.0 - cosine * cosine).sqrt()),
            cosine: R::from_f64(cosine),
            reach: R::INFINITY,
        })
    }

    /// Returns the beam extended to everything within `by` of its rays at their start, and `spread` more per unit
    /// of length; `None` if some of that might lie behind all starts.
    #[must_use]
    pub fn widened(self, by: R, spread: R) -> Option<Self> {
        // sin(a + b) ≤ sin a + b, cos(a + b) ≥ cos a - b.
        (spread < self.cosine).then(|| Self {
            start_radius: self.start_radius + by,
            sine: (self.sine + spread).min(R::ONE),
            cosine: self.cosine - spread,
            ..self
        })
    }

    /// Upper bound of the distance between the start of any ray and any point within `radius` of `center`.
    pub fn distance(&self, center: Vec3<R>, radius: R) -> R {
        (center - self.origin).length() + radius + self.start_radius
    }

    /// Returns whether any ray may reach the far side of the plane `normal` · p = `offset`.
    pub fn crosses(&self, normal: Vec3<R>, offset: R) -> bool {
        let height = normal.dot(self.origin) - offset;
        let slack = R::from_f64(FAR_CAUTION) * (self.origin.max_abs() + height.abs());
        if height.abs() <= self.start_radius + slack {
            return true;
        }
        let away = if height > R::ZERO { normal } else { -normal };
        away.dot(self.axis) <= self.sine + R::from_f64(FAR_CAUTION)
    }

    /// Returns which balls, from `first` on, the beam meets: those whose distance from the cone is at most the sum
    /// of both radii.
    #[inline(always)]
    fn meets<L: SimdFloat<Real = R>>(
        &self,
        token: L::Token,
        balls: &Balls<R>,
        first: usize,
    ) -> u64 {
        let center = Vec3::new(
            L::load(token, &balls.x[first..]),
            L::load(token, &balls.y[first..]),
            L::load(token, &balls.z[first..]),
        );
        let axis = center.like(self.axis);
        let q = center - center.like(self.origin);
        let along = q.dot(axis);
        let across = q - axis * along;
        let height = across.length();
        let radius = (L::load(token, &balls.radius[first..]) + along.like(self.start_radius))
            * along.like_f64(1.0 + CAUTION);
        let room = radius + (along.abs() + height) * along.like_f64(FAR_CAUTION);
        let outside = height * along.like(self.cosine) - along * along.like(self.sine);
        let is_met = outside.at_most(room)
            & (-room).at_most(along)
            & along.at_most(along.like(self.reach) + room);
        is_met.bits()
    }

    /// Lists the indices of the balls that the beam meets, in ascending order, at least of those from index `from`
    /// on.
    #[inline(always)]
    pub fn gather<L: SimdFloat<Real = R>>(
        &self,
        token: L::Token,
        (balls, from): (&Balls<R>, usize),
        met: &mut Vec<u32>,
    ) {
        met.clear();
        let from = from - from % L::WIDTH;
        for first in (from..balls.x.len()).step_by(L::WIDTH) {
            let mut bits = self.meets::<L>(token, balls, first);
            while bits != 0 {
                met.push(first as u32 + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
    }
}

/// The bounding box of points, for each lane.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<L> {
    low: Vec3<L>,
    high: Vec3<L>,
}

impl<L: SimdFloat> Bounds<L> {
    /// An empty box.
    #[inline(always)]
    pub fn new(token: L::Token) -> Self {
        let infinity = L::splat(token, L::Real::INFINITY);
        Self {
            low: Vec3::splat(infinity),
            high: Vec3::splat(-infinity),
        }
    }

    /// Extends the boxes to the points where the mask is set.
    #[inline(always)]
    pub fn add(&mut self, mask: L::Mask, point: Vec3<L>) {
        self.low = Vec3::select(mask, self.low.min(point), self.low);
        self.high = Vec3::select(mask, self.high.max(point), self.high);
    }

    /// The box around the boxes of all lanes; its `low` is above its `high` if no point was added.
    #[inline(always)]
    pub fn bounding_box(&self) -> BoundingBox<L::Real> {
        BoundingBox {
            low: Vec3::new(self.low.x.least(), self.low.y.least(), self.low.z.least()),
            high: Vec3::new(
                self.high.x.greatest(),
                self.high.y.greatest(),
                self.high.z.greatest(),
            ),
        }
    }

    /// The ball around the box of all lanes; `None` if no point was added.
    #[inline(always)]
    pub fn ball(&self) -> Option<Ball> {
        let BoundingBox { low, high } = self.bounding_box();
        let (low, high) = (low.to_dvec3(), high.to_dvec3());
        let radius = (high - low).length() * 0.5;
        radius.is_finite().then(|| Ball {
            center: (low + high) * 0.5,
            radius,
        })
    }
}

/// Returns the beam around the rays of all packets where their masks are set; `None` if there are none, or their
/// directions do not fit in less than a half-space.
#[inline(always)]
pub fn beam_around<L: SimdFloat>(
    token: L::Token,
    rays: impl Iterator<Item = (L::Mask, Ray<L>)> + Clone,
) -> Option<Beam<L::Real>> {
    let (mut origins, mut directions) = (Bounds::new(token), Bounds::new(token));
    for (active, rays) in rays.clone() {
        origins.add(active, rays.origin);
        directions.add(active, rays.direction);
    }
    let axis = directions.ball()?.center.try_normalize()?;
    let shared = Vec3::broadcast(token, Vec3::from_dvec3(axis));
    let mut chord = L::splat(token, L::Real::ZERO);
    for (active, rays) in rays {
        let off = rays.direction - shared;
        chord = L::select(active, chord.max(off.dot(off)), chord);
    }
    Beam::from_ball(&origins.ball()?, axis, chord.greatest().to_f64().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::primitive::{PackedSphere, Primitives};
    use proptest::prelude::*;

    fn vector(scale: f64) -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-scale..scale).prop_map(DVec3::from)
    }

    /// A point of the ball, by its offset from the centre in radii; offsets longer than 1 are shortened to 1.
    fn within(ball: &Ball, inside: DVec3) -> DVec3 {
        ball.center + inside * (ball.radius / inside.length().max(1.0))
    }

    fn is_met(beam: Option<Beam<f64>>, ball: Ball) -> bool {
        let sphere = PackedSphere {
            center: Vec3::from_dvec3(ball.center),
            radius: ball.radius,
            material: 0,
        };
        let balls = Balls::around(&Primitives {
            spheres: vec![sphere],
            ..Primitives::default()
        });
        beam.is_none_or(|beam| beam.meets::<f64>((), &balls, 0) != 0)
    }

    proptest! {
        #[test]
        fn what_blocks_a_line_into_the_ball_is_met(light in vector(10.0), center in vector(10.0), radius in 0.01..5.0_f64,
                                                   inside in vector(1.0), at in 0.0..1.0_f64, off in vector(1.0), size in 0.01..3.0_f64) {
            let ball = Ball { center, radius };
            let on_line = light + (within(&ball, inside) - light) * at;
            let blocker = Ball { center: on_line + off * (size * 0.999 / off.length().max(1.0)), radius: size };
            prop_assert!(is_met(Beam::to_ball(light, &ball), blocker));
        }

        #[test]
        fn what_a_ray_of_a_beam_hits_is_met(origins in prop::collection::vec(vector(3.0), 1..5), axis in vector(1.0), turns in prop::collection::vec(vector(0.5), 5),
                                            pick in 0..5_usize, at in 0.0..20.0_f64, off in vector(1.0), size in 0.01..3.0_f64) {
            let rays: Vec<Ray<f64>> = origins.iter().zip(&turns)
                .filter_map(|(&origin, &turn)| Some(Ray { origin: Vec3::from_dvec3(origin), direction: Vec3::from_dvec3((axis + turn).try_normalize()?) })).collect();
            prop_assume!(!rays.is_empty());
            let beam = beam_around((), rays.iter().map(|&rays| (true, rays)));
            let on_ray = rays[pick % rays.len()].at(at).to_dvec3();
            let ball = Ball { center: on_ray + off * (size * 0.999 / off.length().max(1.0)), radius: size };
            prop_assert!(is_met(beam, ball));
        }

        #[test]
        fn a_plane_that_a_ray_meets_is_crossed(origin in vector(3.0), axis in vector(1.0), turn in vector(0.3), normal in vector(1.0), offset in -4.0..4.0_f64) {
            let (Some(axis), Some(direction), Some(normal)) = (axis.try_normalize(), (axis + turn).try_normalize(), normal.try_normalize()) else { return Ok(()) };
            let ball = Ball { center: origin, radius: 0.1 };
            let Some(beam) = Beam::<f64>::from_ball(&ball, axis, (direction - axis).length()) else { return Ok(()) };
            let t = (offset - normal.dot(origin)) / normal.dot(direction);
            prop_assume!(t > 0.0 && t.is_finite());
            prop_assert!(beam.crosses(Vec3::from_dvec3(normal), offset));
        }
    }

    #[test]
    fn what_is_far_aside_is_left_out() {
        let at = |x: f64, y: f64, radius: f64| Ball {
            center: DVec3::new(x, y, 0.0),
            radius,
        };
        let light = DVec3::ZERO;
        let beam = Beam::to_ball(light, &at(10.0, 0.0, 1.0));
        assert!(!is_met(beam, at(5.0, 3.0, 1.0)));
        assert!(!is_met(beam, at(-3.0, 0.0, 1.0)));
        assert!(!is_met(beam, at(14.0, 0.0, 1.0)));
        assert!(is_met(beam, at(5.0, 1.4, 1.0)));
        let up = Beam::<f64>::from_ball(&at(0.0, 1.0, 0.1), DVec3::Y, 0.1).expect("narrow");
        assert!(
            !up.crosses(Vec3::new(0.0, 1.0, 0.0), 0.0),
            "a beam upwards never meets the floor"
        );
    }
}
