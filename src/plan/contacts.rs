//! Contacts: objects that fill the same surface, and the eye or lights on a surface. Rounding would decide what is
//! seen there; here it is decided once, for all rays and in any precision.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{Coincidence, List, Object, Overlap, Scene, Shape};

/// Maximum number of objects that contain lights or the eye and are kept out of the tree; if there are more, all
/// stay in it.
const MAX_OUTSIDE_TREE: usize = 256;
/// The same for objects that share a surface with others: more of them are found faster in the tree.
const MAX_SHARING_OUTSIDE: usize = 32;

/// Number of pairs of an object and a light up to which lights in the plane of a flat object, but far from it, are
/// found, too: ten milliseconds whenever either has changed.
const MAX_PAIRS: usize = 1_000_000;

/// Distance from a curved surface up to which a point counts as on it, in radii.
const ON_CURVED: f64 = 1e-11;

/// Distance from a curved surface up to which a light may be on it, in radii.
const NEAR_CURVED: f64 = 1e-5;

/// The contacts in a picture.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// Objects that others hide completely.
    pub covered: BTreeSet<usize>,
    /// Pairs of objects that share part of a surface, where the earlier one is seen; sorted.
    pub shared: Vec<Coincidence>,
    /// The flat objects whose planes contain the eye, which sees at most their edges, or the whole window of
    /// parallel rays, which start behind them.
    pub edge_on: Vec<usize>,
    /// The curved object on whose surface the eye is.
    pub eye_object: Option<usize>,
    /// The contacts of the lights.
    pub lights: Arc<LightContacts>,
    /// The objects that are kept out of the tree: those that are completely hidden, those that contain lights or
    /// the eye, and those that share a surface; the latter two only if they are not too many.
    pub outside_tree: BTreeSet<usize>,
    /// The objects in `shared` other than meshes: the numbers of their primitives are needed, in a list or in the
    /// tree.
    sharing: BTreeSet<usize>,
}

/// The contacts of lights.
#[derive(Clone, Debug, Default)]
pub struct LightContacts {
    /// For each light of the scene, the flat objects whose planes contain it: they cast no shadow from it. With many
    /// objects and lights, only those near the light.
    pub held_by: Vec<Vec<usize>>,
    /// For each light, the first ball whose surface contains it: on one side that ball casts a shadow, which is
    /// decided exactly. For further balls, rounding decides.
    pub on_balls: Vec<Option<usize>>,
    /// For each light, whether it may be on the surface of an object other than a mesh.
    pub touching: Vec<bool>,
}

impl LightContacts {
    /// Finds the contacts of lights at these positions.
    pub fn new(objects: &List<Object>, lights: &[DVec3]) -> Self {
        let mut contacts = Self {
            held_by: vec![Vec::new(); lights.len()],
            on_balls: vec![None; lights.len()],
            touching: vec![false; lights.len()],
        };
        let are_few = objects.len() * lights.len() <= MAX_PAIRS;
        let mut lights: Vec<_> = lights.iter().copied().enumerate().collect();
        lights.sort_by(|(_, one), (_, other)| one.x.total_cmp(&other.x));
        for (index, Object { shape, .. }) in objects.visible() {
            let piece = shape.plane_piece();
            let bounds = shape.bounds().filter(|_| piece.is_none() || !are_few);
            for &(light, at) in bounds.map_or(&lights[..], |bounds| beside(bounds, &lights)) {
                if let Some(piece) = &piece {
                    if piece.height(at) == 0.0 {
                        contacts.held_by[light].push(index);
                        contacts.touching[light] = true;
                    }
                } else {
                    let height = shape.height_per_radius(at);
                    contacts.touching[light] |= height < NEAR_CURVED;
                    if height <= ON_CURVED {
                        contacts.on_balls[light].get_or_insert(index);
                    }
                }
            }
        }
        contacts
    }
}

/// Returns the lights, sorted by x, that are not to the left or to the right of something with these bounds.
fn beside((low, high): (DVec3, DVec3), lights: &[(usize, DVec3)]) -> &[(usize, DVec3)] {
    let margin = NEAR_CURVED * (high - low).max_element();
    let start = lights.partition_point(|(_, light)| light.x < low.x - margin);
    let lights = &lights[start..];
    &lights[..lights.partition_point(|(_, light)| light.x <= high.x + margin)]
}

