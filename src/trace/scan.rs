//! Tests of many primitives: all of those in a list, and those in a tree whose boxes are hit.

use std::sync::Arc;

use super::bundle::Bundle;
use super::candidates::Candidates;
use super::entry_points::EntryPoints;
use super::passing::own_width_around;
use super::paths::Paths;
use super::slender::lanes_meeting_oriented_box;
use super::thin_margin::ThinMargin;
use super::walk::{Stack, TreeVisitor, walk, walk_thin};
use crate::plan::{Child, CulledFaces, Geometry, PackedMesh, Plan};
use crate::primitive::{Blur, Kind, Prepared, Primitive, Ray, Visit, WithPrepared};
use crate::simd::{Mask as _, Real as _, SimdFloat, Vec3};

/// A test to run on many primitives.
pub trait Test<L: SimdFloat> {
    /// Whether it looks for thin things beside the rays, and not for hits.
    const FINDS_THIN: bool = false;

    /// Returns how far each ray still looks; not above 0 where it does not.
    fn reach(&self) -> L;

    /// Returns whether nothing more can be found out.
    fn is_done(&self) -> bool {
        false
    }

    /// Tests a mesh as the ball around it, for the rays that see it no larger than a few pixels; a pixel is at most
    /// `widest` wide there. Returns the other active rays, for which its faces are tested; `None` if there are none,
    /// or the faces are not to be tested.
    fn test_ball(
        &mut self,
        _mesh: &PackedMesh<L::Real>,
        _widest: L::Real,
        _paths: &Paths<L>,
        active: L::Mask,
    ) -> Option<L::Mask> {
        Some(active)
    }

    /// Ends the tests of the faces of that mesh.
    fn leave_mesh(&mut self) {}

    /// Tests the contents of a box for the rays that see it as one thing, see [`TreeVisitor::visit_merged_box`].
    fn test_merged_box(
        &mut self,
        _ball: (Vec3<L::Real>, L::Real),
        _thickness: L::Real,
        _paths: &Paths<L>,
        (_active, _passing): (L::Mask, impl FnOnce() -> L::Mask),
    ) -> u64 {
        0
    }

    /// The margin of each ray by itself, see [`TreeVisitor::own_margin`].
    fn own_margin(&self) -> Option<ThinMargin<L>> {
        None
    }

    /// Sets the rays, bit by bit, that are excluded from the tests that follow. Returns those excluded so far.
    fn exclude_lanes(&mut self, _merged_lanes: u64) -> u64 {
        0
    }

    /// Tests the primitive of this number in one of its boxes; it counts for the rays that pass that closely.
    fn test_slice<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        (paths, _passing): (&Paths<L>, impl FnOnce() -> L::Mask),
        number: usize,
    ) {
        self.test(primitive, prepared, paths, number);
    }

    /// Tests the primitive of this number.
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    );
}

/// Runs a test on the primitives in the lists.
#[inline(always)]
pub fn scan_lists<L: SimdFloat>(
    plan: &Plan<L::Real>,
    targets: &Candidates,
    paths: &Paths<L>,
    test: &mut impl Test<L>,
) {
    plan.primitives.visit(&mut ListScan {
        targets,
        paths,
        test,
    });
}

struct ListScan<'a, L, T> {
    targets: &'a Candidates,
    paths: &'a Paths<L>,
    test: &'a mut T,
}

impl<L: SimdFloat, T: Test<L>> Visit<L::Real> for ListScan<'_, L, T> {
    #[inline(always)]
    fn visit<P: Primitive<L::Real>>(&mut self, kind: Kind, primitives: &[P], first: usize) {
        let targets = self.targets.of(kind);
        if targets.is_empty() || self.test.is_done() {
            return;
        }
        let prepared = P::prepare(self.paths.rays.direction);
        for &index in targets {
            let (primitive, number) = (&primitives[index as usize], first + index as usize);
            self.test.test(primitive, &prepared, self.paths, number);
            if self.test.is_done() {
                return;
            }
        }
    }
}

/// The contents of a tree, and how they are scanned.
pub struct TreeScan<'a, L: SimdFloat> {
    /// What is in the tree.
    pub geometry: &'a Geometry<L::Real>,
    /// The number of its first primitive.
    pub first: usize,
    /// Where to start; scans beside the rays start at the roots of the trees.
    pub entry_points: &'a EntryPoints,
    /// For each mesh, the faces that are not tested, if there are any.
    pub culled_faces: &'a [Option<Arc<CulledFaces>>],
    /// If given, boxes are tested along the ways from this point to the origins of the rays, see
    /// [`Bundle::from_point`].
    pub back_from: Option<Vec3<L::Real>>,
    /// Where there is a ray.
    pub active: L::Mask,
    /// How far the rays may be off because of rounding.
    pub blur: Blur<L>,
    /// How far beside the rays tests for thin things look.
    pub margin: ThinMargin<L::Real>,
    /// Whether boxes are tested; otherwise all primitives are.
    pub is_boxed: bool,
}

