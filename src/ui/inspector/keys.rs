//! The properties of the selected keys.

use std::sync::Arc;

use egui::{Button, Id, Ui};
use glam::DVec3;

use super::camera::camera_rows;
use super::items::angle;
use super::title::{differing, list_differing, title};
use crate::editor::{Action, Edit, Editor, Item, ItemKind, Time};
use crate::scene::{
    Animation, Easing, Interpolation, KeyId, Keys, MAX_SECONDS, Orientation, Owners, Scene, Shape,
    Target, Value,
};
use crate::ui::commands::Command;
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::requests::UiRequests;
use crate::ui::rows::{Field, FieldRows, coordinate, fraction};
use crate::words::counted;

/// The interpolations that a key of any value can have.
const BASIC_INTERPOLATIONS: [Interpolation; 3] = [
    Interpolation::Smooth,
    Interpolation::Linear,
    Interpolation::Hold,
];

/// Shows time, interpolation, easing and value of the selected key. For several keys, the time is that of the
/// earliest, which the others follow; interpolation and easing are those of the first, and changes are applied to all.
pub fn show(ui: &mut Ui, editor: &Editor, places: &Keys, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let Some(&first) = places.first() else { return };
    let pace = animation.time_and_pace_of(first).map(|(_, pace)| pace);
    let (Some(pace), Some((time, last))) = (pace, animation.span_of(places)) else {
        return;
    };
    let only = (places.len() == 1).then_some(first);
    let name = if let Some(only) = only {
        animation.name_of(only)
    } else {
        counted(places.len(), "key")
    };
    title(ui, icons::KEY, &name);
    let paces = places
        .iter()
        .filter_map(|place| animation.time_and_pace_of(*place));
    let paces: Vec<_> = paces.map(|(_, pace)| pace).collect();
    let different = differing(
        &paces,
        &[
            ("interpolation", |a, b| a.0 == b.0),
            ("easing", |a, b| a.1 == b.1),
        ],
    );
    list_differing(ui, &different);
    let (mut new_time, mut new_pace) = (time, pace);
    let mut rows = FieldRows::new(ui);
    rows.number(&time_field(only.is_some()), &mut new_time);
    let (duration, mut new_duration) = (last - time, last - time);
    if duration > 0.0 {
        let field = duration_field(animation.frames_per_second);
        rows.number(&field, &mut new_duration);
    }
    interpolation_rows(&mut rows, editor, &mut new_pace);
    let new_value = only.and_then(|only| value_rows(&mut rows, animation, only));
    // With several keys, choosing the shown interpolation or easing again applies it to those that differ.
    let chosen = rows.chosen().map(|chosen| chosen.field);
    let chosen =
        chosen.filter(|field| only.is_none() && ["interpolation", "easing"].contains(field));
    let changed = rows.changed().or(chosen);
    ui.horizontal_wrapped(|ui| buttons(ui, editor, out));
    if new_time != time {
        retime(ui, editor, out, |before| {
            let offset = new_time - before.time;
            before.animation.with_moved(&before.places, offset, false)
        });
    } else if new_duration != duration {
        retime(ui, editor, out, |before| {
            before
                .animation
                .with_stretched(&before.places, new_duration)
        });
    } else if let Some(value) = new_value {
        out.edit(Edit::animation(value, "Key: value"));
    } else if new_pace != pace || only.is_none() && changed.is_some() {
        // With several keys, each keeps the part that was not changed.
        let (interpolation, easing) = new_pace;
        out.edit(match changed {
            Some("easing") => Edit::key_easing(animation, places, easing),
            Some("around") => {
                Edit::key_interpolation(animation, &animation.orbiting(places), interpolation)
            }
            _ => Edit::key_interpolation(animation, places, interpolation),
        });
    }
}

/// Rows for the value of a key. Returns the changed animation if the value was edited.
fn value_rows(rows: &mut FieldRows, animation: &Animation, place: KeyId) -> Option<Animation> {
    let Some(track) = place.track else {
        let key = animation.keys.get(place.index)?;
        let mut camera = key.value.clone();
        rows.heading("Camera");
        camera_rows(rows, Orientation::of(&key.value), &mut camera);
        let only_key = Keys::from([place]);
        return (camera != key.value)
            .then(|| animation.with_each(&only_key, |key| key.value = camera.clone()));
    };
    let track = animation.tracks.get(track)?;
    let key = track.keys.get(place.index)?;
    let mut value = key.value;
    match &mut value {
        Value::Number(number) => rows.number(&intensity_field(), number),
        Value::Point(point) => rows.vector(&point_field(&track.target), DVec3::ZERO, point),
    }
    (value != key.value).then(|| animation.with_value(&track.target, key.time, value))
}

