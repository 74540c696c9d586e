//! The selected keys of the camera, and the keys of other values.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{Button, Id, Ui};
use glam::DVec3;

use super::camera::place_rows;
use super::title::title;
use crate::editor::{Edit, Editor, Time};
use crate::scene::{
    Animation, Camera, Easing, Interpolation, Key, MAX_SECONDS, Orientation, Target,
};
use crate::ui::hint::Hint as _;
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{Field, Rows, coordinate};

/// Time, way and camera of the selected key; of several, way and pace of the first, which others take on.
pub fn show(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    if !ui.input(|input| input.pointer.any_down()) {
        ui.data_mut(|data| data.remove::<Moved>(drag_id()));
    }
    let animation = &editor.scene().animation;
    let indices = &editor.timeline().selected;
    let Some(first) = indices
        .iter()
        .next()
        .and_then(|&index| animation.keys.get(index))
    else {
        return;
    };
    let name = match indices.len() {
        1 => format!("Key {}", indices.iter().next().map_or(0, |index| index + 1)),
        count => format!("{count} keys"),
    };
    title(ui, icons::KEY, &name);
    let mut key = first.clone();
    let mut rows = Rows::new(ui);
    if indices.len() == 1 {
        rows.number(&time_field(), &mut key.time);
    }
    way_rows(&mut rows, editor, &mut key);
    if indices.len() == 1 {
        rows.heading("Camera");
        let angles = Orientation::of(&key.value);
        place_rows(&mut rows, angles, &mut key.value);
    }
    let changed = rows.changed();
    ui.horizontal_wrapped(|ui| buttons(ui, editor, out));
    let Some(field) = changed.filter(|_| key != *first) else {
        return;
    };
    if key.time != first.time {
        return move_key(ui, editor, key.time, out);
    }
    let changed = animation.with_each(indices, |each| {
        // Of several, what was not changed stays as it is in each.
        if key.interpolation != first.interpolation {
            each.interpolation = key.interpolation;
        }
        if key.easing != first.easing {
            each.easing = key.easing;
        }
        if key.value != first.value {
            each.value = key.value.clone();
        }
    });
    let label = match field {
        "way" => "Key: way",
        "pace" => "Key: pace",
        _ => "Key: camera",
    };
    out.edit(Edit::animation(changed, label));
}

/// A key before its time was dragged: it replaces what it lands on, and not what it passes.
#[derive(Clone)]
struct Moved {
    animation: Arc<Animation>,
    indices: BTreeSet<usize>,
    time: f64,
}

/// Moves the selected key to another time.
fn move_key(ui: &Ui, editor: &Editor, to: f64, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let indices = &editor.timeline().selected;
    let Some(first) = indices.first().and_then(|&index| animation.keys.get(index)) else {
        return;
    };
    let now = || Moved {
        animation: Arc::clone(animation),
        indices: indices.clone(),
        time: first.time,
    };
    // A typed time has nothing to remember: it is one step.
    let before = ui.data_mut(|data| data.get_temp_mut_or_insert_with(drag_id(), now).clone());
    let later = to - before.time;
    let (moved, new) = before.animation.with_moved(&before.indices, later, false);
    out.edit(Edit::animation(moved, "Key: time"));
    out.time(Time::SelectKeys(new));
}

/// Where the key that is dragged is remembered.
fn drag_id() -> Id {
    Id::unique("key before its time was dragged")
}

fn time_field() -> Field {
    Field {
        name: "time",
        hint: "Seconds from the start",
        unit: " s",
        default: 0.0,
        range: 0.0..=MAX_SECONDS,
        speed: Some(0.02),
    }
}

fn way_rows(rows: &mut Rows, editor: &Editor, key: &mut Key<Camera>) {
    let around = match key.interpolation {
        Interpolation::Orbit { around } => around,
        _ => target(editor),
    };
    let ways = [
        Interpolation::Smooth,
        Interpolation::Linear,
        Interpolation::Hold,
        Interpolation::Orbit { around },
    ];
    rows.choice(
        "way",
        "How the camera goes on to the next key.\nsmooth: in a curve\nlinear: straight\nhold: stays, then cuts\norbit: on an arc around a point",
        &mut key.interpolation,
        ways.map(|way| (way, way.name().to_owned())),
    );
    if let Interpolation::Orbit { around } = &mut key.interpolation {
        let field = coordinate("around", "The point that the arc goes around");
        let before = *around;
        rows.vector(&field, before, around);
    }
    rows.choice(
        "pace",
        "How fast, on the way to the next key",
        &mut key.easing,
        Easing::ALL.map(|easing| (easing, easing.name().to_owned())),
    );
}

/// The middle of what is selected, or of everything that ends.
pub fn target(editor: &Editor) -> DVec3 {
    let scene = editor.shown();
    let all = || scene.objects_bounds().map(|(low, high)| (low + high) * 0.5);
    editor
        .selected()
        .middle(scene)
        .or_else(all)
        .unwrap_or_default()
}

fn buttons(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let indices = &editor.timeline().selected;
    let overwrite = ui.add_enabled(indices.len() == 1, Button::new("Overwrite with view"));
    let hint = "Put the camera of the view into this key";
    if overwrite.hint(hint).clicked() {
        let view = editor.shown().camera.clone();
        let changed = animation.with_each(indices, |key| key.value = view.clone());
        out.edit(Edit::animation(changed, "Overwrite key"));
    }
    let go = ui.add_enabled(indices.len() == 1, Button::new("Go there"));
    let key = indices
        .iter()
        .next()
        .and_then(|&index| animation.keys.get(index));
    if go.hint("Put the playhead on this key").clicked()
        && let Some(key) = key
    {
        out.time(Time::Seek(key.time));
    }
    if ui.button("Delete").clicked() {
        let kept = animation.without_keys(indices);
        out.edit(Edit::animation(kept, "Delete keys"));
        out.time(Time::SelectKeys(BTreeSet::new()));
    }
}

/// A button for each value that can carry keys: sets one at the playhead, or takes it away.
pub fn of_values(ui: &mut Ui, editor: &Editor, values: &[(&str, Target)], out: &mut UiRequests) {
    let animation: &Animation = &editor.scene().animation;
    let time = editor.shown_time();
    ui.horizontal(|ui| {
        ui.weak("Keys");
        for (name, target) in values {
            let track = animation.track(target);
            let there = animation.value_at(target, time);
            let has_key = there.is_some();
            let count = track.map_or(String::new(), |track| format!(" ({})", track.keys.len()));
            let text = (icons::text(icons::KEY), format!("{name}{count}"));
            let button = Button::selectable(has_key, text);
            let hint = if has_key {
                "Take the key at the playhead away"
            } else {
                "Set a key at the playhead; from then on, changes set keys"
            };
            let button = ui.add(button).hint(hint);
            if button.accessible_name(format!("key {name}")).clicked() {
                let changed = if let Some(there) = there {
                    Some(animation.without_value(target, there))
                } else {
                    let value = target.get(editor.shown());
                    value.map(|value| animation.with_value(target, time, value))
                };
                if let Some(changed) = changed {
                    out.edit(Edit::animation(changed, "Key value"));
                }
            }
        }
    });
}
