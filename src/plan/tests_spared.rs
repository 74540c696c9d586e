//! How many tests the tree spares the rays of a picture.

use super::bvh::Bvh;
use super::geometry::{Geometry, PlanCache};
use super::pack::Plan;
use super::request::RenderRequest;
use crate::primitive::{BoundingBox, Ray};
use crate::scene::Scene;
use crate::simd::Vec3;

/// Number of sampled rays along each side of the picture.
const RAYS_PER_SIDE: u32 = 48;

/// Counts of what rays are tested against.
#[derive(Debug, Default)]
struct Tests {
    boxes: u64,
    primitives: u64,
}

/// Returns in words how many tests the tree of a scene spares the camera rays of `request`; `None` if no tree is
/// traversed. Counts everything along a ray, also behind its hit, so that the actual saving is larger.
pub fn tests_spared(scene: &Scene, request: &RenderRequest) -> Option<String> {
    let plan = Plan::<f64>::new(scene, request, &mut PlanCache::default());
    let geometry = plan.geometry.as_ref().filter(|_| plan.is_boxed)?;
    let all = plan.bounded();
    let mut tests = Tests::default();
    let position =
        |step: u32, side: u32| (f64::from(step) + 0.5) / f64::from(RAYS_PER_SIDE) * f64::from(side);
    for row in 0..RAYS_PER_SIDE {
        for column in 0..RAYS_PER_SIDE {
            let (x, y) = (
                position(column, request.width),
                position(row, request.height),
            );
            let (origin, direction) = plan.view.rays::<f64>(x, y);
            geometry.count(Ray { origin, direction }, &mut tests);
        }
    }
    let rays = f64::from(RAYS_PER_SIDE * RAYS_PER_SIDE);
    let [boxes, primitives] = [tests.boxes, tests.primitives].map(|tests| tests as f64 / rays);
    let tested = boxes + primitives;
    let boxes = format!("{boxes:.0}");
    let plural = if boxes == "1" { "" } else { "es" };
    Some(format!(
        "{:.2} % of the tests of this picture's camera rays: {boxes} box{plural} and {primitives:.1} primitives instead of {all} for each",
        (1.0 - tested / all as f64).max(0.0) * 100.0
    ))
}

impl Geometry<f64> {
    fn count(&self, ray: Ray<f64>, tests: &mut Tests) {
        let listed = self.primitives.len();
        for member in tests.members_met(&self.bvh, &ray) {
            match (member as usize).checked_sub(listed) {
                None => tests.primitives += 1,
                Some(mesh) => {
                    let mesh = &self.meshes[mesh];
                    let ray = Ray {
                        origin: ray.origin - mesh.centre,
                        ..ray
                    };
                    tests.primitives += tests.members_met(&mesh.mesh.bvh, &ray).len() as u64;
                }
            }
        }
    }
}

impl Tests {
    /// The members of a tree whose boxes a ray hits; counts the boxes that are tested.
    fn members_met(&mut self, bvh: &Bvh<f64>, ray: &Ray<f64>) -> Vec<u32> {
        bvh.members_where(|bounds| {
            self.boxes += 1;
            is_hit(bounds, ray)
        })
    }
}

/// Returns whether a ray hits a box; along its sides, the result may be either.
fn is_hit(bounds: &BoundingBox<f64>, ray: &Ray<f64>) -> bool {
    let [low, high, origin, direction] =
        [bounds.low, bounds.high, ray.origin, ray.direction].map(Vec3::to_dvec3);
    let (one, other) = ((low - origin) / direction, (high - origin) / direction);
    one.min(other).max_element().max(0.0) <= one.max(other).min_element()
}
