//! The menu of what can be added.

use egui::{Button, Ui};
use glam::DVec3;

use super::icons;
use super::requests::UiRequests;
use crate::editor::Edit;
use crate::mesh::SOLIDS;
use crate::scene::{Mesh, Scene, Shape};

/// What can be added, placed in front of the camera.
pub fn add_menu(ui: &mut Ui, scene: &Scene, out: &mut UiRequests) {
    let (at, size) = in_front_of_camera(scene);
    let shapes = Shape::examples(at, size).into_iter();
    for shape in shapes.filter(|shape| !matches!(shape, Shape::Mesh(_))) {
        let name = format!("Add {}", shape.kind());
        if ui
            .add(Button::new((icons::text(icons::of_shape(&shape)), &name)))
            .accessible_name(name)
            .clicked()
        {
            out.edit(Edit::AddObject(shape));
        }
    }
    for (solid, make) in SOLIDS {
        let name = format!("Add {solid}");
        let button = Button::new((icons::text(icons::MESH), &name));
        if ui.add(button).accessible_name(name).clicked() {
            let mesh = Mesh {
                position: at,
                ..Mesh::of(make(size))
            };
            out.edit(Edit::AddMesh(solid, mesh));
        }
    }
    let others = [
        (
            icons::LIGHT,
            "Add Light",
            Edit::AddLight(at + DVec3::new(0.0, size, 0.0)),
        ),
        (icons::PACK, "Add ColorPack", Edit::AddPack),
    ];
    for (icon, name, edit) in others {
        if ui
            .add(Button::new((icons::text(icon), name)))
            .accessible_name(name)
            .clicked()
        {
            out.edit(edit);
        }
    }
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
