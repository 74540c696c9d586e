//! The lights that shine on what the eye can reach.

use std::sync::Arc;

use glam::DVec3;

use super::culled_faces::CulledFaces;
use super::geometry::Geometry;
use super::plane_occluders::PlaneOccluder;
use super::request::Model;
use crate::primitive::roundings;
use crate::scene::{Scene, Shape, unit};
use crate::simd::{Real, Vec3};

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight<R> {
    /// Where it shines from.
    pub position: Vec3<R>,
    /// The same in the world.
    pub place: DVec3,
    /// > 0.
    pub intensity: R,
    /// For each triangle, whether another one casts all of its shadow; empty where none is known.
    pub shadow_culled_faces: Vec<bool>,
    /// For each mesh of the geometry, the faces that hold the light, or cast no shadow which others do not, if some are
    /// known.
    pub culled_faces: Vec<Option<Arc<CulledFaces>>>,
    /// Numbers of primitives that hold the light: no ray is held against them to see whether they are before it.
    pub holders: Vec<usize>,
    /// The ball among them, if one is.
    pub ball: HoldingBall<R>,
    /// What rounding may have moved its position by, in the scene file as well.
    pub rounding: R,
    /// Whether it may be in the plane of something: what it is no higher above than that is not lit.
    pub may_be_level: bool,
    /// Whether it may be on a surface: what is no farther from it than that does not stand before it.
    pub may_touch: bool,
}

/// A ball whose surface holds a light. A ray to the light meets it there, and, where it comes from behind the plane that
/// touches the ball there, once more: so far before the light as the chord is long, which is the diameter times the
/// cosine of the angle between the ray and the normal. Rounding decides about neither.
#[derive(Clone, Copy, Debug)]
pub struct HoldingBall<R> {
    /// Its normal at the light, outwards, times its diameter; zero where there is no ball.
    pub chord: Vec3<R>,
    /// Twice its radius.
    pub diameter: R,
}

impl<R: Real> HoldingBall<R> {
    /// What an object is to a light there; none if it is no ball.
    fn new(shape: Option<&Shape>, light: DVec3) -> Self {
        let (center, diameter) = match shape {
            Some(Shape::Sphere(ball)) => (ball.center, 2.0 * ball.radius),
            _ => (light, 0.0),
        };
        let normal = unit(light - center).unwrap_or_default();
        Self {
            chord: Vec3::from_dvec3(normal * diameter),
            diameter: R::from_f64(diameter),
        }
    }
}

/// A light that is farther away than so many times what stands in a tree is rounded by more than its boxes differ.
const FARTHEST_APEX: f64 = 16.0;

impl<R: Real> PointLight<R> {
    /// Where the rays that go to it come together, if that is near enough to be told from there where they start.
    #[inline(always)]
    pub fn apex(&self, geometry: &Geometry<R>) -> Option<Vec3<R>> {
        let farthest = geometry.bvh.bounds.max_abs() * R::from_f64(FARTHEST_APEX);
        (self.position.max_abs() <= farthest).then_some(self.position)
    }
}

/// Lights that shine on what the eye can reach. `touches` tells whether one may be on a surface, `holders` gives
/// the numbers of what holds it, `ball` the place of the ball among that.
pub fn pack_lights<R: Real>(
    scene: &Scene,
    centre: DVec3,
    (occluders, model): (&[PlaneOccluder], Model),
    (touches, holders, ball): (
        impl Fn(usize) -> bool,
        impl Fn(usize) -> Vec<usize>,
        impl Fn(usize) -> Option<usize>,
    ),
) -> Vec<PointLight<R>> {
    let all = model == Model::Everything;
    // Of the planes of a mesh's faces, nobody knows which a light is in.
    let has_meshes = scene.faces() > 0 && !all;
    let lights = scene.lights.iter().enumerate();
    let shining = lights.filter(|(_, light)| light.visible && (all || light.intensity > 0.0));
    shining
        .filter(|(_, light)| {
            occluders
                .iter()
                .all(|plane| plane.side(light.position) >= 0.0)
        })
        .map(|(index, light)| {
            let position: Vec3<R> = Vec3::from_dvec3(light.position - centre);
            let may_touch = touches(index);
            let ball = ball(index).map(|place| &scene.objects[place].shape);
            let in_world = light.position.abs().max_element() * roundings::<f64>();
            PointLight {
                position,
                place: light.position,
                intensity: R::from_f64(light.intensity),
                shadow_culled_faces: Vec::new(),
                culled_faces: Vec::new(),
                holders: holders(index),
                ball: HoldingBall::new(ball, light.position),
                rounding: position.max_abs() * roundings() + R::from_f64(in_world),
                may_be_level: may_touch || has_meshes,
                may_touch,
            }
        })
        .collect()
}
