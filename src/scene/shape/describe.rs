//! What every kind of primitive tells about itself.

use std::fmt::Debug;

use glam::{DQuat, DVec3};

use super::plane_piece::PlanePiece;

/// What every kind of primitive tells about itself.
pub trait Describe: Clone + Debug + PartialEq + Sized {
    /// The name of the kind, as the file writes it.
    const KIND: &'static str;

    /// One of this kind, `size` world units large around `at`: what *Add* offers.
    fn example(at: DVec3, size: f64) -> Self;

    /// Shows every property to `visit`, in the order of the file.
    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>));

    /// What is wrong with the properties together, as a sentence without its full stop; each by itself
    /// is valid.
    fn problem(&self) -> Option<String> {
        None
    }

    /// Smallest and largest corner of the box around it; `None` for what never ends.
    fn bounds(&self) -> Option<(DVec3, DVec3)>;

    /// Where it is: what moves with it, and stays when it is turned or scaled.
    fn position(&self) -> DVec3;

    /// The same, moved.
    #[must_use]
    fn moved(&self, by: DVec3) -> Self;

    /// The same, turned about a point.
    #[must_use]
    fn turned(&self, about: DVec3, by: DQuat) -> Self;

    /// The same, so many times (> 0) as large and as far from a point.
    #[must_use]
    fn scaled(&self, about: DVec3, by: f64) -> Self;

    /// A point of it and its smallest measure in world units; `None` for what has none.
    fn feature(&self) -> Option<(DVec3, f64)>;

    /// How far a point is from its surface, in radii of curvature of that surface; infinity for
    /// what is flat.
    fn height_per_radius(&self, _point: DVec3) -> f64 {
        f64::INFINITY
    }

    /// The piece of a plane that it is; `None` for what is not flat.
    fn plane_piece(&self) -> Option<PlanePiece> {
        None
    }
}

/// Where a point is when it is turned about another one.
pub fn turned(point: DVec3, about: DVec3, by: DQuat) -> DVec3 {
    about + by * (point - about)
}

/// Where a point is when it is so many times as far from another one.
pub fn scaled(point: DVec3, about: DVec3, by: f64) -> DVec3 {
    about + (point - about) * by
}

/// One property of a primitive.
#[derive(Debug)]
pub struct Property<'a> {
    /// What the file and the inspector call it.
    pub name: &'static str,
    /// What it means, in a sentence without its full stop.
    pub hint: &'static str,
    /// Its value.
    pub value: PropertyValue<'a>,
}

/// What a property can be.
#[derive(Debug)]
pub enum PropertyValue<'a> {
    /// A place in world units.
    Point(&'a mut DVec3),
    /// A direction; any length but zero.
    Direction(&'a mut DVec3),
    /// A length in world units, > 0.
    Length(&'a mut f64),
    /// Degrees about x, y and z.
    Angles(&'a mut DVec3),
    /// Degrees, 0–180.
    Angle(&'a mut f64),
    /// Factors along x, y and z; none is 0.
    Factors(&'a mut DVec3),
}
