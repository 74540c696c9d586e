//! Which flat faces samples are on. Where two beside each other are on faces that share no edge, others lie between
//! them, which no sample has seen.

use super::packet::Packet;
use super::paths::NOTHING;
use super::samples::Traced;
use crate::plan::{Geometry, Plan};
use crate::primitive::{Kind, PackedTriangle};
use crate::simd::{MAX_LANES, Real, SimdFloat, Vec3};

/// The bits of a mark that are of one corner.
const BITS: u32 = 10;
const CORNER: u32 = (1 << BITS) - 1;

/// Notes the marks of the flat faces that packets have met, of meshes or of many triangles that hang together: 0 for
/// everything else, and nothing in scenes without. `order` says which sample each ray is, if they are in another order.
/// Smooth meshes do not show their faces.
pub fn note_faces<L: SimdFloat>(
    plan: &Plan<L::Real>,
    (packets, order): (&[Packet<L>], &[u32]),
    traced: &mut Traced<L::Real>,
) {
    if !has_faces(plan) {
        return;
    }
    traced.faces.resize(traced.red.len(), 0);
    let mut numbers = [L::Real::ZERO; MAX_LANES];
    // Those of rays beside each other are often the same.
    let (mut last, mut mark) = (NOTHING, 0);
    for (index, packet) in packets.iter().enumerate() {
        packet.near.number.store(&mut numbers);
        for (lane, number) in numbers[..L::WIDTH].iter().enumerate() {
            let number = number.to_f64();
            if number != last {
                last = number;
                let face = (number != NOTHING).then(|| face_of(plan, number as usize));
                mark = face.flatten().map_or(0, |face| mark_of(face.corners));
            }
            let place = index * L::WIDTH + lane;
            let sample = order.get(place).map_or(place, |&sample| sample as usize);
            traced.faces[sample] = mark;
        }
    }
}

/// Whether there are faces between which others may be hidden.
fn has_faces<R: Real>(plan: &Plan<R>) -> bool {
    let in_geometry = |geometry: &Geometry<R>| {
        let mut meshes = geometry.meshes.iter();
        !geometry.primitives.things.is_empty() || meshes.any(|mesh| mesh.mesh.smooth.is_empty())
    };
    !plan.primitives.things.is_empty() || plan.geometry.as_deref().is_some_and(in_geometry)
}

/// The flat face of this number, if it is one.
fn face_of<R: Real>(plan: &Plan<R>, number: usize) -> Option<&PackedTriangle<R>> {
    let (loose, index) = match plan.numbered_geometry() {
        Some((geometry, first)) if first <= number => {
            let index = number - first;
            if let Some(mesh) = geometry.mesh_of(index) {
                let triangle = mesh.mesh.triangles.get(index - mesh.first);
                return triangle.filter(|_| mesh.mesh.smooth.is_empty());
            }
            (&geometry.primitives, index)
        }
        _ => (&plan.primitives, number),
    };
    let first = loose.firsts()[Kind::Triangle as usize];
    loose.triangles.get(index.checked_sub(first)?)
}

/// What tells a face from others, and its neighbours from those: a few bits of each corner, never 0.
fn mark_of<R: Real>(corners: [Vec3<R>; 3]) -> u32 {
    let [a, b, c] = corners.map(bits_of);
    a << (2 * BITS) | b << BITS | c
}

/// A few bits of a corner, not 0, the same in single and in double precision.
fn bits_of<R: Real>(corner: Vec3<R>) -> u32 {
    let mut bits = 0_u32;
    for number in [corner.x, corner.y, corner.z] {
        // Both zeros are one place.
        let own = (number.to_f64() as f32 + 0.0).to_bits();
        bits = (bits.rotate_left(5) ^ own).wrapping_mul(0x9E37_79B1);
    }
    (bits >> (32 - BITS)).max(1)
}

/// Whether a face may lie between the samples at the corners of a cell that none of them is on: upper left and right,
/// lower left and right.
#[inline(always)]
pub fn may_hide_face([a, b, c, d]: [u32; 4]) -> bool {
    a != b && !are_neighbours(a, b)
        || a != c && !are_neighbours(a, c)
        || b != d && !are_neighbours(b, d)
        || c != d && !are_neighbours(c, d)
}

/// Whether two different faces share an edge, or one of them is none.
fn are_neighbours(a: u32, b: u32) -> bool {
    let corners = |mark: u32| [mark & CORNER, mark >> BITS & CORNER, mark >> (2 * BITS)];
    let others = corners(b);
    let shared = corners(a).into_iter().filter(|own| others.contains(own));
    a == 0 || b == 0 || shared.count() >= 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_that_meet_in_a_corner_alone_have_others_between_them() {
        let at = |x: f64, y: f64| Vec3 { x, y, z: 0.5 };
        let hub = at(0.0, -0.0);
        // A fan around the hub.
        let fan = |number: u32| {
            let rim = |number: u32| {
                let (y, x) = (f64::from(number % 6) * 60.0).to_radians().sin_cos();
                at(x, y)
            };
            mark_of([hub, rim(number), rim(number + 1)])
        };
        for number in 0..6 {
            let (one, next, over) = (fan(number), fan(number + 1), fan(number + 2));
            assert!(!may_hide_face([one; 4]));
            assert!(!may_hide_face([one, next, one, next]));
            assert!(!may_hide_face([one, one, 0, next]), "the sky");
            for around in [
                [one, over, one, one],
                [one, one, over, one],
                [one, over, next, over],
                [next, over, next, one],
                [next, over, one, over],
            ] {
                assert!(may_hide_face(around), "{around:x?}");
            }
        }
        let single = [at(0.0, 0.0), at(0.1, 0.2), at(0.3, 0.7)]
            .map(|corner| Vec3::<f32>::from_dvec3(corner.to_dvec3()));
        let double = [hub, at(0.1, 0.2), at(0.3, 0.7)];
        assert_eq!(mark_of(single), mark_of(double), "whatever the precision");
    }
}
