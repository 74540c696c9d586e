//! Moving the camera relative to what is looked at.

use egui::Vec2;
use glam::DVec3;

use super::screen::Screen;
use super::subject::Movable;
use crate::editor::{Editor, set_orthographic_height};
use crate::scene::{Camera, Framing, Projection, around};
use crate::ui::flying::DOLLY;

/// Radians per point of mouse movement.
const ORBIT: f64 = 0.008;
/// Factor by which a change of projection may change the apparent size.
const MAX_SIZE_CHANGE: f64 = 3.0;
/// Minimum size of what is framed, as a fraction of the whole scene.
const MIN_FRAMED_SHARE: f64 = 0.02;

/// Rotation of an orbit, to the right and upwards, for a mouse movement: things follow the pointer.
pub fn orbit_angles(moved: Vec2) -> (f64, f64) {
    (-f64::from(moved.x) * ORBIT, -f64::from(moved.y) * ORBIT)
}

/// Moves the camera so that a point follows a mouse movement.
pub fn panned(camera: &Camera, screen: &Screen, point: DVec3, moved: Vec2) -> Camera {
    let mut next = camera.clone();
    if let Some(basis) = camera.basis() {
        let unit = screen.unit_at(point);
        let (right, up) = (f64::from(moved.x) * unit, f64::from(moved.y) * unit);
        next.position += basis.y_axis * up - basis.x_axis * right;
    }
    next
}

/// Moves the camera towards a point by a wheel movement; the point keeps its position in the picture.
pub fn dollied(camera: &Camera, point: DVec3, wheel: f64) -> Camera {
    let factor = (-wheel * DOLLY).exp();
    let mut next = camera.clone();
    match camera.projection {
        Projection::Perspective => next.position = point + (camera.position - point) * factor,
        Projection::Orthographic => {
            set_orthographic_height(&mut next, camera.orthographic_height * factor);
            let factor = next.orthographic_height / camera.orthographic_height;
            let forward = camera.forward();
            let arm = point - camera.position;
            // The view window shrinks around the point; its distance does not matter.
            next.position += (arm - forward * arm.dot(forward)) * (1.0 - factor);
        }
    }
    next
}

/// The camera that looks at the same middle from the same distance, but along another direction.
pub fn looking_along(camera: &Camera, about: DVec3, direction: DVec3) -> Camera {
    let distance = (about - camera.position).length();
    let is_steep = direction.y.abs() > 0.5;
    Camera {
        position: about - direction * distance,
        look_at: direction,
        up: if is_steep { DVec3::NEG_Z } else { DVec3::Y },
        ..camera.clone()
    }
}

/// The camera with another projection. If things at the depth of `about` would change their size by
/// `MAX_SIZE_CHANGE` or more, they keep their size instead; smaller differences stay, as the user chose the
/// parameters that cause them.
pub fn projected(camera: &Camera, about: Option<DVec3>, projection: Projection) -> Camera {
    let mut next = Camera {
        projection,
        ..camera.clone()
    };
    let forward = camera.forward();
    let depth = about.map(|about| (about - camera.position).dot(forward));
    let Some(depth) = depth.filter(|depth| 0.0 < *depth && projection != camera.projection) else {
        return next;
    };
    let equal_size_depth = camera.orthographic_height * camera.projection_distance;
    if (equal_size_depth / depth).ln().abs() < MAX_SIZE_CHANGE.ln() {
        return next;
    }
    match projection {
        Projection::Orthographic => {
            set_orthographic_height(&mut next, depth / camera.projection_distance);
        }
        Projection::Perspective => next.position += forward * (depth - equal_size_depth),
    }
    next
}

/// The camera that fits everything into the picture, or everything that is selected.
pub fn framing_camera(editor: &Editor, only_selected: bool) -> Option<Camera> {
    let scene = editor.shown();
    let selected = Movable::of(editor.selection(), scene);
    let bounds = around(selected.iter().filter_map(Movable::bounds));
    let all = scene.surroundings();
    let (low, high) = bounds.filter(|_| only_selected).or(all)?;
    // A light without a marker is a point: show some of its surroundings.
    let size = all.map_or(0.0, |(low, high)| (high - low).length());
    let margin = match (low != high, size > 0.0) {
        (true, _) => 0.0,
        (false, true) => size * MIN_FRAMED_SHARE,
        (false, false) => 1.0,
    };
    let margin = DVec3::splat(margin);
    let middle = low.midpoint(high);
    let bounds = (low.min(middle - margin), high.max(middle + margin));
    Some(scene.camera.around(scene.render.aspect_ratio(), bounds))
}

/// Returns whether the whole selection is certainly out of view: the bounding sphere of each item is beside the
/// picture or behind the camera.
pub fn is_selection_out_of_view(editor: &Editor) -> bool {
    let scene = editor.shown();
    let selected = Movable::of(editor.selection(), scene);
    let Some(framing) = scene.camera.framing() else {
        return false;
    };
    let sides = sides(&framing, scene.render.aspect_ratio());
    let is_out = |(low, high): (DVec3, DVec3)| {
        let (middle, radius) = (low.midpoint(high), (high - low).length() / 2.0);
        let mut sides = sides.iter();
        sides.any(|(on, inwards)| (middle - *on).dot(*inwards) < -radius)
    };
    let mut bounds = selected.iter().map(Movable::bounds);
    !selected.is_empty() && bounds.all(|bounds| bounds.is_some_and(is_out))
}

