//! Shadows that hits are in and that end nearby: between two of these, there may be light or none. Where those of meshes
//! end is not known: all of them count.

use super::candidates::Targets;
use super::cull::LightCandidates;
use super::footprint::Footprint;
use super::hit_material::HitMaterial;
use super::intersect::Kernel;
use super::outcome::component_of;
use super::paths::Paths;
use super::scan::{Test, scan_lists};
use super::shadows::{mark_of, weight_of};
use super::surface::Hit;
use super::walk::Stack;
use crate::plan::Plan;
use crate::primitive::{Blur, Primitive};
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Returns whether there may be gaps between two shadows, of one light or of two.
    ///
    /// Not inlined: inside the kernel, it makes the demo, which asks in few tiles, slower by a twelfth.
    #[inline(never)]
    pub fn may_leave_gaps(self, lights: &[LightCandidates]) -> bool {
        let mut shadows = 0;
        for (light, candidates) in lights.iter().enumerate() {
            if weight_of(light).is_none() || 1 < shadows {
                break;
            }
            shadows += candidates.casters.outline_count(self.plan);
        }
        1 < shadows
    }

    /// Returns the marks of the casters, see [`super::shadows`], in whose shadows hits of this material are; `lit`
    /// says which lights shine there. Tiles leave out different casters, but the marks are the same in all of them.
    ///
    /// Not inlined: few packets need it, and the others are faster without.
    #[inline(never)]
    pub fn shadows_at(
        self,
        lights: &[LightCandidates],
        (hit, footprint): (&Hit<L>, &Footprint<L>),
        (material, view): (HitMaterial<L>, Vec3<L>),
        lit: L,
        stack: &mut Stack<L::Real>,
    ) -> L {
        L::vectorize(
            self.token,
            #[inline(always)]
            || {
                let mut shadows = self.splat(0.0);
                for (index, candidates) in lights.iter().enumerate() {
                    let Some(weight) = weight_of(index) else {
                        break;
                    };
                    let unlit = hit.lanes & !self.is_lit(lit, index);
                    if !unlit.any() || candidates.casters.outline_count(self.plan) == 0 {
                        continue;
                    }
                    let light = &self.plan.lights[index];
                    let to_light = hit.surface.point.like(light.position) - hit.surface.point;
                    let distance = to_light.length();
                    let direction = to_light * (self.splat(1.0) / distance);
                    // If the light itself is too faint to be seen there, its shadow is not visible.
                    let normal = hit.surface.normal;
                    let cosine = normal.dot(direction);
                    let vectors = (cosine, normal, direction - view);
                    let facing = self.splat(0.0).less(cosine);
                    let dark_lanes = unlit & facing & material.shows(self.plan, light, vectors);
                    if !dark_lanes.any() {
                        continue;
                    }
                    let (paths, distance) = self.towards(hit, light, (direction, distance));
                    let targets = Targets {
                        candidates: &candidates.casters,
                        entry_points: &candidates.entry_points,
                        light: None,
                        culled_faces: &light.culled_faces,
                    };
                    let test = DepthTest {
                        plan: self.plan,
                        first_of_meshes: self.plan.first_of_meshes(),
                        distance,
                        full_depth: footprint.full_shadow_depth(),
                        open_lanes: dark_lanes,
                        deepest: self.splat(0.0),
                        caster: self.splat(0.0),
                    };
                    let caster = self.deepest(targets, &paths, test, stack);
                    shadows = shadows + caster * self.splat(weight);
                }
                shadows
            },
        )
    }

    /// Returns where a light shines, given the sums of the bits of all lights that do.
    #[inline(always)]
    fn is_lit(self, lit: L, light: usize) -> L::Mask {
        let mut sums = [L::Real::ZERO; MAX_LANES];
        lit.store(&mut sums);
        for sum in &mut sums[..L::WIDTH] {
            *sum = L::Real::from_f64(f64::from(sum.nearest() >> light & 1));
        }
        self.splat(0.0).less(L::load(self.token, &sums))
    }

    /// Returns the mark of the caster inside whose outline the paths pass deepest; 0 where a caster hides the
    /// whole pixel, or there is none.
    #[inline(always)]
    fn deepest(
        self,
        targets: Targets<L::Real>,
        paths: &Paths<L>,
        mut test: DepthTest<L>,
        stack: &mut Stack<L::Real>,
    ) -> L {
        scan_lists(self.plan, targets.candidates, paths, &mut test);
        let exact = Blur::splat(self.token, Blur::NONE);
        if test.open_lanes.any()
            && let Some(tree_scan) = self.tree_scan(targets, (test.open_lanes, exact))
        {
            tree_scan.scan(paths, stack, &mut test);
        }
        L::select(test.open_lanes, test.caster, self.splat(0.0))
    }
}

/// Looks for the caster inside whose outline the paths pass deepest.
struct DepthTest<'a, L: SimdFloat> {
    plan: &'a Plan<L::Real>,
    /// Number of the first face of a mesh.
    first_of_meshes: usize,
    /// Length of the paths.
    distance: L,
    /// Depth inside an outline beyond which the caster hides the whole pixel.
    full_depth: L,
    /// Where nothing was found yet that hides the whole pixel.
    open_lanes: L::Mask,
    /// Greatest depth of the paths inside an outline so far, and the mark of that caster.
    deepest: L,
    caster: L,
}

impl<L: SimdFloat> Test<L> for DepthTest<'_, L> {
    #[inline(always)]
    fn reach(&self) -> L {
        L::select(self.open_lanes, self.distance, self.distance.like_f64(-1.0))
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        !self.open_lanes.any()
    }

    #[inline(always)]
    fn test<P: Primitive<L::Real>>(
        &mut self,
        primitive: &P,
        prepared: &P::Prepared<L>,
        paths: &Paths<L>,
        number: usize,
    ) {
        let t = paths.distance::<false, P>(primitive, prepared, number, &self.plan.methods);
        let is_met = self.open_lanes & t.less(self.distance);
        if !is_met.any() {
            return;
        }
        let (depth, caster) = match depth(primitive, prepared, paths) {
            Some(depth) => (depth, number),
            // No face knows how far it is to the outline of a mesh. Of several meshes, the one with the least mark
            // counts, so that marks change only along its outline.
            None if self.first_of_meshes <= number => {
                let outermost = self.distance.like_f64(0.0);
                (outermost, component_of(self.plan, number))
            }
            None => {
                self.open_lanes = self.open_lanes & !is_met;
                return;
            }
        };
        let mark = depth.like_f64(mark_of(caster));
        let is_first = self.caster.less(depth.like(L::Real::ONE));
        let is_equal = depth.same(self.deepest) & mark.less(self.caster);
        let deeper = is_met & (is_first | self.deepest.less(depth) | is_equal);
        self.deepest = L::select(deeper, depth, self.deepest);
        self.caster = L::select(deeper, mark, self.caster);
        self.open_lanes = self.open_lanes & !(is_met & self.full_depth.less(depth));
    }
}

/// Depth inside the outline of a primitive of the paths that hit it, in scene units; `None` if the primitive has no
/// outline of its own.
#[inline(always)]
fn depth<L: SimdFloat, P: Primitive<L::Real>>(
    primitive: &P,
    prepared: &P::Prepared<L>,
    paths: &Paths<L>,
) -> Option<L> {
    if !primitive.has_outline() {
        return None;
    }
    let approach = primitive.approach(
        &paths.rays,
        prepared,
        #[inline(always)]
        |_| true,
    )?;
    Some(-approach.distance)
}
