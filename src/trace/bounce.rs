//! One depth of reflection: the packets of a tile, what they can meet, and what they see.

use super::beam::{Bounds, beam_around};
use super::bundle::Shaft;
use super::candidates::{Among, Candidates};
use super::cull::{LightCandidates, Scratch};
use super::footprint::RayCone;
use super::intersect::Kernel;
use super::order::Order;
use super::outcome::{clamped, signatures_of, store};
use super::packet::{EdgeInfo, Packet, ReflectionParent};
use super::parts::Parts;
use super::paths::{IgnoredPrimitive, Paths, real};
use super::roots::Roots;
use super::samples::{Edges, Samples, Traced};
use super::shade::Shader;
use super::stats::Rays;
use super::thin::widest_spread;
use super::thresholds::{LARGEST_STRETCH, SLIPPING};
use super::walk::Stack;
use crate::plan::{HitOrder, Plan};
use crate::primitive::{CAUTION, Kind, Ray, roundings};
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

/// One bounce: its packets, and what they can meet.
pub struct Bounce<L: SimdFloat> {
    packets: Vec<Packet<L>>,
    /// One for each packet, in bounces of mirrored rays.
    parents: Vec<ReflectionParent<L>>,
    /// What is found out about edges.
    pub edges_are: Edges,
    /// One for each packet, where edges are noted.
    edges: Vec<EdgeInfo<L>>,
    /// What the rays can meet.
    seen: Candidates,
    /// Where to start in the trees.
    roots: Roots<L::Real>,
    /// Those of them that may slip between samples.
    thin: Candidates,
    lights: Vec<LightCandidates<L::Real>>,
    signatures: Vec<[u32; MAX_LANES]>,
    /// Which of the samples the rays are, if they were put in another order.
    order: Order<L::Real>,
    /// Memory for the materials of a packet.
    parts: Parts<L>,
}

impl<L: SimdFloat> Bounce<L> {
    /// A bounce without packets.
    pub fn new(plan: &Plan<L::Real>) -> Self {
        let candidates_of = |light| {
            let casters = Candidates::all_casting(plan, light);
            // Without culling nobody looks for the narrow ones among them.
            let thin = match plan.screen {
                Some(_) => Candidates::default(),
                None => casters.clone(),
            };
            LightCandidates {
                casters,
                roots: Roots::default(),
                thin,
                is_umbra: false,
            }
        };
        Self {
            packets: Vec::new(),
            parents: Vec::new(),
            edges_are: Edges::Ignored,
            edges: Vec::new(),
            seen: Candidates::default(),
            roots: Roots::default(),
            thin: Candidates::default(),
            lights: plan.lights.iter().map(candidates_of).collect(),
            signatures: Vec::new(),
            order: Order::default(),
            parts: Parts::new(),
        }
    }

    /// Forgets the packets.
    pub fn clear(&mut self) {
        self.packets.clear();
        self.parents.clear();
        self.edges.clear();
    }

    /// Whether there are no packets.
    pub fn is_empty(&self) -> bool {
        self.packets.is_empty()
    }

