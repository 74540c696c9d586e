//! The geometry of many objects: packed once into a tree and kept from picture to picture.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::borders::Borders;
use super::bvh::{Bvh, Member};
use super::components::{large_components, number_corners};
use super::contacts::LightContacts;
use super::culled_faces::CulledFacesCache;
use super::meshes::Meshes;
use super::packed_mesh::{MeshInstance, PackedMesh, measure};
use super::request::RenderRequest;
use super::solids::{count_corner_users, faces_of_solids};
use crate::primitive::{
    BoundingBox, KINDS, Kind, PackedTriangle, Packing, Primitive, Primitives, Tip, Visit,
};
use crate::scene::{
    Accelerator, Coincidence, List, Object, Sampling, Scene, Shape, around, coincidences,
};
use crate::simd::{Real, Vec3};

/// Number of objects up to which testing those visible in a tile is faster than traversing a tree.
pub const SMALLEST_TREE: usize = 32;
/// Number of objects above which a tree is always faster.
pub const MAX_LIST: usize = 384;
/// The same for spheres and for triangles. With 130, 200, 300 and 380 spheres on a floor and clean edges, a list takes
/// 1.2, 1.3, 1.45 and 1.7 times as long; triangles rarely come alone.
pub const MAX_LISTED_OF_KIND: usize = 128;
/// Between these numbers, a tree is used if the objects fill a space whose every side is this many times as long as
/// they are large: those visible in a tile are then scattered, and most may be in front of its lights. With 60 to
/// 384 balls in such a cloud, a list takes 1.2 to 5 times as long.
const MIN_DEPTH_IN_SIZES: f64 = 4.0;
/// Pixels per object below which a shallower field gets a tree: it saves a third with half as many pixels, and
/// loses as much with ten times as many.
const PIXELS_PER_OBJECT: u64 = 2000;
/// The same with adaptive sampling, whose rays also look for things beside them, which costs more in a tree.
const ADAPTIVE_PIXELS_PER_OBJECT: u64 = 500;

/// Maximum number of meshes for which the outline uses the boxes of the meshes' own roots.
const MAX_FINE_MESHES: usize = 4;

/// The number of primitives of each kind, and of meshes.
type Counts = ([usize; KINDS], usize);

/// The visible bounded objects, ready to be traced: everything that does not depend on the camera, on lights or on
/// the contents of color packs.
#[derive(Clone, Debug)]
pub struct Geometry<R> {
    /// The objects other than meshes; no plane is among them.
    pub primitives: Primitives<R>,
    /// The meshes. Their triangles are numbered after the primitives.
    pub meshes: Vec<MeshInstance<R>>,
    /// The tree over both: its members are the numbers of the primitives, then the meshes.
    pub bvh: Bvh<R>,
    /// Upper bound of the height above hits at which secondary rays start.
    pub lift: R,
    /// For each kind of primitive, the indices of the objects in the scene's list.
    indices: [Vec<usize>; KINDS],
    /// Whether the tree was refitted from that of an earlier picture instead of built.
    is_refitted: bool,
}

/// Results of the previous plan that the next one may reuse.
#[derive(Clone, Debug, Default)]
pub struct PlanCache<R> {
    last: Option<(Source, Arc<Geometry<R>>)>,
    coincidences: Option<(List<Object>, DVec3, Arc<[Coincidence]>)>,
    light_contacts: Option<(List<Object>, Vec<DVec3>, Arc<LightContacts>)>,
    /// Packed meshes for the next picture, in addition to those of the last one.
    extra_meshes: Meshes<R>,
    /// The faces of meshes that shadow rays can skip, kept from picture to picture.
    pub culled_faces: CulledFacesCache<R>,
}

/// Results of the previous plan that the next one may reuse, in both precisions.
#[derive(Clone, Debug, Default)]
pub struct Planner {
    /// For single precision.
    pub single: PlanCache<f32>,
    /// For double precision.
    pub double: PlanCache<f64>,
}

impl Planner {
    /// Makes the packed meshes of `other` available to the next plan.
    pub fn share_meshes(&mut self, other: &Self) {
        self.single.share_meshes(&other.single);
        self.double.share_meshes(&other.double);
    }

    /// Packs the meshes of a scene that is planned in both precisions: each mesh once for both.
    pub fn pack_meshes(&mut self, scene: &Scene) {
        let Self { single, double } = self;
        if single.is_for(&scene.objects) && double.is_for(&scene.objects) {
            return;
        }
        let (mut rounded, mut packed) = (single.meshes(), double.meshes());
        let members = scene.objects.iter();
        for object in members.filter(|one| belongs_in_tree(one)) {
            if let Shape::Mesh(mesh) = &object.shape {
                rounded.take_over(&packed.get_or_pack(mesh));
            }
        }
        (single.extra_meshes, double.extra_meshes) = (rounded, packed);
    }
}