impl<L: SimdFloat> TreeScan<'_, L> {
    /// Tests what is in the boxes of the tree that the rays hit.
    #[inline(always)]
    pub fn scan<T: Test<L>>(&self, paths: &Paths<L>, stack: &mut Stack<L::Real>, test: &mut T) {
        let bvh = &self.geometry.bvh;
        let (rays, reach) = (&paths.rays, bvh.bounds.max_abs());
        let mut bundle = match self.back_from {
            None => Bundle::new(rays, &self.blur, self.active, reach),
            Some(point) => Bundle::from_point(point, (rays, &self.blur), self.active, reach),
        };
        if !self.is_boxed {
            bundle.accept_all_boxes();
        }
        let mut objects = ObjectVisitor {
            tree_scan: self,
            bundle: &bundle,
            paths,
            prepared: Prepared::new(paths.rays.direction),
            test,
        };
        if T::FINDS_THIN {
            // For a mesh as a whole, the width of a pixel is that at the ball around it, which rays may pass long
            // before the box.
            let margin = if self.geometry.meshes.is_empty() {
                self.margin
            } else {
                self.margin.without_narrowing()
            };
            walk_thin(bvh, &bundle, &margin, (stack, 0), &mut objects);
        } else if let Some(start) = self.entry_points.of_objects(self.geometry) {
            walk((bvh, start), &bundle, stack, &mut objects);
        }
    }
}

/// Visits the members of the tree of all objects: primitives, then meshes.
struct ObjectVisitor<'a, L: SimdFloat, T> {
    tree_scan: &'a TreeScan<'a, L>,
    bundle: &'a Bundle<L>,
    paths: &'a Paths<L>,
    prepared: Prepared<L>,
    test: &'a mut T,
}

impl<L: SimdFloat, T: Test<L>> TreeVisitor<L> for ObjectVisitor<'_, L, T> {
    #[inline(always)]
    fn reach(&self) -> L {
        active_reach(self.tree_scan.active, self.test)
    }

    #[inline(always)]
    fn visit_member(&mut self, member: u32, width: L::Real, stack: &mut Stack<L::Real>) {
        let (geometry, index) = (self.tree_scan.geometry, member as usize);
        let number = self.tree_scan.first + index;
        let primitives = &geometry.primitives;
        if let Some(mesh) = index.checked_sub(primitives.len()) {
            return self.scan_mesh((mesh, width), stack);
        }
        let mut test_prepared = TestPrepared {
            paths: self.paths,
            number,
            test: self.test,
        };
        primitives.with_prepared(index, &self.prepared, &mut test_prepared);
    }

    #[inline(always)]
    fn visit_merged_box(
        &mut self,
        ball: (Vec3<L::Real>, L::Real),
        thickness: L::Real,
        passing: impl FnOnce() -> L::Mask,
    ) -> u64 {
        let lanes = (self.tree_scan.active, passing);
        self.test
            .test_merged_box(ball, thickness, self.paths, lanes)
    }

    #[inline(always)]
    fn own_margin(&self) -> ThinMargin<L> {
        own_margin(self.test)
    }

    #[inline(always)]
    fn exclude_lanes(&mut self, merged_lanes: u64) {
        self.test.exclude_lanes(merged_lanes);
    }
}