    /// Becomes the rays from the camera through the samples, which can meet what is in `seen`.
    #[inline(always)]
    pub fn start<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        samples: &Samples<L::Real>,
        seen: &Candidates,
        edges: Edges,
    ) {
        let (token, view) = (kernel.token, &kernel.plan.view);
        self.clear();
        self.order.clear();
        self.seen.clone_from(seen);
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
        self.edges_are = edges;
        if edges != Edges::Ignored {
            let (width, spread) = view.footprint();
            let cone = RayCone {
                width: L::splat(token, width),
                spread: L::splat(token, spread),
            };
            self.edges.resize(self.packets.len(), EdgeInfo::new(cone));
        }
    }

    /// Whether what may slip between samples is looked for.
    fn looks_beside(&self) -> bool {
        self.edges_are == Edges::Near
    }

    /// What the rays of a packet start on.
    #[inline(always)]
    fn ignored_by<const TREE: bool>(
        &self,
        kernel: Kernel<L, TREE>,
        packet: usize,
    ) -> IgnoredPrimitive<L> {
        match (self.parents.get(packet), kernel.plan.eye_on) {
            (Some(parent), _) => parent.ignored,
            (None, None) => IgnoredPrimitive::nothing(kernel.token),
            (None, Some(number)) => {
                IgnoredPrimitive::listed(number, L::splat(kernel.token, real(number)))
            }
        }
    }

    /// Finds what the packets meet, and what can cast shadows there. Whether there is anything.
    #[inline(always)]
    pub fn find<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        scratch: &mut Scratch<L::Real>,
    ) -> bool {
        if self.seen.is_empty() {
            return false;
        }
        let plan = kernel.plan;
        // What is thin beside the rays may be there where they meet nothing.
        self.find_thin(plan);
        self.enter(kernel);
        let infinity = kernel.infinity();
        let mut bounds = Bounds::new(kernel.token);
        let mut farthest = kernel.splat(0.0);
        for index in 0..self.packets.len() {
            let ignored = self.ignored_by(kernel, index);
            let packet = &mut self.packets[index];
            let rays = packet.rays;
            let paths = Paths { rays, ignored };
            let among = Among {
                candidates: &self.seen,
                roots: &self.roots,
                light: None,
            };
            packet.near = kernel.nearest(among, &paths, packet.active, &mut scratch.stack);
            let hit = packet.near.t.less(infinity) & packet.active;
            bounds.add(hit, rays.at(packet.near.t));
            if TREE {
                farthest = L::select(hit, farthest.max(packet.near.t), farthest);
            }
        }
        let Some(mut ball) = bounds.ball() else {
            return !self.thin.is_empty();
        };
        let mut lift = L::Real::ZERO;
        if let Some((geometry, _)) = kernel.geometry() {
            // Rays go on from the curved surfaces that flat faces stand for.
            lift = geometry.lift * L::Real::from_f64(1.0 + CAUTION);
            ball.radius += lift.to_f64();
        }
        if plan.screen.is_some() {
            // Room for what passes beside the rays to the lights, closer than a pixel.
            let footprint = self
                .looks_beside()
                .then(|| self.widest(kernel) * L::Real::from_f64(LARGEST_STRETCH));
            for (between, light) in self.lights.iter_mut().zip(&plan.lights) {
                kernel.keep_between(between, light, (&ball, footprint), scratch);
            }
            if TREE {
                // A ray that has come far is off by a few roundings of its length.
                let hits = bounds
                    .around()
                    .widened(farthest.greatest() * roundings() + lift);
                for (between, light) in self.lights.iter_mut().zip(&plan.lights) {
                    kernel.enter_towards(between, light, &hits);
                }
            }
        }
        true
    }

    /// Finds where the packets can start to look into the trees.
    #[inline(always)]
    fn enter<const TREE: bool>(&mut self, kernel: Kernel<L, TREE>) {
        self.roots.forget();
        let plan = kernel.plan;
        let Some((geometry, _)) = kernel.geometry() else {
            return;
        };
        if !self.seen.has_geometry || !plan.is_boxed {
            return;
        }
        let mut origins = Bounds::new(kernel.token);
        let mut directions = origins;
        for Packet { rays, active, .. } in &self.packets {
            origins.add(*active, rays.origin);
            directions.add(*active, rays.direction);
        }
        let (origins, directions) = (origins.around(), directions.around());
        let slack = (origins.max_abs() + geometry.bvh.bounds.max_abs()) * roundings();
        let shaft = Shaft::of(&origins.widened(slack), &directions);
        let infinity = L::Real::INFINITY;
        self.seen.has_geometry = self
            .roots
            .narrow::<L>(kernel.token, geometry, &shaft, infinity);
    }

    /// Finds what rays from the camera can meet, or just miss, between samples; nothing without
    /// edges. For mirrored rays, [`Self::aim`] knows.
    fn find_thin(&mut self, plan: &Plan<L::Real>) {
        if !self.looks_beside() {
            self.thin.clear();
        } else if self.parents.is_empty() {
            let slipping = L::Real::from_f64(SLIPPING);
            self.thin.keep_narrow(&self.seen, plan, |center, radius| {
                plan.view.width_at(center, radius) * slipping
            });
        }
    }

    /// The widest pixel at what was hit; zero without edges.
    #[inline(always)]
    fn widest<const TREE: bool>(&self, kernel: Kernel<L, TREE>) -> L::Real {
        let mut widest = kernel.splat(0.0);
        for (edge, packet) in self.edges.iter().zip(&self.packets) {
            let hit = packet.near.t.less(kernel.infinity()) & packet.active;
            let width = edge.cone.width_at(packet.near.t);
            widest = L::select(hit, widest.max(width), widest);
        }
        widest.greatest()
    }

    /// Shades the packets; `next` gets the rays that mirrors send on.
    #[inline(always)]
    pub fn shade<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        may_mirror: bool,
        next: &mut Self,
        (stack, rays): (&mut Stack<L::Real>, &mut Rays),
    ) {
        let looks_beside = self.looks_beside();
        for index in 0..self.packets.len() {
            let ignored = self.ignored_by(kernel, index);
            let shader = Shader {
                kernel,
                is_first: self.parents.is_empty(),
                may_mirror,
                looks_beside,
                thin: &self.thin,
                lights: &self.lights,
            };
            let edge = self.edges.get_mut(index);
            let packet = &mut self.packets[index];
            let Some(mirrored) =
                shader.shade(packet, (ignored, edge), &mut self.parts, (stack, rays))
            else {
                continue;
            };
            rays.reflected += u64::from(mirrored.active.bits().count_ones());
            let paths = mirrored.paths;
            next.packets
                .push(Packet::new(kernel, paths.rays, mirrored.active));
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
    pub fn aim<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        scratch: &mut Scratch<L::Real>,
    ) {
        let plan = kernel.plan;
        let rays = self
            .packets
            .iter()
            .map(|packet| (packet.active, packet.rays));
        let beam = if plan.screen.is_some() {
            beam_around(kernel.token, rays)
        } else {
            None
        };
        let Some(mut beam) = beam else {
            self.seen = Candidates::all(plan);
            self.thin.clone_from(&self.seen);
            return;
        };
        let (mut width, mut spread) = (kernel.splat(0.0), kernel.splat(0.0));
        let mut narrowest = kernel.infinity();
        for (edge, packet) in self.edges.iter().zip(&self.packets) {
            width = L::select(packet.active, width.max(edge.cone.width), width);
            spread = L::select(packet.active, spread.max(edge.cone.spread), spread);
            narrowest = L::select(packet.active, narrowest.min(edge.cone.spread), narrowest);
        }
        let (width, spread) = (width.greatest(), spread.greatest());
        if self.looks_beside() && widest_spread(plan) < narrowest.least() {
            self.edges_are = Edges::Signed;
        }
        if self.looks_beside() {
            // Room for what passes beside the rays, closer than a pixel.
            beam = beam.widened(width, spread);
        }
        let start_plane = self.start_plane(plan);
        kernel.keep_met(&mut self.seen, &beam, start_plane, scratch);
        if self.looks_beside() {
            let slipping = L::Real::from_f64(SLIPPING);
            self.thin.keep_narrow(&self.seen, plan, |center, radius| {
                (width + spread * beam.distance(center, radius)) * slipping
            });
        }
    }

    /// The plane that all rays start on, if they all start on one.
    fn start_plane(&self, plan: &Plan<L::Real>) -> Option<usize> {
        let first = self.parents.first()?.ignored.shared()?;
        let mut parents = self.parents.iter();
        let is_shared = parents.all(|parent| parent.ignored.shared() == Some(first));
        let plane = first.checked_sub(plan.primitives.firsts()[Kind::Plane as usize])?;
        (is_shared && plane < plan.primitives.planes.len()).then_some(plane)
    }

    /// Adds the colours that the mirrored rays brought back.
    #[inline(always)]
    pub fn take_colors(&mut self, mirrored: &Self) {
        for (packet, parent) in mirrored.packets.iter().zip(&mirrored.parents) {
            let own = &mut self.packets[parent.packet];
            let added = parent.filter.filter(clamped(packet.color));
            own.color = Vec3::select(packet.active, own.color + added, own.color);
        }
    }

    /// Adds what the mirrored rays know of their edges.
    #[inline(always)]
    pub fn take_edges(&mut self, mirrored: &Self) {
        for (index, edge) in mirrored.edges.iter().enumerate() {
            let active = mirrored.packets[index].active;
            let parent = mirrored.parents[index].packet;
            let own = &mut self.edges[parent];
            own.near = L::select(active, edge.near.min(own.near), own.near);
            let active = active.bits();
            let theirs = &mirrored.signatures[index];
            for (lane, own) in self.signatures[parent].iter_mut().enumerate() {
                if active >> lane & 1 == 1 {
                    *own = own.rotate_left(11) ^ theirs[lane];
                }
            }
        }
    }

    /// Notes what each ray has hit, and which lights shine on it.
    #[inline(always)]
    pub fn sign(&mut self, plan: &Plan<L::Real>) {
        self.signatures.clear();
        for (packet, edge) in self.packets.iter().zip(&self.edges) {
            self.signatures.push(signatures_of(plan, packet, edge));
        }
    }

    /// Makes packets of hits that are close to each other, where the plan asks for it.
    #[inline(always)]
    pub fn arrange<const TREE: bool>(
        &mut self,
        kernel: Kernel<L, TREE>,
        samples: &Samples<L::Real>,
    ) {
        if TREE && kernel.plan.hit_order == HitOrder::OfPlaces {
            self.order.arrange(kernel, &mut self.packets, samples);
        }
    }

    /// Writes what was seen, sample by sample; `unsorted` is memory for what is in another order.
    #[inline(always)]
    pub fn store(
        &self,
        edges: Edges,
        traced: &mut Traced<L::Real>,
        unsorted: &mut Traced<L::Real>,
    ) {
        let (packets, signatures) = (&self.packets, &self.signatures);
        if self.order.samples.is_empty() {
            return store(packets, &self.edges, signatures, traced);
        }
        unsorted.resize(traced.count, traced.red.len(), edges);
        store(packets, &self.edges, signatures, unsorted);
        traced.take_sorted(unsorted, &self.order.samples);
    }
}