/// The inputs that the geometry depends on.
#[derive(Clone, Debug)]
struct Source {
    objects: List<Object>,
    centre: DVec3,
    /// The names of the color packs in order: primitives store their indices.
    packs: Vec<String>,
    /// The indices of objects that are kept out of the geometry.
    excluded: BTreeSet<usize>,
}

impl Source {
    fn of(scene: &Scene, centre: DVec3, excluded: &BTreeSet<usize>) -> Self {
        Self {
            objects: scene.objects.clone(),
            centre,
            packs: scene.color_packs.keys().cloned().collect(),
            excluded: excluded.clone(),
        }
    }

    fn is_for(&self, scene: &Scene, centre: DVec3, excluded: &BTreeSet<usize>) -> bool {
        self.centre == centre
            && self.excluded == *excluded
            && self.objects.is_same(&scene.objects)
            && self.packs.iter().eq(scene.color_packs.keys())
    }
}

impl<R: Real> PlanCache<R> {
    fn share_meshes(&mut self, other: &Self) {
        self.extra_meshes = Meshes::default();
        self.extra_meshes.extend(other.last_meshes());
    }

    /// The packed meshes of the last picture.
    fn last_meshes(&self) -> impl Iterator<Item = Arc<PackedMesh<R>>> {
        let last = self.last.iter().flat_map(|(_, last)| &last.meshes);
        last.map(|instance| Arc::clone(&instance.mesh))
    }

    /// Takes the available packed meshes; only those of the last picture are kept here.
    fn meshes(&mut self) -> Meshes<R> {
        let mut meshes = std::mem::take(&mut self.extra_meshes);
        meshes.extend(self.last_meshes());
        meshes
    }

    /// Returns whether the last picture was of these objects.
    fn is_for(&self, objects: &List<Object>) -> bool {
        let last = self.last.as_ref();
        last.is_some_and(|(source, _)| source.objects.is_same(objects))
    }

    /// Returns the objects that fill the same surface; the previous result if no object has changed.
    pub fn coincidences(&mut self, objects: &List<Object>, centre: DVec3) -> Arc<[Coincidence]> {
        if let Some((known_objects, known_centre, found)) = &self.coincidences
            && known_objects.is_same(objects)
            && *known_centre == centre
        {
            return Arc::clone(found);
        }
        let found: Arc<[Coincidence]> = coincidences(objects, centre).into();
        self.coincidences = Some((objects.clone(), centre, Arc::clone(&found)));
        found
    }

    /// Returns the contacts of a scene's lights; the previous result if nothing has changed.
    pub fn light_contacts(&mut self, scene: &Scene) -> Arc<LightContacts> {
        let lights = scene.lights.iter().map(|light| light.position);
        if let Some((objects, positions, found)) = &self.light_contacts
            && objects.is_same(&scene.objects)
            && lights.clone().eq(positions.iter().copied())
        {
            return Arc::clone(found);
        }
        let positions: Vec<DVec3> = lights.collect();
        let found = Arc::new(LightContacts::new(&scene.objects, &positions));
        self.light_contacts = Some((scene.objects.clone(), positions, Arc::clone(&found)));
        found
    }

    /// Returns the geometry of a scene relative to `centre`, without the objects `excluded`, for this sampling; the
    /// previous one if nothing of it has changed.
    pub fn geometry(
        &mut self,
        scene: &Scene,
        centre: DVec3,
        excluded: &BTreeSet<usize>,
        sampling: Sampling,
    ) -> Arc<Geometry<R>> {
        // Adaptive sampling treats the content of small boxes as one thing, so the picture depends on the tree: it
        // then must be the same as without earlier pictures.
        let may_refit = !matches!(sampling, Sampling::Adaptive { .. });
        if let Some((source, geometry)) = &self.last
            && source.is_for(scene, centre, excluded)
            && (may_refit || !geometry.is_refitted)
        {
            return Arc::clone(geometry);
        }
        let meshes = self.meshes();
        let last = self.last.take().map(|(_, last)| last);
        let previous = last.as_deref().filter(|_| may_refit);
        let previous = previous.map(|last| (last.counts(), &last.bvh));
        let geometry = Geometry::new(scene, centre, excluded, meshes, previous);
        let geometry = Arc::new(geometry);
        self.last = Some((Source::of(scene, centre, excluded), Arc::clone(&geometry)));
        geometry
    }
}

