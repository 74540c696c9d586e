//! Marks of the flat faces that samples are on. If two adjacent samples are on faces that share no edge, there are
//! other faces between them that no sample has seen; if one is on a face that looks away from a light and the other
//! in shadow on one that does not, there may be light between them.

use super::gather::HitPrimitive;
use super::packet::Packet;
use super::paths::NO_PRIMITIVE;
use super::samples::Traced;
use crate::plan::{Geometry, Plan};
use crate::primitive::{Kind, PackedTriangle};
use crate::simd::{MAX_LANES, Real, SimdFloat, Vec3};

/// Bits of a mark for each corner of the face.
const CORNER_BITS: u32 = 10;
const CORNER_MASK: u64 = (1 << CORNER_BITS) - 1;
/// Sine of the angle between a face and the direction to a light below which its light is not visible on the face.
const GRAZING_SINE: f64 = 1e-3;
/// Number of lights that a mark covers.
const MAX_LIGHTS: usize = 32;

/// Notes the marks of the flat faces that packets have hit, of meshes or of connected triangles: 0 for everything
/// else, and nothing in scenes without such faces. `order` maps rays to samples if they were reordered. Faces of
/// smooth surfaces are not visible, and have no marks.
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
    // Adjacent rays are often on the same face.
    let (mut last, mut mark) = (NO_PRIMITIVE, 0);
    for (index, packet) in packets.iter().enumerate() {
        packet.nearest.number.store(&mut numbers);
        for (lane, number) in numbers[..L::WIDTH].iter().enumerate() {
            let number = number.to_f64();
            if number != last {
                last = number;
                let face = (number != NO_PRIMITIVE).then(|| face_of(plan, number as usize));
                mark = face.flatten().map_or(0, |face| {
                    let unlit_lights = lights_behind(plan, face, packet.rays.direction.lane(lane));
                    u64::from(unlit_lights) << (u64::BITS - u32::BITS) | mark_of(face.0.corners)
                });
            }
            let ray = index * L::WIDTH + lane;
            let sample = order.get(ray).map_or(ray, |&sample| sample as usize);
            traced.faces[sample] = mark;
        }
    }
}

/// Returns whether there are faces between which others may be hidden.
fn has_faces<R: Real>(plan: &Plan<R>) -> bool {
    let in_geometry = |geometry: &Geometry<R>| {
        let mut meshes = geometry.meshes.iter();
        !geometry.primitives.things.is_empty() || meshes.any(|mesh| mesh.mesh.has_flat)
    };
    !plan.primitives.things.is_empty() || plan.geometry.as_deref().is_some_and(in_geometry)
}

/// A flat face, and the origin of its corners' coordinates.
type Face<'a, R> = (&'a PackedTriangle<R>, Vec3<R>);

/// Returns the face with this number, if it is a flat one.
fn face_of<R: Real>(plan: &Plan<R>, number: usize) -> Option<Face<'_, R>> {
    match plan.numbered_geometry() {
        Some((geometry, first)) if first <= number => {
            HitPrimitive::of(geometry, number - first)?.flat()
        }
        _ => {
            let first = plan.primitives.firsts()[Kind::Triangle as usize];
            let triangle = plan.primitives.triangles.get(number.checked_sub(first)?)?;
            Some((triangle, Vec3::splat(R::ZERO)))
        }
    }
}

/// Returns which of the first [`MAX_LIGHTS`] lights are behind a face that is seen in this direction, or so low above
/// it that their light is not visible. The result is the same in any precision, even if a light is in the plane of
/// the face.
fn lights_behind<R: Real>(plan: &Plan<R>, (face, origin): Face<R>, direction: Vec3<R>) -> u32 {
    let corner = face.corners[0] + origin;
    let is_front = direction.dot(face.normal) < R::ZERO;
    let lights = plan.lights.iter().take(MAX_LIGHTS).enumerate();
    lights.fold(0, |unlit_lights, (number, light)| {
        let to_light = light.position - corner;
        let height = to_light.dot(face.normal);
        let height = if is_front { height } else { -height };
        let is_lit = to_light.length() * R::from_f64(GRAZING_SINE) < height;
        unlit_lights | u32::from(!is_lit) << number
    })
}

