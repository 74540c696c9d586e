//! Bounding balls in double precision.

use glam::DVec3;

use crate::simd::Real;

/// Relative enlargement of balls and angles, to cover the kernel's rounding.
pub const CAUTION: f64 = 1e-3;
/// The same for distances, as a share of the distance.
pub const FAR_CAUTION: f64 = 1e-5;

/// Upper bound of the accumulated roundings in a primitive's test.
const ROUNDINGS: f64 = 16.0;

/// Upper bound of the error of a primitive's test, as a share of the largest coordinate.
pub fn roundings<R: Real>() -> R {
    R::UNIT_ROUNDOFF * R::from_f64(ROUNDINGS)
}

/// A ball in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The centre.
    pub center: DVec3,
    /// ≥ 0.
    pub radius: f64,
}

impl Ball {
    /// Returns the smallest ball around a triangle.
    pub fn around_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let squares =
            [(a, b, c), (b, c, a), (c, a, b)].map(|(p, q, r)| ((q - p).dot(q - p), p, q, r));
        let longest = squares.iter().fold(
            squares[0],
            |best, &side| if side.0 > best.0 { side } else { best },
        );
        let (square, p, q, r) = longest;
        let middle = (p + q) * 0.5;
        if (r - middle).dot(r - middle) * 4.0 <= square {
            return Self {
                center: middle,
                radius: square.sqrt() * 0.5,
            };
        }
        // Acute: the circle through the corners. From p, with sides u and v and n = u × v, its
        // centre is (|v|²(n × u) + |u|²(v × n)) / 2|n|².
        let (u, v) = (q - p, r - p);
        let n = u.cross(v);
        let from_p = (n.cross(u) * v.dot(v) + v.cross(n) * u.dot(u)) * (0.5 / n.dot(n));
        Self {
            center: p + from_p,
            radius: from_p.length(),
        }
    }

    /// Returns whether another ball is completely behind this one as seen from a light, so that nothing in it is
    /// lit.
    pub fn hides(&self, light: DVec3, ball: &Self) -> bool {
        let towards = self.center - light;
        let length = towards.length();
        // A light on the surface shines into the ball, so that nothing inside is behind it.
        if length <= self.radius * (1.0 + CAUTION) {
            return false;
        }
        let sine = self.radius * (1.0 - CAUTION) / length;
        let axis = towards * (1.0 / length);
        let q = ball.center - light;
        let along = q.dot(axis);
        let height = (q - axis * along).length();
        let radius = ball.radius * (1.0 + CAUTION) + along.abs() * FAR_CAUTION;
        let cosine = (1.0 - sine * sine).sqrt();
        along * sine - height * cosine >= radius && along - radius >= length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(scale: f64) -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-scale..scale).prop_map(DVec3::from)
    }

    /// A point of the ball: `inside` is moved into it.
    fn within(ball: &Ball, inside: DVec3) -> DVec3 {
        ball.center + inside * (ball.radius / inside.length().max(1.0))
    }

    proptest! {
        #[test]
        fn the_ball_of_a_triangle_is_tight(a in vector(50.0), b in vector(50.0), c in vector(50.0)) {
            prop_assume!((b - a).cross(c - a).length() > 1e-3);
            let ball = Ball::around_triangle([a, b, c]);
            let reach = [a, b, c].map(|corner| (corner - ball.center).length());
            let touching = reach.iter().filter(|r| (*r / ball.radius - 1.0).abs() < 1e-6).count();
            prop_assert!(reach.iter().all(|r| *r <= ball.radius * (1.0 + 1e-9)), "{reach:?} {ball:?}");
            prop_assert!(touching >= 2);
        }

        #[test]
        fn what_is_hidden_is_in_shadow(light in vector(5.0), center in vector(5.0), radius in 0.1..3.0_f64, beyond in 1.0..4.0_f64,
                                       aside in vector(1.0), size in 0.0..0.5_f64, inside in vector(1.0)) {
            let place = light + (center - light) * beyond + aside * (radius * beyond);
            let (sphere, ball) = (Ball { center, radius }, Ball { center: place, radius: size * radius });
            prop_assume!(sphere.hides(light, &ball));
            let point = within(&ball, inside);
            let to_light = (light - point).try_normalize().expect("apart");
            let along = (center - point).dot(to_light);
            let beside = (center - point - to_light * along).length();
            prop_assert!(beside < radius && along > 0.0 && along < (light - point).length());
        }
    }

    #[test]
    fn what_peeps_out_is_not_hidden() {
        let at = |x: f64, y: f64, radius: f64| Ball {
            center: DVec3::new(x, y, 0.0),
            radius,
        };
        let sphere = at(5.0, 0.0, 2.0);
        assert!(sphere.hides(DVec3::ZERO, &at(10.0, 0.5, 1.0)));
        assert!(!sphere.hides(DVec3::ZERO, &at(10.0, 3.5, 1.0)));
        for place in [3.0, 3.0 + 1e-9, 3.0 - 1e-9, 3.001] {
            let light = DVec3::new(place, 0.0, 0.0);
            assert!(!sphere.hides(light, &at(6.8, 0.0, 0.1)), "inside of it");
        }
    }
}
