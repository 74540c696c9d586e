//! The infinite plane.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Property, PropertyValue};
use super::plane_piece::{Outline, PlanePiece};
use crate::scene::direction::unit;
use crate::scene::notation;

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Any point on it.
    #[serde(with = "notation::vector")]
    pub point: DVec3,
    /// Normal vector; any length but zero.
    #[serde(with = "notation::vector")]
    pub normal: DVec3,
}

impl Describe for Plane {
    const KIND: &'static str = "Plane";

    fn example(at: DVec3, _size: f64) -> Self {
        Self {
            point: at,
            normal: DVec3::Y,
        }
    }

    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
        visit(Property {
            name: "point",
            hint: "Any point on the plane",
            value: PropertyValue::Point(&mut self.point),
        });
        visit(Property {
            name: "normal",
            hint: "Direction perpendicular to the plane; its length does not matter",
            value: PropertyValue::Direction(&mut self.normal),
        });
    }

    fn bounds(&self) -> Option<(DVec3, DVec3)> {
        None
    }

    fn position(&self) -> DVec3 {
        self.point
    }

    fn feature(&self) -> Option<(DVec3, f64)> {
        None
    }

    fn plane_piece(&self) -> Option<PlanePiece> {
        Some(PlanePiece {
            point: self.point,
            normal: unit(self.normal)?,
            outline: Outline::Endless,
        })
    }
}
