//! Culling of primitives before any ray is tested: planes that a tile does not see, primitives that its mirrors
//! cannot show, and those that cannot cast a shadow into it.

use glam::DVec3;

use super::beam::Beam;
use super::bundle::Shaft;
use super::candidates::Candidates;
use super::entry_points::EntryPoints;
use super::intersect::Kernel;
use super::thin_cull::may_pass_thin;
use super::thin_margin::ThinMargin;
use super::thresholds::THIN_WIDTH;
use super::tile::Tile;
use super::walk::Stack;
use crate::plan::{Plan, PointLight, RayOrigin};
use crate::primitive::{Ball, BoundingBox, FAR_CAUTION, Kind, Primitive as _};
use crate::simd::{Real, SimdFloat};

/// Scratch memory for gathering candidates, reused for every beam.
#[derive(Debug, Default)]
pub struct Scratch<R> {
    /// Boxes of a tree that are still to be visited.
    pub stack: Stack<R>,
    met: Vec<u32>,
}

/// What can block a light on the way to the hits of a tile.
#[derive(Clone, Debug, Default)]
pub struct LightCandidates {
    /// Candidates that may block the light for some of the hits.
    pub casters: Candidates,
    /// Where the shadow rays enter the trees.
    pub entry_points: EntryPoints,
    /// Candidates whose shadows may slip between samples.
    pub thin: Candidates,
    /// Whether a single primitive blocks the light for all hits.
    pub is_umbra: bool,
}

impl Candidates {
    /// Becomes the candidates of `from` that may slip between samples if pixels are `footprint` wide; empty without
    /// a footprint.
    fn keep_thin<R: Real>(&mut self, from: &Self, plan: &Plan<R>, footprint: Option<R>) {
        match footprint {
            None => self.clear(),
            Some(width) => {
                let thin_width = width * R::from_f64(THIN_WIDTH);
                self.keep_narrow(from, plan, |_, _| thin_width);
            }
        }
    }

    /// Returns whether one of the spheres alone hides all of `ball` from a light.
    fn hold_umbra<R: Real>(&self, plan: &Plan<R>, light: DVec3, ball: &Ball) -> bool {
        let spheres = self.of(Kind::Sphere).iter();
        let mut spheres = spheres.map(|&index| &plan.primitives.spheres[index as usize]);
        spheres.any(|sphere| sphere.ball().is_some_and(|own| own.hides(light, ball)))
    }

    /// Removes the planes that the rays of a tile pass by or leave behind.
    ///
    /// Height above the plane and speed towards it change linearly along a row or column, so that no signs occur
    /// but those at the corners.
    pub fn drop_unseen_planes<R: Real>(&mut self, plan: &Plan<R>, tile: &Tile) {
        let edge = |index: usize| R::from_f64(index as f64);
        let (left, right) = (edge(tile.columns.start), edge(tile.columns.end));
        let (top, bottom) = (edge(tile.rows.start), edge(tile.rows.end));
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let corners = corners.map(|(x, y)| plan.view.rays(x, y));
        let tolerance = R::from_f64(FAR_CAUTION);
        self.planes_mut().retain(|&index| {
            let plane = &plan.primitives.planes[index as usize];
            corners.iter().any(|(origin, direction)| {
                let height = plane.offset - plane.normal.dot(*origin);
                let speed = plane.normal.dot(*direction);
                let is_near = height.abs() <= tolerance * (origin.max_abs() + plane.offset.abs());
                is_near || speed.abs() <= tolerance || (height > R::ZERO) == (speed > R::ZERO)
            })
        });
    }
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// `candidates` becomes what rays of the beam can meet, markers included, except a plane on which all of them
    /// start.
    #[inline(always)]
    pub fn gather_met(
        self,
        candidates: &mut Candidates,
        beam: &Beam<L::Real>,
        start_plane: Option<usize>,
        scratch: &mut Scratch<L::Real>,
    ) {
        let plan = self.plan;
        beam.gather::<L>(self.token, (&plan.balls, 0), &mut scratch.met);
        candidates.sort_by_kind(plan, &scratch.met);
        candidates.has_geometry = plan.geometry.is_some();
        for (index, plane) in plan.primitives.planes.iter().enumerate() {
            if start_plane != Some(index) && beam.crosses(plane.normal, plane.offset) {
                candidates.planes_mut().push(index as u32);
            }
        }
    }

