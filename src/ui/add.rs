//! The menu of what can be added.

use egui::{Button, Ui};
use egui_material_icons::MaterialIcon;
use glam::DVec3;

use super::icons;
use super::requests::UiRequests;
use crate::editor::Edit;
use crate::mesh::SOLIDS;
use crate::scene::{Mesh, Scene, Shape};

/// The menu of what can be added.
pub fn add_menu(ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
    for (icon, name, edit) in additions_to(scene) {
        let button = ui.add(Button::new((icons::text(icon), &name)));
        if button.accessible_name(name).clicked() {
            out.edit(edit);
        }
    }
}

/// What can be added, placed in front of the camera: its icon and name.
pub fn additions_to(scene: &Scene) -> Vec<(MaterialIcon, String, Edit)> {
    let (at, size) = in_front_of_camera(scene);
    let shapes = Shape::examples(at, size).into_iter();
    let shapes = shapes.filter(|shape| !matches!(shape, Shape::Mesh(_)));
    let shapes = shapes.map(|shape| {
        let (icon, name) = (icons::of_shape(&shape), format!("Add {}", shape.kind()));
        (icon, name, Edit::AddObject(shape))
    });
    let solids = SOLIDS.into_iter().map(|(solid, make)| {
        let mesh = Mesh {
            position: at,
            ..Mesh::of(make(size))
        };
        let edit = Edit::AddMesh(solid, mesh);
        (icons::MESH, format!("Add {solid}"), edit)
    });
    let light = Edit::AddLight(at + DVec3::new(0.0, size, 0.0));
    let others = [
        (icons::LIGHT, "Add Light".to_owned(), light),
        (icons::PACK, "Add ColorPack".to_owned(), Edit::AddPack),
    ];
    shapes.chain(solids).chain(others).collect()
}

/// Where a new thing goes, and how large it is: in the middle of the picture, a fifth of its height.
fn in_front_of_camera(scene: &Scene) -> (DVec3, f64) {
    let camera = &scene.camera;
    let look = camera
        .look_at
        .try_normalize()
        .unwrap_or(DVec3::new(0.0, 0.0, -1.0));
    let extent = scene
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).length());
    let distance = if extent > 0.0 { extent / 2.0 } else { 100.0 };
    let height = match camera.projection {
        crate::scene::Projection::Perspective => distance / camera.projection_distance,
        crate::scene::Projection::Orthographic => camera.orthographic_height,
    };
    // Whole numbers read better in the inspector, where the scene is large enough for them.
    let tidy = |x: f64| if distance > 10.0 { x.round() } else { x };
    let at = camera.position + look * distance;
    (
        DVec3::new(tidy(at.x), tidy(at.y), tidy(at.z)),
        tidy(height / 5.0).max(1e-6),
    )
}
