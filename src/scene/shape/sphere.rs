//! The sphere.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Property, PropertyValue};
use crate::scene::notation;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre in world units.
    #[serde(with = "notation::vector")]
    pub center: DVec3,
    /// Radius in world units, > 0.
    #[serde(with = "notation::number")]
    pub radius: f64,
}

/// Largest gap between spheres that count as identical, as a share of their size (radius plus largest coordinate):
/// the rounding left by moving or scaling there and back.
const SAME_SPHERE: f64 = 64.0 * f64::EPSILON;
/// A direction along which the positions of spheres in regular rows differ.
const SORT_DIRECTION: DVec3 = DVec3::new(0.791_287_3, 0.529_103_7, 0.306_419_1);

impl Sphere {
    /// Returns whether both spheres are identical up to rounding, so that rounding would decide which is seen.
    pub fn is_same(&self, other: &Self) -> bool {
        let size = |ball: &Self| ball.radius + ball.center.abs().max_element();
        self.gap(other) <= SAME_SPHERE * size(self).max(size(other))
    }

    /// Returns an upper bound on the distance between the surfaces of two nearly identical spheres, in world units.
    pub fn gap(&self, other: &Self) -> f64 {
        self.center.distance(other.center) + (self.radius - other.radius).abs()
    }

    /// The projection of the centre on a fixed direction, in world units: nearby spheres have nearby values.
    pub fn along(&self) -> f64 {
        self.center.dot(SORT_DIRECTION)
    }

    /// The largest difference of [`Self::along`] between this sphere and an identical one.
    pub fn along_tolerance(&self) -> f64 {
        2.0 * SAME_SPHERE * (self.radius + self.center.abs().max_element())
    }
}

impl Describe for Sphere {
    const KIND: &'static str = "Sphere";

    fn example(at: DVec3, size: f64) -> Self {
        Self {
            center: at,
            radius: size / 2.0,
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
        visit(Property {
            name: "center",
            hint: "Center of the sphere, in world units",
            value: PropertyValue::Point(&mut self.center),
        });
        visit(Property {
            name: "radius",
            hint: "In world units, greater than 0",
            value: PropertyValue::Length(&mut self.radius),
        });
    }

    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let reach = DVec3::splat(self.radius);
        Some((self.center - reach, self.center + reach))
    }

    fn position(&self) -> DVec3 {
        self.center
    }

    fn feature(&self) -> Option<(DVec3, f64)> {
        Some((self.center, self.radius))
    }

    fn height_per_radius(&self, point: DVec3) -> f64 {
        ((point - self.center).length() - self.radius).abs() / self.radius
    }
}