/// An object that shares its surface with earlier ones.
#[derive(Clone, Debug)]
pub struct Tie {
    /// The numbers of its primitives.
    pub numbers: Range<usize>,
    /// The earlier objects; of those that a ray hits there, the first is seen.
    pub over: RankedObjects,
}

/// An ordered set of objects, searched by primitive number: many may share a surface with one object.
#[derive(Clone, Debug)]
pub struct RankedObjects {
    /// The primitive numbers of each object and its rank in the order, sorted by number.
    ranked: Vec<(Range<usize>, usize)>,
    /// The number of entries that are not in the tree; they come first.
    listed: usize,
}

impl RankedObjects {
    /// Creates the set from the primitive numbers of each object, in order; numbers below `listed` are not in the
    /// tree.
    pub fn new(numbers: Vec<Range<usize>>, listed: usize) -> Self {
        let ranked = numbers.into_iter().enumerate();
        let mut ranked: Vec<_> = ranked.map(|(rank, numbers)| (numbers, rank)).collect();
        ranked.sort_by_key(|(numbers, _)| numbers.start);
        Self {
            listed: ranked.partition_point(|(numbers, _)| numbers.start < listed),
            ranked,
        }
    }

    /// Returns the rank of the object with this primitive number, if it is in the set.
    pub fn rank_of(&self, number: usize) -> Option<usize> {
        let after = self
            .ranked
            .partition_point(|(numbers, _)| numbers.start <= number);
        let (numbers, rank) = self.ranked.get(after.checked_sub(1)?)?;
        numbers.contains(&number).then_some(*rank)
    }

    /// The numbers of the objects outside of the tree, each of which is one primitive.
    pub fn listed(&self) -> impl Iterator<Item = usize> {
        self.ranked[..self.listed]
            .iter()
            .map(|(numbers, _)| numbers.start)
    }

    /// Returns whether any of the objects are in the tree.
    pub fn are_in_tree(&self) -> bool {
        self.listed < self.ranked.len()
    }
}

impl Contacts {
    /// Collects the contacts in a picture of a scene from its coincidences and those of the lights.
    pub fn new(
        scene: &Scene,
        request: &RenderRequest,
        found: &[Coincidence],
        lights: Arc<LightContacts>,
    ) -> Self {
        if request.model == Model::Everything {
            return Self::default();
        }
        let found = found.iter().copied();
        let (whole, shared): (Vec<_>, _) = found.partition(|found| found.extent == Overlap::Whole);
        let mut contacts = Self {
            covered: whole.into_iter().map(|found| found.later).collect(),
            shared,
            lights,
            ..Self::default()
        };
        let is_parallel = request.is_parallel(&scene.camera);
        contacts.find_eye_contacts(scene, is_parallel);
        contacts.find_outside_tree(&scene.objects);
        contacts
    }

    /// Finds what the eye is on, in one pass, as there may be many objects.
    fn find_eye_contacts(&mut self, scene: &Scene, is_parallel: bool) {
        let eye = scene.camera.position;
        let direction = scene.camera.forward();
        for (index, Object { shape, .. }) in scene.objects.visible() {
            if let Some(piece) = shape.plane_piece() {
                let holds_eye = piece.height(eye) == 0.0;
                if holds_eye && (!is_parallel || piece.is_perpendicular_to(direction)) {
                    self.edge_on.push(index);
                }
            } else if !is_parallel
                && self.eye_object.is_none()
                && shape.height_per_radius(eye) <= ON_CURVED
            {
                self.eye_object = Some(index);
            }
        }
    }

    /// Returns whether the number that an object gets in the lists is needed.
    pub fn needs_number(&self, index: usize) -> bool {
        self.outside_tree.contains(&index) || self.sharing.contains(&index)
    }