/// Combines a few bits of each corner, never 0: they identify the face, and show which faces are its neighbours.
fn mark_of<R: Real>(corners: [Vec3<R>; 3]) -> u64 {
    let [a, b, c] = corners.map(bits_of).map(u64::from);
    a << (2 * CORNER_BITS) | b << CORNER_BITS | c
}

/// Hashes a corner to a few bits, not 0, which are the same in single and in double precision.
fn bits_of<R: Real>(corner: Vec3<R>) -> u32 {
    let mut bits = 0_u32;
    for number in [corner.x, corner.y, corner.z] {
        // Maps -0 to +0.
        let float_bits = (number.to_f64() as f32 + 0.0).to_bits();
        bits = (bits.rotate_left(5) ^ float_bits).wrapping_mul(0x9E37_79B1);
    }
    (bits >> (32 - CORNER_BITS)).max(1)
}

/// Returns whether a face, or light, may be hidden between the samples at a cell's corners: upper left and right,
/// lower left and right.
#[inline(always)]
pub fn may_hide_face(corners: [u64; 4]) -> bool {
    any_adjacent(corners, |one, other| {
        one != other && !are_neighbours(one, other)
    })
}

/// Returns whether light may be hidden between them: two adjacent ones are on faces of which only one looks away
/// from it.
pub fn may_hide_light(corners: [u64; 4]) -> bool {
    any_adjacent(corners, |one, other| {
        one != 0 && other != 0 && unlit_lights(one) != unlit_lights(other)
    })
}

/// Returns whether a condition holds for any two adjacent corners of a cell.
#[inline(always)]
fn any_adjacent([a, b, c, d]: [u64; 4], holds: impl Fn(u64, u64) -> bool) -> bool {
    holds(a, b) || holds(a, c) || holds(b, d) || holds(c, d)
}

/// Returns whether two different faces share an edge and face the same lights, or one of the marks is of no face.
fn are_neighbours(a: u64, b: u64) -> bool {
    let corners = |mark: u64| {
        [mark, mark >> CORNER_BITS, mark >> (2 * CORNER_BITS)].map(|bits| bits & CORNER_MASK)
    };
    let corners_of_b = corners(b);
    let shared = corners(a)
        .into_iter()
        .filter(|corner| corners_of_b.contains(corner));
    a == 0 || b == 0 || (shared.count() >= 2 && unlit_lights(a) == unlit_lights(b))
}

/// The lights behind the face, as bits.
fn unlit_lights(mark: u64) -> u64 {
    mark >> (u64::BITS - u32::BITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_that_meet_in_a_corner_alone_have_others_between_them() {
        let at = |x: f64, y: f64| Vec3 { x, y, z: 0.5 };
        let hub = at(0.0, -0.0);
        // A fan of triangles around the hub.
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
        // A light behind only one of two neighbours.
        let unlit_lights = fan(1) | 1 << u32::BITS;
        assert!(may_hide_face([fan(0), unlit_lights, fan(0), unlit_lights]));
        assert!(may_hide_light([fan(0), unlit_lights, fan(0), unlit_lights]));
        for alike in [
            [fan(0) | 1 << u32::BITS, unlit_lights, 0, unlit_lights],
            [fan(0), fan(1), 0, fan(1)],
        ] {
            assert!(!may_hide_face(alike) && !may_hide_light(alike));
        }
        let single = [at(0.0, 0.0), at(0.1, 0.2), at(0.3, 0.7)]
            .map(|corner| Vec3::<f32>::from_dvec3(corner.to_dvec3()));
        let double = [hub, at(0.1, 0.2), at(0.3, 0.7)];
        assert_eq!(mark_of(single), mark_of(double), "whatever the precision");
    }
}
