//! Which faces of a mesh are cut into slices with boxes of their own in its tree.

use crate::primitive::Slicing;
use crate::simd::Vec3;

/// Number of faces from which on a mesh is sliced. The boxes of fewer faces are tested quickly: rods of 20 faces would
/// take 1.4 times as long, a trunk of 48 among leaves 1.1 times.
const MIN_FACES: usize = 64;
/// Maximum number of slices of a mesh beyond one for each of its faces. They take 60 bytes each in the tree.
const MAX_MORE_SLICES: usize = 1 << 18;

/// The slices of each face of a mesh; empty if none is cut.
pub fn slicings(count: usize, corners: impl Fn(usize) -> [Vec3<f64>; 3]) -> Vec<Slicing> {
    if count < MIN_FACES {
        return Vec::new();
    }
    let mut slicings: Vec<_> = (0..count).map(|face| Slicing::of(&corners(face))).collect();
    let more = |slicing: &Slicing| usize::from(slicing.count() - 1);
    let wanted: usize = slicings.iter().map(more).sum();
    if wanted == 0 {
        return Vec::new();
    }
    let share = (MAX_MORE_SLICES as f64 / wanted as f64).min(1.0);
    // What is left of a face's share goes to the next one.
    let mut rest = 0.0;
    for slicing in &mut slicings {
        let wanted = slicing.count() - 1;
        rest += f64::from(wanted) * share;
        let more = (rest as u8).min(wanted);
        rest -= f64::from(more);
        *slicing = slicing.with_count(1 + more);
    }
    slicings
}

/// The slices of all faces in a row: the number of the face, and that of the slice in it.
pub fn entries(slicings: &[Slicing]) -> Vec<(u32, u8)> {
    let faces = (0..).zip(slicings);
    let entries =
        faces.flat_map(|(face, slicing)| (0..slicing.count()).map(move |slice| (face, slice)));
    entries.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face of a cone with this number of sides.
    fn side(sides: usize, side: usize) -> [Vec3<f64>; 3] {
        let rim = |side: usize| {
            let angle = side as f64 / sides as f64 * std::f64::consts::TAU;
            Vec3::new(angle.cos() * 5.0, -8.0, angle.sin() * 5.0)
        };
        [Vec3::splat(0.0), rim(side), rim(side + 1)]
    }

    #[test]
    fn ordinary_faces_and_those_of_a_few_are_not_sliced() {
        let narrow = |face| side(1000, face);
        let wide = |face| side(20, face);
        assert!(slicings(MIN_FACES - 1, narrow).is_empty());
        assert!(slicings(1000, wide).is_empty());
        // A million such faces get no more slices than they may take memory for.
        let more = entries(&slicings(1_000_000, narrow)).len() - 1_000_000;
        assert!(
            (MAX_MORE_SLICES - 1..=MAX_MORE_SLICES).contains(&more),
            "{more}"
        );
        // A face that is not cut is a whole one among others that are.
        let mixed = slicings(100, |face| if face == 7 { narrow(7) } else { wide(face) });
        let slices = usize::from(mixed[7].count());
        assert!(slices > 1 && entries(&mixed).len() == 99 + slices);
    }
}
