//! The plan of a picture: the scene as flat lists, one per kind of primitive.

use std::collections::HashMap;
use std::sync::Arc;

use glam::DVec3;

use super::balls::Balls;
use super::contacts::{Contacts, Tie};
use super::culled_faces::CulledFaces;
use super::flats::Flats;
use super::geometry::{
    Geometry, PlanCache, belongs_in_tree, material_number, measure_loose, uses_tree,
};
use super::hit_order::HitOrder;
use super::lights::{PointLight, pack_lights};
use super::materials::{Material, linear, pack_materials};
use super::plane_occluders::classify_planes;
use super::ray_origin::{RayOrigin, ray_origin};
use super::request::{Model, RenderRequest};
use super::show::Show;
use super::solids::{count_corner_users, faces_of_solids};
use super::view::View;
use crate::primitive::{
    Blur, BoundingBox, CAUTION, KINDS, Packed, Packing, Primitives, Projector, Rectangle,
};
use crate::scene::{
    Accelerator, Camera, CoordinateFrame, LightObj, Methods, Object, Sampling, Scene, Shape,
    Sphere, SphereMethod,
};
use crate::simd::{Real, Vec3};

/// A scene and a view of it, ready to be traced. Coordinates are relative to the scene's middle, so that single
/// precision is spent on the scene and not on its distance from the origin.
#[derive(Clone, Debug)]
pub struct Plan<R> {
    /// The scene's middle, the origin of all coordinates.
    pub centre: DVec3,
    /// Generates the primary rays.
    pub view: View<R>,
    /// The primitives that are listed per tile: all of them without `geometry`, otherwise those outside of it. The
    /// first spheres are the markers of the lights.
    pub primitives: Primitives<R>,
    /// The number of spheres that are markers, which cast no shadow.
    pub markers: usize,
    /// The objects in the BVH. Their primitives are numbered after those of `primitives`.
    pub geometry: Option<Arc<Geometry<R>>>,
    /// How hits are grouped into packets.
    pub hit_order: HitOrder,
    /// Whether rays test only what is in the boxes they hit; otherwise they test everything in the tree.
    pub is_boxed: bool,
    /// Screen rectangles of balls that together enclose the geometry; empty if unknown.
    pub outline: Vec<Rectangle>,
    /// The lights that can shine on something visible.
    pub lights: Vec<PointLight<R>>,
    /// The materials, indexed by the primitives' `material`.
    pub materials: Vec<Material<R>>,
    /// What the kernels write as colour.
    pub show: Show<R>,
    /// Colour of a ray that hits nothing, 0–1.
    pub background: Vec3<R>,
    /// Maximum number of reflections along a path.
    pub reflection_limit: u32,
    /// The formulas to trace with.
    pub methods: Methods,
    /// Where shadow and reflection rays start.
    pub ray_origin: RayOrigin<R>,
    /// Whether planes must be tested for shadows. Everything that a perspective camera reaches, directly or in
    /// mirrors, is on the camera's side of every plane, so a plane blocks a light for all points or for none.
    pub planes_cast: bool,
    /// Whether shadow rays are traced even where a surface faces away from the light.
    pub shadows_behind: bool,
    /// The screen rectangle of each bounded primitive, by kind; `None` if nothing may be culled, as with formulas
    /// whose failures must not be hidden.
    pub screen: Option<[Vec<Rectangle>; KINDS]>,
    /// Balls around the bounded primitives of `primitives`.
    pub balls: Balls<R>,
    /// For each triangle, whether it can be skipped for camera rays; empty if none can.
    pub camera_culled_faces: Vec<bool>,
    /// Numbers of primitives whose planes contain the eye, or the whole window from which parallel rays start.
    /// Camera rays skip them.
    pub edge_on: Vec<usize>,
    /// For each mesh of the geometry, the faces that camera rays skip for the same reason, if any.
    pub unseen_faces: Vec<Option<Arc<CulledFaces>>>,
    /// The number of the primitive on which the camera's rays start.
    pub eye_primitive: Option<usize>,
    /// Primitives that share their surface with earlier objects, which are seen there; sorted by number.
    pub ties: Vec<Tie>,
    /// Least height above hits at which secondary rays start, as a share of the coordinates, so that they clear
    /// anything in the same surface. Anything hit within that distance of a hit counts as being in its surface.
    pub clearance: R,
    /// The number of visible objects.
    pub visible_objects: usize,
    /// The extents of the largest flat primitives.
    pub flats: Flats<R>,
    /// The largest coordinate of the bounded objects.
    pub farthest: R,
    /// The same without objects that are much farther away than most, see [`CoordinateFrame`].
    pub extent: R,
    /// How far rounding may displace the camera's rays; zero if doubtful samples are not looked for.
    pub blur: Blur<R>,
    /// The largest coordinate of a mesh's middle; 0 if doubtful samples are not looked for.
    pub max_mesh_centre: R,
}