    fn find_outside_tree(&mut self, objects: &List<Object>) {
        let shared = self.shared.iter();
        let shared = shared.flat_map(|found| [found.later, found.earlier]);
        let is_mesh = |index: &usize| matches!(objects[*index].shape, Shape::Mesh(_));
        self.sharing = shared.filter(|index| !is_mesh(index)).collect();
        let LightContacts {
            held_by, on_balls, ..
        } = &*self.lights;
        let lights = held_by.iter().flatten().chain(on_balls.iter().flatten());
        let eye = self.edge_on.iter().chain(&self.eye_object).copied();
        let holders: BTreeSet<usize> = lights.copied().chain(eye).collect();
        if holders.len() <= MAX_OUTSIDE_TREE {
            self.outside_tree = holders;
        }
        if self.sharing.len() <= MAX_SHARING_OUTSIDE {
            self.outside_tree.extend(&self.sharing);
        }
        self.outside_tree.extend(&self.covered);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Plan;
    use super::super::geometry::PlanCache;
    use super::*;
    use crate::primitive::Kind;
    use crate::scene::{Accelerator, Disc, Sampling, Sphere, Triangle};

    #[test]
    fn others_are_found_by_their_numbers_in_whatever_order_they_are() {
        let others = RankedObjects::new(vec![40..60, 7..8, 20..40, 3..4], 20);
        let ranks = [50, 7, 20, 39, 3].map(|number| others.rank_of(number));
        assert_eq!(ranks, [Some(0), Some(1), Some(2), Some(2), Some(3)]);
        for none in [0, 4, 8, 19, 60] {
            assert_eq!(others.rank_of(none), None, "{none}");
        }
        assert!(others.listed().eq([3, 7]) && others.are_in_tree());
        assert!(!RankedObjects::new(vec![1..2, 5..6], 20).are_in_tree());
    }

    #[test]
    fn lights_are_on_things_among_any_number_of_others() {
        let at = |x: f64| DVec3::new(x, 0.0, 0.0);
        let ball = |index: usize| Sphere {
            center: at(3.0 * index as f64),
            radius: 1.0,
        };
        let mut objects: List<Object> = (0..100)
            .map(|index| Object::new(format!("Ball {index}"), "plane", ball(index)))
            .collect();
        let disc = Disc {
            center: at(1.5),
            normal: DVec3::Y,
            radius: 0.25,
        };
        objects.push(Object::new("Disc", "plane", disc));
        // On a ball, beside it, on the disc, and in the disc's plane.
        let mut lights = vec![at(22.0), at(22.4) + DVec3::Y, at(1.5), at(1.9)];
        for are_many in [false, true] {
            if are_many {
                let more = MAX_PAIRS / objects.len() - lights.len() + 1;
                lights.extend((0..more).map(|index| DVec3::new(index as f64, 5.0, 0.0)));
            }
            let found = LightContacts::new(&objects, &lights);
            assert_eq!(found.on_balls[..4], [Some(7), None, None, None]);
            assert_eq!(found.touching[..4], [true, false, true, !are_many]);
            assert_eq!(found.held_by[2], [100]);
        }
    }

    #[test]
    fn triangles_are_measured_alike_in_lists_and_in_trees_where_some_stand_apart() {
        // A narrow sheet that rises in its second half, and a light on the ground.
        let mut scene = Scene::demo();
        scene.objects = List::new();
        scene.lights[0].position = DVec3::new(-40.0, 0.0, -99.0);
        let at = |x: u32, z: u32| {
            DVec3::new(x.into(), x.saturating_sub(20).into(), f64::from(z) - 100.0)
        };
        for (x, z) in (0..40).flat_map(|x| [(x, 0), (x, 1)]) {
            let [a, b, c, d] = [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)];
            for piece in [Triangle { a, b, c }, Triangle { a, b: c, c: d }] {
                let name = format!("Piece {}", scene.objects.len());
                scene.objects.push(Object::new(name, "plane", piece));
            }
        }
        let measured = |accelerator| {
            let request = RenderRequest {
                accelerator,
                sampling: Sampling::ADAPTIVE,
                ..RenderRequest::sized(64, 64)
            };
            let plan = Plan::<f64>::new(&scene, &request, &mut PlanCache::default());
            let in_tree = plan.geometry.iter().map(|geometry| &geometry.primitives);
            let all = in_tree.chain([&plan.primitives]);
            let mut found: Vec<_> = all
                .flat_map(|primitives| {
                    let first = primitives.firsts()[Kind::Triangle as usize];
                    let triangles = primitives.triangles.iter().enumerate();
                    triangles.map(move |(index, of)| {
                        let thing = primitives.component_of(first + index) - first;
                        let thing = primitives.triangles[thing].corners;
                        format!("{:?} {} {:?} {thing:?}", of.corners, of.thickness, of.tip)
                    })
                })
                .collect();
            found.sort();
            (plan.geometry.is_some(), found)
        };
        let (list, tree) = (measured(Accelerator::List), measured(Accelerator::Bvh));
        assert_eq!((list.0, tree.0, list.1.len()), (false, true, 160));
        assert_eq!(list.1, tree.1);
    }
}
