//! The controls above the keys.

use egui::containers::menu::{MenuButton, MenuConfig};
use std::sync::Arc;

use egui::{Button, Id, PopupCloseBehavior, RichText, Slider, Ui};

use super::length::show_length;
use crate::editor::{Action, Edit, Editor, Repeat, Time, replaced_flight};
use crate::scene::{Animation, FRAME_RATES, KeyId, Keys, MAX_SECONDS};
use crate::ui::commands::{Command, with_key};
use crate::ui::hint::Hinted as _;
use crate::ui::icons;
use crate::ui::inspector::replaced_keys_message;
use crate::ui::menu_entry::on_click;
use crate::ui::number::{Field, drag_unlabelled};
use crate::ui::obstacles::obstacle;
use crate::ui::requests::UiRequests;
use crate::ui::theme::palette;
use crate::words::counted;

/// Minimum window width in points to show all controls.
const MIN_WIDTH_FOR_ALL: f32 = 1100.0;
/// Minimum window width in points to show all controls but the rates.
const MIN_WIDTH_WITHOUT_RATES: f32 = 910.0;
/// Minimum window width in points to show buttons with text.
const MIN_WIDTH_FOR_TEXT: f32 = 770.0;
/// Duration of a preset flight, in seconds.
const PRESET_SECONDS: f64 = 8.0;
/// Number of samples beyond which a recording counts as long: one of a minute or two.
const LONG_RECORDING: usize = 5000;

/// Shows the controls for playback and keys, and the current time.
pub fn show(ui: &mut Ui, editor: &Editor, shown_fps: f64, graph: &mut bool, out: &mut UiRequests) {
    let timeline = editor.timeline();
    let animation = &editor.scene().animation;
    let mut command_button = |ui: &mut Ui, icon, name: &str, command: Command| {
        if icons::button(ui, icon, &with_key(ui, name, &command)).clicked() {
            out.commands.push(command);
        }
    };
    command_button(ui, icons::FIRST, "First frame", Command::FirstFrame);
    command_button(ui, icons::PREVIOUS, "Previous key", Command::PreviousKey);
    command_button(ui, icons::BACK, "One frame back", Command::FrameBack);
    let (icon, name) = if timeline.is_playing {
        (icons::PAUSE, "Pause")
    } else {
        (icons::PLAY, "Play")
    };
    command_button(ui, icon, name, Command::Play);
    command_button(ui, icons::FORWARD, "One frame forward", Command::FrameOn);
    command_button(ui, icons::NEXT, "Next key", Command::NextKey);
    command_button(ui, icons::LAST, "Last frame", Command::LastFrame);
    let (icon, name, next) = match timeline.repeat {
        Repeat::Once => (icons::ONCE, "Plays once; click to loop", Repeat::Loop),
        Repeat::Loop => (
            icons::LOOP,
            "Plays in a loop; click to play back and forth",
            Repeat::PingPong,
        ),
        Repeat::PingPong => (
            icons::PING_PONG,
            "Plays back and forth; click to play once",
            Repeat::Once,
        ),
    };
    if icons::button(ui, icon, name).clicked() {
        out.time(Time::Repeat(next));
    }
    ui.separator();
    let times = format!(
        "{} / {}",
        clock(editor.shown_time()),
        clock(animation.duration())
    );
    ui.label(RichText::new(times).monospace());
    let width = ui.content_rect().width();
    if width >= MIN_WIDTH_WITHOUT_RATES {
        frame_field(ui, editor, out);
    }
    ui.separator();
    record_button(ui, editor, width >= MIN_WIDTH_FOR_TEXT, out);
    let words =
        "Set a camera key at the playhead from the current view, replacing one that is there";
    let add_key = if width >= MIN_WIDTH_FOR_TEXT {
        Button::new("Add camera key")
    } else {
        Button::new(icons::text(icons::KEY))
    };
    let add_key = ui.add(add_key).accessible_name("Add camera key");
    on_click(ui, add_key, (words, Command::AddKey), out);
    if width >= MIN_WIDTH_WITHOUT_RATES {
        through_shot(ui, editor, out);
    }
    ui.separator();
    if width >= MIN_WIDTH_FOR_ALL {
        rates(ui, editor, (graph, false), out);
    } else {
        let menu_config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let more =
            MenuButton::from_button(Button::new(icons::text(icons::OTHER))).config(menu_config);
        let (button, _) = more.ui(ui, |ui| {
            if width < MIN_WIDTH_WITHOUT_RATES {
                ui.horizontal(|ui| {
                    ui.weak("frame");
                    frame_field(ui, editor, out);
                });
                through_shot(ui, editor, out);
            }
            rates(ui, editor, (graph, true), out);
        });
        button
            .accessible_name("More timeline settings")
            .hint("Length, frames per second, playback speed, speed graph; in a narrow window the frame and the shot as well");
    }
    // If the view is not the shot, and nothing but the camera has keys, the picture does not change during
    // playback.
    if timeline.is_playing && (editor.looks_through() || shown_fps > 0.0) {
        let text = format!(
            "{shown_fps:.1} of {:.0} fps",
            animation.frames_per_second * timeline.speed
        );
        ui.label(RichText::new(text).monospace().weak())
            .hint("Pictures per second on screen; a slow scene loses resolution, never time");
    }
}

