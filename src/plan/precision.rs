//! Which real type a scene needs: single precision wherever its errors stay invisible.

use crate::scene::Scene;

/// Largest ratio of a sphere's distance to its radius in single precision: the perpendicular
/// discriminant is then off by at most 3.2·u·ρ ≈ 1/1000 of the radius.
const MAX_DISTANCE_PER_RADIUS: f64 = 5e3;
/// Largest ratio of the scene's extent to its smallest feature in single precision.
const MAX_EXTENT_PER_FEATURE: f64 = 1e5;

/// Smallest height of the eye over a sphere, in radii, in single precision: below it, the distance
/// to the ground right ahead has lost its digits.
const MIN_HEIGHT_PER_RADIUS: f64 = 1e-3;

/// Most things that single precision can number.
const MAX_NUMBER: usize = 1 << 24;

/// Whether there are more things than single precision can number.
pub fn is_uncountable(scene: &Scene) -> bool {
    scene.objects.len() + scene.lights.len() + scene.faces() >= MAX_NUMBER
}

/// Whether single precision would show in the picture.
pub fn needs_double(scene: &Scene) -> bool {
    let Some((low, high)) = scene.bounds() else {
        return false;
    };
    let centre = (low + high) * 0.5;
    let eye = scene.camera.position;
    let extent = (high - low).length().max((eye - centre).length());
    let visible = scene.objects.iter().filter(|object| object.visible);
    visible.map(|object| &object.shape).any(|shape| {
        shape.height_per_radius(eye) < MIN_HEIGHT_PER_RADIUS
            || match shape.feature() {
                None => false,
                Some((at, size)) => {
                    (eye - at).length() > MAX_DISTANCE_PER_RADIUS * size
                        || extent > MAX_EXTENT_PER_FEATURE * size
                }
            }
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_rule_flips_at_its_boundary() {
        let mut scene = Scene::demo();
        assert!(!needs_double(&scene));
        scene.objects.retain(|object| object.name == "Sphere 1");
        scene.lights.clear();
        let away = |radii: f64| DVec3::new(125.0, 50.0, -150.0 + radii * 50.0);
        scene.camera.position = away(MAX_DISTANCE_PER_RADIUS * 0.999);
        assert!(!needs_double(&scene));
        scene.camera.position = away(MAX_DISTANCE_PER_RADIUS * 1.001);
        assert!(needs_double(&scene));
    }
}
