//! Mapping between the scene and the picture on screen.

use egui::{Pos2, Rect, vec2};
use glam::DVec3;

use crate::scene::{Camera, Framing, Projection, Shape};

/// Maps points of the scene to the screen, and screen positions to rays.
#[derive(Clone, Debug)]
pub struct Screen {
    framing: Framing,
    camera: Camera,
    /// Rectangle of the picture.
    pub view: Rect,
}

impl Screen {
    /// Creates the mapping of a camera whose picture is at `view`; `None` if the camera has no valid basis.
    pub fn new(camera: &Camera, view: Rect) -> Option<Self> {
        Some(Self {
            framing: camera.framing()?,
            camera: camera.clone(),
            view,
        })
    }

    /// Position of a point on the screen; `None` if it is behind the camera.
    pub fn place(&self, point: DVec3) -> Option<Pos2> {
        let [x, y] = self.framing.project(point)?;
        let height = self.view.height();
        Some(self.view.center() + vec2(x as f32 * height, -y as f32 * height))
    }

    /// Origin and unit direction of the ray through a screen position.
    pub fn ray(&self, at: Pos2) -> (DVec3, DVec3) {
        let offset = (at - self.view.center()) / self.view.height();
        self.framing
            .ray([f64::from(offset.x), f64::from(-offset.y)])
    }

    /// The viewing direction of the camera.
    pub fn forward(&self) -> DVec3 {
        self.ray(self.view.center()).1
    }

    /// World units per screen point at the depth of `point`.
    pub fn unit_at(&self, point: DVec3) -> f64 {
        let height = match self.camera.projection {
            Projection::Perspective => {
                let depth = (point - self.camera.position).dot(self.forward());
                depth.abs() / self.camera.projection_distance
            }
            Projection::Orthographic => self.camera.orthographic_height,
        };
        height / f64::from(self.view.height())
    }

    /// Intersection of the ray through a screen position with the plane through a point; `None` if the ray is
    /// parallel to the plane, or the plane is behind the camera.
    pub fn on_plane(&self, at: Pos2, point: DVec3, normal: DVec3) -> Option<DVec3> {
        let (origin, direction) = self.ray(at);
        let t = (point - origin).dot(normal) / direction.dot(normal);
        (t.is_finite() && t > 0.0).then(|| origin + direction * t)
    }

    /// Parameter, in units of `direction`, of the point on the line through `point` that is nearest to a screen
    /// position; `None` if the line is seen end-on.
    pub fn along(&self, at: Pos2, point: DVec3, direction: DVec3) -> Option<f64> {
        let (origin, ray) = self.ray(at);
        // The point of the line that is closest to the ray.
        let across = direction.cross(ray);
        let size = across.length_squared();
        let t = (origin - point).cross(ray).dot(across) / size;
        (size > 1e-9 * direction.length_squared()).then_some(t)
    }

    /// Intersection of the ray through a screen position with a shape that is seen there; for meshes, the depth of
    /// their middle is assumed.
    pub fn on_shape(&self, at: Pos2, shape: &Shape) -> Option<DVec3> {
        match shape {
            Shape::Sphere(ball) => {
                let (origin, direction) = self.ray(at);
                let arm = ball.center - origin;
                let along = arm.dot(direction);
                let off = (arm - direction * along).length_squared();
                let half = (ball.radius * ball.radius - off).max(0.0).sqrt();
                // From inside, the far side is seen.
                let near = along - half;
                let t = if near > 0.0 { near } else { along + half };
                Some(origin + direction * t)
            }
            Shape::Plane(plane) => self.on_plane(at, plane.point, plane.normal),
            Shape::Disc(disc) => self.on_plane(at, disc.center, disc.normal),
            Shape::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                self.on_plane(at, a, (b - a).cross(c - a))
            }
            Shape::Mesh(_) => {
                let (low, high) = shape.bounds()?;
                self.on_plane(at, low.midpoint(high), self.forward())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Plane, Sphere};
    use egui::pos2;

    fn screen(projection: Projection) -> Screen {
        let camera = Camera {
            projection,
            ..Camera::default()
        };
        let view = Rect::from_min_size(pos2(100.0, 50.0), vec2(600.0, 400.0));
        Screen::new(&camera, view).expect("a basis")
    }

    #[test]
    fn what_is_met_is_seen_where_it_was_pointed_at() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let screen = screen(projection);
            let at = pos2(380.0, 260.0);
            let shapes = [
                Shape::Plane(Plane {
                    point: DVec3::ZERO,
                    normal: DVec3::Y,
                }),
                Shape::Sphere(Sphere {
                    center: screen.ray(at).0 + screen.ray(at).1 * 90.0,
                    radius: 40.0,
                }),
            ];
            for shape in shapes {
                let point = screen.on_shape(at, &shape).expect("it is met");
                let found = screen.place(point).expect("in front");
                assert!((found - at).length() < 1e-3, "{projection:?} {found}");
                let beside = screen.place(
                    point + screen.forward().any_orthonormal_vector() * screen.unit_at(point),
                );
                let width = (beside.expect("in front") - found).length();
                assert!((width - 1.0).abs() < 1e-3, "{width}");
            }
        }
    }

    #[test]
    fn along_a_line_is_where_the_pointer_is() {
        let screen = screen(Projection::Perspective);
        let (point, direction) = (DVec3::new(60.0, 20.0, -130.0), DVec3::new(0.0, 1.0, 0.0));
        let at = screen.place(point + direction * 25.0).expect("in front");
        let along = screen.along(at, point, direction).expect("not along");
        assert!((along - 25.0).abs() < 1e-3, "{along}");
    }
}