/// Shows the current frame as an editable field, and the number of frames.
fn frame_field(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let before = animation.frame_at(editor.timeline().playhead) as f64;
    let mut frame = before;
    let last = animation.frame_at(MAX_SECONDS) as f64;
    let field = Field {
        name: "frame",
        hint: "Frame, counted from 1, as in glint render --frame. There is room for more keys after the last frame",
        unit: "",
        default: 1.0,
        range: 1.0..=last,
        speed: Some(0.2),
    };
    drag_unlabelled(ui, &field, &mut frame);
    if frame != before {
        out.time(Time::Seek(animation.time_of(frame.round() as u64)));
    }
    let count = format!("/{}", animation.frame_count());
    ui.label(RichText::new(count).monospace().weak());
}

fn through_shot(ui: &mut Ui, editor: &Editor, out: &mut UiRequests) {
    let obstacle = obstacle(&Command::LookThrough, editor);
    let through = Button::selectable(editor.looks_through(), "Through shot");
    let through = ui.add_enabled(obstacle.is_none(), through);
    let words = with_key(ui, "Enter or leave the shot camera", &Command::LookThrough);
    if through.hint_unless(obstacle, words).clicked() {
        out.commands.push(Command::LookThrough);
    }
}

fn record_button(ui: &mut Ui, editor: &Editor, has_words: bool, out: &mut UiRequests) {
    let accent = palette(ui.ctx()).accent;
    if let Some((samples, seconds)) = editor.timeline().recorded() {
        let stop = Button::new((icons::text(icons::STOP).color(accent), "Stop"));
        let stop = ui.add(stop).accessible_name("Stop recording");
        let words = "Stop recording and make keys";
        on_click(ui, stop, (words, Command::StopRecording), out);
        let text = format!("{samples} samples, {seconds:.1} s");
        ui.label(RichText::new(text).monospace().color(accent));
        return;
    }
    let record = if has_words {
        Button::new((icons::text(icons::RECORD), "Record"))
    } else {
        Button::new(icons::text(icons::RECORD))
    };
    let record = ui.add(record).accessible_name("Record");
    let words = "Record the flight of the camera";
    on_click(ui, record, (words, Command::Record), out);
}

/// Shows length, frame rate and playing speed; with their names, if they are below each other in the menu.
fn rates(
    ui: &mut Ui,
    editor: &Editor,
    (graph, are_named): (&mut bool, bool),
    out: &mut UiRequests,
) {
    let number = |ui: &mut Ui, field: &Field, value: &mut f64| {
        if !are_named {
            return drag_unlabelled(ui, field, value);
        }
        ui.horizontal(|ui| {
            ui.weak(field.name);
            drag_unlabelled(ui, field, value);
        });
    };
    ui.toggle_value(graph, "Speed")
        .hint("Show speed and turn rate below the keys");
    let animation = &editor.scene().animation;
    show_length(ui, editor, number, out);
    let mut fps = animation.frames_per_second;
    let field = Field {
        name: "frames per second",
        hint: "Frames per second; the flight does not change",
        unit: " fps",
        default: animation.frames_per_second,
        range: FRAME_RATES,
        speed: Some(0.1),
    };
    number(ui, &field, &mut fps);
    if fps != animation.frames_per_second {
        let changed = Animation {
            frames_per_second: fps,
            ..Animation::clone(animation)
        };
        out.edit(Edit::animation(changed, "Frames per second"));
    }
    let before = editor.timeline().speed;
    let mut speed = before;
    let field = Field {
        name: "playback speed",
        hint: "Playback speed; 1 is real time",
        unit: "×",
        default: 1.0,
        range: 0.05..=20.0,
        speed: Some(0.01),
    };
    number(ui, &field, &mut speed);
    if speed != before {
        out.time(Time::Speed(speed));
    }
}

