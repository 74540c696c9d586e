//! The primitives as the file describes them: one file each.
//!
//! A new one is a file here that implements [`Describe`] and its name in the list below, its kernels in
//! [`crate::primitive`], and its symbol in the window.

mod plane;
mod sphere;
mod triangle;

use std::fmt::Debug;

use glam::DVec3;
use serde::{Deserialize, Serialize};

pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// What every kind of primitive tells about itself.
pub trait Describe: Clone + Debug + PartialEq + Sized {
    /// The name of the kind, as the file writes it.
    const KIND: &'static str;

    /// One of this kind, `size` world units large around `at`: what *Add* offers.
    fn example(at: DVec3, size: f64) -> Self;

    /// Shows every property to `visit`, in the order of the file.
    fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Field<'a>));

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

    /// A point of it and its smallest measure in world units; `None` for what has none.
    fn feature(&self) -> Option<(DVec3, f64)>;

    /// How far a point is from its surface, in radii of curvature of that surface; infinity for
    /// what is flat.
    fn height_per_radius(&self, _point: DVec3) -> f64 {
        f64::INFINITY
    }

    /// The point and the normal of the plane that it fills, if it is an endless one.
    fn endless_plane(&self) -> Option<(DVec3, DVec3)> {
        None
    }
}

/// One property of a primitive.
#[derive(Debug)]
pub struct Field<'a> {
    /// What the file and the inspector call it.
    pub name: &'static str,
    /// What it means, in a sentence without its full stop.
    pub hint: &'static str,
    /// Its value.
    pub value: FieldValue<'a>,
}

/// What a property can be.
#[derive(Debug)]
pub enum FieldValue<'a> {
    /// A place in world units.
    Point(&'a mut DVec3),
    /// A direction; any length but zero.
    Direction(&'a mut DVec3),
    /// A length in world units, > 0.
    Length(&'a mut f64),
}

macro_rules! shapes {
    ($($kind:ident: $article:literal),*) => {
        /// A primitive: all numbers in world units.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub enum Shape {
            $(#[doc = $article] $kind($kind)),*
        }

        $(impl From<$kind> for Shape {
            fn from(shape: $kind) -> Self {
                Self::$kind(shape)
            }
        })*

        impl Shape {
            /// One shape of every kind, of the given size around `at`: what *Add* offers.
            pub fn examples(at: DVec3, size: f64) -> Vec<Self> {
                vec![$(Self::$kind($kind::example(at, size))),*]
            }

            /// The name of the kind, as the file writes it.
            pub fn kind(&self) -> &'static str {
                match self { $(Self::$kind(_) => $kind::KIND),* }
            }

            /// Shows every property to `visit`, in the order of the file.
            pub fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Field<'a>)) {
                match self { $(Self::$kind(shape) => shape.fields(visit)),* }
            }

            /// What is wrong with the properties together, see [`Describe::problem`].
            pub fn problem(&self) -> Option<String> {
                match self { $(Self::$kind(shape) => shape.problem()),* }
            }

            /// Smallest and largest corner of the box around it; `None` for what never ends.
            pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
                match self { $(Self::$kind(shape) => shape.bounds()),* }
            }

            /// Where it is, see [`Describe::position`].
            pub fn position(&self) -> DVec3 {
                match self { $(Self::$kind(shape) => shape.position()),* }
            }

            /// The same shape, moved.
            #[must_use]
            pub fn moved(&self, by: DVec3) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.moved(by))),* }
            }

            /// A point of it and its smallest measure, see [`Describe::feature`].
            pub fn feature(&self) -> Option<(DVec3, f64)> {
                match self { $(Self::$kind(shape) => shape.feature()),* }
            }

            /// See [`Describe::height_per_radius`].
            pub fn height_per_radius(&self, point: DVec3) -> f64 {
                match self { $(Self::$kind(shape) => shape.height_per_radius(point)),* }
            }

            /// See [`Describe::endless_plane`].
            pub fn endless_plane(&self) -> Option<(DVec3, DVec3)> {
                match self { $(Self::$kind(shape) => shape.endless_plane()),* }
            }
        }
    };
}

shapes! {
    Sphere: "A ball.",
    Plane: "An endless plane.",
    Triangle: "A flat triangle."
}
