//! What touches: objects that fill the same surface, and eyes and lights on one. Rounding would decide what
//! is seen there; here it is decided once, for all rays and in any precision.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{Coincidence, Extent, List, Object, Projection, Scene, Shape, unit};

/// Most touching objects that are kept out of the tree; of more, none is.
const MOST_APART: usize = 256;

/// Most pairs of an object and a point that are looked at: half a millisecond.
const MOST_PAIRS: usize = 50_000;

/// How near to a round surface a point counts as on it, in radii.
const ON_ROUND: f64 = 1e-11;

/// How near a light may be on a round object, in radii.
const NEAR_ROUND: f64 = 1e-5;

/// Objects by their places in the scene's list.
pub type Places = Vec<usize>;

/// What touches in a picture.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// Objects that others hide altogether.
    pub covered: BTreeSet<usize>,
    /// Objects in whose surface earlier ones lie in part, which are seen there; sorted.
    pub shared: Vec<Coincidence>,
    /// The flat objects whose planes hold the eye, which sees their edges at most, or the whole window that parallel
    /// rays come from, which start behind them.
    pub edge_on: Places,
    /// The round object whose surface the eye is on.
    pub eye_on: Option<usize>,
    /// For each light of the scene, the flat objects whose planes hold it: they cast no shadow from it.
    pub lights_in: Vec<Places>,
    /// The lights of the scene that may be on the surface of an object that is no mesh.
    pub touching_lights: Places,
    apart: BTreeSet<usize>,
}

/// An object in whose surface others lie.
#[derive(Clone, Debug)]
pub struct Tie {
    /// The numbers of its primitives.
    pub numbers: Range<usize>,
    /// Those of the others, in their order; the first that a ray meets there is seen.
    pub over: Vec<Range<usize>>,
}

impl Contacts {
    /// What touches in a picture of a scene; coordinates count from `centre`.
    pub fn new(scene: &Scene, request: &RenderRequest, found: &[Coincidence]) -> Self {
        if request.model == Model::Everything {
            return Self::default();
        }
        let mut contacts = Self::default();
        for one in found {
            contacts.add(*one);
        }
        let lights: Vec<_> = scene.lights.iter().map(|light| light.position).collect();
        contacts.lights_in = planes_through(&scene.objects, &lights);
        let are_few = scene.objects.len() * lights.len() <= MOST_PAIRS;
        let touches = |light: &usize| {
            !contacts.lights_in[*light].is_empty()
                || are_few && is_on_any(&scene.objects, lights[*light])
        };
        contacts.touching_lights = (0..lights.len()).filter(touches).collect();
        let eye = scene.camera.position;
        let projection = request.projection_of(&scene.camera);
        contacts.edge_on = planes_through(&scene.objects, &[eye]).concat();
        if projection == Projection::Orthographic {
            let direction = unit(scene.camera.look_at).unwrap_or_default();
            let holds_window = |place: &usize| {
                let piece = scene.objects[*place].shape.plane_piece();
                piece.is_some_and(|piece| piece.is_across(direction))
            };
            contacts.edge_on.retain(holds_window);
        } else {
            let looked_at = scene.objects.iter().take(MOST_PAIRS);
            let is_on = |object: &Object| object.shape.height_per_radius(eye) <= ON_ROUND;
            contacts.eye_on = looked_at
                .enumerate()
                .find(|(_, object)| object.visible && is_on(object))
                .map(|(index, _)| index);
        }
        contacts.set_apart(&scene.objects);
        contacts
    }

    fn add(&mut self, found: Coincidence) {
        if found.extent == Extent::Whole {
            self.covered.insert(found.later);
        } else {
            self.shared.push(found);
        }
    }

    /// The objects that stand in no tree: those that are hidden, and those that are traced otherwise than
    /// others, unless there are too many.
    pub fn apart(&self) -> &BTreeSet<usize> {
        &self.apart
    }

    fn set_apart(&mut self, objects: &List<Object>) {
        let shared = self.shared.iter();
        let shared = shared.flat_map(|found| [found.later, found.earlier]);
        // A mesh is told by its numbers where it stands.
        let is_mesh = |place: &usize| matches!(objects[*place].shape, Shape::Mesh(_));
        let shared = shared.filter(|place| !is_mesh(place));
        let lights = self.lights_in.iter().flatten().copied();
        let eye = self.edge_on.iter().chain(&self.eye_on).copied();
        let all: BTreeSet<usize> = shared.chain(lights).chain(eye).collect();
        if all.len() <= MOST_APART {
            self.apart = all;
        }
        self.apart.extend(&self.covered);
    }
}

/// Whether a point may be on a round object.
fn is_on_any(objects: &List<Object>, point: DVec3) -> bool {
    let mut visible = objects.iter().filter(|object| object.visible);
    visible.any(|object| object.shape.height_per_radius(point) < NEAR_ROUND)
}

/// For each point the visible flat objects whose planes hold it; none where that would take long.
fn planes_through(objects: &List<Object>, points: &[DVec3]) -> Vec<Places> {
    let mut through = vec![Places::new(); points.len()];
    if objects.len() * points.len() > MOST_PAIRS {
        return through;
    }
    for (index, object) in objects.iter().enumerate() {
        let Some(piece) = object.shape.plane_piece().filter(|_| object.visible) else {
            continue;
        };
        for (point, through) in points.iter().zip(&mut through) {
            if piece.height(*point) == 0.0 {
                through.push(index);
            }
        }
    }
    through
}
