//! The results of packets, sample by sample.

use super::packet::{EdgeInfo, Packet};
use super::paths::NO_PRIMITIVE;
use super::samples::{OBJECT_BITS, Traced};
use super::shadows::joined as joined_shadows;
use crate::plan::Plan;
use crate::simd::{MAX_LANES, Mask as _, Real, SimdFloat, Vec3};

/// Returns a number for each ray of a packet that identifies what it has hit and which lights shine there.
#[inline(always)]
pub fn signatures_of<L: SimdFloat>(
    plan: &Plan<L::Real>,
    packet: &Packet<L>,
    edge: &EdgeInfo<L>,
) -> [u32; MAX_LANES] {
    let mut numbers = [L::Real::ZERO; MAX_LANES];
    let mut lit = numbers;
    packet.nearest.number.store(&mut numbers);
    edge.lit.store(&mut lit);
    let mut signatures = [0; MAX_LANES];
    // Separate loops: without calls, all lanes are computed in step.
    if plan.geometry.is_none() && plan.primitives.components.is_empty() {
        for lane in 0..L::WIDTH {
            let object = (numbers[lane] + L::Real::ONE).nearest();
            signatures[lane] = signature_of(object, lit[lane]);
        }
    } else {
        // Neighbouring rays often hit the same primitive.
        let (mut last, mut object) = (L::Real::from_f64(NO_PRIMITIVE), 0);
        for lane in 0..L::WIDTH {
            if numbers[lane] != last {
                (last, object) = (numbers[lane], object_of(plan, numbers[lane]));
            }
            signatures[lane] = signature_of(object, lit[lane]);
        }
    }
    signatures
}

/// Combines an object and the lights on it into one number: odd multipliers spread small numbers over all bits.
#[inline(always)]
fn signature_of<R: Real>(object: u32, lit: R) -> u32 {
    let object = object.wrapping_mul(0x9E37_79B1);
    let mixed = object ^ lit.nearest().wrapping_mul(0x85EB_CA6B);
    object & OBJECT_BITS | fold_to_detail_bits(mixed)
}

/// Combines a signature with that of what is seen in the mirror. The bits of the thing stay those of the mirror
/// itself, since in curved mirrors each pixel shows another thing.
#[inline(always)]
pub fn join_signatures(own: u32, mirrored: u32) -> u32 {
    own & OBJECT_BITS | fold_to_detail_bits(own.rotate_left(11) ^ mirrored)
}

/// Folds all bits of a number into those that do not identify things.
#[inline(always)]
fn fold_to_detail_bits(mixed: u32) -> u32 {
    (mixed ^ mixed >> 16) & !OBJECT_BITS
}

/// Returns a number that identifies the object of a primitive: connected faces of a mesh count as one thing.
#[inline(always)]
fn object_of<R: Real>(plan: &Plan<R>, number: R) -> u32 {
    // The numbers of faces may be too large for `nearest`.
    let number = ((number.to_f64() + 1.0) as usize).checked_sub(1);
    number.map_or(0, |number| component_of(plan, number) as u32 + 1)
}

/// Returns the number of the first primitive of the thing that a primitive belongs to. Not inlined: in the kernels,
/// it would slow down the clean edges of the demo, which does not need it, by a tenth.
#[inline(never)]
pub fn component_of<R: Real>(plan: &Plan<R>, number: usize) -> usize {
    let in_tree = plan.numbered_geometry().and_then(|(geometry, first)| {
        let index = number.checked_sub(first)?;
        let component = match geometry.mesh_of(index) {
            Some(mesh) => mesh.first + mesh.mesh.component_of(index - mesh.first),
            None => geometry.primitives.component_of(index),
        };
        Some(first + component)
    });
    in_tree.unwrap_or_else(|| plan.primitives.component_of(number))
}

/// Writes for each ray of a packet the shadows that its hit is in and that end near it. Most rays have none.
#[inline(always)]
fn shadows_of<L: SimdFloat>(edge: &EdgeInfo<L>, shadows: &mut [u32]) {
    shadows.fill(0);
    let (direct, mirrored) = (edge.shadows, edge.mirrored_shadows);
    let mut remaining = direct.like(L::Real::ZERO).less(direct + mirrored).bits();
    while remaining != 0 {
        let lane = remaining.trailing_zeros() as usize;
        remaining &= remaining - 1;
        shadows[lane] = joined_shadows(direct.lane(lane).nearest(), mirrored.lane(lane).nearest());
    }
}

/// Writes the colours and edges of all rays, packet by packet.
#[inline(always)]
pub fn store<L: SimdFloat>(
    packets: &[Packet<L>],
    edges: &[EdgeInfo<L>],
    signatures: &[[u32; MAX_LANES]],
    traced: &mut Traced<L::Real>,
) {
    for (index, packet) in packets.iter().enumerate() {
        let first = index * L::WIDTH;
        let color = clamped(packet.color);
        color.x.store(&mut traced.red[first..]);
        color.y.store(&mut traced.green[first..]);
        color.z.store(&mut traced.blue[first..]);
    }
    for (index, (edge, signatures)) in edges.iter().zip(signatures).enumerate() {
        let first = index * L::WIDTH;
        edge.thin_distance.store(&mut traced.thin_distance[first..]);
        let lanes = first..first + L::WIDTH;
        traced.signature[lanes.clone()].copy_from_slice(&signatures[..L::WIDTH]);
        shadows_of(edge, &mut traced.shadows[lanes]);
    }
}

/// Clamps a colour to 0–1.
#[inline(always)]
pub fn clamped<L: SimdFloat>(color: Vec3<L>) -> Vec3<L> {
    color.clamp(color.x.like(L::Real::ZERO), color.x.like(L::Real::ONE))
}
