//! Rotating or scaling a group through the properties of one of its members.

use glam::DVec3;

use crate::editor::{Edit, Item, ItemKind};
use crate::scene::{Mesh, Object, Scene, Shape, rotations_between};

/// Why a group cannot be stretched.
const SHEARED: &str = "A group with rotated parts, or parts that are not meshes, can only be scaled by the same factor in x, y and z";

/// A transformation of all members.
#[derive(Clone, Copy)]
enum Change {
    /// Between two triples of rotation angles, in degrees.
    Rotate(DVec3, DVec3),
    Scale(f64),
    Stretch(DVec3),
}

impl Change {
    /// The transformation from one mesh to another, if it is a rotation or a scaling.
    fn between(old: &Mesh, new: &Mesh) -> Option<Self> {
        if old.rotation != new.rotation {
            return Some(Self::Rotate(old.rotation, new.rotation));
        }
        let ratio = new.scale / old.scale;
        match ratio == DVec3::splat(ratio.x) {
            _ if old.scale == new.scale || !ratio.is_finite() => None,
            true => (ratio.x > 0.0).then_some(Self::Scale(ratio.x)),
            false => Some(Self::Stretch(ratio)),
        }
    }

    /// Applies the transformation to a member, about a point. `None` if it would shear the shape, which no shape
    /// can represent.
    fn apply(self, shape: &Shape, about: DVec3) -> Option<Shape> {
        match (self, shape) {
            (Self::Rotate(from, to), shape) => {
                let rotations = rotations_between(from, to);
                Some(rotations.fold(shape.clone(), |shape, by| shape.turned(about, by)))
            }
            (Self::Scale(by), shape) => Some(shape.scaled(about, by)),
            (Self::Stretch(by), Shape::Mesh(mesh)) if mesh.rotation == DVec3::ZERO => {
                let stretched = Mesh {
                    position: about + (mesh.position - about) * by,
                    scale: mesh.scale * by,
                    ..mesh.clone()
                };
                Some(stretched.into())
            }
            (Self::Stretch(_), _) => None,
        }
    }

    fn verb(self) -> &'static str {
        match self {
            Self::Rotate(..) => "Rotate",
            Self::Scale(_) | Self::Stretch(_) => "Resize",
        }
    }
}

/// Returns the edit that rotates or scales all members of a group about the mean of their positions, as `edit` does
/// one of them. The mean is unchanged by this, however often it is repeated. `None` if `edit` does neither.
///
/// # Errors
/// Why it is impossible, in words: some members would be sheared.
pub fn transform_group(
    scene: &Scene,
    members: &[Item],
    edit: &Edit,
) -> Option<Result<Edit, &'static str>> {
    let Edit::Object(edited, new, field) = edit else {
        return None;
    };
    let (Shape::Mesh(old), Shape::Mesh(new)) = (&scene.objects.get(*edited)?.shape, &new.shape)
    else {
        return None;
    };
    let change = Change::between(old, new)?;
    let objects = members.iter().filter(|item| item.kind == ItemKind::Object);
    let objects = objects.filter_map(|item| Some((item.index, scene.objects.get(item.index)?)));
    let objects: Vec<(usize, &Object)> = objects.collect();
    let sum: DVec3 = objects
        .iter()
        .map(|(_, object)| object.shape.position())
        .sum();
    let about = sum / objects.len() as f64;
    let edits = objects.iter().map(|&(index, object)| {
        let mut shape = change.apply(&object.shape, about)?;
        if let Shape::Mesh(mesh) = &mut shape
            && index == *edited
        {
            // Exactly what was typed.
            (mesh.rotation, mesh.scale) = (new.rotation, new.scale);
        }
        let changed = Object {
            shape,
            ..object.clone()
        };
        Some(Edit::object(index, changed, field))
    });
    let Some(edits) = edits.collect::<Option<Vec<Edit>>>() else {
        return Some(Err(SHEARED));
    };
    let label = format!("{} {} items", change.verb(), edits.len());
    Some(Ok(Edit::Each(edits, label)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::SOLIDS;
    use crate::scene::Sphere;

    type Changed = Result<(Mesh, Sphere), &'static str>;

    /// Applies a change to a box with a ball beside it, and returns both as they are afterwards.
    fn changed(change: impl FnOnce(&mut Mesh)) -> Option<Changed> {
        let mut scene = Scene::demo();
        let mesh = Mesh {
            position: DVec3::new(10.0, 0.0, 0.0),
            ..Mesh::of((SOLIDS[0].make)(4.0))
        };
        let center = DVec3::new(-10.0, 0.0, 0.0);
        scene.objects[0].shape = mesh.clone().into();
        scene.objects[1].shape = Sphere {
            center,
            radius: 3.0,
        }
        .into();
        let mut new = mesh;
        change(&mut new);
        let edit = Edit::object(
            0,
            Object {
                shape: new.into(),
                ..scene.objects[0].clone()
            },
            "rotation",
        );
        let edit = transform_group(&scene, &[Item::object(1), Item::object(0)], &edit)?;
        match edit {
            Ok(edit) => edit.apply(&mut scene).expect("made"),
            Err(why) => return Some(Err(why)),
        };
        match (&scene.objects[0].shape, &scene.objects[1].shape) {
            (Shape::Mesh(mesh), Shape::Sphere(ball)) => Some(Ok((mesh.clone(), *ball))),
            _ => panic!("other shapes"),
        }
    }

    fn turned(change: impl FnOnce(&mut Mesh)) -> (Mesh, Sphere) {
        changed(change).expect("a change").expect("of all")
    }

    #[test]
    fn a_group_is_turned_and_grows_about_its_middle() {
        let (mesh, ball) = turned(|mesh| mesh.rotation.y = 90.0);
        assert_eq!(mesh.rotation, DVec3::new(0.0, 90.0, 0.0));
        assert!((mesh.position - DVec3::NEG_Z * 10.0).length() < 1e-9);
        assert!((ball.center - DVec3::Z * 10.0).length() < 1e-9);
        let (mesh, ball) = turned(|mesh| mesh.scale *= 3.0);
        assert_eq!((mesh.position.x, ball.center.x), (30.0, -30.0));
        assert_eq!((mesh.scale, ball.radius), (DVec3::splat(3.0), 9.0));
    }

    #[test]
    fn what_would_be_sheared_stays() {
        let of_a_ball = changed(|mesh| mesh.scale.x = 2.0);
        assert_eq!(of_a_ball.and_then(Result::err), Some(SHEARED));
        assert!(changed(|mesh| mesh.position.x = 2.0).is_none(), "moved");
    }
}
