//! The scene as flat lists of one kind each.

use std::collections::HashMap;

use glam::DVec3;

use super::bvh::LARGEST_LIST;
use super::materials::{Material, linear, pack_materials};
use super::plane_occluders::{PlaneOccluder, classify_planes};
use super::solids::{Corner, Solids, corner};
use super::{
    Accelerator, Ball, Bvh, Methods, Model, RayOffset, RenderRequest, ScreenExtents, SphereMethod,
    TriangleMethod, View,
};
use crate::scene::{LightObj, Projection, Scene, Shape};
use crate::simd::{Real, Vec3};

/// A scene and a view of it, ready to be traced. Coordinates are relative to the scene's middle,
/// so that single precision is spent on the scene and not on its distance from the origin.
#[derive(Clone, Debug)]
pub struct Plan<R> {
    /// Primary rays.
    pub view: View<R>,
    /// Spheres: first those that cast shadows, then the markers of the lights.
    pub spheres: Vec<Sphere<R>>,
    /// How many of [`Self::spheres`] cast shadows.
    pub casting_spheres: usize,
    /// Planes.
    pub planes: Vec<Plane<R>>,
    /// Triangles.
    pub triangles: Vec<Triangle<R>>,
    /// Lights that shine.
    pub lights: Vec<PointLight<R>>,
    /// What the primitives' `material` numbers mean.
    pub materials: Vec<Material<R>>,
    /// Colour of a ray that hits nothing, 0–1.
    pub background: Vec3<R>,
    /// How many reflections a ray may have behind it and still spawn another.
    pub reflection_limit: u32,
    /// The formulas to trace with.
    pub methods: Methods,
    /// Where shadow and reflection rays start.
    pub departure: RayOrigin<R>,
    /// Whether planes must be tested for shadows. What a perspective eye reaches, directly or in
    /// mirrors, lies on its side of every plane, so a plane blocks a light for all points or none.
    pub planes_cast: bool,
    /// Whether shadow rays are traced even where a surface faces away from the light.
    pub shadows_behind: bool,
    /// Where each sphere and triangle is in the picture; `None` where formulas are in use whose
    /// failures must not be hidden.
    pub screen: Option<ScreenExtents>,
    /// Balls around the spheres, then the triangles.
    pub volumes: Bvh<R>,
    /// For each triangle, whether no camera ray needs it; empty where they all may.
    pub camera_culled_faces: Vec<bool>,
}

/// [`RayOffset`] with its lengths in the scene's units.
#[derive(Clone, Copy, Debug)]
pub enum RayOrigin<R> {
    /// At the hit, ignoring the own primitive.
    AtHit,
    /// So far along the new ray.
    Along(R),
    /// 256 roundings along the normal.
    Roundings,
}

/// A ball.
#[derive(Clone, Copy, Debug)]
pub struct Sphere<R> {
    /// Its middle.
    pub center: Vec3<R>,
    /// > 0.
    pub radius: R,
    /// Index into [`Plan::materials`].
    pub material: u32,
}

/// An endless plane: the points p with normal · p = offset.
#[derive(Clone, Copy, Debug)]
pub struct Plane<R> {
    /// Unit normal.
    pub normal: Vec3<R>,
    /// Distance from the scene's middle along the normal.
    pub offset: R,
    /// Index into [`Plan::materials`].
    pub material: u32,
}

/// A flat triangle.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<R> {
    /// The corners.
    pub corners: [Vec3<R>; 3],
    /// Unit normal, outwards for corners that are clockwise seen from outside.
    pub normal: Vec3<R>,
    /// Whether it shares a corner with another triangle. Its neighbours then shadow it at the seam
    /// unless secondary rays start a few roundings off the surface.
    pub in_mesh: bool,
    /// Its smallest altitude.
    pub thickness: R,
    /// Index into [`Plan::materials`].
    pub material: u32,
}

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight<R> {
    /// Where it shines from.
    pub position: Vec3<R>,
    /// > 0.
    pub intensity: R,
    /// For each triangle, whether another one casts all of its shadow; empty where none is known.
    pub shadow_culled_faces: Vec<bool>,
}

