//! The real type that a scene needs: single precision wherever its errors stay invisible.

use super::closeness::{
    has_layers, has_twins, is_almost_on, is_at_border, is_just_above, visible_planes,
};
use super::request::{Model, RenderRequest};
use crate::scene::{Object, Precision, Projection, Scene};

/// Largest ratio of a sphere's distance to its radius in single precision: the perpendicular
/// discriminant is then off by at most 3.2·u·ρ ≈ 1/1000 of the radius.
const MAX_DISTANCE_PER_RADIUS: f64 = 5e3;
/// Largest ratio of the scene's extent to its smallest feature in single precision: edges are then off by a
/// thousandth of the feature, which is a tenth of a pixel for a feature of a hundred pixels.
const MAX_EXTENT_PER_FEATURE: f64 = 1e4;
/// Factor by which features may be smaller if samples that rounding may decide are traced again: of 400 random
/// scenes with features down to a millionth, this lets 119 into single precision, and no pixel of them is off.
const SMALLER_WHEN_FILTERED: f64 = 100.0;
/// Smallest extent of a scene in single precision: squares of much smaller numbers underflow to zero.
const MIN_EXTENT: f64 = 1e-12;

/// Cosine between the camera's direction and a plane's normal above which the camera looks at the plane, not along
/// it.
const MIN_FACING_COSINE: f64 = 0.1;
/// Largest ratio of the distance of visible things to the height of the picture for parallel rays in single
/// precision: an error of 1/16 of a pixel in a picture that is a thousand pixels high.
const MAX_DISTANCE_PER_HEIGHT: f64 = 1e3;

/// Longest lens in single precision, as the distance from the eye to the image plane in pixels: the last digit of a
/// ray is then 1/500 of a pixel. At 360,000, 8 of 40,000 pixels of a triangle are wrong and clean edges are off by
/// 8 levels; at 800,000, by 19 levels.
const MAX_DISTANCE_IN_PIXELS: f64 = 3e4;

/// Largest number of things for which single precision can represent each number.
const MAX_NUMBER: usize = 1 << 24;

/// Maximum number of primitives that are planned in both precisions: they then take 200 MB instead of 100, and a
/// fifth longer to open. A million faces, few of which are hit by rays that have also hit their neighbours, take as
/// long in double precision alone, and two thirds of the memory.
const MAX_FILTERED: usize = 300_000;
/// Number of objects up to which there are so few edges that rounding hardly shows: of 1,000 such random scenes at
/// 200 × 200 pixels, not one pixel is off by more than a step, whereas 3 of 10 such scenes with meshes have some.
/// Tracing doubtful samples again makes them take 1.4 times as long.
const MIN_FILTERED: usize = 32;
/// Number of pixels up to which pictures of so few objects are not filtered. Rounding decides some of these pixels:
/// one in three million in the demo, two in a million with mirror balls. Nobody waits for larger pictures in the
/// window; 3840 × 2160 is below the limit.
const MAX_UNFILTERED: u64 = 10_000_000;

/// Returns whether a picture is traced in double precision.
pub fn is_double(scene: &Scene, request: &RenderRequest) -> bool {
    let is_needed = || match request.precision {
        Precision::Auto => needs_double(scene, request) || is_too_large_for_both(scene, request),
        Precision::Single => false,
        Precision::Double => true,
    };
    is_uncountable(scene) || is_needed()
}

/// Returns whether samples of a single-precision picture that rounding may decide are traced again in double
/// precision.
pub fn is_filtered(scene: &Scene, request: &RenderRequest) -> bool {
    is_rounding_seen(scene, request) && primitives(scene) <= MAX_FILTERED
}

/// Returns whether features may be smaller and farther away because doubtful samples are traced again. Independent
/// of the picture's size, since otherwise parts of a picture would differ from the whole.
pub fn allows_finer_features(scene: &Scene, request: &RenderRequest) -> bool {
    is_filtered(scene, request) && has_many_edges(scene)
}

/// Returns whether a scene has too many primitives for both precisions, so that all of it is traced in double
/// precision.
pub fn is_too_large_for_both(scene: &Scene, request: &RenderRequest) -> bool {
    is_rounding_seen(scene, request) && primitives(scene) > MAX_FILTERED
}

