//! What packets have found out, sample by sample.

use super::order::Order;
use super::packet::{EdgeInfo, Packet};
use super::samples::Traced;
use crate::plan::Plan;
use crate::simd::{MAX_LANES, Real, SimdFloat, Vec3};

/// For each ray of a packet what it has hit and which lights shine on it, as one number.
#[inline(always)]
pub fn signatures_of<L: SimdFloat>(
    plan: &Plan<L::Real>,
    packet: &Packet<L>,
    edge: &EdgeInfo<L>,
) -> [u32; MAX_LANES] {
    let mut numbers = [L::Real::ZERO; MAX_LANES];
    let mut lit = numbers;
    packet.near.number.store(&mut numbers);
    edge.lit.store(&mut lit);
    let mut signatures = [0; MAX_LANES];
    for lane in 0..L::WIDTH {
        // Odd multipliers spread the small numbers over all bits.
        let number = object_of(plan, (numbers[lane] + L::Real::ONE).nearest());
        let lit = lit[lane].nearest();
        signatures[lane] = number.wrapping_mul(0x9E37_79B1) ^ lit.wrapping_mul(0x85EB_CA6B);
    }
    signatures
}

/// What tells objects apart, from 1 plus the number of a primitive: the faces of a mesh are one thing.
#[inline(always)]
fn object_of<R: Real>(plan: &Plan<R>, number: u32) -> u32 {
    let Some((geometry, first)) = plan.numbered_geometry() else {
        return number;
    };
    let index = (number as usize).checked_sub(first + 1);
    let mesh = index.and_then(|index| geometry.mesh_of(index));
    mesh.map_or(number, |mesh| (first + mesh.first + 1) as u32)
}

/// Writes the colours of the samples, of which the packets may be in another order.
#[inline(always)]
pub fn store_colors<L: SimdFloat>(
    packets: &[Packet<L>],
    order: Option<&Order<L::Real>>,
    traced: &mut Traced<L::Real>,
) {
    for (index, packet) in packets.iter().enumerate() {
        let first = index * L::WIDTH;
        let color = clamped(packet.color);
        store(color.x, first, order, &mut traced.red);
        store(color.y, first, order, &mut traced.green);
        store(color.z, first, order, &mut traced.blue);
    }
}

/// Writes what the samples know of their edges.
#[inline(always)]
pub fn store_edges<L: SimdFloat>(
    edges: &[EdgeInfo<L>],
    signatures: &[[u32; MAX_LANES]],
    order: Option<&Order<L::Real>>,
    traced: &mut Traced<L::Real>,
) {
    for (index, (edge, signatures)) in edges.iter().zip(signatures).enumerate() {
        let first = index * L::WIDTH;
        store(edge.near, first, order, &mut traced.near);
        for (lane, &signature) in signatures[..L::WIDTH].iter().enumerate() {
            let place = order.map_or(first + lane, |order| order.samples[first + lane] as usize);
            traced.signature[place] = signature;
        }
    }
}

/// Writes the lanes of a packet, of which the first is given.
#[inline(always)]
fn store<L: SimdFloat>(
    lanes: L,
    first: usize,
    order: Option<&Order<L::Real>>,
    column: &mut [L::Real],
) {
    match order {
        None => lanes.store(&mut column[first..]),
        Some(order) => order.scatter(lanes, first, column),
    }
}

/// A colour within 0–1.
#[inline(always)]
pub fn clamped<L: SimdFloat>(color: Vec3<L>) -> Vec3<L> {
    color.clamp(color.x.like(L::Real::ZERO), color.x.like(L::Real::ONE))
}
