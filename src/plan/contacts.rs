//! What touches: objects that fill the same surface, and eyes and lights on one. Rounding would decide what
//! is seen there; here it is decided once, for all rays and in any precision.

use std::collections::BTreeSet;

use glam::DVec3;

use super::request::{Model, RenderRequest};
use crate::scene::{Coincidence, List, Object, Projection, Scene};

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
    /// Objects in whose surface earlier ones lie, which are seen there: those, in their order.
    pub under: Vec<(usize, Places)>,
    /// The flat objects whose planes hold the eye: it sees their edges at most.
    pub edge_on: Places,
    /// The round object whose surface the eye is on.
    pub eye_on: Option<usize>,
    /// For each light of the scene, the flat objects whose planes hold it: they cast no shadow from it.
    pub lights_in: Vec<Places>,
    /// The lights of the scene that may be on the surface of an object that is no mesh.
    pub touching_lights: Places,
    apart: BTreeSet<usize>,
}

/// A primitive in whose surface others lie.
#[derive(Clone, Debug)]
pub struct Tie {
    /// Its number.
    pub number: usize,
    /// The numbers of the others; the first that a ray meets is seen.
    pub over: Vec<usize>,
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
        let projection = request.projection_of(&scene.camera);
        if projection == Projection::Perspective {
            let eye = scene.camera.position;
            contacts.edge_on = planes_through(&scene.objects, &[eye]).concat();
            let looked_at = scene.objects.iter().take(MOST_PAIRS);
            let is_on = |object: &Object| object.shape.height_per_radius(eye) <= ON_ROUND;
            contacts.eye_on = looked_at
                .enumerate()
                .find(|(_, object)| object.visible && is_on(object))
                .map(|(index, _)| index);
        }
        contacts.set_apart();
        contacts
    }

    fn add(&mut self, found: Coincidence) {
        if found.is_whole {
            self.covered.insert(found.later);
            return;
        }
        match self
            .under
            .last_mut()
            .filter(|(later, _)| *later == found.later)
        {
            Some((_, earlier)) => earlier.push(found.earlier),
            None => self.under.push((found.later, vec![found.earlier])),
        }
    }

    /// The objects that stand in no tree: those that are hidden, and those that are traced otherwise than
    /// others, unless there are too many.
    pub fn apart(&self) -> &BTreeSet<usize> {
        &self.apart
    }

    /// The ties, given the numbers of objects.
    pub fn ties(&self, number: impl Fn(&usize) -> Option<usize>) -> Vec<Tie> {
        let ties = self.under.iter().filter_map(|(later, earlier)| {
            Some(Tie {
                number: number(later)?,
                over: earlier.iter().filter_map(&number).collect(),
            })
        });
        ties.collect()
    }

    fn set_apart(&mut self) {
        let under = self.under.iter();
        let under = under.flat_map(|(later, earlier)| std::iter::once(later).chain(earlier));
        let lights = self.lights_in.iter().flatten();
        let eye = self.edge_on.iter().chain(&self.eye_on);
        let all: BTreeSet<usize> = under.chain(lights).chain(eye).copied().collect();
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
