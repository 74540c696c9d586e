//! What many objects become: packed once, in a tree, and kept from picture to picture.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;

use super::borders::Borders;
use super::bvh::{Bvh, Member};
use super::components::things;
use super::contacts::LightContacts;
use super::culled_faces::KeptCulledFaces;
use super::meshes::Meshes;
use super::packed_mesh::{MeshInstance, PackedMesh, measure, member};
use super::request::RenderRequest;
use super::solids::faces_of_solids;
use crate::primitive::{
    BoundingBox, KINDS, Kind, PackedTriangle, Packing, Primitive, Primitives, Tip, Visit,
    count_corner_users, number_corners,
};
use crate::scene::{Accelerator, Coincidence, List, Object, Sampling, Scene, Shape, coincidences};
use crate::simd::{Real, Vec3};

/// Up to so many objects, testing those that a tile can see costs less than walking a tree.
pub const SMALLEST_TREE: usize = 32;
/// Above so many it costs more, whatever they look like.
pub const LARGEST_LIST: usize = 384;
/// The same for triangles, which seldom come alone.
pub const MOST_LISTED_TRIANGLES: usize = 128;
/// Between these, a tree pays where objects fill a space that is so many times as deep, wide and high as they are:
/// what a tile sees is then scattered, and most of them may stand before its lights. With 60 to 384 balls in such a
/// cloud a list takes 1.2 to 5 times as long.
const DEEPEST_FIELD: f64 = 4.0;
/// In a field that is not so deep, it pays with fewer pixels than this for each object: by a third with half as many,
/// as much is lost with ten times as many.
const PIXELS_IN_TREES: u64 = 2000;
/// The same where rays look beside themselves, which costs more in a tree.
const PIXELS_IN_SMOOTH_TREES: u64 = 500;

/// Most meshes whose parts surround the geometry one by one.
const FINE_OUTLINE: usize = 4;

/// How many primitives of each kind there are, and meshes.
type Counts = ([usize; KINDS], usize);

/// The visible objects that end, ready to be traced: what does not depend on the camera, on lights or on
/// what colours mean.
#[derive(Clone, Debug)]
pub struct Geometry<R> {
    /// The objects; no plane is among them.
    pub primitives: Primitives<R>,
    /// The meshes. Their triangles are numbered after the primitives.
    pub meshes: Vec<MeshInstance<R>>,
    /// The way to them: its members are the numbers of the primitives, then the meshes.
    pub bvh: Bvh<R>,
    /// How far above what is hit rays that go on from there may start.
    pub lift: R,
    /// For each kind of primitive the places of the objects in the scene's list.
    places: [Vec<usize>; KINDS],
    /// Whether the tree was built around other places of its members.
    is_refitted: bool,
}

/// What a picture was planned from that the next one may need as well.
#[derive(Clone, Debug, Default)]
pub struct PlanCache<R> {
    last: Option<(Source, Arc<Geometry<R>>)>,
    coincidences: Option<(List<Object>, DVec3, Arc<[Coincidence]>)>,
    light_contacts: Option<(List<Object>, Vec<DVec3>, Arc<LightContacts>)>,
    /// Meshes that are ready for the next picture, beside those of the last one.
    others: Meshes<R>,
    culled_faces: KeptCulledFaces<R>,
}

/// What the picture before was planned from, which the next one may need as well.
#[derive(Clone, Debug, Default)]
pub struct Planner {
    /// For single precision.
    pub single: PlanCache<f32>,
    /// For double precision.
    pub double: PlanCache<f64>,
}

impl Planner {
    /// What is planned next need not make meshes ready that are ready in `other`.
    pub fn share_meshes(&mut self, other: &Self) {
        self.single.share_meshes(&other.single);
        self.double.share_meshes(&other.double);
    }

    /// Makes the meshes of a scene ready that is planned in both precisions: each of them once for both.
    pub fn pack_meshes(&mut self, scene: &Scene) {
        let Self { single, double } = self;
        if single.is_of(&scene.objects) && double.is_of(&scene.objects) {
            return;
        }
        let (mut rounded, mut packed) = (single.meshes(), double.meshes());
        for object in scene.objects.iter().filter(|object| is_planted(object)) {
            if let Shape::Mesh(mesh) = &object.shape {
                rounded.take_over(&packed.ready(mesh));
            }
        }
        (single.others, double.others) = (rounded, packed);
    }
}

