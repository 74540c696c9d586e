//! The primitives that rays are tested against.

use std::ops::Range;
use std::sync::Arc;

use super::entry_points::EntryPoints;
use crate::plan::{CulledFaces, Plan, PointLight};
use crate::primitive::{Extent, KINDS, Kind, Primitive, Rectangle, Visit};
use crate::simd::{Real, Vec3};

/// The primitives that are worth testing.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// For each kind, indices into the plan's primitives of that kind.
    lists: [Vec<u32>; KINDS],
    /// Whether the plan's geometry is to be tested as well.
    pub has_geometry: bool,
}

/// What rays are tested against: lists of primitives, and trees from their entry points on.
#[derive(Clone, Copy, Debug)]
pub struct Targets<'a, R> {
    /// The listed primitives, and whether the trees are tested at all.
    pub candidates: &'a Candidates,
    /// Where the rays enter the trees.
    pub entry_points: &'a EntryPoints,
    /// The light that shadow rays go to, if boxes may be tested along the paths from there.
    pub light: Option<&'a PointLight<R>>,
    /// For each mesh, the faces to skip, if there are any.
    pub culled_faces: &'a [Option<Arc<CulledFaces>>],
}

impl Candidates {
    /// Everything, markers included.
    pub fn all<R: Real>(plan: &Plan<R>) -> Self {
        Self {
            lists: plan
                .primitives
                .counts()
                .map(|count| (0..count as u32).collect()),
            has_geometry: plan.geometry.is_some(),
        }
    }

    /// Everything that camera rays may hit.
    pub fn all_seen<R: Real>(plan: &Plan<R>) -> Self {
        let mut all = Self::all(plan);
        all.leave_out_faces(&plan.camera_culled_faces);
        all.leave_out(plan, &plan.edge_on);
        all
    }

    /// Everything that may cast shadows from a light.
    pub fn all_casting<R: Real>(plan: &Plan<R>, light: &PointLight<R>) -> Self {
        // Each thread has such a list per light, so no list should have capacity for primitives that are not in it.
        let mut kinds = plan.primitives.counts().map(|count| 0..count as u32);
        kinds[Kind::Sphere as usize].start = plan.markers as u32;
        if !plan.planes_cast {
            kinds[Kind::Plane as usize] = 0..0;
        }
        let mut all = Self {
            lists: kinds.map(Iterator::collect),
            has_geometry: plan.geometry.is_some(),
        };
        all.leave_out(plan, &light.holders);
        all
    }

    /// Removes the primitives with these numbers.
    pub fn leave_out<R: Real>(&mut self, plan: &Plan<R>, numbers: &[usize]) {
        if numbers.is_empty() {
            return;
        }
        for (list, first) in self.lists.iter_mut().zip(plan.primitives.firsts()) {
            list.retain(|&index| !numbers.contains(&(first + index as usize)));
        }
    }

    /// Removes the triangles whose flag is set.
    pub fn leave_out_faces(&mut self, flags: &[bool]) {
        let is_set = |index: u32| flags.get(index as usize) == Some(&true);
        self.lists[Kind::Triangle as usize].retain(|&index| !is_set(index));
    }

    /// Removes the markers of lights, which are the first spheres.
    pub fn leave_out_markers<R: Real>(&mut self, plan: &Plan<R>) {
        let is_marker = |index: u32| (index as usize) < plan.markers;
        self.lists[Kind::Sphere as usize].retain(|&index| !is_marker(index));
    }

    /// The indices of one kind.
    #[inline(always)]
    pub fn of(&self, kind: Kind) -> &[u32] {
        &self.lists[kind as usize]
    }

    /// The indices of the planes, for changes.
    pub fn planes_mut(&mut self) -> &mut Vec<u32> {
        &mut self.lists[Kind::Plane as usize]
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        for list in &mut self.lists {
            list.clear();
        }
        self.has_geometry = false;
    }

    /// Returns whether there is nothing to test.
    pub fn is_empty(&self) -> bool {
        !self.has_geometry && self.lists.iter().all(Vec::is_empty)
    }

    /// Returns how many candidates may have outlines of their own, see [`Primitive::has_outline`], or are meshes: 0, 1,
    /// or 2 for two or more.
    pub fn outline_count<R: Real>(&self, plan: &Plan<R>) -> usize {
        let all = &plan.primitives.triangles;
        let triangles = self.of(Kind::Triangle).iter();
        let loose = triangles.filter(|&&index| all[index as usize].has_outline());
        let round = self.of(Kind::Sphere).len() + self.of(Kind::Disc).len();
        let in_tree = plan.geometry.as_ref().filter(|_| self.has_geometry);
        if in_tree.is_some_and(|geometry| geometry.is_of_several()) {
            return 2;
        }
        (round + loose.take(2).count()).min(2)
    }

    /// Becomes the candidates of `from` that can be seen in these rows or columns of pixels, whichever `extent` takes
    /// of a rectangle on the screen.
    pub fn keep_seen<R: Real>(
        &mut self,
        from: &Self,
        plan: &Plan<R>,
        pixels: &Range<usize>,
        extent: fn(&Rectangle) -> Extent,
    ) {
        let Some(screen) = &plan.screen else {
            return self.clone_from(from);
        };
        let meets = |rectangle: &Rectangle| extent(rectangle).meets(pixels);
        for ((list, from), rectangles) in self.lists.iter_mut().zip(&from.lists).zip(screen) {
            list.clear();
            // Endless primitives have no rectangles.
            if rectangles.is_empty() {
                list.extend_from_slice(from);
            } else {
                let seen = from
                    .iter()
                    .filter(|&&index| meets(&rectangles[index as usize]));
                list.extend(seen);
            }
        }
        self.has_geometry =
            from.has_geometry && (plan.outline.is_empty() || plan.outline.iter().any(meets));
    }

    /// Becomes the candidates of `from` that are thinner than `width`, which is called with a point of the
    /// primitive and how far it reaches from there.
    pub fn keep_narrow<R: Real>(
        &mut self,
        from: &Self,
        plan: &Plan<R>,
        width: impl Fn(Vec3<R>, R) -> R,
    ) {
        self.has_geometry = from.has_geometry
            && plan.geometry.as_ref().is_some_and(|geometry| {
                let (at, reach) = geometry.bvh.bounds.ball();
                geometry.bvh.thinnest < width(at, reach)
            });
        plan.primitives.visit(&mut NarrowFilter {
            from,
            to: self,
            width,
        });
    }

    /// Becomes the primitives in these balls of the plan, sorted by kind; no geometry.
    pub fn sort_by_kind<R: Real>(&mut self, plan: &Plan<R>, balls: &[u32]) {
        self.clear();
        for &ball in balls {
            let (kind, index) = plan.balls.primitives[ball as usize];
            self.lists[kind as usize].push(index);
        }
    }
}

struct NarrowFilter<'a, W> {
    from: &'a Candidates,
    to: &'a mut Candidates,
    width: W,
}

impl<R: Real, W: Fn(Vec3<R>, R) -> R> Visit<R> for NarrowFilter<'_, W> {
    fn visit<P: Primitive<R>>(&mut self, kind: Kind, primitives: &[P], _first: usize) {
        let narrow = self.from.of(kind).iter().filter(|&&index| {
            let primitive = &primitives[index as usize];
            let (at, reach) = primitive.reach();
            primitive.thickness() < (self.width)(at, reach)
        });
        let list = &mut self.to.lists[kind as usize];
        list.clear();
        list.extend(narrow);
    }
}