impl<R: Real> Plan<R> {
    /// Packs what `request` of `scene` can show. The scene must pass [`crate::scene::check`].
    pub fn new(scene: &Scene, request: &RenderRequest) -> Self {
        let centre = scene
            .bounds()
            .map_or(scene.camera.position, |(low, high)| low * 0.5 + high * 0.5);
        let (settled, model) = (classify_planes(scene, request), request.model);
        let mut plan = Self {
            view: View::new(&scene.camera, request, centre),
            spheres: Vec::new(),
            casting_spheres: 0,
            planes: Vec::new(),
            triangles: Vec::new(),
            lights: pack_lights(scene, centre, settled.as_deref().unwrap_or_default(), model),
            materials: pack_materials(scene, request),
            background: linear(scene.background),
            reflection_limit: scene.render.reflection_limit,
            methods: request.methods,
            departure: departure(scene, request.methods.offset),
            planes_cast: settled.is_none(),
            shadows_behind: model == Model::Everything,
            screen: None,
            volumes: Bvh::default(),
            camera_culled_faces: Vec::new(),
        };
        plan.pack_objects(scene, centre);
        plan.casting_spheres = plan.spheres.len();
        if scene.light_visualization {
            plan.pack_markers(scene, centre);
        }
        // The classic formula hits spheres where they are not: that must show.
        if request.methods.sphere == SphereMethod::Stable && model == Model::Needed {
            plan.screen = Some(ScreenExtents::new(scene, request));
            plan.volumes = plan.bound(request.accelerator);
            // What leaks through a face must not find that those behind it were left out.
            let is_tight = request.methods.triangle == TriangleMethod::Watertight;
            if is_tight && request.methods.offset == RayOffset::Robust {
                plan.drop_far_faces(scene, request, centre);
            }
        }
        plan
    }

    fn pack_objects(&mut self, scene: &Scene, centre: DVec3) {
        let corner_users = count_corner_users(scene);
        for object in scene.objects.iter().filter(|object| object.visible) {
            let material = material_number(scene, &object.color_pack);
            match object.shape {
                Shape::Sphere { center, radius } => self.spheres.push(Sphere {
                    center: Vec3::from_dvec3(center - centre),
                    radius: R::from_f64(radius),
                    material,
                }),
                Shape::Plane { point, normal } => {
                    let Some(normal) = normal.try_normalize() else {
                        continue;
                    };
                    self.planes.push(Plane {
                        normal: Vec3::from_dvec3(normal),
                        offset: R::from_f64(normal.dot(point - centre)),
                        material,
                    });
                }
                Shape::Triangle { a, b, c } => {
                    let Some(normal) = (c - a).cross(b - a).try_normalize() else {
                        continue;
                    };
                    self.triangles.push(Triangle {
                        corners: [a, b, c].map(|corner| Vec3::from_dvec3(corner - centre)),
                        normal: Vec3::from_dvec3(normal),
                        in_mesh: [a, b, c].iter().any(|p| corner_users[&corner(*p)] > 1),
                        thickness: R::from_f64(thickness([a, b, c])),
                        material,
                    });
                }
            }
        }
    }

    /// Finds the faces of solids that camera rays, and shadow rays to each light, can do without.
    fn drop_far_faces(&mut self, scene: &Scene, request: &RenderRequest, centre: DVec3) {
        let triangles = self.triangles.iter();
        let solids = Solids::among(triangles.map(|t| t.corners.map(Vec3::to_dvec3)).collect());
        let projection = request.projection.unwrap_or(scene.camera.projection);
        if projection == Projection::Perspective {
            self.camera_culled_faces = solids.turned_away(scene.camera.position - centre);
        }
        for light in &mut self.lights {
            light.shadow_culled_faces = solids.turned_away(light.position.to_dvec3());
        }
    }

    fn bound(&self, accelerator: Accelerator) -> Bvh<R> {
        let spheres = self.spheres.iter().map(|sphere| Ball {
            center: sphere.center.to_dvec3(),
            radius: sphere.radius.to_f64(),
        });
        let triangles = self
            .triangles
            .iter()
            .map(|triangle| Ball::around_triangle(triangle.corners.map(Vec3::to_dvec3)));
        let balls: Vec<Ball> = spheres.chain(triangles).collect();
        let bundled = match accelerator {
            Accelerator::Auto => balls.len() > LARGEST_LIST,
            Accelerator::List => false,
            Accelerator::Bvh => true,
        };
        Bvh::new(&balls, bundled)
    }

    fn pack_markers(&mut self, scene: &Scene, centre: DVec3) {
        let first_marker_material = scene.color_packs.len();
        for light in scene.lights.iter().filter(|light| light.visible) {
            let Some(LightObj { radius, color_pack }) = &light.marker else {
                continue;
            };
            let pack = material_number(scene, color_pack) as usize;
            self.spheres.push(Sphere {
                center: Vec3::from_dvec3(light.position - centre),
                radius: R::from_f64(*radius),
                material: number(first_marker_material + pack),
            });
        }
    }
}

fn departure<R: Real>(scene: &Scene, offset: RayOffset) -> RayOrigin<R> {
    let along = |distance| RayOrigin::Along(R::from_f64(distance));
    match offset {
        RayOffset::Robust => RayOrigin::AtHit,
        RayOffset::Fixed(distance) => along(distance),
        RayOffset::Relative(share) => {
            let diagonal = scene
                .bounds()
                .map_or(1.0, |(low, high)| (high - low).length());
            along(share * diagonal)
        }
        RayOffset::WachterBinder => RayOrigin::Roundings,
    }
}

