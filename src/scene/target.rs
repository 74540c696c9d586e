//! What tracks move in a scene.

use super::animation::{Target, Value};
use super::object::Light;
use super::shape::Shape;
use super::whole::Scene;

impl Target {
    /// The value in a scene; `None` if the scene has no such light or object, or it
    /// has no such property.
    pub fn get(&self, scene: &Scene) -> Option<Value> {
        let light = |name: &String| scene.lights.iter().find(|light| light.name == *name);
        Some(match self {
            Self::AmbientIntensity => Value::Number(scene.ambient_intensity),
            Self::LightIntensity(name) => Value::Number(light(name)?.intensity),
            Self::LightPosition(name) => Value::Point(light(name)?.position),
            Self::ObjectPosition(name) => Value::Point(shape(scene, name)?.position()),
            Self::ObjectRotation(name) => match shape(scene, name)? {
                Shape::Mesh(mesh) => Value::Point(mesh.rotation),
                _ => return None,
            },
        })
    }

    /// Puts a value into a scene; one of the wrong kind, or for what is not there, changes nothing.
    pub fn set(&self, scene: &mut Scene, value: Value) {
        match (self, value) {
            (Self::AmbientIntensity, Value::Number(number)) => scene.ambient_intensity = number,
            (Self::LightIntensity(name), Value::Number(number)) => {
                if let Some(light) = light(scene, name) {
                    light.intensity = number;
                }
            }
            (Self::LightPosition(name), Value::Point(point)) => {
                if let Some(light) = light(scene, name) {
                    light.position = point;
                }
            }
            (Self::ObjectPosition(name), Value::Point(point)) => {
                let object = scene.objects.find_mut(|object| object.name == *name);
                match object.map(|object| &mut object.shape) {
                    None => {}
                    // To and fro, it would be rounded.
                    Some(Shape::Mesh(mesh)) => mesh.position = point,
                    Some(shape) => *shape = shape.moved(point - shape.position()),
                }
            }
            (Self::ObjectRotation(name), Value::Point(rotation)) => {
                let object = scene.objects.find_mut(|object| object.name == *name);
                if let Some(Shape::Mesh(mesh)) = object.map(|object| &mut object.shape) {
                    mesh.rotation = rotation;
                }
            }
            _ => {}
        }
    }
}

fn shape<'s>(scene: &'s Scene, name: &str) -> Option<&'s Shape> {
    let object = scene.objects.iter().find(|object| object.name == name)?;
    Some(&object.shape)
}

fn light<'s>(scene: &'s mut Scene, name: &str) -> Option<&'s mut Light> {
    scene.lights.find_mut(|light| light.name == name)
}