fn intensity_field() -> Field {
    fraction("intensity", "Brightness at that time, 0–1", 1.0)
}

fn point_field(target: &Target) -> Field {
    match target {
        Target::ObjectRotation(_) => {
            let hint = "Rotation at that time: about x, then y, then z";
            angle("rotation", hint)
        }
        _ => coordinate("position", "Position at that time, in world units"),
    }
}

/// Reports how many keys were replaced by a change of time, once it is over, whatever is selected by then.
pub fn report_replaced_keys(ui: &Ui, editor: &Editor, out: &mut UiRequests) {
    if ui.input(|input| input.pointer.any_down()) {
        return;
    }
    let before_move: Option<BeforeMove> = ui.data_mut(|data| data.remove_temp(drag_id()));
    let message = before_move.and_then(|before_move| {
        let before = before_move.animation.key_count();
        replaced_keys_message(before, &editor.scene().animation)
    });
    out.actions.extend(message.map(Action::Tell));
}

/// The state before the time of keys was dragged: a drag replaces the keys that it ends on, not those that it
/// passes.
#[derive(Clone, Default)]
struct BeforeMove {
    animation: Arc<Animation>,
    places: Keys,
    time: f64,
}

/// Moves the selected keys as `change` does it from the state before the drag.
fn retime(
    ui: &Ui,
    editor: &Editor,
    out: &mut UiRequests,
    change: impl FnOnce(&BeforeMove) -> (Animation, Keys),
) {
    let animation = &editor.scene().animation;
    let places = editor.selection().keys();
    let Some((time, _)) = animation.span_of(places) else {
        return;
    };
    let current = || BeforeMove {
        animation: Arc::clone(animation),
        places: places.clone(),
        time,
    };
    // Also stored for a typed time, which is reported on in the next frame.
    let before = ui.data_mut(|data| data.get_temp_mut_or_insert_with(drag_id(), current).clone());
    let (moved, new) = change(&before);
    out.edit(Edit::animation(moved, "Key: time"));
    out.select(new);
}

/// The message after moved keys have replaced others, so that of `before` keys fewer are left.
pub fn replaced_keys_message(before: usize, now: &Animation) -> Option<String> {
    let count = before.saturating_sub(now.key_count());
    let them = if count == 1 { "it" } else { "them" };
    let keys = counted(count, "key");
    (count > 0).then(|| format!("This has replaced {keys}; undo brings {them} back"))
}

/// Where the state before a drag is stored.
fn drag_id() -> Id {
    Id::unique("key before its time was dragged")
}

fn time_field(is_only: bool) -> Field {
    let (name, hint) = if is_only {
        let hint = "Seconds from the start; replaces a key that is already there";
        ("time", hint)
    } else {
        let hint = "Seconds from the start to the earliest of them; the others move along";
        ("first at", hint)
    };
    Field {
        name,
        hint,
        unit: " s",
        default: 0.0,
        range: 0.0..=MAX_SECONDS,
        speed: Some(0.02),
    }
}

fn duration_field(frames_per_second: f64) -> Field {
    Field {
        name: "duration",
        hint: "Seconds from the first to the last of them; those between keep their shares of it",
        unit: " s",
        default: 1.0,
        range: 1.0 / frames_per_second..=MAX_SECONDS,
        speed: Some(0.02),
    }
}

fn interpolation_rows(
    rows: &mut FieldRows,
    editor: &Editor,
    (interpolation, easing): &mut (Interpolation, Easing),
) {
    let interpolations = interpolations_for(editor, editor.selection().keys(), *interpolation);
    let can_orbit = interpolations.len() > BASIC_INTERPOLATIONS.len();
    rows.choice(
        "interpolation",
        "Interpolation to the next key.\nsmooth: along a curve\nlinear: straight\nhold: stays, then jumps\norbit: along an arc around a point",
        interpolation,
        interpolations.into_iter().map(|kind| (kind, kind.name().to_owned())),
    );
    if let Interpolation::Orbit { around } = interpolation
        && can_orbit
    {
        let field = coordinate("around", "The point that the arc goes around");
        rows.vector(&field, DVec3::ZERO, around);
    }
    rows.choice(
        "easing",
        "How the speed changes on the way to the next key",
        easing,
        Easing::ALL.map(|easing| (easing, easing.name().to_owned())),
    );
}