/// What the geometry depends on.
#[derive(Clone, Debug)]
struct Source {
    objects: List<Object>,
    centre: DVec3,
    /// The names of the packs in their order: their places are in the primitives.
    packs: Vec<String>,
    /// The places of objects that stand apart from it.
    apart: BTreeSet<usize>,
}

impl Source {
    fn of(scene: &Scene, centre: DVec3, apart: &BTreeSet<usize>) -> Self {
        Self {
            objects: scene.objects.clone(),
            centre,
            packs: scene.color_packs.keys().cloned().collect(),
            apart: apart.clone(),
        }
    }

    fn is_of(&self, scene: &Scene, centre: DVec3, apart: &BTreeSet<usize>) -> bool {
        self.centre == centre
            && self.apart == *apart
            && self.objects.is_same(&scene.objects)
            && self.packs.iter().eq(scene.color_packs.keys())
    }
}

impl<R: Real> PlanCache<R> {
    fn share_meshes(&mut self, other: &Self) {
        self.others = Meshes::default();
        self.others.extend(other.last_meshes());
    }

    /// The meshes of the last picture.
    fn last_meshes(&self) -> impl Iterator<Item = Arc<PackedMesh<R>>> {
        let last = self.last.iter();
        last.flat_map(|(_, geometry)| geometry.packed_meshes())
    }

    /// The meshes that are ready, which are not kept any longer beside those of the last picture.
    fn meshes(&mut self) -> Meshes<R> {
        let mut meshes = std::mem::take(&mut self.others);
        meshes.extend(self.last_meshes());
        meshes
    }

    /// Whether the last picture was of these objects.
    fn is_of(&self, objects: &List<Object>) -> bool {
        let mut last = self.last.iter();
        last.any(|(source, _)| source.objects.is_same(objects))
    }

    /// The faces that cast no shadows of their own.
    pub fn culled_faces(&mut self) -> &mut KeptCulledFaces<R> {
        &mut self.culled_faces
    }

    /// The objects of a scene that fill the same surface; the last ones, if none has changed.
    pub fn coincidences(&mut self, objects: &List<Object>, centre: DVec3) -> Arc<[Coincidence]> {
        if let Some((of, around, found)) = &self.coincidences
            && of.is_same(objects)
            && *around == centre
        {
            return Arc::clone(found);
        }
        let found: Arc<[Coincidence]> = coincidences(objects, centre).into();
        self.coincidences = Some((objects.clone(), centre, Arc::clone(&found)));
        found
    }

    /// What the lights of a scene touch; the last of it, if nothing has changed.
    pub fn light_contacts(&mut self, scene: &Scene) -> Arc<LightContacts> {
        let lights = scene.lights.iter().map(|light| light.position);
        if let Some((objects, places, found)) = &self.light_contacts
            && objects.is_same(&scene.objects)
            && lights.clone().eq(places.iter().copied())
        {
            return Arc::clone(found);
        }
        let places: Vec<DVec3> = lights.collect();
        let found = Arc::new(LightContacts::new(&scene.objects, &places));
        self.light_contacts = Some((scene.objects.clone(), places, Arc::clone(&found)));
        found
    }

    /// The geometry of a scene, relative to `centre`, without what stands apart, to be sampled in this way: the last
    /// one, if nothing of it has changed.
    pub fn geometry(
        &mut self,
        scene: &Scene,
        (centre, apart): (DVec3, &BTreeSet<usize>),
        sampling: Sampling,
    ) -> Arc<Geometry<R>> {
        // What is looked at as one thing depends on the boxes: where that is asked for, the tree is as it would be
        // without a picture before.
        let may_refit = !matches!(sampling, Sampling::Adaptive { .. });
        if let Some((source, geometry)) = &self.last
            && source.is_of(scene, centre, apart)
            && (may_refit || !geometry.is_refitted)
        {
            return Arc::clone(geometry);
        }
        let meshes = self.meshes();
        let last = self.last.take().map(|(_, last)| last);
        let before = last.as_deref().filter(|_| may_refit);
        let before = before.map(|last| (last.counts(), &last.bvh));
        let geometry = Geometry::new(scene, (centre, apart), meshes, before);
        let geometry = Arc::new(geometry);
        self.last = Some((Source::of(scene, centre, apart), Arc::clone(&geometry)));
        geometry
    }
}