/// The planes that bound the visible volume, through the four sides of the picture and through the camera; each as
/// a point on it and the unit normal that points inwards.
fn sides(framing: &Framing, aspect: f64) -> [(DVec3, DVec3); 5] {
    let (x, y) = (aspect / 2.0, 0.5);
    let corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|corner| framing.ray(corner));
    let (middle, forward) = framing.ray([0.0, 0.0]);
    let side = |n: usize| {
        let ((a, direction), (b, next_direction)) = (corners[n], corners[(n + 1) % 4]);
        let normal = direction.cross(b + next_direction - a).normalize_or_zero();
        let is_inwards = normal.dot(middle + forward - a) > 0.0;
        (a, if is_inwards { normal } else { -normal })
    };
    [side(0), side(1), side(2), side(3), (middle, forward)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MAX_COORDINATE, MIN_ORTHOGRAPHIC_HEIGHT};
    use egui::{Rect, pos2, vec2};

    fn screen(camera: &Camera) -> Screen {
        let view = Rect::from_min_size(pos2(0.0, 0.0), vec2(800.0, 400.0));
        Screen::new(camera, view).expect("a basis")
    }

    fn cameras() -> [Camera; 2] {
        [Projection::Perspective, Projection::Orthographic].map(|projection| Camera {
            projection,
            ..Camera::default()
        })
    }

    #[test]
    fn another_projection_shows_what_is_in_the_middle_about_as_large() {
        for camera in cameras() {
            let other = match camera.projection {
                Projection::Perspective => Projection::Orthographic,
                Projection::Orthographic => Projection::Perspective,
            };
            let forward = camera.look_at.normalize();
            let at = |depth: f64| camera.position + forward * depth + camera.up * 7.0;
            // At this depth, both projections show the same size.
            let usual = camera.orthographic_height * camera.projection_distance;
            for depth in [0.5 * usual, 2.0 * usual, -1.0] {
                let seen = projected(&camera, Some(at(depth)), other);
                let only = Camera {
                    projection: other,
                    ..camera.clone()
                };
                assert_eq!(seen, only, "{depth}");
            }
            for depth in [0.01 * usual, 10.0 * usual] {
                let seen = projected(&camera, Some(at(depth)), other);
                let unit = |camera: &Camera| screen(camera).unit_at(at(depth));
                assert_eq!(
                    projected(&camera, Some(at(depth)), camera.projection),
                    camera
                );
                let (before, after) = (unit(&camera), unit(&seen));
                assert!((before - after).abs() < 1e-9 * before, "{before} {after}");
            }
        }
    }

    #[test]
    fn what_is_under_the_pointer_stays_there() {
        for camera in cameras() {
            let point = camera.position + DVec3::new(-60.0, -50.0, -90.0);
            let before = screen(&camera).place(point).expect("in front");
            let near = dollied(&camera, point, 120.0);
            assert!((screen(&near).place(point).expect("in front") - before).length() < 1e-2);
            let moved = vec2(31.0, -12.0);
            let panned = panned(&camera, &screen(&camera), point, moved);
            let after = screen(&panned).place(point).expect("in front");
            assert!((after - before - moved).length() < 1e-2, "{after} {before}");
        }
    }

    #[test]
    fn parallel_projection_is_zoomed_as_far_as_is_valid() {
        let [_, camera] = cameras();
        let point = camera.position + DVec3::new(-60.0, -50.0, -90.0);
        for (wheel, limit) in [(1e6, MIN_ORTHOGRAPHIC_HEIGHT), (-1e6, MAX_COORDINATE)] {
            let end = dollied(&camera, point, wheel);
            assert_eq!(end.orthographic_height, limit);
            assert!(end.position.is_finite());
            // There, it stays.
            assert_eq!(dollied(&end, point, wheel), end);
        }
    }

    #[test]
    fn what_is_framed_fits() {
        let corners = (DVec3::new(-10.0, 0.0, -30.0), DVec3::new(20.0, 15.0, 5.0));
        for camera in cameras() {
            for aspect in [2.0, 0.5] {
                let screen = Screen::new(
                    &camera.around(aspect, corners),
                    Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0 * aspect as f32, 400.0)),
                );
                let screen = screen.expect("a basis");
                for corner in 0..8 {
                    let part = |axis: usize| {
                        if corner >> axis & 1 == 0 {
                            corners.0[axis]
                        } else {
                            corners.1[axis]
                        }
                    };
                    let place = screen.place(DVec3::new(part(0), part(1), part(2)));
                    assert!(
                        screen.view.contains(place.expect("in front")),
                        "{aspect} {place:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_view_along_an_axis_looks_at_the_middle() {
        let camera = Camera::default();
        let middle = DVec3::new(3.0, -5.0, 7.0);
        for direction in [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Y] {
            let seen = looking_along(&camera, middle, direction);
            assert_eq!(seen.basis().expect("a basis").z_axis, -direction);
            let towards = (middle - seen.position).normalize();
            assert!(towards.abs_diff_eq(direction, 1e-12), "{towards}");
        }
    }
}
