//! One depth of reflection: its packets, and the results they return.

use super::candidates::Candidates;
use super::cull::LightCandidates;
use super::doubt::Uncertainty;
use super::entry_points::EntryPoints;
use super::mixed_materials::MixedMaterials;
use super::order::Order;
use super::outcome::{clamped, join_signatures, signatures_of, store};
use super::packet::{EdgeInfo, Packet, ReflectionParent};
use super::samples::{EdgeDetail, Traced};
use crate::plan::Plan;
use crate::simd::{MAX_LANES, Mask as _, SimdFloat, Vec3};

/// One bounce: its packets, and what they can meet.
pub struct Bounce<L: SimdFloat> {
    /// The packets of rays.
    pub packets: Vec<Packet<L>>,
    /// Where each packet comes from, in bounces of mirrored rays.
    pub parents: Vec<ReflectionParent<L>>,
    /// What is to be found out about edges.
    pub edge_detail: EdgeDetail,
    /// One entry per packet, if edges are noted.
    pub edges: Vec<EdgeInfo<L>>,
    /// One entry per packet, if doubtful hits are noted.
    pub uncertainties: Vec<Uncertainty<L>>,
    /// What the rays can meet.
    pub candidates: Candidates,
    /// Where the rays enter the trees.
    pub entry_points: EntryPoints,
    /// Candidates that may slip between samples.
    pub thin: Candidates,
    /// For each light, what can cast shadows on the hits.
    pub lights: Vec<LightCandidates>,
    /// For each ray of a packet, a number that changes across edges.
    pub signatures: Vec<[u32; MAX_LANES]>,
    /// Which sample each ray belongs to, if they were reordered.
    pub order: Order<L::Real>,
    /// Scratch memory for the materials of a packet.
    pub mixed: MixedMaterials<L>,
}

impl<L: SimdFloat> Bounce<L> {
    /// A bounce without packets.
    pub fn new(plan: &Plan<L::Real>) -> Self {
        let candidates_of = |light| {
            let casters = Candidates::all_casting(plan, light);
            // Without culling, nothing picks out the thin ones: all of them count.
            let thin = match plan.screen {
                Some(_) => Candidates::default(),
                None => casters.clone(),
            };
            LightCandidates {
                casters,
                entry_points: EntryPoints::default(),
                thin,
                is_umbra: false,
            }
        };
        Self {
            packets: Vec::new(),
            parents: Vec::new(),
            edge_detail: EdgeDetail::Ignored,
            edges: Vec::new(),
            uncertainties: Vec::new(),
            candidates: Candidates::default(),
            entry_points: EntryPoints::default(),
            thin: Candidates::default(),
            lights: plan.lights.iter().map(candidates_of).collect(),
            signatures: Vec::new(),
            order: Order::default(),
            mixed: MixedMaterials::new(),
        }
    }

    /// Removes all packets.
    pub fn clear(&mut self) {
        self.packets.clear();
        self.parents.clear();
        self.edges.clear();
        self.uncertainties.clear();
    }

    /// Returns whether there are no packets.
    pub fn is_empty(&self) -> bool {
        self.packets.is_empty()
    }

    /// Adds the colours that the mirrored rays returned, and their doubts.
    #[inline(always)]
    pub fn take_colors(&mut self, mirrored: &Self) {
        for (packet, parent) in mirrored.packets.iter().zip(&mirrored.parents) {
            let parent_packet = &mut self.packets[parent.packet];
            let added = parent.filter.filter(clamped(packet.color));
            parent_packet.color = Vec3::select(
                packet.active,
                parent_packet.color + added,
                parent_packet.color,
            );
        }
        for (index, mirrored_on) in mirrored.uncertainties.iter().enumerate() {
            let parent_rays = &mut self.uncertainties[mirrored.parents[index].packet];
            parent_rays.doubt =
                parent_rays.doubt | mirrored_on.doubt & mirrored.packets[index].active;
        }
    }

    /// Merges the edge information of the mirrored rays.
    #[inline(always)]
    pub fn take_edges(&mut self, mirrored: &Self) {
        for (index, edge) in mirrored.edges.iter().enumerate() {
            let active = mirrored.packets[index].active;
            let parent = mirrored.parents[index].packet;
            let parent_edge = &mut self.edges[parent];
            parent_edge.thin_distance = L::select(
                active,
                edge.thin_distance.min(parent_edge.thin_distance),
                parent_edge.thin_distance,
            );
            parent_edge.mirrored_shadows =
                L::select(active, edge.shadows, parent_edge.mirrored_shadows);
            let active = active.bits();
            let theirs = &mirrored.signatures[index];
            for (lane, signature) in self.signatures[parent].iter_mut().enumerate() {
                if active >> lane & 1 == 1 {
                    *signature = join_signatures(*signature, theirs[lane]);
                }
            }
        }
    }

    /// Computes the signatures: what each ray has hit, and which lights shine on it.
    #[inline(always)]
    pub fn compute_signatures(&mut self, plan: &Plan<L::Real>) {
        self.signatures.clear();
        for (packet, edge) in self.packets.iter().zip(&self.edges) {
            self.signatures.push(signatures_of(plan, packet, edge));
        }
    }

    /// Lists which of the first `count` samples are in doubt. The list is empty if no doubts are noted.
    pub fn list_doubtful(&self, count: usize, indices: &mut Vec<u32>) {
        indices.clear();
        let notes = self.packets.iter().zip(&self.uncertainties);
        for (index, (packet, uncertainty)) in notes.enumerate() {
            let first = index * L::WIDTH;
            let mut remaining = uncertainty.doubt.bits() & packet.active.bits();
            while remaining != 0 {
                let ray = first + remaining.trailing_zeros() as usize;
                let sample = self.order.samples.get(ray);
                indices.push(sample.map_or(ray as u32, |&sample| sample));
                remaining &= remaining - 1;
            }
        }
        indices.retain(|&index| (index as usize) < count);
        indices.sort_unstable();
    }

    /// Writes the results, sample by sample; `unsorted` is scratch memory, used if the rays were reordered.
    #[inline(always)]
    pub fn store(
        &self,
        edges: EdgeDetail,
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
