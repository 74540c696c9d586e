//! What a single ray sees, in double precision and without a picture: for what is drawn over the
//! picture and for the depth of what the picture shows.

use glam::DVec3;

use crate::primitive::{Kind, Packing, Primitive, Primitives, Ray, Visit, count_corner_users};
use crate::scene::{Methods, Scene};
use crate::simd::Vec3;

/// The visible objects of a scene; markers of lights are not among them.
#[derive(Clone, Debug, Default)]
pub struct SceneQuery {
    primitives: Primitives<f64>,
}

/// Looks for the nearest hit of one ray.
struct Distance {
    ray: Ray<f64>,
    methods: Methods,
    t: f64,
}

impl Visit<f64> for Distance {
    fn visit<P: Primitive<f64>>(&mut self, _kind: Kind, primitives: &[P], _first: usize) {
        let prepared = P::prepare(self.ray.direction);
        for primitive in primitives {
            let t = primitive.intersect(&self.ray, &prepared, &self.methods);
            self.t = self.t.min(t);
        }
    }
}

impl SceneQuery {
    /// What can be seen of a scene, which must pass [`crate::scene::check`].
    pub fn new(scene: &Scene) -> Self {
        let mut primitives = Primitives::default();
        let packing = Packing {
            centre: DVec3::ZERO,
            corner_users: &count_corner_users(scene),
            projector: None,
        };
        for object in scene.objects.iter().filter(|object| object.visible) {
            primitives.push(&object.shape, 0, &packing);
        }
        Self { primitives }
    }

    /// How far the first object is along a ray with a unit direction; infinity for the sky.
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let mut distance = Distance {
            ray: Ray {
                origin: Vec3::from_dvec3(origin),
                direction: Vec3::from_dvec3(direction),
            },
            methods: Methods::default(),
            t: f64::INFINITY,
        };
        self.primitives.visit(&mut distance);
        distance.t
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