/// Returns whether rounding to single precision would show on edges if nothing were done about it.
fn is_rounding_seen(scene: &Scene, request: &RenderRequest) -> bool {
    request.precision == Precision::Auto
        && matches!(request.model, Model::Needed | Model::Unculled)
        && request.methods.is_tight()
        && (has_many_edges(scene) || request.pixels() > MAX_UNFILTERED)
}

fn has_many_edges(scene: &Scene) -> bool {
    let visible = || scene.visible_objects();
    visible().count() > MIN_FILTERED || visible().any(|object| object.faces() > 0)
}

/// The number of visible objects and faces.
fn primitives(scene: &Scene) -> usize {
    let visible = scene.visible_objects();
    visible.map(|object| object.faces() + 1).sum()
}

/// Returns whether there are more things than single precision can number.
fn is_uncountable(scene: &Scene) -> bool {
    scene.objects.len() + scene.lights.len() + scene.faces() >= MAX_NUMBER
}

/// Returns whether the errors of single precision would show in the picture.
pub fn needs_double(scene: &Scene, request: &RenderRequest) -> bool {
    let eye = scene.camera.position;
    // Parallel rays start from a window, not from a point.
    let (is_out_of_sight, start) = match request.projection_of(&scene.camera) {
        Projection::Orthographic => (is_far_in_parallel(scene), None),
        Projection::Perspective => {
            let pixels = scene.camera.projection_distance * f64::from(request.height);
            (pixels > MAX_DISTANCE_IN_PIXELS, Some(eye))
        }
    };
    if is_out_of_sight {
        return true;
    }
    // Far lights are no reason: their directions are as exact as any.
    let Some((low, high)) = scene.surroundings() else {
        return false;
    };
    let centre = low.midpoint(high);
    let extent = (high - low).length().max((eye - centre).length());
    if extent < MIN_EXTENT || is_just_above(scene, extent) || has_twins(scene, extent) {
        return true;
    }
    let allows_finer_features = allows_finer_features(scene, request);
    let size = (high - low).length();
    // Samples that search for an edge inside a pixel are not filtered, and layers would show in all of them.
    if has_layers(scene, centre, extent)
        || !allows_finer_features && is_at_border(scene, start, size)
    {
        return true;
    }
    let smaller = if allows_finer_features {
        SMALLER_WHEN_FILTERED
    } else {
        1.0
    };
    let wall = if scene.lights.is_empty() {
        0.0
    } else {
        farthest_wall(scene)
    };
    let visible = scene.visible_objects();
    visible.map(|object| &object.shape).any(|shape| {
        is_almost_on(shape, eye)
            || shape.feature().is_some_and(|(at, size)| {
                let size = size * smaller;
                (eye - at).length().max(wall) > MAX_DISTANCE_PER_RADIUS * size
                    || extent > MAX_EXTENT_PER_FEATURE * size
            })
    })
}

/// The distance of the farthest plane that the camera looks at, on which shadows would show.
fn farthest_wall(scene: &Scene) -> f64 {
    let (eye, direction) = (scene.camera.position, scene.camera.forward());
    let facing =
        visible_planes(scene).filter(|piece| direction.dot(piece.normal).abs() > MIN_FACING_COSINE);
    let distances = facing.map(|piece| -piece.height(eye) / direction.dot(piece.normal));
    distances.fold(0.0, f64::max)
}