/// Shows the controls of a recorded flight: the tolerance of its keys, and how closely they follow it.
pub fn show_take(ui: &mut Ui, editor: &Editor, paused: f64, out: &mut UiRequests) {
    let animation = &editor.scene().animation;
    let Some(take) = &animation.take else { return };
    let before = editor.timeline().tolerance;
    // Making keys of a long recording takes seconds, so it is done when the slider is released.
    let is_long = take.samples.len() > LONG_RECORDING;
    let slider_id = Id::unique(("tolerance of a long recording", Arc::as_ptr(take).addr()));
    let mut tolerance = ui.data(|data| data.get_temp(slider_id)).unwrap_or(before);
    ui.weak("tolerance");
    let slider = Slider::new(&mut tolerance, 0.05..=1000.0)
        .clamping(egui::SliderClamping::Edits)
        .logarithmic(true)
        .suffix(" px")
        .max_decimals(2);
    let slider = ui.add(slider).accessible_name("tolerance");
    let hint = "How far the keys may deviate from the recording. A change makes the keys again and discards other edits of them (undo brings them back)";
    let slider = slider.hint(hint);
    let is_dragging = is_long && slider.dragged();
    let is_released = ui.data_mut(|data| {
        let was_dragging = data.remove_temp::<f64>(slider_id).is_some();
        if is_dragging {
            data.insert_temp(slider_id, tolerance);
        }
        was_dragging && !is_dragging
    });
    // The widget rounds its value, which is no change by the user.
    let is_changed = (tolerance - before).abs() > 0.006;
    if is_changed && !is_dragging && (slider.changed() || is_released) {
        out.time(Time::Simplify(tolerance));
    }
    // To the right of the slider, which must not move during a drag.
    let text = format!(
        "{} samples → {}",
        take.samples.len(),
        counted(animation.keys.len(), "key")
    );
    ui.label(RichText::new(text).monospace());
    let worst = editor.timeline().worst;
    if let Some(worst) = worst.filter(|worst| worst.deviation.is_finite()) {
        let text = format!(
            "· deviation {:.1} px at {:.1} s",
            worst.deviation, worst.time
        );
        ui.label(RichText::new(text).monospace())
            .hint("Largest deviation of the keys from the recording, in pixels of a 1024² picture, and when it occurs");
    }
    if editor.timeline().is_edited {
        ui.weak("edited by hand")
            .hint("The keys were changed after they were made from the recording");
    }
    ui.separator();
    if paused > 0.0 {
        ui.weak(format!("{paused:.1} s of pauses"));
    }
    let discard = ui.button("Discard the recording");
    if discard
        .hint("Keeps the keys and makes the file smaller")
        .clicked()
    {
        let changed = Animation {
            take: None,
            ..Animation::clone(animation)
        };
        out.edit(Edit::animation(changed, "Discard the recording"));
    }
}

/// Formats a time as minutes, seconds and tenths.
pub fn clock(seconds: f64) -> String {
    let tenths = (seconds * 10.0).round() as u64;
    format!(
        "{:02}:{:02}.{}",
        tenths / 600,
        tenths / 10 % 60,
        tenths % 10
    )
}

