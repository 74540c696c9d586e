//! Small things that look alike, put together so that rays which have met different ones are shaded as one
//! packet.

use crate::plan::{Geometry, MeshInstance};
use crate::primitive::{Flat, PackedSphere, PackedTriangle, Ray, Round, SurfacePoint};
use crate::simd::{MAX_LANES, Real, SimdFloat, Vec3};

/// A primitive in a tree, and what it must have in common with others to be shaded with them.
pub struct Piece<'a, R> {
    form: Form<'a, R>,
    /// Index into [`crate::plan::Plan::materials`].
    pub material: u32,
    /// The mesh that it belongs to.
    mesh: Option<&'a MeshInstance<R>>,
}

enum Form<'a, R> {
    Flat(&'a PackedTriangle<R>),
    Round(&'a PackedSphere<R>),
}

impl<'a, R: Real> Piece<'a, R> {
    /// The primitive of a number, counted from the geometry's first; `None` for a kind that is shaded by
    /// itself.
    #[inline(always)]
    pub fn of(geometry: &'a Geometry<R>, index: usize) -> Option<Self> {
        if let Some(mesh) = geometry.mesh_of(index) {
            return Some(Self {
                form: Form::Flat(&mesh.mesh.triangles[index - mesh.first]),
                material: mesh.material,
                mesh: Some(mesh),
            });
        }
        let loose = &geometry.primitives;
        // Planes stand in no tree: spheres are first.
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

    /// Whether it is shaded in the same way.
    #[inline(always)]
    pub fn is_like(&self, other: &Self) -> bool {
        let is_same_form = matches!(
            (&self.form, &other.form),
            (Form::Flat(_), Form::Flat(_)) | (Form::Round(_), Form::Round(_))
        );
        let is_same_mesh = match (self.mesh, other.mesh) {
            (None, None) => true,
            (Some(this), Some(other)) => std::ptr::eq(this, other),
            _ => false,
        };
        is_same_form && is_same_mesh && self.material == other.material
    }
}

/// What is needed of pieces where they are hit, lane by lane.
pub struct Gathered<R> {
    /// A corner, or the middle.
    place: [[R; MAX_LANES]; 3],
    normal: [[R; MAX_LANES]; 3],
    /// Whether it is in a mesh; or the radius, and one over it.
    measures: [[R; MAX_LANES]; 2],
    /// 1 where there is something, else 0.
    is_there: [R; MAX_LANES],
}

impl<R: Real> Gathered<R> {
    /// Nothing in any lane.
    #[inline(always)]
    pub fn new() -> Self {
        let zeros = [R::ZERO; MAX_LANES];
        Self {
            place: [zeros; 3],
            normal: [zeros; 3],
            measures: [zeros; 2],
            is_there: zeros,
        }
    }

    /// Puts a piece into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, piece: &Piece<R>) {
        self.is_there[lane] = R::ONE;
        match piece.form {
            Form::Flat(triangle) => {
                put(&mut self.place, lane, triangle.corners[0]);
                put(&mut self.normal, lane, triangle.normal);
                self.measures[0][lane] = if triangle.in_mesh { R::ONE } else { R::ZERO };
            }
            Form::Round(sphere) => {
                put(&mut self.place, lane, sphere.center);
                self.measures[0][lane] = sphere.radius;
                self.measures[1][lane] = R::ONE / sphere.radius;
            }
        }
    }

    /// Where there is something.
    #[inline(always)]
    pub fn mask<L: SimdFloat<Real = R>>(&self, token: L::Token) -> L::Mask {
        L::splat(token, R::ZERO).less(L::load(token, &self.is_there))
    }

    /// The hits at `t` on pieces that are like `piece`.
    #[inline(always)]
    pub fn refine<L: SimdFloat<Real = R>>(
        &self,
        piece: &Piece<R>,
        rays: &Ray<L>,
        t: L,
    ) -> SurfacePoint<L> {
        let token = t.token();
        let place = load::<L>(token, &self.place);
        let [first, second] = &self.measures;
        let (first, second) = (L::load(token, first), L::load(token, second));
        match (&piece.form, piece.mesh) {
            (Form::Round(_), _) => {
                let round = Round {
                    center: place,
                    radius: first,
                    curvature: second,
                };
                round.refine(rays, t)
            }
            (Form::Flat(_), mesh) => {
                let flat = Flat {
                    corner: place,
                    normal: load::<L>(token, &self.normal),
                    in_mesh: first,
                };
                match mesh {
                    None => flat.refine(rays, t),
                    Some(mesh) => refine_in_mesh(mesh, &flat, rays, t),
                }
            }
        }
    }
}

#[inline(always)]
fn put<R: Real>(columns: &mut [[R; MAX_LANES]; 3], lane: usize, vector: Vec3<R>) {
    for (column, part) in columns.iter_mut().zip(vector.to_array()) {
        column[lane] = part;
    }
}

#[inline(always)]
fn load<L: SimdFloat>(token: L::Token, [x, y, z]: &[[L::Real; MAX_LANES]; 3]) -> Vec3<L> {
    Vec3::new(L::load(token, x), L::load(token, y), L::load(token, z))
}

/// The hits on faces of a mesh, which are met from the mesh's own middle.
#[inline(always)]
fn refine_in_mesh<L: SimdFloat>(
    instance: &MeshInstance<L::Real>,
    flat: &Flat<L>,
    rays: &Ray<L>,
    t: L,
) -> SurfacePoint<L> {
    let centre = rays.origin.like(instance.centre);
    let local = Ray {
        origin: rays.origin - centre,
        direction: rays.direction,
    };
    let surface = flat.refine(&local, t);
    let point = surface.point + centre;
    // Back in the world's coordinates it is rounded once more, and again where the next ray sets out.
    let world = (point.max_abs() + centre.max_abs()) * t.like(L::Real::UNIT_ROUNDOFF);
    SurfacePoint {
        point,
        slack: surface.slack + (world + world),
        ..surface
    }
}
