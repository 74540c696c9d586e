//! Extents of flat surfaces: a pixel seen at a grazing angle stretches along such a surface, but only as far as it
//! extends.

use super::geometry::Geometry;
use crate::primitive::{CornerNormals, Primitive, Primitives, WithPrimitive};
use crate::simd::{Real, Vec3};

/// Extents of the largest flat bounded surfaces, in scene units; 0 if the stretching of pixels is not computed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Flats<R> {
    /// Largest extent of a primitive outside of meshes, including spheres: a large sphere seen as the ground looks
    /// flat.
    pub loose: R,
    /// Largest extent of a face of a mesh.
    pub in_meshes: R,
}

impl<R: Real> Flats<R> {
    /// The extents for a plan.
    pub fn of(primitives: &Primitives<R>, geometry: Option<&Geometry<R>>) -> Self {
        let Some(geometry) = geometry else {
            return Self {
                loose: largest_of(primitives),
                ..Self::default()
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
    /// Returns the normal and the extent of a primitive, see [`Primitive::flat`], if it is flat and also shaded as
    /// flat. `number` counts from the geometry's first primitive.
    pub fn flat_at(&self, number: usize) -> Option<(Vec3<R>, R)> {
        let Some(instance) = self.mesh_of(number) else {
            return self.primitives.with(number, FlatExtent);
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
    let flat_extent = largest(&primitives.discs).max(largest(&primitives.triangles));
    flat_extent.max(largest(&primitives.spheres))
}

/// Calls [`Primitive::flat`].
pub struct FlatExtent;

impl<R: Real> WithPrimitive<R> for FlatExtent {
    type Output = Option<(Vec3<R>, R)>;

    fn run<P: Primitive<R>>(self, primitive: &P) -> Self::Output {
        primitive.flat()
    }
}
