//! The list of all kinds of shapes.

use std::fmt::{self, Formatter};
use std::marker::PhantomData;

use glam::{DQuat, DVec3};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, EnumAccess, MapAccess, VariantAccess as _, Visitor};
use serde::{Deserialize, Serialize};

use super::describe::{Describe, Property, PropertyValue};
use super::disc::Disc;
use super::mesh::Mesh;
use super::plane::Plane;
use super::plane_piece::{Outline, PlanePiece};
use super::sphere::Sphere;
use super::triangle::Triangle;

/// Deserializes a shape. With derived newtype variants, the file would need nested parentheses; the RON extension
/// that unwraps them rejects an explicit `Some`.
struct AnyShape;

/// Deserializes the fields of a variant as those of a struct.
struct Fields<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Fields<T> {
    type Value = T;

    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("the fields of a shape")
    }

    fn visit_map<A: MapAccess<'de>>(self, fields: A) -> Result<T, A::Error> {
        T::deserialize(MapAccessDeserializer::new(fields))
    }
}

macro_rules! shapes {
    ($($kind:ident: $article:literal),*) => {
        /// A primitive shape. All lengths are in world units.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        pub enum Shape {
            $(#[doc = $article] $kind($kind)),*
        }

        $(impl From<$kind> for Shape {
            fn from(shape: $kind) -> Self {
                Self::$kind(shape)
            }
        })*

        #[derive(Deserialize)]
        #[serde(variant_identifier)]
        enum Kind {
            $($kind),*
        }

        impl<'de> Visitor<'de> for AnyShape {
            type Value = Shape;

            fn expecting(&self, f: &mut Formatter) -> fmt::Result {
                f.write_str("a shape")
            }

            fn visit_enum<A: EnumAccess<'de>>(self, shape: A) -> Result<Shape, A::Error> {
                match shape.variant()? {
                    $((Kind::$kind, fields) => fields.struct_variant(&[], Fields(PhantomData)).map(Shape::$kind)),*
                }
            }
        }

        impl<'de> Deserialize<'de> for Shape {
            fn deserialize<D: Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
                file.deserialize_enum("Shape", &[$(stringify!($kind)),*], AnyShape)
            }
        }

        impl Shape {
            /// Returns one example of each kind, of the given size around `at`, for the *Add* menu.
            pub fn examples(at: DVec3, size: f64) -> Vec<Self> {
                vec![$(Self::$kind($kind::example(at, size))),*]
            }

            /// The name of the kind, as written in the file.
            pub fn kind(&self) -> &'static str {
                match self { $(Self::$kind(_) => $kind::KIND),* }
            }

            /// Calls `visit` with each property, in file order.
            pub fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
                match self { $(Self::$kind(shape) => shape.fields(visit)),* }
            }

            /// Checks the combination of properties, see [`Describe::problem`].
            pub fn problem(&self) -> Option<String> {
                match self { $(Self::$kind(shape) => shape.problem()),* }
            }

            /// Returns the lowest and highest corner of the bounding box; `None` for unbounded shapes.
            pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
                match self { $(Self::$kind(shape) => shape.bounds()),* }
            }

            /// The reference point, see [`Describe::position`].
            pub fn position(&self) -> DVec3 {
                match self { $(Self::$kind(shape) => shape.position()),* }
            }

            /// Returns the shape moved by a vector.
            #[must_use]
            pub fn moved(&self, by: DVec3) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.moved(by))),* }
            }

            /// Returns the shape turned about a point.
            #[must_use]
            pub fn turned(&self, about: DVec3, by: DQuat) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.turned(about, by))),* }
            }

            /// Returns the shape scaled about a point by a factor > 0.
            #[must_use]
            pub fn scaled(&self, about: DVec3, by: f64) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.scaled(about, by))),* }
            }

            /// Returns a point and the smallest dimension of the shape, see [`Describe::feature`].
            pub fn feature(&self) -> Option<(DVec3, f64)> {
                match self { $(Self::$kind(shape) => shape.feature()),* }
            }

            /// See [`Describe::height_per_radius`].
            pub fn height_per_radius(&self, point: DVec3) -> f64 {
                match self { $(Self::$kind(shape) => shape.height_per_radius(point)),* }
            }

            /// Returns the shape as a piece of a plane, see [`Describe::plane_piece`].
            pub fn plane_piece(&self) -> Option<PlanePiece> {
                match self { $(Self::$kind(shape) => shape.plane_piece()),* }
            }
        }
    };
}

