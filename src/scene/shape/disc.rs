//! The disc: a bounded floor or mirror.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Property, PropertyValue};
use super::plane_piece::{Outline, PlanePiece};
use crate::scene::direction::unit;
use crate::scene::notation;

/// A flat disc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Centre in world units.
    #[serde(with = "notation::vector")]
    pub center: DVec3,
    /// Normal vector; any length but zero.
    #[serde(with = "notation::vector")]
    pub normal: DVec3,
    /// Radius in world units, > 0.
    #[serde(with = "notation::number")]
    pub radius: f64,
}

impl Describe for Disc {
    const KIND: &'static str = "Disc";

    fn example(at: DVec3, size: f64) -> Self {
        Self {
            center: at,
            normal: DVec3::Y,
            radius: size / 2.0,
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
        visit(Property {
            name: "center",
            hint: "Center of the disc, in world units",
            value: PropertyValue::Point(&mut self.center),
        });
        visit(Property {
            name: "normal",
            hint: "Direction perpendicular to the disc; its length does not matter",
            value: PropertyValue::Direction(&mut self.normal),
        });
        visit(Property {
            name: "radius",
            hint: "In world units, greater than 0",
            value: PropertyValue::Length(&mut self.radius),
        });
    }

    /// The extent along an axis is the radius times the sine of the angle between axis and normal.
    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let normal = unit(self.normal).unwrap_or(DVec3::ZERO);
        let sines = (DVec3::ONE - normal * normal).max(DVec3::ZERO);
        let reach = DVec3::new(sines.x.sqrt(), sines.y.sqrt(), sines.z.sqrt()) * self.radius;
        Some((self.center - reach, self.center + reach))
    }

    fn position(&self) -> DVec3 {
        self.center
    }

    fn feature(&self) -> Option<(DVec3, f64)> {
        Some((self.center, self.radius))
    }

    fn plane_piece(&self) -> Option<PlanePiece> {
        Some(PlanePiece {
            point: self.center,
            normal: unit(self.normal)?,
            outline: Outline::Disc(self.radius),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lying_disc_has_no_height_and_a_leaning_one_reaches_both_ways() {
        let lying = Disc::example(DVec3::new(1.0, 2.0, 3.0), 4.0);
        let box_of = |disc: Disc| disc.bounds().expect("it ends");
        assert_eq!(
            box_of(lying),
            (DVec3::new(-1.0, 2.0, 1.0), DVec3::new(3.0, 2.0, 5.0))
        );
        let leaning = Disc {
            normal: DVec3::new(3.0, 4.0, 0.0),
            ..lying
        };
        let (low, high) = box_of(leaning);
        assert!((high - low - DVec3::new(3.2, 2.4, 4.0)).length() < 1e-12);
    }
}
