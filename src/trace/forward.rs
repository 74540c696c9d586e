//! One depth of reflection on the way forward: what its packets can meet, and what they see.

use std::sync::Arc;

use super::beam::{Bounds, beam_around};
use super::bounce::Bounce;
use super::bundle::{Shaft, blur_margin};
use super::candidates::{Candidates, Targets};
use super::cull::Scratch;
use super::doubt::{DoubtScope, Uncertainty, is_filtered, max_hit_error, widest_blur};
use super::footprint::RayCone;
use super::intersect::Kernel;
use super::packet::{EdgeInfo, Packet, ReflectionParent};
use super::paths::{IgnoredPrimitive, Paths, real};
use super::samples::{EdgeDetail, Samples};
use super::shade::Shader;
use super::stats::Rays;
use super::thin_cull::may_pass_thin;
use super::thin_margin::ThinMargin;
use super::thresholds::THIN_WIDTH;
use super::walk::Stack;
use crate::plan::{CulledFaces, HitOrder, Plan, Show};
use crate::primitive::{Blur, CAUTION, Kind, Ray, roundings};
use crate::simd::{Mask as _, Real, SimdFloat};

/// Least number of packets for which entry points into the trees are computed: computing them costs about as much
/// as one packet's traversal. Most retraced samples come in two packets; with entry points for these, a mesh of
/// 100,000 faces takes 1.05 times as long.
const MIN_NARROWED_PACKETS: usize = 3;