    /// `candidates` becomes what can block a light for any point of a ball or within `footprint` of it; without a
    /// footprint, nothing thin is listed.
    #[inline(always)]
    pub fn gather_casters(
        self,
        candidates: &mut LightCandidates,
        light: &PointLight<L::Real>,
        (ball, footprint): (&Ball, Option<L::Real>),
        scratch: &mut Scratch<L::Real>,
    ) {
        let plan = self.plan;
        let LightCandidates {
            casters,
            entry_points,
            thin,
            is_umbra,
        } = candidates;
        entry_points.reset();
        let from = light.position.to_dvec3();
        let margin = footprint.unwrap_or(L::Real::ZERO);
        let beam = Beam::to_ball(from, ball);
        let Some(beam) = beam.and_then(|beam| beam.widened(margin, L::Real::ZERO)) else {
            *casters = Candidates::all_casting(plan, light);
            thin.keep_thin(casters, plan, footprint);
            *is_umbra = false;
            return;
        };
        // The first balls are those of the markers.
        beam.gather::<L>(self.token, (&plan.balls, plan.markers), &mut scratch.met);
        casters.sort_by_kind(plan, &scratch.met);
        casters.leave_out_markers(plan);
        casters.leave_out_faces(&light.shadow_culled_faces);
        casters.has_geometry = plan.geometry.is_some();
        if plan.planes_cast {
            let planes = 0..plan.primitives.planes.len() as u32;
            casters.planes_mut().extend(planes);
        }
        casters.leave_out(plan, &light.holders);
        thin.keep_thin(casters, plan, footprint);
        *is_umbra = casters.hold_umbra(plan, from, ball);
    }
}

impl<L: SimdFloat, const TREE: bool> Kernel<'_, L, TREE> {
    /// Finds where shadow rays from these hits to a light enter the trees, and whether something thin may slip
    /// between samples there if pixels are as wide as `footprint`. Does nothing unless the plan starts rays at the
    /// hits, since otherwise they may start anywhere.
    #[inline(always)]
    pub fn find_shadow_entry_points(
        self,
        candidates: &mut LightCandidates,
        light: &PointLight<L::Real>,
        (hits, footprint): (&BoundingBox<L::Real>, Option<L::Real>),
    ) {
        let plan = self.plan;
        let Some((geometry, _)) = self.geometry() else {
            return;
        };
        let is_at_hits = matches!(plan.ray_origin, RayOrigin::AtHit);
        if !candidates.casters.has_geometry || !plan.is_boxed || !is_at_hits {
            return;
        }
        let caution = L::Real::from_f64(FAR_CAUTION);
        let reach = geometry.bvh.bounds.max_abs();
        // Parametrised from 0 to 1: from the light to the hits or, for a distant light, from the hits to the light.
        let shaft = if let Some(apex) = light.apex(geometry) {
            let slack = (hits.max_abs() + reach.max(apex.max_abs())) * caution;
            let ends = hits.widened(slack);
            let directions = BoundingBox {
                low: ends.low - apex,
                high: ends.high - apex,
            };
            Shaft::of(&BoundingBox::around(&[apex]).widened(slack), &directions)
        } else {
            let starts = hits.widened((hits.max_abs() + reach) * caution);
            let directions = BoundingBox {
                low: light.position - starts.high,
                high: light.position - starts.low,
            };
            Shaft::of(&starts, &directions)
        };
        let end = L::Real::ONE + caution;
        candidates.casters.has_geometry = candidates
            .entry_points
            .narrow::<L>(self.token, geometry, &shaft, end);
        if let Some(width) = footprint.filter(|_| candidates.thin.has_geometry) {
            let margin = ThinMargin::new(width, L::Real::ZERO);
            candidates.thin.has_geometry =
                may_pass_thin::<L>(self.token, geometry, &shaft, &margin);
        }
    }
}
