//! The lights that can shine on what the eye can reach.

use std::sync::Arc;

use glam::DVec3;

use super::contacts::LightContacts;
use super::culled_faces::CulledFaces;
use super::geometry::Geometry;
use super::plane_occluders::PlaneOccluder;
use super::request::Model;
use crate::primitive::roundings;
use crate::scene::{Light, Scene, Shape, unit};
use crate::simd::{Real, Vec3};

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight<R> {
    /// Position relative to the scene's middle.
    pub position: Vec3<R>,
    /// Position in the world.
    pub world_position: DVec3,
    /// > 0.
    pub intensity: R,
    /// The sum with those of all lights around it whose shadows have the same edges: by so much an edge shows.
    pub edge_intensity: R,
    /// For each triangle, whether others cast all of its shadow; empty if no such triangles are known.
    pub shadow_culled_faces: Vec<bool>,
    /// For each mesh of the geometry, the faces that shadow rays skip, if any are known: those that contain the
    /// light, or whose shadow is also cast by other faces.
    pub culled_faces: Vec<Option<Arc<CulledFaces>>>,
    /// Numbers of the listed primitives whose plane or surface contains the light. Shadow rays do not test them.
    pub holders: Vec<usize>,
    /// The ball among them, if there is one.
    pub ball: HoldingBall<R>,
    /// Upper bound of the rounding error of its position, including the rounding in the scene file.
    pub rounding: R,
    /// Whether it may be in the plane of a surface: surfaces are then lit only if it is above them by more than
    /// rounding.
    pub may_be_in_plane: bool,
    /// Whether it may be on a surface: anything within rounding of it then casts no shadow.
    pub may_be_on_surface: bool,
}

/// A ball whose surface contains a light. A ray to the light hits the ball at the light and, if it comes from
/// behind the tangent plane there, once before: by the length of the chord, which is the diameter times the cosine
/// of the angle between ray and normal. Rounding decides neither of these hits.
#[derive(Clone, Copy, Debug)]
pub struct HoldingBall<R> {
    /// Outward unit normal at the light times the diameter; zero without a ball.
    pub chord: Vec3<R>,
    /// Twice its radius.
    pub diameter: R,
}

impl<R: Real> HoldingBall<R> {
    /// The ball of a shape that contains the light; one without a size for any other shape.
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

/// Largest distance of a light, in sizes of the tree, at which it serves as an apex: beyond, its position is
/// rounded by more than the boxes differ.
const MAX_APEX_DISTANCE: f64 = 16.0;

impl<R: Real> PointLight<R> {
    /// The point where the rays to the light converge, if it is near enough for boxes to be tested against rays
    /// from there.
    #[inline(always)]
    pub fn apex(&self, geometry: &Geometry<R>) -> Option<Vec3<R>> {
        let farthest = geometry.bvh.bounds.max_abs() * R::from_f64(MAX_APEX_DISTANCE);
        (self.position.max_abs() <= farthest).then_some(self.position)
    }
}

/// Distance of two lights, as a share of the scene's extent, up to which the edges of their shadows fall together.
const SAME_SHADOWS: f64 = 0.01;

/// Returns for each light the sum of the intensities of the visible lights around it, and of its own.
fn edge_intensities(scene: &Scene) -> Vec<f64> {
    let extent = scene
        .surroundings()
        .map_or(0.0, |(low, high)| low.distance(high));
    let lights = scene.lights.iter().enumerate();
    let shining = lights.filter(|(_, light)| light.visible);
    let mut shining: Vec<(usize, &Light)> = shining.collect();
    shining.sort_by(|(_, one), (_, other)| one.position.x.total_cmp(&other.position.x));
    let mut sums: Vec<f64> = scene.lights.iter().map(|light| light.intensity).collect();
    let near = SAME_SHADOWS * extent;
    for (rank, (index, one)) in shining.iter().enumerate() {
        let others = shining[rank + 1..].iter();
        let beside = others.take_while(|(_, other)| other.position.x - one.position.x <= near);
        for (other, light) in
            beside.filter(|(_, light)| light.position.distance(one.position) <= near)
        {
            sums[*index] += light.intensity;
            sums[*other] += one.intensity;
        }
    }
    sums
}

/// Packs the lights that shine on what the eye can reach. `number` returns the number of the primitive of an object, if
/// that is in contact with something and not in the tree.
pub fn pack_lights<R: Real>(
    scene: &Scene,
    centre: DVec3,
    occluders: &[PlaneOccluder],
    model: Model,
    contacts: &LightContacts,
    number: impl Fn(&usize) -> Option<usize>,
) -> Vec<PointLight<R>> {
    let all = model == Model::Everything;
    let edge_intensities = edge_intensities(scene);
    // Whether a light is in the plane of any face of a mesh is unknown.
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
            let may_be_on_surface = contacts.touching.get(index) == Some(&true);
            let flat = contacts.held_by.get(index).into_iter().flatten();
            let ball = contacts.on_balls.get(index).copied().flatten();
            // If it is in the tree, rays test it like everything else.
            let ball = ball.filter(|object| number(object).is_some());
            let holding_shape = ball.map(|object| &scene.objects[object].shape);
            let world_rounding = light.position.abs().max_element() * roundings::<f64>();
            PointLight {
                position,
                world_position: light.position,
                intensity: R::from_f64(light.intensity),
                edge_intensity: R::from_f64(edge_intensities[index]),
                shadow_culled_faces: Vec::new(),
                culled_faces: Vec::new(),
                holders: flat.chain(&ball).filter_map(&number).collect(),
                ball: HoldingBall::new(holding_shape, light.position),
                rounding: position.max_abs() * roundings() + R::from_f64(world_rounding),
                may_be_in_plane: may_be_on_surface || has_meshes,
                may_be_on_surface,
            }
        })
        .collect()
}