impl<L: SimdFloat> Bounce<L> {
    /// Becomes the camera rays through the samples, which can meet what is in `candidates`.
    #[inline(always)]
    pub fn start<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        samples: &Samples<L::Real>,
        candidates: &Candidates,
        edges: EdgeDetail,
    ) {
        let (token, view) = (kernel.token, &kernel.plan.view);
        self.clear();
        self.order.clear();
        self.candidates.clone_from(candidates);
        let lane_number = L::from_fn(token, |lane| L::Real::from_f64(lane as f64));
        for first in (0..samples.x.len()).step_by(L::WIDTH) {
            let x = L::load(token, &samples.x[first..]);
            let y = L::load(token, &samples.y[first..]);
            let (origin, direction) = view.rays(x, y);
            let wanted = L::Real::from_f64((samples.count - first) as f64);
            let active = lane_number.less(lane_number.like(wanted));
            let rays = Ray { origin, direction };
            self.packets.push(Packet::new(kernel, rays, active));
        }
        self.edge_detail = edges;
        if self.doubt_scope::<TREE>(kernel.plan) != DoubtScope::Nothing {
            let uncertainty = Uncertainty::new(token, kernel.plan);
            self.uncertainties.resize(self.packets.len(), uncertainty);
        }
        if edges != EdgeDetail::Ignored {
            let (width, spread) = view.footprint();
            let cone = RayCone {
                width: L::splat(token, width),
                spread: L::splat(token, spread),
            };
            self.edges.resize(self.packets.len(), EdgeInfo::new(cone));
        }
    }

    /// What may be in doubt about the hits.
    ///
    /// For samples that search for an edge inside a pixel, only which of two surfaces a hair apart a camera ray hits,
    /// since they may swap places in whole pixels. Where rounding may decide what else they see, both sides of the
    /// edge are equally near: the pixel changes by one step of the finest grid, or by what remains of a cell that is
    /// not divided. In 1 scene of 30, this is more than one level, and at most 7, in one pixel or a few; doubting them
    /// would make meshes take 1.2 times as long, and a mirror with a mesh 1.4 times.
    #[inline(always)]
    fn doubt_scope<const TREE: bool>(&self, plan: &Plan<L::Real>) -> DoubtScope {
        let is_tied = !plan.ties.is_empty();
        if !is_filtered::<L, TREE>() {
            DoubtScope::Nothing
        } else if self.edge_detail != EdgeDetail::Signatures {
            DoubtScope::of(plan.is_doubted(), !is_tied)
        } else if plan.is_doubted() && !is_tied && self.parents.is_empty() {
            DoubtScope::Ties
        } else {
            DoubtScope::Nothing
        }
    }

    /// Returns whether things that may slip between samples are looked for.
    fn looks_for_thin(&self) -> bool {
        self.edge_detail == EdgeDetail::Thin
    }

    /// Returns the primitives on which the rays of a packet start.
    #[inline(always)]
    fn ignored_by<const TREE: bool>(
        &self,
        kernel: Kernel<L, TREE>,
        packet: usize,
    ) -> IgnoredPrimitive<L> {
        match (self.parents.get(packet), kernel.plan.eye_primitive) {
            (Some(parent), _) => parent.ignored,
            (None, None) => IgnoredPrimitive::nothing(kernel.token),
            (None, Some(number)) => {
                IgnoredPrimitive::listed(number, L::splat(kernel.token, real(number)))
            }
        }
    }

    /// For each mesh, the faces that the rays of the packets need not be tested against; empty for none.
    fn culled_faces<'p>(&self, plan: &'p Plan<L::Real>) -> &'p [Option<Arc<CulledFaces>>] {
        if self.parents.is_empty() {
            &plan.unseen_faces
        } else {
            &[]
        }
    }

    /// Finds what the packets hit, and what can cast shadows there. Returns whether anything is to be shaded.
    #[inline(always)]
    pub fn find_hits<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        scratch: &mut Scratch<L::Real>,
    ) -> bool {
        if self.candidates.is_empty() {
            return false;
        }
        let plan = kernel.plan;
        // Something thin may be next to rays that hit nothing.
        self.find_thin_candidates(plan);
        self.find_entry_points(kernel);
        let infinity = kernel.infinity();
        let mut bounds = Bounds::new(kernel.token);
        let mut farthest = kernel.splat(0.0);
        let none = Blur::splat(kernel.token, Blur::NONE);
        let culled_faces = self.culled_faces(plan);
        let scope = self.doubt_scope::<TREE>(plan);
        for index in 0..self.packets.len() {
            let ignored = self.ignored_by(kernel, index);
            let packet = &mut self.packets[index];
            let rays = packet.rays;
            let paths = Paths { rays, ignored };
            let targets = Targets {
                candidates: &self.candidates,
                entry_points: &self.entry_points,
                light: None,
                culled_faces,
            };
            let (active, stack) = (packet.active, &mut scratch.stack);
            let mut uncertainty = self.uncertainties.get_mut(index);
            let blur = uncertainty.as_ref().map_or(none, |rays| rays.blur);
            let doubt;
            (packet.nearest, doubt) = kernel.nearest(targets, (&paths, blur, scope), active, stack);
            if let Some(uncertainty) = &mut uncertainty {
                uncertainty.doubt = doubt;
            }
            let hit = packet.nearest.t.less(infinity) & active;
            bounds.add(hit, rays.at(packet.nearest.t));
            if TREE {
                farthest = L::select(hit, farthest.max(packet.nearest.t), farthest);
            }
        }
        let Some(mut ball) = bounds.ball() else {
            // If mirrors are shown, everything else becomes black, including the sky.
            return !self.thin.is_empty() || plan.show == Show::Mirrors;
        };
        let mut lift = L::Real::ZERO;
        if let Some((geometry, _)) = kernel.geometry() {
            // Rays go on from the curved surfaces that flat faces approximate.
            lift = geometry.lift * L::Real::from_f64(1.0 + CAUTION);
            ball.radius += lift.to_f64();
        }
        // Hits may be off, most of all on large things.
        let farthest = farthest.greatest();
        let hit_error = if self.uncertainties.is_empty() || scope == DoubtScope::Ties {
            L::Real::ZERO
        } else {
            let blur = widest_blur(kernel.token, &self.uncertainties);
            let largest_coordinate = bounds.bounding_box().max_abs();
            let size = plan.farthest + plan.farthest + plan.max_mesh_centre;
            max_hit_error(blur.at(farthest), largest_coordinate + size)
        };
        ball.radius += hit_error.to_f64();
        if plan.screen.is_some() {
            // Includes what shadow rays pass at less than a pixel's distance.
            let footprint = if self.looks_for_thin() {
                Some(self.max_footprint_length(kernel))
            } else {
                None
            };
            for (light_candidates, light) in self.lights.iter_mut().zip(&plan.lights) {
                kernel.gather_casters(light_candidates, light, (&ball, footprint), scratch);
            }
            if TREE && self.is_worth_narrowing() {
                // The hit of a long ray is off by a few roundings of its length.
                let hits = bounds
                    .bounding_box()
                    .widened(farthest * roundings() + lift + hit_error);
                for (light_candidates, light) in self.lights.iter_mut().zip(&plan.lights) {
                    kernel.find_shadow_entry_points(light_candidates, light, (&hits, footprint));
                }
            }
        }
        true
    }

    /// Returns whether there are enough packets to make entry points into the trees worthwhile.
    fn is_worth_narrowing(&self) -> bool {
        self.packets.len() >= MIN_NARROWED_PACKETS
    }

    /// Finds where the packets enter the trees, and whether something thin may slip between their rays there.
    #[inline(always)]
    fn find_entry_points<const TREE: bool>(&mut self, kernel: Kernel<L, TREE>) {
        self.entry_points.reset();
        let Some((geometry, _)) = kernel.geometry() else {
            return;
        };
        if !self.candidates.has_geometry || !kernel.plan.is_boxed || !self.is_worth_narrowing() {
            return;
        }
        let mut origins = Bounds::new(kernel.token);
        let mut directions = origins;
        for Packet { rays, active, .. } in &self.packets {
            origins.add(*active, rays.origin);
            directions.add(*active, rays.direction);
        }
        let (origins, directions) = (origins.bounding_box(), directions.bounding_box());
        let size = origins.max_abs() + geometry.bvh.bounds.max_abs();
        let blur = widest_blur(kernel.token, &self.uncertainties);
        let slack = size * roundings() + blur_margin(&blur, L::Real::ZERO, size);
        let shaft = Shaft::of(&origins.widened(slack), &directions);
        let infinity = L::Real::INFINITY;
        self.candidates.has_geometry =
            self.entry_points
                .narrow::<L>(kernel.token, geometry, &shaft, infinity);
        if self.thin.has_geometry {
            let (width, spread) = self.widest_cone(kernel);
            let margin = ThinMargin::new(width, spread);
            self.thin.has_geometry = may_pass_thin::<L>(kernel.token, geometry, &shaft, &margin);
        }
    }

    /// Finds what camera rays can meet, or just miss, between samples; nothing unless that is looked for. For
    /// mirrored rays, [`Self::find_candidates`] does this.
    fn find_thin_candidates(&mut self, plan: &Plan<L::Real>) {
        if !self.looks_for_thin() {
            self.thin.clear();
        } else if self.parents.is_empty() {
            let thin_width = L::Real::from_f64(THIN_WIDTH);
            self.thin
                .keep_narrow(&self.candidates, plan, |center, radius| {
                    plan.view.width_at(center, radius) * thin_width
                });
        }
    }

    /// Greatest width of a pixel where the rays start, and its greatest growth per unit of distance; zero without
    /// edges.
    #[inline(always)]
    fn widest_cone<const TREE: bool>(&self, kernel: Kernel<L, TREE>) -> (L::Real, L::Real) {
        let (mut width, mut spread) = (kernel.splat(0.0), kernel.splat(0.0));
        for (edge, packet) in self.edges.iter().zip(&self.packets) {
            width = L::select(packet.active, width.max(edge.cone.width), width);
            spread = L::select(packet.active, spread.max(edge.cone.spread), spread);
        }
        (width.greatest(), spread.greatest())
    }

    /// Greatest length of a pixel's footprint on what was hit; zero without edges.
    #[inline(always)]
    fn max_footprint_length<const TREE: bool>(&self, kernel: Kernel<L, TREE>) -> L::Real {
        let mut max_footprint_length = kernel.splat(0.0);
        for (edge, packet) in self.edges.iter().zip(&self.packets) {
            let hit = packet.nearest.t.less(kernel.infinity()) & packet.active;
            let width = edge.cone.width_at(packet.nearest.t);
            let hits = (hit, packet.rays.direction, width);
            max_footprint_length =
                max_footprint_length.max(kernel.max_length_on(packet.nearest.number, hits));
        }
        max_footprint_length.greatest() * L::Real::from_f64(1.0 + CAUTION)
    }

    /// Shades the packets; adds the rays that mirrors send on to `next`.
    #[inline(always)]
    pub fn shade<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        may_mirror: bool,
        next: &mut Self,
        (stack, rays): (&mut Stack<L::Real>, &mut Rays),
    ) {
        let looks_for_thin = self.looks_for_thin();
        let doubts_colors = self.doubt_scope::<TREE>(kernel.plan) != DoubtScope::Ties;
        let has_gaps =
            self.edge_detail >= EdgeDetail::Borders && kernel.may_leave_gaps(&self.lights);
        for index in 0..self.packets.len() {
            let ignored = self.ignored_by(kernel, index);
            let shader = Shader {
                kernel,
                is_first: self.parents.is_empty(),
                may_mirror,
                looks_for_thin,
                thin: &self.thin,
                lights: &self.lights,
                gap_lights: has_gaps.then_some(&self.lights),
            };
            let uncertainty = self.uncertainties.get_mut(index);
            let uncertainty = uncertainty.filter(|_| doubts_colors);
            let notes = (self.edges.get_mut(index), uncertainty);
            let packet = &mut self.packets[index];
            let Some(mirrored) =
                shader.shade(packet, (ignored, notes), &mut self.mixed, (stack, rays))
            else {
                continue;
            };
            rays.reflected += u64::from(mirrored.active.bits().count_ones());
            let paths = mirrored.paths;
            next.packets
                .push(Packet::new(kernel, paths.rays, mirrored.active));
            let uncertainty = self.uncertainties.get(index).filter(|_| doubts_colors);
            next.uncertainties
                .extend(uncertainty.map(Uncertainty::of_mirrored));
            next.parents.push(ReflectionParent {
                packet: index,
                ignored: paths.ignored,
                filter: mirrored.filter,
            });
            if let Some(cone) = mirrored.cone {
                next.edges.push(EdgeInfo::new(cone));
            }
        }
    }

    /// Finds what mirrored rays can meet.
    #[inline(always)]
    pub fn find_candidates<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        scratch: &mut Scratch<L::Real>,
    ) {
        let plan = kernel.plan;
        let rays = self
            .packets
            .iter()
            .map(|packet| (packet.active, packet.rays));
        let blur = widest_blur(kernel.token, &self.uncertainties);
        let beam = if plan.screen.is_some() {
            beam_around(kernel.token, rays)
        } else {
            None
        };
        let Some(beam) = beam.and_then(|beam| beam.widened(blur.start, blur.spread)) else {
            self.candidates = Candidates::all(plan);
            self.thin.clone_from(&self.candidates);
            return;
        };
        let start_plane = self.start_plane(plan);
        if !self.looks_for_thin() {
            return kernel.gather_met(&mut self.candidates, &beam, start_plane, scratch);
        }
        let (width, spread) = self.widest_cone(kernel);
        // Includes what the rays pass at less than a pixel's distance.
        let wide = beam.widened(width, spread);
        kernel.gather_met(
            &mut self.candidates,
            wide.as_ref().unwrap_or(&beam),
            start_plane,
            scratch,
        );
        let thin_width = |center, radius| {
            let width = width + spread * beam.distance(center, radius);
            width * L::Real::from_f64(THIN_WIDTH)
        };
        if wide.is_some() {
            self.thin.keep_narrow(&self.candidates, plan, thin_width);
        } else {
            self.thin
                .keep_narrow(&Candidates::all(plan), plan, thin_width);
        }
    }

    /// The plane on which all rays start, if there is one.
    fn start_plane(&self, plan: &Plan<L::Real>) -> Option<usize> {
        let first = self.parents.first()?.ignored.shared()?;
        let mut parents = self.parents.iter();
        let is_shared = parents.all(|parent| parent.ignored.shared() == Some(first));
        let plane = first.checked_sub(plan.primitives.firsts()[Kind::Plane as usize])?;
        (is_shared && plane < plan.primitives.planes.len()).then_some(plane)
    }

    /// Regroups nearby hits into the same packets, if the plan asks for it.
    #[inline(always)]
    pub fn regroup_hits<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        samples: &Samples<L::Real>,
    ) {
        if TREE && kernel.plan.hit_order == HitOrder::ByPosition {
            let packets = (&mut self.packets[..], &mut self.uncertainties[..]);
            self.order.regroup_hits(kernel, packets, samples);
        }
    }
}
