//! How large what is flat is: pixels stretch along it, and no farther than it goes.

use super::geometry::Geometry;
use crate::primitive::{CornerNormals, Primitive, Primitives, WithPrimitive};
use crate::simd::{Real, Vec3};

/// The largest of what is flat and ends, in scene units; 0 where nobody asks how pixels lie on it.
#[derive(Clone, Copy, Debug)]
pub struct Flats<R> {
    /// Of what is in no mesh, large balls among it: where they are the ground, they are seen as flat.
    pub loose: R,
    /// Of the faces of meshes.
    pub in_meshes: R,
}

impl<R: Real> Flats<R> {
    /// Nobody asks.
    pub const NONE: Self = Self {
        loose: R::ZERO,
        in_meshes: R::ZERO,
    };

    /// Those of a plan.
    pub fn of(primitives: &Primitives<R>, geometry: Option<&Geometry<R>>) -> Self {
        let Some(geometry) = geometry else {
            return Self {
                loose: largest_of(primitives),
                ..Self::NONE
            };
        };
        let meshes = geometry.meshes.iter();
        Self {
            loose: largest_of(primitives).max(largest_of(&geometry.primitives)),
            in_meshes: meshes
                .map(|instance| instance.mesh.longest)
                .fold(R::ZERO, R::max),
        }
    }
}

impl<R: Real> Geometry<R> {
    /// The normal of the primitive of a number, counted from the first, if that is flat and looks so, and how far it goes
    /// at most, see [`Primitive::flat`].
    pub fn flat_at(&self, number: usize) -> Option<(Vec3<R>, R)> {
        let Some(instance) = self.mesh_of(number) else {
            return self.primitives.with(number, AskFlat);
        };
        let face = number - instance.first;
        let normals = instance.mesh.smooth.get(face);
        let is_flat = normals.is_none_or(CornerNormals::are_alike);
        is_flat.then(|| instance.mesh.triangles[face].flat())?
    }
}

fn largest_of<R: Real>(primitives: &Primitives<R>) -> R {
    fn largest<R: Real, P: Primitive<R>>(primitives: &[P]) -> R {
        let flats = primitives.iter().filter_map(P::flat);
        flats.map(|(_, extent)| extent).fold(R::ZERO, R::max)
    }
    let ending = largest(&primitives.discs).max(largest(&primitives.triangles));
    ending.max(largest(&primitives.spheres))
}

/// Asks a primitive for [`Primitive::flat`].
pub struct AskFlat;

impl<R: Real> WithPrimitive<R> for AskFlat {
    type Output = Option<(Vec3<R>, R)>;

    fn run<P: Primitive<R>>(self, primitive: &P) -> Self::Output {
        primitive.flat()
    }
}
