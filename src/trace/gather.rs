//! Gathers the data of small, similar primitives, so that rays which have hit different ones are lit as one packet.

use super::columns::{Columns, CurvedColumns};
use super::mixed_materials::MixedMaterials;
use crate::plan::{Geometry, MeshInstance};
use crate::primitive::{
    CornerNormals, Flat, PackedSphere, PackedTriangle, Ray, Round, SurfacePoint,
};
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

/// A primitive in a tree, and what it must have in common with others to be lit together.
pub struct HitPrimitive<'a, R> {
    form: Form<'a, R>,
    /// Index into [`crate::plan::Plan::materials`].
    pub material: u32,
    /// The mesh that it belongs to, if any.
    mesh: Option<&'a MeshInstance<R>>,
}

enum Form<'a, R> {
    Flat(&'a PackedTriangle<R>),
    Curved(&'a PackedTriangle<R>, &'a CornerNormals<R>),
    Round(&'a PackedSphere<R>),
}

impl<'a, R: Real> HitPrimitive<'a, R> {
    /// Returns the primitive with this number, counted from the geometry's first; `None` for a kind that is shaded
    /// separately.
    #[inline(always)]
    pub fn of(geometry: &'a Geometry<R>, index: usize) -> Option<Self> {
        if let Some(mesh) = geometry.mesh_of(index) {
            let face = index - mesh.first;
            let triangle = &mesh.mesh.triangles[face];
            let form = match mesh.mesh.smooth.get(face) {
                None => Form::Flat(triangle),
                Some(normals) => Form::Curved(triangle, normals),
            };
            return Some(Self {
                form,
                material: mesh.material,
                mesh: Some(mesh),
            });
        }
        let loose = &geometry.primitives;
        // There are no planes in trees, so that spheres come first.
        let (form, material) = if let Some(sphere) = loose.spheres.get(index) {
            (Form::Round(sphere), sphere.material)
        } else {
            let triangle = loose.triangles.get(index - loose.spheres.len())?;
            (Form::Flat(triangle), triangle.material)
        };
        Some(Self {
            form,
            material,
            mesh: None,
        })
    }

    /// The triangle, if it is shaded flat or its corner normals are alike, and the origin of its corners' coordinates.
    pub fn flat(&self) -> Option<(&'a PackedTriangle<R>, Vec3<R>)> {
        let triangle = match self.form {
            Form::Flat(triangle) => triangle,
            Form::Curved(triangle, normals) if normals.are_alike() => triangle,
            Form::Curved(..) | Form::Round(_) => return None,
        };
        let origin = self.mesh.map(|mesh| mesh.centre);
        Some((triangle, origin.unwrap_or(Vec3::splat(R::ZERO))))
    }

    /// Returns whether another primitive can be lit together with this one.
    #[inline(always)]
    pub fn is_like(&self, other: &Self) -> bool {
        let is_same_form = matches!(
            (&self.form, &other.form),
            (Form::Flat(_), Form::Flat(_))
                | (Form::Curved(..), Form::Curved(..))
                | (Form::Round(_), Form::Round(_))
        );
        let is_same_mesh = match (self.mesh, other.mesh) {
            (None, None) => true,
            (Some(this), Some(other)) => std::ptr::eq(this, other),
            _ => false,
        };
        is_same_form && is_same_mesh
    }
}

/// The data of primitives that their hits need, lane by lane.
pub struct Gathered<R> {
    /// A corner, or the centre.
    anchor: Columns<R>,
    normal: Columns<R>,
    /// Of a triangle, 1 if it shares a corner with others, else 0, and the longest edge; of a sphere, the radius
    /// and one over it.
    measures: [[R; MAX_LANES]; 2],
    /// Data for smooth shading, if the faces are shaded smoothly.
    curved: Option<CurvedColumns<R>>,
    /// 1 plus the index of the material in lanes that have a primitive, else 0.
    materials: [R; MAX_LANES],
}

impl<R: Real> Gathered<R> {
    /// Creates it with all lanes empty, for primitives like this one.
    #[inline(always)]
    pub fn like(hit_primitive: &HitPrimitive<R>) -> Self {
        let zeros = [R::ZERO; MAX_LANES];
        let curved = match hit_primitive.form {
            Form::Curved(..) => Some(CurvedColumns::new()),
            Form::Flat(_) | Form::Round(_) => None,
        };
        Self {
            anchor: Columns::new(),
            normal: Columns::new(),
            measures: [zeros; 2],
            curved,
            materials: zeros,
        }
    }

    /// Sets the primitive of a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, hit_primitive: &HitPrimitive<R>) {
        self.materials[lane] = R::from_f64(f64::from(hit_primitive.material) + 1.0);
        match hit_primitive.form {
            Form::Flat(triangle) => self.set_flat(lane, triangle),
            Form::Curved(triangle, normals) => {
                self.set_flat(lane, triangle);
                if let Some(curved) = &mut self.curved {
                    curved.set(lane, triangle, normals);
                }
            }
            Form::Round(sphere) => {
                self.anchor.set(lane, sphere.center);
                self.measures[0][lane] = sphere.radius;
                self.measures[1][lane] = R::ONE / sphere.radius;
            }
        }
    }

    #[inline(always)]
    fn set_flat(&mut self, lane: usize, triangle: &PackedTriangle<R>) {
        self.anchor.set(lane, triangle.corners[0]);
        self.normal.set(lane, triangle.normal);
        self.measures[0][lane] = if triangle.in_mesh { R::ONE } else { R::ZERO };
        self.measures[1][lane] = triangle.longest;
    }

    /// Returns which lanes have a primitive.
    #[inline(always)]
    pub fn mask<L: SimdFloat<Real = R>>(&self, token: L::Token) -> L::Mask {
        L::splat(token, R::ZERO).less(L::load(token, &self.materials))
    }

    /// Sets `mixed` to the materials in all lanes.
    #[inline(always)]
    pub fn group_by_material<L: SimdFloat<Real = R>>(
        &self,
        token: L::Token,
        mixed: &mut MixedMaterials<L>,
    ) {
        mixed.clear();
        let materials = L::load(token, &self.materials);
        let mut remaining = self.mask::<L>(token).bits();
        while remaining != 0 {
            let material = self.materials[remaining.trailing_zeros() as usize];
            let lanes = materials.same(materials.like(material));
            remaining &= !lanes.bits();
            mixed.add(lanes, (material - R::ONE).to_f64() as u32);
        }
    }

    /// Returns the hits at `t` on primitives like this one.
    #[inline(always)]
    pub fn refine<L: SimdFloat<Real = R>>(
        &self,
        hit_primitive: &HitPrimitive<R>,
        rays: &Ray<L>,
        t: L,
    ) -> SurfacePoint<L> {
        let token = t.token();
        let anchor = self.anchor.load::<L>(token);
        let [first, second] = &self.measures;
        let (first, second) = (L::load(token, first), L::load(token, second));
        match (&hit_primitive.form, hit_primitive.mesh) {
            (Form::Round(_), _) => {
                let round = Round {
                    center: anchor,
                    radius: first,
                    curvature: second,
                };
                round.refine(rays, t)
            }
            (Form::Flat(_) | Form::Curved(..), mesh) => {
                let flat = Flat {
                    corner: anchor,
                    normal: self.normal.load::<L>(token),
                    in_mesh: first,
                    longest: second,
                };
                match mesh {
                    None => flat.refine(rays, t),
                    Some(mesh) => self.refine_in_mesh(mesh, &flat, rays, t),
                }
            }
        }
    }

    /// Returns the hits on faces of a mesh, which are computed in coordinates relative to the mesh's centre.
    #[inline(always)]
    fn refine_in_mesh<L: SimdFloat<Real = R>>(
        &self,
        instance: &MeshInstance<R>,
        flat: &Flat<L>,
        rays: &Ray<L>,
        t: L,
    ) -> SurfacePoint<L> {
        let centre = rays.origin.like(instance.centre);
        let local = Ray {
            origin: rays.origin - centre,
            direction: rays.direction,
        };
        let mut surface = flat.refine(&local, t);
        let point = surface.point + centre;
        // Conversion to world coordinates adds a rounding, and so does the start of the next ray.
        let world = (point.max_abs() + centre.max_abs()) * t.like(R::UNIT_ROUNDOFF);
        surface.slack = surface.slack + (world + world);
        surface.size = surface.size + point.max_abs();
        if let Some(curved) = &self.curved {
            surface = curved.load(t.token()).bend(&surface, rays.direction);
        }
        SurfacePoint {
            point: surface.point + centre,
            ..surface
        }
    }
}