/// Returns whether the bounded objects of a scene are kept in a tree: many of them, fewer if they fill a space or
/// share few pixels, and any mesh.
pub fn uses_tree(scene: &Scene, request: &RenderRequest, may_cull: bool) -> bool {
    let visible = || scene.visible_objects();
    let is_preferred = match request.accelerator {
        Accelerator::List => false,
        Accelerator::Bvh => true,
        Accelerator::Auto => {
            let are_many = |is_kind: fn(&Shape) -> bool| {
                let all = visible().filter(|object| is_kind(&object.shape));
                all.take(MAX_LISTED_OF_KIND + 1).count() > MAX_LISTED_OF_KIND
            };
            let bounded = visible().filter_map(|object| object.shape.bounds());
            let bounded: Vec<_> = bounded.take(MAX_LIST + 1).collect();
            let pixels_each = match request.sampling {
                Sampling::Adaptive { .. } => ADAPTIVE_PIXELS_PER_OBJECT,
                Sampling::Centres | Sampling::Grid(_) => PIXELS_PER_OBJECT,
            };
            let are_small = request.pixels() < bounded.len() as u64 * pixels_each;
            bounded.len() > MAX_LIST
                || are_many(|shape| matches!(shape, Shape::Sphere(_)))
                || are_many(|shape| matches!(shape, Shape::Triangle(_)))
                || (bounded.len() > SMALLEST_TREE && (are_small || fills_space(&bounded)))
        }
    };
    let is_mesh = |object: &Object| matches!(object.shape, Shape::Mesh(_));
    (is_preferred && may_cull) || visible().any(is_mesh)
}

/// Returns whether things with these bounds fill a space rather than a shallow field.
fn fills_space(bounds: &[(DVec3, DVec3)]) -> bool {
    let Some((low, high)) = around(bounds.iter().copied()) else {
        return false;
    };
    let sizes = bounds.iter().map(|(low, high)| {
        let [x, y, z] = (*high - *low).to_array();
        // The median of the three: a pole counts as no larger than it is wide.
        x.min(y).max(x.max(y).min(z))
    });
    let mean = sizes.sum::<f64>() / bounds.len() as f64;
    (high - low).min_element() > MIN_DEPTH_IN_SIZES * mean
}

impl<R: Real> Geometry<R> {
    /// Packs the objects that belong into the tree, relative to `centre`. Reuses meshes that are already packed,
    /// and refits the tree of the last picture if that had the same number of members of each kind.
    fn new(
        scene: &Scene,
        centre: DVec3,
        excluded: &BTreeSet<usize>,
        mut known: Meshes<R>,
        previous: Option<(Counts, &Bvh<R>)>,
    ) -> Self {
        let (mut primitives, mut meshes) = (Primitives::default(), Vec::new());
        let mut indices: [Vec<usize>; KINDS] = Default::default();
        let packing = Packing {
            centre,
            corner_users: &count_corner_users(scene),
            faces_of_solids: &faces_of_solids(scene),
            projector: None,
        };
        for (index, object) in scene.objects.iter().enumerate() {
            if !belongs_in_tree(object) || excluded.contains(&index) {
                continue;
            }
            let material = material_number(scene, &object.color_pack);
            match &object.shape {
                Shape::Mesh(mesh) => {
                    let packed = known.get_or_pack(mesh);
                    if packed.triangles.is_empty() {
                        continue; // None of them has an area.
                    }
                    meshes.push(MeshInstance {
                        centre: Vec3::from_dvec3(packed.middle_of(mesh) - centre),
                        mesh: packed,
                        material,
                        object_index: index,
                        first: 0,
                    });
                }
                shape => {
                    if let Some(packed) = primitives.push(shape, material, &packing) {
                        indices[packed.kind as usize].push(index);
                    }
                }
            }
        }
        let mut first = primitives.len();
        for instance in &mut meshes {
            instance.first = first;
            first += instance.mesh.triangles.len();
        }
        measure_loose(&mut primitives, &BTreeSet::new());
        let mut members = MemberCollector(Vec::with_capacity(primitives.len()));
        primitives.visit(&mut members);
        members.0.extend(meshes.iter().map(MeshInstance::member));
        let lifts = meshes.iter().map(|instance| instance.mesh.lift);
        let member = |number: usize| members.0[number];
        // If nothing was added or removed, something has moved, mostly by little.
        let counts = (primitives.counts(), meshes.len());
        let refitted = previous
            .filter(|(previous, _)| *previous == counts)
            .and_then(|(_, bvh)| bvh.refitted(member));
        Self {
            is_refitted: refitted.is_some(),
            bvh: refitted.unwrap_or_else(|| Bvh::new(members.0.len(), member)),
            lift: lifts.fold(R::ZERO, R::max),
            indices,
            primitives,
            meshes,
        }
    }

    fn counts(&self) -> Counts {
        (self.primitives.counts(), self.meshes.len())
    }

