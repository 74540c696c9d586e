//! Directions, however long they are written.

use glam::DVec3;

/// Lengths whose squares are numbers with all their digits.
const SQUARABLE: std::ops::Range<f64> = 1e-140..1e140;

/// The power of two that smaller ones are multiplied by, and larger ones divided: it costs no digit.
const SCALE: i32 = 600;

/// The unit vector in this direction; `None` for none.
pub fn unit(vector: DVec3) -> Option<DVec3> {
    let size = vector.abs().max_element();
    if SQUARABLE.contains(&size) {
        vector.try_normalize()
    } else {
        let exponent = if size < 1.0 { SCALE } else { -SCALE };
        (vector * 2.0_f64.powi(exponent)).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_but_none_has_a_direction() {
        for length in [1e-305, 1e-199, 1e-160, 1.0, 1e150, 1e300] {
            let found = unit(DVec3::new(0.0, -0.6, -0.8) * length).expect("a direction");
            assert!(
                (found - DVec3::new(0.0, -0.6, -0.8)).length() < 1e-15,
                "{length}"
            );
        }
        assert_eq!(
            unit(DVec3::Y * 5e-324),
            Some(DVec3::Y),
            "the smallest number"
        );
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert_eq!(unit(none), None);
        }
    }
}