/// Copies the selected keys so that the earliest is at the playhead; no actions if no keys are selected.
fn copied_keys(editor: &Editor) -> Vec<Action> {
    let (animation, places) = (&editor.scene().animation, editor.selection().keys());
    let Some((first, _)) = animation.span_of(places) else {
        return Vec::new();
    };
    let shown = editor.shown_time();
    // Recorded keys may lie between frames, so frames are compared.
    if animation.nearest_frame(first) == animation.nearest_frame(shown) {
        let message = "Keys are copied to the playhead: move it to where they should go";
        return vec![Action::Tell(message.to_owned())];
    }
    let (changed, new) = animation.with_moved(places, shown - first, true);
    let added = places.len() + animation.key_count();
    let message = replaced_keys_message(added, &changed).map(Action::Tell);
    let made = [
        Action::Edit(Edit::animation(changed, "Copy keys")),
        Action::Select(new.into()),
    ];
    made.into_iter().chain(message).collect()
}

/// The actions of a timeline command; none for other commands, or if they do not apply.
pub fn actions(command: &Command, editor: &Editor) -> Vec<Action> {
    let animation = &editor.scene().animation;
    let time = editor.shown_time();
    // Keys are compared by nearest frame, as the playhead stops on frames and keys may lie between them.
    let frame = |time: f64| animation.nearest_frame(time);
    let times = || {
        let tracks = animation.tracks.iter().flat_map(|track| &track.keys);
        let of_camera = animation.keys.iter().map(|key| key.time);
        of_camera.chain(tracks.map(|key| key.time))
    };
    let time_action = |time: Time| vec![Action::Time(time)];
    match command {
        Command::Play => time_action(Time::Play(!editor.timeline().is_playing)),
        Command::FirstFrame => time_action(Time::Seek(0.0)),
        // The frame nearest to the last key may be beyond the last frame.
        Command::LastFrame => {
            let last = animation.time_of(animation.frame_count());
            time_action(Time::Seek(last))
        }
        Command::FrameBack => time_action(Time::Step(-1)),
        Command::FrameOn => time_action(Time::Step(1)),
        Command::PreviousKey => {
            let earlier = times().filter(|key| frame(*key) < frame(time));
            let key = earlier.max_by(f64::total_cmp);
            key.map_or(Vec::new(), |key| time_action(Time::Seek(key)))
        }
        Command::NextKey => {
            let later = times().filter(|key| frame(*key) > frame(time));
            let key = later.min_by(f64::total_cmp);
            key.map_or(Vec::new(), |key| time_action(Time::Seek(key)))
        }
        Command::Record => time_action(Time::Record),
        Command::StopRecording => time_action(Time::Stop),
        Command::SelectKeys => vec![Action::Select(animation.all_keys().into())],
        Command::LookThrough => time_action(Time::LookThrough(!editor.looks_through())),
        Command::Duplicate => copied_keys(editor),
        Command::AddKey => {
            let view = editor.shown().camera.clone();
            let (changed, place) = animation.with_key(time, view);
            vec![
                Action::Edit(Edit::animation(changed, "Add camera key")),
                Action::Select(Keys::from([KeyId::of_camera(place)]).into()),
            ]
        }
        Command::Preset(preset) => {
            let keys = preset.keys(&editor.shown().camera, editor.middle(), PRESET_SECONDS);
            if keys.windows(2).all(|pair| pair[0].value == pair[1].value) {
                let message = "This flight would not move from here: look from the side first";
                return vec![Action::Tell(message.to_owned())];
            }
            let changed = Animation {
                keys,
                take: None,
                ..Animation::clone(animation)
            };
            let name = preset.words().0;
            let message = replaced_flight(name, animation).map(Action::Tell);
            let edit = Action::Edit(Edit::animation(changed, name));
            let made = [edit, Action::Time(Time::Seek(0.0))].into_iter();
            made.chain(message).collect()
        }
        Command::Retime(retime) => {
            let changed = Animation {
                keys: retime.apply(&animation.keys),
                ..Animation::clone(animation)
            };
            if changed == **animation {
                let message = "This would not change the flight";
                return vec![Action::Tell(message.to_owned())];
            }
            // If the flight now ends before the playhead, the playhead moves to the end.
            let end = changed.duration();
            let edit = Action::Edit(Edit::animation(changed, retime.words().0));
            let is_behind = editor.timeline().playhead > end;
            let back = is_behind.then_some(Action::Time(Time::Seek(end)));
            [edit].into_iter().chain(back).collect()
        }
        _ => Vec::new(),
    }
}
