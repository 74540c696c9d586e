//! The properties of the camera: projection, position, angles and vectors.

use egui::{Align, Id, Layout, Ui, vec2};

use super::title::{name_field, title};
use crate::editor::{Edit, Editor, free_bookmark_name};
use crate::scene::{
    Bookmark, Camera, MAX_COORDINATE, MIN_ORTHOGRAPHIC_HEIGHT, Orientation, PROJECTION_DISTANCES,
    Projection, field_of_view_radians,
};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::menu_entry::on_click;
use crate::ui::number::ROUNDED_ANGLE;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{Field, FieldRows, coordinate};
use crate::ui::theme::ROW;

/// Shows every property of the camera.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    title(ui, icons::CAMERA, "Camera");
    let before = &editor.shown().camera;
    let mut camera = before.clone();
    let mut rows = FieldRows::new(ui);
    camera_rows(&mut rows, editor.orientation(), &mut camera);
    rows.heading("Vectors");
    let defaults = Camera::default();
    rows.vector(
        &coordinate("look_at", "Viewing direction; its length does not matter"),
        defaults.look_at,
        &mut camera.look_at,
    );
    rows.vector(
        &coordinate("up", "Roughly upwards; must not be parallel to look_at"),
        defaults.up,
        &mut camera.up,
    );
    let changed = rows.changed();
    ui.horizontal(|ui| {
        let frame = ui.button("Frame everything");
        let hint = "Move the camera so that all of the scene is in the picture";
        on_click(ui, frame, (hint, Command::FrameAll), out);
        let angles = editor.orientation();
        let is_level = angles.roll.to_degrees().abs() < ROUNDED_ANGLE;
        let level = ui.add_enabled(!is_level, egui::Button::new("Level"));
        let obstacle = is_level.then_some("its roll is 0");
        if level
            .hint_unless(obstacle, "Turn the camera upright")
            .clicked()
        {
            let upright = Orientation {
                roll: 0.0,
                ..angles
            };
            out.edit(Edit::Camera(upright.apply(before), "roll"));
        }
    });
    if camera.projection != before.projection {
        // As with the keyboard commands, which keep the apparent size of things.
        out.commands.push(Command::Projection(camera.projection));
    } else if let Some(field) = changed.filter(|_| camera != *before) {
        out.edit(Edit::Camera(camera, field));
    }
    bookmarks(ui, editor, out);
}

/// The bookmarked views.
fn bookmarks(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let before = &editor.scene().bookmarks;
    if before.is_empty() {
        return;
    }
    FieldRows::new(ui).heading("Bookmarks");
    for (index, Bookmark { name, .. }) in before.iter().enumerate() {
        let size = vec2(ui.available_width(), ROW);
        let layout = Layout::right_to_left(Align::Center);
        ui.allocate_ui_with_layout(size, layout, |ui| {
            let remove = icons::button(ui, icons::CLOSE, &format!("Remove {name}"));
            if remove.clicked() {
                let mut bookmarks = before.clone();
                bookmarks.remove(index);
                return out.edit(Edit::Bookmarks(bookmarks, "Remove bookmark"));
            }
            let go = icons::button(ui, icons::CAMERA, &format!("Look from {name}"));
            if go.clicked() {
                out.commands.push(Command::GoToBookmark(index));
            }
            let (id, label) = (
                Id::unique(("bookmark", index)),
                format!("bookmark {}", index + 1),
            );
            if let Some(name) = name_field(ui, &label, id, name) {
                let mut bookmarks = before.clone();
                let renamed = bookmarks.remove(index);
                let name = free_bookmark_name(&bookmarks, &name);
                bookmarks.insert(index, Bookmark { name, ..renamed });
                out.edit(Edit::Bookmarks(bookmarks, "Rename bookmark"));
            }
        });
    }
}

/// Rows for projection, position and angles.
pub fn camera_rows(rows: &mut FieldRows, angles: Orientation, camera: &mut Camera) {
    let kinds = [Projection::Perspective, Projection::Orthographic];
    rows.choice(
        "projection",
        "Whether rays spread from the eye (P) or run parallel (O)",
        &mut camera.projection,
        kinds.map(|kind| (kind, format!("{kind:?}"))),
    );
    projection_rows(rows, camera);
    rows.heading("Placement");
    rows.vector(
        &coordinate("position", "Where the camera stands, in world units"),
        Camera::default().position,
        &mut camera.position,
    );
    angle_rows(rows, angles, camera);
}

fn projection_rows(rows: &mut FieldRows, camera: &mut Camera) {
    let defaults = Camera::default();
    if camera.projection == Projection::Orthographic {
        rows.number(
            &Field {
                name: "height",
                hint: "Height of the view window, in world units",
                unit: "",
                default: defaults.orthographic_height,
                range: MIN_ORTHOGRAPHIC_HEIGHT..=MAX_COORDINATE,
                speed: None,
            },
            &mut camera.orthographic_height,
        );
        return;
    }
    rows.number(
        &Field {
            name: "distance",
            hint: "Projection distance: from the eye to the image plane, in image heights (0.001–100000). Longer gives a narrower view",
            unit: " h",
            default: defaults.projection_distance,
            range: PROJECTION_DISTANCES,
            speed: None,
        },
        &mut camera.projection_distance,
    );
    let degrees = camera.field_of_view_radians().to_degrees();
    let view_angle = |distance| field_of_view_radians(distance).to_degrees();
    let distances = PROJECTION_DISTANCES;
    let mut edited = degrees;
    rows.number(
        &Field {
            name: "view angle",
            hint: "The same as an angle: vertical field of view in degrees",
            unit: "°",
            default: view_angle(defaults.projection_distance),
            range: view_angle(*distances.end())..=view_angle(*distances.start()),
            speed: None,
        },
        &mut edited,
    );
    if edited != degrees {
        camera.projection_distance = 0.5 / (edited.to_radians() / 2.0).tan();
    }
}

/// Rows for yaw, pitch and roll in degrees; a change recomputes `look_at` and `up` from them.
fn angle_rows(rows: &mut FieldRows, before: Orientation, camera: &mut Camera) {
    let mut angles = before;
    let parts = [
        (
            "yaw",
            "Turn to the right; 270° is the same as -90°",
            360.0,
            &mut angles.yaw,
        ),
        (
            "pitch",
            "Tilt upwards, up to 89.9°",
            89.9,
            &mut angles.pitch,
        ),
        (
            "roll",
            "Lean to the right; 270° is the same as -90°",
            360.0,
            &mut angles.roll,
        ),
    ];
    for (name, hint, limit, radians) in parts {
        let degrees = radians.to_degrees();
        let mut edited = degrees;
        let field = Field {
            name,
            hint,
            unit: "°",
            default: 0.0,
            range: -limit..=limit,
            speed: Some(0.25),
        };
        rows.number(&field, &mut edited);
        if edited != degrees {
            *radians = edited.to_radians();
        }
    }
    if angles != before {
        *camera = angles.apply(camera);
    }
}
