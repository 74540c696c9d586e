//! Queries by single rays, in double precision and without a picture: for what is drawn over the picture and for the
//! depth of what it shows.
//!
//! They run in pieces that can be stopped.

use glam::DVec3;
use rayon::current_num_threads;
use rayon::iter::{IntoParallelIterator as _, ParallelExtend as _, ParallelIterator as _};

use super::candidates::{Candidates, Targets};
use super::control::RenderControl;
use super::doubt::DoubtScope;
use super::entry_points::EntryPoints;
use super::intersect::Kernel;
use super::paths::{IgnoredPrimitive, Paths};
use crate::animate::Landmark;
use crate::plan::{Plan, Planner, RenderRequest};
use crate::primitive::{Blur, Ray};
use crate::scene::{Camera, Framing, List, Object, Scene, Take};
use crate::simd::Vec3;

/// The visible objects of a scene, without the markers of lights.
#[derive(Clone, Debug)]
pub struct SceneQuery {
    plan: Plan<f64>,
    candidates: Candidates,
}

/// A query that is kept for reuse: the next one may be about the same objects, seen from elsewhere.
#[derive(Clone, Debug, Default)]
pub struct CachedQuery(Option<(List<Object>, SceneQuery)>);

impl CachedQuery {
    /// Returns the query of a scene. It is reused for the same objects, and meshes that are ready in `planner` are
    /// not packed again.
    pub fn of(&mut self, scene: &Scene, planner: &Planner) -> &SceneQuery {
        let known = self.0.take();
        let known = known.filter(|(objects, _)| objects.is_same(&scene.objects));
        let fresh = || (scene.objects.clone(), SceneQuery::of(scene, planner));
        &self.0.insert(known.unwrap_or_else(fresh)).1
    }
}

impl SceneQuery {
    /// Plans the visible objects of a scene, which must pass [`crate::scene::check`].
    pub fn new(scene: &Scene) -> Self {
        Self::of(scene, &Planner::default())
    }

    fn of(scene: &Scene, planner: &Planner) -> Self {
        // No query depends on lights.
        let unlit = Scene {
            lights: List::new(),
            ..scene.clone()
        };
        let request = RenderRequest::sized(1, 1);
        let mut query_planner = Planner::default();
        query_planner.share_meshes(planner);
        let plan = Plan::new(&unlit, &request, &mut query_planner.double);
        Self {
            candidates: Candidates::all(&plan),
            plan,
        }
    }

    /// Returns the distance of the first object along a ray with a unit direction; infinity for the sky.
    pub fn distance(&self, origin: DVec3, direction: DVec3) -> f64 {
        let paths = Paths {
            rays: Ray {
                origin: Vec3::from_dvec3(origin - self.plan.centre),
                direction: Vec3::from_dvec3(direction),
            },
            ignored: IgnoredPrimitive::nothing(()),
        };
        let kernel = Kernel::<f64, true> {
            token: (),
            plan: &self.plan,
        };
        let targets = Targets {
            candidates: &self.candidates,
            entry_points: &EntryPoints::default(),
            light: None,
            culled_faces: &[],
        };
        let rays = (&paths, Blur::NONE, DoubtScope::Nothing);
        let (nearest, _) = kernel.nearest(targets, rays, true, &mut Vec::new());
        nearest.t
    }

    /// Returns whether nothing stands between two points. What is at the second point itself does not count.
    pub fn is_clear(&self, from: DVec3, to: DVec3) -> bool {
        let offset = to - from;
        match offset.try_normalize() {
            Some(direction) => self.distance(from, direction) >= offset.length() * (1.0 - 1e-6),
            None => true,
        }
    }
}

/// Rays along each side of the grid that [`survey`] casts.
const SURVEY_SIDE: u32 = 5;

/// Appends to `seen` what the remaining samples of a recorded flight see of the scene, at a grid of places in a
/// picture that is `aspect` times as wide as high. If `control` is stopped, only some samples are added, at least
/// one per thread. Returns whether all are done.
pub fn survey(
    take: &Take,
    query: &SceneQuery,
    aspect: f64,
    seen: &mut Vec<Vec<Landmark>>,
    control: &RenderControl,
) -> bool {
    let sample = |sample: usize| {
        let framing = take.camera(sample).and_then(|camera| camera.framing());
        framing.map_or(Vec::new(), |framing| query.sample_grid(&framing, aspect))
    };
    while seen.len() < take.samples.len() {
        let last = take.samples.len().min(seen.len() + current_num_threads());
        seen.par_extend((seen.len()..last).into_par_iter().map(sample));
        if control.is_stopped() {
            break;
        }
    }
    seen.len() == take.samples.len()
}

/// Returns for each point whether nothing stands between it and the camera; `None` if `control` is stopped.
pub fn visible(
    query: &SceneQuery,
    camera: &Camera,
    points: &[DVec3],
    control: &RenderControl,
) -> Option<Vec<(DVec3, bool)>> {
    let framing = camera.framing();
    let is_visible = |point: DVec3| {
        framing.is_some_and(|framing| {
            let from = framing.project(point).map(|at| framing.ray(at).0);
            from.is_some_and(|from| query.is_clear(from, point))
        })
    };
    let points = points.iter().map(|&point| {
        let is_stopped = control.is_stopped();
        (!is_stopped).then(|| (point, is_visible(point)))
    });
    points.collect()
}

impl SceneQuery {
    /// Returns what is seen at a grid of places in the picture.
    fn sample_grid(&self, framing: &Framing, aspect: f64) -> Vec<Landmark> {
        let last = f64::from(SURVEY_SIDE - 1);
        // Parallel rays all see the same place of the sky.
        let is_parallel = framing
            .project_direction(framing.ray([0.0, 0.0]).1)
            .is_none();
        let all = (0..SURVEY_SIDE * SURVEY_SIDE).map(|n| {
            let (x, y) = (f64::from(n % SURVEY_SIDE), f64::from(n / SURVEY_SIDE));
            let at = [(x / last - 0.5) * aspect, y / last - 0.5];
            let (origin, direction) = framing.ray(at);
            let distance = self.distance(origin, direction);
            let is_sky = distance.is_infinite();
            let what = if is_sky {
                direction
            } else {
                origin + direction * distance
            };
            Landmark { at, what, is_sky }
        });
        all.filter(|seen| !(seen.is_sky && is_parallel)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demo_is_seen_where_it_is() {
        let query = SceneQuery::new(&Scene::demo());
        let down = DVec3::new(0.0, -1.0, 0.0);
        // Sphere 1: centre (125, 50, -150), radius 50, on the plane y = 0.
        let above = DVec3::new(125.0, 300.0, -150.0);
        assert!((query.distance(above, down) - 200.0).abs() < 1e-9);
        assert!(query.is_clear(above, DVec3::new(125.0, 100.0, -150.0)));
        assert!(!query.is_clear(above, DVec3::new(125.0, 99.0, -150.0)));
        let ground = DVec3::new(1000.0, 30.0, 1000.0);
        assert_eq!(query.distance(ground, down), 30.0);
        assert_eq!(query.distance(ground, -down), f64::INFINITY);
    }
}