impl<L: SimdFloat, T: Test<L>> ObjectVisitor<'_, L, T> {
    /// Scans a mesh, with rays relative to its middle.
    #[inline(always)]
    fn scan_mesh(&mut self, (mesh, width): (usize, L::Real), stack: &mut Stack<L::Real>) {
        let TreeScan {
            geometry,
            first,
            entry_points,
            culled_faces,
            active,
            margin,
            is_boxed,
            ..
        } = self.tree_scan;
        let instance = &geometry.meshes[mesh];
        let rays = self.paths.rays;
        let paths = Paths {
            rays: Ray {
                origin: rays.origin - rays.origin.like(instance.centre),
                direction: rays.direction,
            },
            ignored: self.paths.ignored,
        };
        let bvh = &instance.mesh.bvh;
        let Some(mut active) = self.test.test_ball(&instance.mesh, width, &paths, *active) else {
            return;
        };
        let bundle = self.bundle.seen_from(instance.centre);
        if let Some(oriented) = &instance.mesh.oriented
            && *is_boxed
        {
            let width = if T::FINDS_THIN {
                own_width_around(&bundle, &bvh.bounds, &own_margin(self.test))
            } else {
                rays.origin.x.like(L::Real::ZERO)
            };
            let margin = bundle.margin();
            let is_met = lanes_meeting_oriented_box(&paths.rays, margin, oriented, width);
            active = active & is_met;
            if !active.any() {
                self.test.leave_mesh();
                return;
            }
        }
        let mut faces = FaceVisitor {
            mesh: &instance.mesh,
            culled_faces: culled_faces.get(mesh).and_then(Option::as_deref),
            first: first + instance.first,
            active,
            paths: &paths,
            prepared: &self.prepared,
            test: self.test,
        };
        if T::FINDS_THIN {
            let merged_lanes = faces.test.exclude_lanes(0);
            walk_thin(bvh, &bundle, margin, (stack, merged_lanes), &mut faces);
            faces.test.exclude_lanes(merged_lanes);
        } else if let Some(start) = entry_points.of_mesh(geometry, mesh) {
            walk((bvh, start), &bundle, stack, &mut faces);
        }
        self.test.leave_mesh();
    }
}

/// Visits the members of the tree of a mesh.
struct FaceVisitor<'a, L: SimdFloat, T> {
    mesh: &'a PackedMesh<L::Real>,
    /// The faces that are left out.
    culled_faces: Option<&'a CulledFaces>,
    first: usize,
    active: L::Mask,
    paths: &'a Paths<L>,
    prepared: &'a Prepared<L>,
    test: &'a mut T,
}

impl<L: SimdFloat, T: Test<L>> TreeVisitor<L> for FaceVisitor<'_, L, T> {
    #[inline(always)]
    fn reach(&self) -> L {
        active_reach(self.active, self.test)
    }

    #[inline(always)]
    fn is_culled(&self, child: Child) -> bool {
        match self.culled_faces {
            None => false,
            Some(culled_faces) => culled_faces.holds(child),
        }
    }

    #[inline(always)]
    fn visit_member(&mut self, member: u32, _width: L::Real, _stack: &mut Stack<L::Real>) {
        let (index, prepared) = (member as usize, &self.prepared.triangles);
        let (triangle, number) = (&self.mesh.triangles[index], self.first + index);
        self.test.test(triangle, prepared, self.paths, number);
    }

    #[inline(always)]
    fn is_sliced(&self, member: u32) -> bool {
        self.mesh.triangles[member as usize].slicing.count() > 1
    }

    #[inline(always)]
    fn visit_slice(&mut self, member: u32, passing: impl FnOnce() -> L::Mask) {
        let (index, prepared) = (member as usize, &self.prepared.triangles);
        let (triangle, number) = (&self.mesh.triangles[index], self.first + index);
        let paths = (self.paths, passing);
        self.test.test_slice(triangle, prepared, paths, number);
    }

    #[inline(always)]
    fn visit_merged_box(
        &mut self,
        ball: (Vec3<L::Real>, L::Real),
        thickness: L::Real,
        passing: impl FnOnce() -> L::Mask,
    ) -> u64 {
        let lanes = (self.active, passing);
        self.test
            .test_merged_box(ball, thickness, self.paths, lanes)
    }

    #[inline(always)]
    fn own_margin(&self) -> ThinMargin<L> {
        own_margin(self.test)
    }

    #[inline(always)]
    fn exclude_lanes(&mut self, merged_lanes: u64) {
        self.test.exclude_lanes(merged_lanes);
    }
}

#[inline(always)]
fn own_margin<L: SimdFloat>(test: &impl Test<L>) -> ThinMargin<L> {
    let zero = test.reach().like(L::Real::ZERO);
    test.own_margin().unwrap_or(ThinMargin {
        width: zero,
        spread: zero,
        max_thickness: zero,
        narrowing: zero,
        min_width: zero,
    })
}

#[inline(always)]
fn active_reach<L: SimdFloat>(active: L::Mask, test: &impl Test<L>) -> L {
    let reach = test.reach();
    L::select(active, reach, reach.like_f64(-1.0))
}

struct TestPrepared<'a, L, T> {
    paths: &'a Paths<L>,
    number: usize,
    test: &'a mut T,
}

impl<L: SimdFloat, T: Test<L>> WithPrepared<L> for TestPrepared<'_, L, T> {
    #[inline(always)]
    fn run<P: Primitive<L::Real>>(&mut self, primitive: &P, prepared: &P::Prepared<L>) {
        if P::IS_ENDLESS {
            return; // Endless primitives are in no tree.
        }
        self.test.test(primitive, prepared, self.paths, self.number);
    }
}