shapes! {
    Sphere: "A ball.",
    Plane: "An endless plane.",
    Triangle: "A flat triangle.",
    Disc: "A flat disc.",
    Mesh: "Many triangles."
}

impl Shape {
    /// The centre of the bounding box; for unbounded shapes, the position.
    pub fn middle(&self) -> DVec3 {
        match self.bounds() {
            Some((low, high)) => low.midpoint(high),
            None => self.position(),
        }
    }

    /// The point about which the shape is turned and scaled: for a mesh its position, if that is within its
    /// bounding box; in all other cases the middle.
    pub fn pivot(&self) -> DVec3 {
        let position = self.position();
        let is_within =
            |(low, high): (DVec3, DVec3)| position.cmpge(low).all() && position.cmple(high).all();
        match self {
            Self::Mesh(_) if self.bounds().is_some_and(is_within) => position,
            _ => self.middle(),
        }
    }

    /// Returns the values of the point properties, in file order.
    pub fn points(&self) -> Vec<DVec3> {
        let mut points = Vec::new();
        self.clone().fields(&mut |field| {
            if let PropertyValue::Point(point) = field.value {
                points.push(*point);
            }
        });
        points
    }

    /// Returns the shape moved so that its position is `place`; exactly so for shapes with a single point.
    #[must_use]
    pub fn placed(&self, place: DVec3) -> Self {
        let mut placed = self.moved(place - self.position());
        if self.points().len() == 1 {
            placed.fields(&mut |field| {
                if let PropertyValue::Point(point) = field.value {
                    *point = place;
                }
            });
        }
        placed
    }

    /// Returns the surface of an infinite plane; `None` for all other shapes.
    pub fn endless_plane(&self) -> Option<PlanePiece> {
        let piece = self.plane_piece();
        piece.filter(|piece| piece.outline == Outline::Endless)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::mesh::Triangles;
    use crate::scene::MeshSource;

    #[test]
    fn what_is_scaled_is_as_many_times_as_large_and_as_far_away() {
        let (about, by) = (DVec3::new(3.0, -2.0, 1.0), 2.5);
        for shape in Shape::examples(DVec3::new(10.0, 20.0, 30.0), 4.0) {
            let scaled = shape.scaled(about, by);
            let place = about + (shape.position() - about) * by;
            assert!((scaled.position() - place).length() < 1e-12, "{scaled:?}");
            let (Some((low, high)), Some((less, more))) = (shape.bounds(), scaled.bounds()) else {
                continue;
            };
            for (before, after) in [(low, less), (high, more)] {
                let wanted = about + (before - about) * by;
                assert!(
                    (after - wanted).length() < 1e-9,
                    "{}: {after}",
                    shape.kind()
                );
            }
        }
    }

    #[test]
    fn a_turn_about_its_own_point_moves_nothing_and_leaves_round_angles() {
        let shape = Shape::from(Mesh {
            position: DVec3::new(14.5, 13.0, 13.0),
            ..Mesh::example(DVec3::ZERO, 30.0)
        });
        assert_eq!(shape.pivot(), DVec3::new(14.5, 13.0, 13.0));
        let mut turned = shape.clone();
        for degrees in [50.0_f64, -20.0, -10.0] {
            let by = DQuat::from_axis_angle(DVec3::Y, degrees.to_radians());
            turned = turned.turned(turned.pivot(), by);
        }
        let Shape::Mesh(mesh) = &turned else {
            panic!("a mesh")
        };
        assert_eq!(mesh.position, shape.position());
        assert_eq!(mesh.rotation, DVec3::new(0.0, 20.0, 0.0));
        // The position is not the pivot if it is far from the triangles.
        let away = shape.moved(DVec3::X);
        let Shape::Mesh(mut mesh) = away else {
            panic!("a mesh")
        };
        let far = DVec3::splat(1e3);
        let points = mesh.source.triangles().points().iter();
        let moved = points.map(|point| point + far).collect();
        let faces = mesh.source.triangles().faces().to_vec();
        mesh.source = MeshSource::Inline(Arc::new(Triangles::new(moved, faces).expect("faces")));
        let shape = Shape::from(mesh);
        assert_eq!(shape.pivot(), shape.middle());
    }
}
