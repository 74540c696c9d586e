//! The trait that every kind of shape implements.

use std::fmt::Debug;

use glam::{DQuat, DVec3};

use super::angles::{angles_of, orientation_of};
use super::plane_piece::PlanePiece;

/// The common interface of all kinds of shapes.
pub trait Describe: Clone + Debug + PartialEq + Sized {
    /// The name of the kind, as written in the file.
    const KIND: &'static str;

    /// Returns an example, `size` world units large around `at`, for the *Add* menu.
    fn example(at: DVec3, size: f64) -> Self;

    /// Calls `visit` with each property, in file order.
    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>));

    /// Checks the combination of properties, each of which is valid by itself. Returns what is wrong as a sentence
    /// without its full stop.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Returns the lowest and highest corner of the bounding box; `None` for unbounded shapes.
    fn bounds(&self) -> Option<(DVec3, DVec3)>;

    /// The reference point: it moves with the shape, and stays in place when the shape is turned or scaled about
    /// it.
    fn position(&self) -> DVec3;

    /// Returns the shape moved by a vector.
    #[must_use]
    fn moved(&self, by: DVec3) -> Self {
        let mut moved = self.clone();
        moved.fields(&mut |field| {
            if let PropertyValue::Point(point) = field.value {
                *point += by;
            }
        });
        moved
    }

    /// Returns the shape turned about a point.
    #[must_use]
    fn turned(&self, about: DVec3, by: DQuat) -> Self {
        let mut turned = self.clone();
        turned.fields(&mut |field| match field.value {
            PropertyValue::Point(point) => *point = about + by * (*point - about),
            PropertyValue::Direction(direction) => *direction = by * *direction,
            PropertyValue::Angles(angles) => {
                *angles = angles_of(by * orientation_of(*angles), *angles);
            }
            PropertyValue::Length(_) | PropertyValue::Angle(_) | PropertyValue::Factors(_) => {}
        });
        turned
    }

    /// Returns the shape scaled about a point by a factor > 0.
    #[must_use]
    fn scaled(&self, about: DVec3, by: f64) -> Self {
        let mut scaled = self.clone();
        scaled.fields(&mut |field| match field.value {
            PropertyValue::Point(point) => *point = about + (*point - about) * by,
            PropertyValue::Length(length) => *length *= by,
            PropertyValue::Factors(factors) => *factors *= by,
            PropertyValue::Direction(_) | PropertyValue::Angles(_) | PropertyValue::Angle(_) => {}
        });
        scaled
    }

    /// Returns a point of the shape and its smallest dimension, in world units; `None` for unbounded shapes.
    fn feature(&self) -> Option<(DVec3, f64)>;

    /// Returns the distance of a point from the surface, in radii of curvature of that surface; infinity for flat
    /// shapes and meshes.
    fn height_per_radius(&self, _point: DVec3) -> f64 {
        f64::INFINITY
    }

    /// Returns the shape as a piece of a plane; `None` if it is not flat.
    fn plane_piece(&self) -> Option<PlanePiece> {
        None
    }
}

/// A property of a shape.
#[derive(Debug)]
pub struct Property<'a> {
    /// Name in the file and the inspector.
    pub name: &'static str,
    /// Explanation, as a sentence without its full stop.
    pub hint: &'static str,
    /// Mutable reference to the value.
    pub value: PropertyValue<'a>,
}

/// A mutable reference to the value of a property, by type: this says how it is moved, turned and scaled.
#[derive(Debug)]
pub enum PropertyValue<'a> {
    /// A position in world units.
    Point(&'a mut DVec3),
    /// A direction; any length but zero.
    Direction(&'a mut DVec3),
    /// A length in world units, > 0.
    Length(&'a mut f64),
    /// Rotation in degrees about x, y and z.
    Angles(&'a mut DVec3),
    /// An angle in degrees, 0–180.
    Angle(&'a mut f64),
    /// Scale factors along x, y and z; none is 0.
    Factors(&'a mut DVec3),
}

impl PropertyValue<'_> {
    /// Calls `visit` with the vector. A single number fills all three coordinates, and then takes on the first.
    pub fn with_vector(&mut self, visit: impl FnOnce(&mut DVec3)) {
        match self {
            Self::Point(vector)
            | Self::Direction(vector)
            | Self::Angles(vector)
            | Self::Factors(vector) => visit(vector),
            Self::Length(number) | Self::Angle(number) => {
                let mut vector = DVec3::splat(**number);
                visit(&mut vector);
                **number = vector.x;
            }
        }
    }
}