/// Returns whether parallel rays come from too far away.
fn is_far_in_parallel(scene: &Scene) -> bool {
    let camera = &scene.camera;
    let direction = camera.forward();
    let distance = |object: &Object| match object.shape.bounds() {
        Some((low, high)) => low.midpoint(high).distance(camera.position),
        // Where the ray through the middle of the picture hits it.
        None => object.shape.plane_piece().map_or(0.0, |piece| {
            let towards = direction.dot(piece.normal);
            let distance = piece.height(camera.position) / -towards;
            if distance.is_finite() {
                distance.max(0.0)
            } else {
                0.0
            }
        }),
    };
    let visible = scene.visible_objects();
    let farthest = visible.map(distance).fold(0.0, f64::max);
    farthest > MAX_DISTANCE_PER_HEIGHT * camera.orthographic_height
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::Triangles;
    use crate::scene::{List, Mesh, Plane, Sphere, Triangle};

    fn is_needed(scene: &Scene) -> bool {
        needs_double(scene, &RenderRequest::sized(64, 64))
    }

    #[test]
    fn far_walls_narrow_sights_and_tiny_worlds_need_double_precision() {
        let wants = |change: &dyn Fn(&mut Scene)| {
            let mut scene = Scene::demo();
            change(&mut scene);
            is_needed(&scene)
        };
        let wall = |away: f64| {
            move |scene: &mut Scene| {
                let point = scene.camera.position + scene.camera.look_at.normalize() * away;
                let normal = -scene.camera.look_at;
                scene
                    .objects
                    .push(Object::new("Wall", "plane", Plane { point, normal }));
            }
        };
        assert!(!wants(&wall(1e4)) && wants(&wall(1e6)));
        // Without lights, no shadow can show on the wall.
        assert!(!wants(&|scene| {
            wall(1e6)(scene);
            scene.lights.clear();
        }));
        let over = |height: f64| {
            move |scene: &mut Scene| {
                let at = scene.camera.position - DVec3::Y * height;
                let [a, b, c] = [DVec3::X, DVec3::Z, -DVec3::ONE]
                    .map(|off| at + off * 30.0 * (DVec3::X + DVec3::Z));
                scene
                    .objects
                    .push(Object::new("Piece", "plane", Triangle { a, b, c }));
            }
        };
        assert!(!wants(&over(1.0)) && !wants(&over(0.0)) && wants(&over(1e-6)));
        let tiny = |scene: &mut Scene| {
            scene.objects.retain(|object| object.name == "Sphere 1");
            scene.lights.clear();
            scene.camera.position *= 1e-16;
            scene.objects[0].shape = Sphere {
                center: DVec3::ZERO,
                radius: 1e-14,
            }
            .into();
        };
        assert!(wants(&tiny));
    }

    #[test]
    fn what_all_but_touches_needs_double_precision_and_what_touches_does_not() {
        let mut scene = Scene::demo();
        let eye = scene.camera.position;
        for (height, expected) in [(0.0, false), (1e-4, true), (1.0, false)] {
            scene.camera.position = DVec3 { y: height, ..eye };
            assert_eq!(is_needed(&scene), expected, "eye at {height}");
        }
        scene.camera.position = eye;
        for (height, expected) in [(0.0, false), (1e-4, true), (0.1, false)] {
            scene.lights[0].position.y = height;
            assert_eq!(is_needed(&scene), expected, "light at {height}");
        }
    }

    #[test]
    fn spheres_that_all_but_fill_one_surface_need_double_precision() {
        for (gap, expected) in [(0.0, false), (1e-6, true), (0.04, true), (0.2, false)] {
            let mut scene = Scene::demo();
            let mut twin = scene.objects[0].clone();
            twin.name = "Twin".into();
            twin.shape = Sphere {
                center: DVec3::new(125.0, 50.0, -150.0 + gap / 2.0),
                radius: 50.0 + gap / 2.0,
            }
            .into();
            scene.objects.push(twin);
            assert_eq!(is_needed(&scene), expected, "{gap}");
        }
    }

    #[test]
    fn an_eye_or_a_light_at_a_border_needs_double_precision() {
        let mut scene = Scene::demo();
        let corner = DVec3::new(200.0, 55.0, -100.0);
        let eye = scene.camera.position;
        for (away, expected) in [(0.0, true), (0.05, true), (0.2, false)] {
            scene.camera.position = corner + DVec3::Y * away;
            assert_eq!(is_needed(&scene), expected, "eye at {away}");
            scene.camera.position = eye;
            scene.lights[1].position = corner + DVec3::Y * away;
            assert_eq!(is_needed(&scene), expected, "light at {away}");
            scene.lights[1] = Scene::demo().lights[1].clone();
        }
    }

    #[test]
    fn pieces_a_hair_apart_need_double_precision() {
        for (gap, expected) in [(0.0, false), (1e-4, true), (0.1, false)] {
            let mut scene = Scene::demo();
            let mut rug = scene.objects[2].clone();
            rug.name = "Rug".into();
            rug.shape = rug.shape.moved(DVec3::new(0.0, 0.0, gap));
            scene.objects.push(rug);
            assert_eq!(is_needed(&scene), expected, "{gap}");
        }
    }

    #[test]
    fn a_light_that_is_off_needs_no_double_precision() {
        let mut scene = Scene::demo();
        scene.lights[1].position = DVec3::new(200.0, 55.05, -100.0);
        assert!(is_needed(&scene));
        scene.lights[1].visible = false;
        assert!(!is_needed(&scene));
    }

    #[test]
    fn a_lens_may_be_thirty_thousand_pixels_long() {
        let mut scene = Scene::demo();
        for (distance, height, expected) in [(1e2, 299, false), (1e2, 301, true), (1e3, 29, false)]
        {
            scene.camera.projection_distance = distance;
            let request = RenderRequest::sized(64, height);
            assert_eq!(
                needs_double(&scene, &request),
                expected,
                "{distance} {height}"
            );
        }
    }

    #[test]
    fn parallel_rays_may_come_from_a_thousand_heights_away() {
        let mut scene = Scene::demo();
        scene.objects.retain(|object| object.name == "Plane");
        scene.lights.clear();
        scene.camera.projection = Projection::Orthographic;
        scene.camera.look_at = DVec3::new(0.0, -1.0, -1.0);
        for (away, expected) in [(9e4, false), (2e5, true)] {
            scene.camera.position = DVec3::new(0.0, away, away);
            assert_eq!(is_needed(&scene), expected, "{away}");
        }
    }

    #[test]
    fn many_objects_may_be_smaller_since_what_is_in_doubt_is_traced_again() {
        let mut scene = Scene::demo();
        let objects = scene.objects.clone();
        let mut is_needed_with = |count: usize, radius: f64| {
            scene.objects = objects.clone();
            for index in 0..count {
                let center = DVec3::new(100.0 + index as f64, 20.0, -100.0);
                let shape = Sphere { center, radius };
                let name = format!("Speck {index}");
                scene.objects.push(Object::new(name, "plane", shape));
            }
            is_needed(&scene)
        };
        assert!(!is_needed_with(2, 0.1) && is_needed_with(2, 0.01));
        assert!(!is_needed_with(40, 0.01) && is_needed_with(40, 1e-4));
    }

    #[test]
    fn what_is_too_much_to_keep_in_both_is_traced_in_double_precision() {
        let of_faces = |faces: usize| {
            let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
            let faces = vec![[0, 1, 2]; faces];
            let triangles = Triangles::new(points.to_vec(), faces).expect("a mesh");
            let mut scene = Scene::demo();
            scene.objects = List::default();
            scene
                .objects
                .push(Object::new("Mesh", "plane", Mesh::of(triangles)));
            scene
        };
        for (faces, expected) in [(MAX_FILTERED - 1, false), (MAX_FILTERED, true)] {
            let (scene, mut request) = (of_faces(faces), RenderRequest::sized(64, 64));
            assert_eq!(is_double(&scene, &request), expected, "{faces}");
            assert_eq!(is_filtered(&scene, &request), !expected, "{faces}");
            request.precision = Precision::Single;
            assert!(!is_double(&scene, &request) && !is_filtered(&scene, &request));
        }
    }

    #[test]
    fn few_objects_have_edges_enough_in_a_large_picture() {
        let is_filtered = |width: u32, height: u32| {
            is_filtered(&Scene::demo(), &RenderRequest::sized(width, height))
        };
        assert!(!is_filtered(3840, 2160) && !is_filtered(2500, 4000));
        assert!(is_filtered(2501, 4000) && is_filtered(16_384, 16_384));
    }

    #[test]
    fn a_sphere_may_be_five_thousand_radii_away() {
        let mut scene = Scene::demo();
        assert!(!is_needed(&scene));
        scene.objects.retain(|object| object.name == "Sphere 1");
        scene.lights.clear();
        let away = |radii: f64| DVec3::new(125.0, 50.0, -150.0 + radii * 50.0);
        scene.camera.position = away(MAX_DISTANCE_PER_RADIUS * 0.999);
        assert!(!is_needed(&scene));
        scene.camera.position = away(MAX_DISTANCE_PER_RADIUS * 1.001);
        assert!(is_needed(&scene));
    }
}
