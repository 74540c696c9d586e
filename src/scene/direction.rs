//! Directions, however long they are written.

use glam::DVec3;

/// Lengths whose squares are numbers with all their digits.
const SQUARABLE: std::ops::Range<f64> = 1e-140..1e140;

/// The unit vector in this direction; `None` for none.
pub fn unit(vector: DVec3) -> Option<DVec3> {
    let size = vector.abs().max_element();
    if SQUARABLE.contains(&size) {
        vector.try_normalize()
    } else {
        // By a power of two, which costs no digit.
        (vector * size.log2().floor().exp2().recip()).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_but_none_has_a_direction() {
        for length in [1e-300, 1e-199, 1e-160, 1.0, 1e150, 1e300] {
            let found = unit(DVec3::new(0.0, -0.6, -0.8) * length).expect("a direction");
            assert!(
                (found - DVec3::new(0.0, -0.6, -0.8)).length() < 1e-15,
                "{length}"
            );
        }
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(unit(none), None);
        }
    }
}