/// Lights that shine on what the eye can reach.
fn pack_lights<R: Real>(
    scene: &Scene,
    centre: DVec3,
    walls: &[PlaneOccluder],
    model: Model,
) -> Vec<PointLight<R>> {
    let all = model == Model::Everything;
    let shining = scene
        .lights
        .iter()
        .filter(|light| light.visible && (all || light.intensity > 0.0));
    shining
        .filter(|light| walls.iter().all(|wall| wall.side(light.position) >= 0.0))
        .map(|light| PointLight {
            position: Vec3::from_dvec3(light.position - centre),
            intensity: R::from_f64(light.intensity),
            shadow_culled_faces: Vec::new(),
        })
        .collect()
}

/// Twice the area over the longest side.
fn thickness([a, b, c]: [DVec3; 3]) -> f64 {
    let sides = [b - a, c - b, a - c].map(DVec3::length);
    let longest = sides[0].max(sides[1]).max(sides[2]);
    (b - a).cross(c - a).length() / longest
}

fn material_number(scene: &Scene, pack: &str) -> u32 {
    number(scene.color_packs.get_index_of(pack).unwrap_or_default())
}

fn number(index: usize) -> u32 {
    index as u32
}

/// How many visible triangles meet at each corner.
fn count_corner_users(scene: &Scene) -> HashMap<Corner, usize> {
    let mut users = HashMap::new();
    for object in scene.objects.iter().filter(|object| object.visible) {
        if let Shape::Triangle { a, b, c } = object.shape {
            for point in [a, b, c] {
                *users.entry(corner(point)).or_insert(0) += 1;
            }
        }
    }
    users
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(scene: &Scene) -> Plan<f32> {
        Plan::new(scene, &RenderRequest::sized(64, 64))
    }

    #[test]
    fn hidden_markers_and_objects_are_in_no_list() {
        let mut scene = Scene::demo();
        let full = plan(&scene);
        assert_eq!((full.spheres.len(), full.casting_spheres), (4, 2));
        scene.light_visualization = false;
        assert_eq!(plan(&scene).spheres.len(), 2);
        scene.objects[0].visible = false;
        scene.objects[2].visible = false;
        let sparse = plan(&scene);
        assert_eq!((sparse.spheres.len(), sparse.triangles.len()), (1, 5));
    }

    #[test]
    fn a_light_that_is_off_is_no_light() {
        let mut scene = Scene::demo();
        scene.lights[0].intensity = 0.0;
        assert_eq!(plan(&scene).lights.len(), 1);
        scene.lights[1].visible = false;
        assert_eq!(plan(&scene).lights.len(), 0);
        let mirrors = plan(&scene)
            .materials
            .iter()
            .any(|m| m.surface.is_some_and(|s| s.mirror.is_some()));
        assert!(!mirrors, "without light there is nothing to mirror with");
    }

    #[test]
    fn a_light_behind_a_plane_is_dropped_and_one_on_it_is_not() {
        let mut scene = Scene::demo();
        let lights = |scene: &Scene| (plan(scene).lights.len(), plan(scene).planes_cast);
        assert_eq!(lights(&scene), (2, false));
        scene.lights[0].position.y = -0.001;
        assert_eq!(lights(&scene), (1, false));
        scene.lights[0].position.y = 0.0;
        assert_eq!(lights(&scene), (2, false));
        scene.camera.position.y = 0.0;
        assert_eq!(lights(&scene), (2, true));
        scene.camera.position.y = -5.0;
        assert_eq!(
            lights(&scene),
            (1, false),
            "the one on the floor, seen from below"
        );
        scene.camera.projection = Projection::Orthographic;
        assert_eq!(lights(&scene), (2, true));
    }

    #[test]
    fn triangles_that_share_corners_are_a_mesh() {
        let mut scene = Scene::demo();
        assert!(
            plan(&scene)
                .triangles
                .iter()
                .all(|triangle| triangle.in_mesh)
        );
        scene.objects.truncate(3);
        assert!(
            plan(&scene)
                .triangles
                .iter()
                .all(|triangle| !triangle.in_mesh)
        );
    }

    #[test]
    fn distance_from_the_origin_costs_no_precision() {
        let scene = Scene::demo();
        let mut moved = scene.clone();
        let by = DVec3::new(1e6, -3e6, 2e6);
        for object in &mut moved.objects {
            object.shape = object.shape.moved(by);
        }
        for light in &mut moved.lights {
            light.position = light.position + by;
        }
        moved.camera.position = moved.camera.position + by;
        let (here, there) = (plan(&scene), plan(&moved));
        for (a, b) in here.spheres.iter().zip(&there.spheres) {
            assert_eq!(a.center, b.center);
        }
    }
}