    /// Boxes that together enclose the geometry: those of the root, or of the roots of meshes.
    pub fn outline(&self) -> impl Iterator<Item = BoundingBox<R>> {
        let meshes = self.meshes.iter().flat_map(|instance| {
            let boxes = instance.mesh.bvh.outline();
            boxes.map(|inner| inner.moved(instance.centre))
        });
        let is_fine = self.meshes.len() <= MAX_FINE_MESHES && self.primitives.is_empty();
        let coarse = self.bvh.outline().filter(move |_| !is_fine);
        coarse.chain(meshes.filter(move |_| is_fine))
    }

    /// Returns whether there are primitives besides meshes, or several meshes or unconnected parts of one.
    pub fn is_of_several(&self) -> bool {
        !self.primitives.is_empty()
            || self.meshes.len() > 1
            || self.meshes.iter().any(|instance| instance.mesh.has_parts())
    }

    /// The number of primitives, including triangles of meshes.
    pub fn len(&self) -> usize {
        let last = self.meshes.last();
        last.map_or(self.primitives.len(), |last| {
            last.first + last.mesh.triangles.len()
        })
    }

    /// The number of members of the tree: each mesh counts as one.
    pub fn members(&self) -> usize {
        self.primitives.len() + self.meshes.len()
    }

    /// Returns whether there are no primitives.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of the primitive for the object with this index in the scene's list.
    pub fn number_at(&self, index: usize) -> Option<usize> {
        let mut kinds = self.primitives.firsts().into_iter().zip(&self.indices);
        kinds.find_map(|(first, indices)| Some(first + indices.binary_search(&index).ok()?))
    }

    /// The mesh to which a primitive belongs; numbers count from the geometry's first primitive.
    #[inline(always)]
    pub fn mesh_of(&self, number: usize) -> Option<&MeshInstance<R>> {
        if number < self.primitives.len() {
            return None;
        }
        let after = self.meshes.partition_point(|mesh| mesh.first <= number);
        self.meshes.get(after.wrapping_sub(1))
    }
}

/// Returns whether an object belongs into the tree, if the scene has one: if it is bounded and visible.
pub fn belongs_in_tree(object: &Object) -> bool {
    object.visible && object.shape.bounds().is_some()
}

/// Measures the thickness of connected loose triangles, and finds large components of them.
/// Primitives with numbers in `separate` are measured by themselves: with a tree, the others are in it.
pub fn measure_loose<R: Real>(primitives: &mut Primitives<R>, separate: &BTreeSet<usize>) {
    let first = primitives.firsts()[Kind::Triangle as usize];
    let indices = 0..primitives.triangles.len();
    let is_separate = |index: &usize| separate.contains(&(first + index));
    let (separate, others): (Vec<usize>, Vec<usize>) = indices.clone().partition(is_separate);
    let mut found = vec![None; indices.len()];
    for group in [others, separate] {
        // Measured in double precision, whichever precision traces them.
        let own_triangles = group.iter().map(|&index| &primitives.triangles[index]);
        let mut triangles: Vec<_> = own_triangles.map(PackedTriangle::in_precision).collect();
        let corners = number_corners(&triangles);
        let mut bvh = Bvh::new(triangles.len(), |number| Member::of(&triangles[number]));
        let all = &triangles;
        let borders = Borders::of(
            &corners,
            |face| all[face as usize].corners,
            |face| all[face as usize].material,
        );
        measure(&mut triangles, &corners, &mut bvh, &borders);
        let parts = borders.of_one_material.unwrap_or(borders.connected);
        let components = large_components(&parts);
        for (index, (&target, mut triangle)) in group.iter().zip(triangles).enumerate() {
            let component = components.get(index).copied().flatten();
            triangle.tip = component.map_or(Tip::Narrow, |_| triangle.tip);
            primitives.triangles[target] = triangle.in_precision();
            found[target] = component.map(|first| group[first as usize] as u32);
        }
    }
    let has_components = found.iter().any(Option::is_some);
    primitives.components = if has_components { found } else { Vec::new() };
}

/// The index of a color pack among the materials.
pub fn material_number(scene: &Scene, pack: &str) -> u32 {
    scene.color_packs.get_index_of(pack).unwrap_or_default() as u32
}

/// All bounded primitives, in the order of their numbers.
struct MemberCollector<R>(Vec<Member<R>>);

impl<R: Real> Visit<R> for MemberCollector<R> {
    fn visit<P: Primitive<R>>(&mut self, _kind: Kind, primitives: &[P], _first: usize) {
        let members = primitives.iter().filter_map(|primitive| {
            Some(Member {
                bounds: primitive.bounds()?,
                thickness: primitive.thickness(),
            })
        });
        self.0.extend(members);
    }
}
