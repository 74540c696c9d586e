//! Normalizing vectors of extreme length.

use glam::DVec3;

/// Range of lengths whose squares have full precision.
const SQUARABLE: std::ops::Range<f64> = 1e-140..1e140;

/// Exponent of the power of two by which shorter vectors are multiplied and longer ones divided, without loss of
/// precision.
const SCALE: i32 = 600;

/// Returns the unit vector in the direction of `vector`; `None` if it has no direction.
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
