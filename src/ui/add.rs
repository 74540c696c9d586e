//! What can be added, in a menu and by name.

use egui::{Button, Ui};
use egui_material_icons::MaterialIcon;
use glam::DVec3;

use super::icons;
use super::requests::UiRequests;
use crate::editor::Edit;
use crate::lab::{Sight, explain};
use crate::mesh::SOLIDS;
use crate::scene::{Mesh, Projection, Scene, Shape};

/// Something that can be added.
#[derive(Clone, Copy, Debug)]
pub enum Addition {
    /// The shape in this place of [`Shape::examples`].
    Shape(usize),
    /// The mesh in this place of [`SOLIDS`].
    Solid(usize),
    /// A light.
    Light,
    /// A color pack.
    Pack,
}

impl Addition {
    /// The change that adds it, in front of what the camera sees.
    pub fn edit(self, scene: &Scene) -> Edit {
        let (at, size) = in_front_of_camera(scene);
        match self {
            Self::Shape(place) => Edit::AddObject(Shape::examples(at, size).swap_remove(place)),
            Self::Solid(place) => {
                let solid = SOLIDS[place];
                let mesh = Mesh {
                    position: at,
                    smooth: solid.smooth,
                    ..Mesh::of((solid.make)(size))
                };
                Edit::AddMesh(solid.name, mesh)
            }
            Self::Light => Edit::AddLight(at + DVec3::new(0.0, size, 0.0)),
            Self::Pack => Edit::AddPack,
        }
    }

    /// All of them, with their icons and names.
    pub fn all() -> impl Iterator<Item = (Self, MaterialIcon, String)> {
        let shapes = Shape::examples(DVec3::ZERO, 1.0).into_iter().enumerate();
        // Meshes have names of their own.
        let shapes = shapes.filter(|(_, shape)| !matches!(shape, Shape::Mesh(_)));
        let shapes = shapes.map(|(place, shape)| {
            let name = format!("Add {}", shape.kind());
            (Self::Shape(place), icons::of_shape(&shape), name)
        });
        let solids = SOLIDS.iter().enumerate();
        let solids = solids.map(|(place, solid)| {
            (
                Self::Solid(place),
                icons::MESH,
                format!("Add {}", solid.name),
            )
        });
        let others = [
            (Self::Light, icons::LIGHT, "Add Light".to_owned()),
            (Self::Pack, icons::PACK, "Add ColorPack".to_owned()),
        ];
        shapes.chain(solids).chain(others)
    }
}

/// The menu of what can be added.
pub fn add_menu(ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
    for (addition, icon, name) in Addition::all() {
        let button = ui.add(Button::new((icons::text(icon), &name)));
        if button.accessible_name(name).clicked() {
            out.edit(addition.edit(scene));
        }
    }
}

/// Where a new thing goes, and how large it is: in the middle of the picture, a fifth of its height, before what
/// is there.
fn in_front_of_camera(scene: &Scene) -> (DVec3, f64) {
    let camera = &scene.camera;
    let middle = camera.framing().map(|framing| framing.ray([0.0, 0.0]));
    let (origin, look) = middle.unwrap_or((camera.position, DVec3::NEG_Z));
    let extent = scene
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).length());
    let usual = if extent > 0.0 { extent / 2.0 } else { 100.0 };
    // What is close to the eye fills the picture anyway.
    let seen = match explain(scene, origin, look) {
        Sight::Surface(lit) if lit.distance > NEAREST * usual => lit.distance,
        _ => f64::INFINITY,
    };
    let (distance, height) = match camera.projection {
        Projection::Perspective => {
            // The farther, the larger: half of it is between its middle and what is seen.
            let per_distance = SHARE / camera.projection_distance;
            let distance = usual.min(seen / (1.0 + per_distance / 2.0));
            (distance, distance / camera.projection_distance)
        }
        Projection::Orthographic => {
            let height = camera.orthographic_height;
            (usual.min(seen - height * SHARE / 2.0), height)
        }
    };
    // Whole numbers read better in the inspector, where the scene is large enough for them.
    let tidy = |x: f64| if height * SHARE > 10.0 { x.round() } else { x };
    let at = origin + look * distance;
    (
        DVec3::new(tidy(at.x), tidy(at.y), tidy(at.z)),
        tidy(height * SHARE).max(SMALLEST),
    )
}

/// The smallest that a new thing is, in world units.
const SMALLEST: f64 = 1e-6;
/// How large a new thing is, in heights of the picture.
const SHARE: f64 = 0.2;
/// What is nearer than this, in distances where a new thing goes, is not gone before.
const NEAREST: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_added_is_seen() {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let mut scene = Scene::demo();
            scene.camera.projection = projection;
            for (addition, _, name) in Addition::all() {
                let Edit::AddMesh(..) = addition.edit(&scene) else {
                    continue;
                };
                let mut with = scene.clone();
                addition.edit(&scene).apply(&mut with).expect("added");
                let framing = with.camera.framing().expect("a basis");
                // A torus has nothing in its middle.
                let seen = [0.0, 0.04, 0.06].iter().any(|x| {
                    let (origin, direction) = framing.ray([*x, 0.0]);
                    let sight = explain(&with, origin, direction);
                    matches!(sight, Sight::Surface(lit) if lit.object == with.objects[9].name)
                });
                assert!(seen, "{projection:?}: {name}");
            }
        }
    }
}