/// Pixels added around every screen rectangle to cover the kernel's rounding.
const MARGIN: f64 = 1.0;
/// The same with adaptive sampling, where rays also look for things up to a pixel beside them: a pixel as wide as
/// in the middle of the picture, where rays are farthest apart.
const SMOOTH_MARGIN: f64 = 4.0;

impl<R: Real> Plan<R> {
    /// Plans `request` of `scene`, packing only what can be seen. The scene must pass [`crate::scene::check`].
    pub fn new(scene: &Scene, request: &RenderRequest, cache: &mut PlanCache<R>) -> Self {
        let frame = CoordinateFrame::of(scene).unwrap_or(CoordinateFrame {
            centre: scene.camera.position,
            farthest: 0.0,
            extent: 0.0,
        });
        let centre = match request.model {
            Model::Unrebased => DVec3::ZERO,
            _ => frame.centre,
        };
        let (occluders, model) = (classify_planes(scene, request), request.model);
        // The classic formula hits spheres where they are not, which must stay visible.
        let is_whole = matches!(model, Model::Unculled | Model::Everything);
        let may_cull = request.methods.sphere == SphereMethod::Stable && !is_whole;
        let mut plan = Self {
            centre,
            view: View::new(&scene.camera, request, centre),
            primitives: Primitives::default(),
            markers: 0,
            geometry: None,
            hit_order: HitOrder::BySample,
            is_boxed: may_cull && request.accelerator != Accelerator::List,
            outline: Vec::new(),
            lights: Vec::new(),
            materials: pack_materials(scene, request),
            show: Show::new(request.aspect, scene, request.projection_of(&scene.camera)),
            background: linear(scene.background),
            reflection_limit: scene.render.reflection_limit,
            methods: request.methods,
            ray_origin: ray_origin(scene, request.methods.offset),
            planes_cast: occluders.is_none(),
            shadows_behind: model == Model::Everything,
            screen: may_cull.then(Default::default),
            balls: Balls::default(),
            camera_culled_faces: Vec::new(),
            edge_on: Vec::new(),
            unseen_faces: Vec::new(),
            eye_primitive: None,
            ties: Vec::new(),
            clearance: R::ZERO,
            visible_objects: scene.visible_objects().count(),
            flats: Flats::default(),
            farthest: R::from_f64(frame.farthest),
            extent: R::from_f64(frame.extent),
            blur: Blur::NONE,
            max_mesh_centre: R::ZERO,
        };
        let coincidences = cache.coincidences(&scene.objects, centre);
        let contacts = Contacts::new(scene, request, &coincidences, cache.light_contacts(scene));
        let projector = projector(scene, request).filter(|_| may_cull);
        let projector = projector.as_ref();
        if uses_tree(scene, request, may_cull) {
            let outside_tree = &contacts.outside_tree;
            let geometry = cache.geometry(scene, centre, outside_tree, request.sampling);
            plan.hit_order = HitOrder::of(geometry.members(), request);
            plan.take_geometry(geometry, projector);
        }
        let numbers = plan.pack(scene, &contacts, projector);
        let is_outside = |index: &usize| contacts.outside_tree.contains(index);
        let number = |index: &usize| numbers.get(index).copied().filter(|_| is_outside(index));
        plan.edge_on = contacts.edge_on.iter().filter_map(number).collect();
        plan.eye_primitive = contacts.eye_object.as_ref().and_then(number);
        plan.find_ties(scene, request, &contacts, &numbers);
        let occluders = occluders.as_deref().unwrap_or_default();
        plan.lights = pack_lights(scene, centre, occluders, model, &contacts.lights, number);
        plan.find_held_faces(scene, request);
        if matches!(request.sampling, Sampling::Adaptive { .. }) {
            let outside_tree = contacts.outside_tree.iter().filter_map(number).collect();
            measure_loose(&mut plan.primitives, &outside_tree);
            plan.flats = Flats::of(&plan.primitives, plan.geometry.as_deref());
        }
        if may_cull {
            plan.balls = Balls::around(&plan.primitives);
            // A ray that leaks through a face must not reveal that the faces behind it were left out.
            if request.methods.is_tight() {
                plan.drop_far_faces(scene, request);
                plan.drop_lit_faces(scene, request, &mut cache.culled_faces);
            }
        }
        cache.culled_faces.end_picture();
        plan
    }

    /// Stores the geometry of the BVH and the screen rectangles that enclose it.
    fn take_geometry(&mut self, geometry: Arc<Geometry<R>>, projector: Option<&Projector>) {
        let rectangle = |bounds: BoundingBox<R>| {
            let (middle, radius) = bounds.ball();
            let radius = radius.to_f64() * (1.0 + CAUTION);
            Some(projector?.ball(middle.to_dvec3() + self.centre, radius))
        };
        self.outline = geometry.outline().filter_map(rectangle).collect();
        self.geometry = Some(geometry);
    }