/// Whether the objects of a scene that end are kept in a tree: many of them, fewer where they fill a space or share few
/// pixels, and any mesh.
pub fn is_tree(scene: &Scene, request: &RenderRequest, may_cull: bool) -> bool {
    let visible = || scene.visible_objects();
    let is_wanted = match request.accelerator {
        Accelerator::List => false,
        Accelerator::Bvh => true,
        Accelerator::Auto => {
            let is_triangle = |object: &&Object| matches!(object.shape, Shape::Triangle(_));
            let triangles = visible().filter(is_triangle);
            let ended = visible().filter_map(|object| object.shape.bounds());
            let ended: Vec<_> = ended.take(LARGEST_LIST + 1).collect();
            let pixels_each = match request.sampling {
                Sampling::Adaptive { .. } => PIXELS_IN_SMOOTH_TREES,
                Sampling::Centres | Sampling::Grid(_) => PIXELS_IN_TREES,
            };
            let are_small = request.pixels() < ended.len() as u64 * pixels_each;
            ended.len() > LARGEST_LIST
                || triangles.take(MOST_LISTED_TRIANGLES + 1).count() > MOST_LISTED_TRIANGLES
                || (ended.len() > SMALLEST_TREE && (are_small || is_space(&ended)))
        }
    };
    let is_mesh = |object: &Object| matches!(object.shape, Shape::Mesh(_));
    (is_wanted && may_cull) || visible().any(is_mesh)
}

/// Whether things between these corners fill a space, and no field.
fn is_space(bounds: &[(DVec3, DVec3)]) -> bool {
    let low = bounds
        .iter()
        .fold(DVec3::INFINITY, |low, one| low.min(one.0));
    let high = bounds
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, one| high.max(one.1));
    let sizes = bounds.iter().map(|(low, high)| {
        let [x, y, z] = (*high - *low).to_array();
        // The second of three: poles are no larger than they are wide.
        x.min(y).max(x.max(y).min(z))
    });
    let mean = sizes.sum::<f64>() / bounds.len() as f64;
    (high - low).min_element() > DEEPEST_FIELD * mean
}