/// The interpolations that all of these keys can have; `current` is that of one of them. Only positions can orbit a
/// point.
pub fn interpolations_for(
    editor: &Editor,
    places: &Keys,
    current: Interpolation,
) -> Vec<Interpolation> {
    let tracks = &editor.scene().animation.tracks;
    let is_position = |place: &KeyId| {
        let track = place.track.and_then(|track| tracks.get(track));
        track.is_none_or(|track| track.target.is_position())
    };
    let around = match current {
        Interpolation::Orbit { around } => around,
        _ => editor.middle(),
    };
    let mut interpolations = BASIC_INTERPOLATIONS.to_vec();
    if places.iter().all(is_position) {
        interpolations.push(Interpolation::Orbit { around });
    }
    interpolations
}

fn buttons(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let places = editor.selection().keys();
    let only = places.first().filter(|_| places.len() == 1);
    let is_of_camera = only.is_some_and(|only| only.track.is_none());
    let overwrite = ui.add_enabled(is_of_camera, Button::new("Overwrite with view"));
    let obstacle = (!is_of_camera).then_some("select one key of the camera");
    let hint = "Set this key to the current view";
    if overwrite.hint_unless(obstacle, hint).clicked() {
        let view = editor.shown().camera.clone();
        let changed = animation.with_each(places, |key| key.value = view.clone());
        out.edit(Edit::animation(changed, "Overwrite key"));
    }
    let go = ui.add_enabled(only.is_some(), Button::new("Go there"));
    let timed_key = only.and_then(|only| animation.time_and_pace_of(*only));
    let obstacle = only.is_none().then_some("several keys are selected");
    let hint = "Move the playhead to this key";
    if go.hint_unless(obstacle, hint).clicked()
        && let Some((time, _)) = timed_key
    {
        out.time(Time::Seek(time));
    }
    if ui.button("Delete").clicked() {
        out.commands.push(Command::Delete);
    }
}

/// A value that can be keyed: its name, and the targets that have it.
pub type KeyableValue = (&'static str, Vec<Target>);

/// The values of these items that can be keyed.
pub fn keyable_values(scene: &Scene, items: &[Item]) -> Vec<KeyableValue> {
    let [mut positions, mut rotations, mut intensities] = [const { Vec::new() }; 3];
    for item in items {
        let name = || item.name(scene).unwrap_or_default().to_owned();
        match item.kind {
            ItemKind::Light => {
                positions.push(Target::LightPosition(name()));
                intensities.push(Target::LightIntensity(name()));
            }
            ItemKind::Object => {
                positions.push(Target::ObjectPosition(name()));
                let object = scene.objects.get(item.index);
                if object.is_some_and(|object| matches!(object.shape, Shape::Mesh(_))) {
                    rotations.push(Target::ObjectRotation(name()));
                }
            }
            ItemKind::Pack => {}
        }
    }
    let mut values = vec![
        ("position", positions),
        ("rotation", rotations),
        ("intensity", intensities),
    ];
    values.retain(|(_, targets)| !targets.is_empty());
    values
}

/// Shows a button for each value that can be keyed. It sets keys at the playhead for all items with that value, or
/// removes them if all have one there.
pub fn key_buttons(ui: &mut Ui, editor: &Editor, values: &[KeyableValue], out: &mut UiRequests) {
    if values.is_empty() {
        return;
    }
    let animation: &Animation = &editor.scene().animation;
    let time = editor.shown_time();
    let places = animation.track_indices(values.iter().flat_map(|(_, targets)| targets));
    let key_of = |target: &Target| animation.value_at(*places.get(target)?, time);
    ui.horizontal(|ui| {
        ui.weak("Keys");
        for (name, targets) in values {
            let tracks = targets.iter().filter_map(|target| places.get(target));
            let count = tracks
                .map(|place| animation.tracks[*place].keys.len())
                .max();
            let existing: Keys = targets.iter().filter_map(key_of).collect();
            let has_key = existing.len() == targets.len();
            let count = count.map_or(String::new(), |count| format!(" ({count})"));
            let text = (icons::text(icons::KEY), format!("{name}{count}"));
            let button = Button::selectable(has_key, text);
            let hint = if has_key {
                "Remove the key at the playhead"
            } else {
                "Set a key at the playhead; from then on, changes set keys"
            };
            let button = ui.add(button).hint(hint);
            if button.accessible_name(format!("key {name}")).clicked() {
                let changed = if has_key {
                    animation.without_keys(&existing)
                } else {
                    // Existing keys at the playhead stay as they are.
                    let targets = targets.iter().filter(|target| key_of(target).is_none());
                    let owners = Owners::of(editor.shown(), targets.clone());
                    let value = |target| Some((target, owners.get(editor.shown(), target)?));
                    animation.with_values(targets.filter_map(value), time)
                };
                out.edit(Edit::animation(changed, "Key value"));
            }
        }
    });
}
