//! What a single ray sees, in double precision and without a plan: for what is drawn over the
//! picture and for the depth of what the picture shows.

use glam::DVec3;

use super::Ray;
use super::probe::{meet_plane, meet_sphere, meet_triangle};
use crate::plan::{Plane, Sphere, SphereMethod, Triangle, TriangleMethod};
use crate::scene::{Scene, Shape};
use crate::simd::Vec3;

/// The visible objects of a scene; markers of lights are not among them.
#[derive(Clone, Debug, Default)]
pub struct SceneQuery {
    spheres: Vec<Sphere<f64>>,
    planes: Vec<Plane<f64>>,
    triangles: Vec<Triangle<f64>>,
}

impl SceneQuery {
    /// What can be seen of a scene, which must pass [`crate::scene::check`].
    pub fn new(scene: &Scene) -> Self {
        let mut sight = Self::default();
        for object in scene.objects.iter().filter(|object| object.visible) {
            sight.add(&object.shape);
        }
        sight
    }

    fn add(&mut self, shape: &Shape) {
        let material = 0;
        match *shape {
            Shape::Sphere { center, radius } => self.spheres.push(Sphere {
                center: Vec3::from_dvec3(center),
                radius,
                material,
            }),
            Shape::Plane { point, normal } => {
                if let Some(normal) = normal.try_normalize() {
                    self.planes.push(Plane {
                        normal: Vec3::from_dvec3(normal),
                        offset: normal.dot(point),
                        material,
                    });
                }
            }
            Shape::Triangle { a, b, c } => {
                if let Some(normal) = (c - a).cross(b - a).try_normalize() {
                    self.triangles.push(Triangle {
                        corners: [a, b, c].map(Vec3::from_dvec3),
                        normal: Vec3::from_dvec3(normal),
                        in_mesh: true,
                        thickness: 1.0,
                        material,
                    });
                }
            }
        }
    }

    /// How far the first object is along a ray with a unit direction; infinity for the sky.
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let ray = Ray {
            origin: Vec3::from_dvec3(origin),
            direction: Vec3::from_dvec3(direction),
        };
        let spheres = self.spheres.iter();
        let spheres = spheres.map(|sphere| meet_sphere(SphereMethod::Stable, &ray, sphere));
        let planes = self.planes.iter().map(|plane| meet_plane(&ray, plane));
        let triangles = self.triangles.iter();
        let triangles =
            triangles.map(|triangle| meet_triangle(TriangleMethod::Watertight, &ray, triangle));
        let all = spheres.chain(planes).chain(triangles);
        all.fold(f64::INFINITY, f64::min)
    }

    /// Whether nothing stands between two points. What is at the second point itself does not.
    pub fn is_clear(&self, from: DVec3, to: DVec3) -> bool {
        let arm = to - from;
        match arm.try_normalize() {
            Some(direction) => self.distance(from, direction) >= arm.length() * (1.0 - 1e-6),
            None => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demo_is_seen_where_it_is() {
        let sight = SceneQuery::new(&Scene::demo());
        let down = DVec3::new(0.0, -1.0, 0.0);
        // Sphere 1: centre (125, 50, -150), radius 50, on the plane y = 0.
        let above = DVec3::new(125.0, 300.0, -150.0);
        assert!((sight.distance(above, down) - 200.0).abs() < 1e-9);
        assert!(sight.is_clear(above, DVec3::new(125.0, 100.0, -150.0)));
        assert!(!sight.is_clear(above, DVec3::new(125.0, 99.0, -150.0)));
        let ground = DVec3::new(1000.0, 30.0, 1000.0);
        assert_eq!(sight.distance(ground, down), 30.0);
        assert_eq!(sight.distance(ground, -down), f64::INFINITY);
    }
}