impl<R: Real> Geometry<R> {
    /// Packs the objects that are to stand in it, relative to `centre`, with those of the meshes that are packed
    /// already, and with the tree around so many others as there were before.
    fn new(
        scene: &Scene,
        (centre, apart): (DVec3, &BTreeSet<usize>),
        mut ready: Meshes<R>,
        before: Option<(Counts, &Bvh<R>)>,
    ) -> Self {
        let (mut primitives, mut meshes) = (Primitives::default(), Vec::new());
        let mut places: [Vec<usize>; KINDS] = Default::default();
        let packing = Packing {
            centre,
            corner_users: &count_corner_users(scene),
            faces_of_solids: &faces_of_solids(scene),
            projector: None,
        };
        for (index, object) in scene.objects.iter().enumerate() {
            if !is_planted(object) || apart.contains(&index) {
                continue;
            }
            let material = material_number(scene, &object.color_pack);
            match &object.shape {
                Shape::Mesh(mesh) => {
                    let packed = ready.ready(mesh);
                    if packed.triangles.is_empty() {
                        continue; // None of them has an area.
                    }
                    meshes.push(MeshInstance {
                        centre: Vec3::from_dvec3(packed.middle_of(mesh) - centre),
                        mesh: packed,
                        material,
                        place: index,
                        first: 0,
                    });
                }
                shape => {
                    if let Some(packed) = primitives.push(shape, material, &packing) {
                        places[packed.kind as usize].push(index);
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
        let mut members = Members(Vec::with_capacity(primitives.len()));
        primitives.visit(&mut members);
        members.0.extend(meshes.iter().map(MeshInstance::member));
        let lifts = meshes.iter().map(|instance| instance.mesh.lift);
        let member = |number: usize| members.0[number];
        // Where nothing was added or removed, something has moved: mostly little.
        let counts = (primitives.counts(), meshes.len());
        let refitted = before
            .filter(|(before, _)| *before == counts)
            .and_then(|(_, bvh)| bvh.refitted(member));
        Self {
            is_refitted: refitted.is_some(),
            bvh: refitted.unwrap_or_else(|| Bvh::new(members.0.len(), member)),
            lift: lifts.fold(R::ZERO, R::max),
            places,
            primitives,
            meshes,
        }
    }

    fn counts(&self) -> Counts {
        (self.primitives.counts(), self.meshes.len())
    }

    /// Boxes that together surround it: those of the root, or of the roots of meshes in them.
    pub fn outline(&self) -> impl Iterator<Item = BoundingBox<R>> {
        let meshes = self.meshes.iter().flat_map(|instance| {
            let boxes = instance.mesh.bvh.outline();
            boxes.map(|inner| BoundingBox {
                low: inner.low + instance.centre,
                high: inner.high + instance.centre,
            })
        });
        let is_fine = self.meshes.len() <= FINE_OUTLINE && self.primitives.is_empty();
        let coarse = self.bvh.outline().filter(move |_| !is_fine);
        coarse.chain(meshes.filter(move |_| is_fine))
    }

    fn packed_meshes(&self) -> impl Iterator<Item = Arc<PackedMesh<R>>> {
        let meshes = self.meshes.iter();
        meshes.map(|instance| Arc::clone(&instance.mesh))
    }

    /// How many primitives there are, triangles of meshes included.
    pub fn len(&self) -> usize {
        let last = self.meshes.last();
        last.map_or(self.primitives.len(), |last| {
            last.first + last.mesh.triangles.len()
        })
    }

    /// How many things there are, with each mesh as one.
    pub fn members(&self) -> usize {
        self.primitives.len() + self.meshes.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of the primitive that the object at a place in the scene's list became.
    pub fn number_at(&self, index: usize) -> Option<usize> {
        let mut kinds = self.primitives.firsts().into_iter().zip(&self.places);
        kinds.find_map(|(first, places)| Some(first + places.binary_search(&index).ok()?))
    }

    /// The mesh that the primitive of a number belongs to, counted from that of the first primitive.
    #[inline(always)]
    pub fn mesh_of(&self, number: usize) -> Option<&MeshInstance<R>> {
        if number < self.primitives.len() {
            return None;
        }
        let after = self.meshes.partition_point(|mesh| mesh.first <= number);
        self.meshes.get(after.wrapping_sub(1))
    }
}

/// Whether an object stands in the tree of a scene that has one: where it ends and is visible.
pub fn is_planted(object: &Object) -> bool {
    object.visible && object.shape.bounds().is_some()
}

/// Measures how thick what loose triangles make is, where they hang together, and finds what of them is one thing.
/// Primitives of the numbers `apart` are measured by themselves: where there is a tree, the others stand in it.
pub fn measure_loose<R: Real>(primitives: &mut Primitives<R>, apart: &BTreeSet<usize>) {
    let first = primitives.firsts()[Kind::Triangle as usize];
    let places = 0..primitives.triangles.len();
    let is_apart = |place: &usize| apart.contains(&(first + place));
    let (apart, others): (Vec<usize>, Vec<usize>) = places.clone().partition(is_apart);
    let mut found = vec![None; places.len()];
    for group in [others, apart] {
        // Measured in double precision, whatever they are traced in.
        let own = group.iter().map(|&at| &primitives.triangles[at]);
        let mut triangles: Vec<_> = own.map(PackedTriangle::in_precision).collect();
        let corners = number_corners(&triangles);
        let mut bvh = Bvh::new(triangles.len(), |number| member(&triangles[number]));
        let all = &triangles;
        let borders = Borders::of(
            &corners,
            |face| all[face as usize].corners,
            |face| all[face as usize].material,
        );
        measure(&mut triangles, &corners, &mut bvh, &borders);
        let parts = borders.of_one_material.unwrap_or(borders.connected);
        let things = things(&parts);
        for (index, (&place, mut triangle)) in group.iter().zip(triangles).enumerate() {
            let thing = things.get(index).copied().flatten();
            triangle.tip = thing.map_or(Tip::Narrow, |_| triangle.tip);
            primitives.triangles[place] = triangle.in_precision();
            found[place] = thing.map(|first| group[first as usize] as u32);
        }
    }
    let has_things = found.iter().any(Option::is_some);
    primitives.things = if has_things { found } else { Vec::new() };
}

/// The place of a pack among the materials.
pub fn material_number(scene: &Scene, pack: &str) -> u32 {
    scene.color_packs.get_index_of(pack).unwrap_or_default() as u32
}

/// All primitives that end, in the order of their numbers.
struct Members<R>(Vec<Member<R>>);

impl<R: Real> Visit<R> for Members<R> {
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
