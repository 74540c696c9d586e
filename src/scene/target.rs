//! Reading and writing the animated properties of a scene.

use std::collections::{HashMap, HashSet};

use super::animation::{Owner, Target, Value};
use super::shape::Shape;
use super::whole::Scene;

impl Target {
    /// Returns the value in `scene`; `None` if it has no such light or object, or that one has no such property.
    pub fn get(&self, scene: &Scene) -> Option<Value> {
        Owners::of(scene, [self]).get(scene, self)
    }
}

/// Indices of the lights and objects that a set of targets refers to, found in one pass over the scene.
#[derive(Debug)]
pub struct Owners<'a> {
    lights: HashMap<&'a str, usize>,
    objects: HashMap<&'a str, usize>,
}

impl<'a> Owners<'a> {
    /// Finds the owners of `targets` in `scene`.
    pub fn of(scene: &Scene, targets: impl IntoIterator<Item = &'a Target>) -> Self {
        let (mut lights, mut objects) = (HashSet::new(), HashSet::new());
        for target in targets {
            match target.owner() {
                Some(Owner::Light(name)) => lights.insert(name),
                Some(Owner::Object(name)) => objects.insert(name),
                None => false,
            };
        }
        Self {
            lights: indices_by_name(lights, scene.lights.iter().map(|light| &*light.name)),
            objects: indices_by_name(objects, scene.objects.iter().map(|object| &*object.name)),
        }
    }

    /// Returns the index of the target's owner in its list.
    pub fn index(&self, target: &Target) -> Option<usize> {
        match target.owner()? {
            Owner::Light(name) => self.lights.get(name),
            Owner::Object(name) => self.objects.get(name),
        }
        .copied()
    }

    /// Like [`Target::get`], for one of the targets that the owners were found for.
    pub fn get(&self, scene: &Scene, target: &Target) -> Option<Value> {
        let index = self.index(target);
        let light = || scene.lights.get(index?);
        let shape = || Some(&scene.objects.get(index?)?.shape);
        Some(match target {
            Target::AmbientIntensity => Value::Number(scene.ambient_intensity),
            Target::LightIntensity(_) => Value::Number(light()?.intensity),
            Target::LightPosition(_) => Value::Point(light()?.position),
            Target::ObjectPosition(_) => Value::Point(shape()?.position()),
            Target::ObjectRotation(_) => match shape()? {
                Shape::Mesh(mesh) => Value::Point(mesh.rotation),
                _ => return None,
            },
        })
    }

    /// Writes the value of one of the targets to the scene. A value of the wrong type, or for a missing owner,
    /// changes nothing.
    pub fn set(&self, scene: &mut Scene, target: &Target, value: Value) {
        match (target, self.index(target), value) {
            (Target::AmbientIntensity, _, Value::Number(number)) => {
                scene.ambient_intensity = number;
            }
            (Target::LightIntensity(_), Some(index), Value::Number(number)) => {
                scene.lights[index].intensity = number;
            }
            (Target::LightPosition(_), Some(index), Value::Point(point)) => {
                scene.lights[index].position = point;
            }
            (Target::ObjectPosition(_), Some(index), Value::Point(point)) => {
                match &mut scene.objects[index].shape {
                    // Its faces are not rebuilt.
                    Shape::Mesh(mesh) => mesh.position = point,
                    shape => *shape = shape.placed(point),
                }
            }
            (Target::ObjectRotation(_), Some(index), Value::Point(rotation)) => {
                if let Shape::Mesh(mesh) = &mut scene.objects[index].shape {
                    mesh.rotation = rotation;
                }
            }
            _ => {}
        }
    }
}

/// Returns the index of the first occurrence of each wanted name.
fn indices_by_name<'a, 's>(
    mut wanted: HashSet<&'a str>,
    names: impl Iterator<Item = &'s str>,
) -> HashMap<&'a str, usize> {
    let mut indices_by_name = HashMap::with_capacity(wanted.len());
    for (index, name) in names.enumerate() {
        if wanted.is_empty() {
            break;
        }
        if let Some(name) = wanted.take(name) {
            indices_by_name.insert(name, index);
        }
    }
    indices_by_name
}
