//! The list of all kinds.

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

/// Reads a shape. A variant that holds a struct would have parentheses within parentheses in the file;
/// the extension of RON that unwraps them refuses an explicit `Some`.
struct AnyShape;

/// Reads the fields of a variant as those of a struct.
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
        /// A primitive: all numbers in world units.
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
            /// One shape of every kind, of the given size around `at`: what *Add* offers.
            pub fn examples(at: DVec3, size: f64) -> Vec<Self> {
                vec![$(Self::$kind($kind::example(at, size))),*]
            }

            /// The name of the kind, as the file writes it.
            pub fn kind(&self) -> &'static str {
                match self { $(Self::$kind(_) => $kind::KIND),* }
            }

            /// Shows every property to `visit`, in the order of the file.
            pub fn fields<'a>(&'a mut self, visit: &mut dyn FnMut(Property<'a>)) {
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

            /// The middle of one that ends, or where it is.
            pub fn middle(&self) -> DVec3 {
                match self.bounds() {
                    Some((low, high)) => low * 0.5 + high * 0.5,
                    None => self.position(),
                }
            }

            /// What one is turned about, and grows from: of a mesh its position, if that is in the box around it; of
            /// all else the middle.
            pub fn pivot(&self) -> DVec3 {
                let position = self.position();
                let is_within = |(low, high): (DVec3, DVec3)| {
                    position.cmpge(low).all() && position.cmple(high).all()
                };
                match self {
                    Self::Mesh(_) if self.bounds().is_some_and(is_within) => position,
                    _ => self.middle(),
                }
            }

            /// The same shape, moved.
            #[must_use]
            pub fn moved(&self, by: DVec3) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.moved(by))),* }
            }

            /// Its points, in the order of the file.
            pub fn points(&self) -> Vec<DVec3> {
                let mut points = Vec::new();
                self.clone().fields(&mut |field| {
                    if let PropertyValue::Point(point) = field.value {
                        points.push(*point);
                    }
                });
                points
            }

            /// The same shape in another place: one that has a single point has it there to the last digit.
            #[must_use]
            pub fn placed(&self, place: DVec3) -> Self {
                let mut placed = self.moved(place - self.position());
                let mut points = Vec::new();
                placed.fields(&mut |field| {
                    if let PropertyValue::Point(point) = field.value {
                        points.push(point);
                    }
                });
                if let [only] = &mut points[..] {
                    **only = place;
                }
                placed
            }

            /// The same shape, turned about a point.
            #[must_use]
            pub fn turned(&self, about: DVec3, by: DQuat) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.turned(about, by))),* }
            }

            /// The same shape, so many times (> 0) as large and as far from a point.
            #[must_use]
            pub fn scaled(&self, about: DVec3, by: f64) -> Self {
                match self { $(Self::$kind(shape) => Self::$kind(shape.scaled(about, by))),* }
            }

            /// A point of it and its smallest measure, see [`Describe::feature`].
            pub fn feature(&self) -> Option<(DVec3, f64)> {
                match self { $(Self::$kind(shape) => shape.feature()),* }
            }

            /// See [`Describe::height_per_radius`].
            pub fn height_per_radius(&self, point: DVec3) -> f64 {
                match self { $(Self::$kind(shape) => shape.height_per_radius(point)),* }
            }

            /// The piece of a plane that it is, see [`Describe::plane_piece`].
            pub fn plane_piece(&self) -> Option<PlanePiece> {
                match self { $(Self::$kind(shape) => shape.plane_piece()),* }
            }

            /// The point and the normal of the plane that it fills, if it is an endless one.
            pub fn endless_plane(&self) -> Option<(DVec3, DVec3)> {
                let flat = self.plane_piece().filter(|flat| flat.outline == Outline::Endless)?;
                Some((flat.point, flat.normal))
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
        // Far from its triangles, it is no point to turn them about.
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
