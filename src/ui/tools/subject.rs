//! The objects and lights that the tools move, as they are on screen.

use glam::{DQuat, DVec3};

use crate::editor::{Edit, Item, ItemKind, Selection};
use crate::scene::{Light, Object, Scene, Shape};

/// An item with a position.
#[derive(Clone, Debug)]
pub enum Movable {
    /// An object with its index in the scene.
    Object(usize, Object),
    /// A light with its index in the scene.
    Light(usize, Light),
}

impl Movable {
    /// The item as it is on screen, if it has a position.
    pub fn new(scene: &Scene, Item { kind, index }: Item) -> Option<Self> {
        match kind {
            ItemKind::Object => Some(Self::Object(index, scene.objects.get(index)?.clone())),
            ItemKind::Light => Some(Self::Light(index, scene.lights.get(index)?.clone())),
            ItemKind::Pack => None,
        }
    }

    /// The items of a selection that have a position.
    pub fn of(selected: &Selection, scene: &Scene) -> Vec<Self> {
        let items = selected.items().iter();
        items.filter_map(|item| Self::new(scene, *item)).collect()
    }

    /// The bounding box, if it is finite.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Object(_, object) => object.shape.bounds(),
            Self::Light(_, light) => {
                let radius = light.marker.as_ref().map_or(0.0, |marker| marker.radius);
                let reach = DVec3::splat(radius);
                Some((light.position - reach, light.position + reach))
            }
        }
    }

    /// The shape, if it is an object.
    pub fn shape(&self) -> Option<&Shape> {
        match self {
            Self::Object(_, object) => Some(&object.shape),
            Self::Light(..) => None,
        }
    }

    /// The middle of its bounding box; its position if it is infinite.
    pub fn middle(&self) -> DVec3 {
        match self {
            Self::Object(_, object) => object.shape.middle(),
            Self::Light(_, light) => light.position,
        }
    }

    /// The point whose coordinates are rounded when it is moved: the position of shapes that have a single point,
    /// the middle of others.
    pub fn position(&self) -> DVec3 {
        match self.shape() {
            Some(shape) if shape.points().len() == 1 => shape.position(),
            _ => self.middle(),
        }
    }

    /// The edit that moves it to a position.
    pub fn placed(&self, place: DVec3) -> Edit {
        match self {
            Self::Object(_, object) if object.shape.points().len() == 1 => {
                self.reshaped(object.shape.placed(place), "move")
            }
            Self::Object(..) => self.moved(place - self.position()),
            Self::Light(index, light) => {
                let light = Light {
                    position: place,
                    ..light.clone()
                };
                Edit::Light(*index, light, "move")
            }
        }
    }

    /// The edit that moves it by an offset.
    pub fn moved(&self, by: DVec3) -> Edit {
        match self {
            Self::Object(_, object) => self.reshaped(object.shape.moved(by), "move"),
            Self::Light(_, light) => self.placed(light.position + by),
        }
    }

    /// The edit that rotates it about a point.
    pub fn turned(&self, about: DVec3, (axis, degrees): (DVec3, f64)) -> Edit {
        let by = DQuat::from_axis_angle(axis, degrees.to_radians());
        match self {
            Self::Object(_, object) => {
                let turned = match &object.shape {
                    Shape::Mesh(mesh) => mesh.turned_by(about, (axis, degrees)).into(),
                    shape => shape.turned(about, by),
                };
                self.reshaped(turned, "rotate")
            }
            Self::Light(_, light) => {
                self.moved(by * (light.position - about) + about - light.position)
            }
        }
    }

    /// The edit that scales its size and its distance from a point.
    pub fn scaled(&self, about: DVec3, by: f64) -> Edit {
        match self {
            Self::Object(_, object) => self.reshaped(object.shape.scaled(about, by), "size"),
            Self::Light(index, light) => {
                let mut light = light.clone();
                light.position = about + (light.position - about) * by;
                if let Some(marker) = &mut light.marker {
                    marker.radius *= by;
                }
                Edit::Light(*index, light, "size")
            }
        }
    }

    /// The edit that sets its radius, if it has one.
    pub fn with_radius(&self, radius: f64) -> Option<Edit> {
        match self {
            Self::Object(_, object) => {
                let mut shape = object.shape.clone();
                match &mut shape {
                    Shape::Sphere(ball) => ball.radius = radius,
                    Shape::Disc(disc) => disc.radius = radius,
                    _ => return None,
                }
                Some(self.reshaped(shape, "radius"))
            }
            Self::Light(index, light) => {
                let mut light = light.clone();
                light.marker.as_mut()?.radius = radius;
                Some(Edit::Light(*index, light, "radius"))
            }
        }
    }

    /// The edit that gives it another shape.
    pub fn reshaped(&self, shape: Shape, field: &'static str) -> Edit {
        match self {
            Self::Object(index, object) => {
                let object = Object {
                    shape,
                    ..object.clone()
                };
                Edit::object(*index, object, field)
            }
            Self::Light(index, light) => Edit::Light(*index, light.clone(), field),
        }
    }
}