    /// Packs the markers, then the visible objects that are not in the tree. Returns the primitive numbers of the
    /// objects whose contacts refer to them, by index in the scene's list.
    fn pack(
        &mut self,
        scene: &Scene,
        contacts: &Contacts,
        projector: Option<&Projector>,
    ) -> HashMap<usize, usize> {
        // With a tree, the only listed triangles are those that touch something.
        let has_triangles = self.geometry.is_none() || !contacts.outside_tree.is_empty();
        let (corner_users, faces_of_solids) = if has_triangles {
            (count_corner_users(scene), faces_of_solids(scene))
        } else {
            Default::default()
        };
        let packing = Packing {
            centre: self.centre,
            corner_users: &corner_users,
            faces_of_solids: &faces_of_solids,
            projector,
        };
        if scene.light_visualization {
            self.pack_markers(scene, &packing);
        }
        let has_tree = self.geometry.is_some();
        let is_listed = |index: usize, object: &Object| {
            let belongs_in_tree = has_tree && belongs_in_tree(object);
            object.visible && (!belongs_in_tree || contacts.outside_tree.contains(&index))
        };
        let mut numbered = Vec::new();
        for (index, object) in scene.objects.iter().enumerate() {
            if !is_listed(index, object) || contacts.covered.contains(&index) {
                continue;
            }
            let material = material_number(scene, &object.color_pack);
            let packed = self.push(&object.shape, material, &packing);
            if let Some(packed) = packed.filter(|_| contacts.needs_number(index)) {
                numbered.push((index, packed));
            }
        }
        let firsts = self.primitives.firsts();
        let number = |packed: &Packed| firsts[packed.kind as usize] + packed.index;
        numbered
            .iter()
            .map(|(index, packed)| (*index, number(packed)))
            .collect()
    }

    fn pack_markers(&mut self, scene: &Scene, packing: &Packing) {
        let first_marker_material = scene.color_packs.len() as u32;
        for light in scene.visible_lights() {
            let Some(LightObj { radius, color_pack }) = &light.marker else {
                continue;
            };
            let marker = Sphere {
                center: light.position,
                radius: *radius,
            };
            let material = first_marker_material + material_number(scene, color_pack);
            self.push(&marker.into(), material, packing);
        }
        self.markers = self.primitives.spheres.len();
    }

    fn push(&mut self, shape: &Shape, material: u32, packing: &Packing) -> Option<Packed> {
        let packed = self.primitives.push(shape, material, packing)?;
        if let (Some(rectangle), Some(screen)) = (packed.rectangle, &mut self.screen) {
            screen[packed.kind as usize].push(rectangle);
        }
        Some(packed)
    }

    /// The geometry, with the number of its first primitive.
    #[inline(always)]
    pub fn numbered_geometry(&self) -> Option<(&Geometry<R>, usize)> {
        let geometry = self.geometry.as_deref()?;
        Some((geometry, self.primitives.len()))
    }

    /// The number of the first face of a mesh; no primitive has a greater one if there are no meshes.
    pub fn first_of_meshes(&self) -> usize {
        let in_tree = self.geometry.as_ref();
        self.primitives.len() + in_tree.map_or(0, |geometry| geometry.primitives.len())
    }

    /// The number of bounded primitives.
    pub fn bounded(&self) -> usize {
        let in_tree = self.geometry.as_ref().map_or(0, |all| all.len());
        self.primitives.bounded() + in_tree
    }
}

fn projector(scene: &Scene, request: &RenderRequest) -> Option<Projector> {
    let camera = Camera {
        projection: request.projection_of(&scene.camera),
        ..scene.camera.clone()
    };
    let margin = match request.sampling {
        Sampling::Adaptive { .. } => SMOOTH_MARGIN,
        Sampling::Centres | Sampling::Grid(_) => MARGIN,
    };
    Projector::new(&camera, (request.width, request.height), margin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Projection;

    fn plan(scene: &Scene) -> Plan<f32> {
        let request = RenderRequest::sized(64, 64);
        Plan::new(scene, &request, &mut PlanCache::default())
    }

    #[test]
    fn hidden_markers_and_objects_are_in_no_list() {
        let mut scene = Scene::demo();
        let full = plan(&scene);
        assert_eq!((full.primitives.spheres.len(), full.markers), (4, 2));
        scene.light_visualization = false;
        assert_eq!(plan(&scene).primitives.spheres.len(), 2);
        scene.objects[0].visible = false;
        scene.objects[2].visible = false;
        let sparse = plan(&scene);
        assert_eq!(
            (
                sparse.primitives.spheres.len(),
                sparse.primitives.triangles.len()
            ),
            (1, 5)
        );
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
                .primitives
                .triangles
                .iter()
                .all(|triangle| triangle.in_mesh)
        );
        scene.objects.truncate(3);
        assert!(
            plan(&scene)
                .primitives
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
        for object in moved.objects.iter_mut() {
            object.shape = object.shape.moved(by);
        }
        for light in moved.lights.iter_mut() {
            light.position += by;
        }
        moved.camera.position += by;
        let (here, there) = (plan(&scene), plan(&moved));
        for (a, b) in here
            .primitives
            .spheres
            .iter()
            .zip(&there.primitives.spheres)
        {
            assert_eq!(a.center, b.center);
        }
    }
}
