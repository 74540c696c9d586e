//! The lights that shine on what the eye can reach.

use std::sync::Arc;

use glam::DVec3;

use super::geometry::Geometry;
use super::idle::IdleFaces;
use super::plane_occluders::PlaneOccluder;
use super::request::Model;
use crate::primitive::roundings;
use crate::scene::Scene;
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
    pub idle_faces: Vec<Option<Arc<IdleFaces>>>,
    /// Numbers of primitives whose planes hold the light: they cast no shadow from it.
    pub holders: Vec<usize>,
    /// What rounding may have moved its position by, in the scene file as well.
    pub rounding: R,
    /// Whether it may be in the plane of something: what it is no higher above than that is not lit.
    pub may_be_level: bool,
    /// Whether it may be on a surface: what is no farther from it than that does not stand before it.
    pub may_touch: bool,
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
/// the numbers of what is flat and holds it.
pub fn pack_lights<R: Real>(
    scene: &Scene,
    centre: DVec3,
    (occluders, model): (&[PlaneOccluder], Model),
    (touches, holders): (impl Fn(usize) -> bool, impl Fn(usize) -> Vec<usize>),
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
            let in_world = light.position.abs().max_element() * roundings::<f64>();
            PointLight {
                position,
                place: light.position,
                intensity: R::from_f64(light.intensity),
                shadow_culled_faces: Vec::new(),
                idle_faces: Vec::new(),
                holders: holders(index),
                rounding: position.max_abs() * roundings() + R::from_f64(in_world),
                may_be_level: may_touch || has_meshes,
                may_touch,
            }
        })
        .collect()
}
