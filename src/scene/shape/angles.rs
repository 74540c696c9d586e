//! The rotation angles of meshes.

use glam::{DQuat, DVec3, EulerRot};

/// Largest step, in degrees, in which a rotation is tracked. It is this large because any intermediate step could end
/// in a gimbal lock, where two of the three angles turn about one axis and it is ambiguous which of them has changed.
const MAX_STEP: f64 = 90.0;
/// Largest number of such steps: for larger rotations, the number of full turns is not meaningful.
const MAX_STEPS: f64 = 4000.0;

/// Returns the rotation by these angles in degrees about x, then y, then z.
pub fn orientation_of(angles: DVec3) -> DQuat {
    let [x, y, z] = angles.to_array().map(f64::to_radians);
    DQuat::from_euler(EulerRot::ZYX, z, y, x)
}

/// Returns the angles of a rotation in degrees about x, then y, then z. Of the two solutions, each with any number
/// of full turns, it is the one nearer to `previous`.
pub fn angles_of(orientation: DQuat, previous: DVec3) -> DVec3 {
    let (z, y, x) = orientation.to_euler(EulerRot::ZYX);
    let one = DVec3::new(x.to_degrees(), y.to_degrees(), z.to_degrees());
    let other = DVec3::new(one.x + 180.0, 180.0 - one.y, one.z + 180.0);
    let [one, other] = [one, other].map(|angles| {
        let turns = ((previous - angles) / 360.0).round();
        angles + turns * 360.0
    });
    let nearer = if one.distance_squared(previous) <= other.distance_squared(previous) {
        one
    } else {
        other
    };
    DVec3::from(nearer.to_array().map(without_noise))
}

/// Returns the angles after a further rotation, in degrees about a unit axis, including its full turns.
pub fn turned_about(angles: DVec3, axis: DVec3, degrees: f64) -> DVec3 {
    let steps = (degrees.abs() / MAX_STEP).ceil().clamp(1.0, MAX_STEPS) as u32;
    let start = orientation_of(angles);
    (1..=steps).fold(angles, |previous, step| {
        let degrees = degrees * f64::from(step) / f64::from(steps);
        let rotation = DQuat::from_axis_angle(axis, degrees.to_radians());
        angles_of(rotation * start, previous)
    })
}

/// Returns rotations by less than half a turn each, which one after the other lead from some angles to others, in
/// degrees, so that what is turned by them makes as many full turns.
pub fn rotations_between(from: DVec3, to: DVec3) -> impl Iterator<Item = DQuat> {
    let degrees = (to - from).abs().element_sum();
    let steps = (degrees / MAX_STEP).floor().min(MAX_STEPS) as u32 + 1;
    let angles = move |step: u32| from.lerp(to, f64::from(step) / f64::from(steps));
    (0..steps)
        .map(move |step| orientation_of(angles(step + 1)) * orientation_of(angles(step)).inverse())
}

/// Removes rounding noise from an angle with few digits: -50.00000000000001 becomes -50.
fn without_noise(degrees: f64) -> f64 {
    let round = (degrees * 1e9).round() / 1e9;
    if (round - degrees).abs() < 1e-12 {
        round
    } else {
        degrees
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_counted() {
        let level = DVec3::new(0.0, 20.0, 0.0);
        for degrees in [270.0, 360.0, -1000.0, 15.0] {
            let turned = turned_about(level, DVec3::Y, degrees);
            let expected = DVec3::new(0.0, 20.0 + degrees, 0.0);
            assert!((turned - expected).length() < 1e-9, "{degrees}: {turned}");
        }
        let lying = turned_about(DVec3::X * 90.0, DVec3::Y, 360.0);
        assert!(
            (lying - DVec3::new(90.0, 360.0, 0.0)).length() < 1e-9,
            "{lying}"
        );
        // What is turned by the steps from one triple of angles to another turns as often.
        for to in [DVec3::Y * 360.0, DVec3::Y * 270.0, DVec3::X * -720.0] {
            let turned = rotations_between(DVec3::ZERO, to).fold(DVec3::ZERO, |angles, by| {
                angles_of(by * orientation_of(angles), angles)
            });
            assert!((turned - to).length() < 1e-6, "{turned} for {to}");
        }
        // About an oblique axis, only the resulting orientation is predictable, not the angles.
        let angles = DVec3::new(12.0, 20.0, -40.0);
        let axis = DVec3::new(0.6, 0.0, -0.8);
        let expected = DQuat::from_axis_angle(axis, 4.0) * orientation_of(angles);
        let turned = orientation_of(turned_about(angles, axis, 4.0_f64.to_degrees()));
        assert!(turned.dot(expected).abs() > 1.0 - 1e-12);
    }
}
