//! The ball.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Field, FieldValue, scaled, turned};
use crate::scene::notation;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its middle.
    #[serde(with = "notation::vector")]
    pub center: DVec3,
    /// > 0.
    #[serde(with = "notation::number")]
    pub radius: f64,
}

impl Describe for Sphere {
    const KIND: &'static str = "Sphere";

    fn example(at: DVec3, size: f64) -> Self {
        Self {
            center: at,
            radius: size / 2.0,
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Field<'a>)) {
        visit(Field {
            name: "center",
            hint: "The middle of the ball, in world units",
            value: FieldValue::Point(&mut self.center),
        });
        visit(Field {
            name: "radius",
            hint: "In world units, greater than 0",
            value: FieldValue::Length(&mut self.radius),
        });
    }

    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let reach = DVec3::splat(self.radius);
        Some((self.center - reach, self.center + reach))
    }

    fn position(&self) -> DVec3 {
        self.center
    }

    fn moved(&self, by: DVec3) -> Self {
        Self {
            center: self.center + by,
            ..*self
        }
    }

    fn turned(&self, about: DVec3, by: DQuat) -> Self {
        Self {
            center: turned(self.center, about, by),
            ..*self
        }
    }

    fn scaled(&self, about: DVec3, by: f64) -> Self {
        Self {
            center: scaled(self.center, about, by),
            radius: self.radius * by,
        }
    }

    fn feature(&self) -> Option<(DVec3, f64)> {
        Some((self.center, self.radius))
    }

    fn height_per_radius(&self, point: DVec3) -> f64 {
        ((point - self.center).length() - self.radius).abs() / self.radius
    }
}
