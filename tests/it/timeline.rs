//! The timeline, driven in the window: recording, keys, playback, and the flight drawn in the viewport; and frames
//! rendered on the command line.

use std::process::Command;
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use glint::animate::{CameraPath, Preset, shot};
use glint::editor::{Action, Edit, Editor, Repeat, Selection, Time};
use glint::plan::RenderRequest;
use glint::scene::{
    Animation, Document, Interpolation, Key as SceneKey, KeyId, Keys, Leftover, MAX_SECONDS, Owner,
    Projection, Scene, Target, Value,
};
use glint::ui::Ask;
use glint::worker::{ThumbnailJob, Worker};

use crate::harness::{CTRL, EditorHarness, survey_flight};
use crate::pictures::picture;
use crate::program::FLIGHT;
use crate::random::flight;

/// An editor with unsaved work left by an ended program.
fn recovered(document: Document) -> Editor {
    let mut editor = Editor::demo();
    editor.recover(Leftover {
        document,
        path: None,
        stamp: None,
    });
    editor
}

/// A window on the demo with camera keys at ten frames per second, each given as a time and an offset to the right.
pub fn animation(keys: &[(f64, f64)]) -> EditorHarness {
    let mut scene = Scene::demo();
    let key = |&(time, right): &(f64, f64)| {
        let mut camera = scene.camera.clone();
        camera.position.x += right;
        SceneKey::new(time, camera)
    };
    scene.animation_mut().keys = keys.iter().map(key).collect();
    scene.animation_mut().frames_per_second = 10.0;
    EditorHarness::on(scene)
}

/// Times of the camera keys in seconds, rounded to milliseconds.
pub fn times(harness: &EditorHarness) -> Vec<f64> {
    let keys = harness.scene().animation.keys.iter();
    keys.map(|key| (key.time * 1e3).round() / 1e3).collect()
}

fn place_of(harness: &EditorHarness, name: &str) -> Pos2 {
    let role = if name == "Playhead" {
        Role::Slider
    } else {
        Role::Button
    };
    let widget = harness.window.get_by_role_and_label(role, name);
    widget.rect().center()
}

fn hover_over_line(harness: &mut EditorHarness) {
    let line = place_of(harness, "Playhead");
    harness.window.hover_at(line);
    harness.settle();
}

/// Drags from a position by an offset, in several moves, with modifier keys held.
fn drag(harness: &mut EditorHarness, from: Pos2, by: egui::Vec2, modifiers: Modifiers) {
    let moved = |part: u16| from + by * f32::from(part) / 6.0;
    harness.window.event(Event::ModifiersChanged(modifiers));
    harness.window.drag_at(from);
    harness.window.step();
    for part in 1..=6 {
        harness.window.hover_at(moved(part));
        harness.window.step();
    }
    harness.window.drop_at(from + by);
    harness.window.step();
    harness
        .window
        .event(Event::ModifiersChanged(Modifiers::NONE));
    harness.settle();
}

/// Selects the second and the third camera key.
fn select_two_keys(harness: &mut EditorHarness) {
    harness.click("Key 2");
    harness.click_with(Modifiers::SHIFT, "Key 3");
}

/// Width of a second on the timeline, in points.
fn points_per_second(harness: &EditorHarness) -> f32 {
    let (first, last) = (
        place_of(harness, "Key 1"),
        place_of(harness, &format!("Key {}", times(harness).len())),
    );
    let seconds = times(harness)[times(harness).len() - 1] - times(harness)[0];
    (last.x - first.x) / seconds as f32
}

#[test]
fn a_flight_is_recorded_and_becomes_keys_in_one_step() {
    let mut harness = EditorHarness::new();
    let start = harness.scene().camera.clone();
    harness.window.key_press(Key::R);
    harness.window.step();
    harness.window.key_down(Key::W);
    (0..60).for_each(|_| harness.window.step());
    harness.window.key_down(Key::ArrowRight);
    (0..60).for_each(|_| harness.window.step());
    harness.window.key_up(Key::W);
    harness.window.key_up(Key::ArrowRight);
    (0..5).for_each(|_| harness.window.step());
    let end = harness.scene().camera.clone();
    harness.press(Modifiers::NONE, Key::T);
    let animation = harness.scene().animation.clone();
    let take = animation.take.clone().expect("a take");
    assert!(
        (120..140).contains(&take.samples.len()),
        "{}",
        take.samples.len()
    );
    let seconds = take.samples.last().expect("samples").0;
    assert!((2.0..2.4).contains(&seconds), "true times: {seconds} s");
    let count = animation.keys.len();
    assert!((2..=20).contains(&count), "{count} keys");
    let path = CameraPath::new(&animation.keys);
    let first = path.at(0.0).expect("a camera").position;
    let last = path.at(seconds).expect("a camera").position;
    assert!((first - start.position).length() < 2.0, "{first:?}");
    assert!((last - end.position).length() < 2.0, "{last:?}");
    assert!(harness.editor().looks_through(), "the flight is shown");
    harness.assert_says("samples → ");
    assert_eq!(harness.editor().undo_label(), Some("Record flight"));
    // The slider makes new keys from the same take.
    let text = harness.editor().to_text().expect("a text");
    let mut editor = recovered(Document::from_text(&text).expect("a scene"));
    editor.apply(Action::Time(Time::Simplify(0.1)));
    survey_flight(&mut editor);
    let fine = editor.scene().animation.keys.len();
    editor.apply(Action::Time(Time::Simplify(100.0)));
    let coarse = editor.scene().animation.keys.len();
    assert!(coarse <= count && count <= fine, "{coarse} {count} {fine}");
    assert!(editor.timeline().worst.expect("measured").deviation <= 100.0);
    assert_eq!(editor.scene().animation.take.as_deref(), Some(&*take));
    // A single undo leads back to before the recording.
    harness.press(Modifiers::COMMAND, Key::Z);
    assert!(harness.scene().animation.is_still());
}

#[test]
fn keys_of_another_recording_are_not_called_edited() {
    let mut editor = recovered(Document::load(FLIGHT.as_ref()).expect("valid"));
    survey_flight(&mut editor);
    assert!(!editor.timeline().is_edited);
    // What another program writes: the same flight further to the right.
    let mut scene = Scene::clone(editor.scene());
    let animation = scene.animation_mut();
    for key in &mut animation.keys {
        key.value.position.x += 5.0;
    }
    let take = animation.take.as_mut().map(Arc::make_mut);
    for sample in &mut take.expect("a recording").samples {
        sample.1.x += 5.0;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("other.ron");
    let text = Document::of(scene).to_text().expect("a text");
    std::fs::write(&path, text).expect("written");
    editor.take_theirs(Document::load_stamped(&path).expect("valid"));
    survey_flight(&mut editor);
    assert!(editor.timeline().worst.is_some() && !editor.timeline().is_edited);
}

#[test]
fn a_long_drag_of_the_tolerance_that_is_undone_leaves_keys_that_are_not_edited() {
    let mut editor = recovered(Document::load(FLIGHT.as_ref()).expect("valid"));
    survey_flight(&mut editor);
    let before = editor.timeline().tolerance;
    for step in 0..40 {
        let tolerance = 0.5 + 0.2 * f64::from(step);
        editor.apply(Action::Time(Time::Simplify(tolerance)));
        survey_flight(&mut editor);
    }
    editor.end_gesture();
    editor.apply(Action::Undo);
    survey_flight(&mut editor);
    assert!(!editor.timeline().is_edited);
    assert_eq!(editor.timeline().tolerance, before);
}

/// Records two seconds of flight to the right, along a bend.
fn record(editor: &mut Editor) {
    editor.apply(Action::Time(Time::Record));
    for tenth in 0..20 {
        let mut camera = editor.scene().camera.clone();
        camera.position.x += 1.0;
        camera.position.y += f64::from(tenth % 7) * 0.05;
        editor.apply(Action::Edit(Edit::Camera(camera, "move")));
        editor.apply(Action::Time(Time::Sample(f64::from(tenth) / 10.0)));
    }
    editor.apply(Action::Time(Time::Stop));
}

#[test]
fn the_tolerance_of_a_recording_comes_back_when_the_next_one_is_undone() {
    let mut editor = Editor::demo();
    record(&mut editor);
    survey_flight(&mut editor);
    let before = editor.timeline().tolerance;
    record(&mut editor);
    survey_flight(&mut editor);
    editor.apply(Action::Undo);
    survey_flight(&mut editor);
    assert!(!editor.timeline().is_edited);
    assert_eq!(editor.timeline().tolerance, before);
}

#[test]
fn no_recorded_flight_is_lost_while_it_becomes_keys() {
    let mut editor = Editor::demo();
    record(&mut editor);
    assert!(editor.is_making_keys() && editor.is_dirty());
    let take = editor.wanted_survey().cloned().expect("a take");
    // Before the worker has surveyed the first take.
    record(&mut editor);
    survey_flight(&mut editor);
    assert!(!editor.is_making_keys());
    assert_eq!(editor.scene().animation.take, Some(take));
}

#[test]
fn a_recording_without_a_movement_leaves_the_flight_as_it_is() {
    let mut editor = recovered(Document::of(flight()));
    let before = editor.scene().animation.clone();
    editor.apply(Action::Time(Time::Record));
    for tenth in 0..20 {
        editor.apply(Action::Time(Time::Sample(f64::from(tenth) / 10.0)));
        // Moving things may be watched during a recording; it is the camera that is flown.
        editor.apply(Action::Time(Time::Seek(f64::from(tenth))));
        assert!(!editor.looks_through());
    }
    editor.apply(Action::Time(Time::Stop));
    assert!(!editor.is_making_keys());
    assert_eq!(editor.scene().animation, before);
}

#[test]
fn keys_are_set_overwritten_and_deleted() {
    let mut harness = EditorHarness::new();
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(times(&harness), [0.0]);
    // With one key the flight has no duration: a second key is added to the text.
    let mut scene = harness.scene().clone();
    let later = SceneKey::new(2.0, scene.camera.clone());
    scene.animation_mut().keys.push(later);
    let mut harness = EditorHarness::on(scene);
    harness.press(Modifiers::NONE, Key::CloseBracket);
    assert_eq!(harness.editor().shown_time(), 2.0);
    // Flies away from the key, and overwrites it with the view.
    harness.hold(Key::D, 30);
    assert!(!harness.editor().looks_through(), "flying leaves the shot");
    let view = harness.scene().camera.clone();
    assert_ne!(
        view.position,
        harness.scene().animation.keys[1].value.position
    );
    harness.press(Modifiers::NONE, Key::K);
    assert_eq!(times(&harness), [0.0, 2.0], "the key there is overwritten");
    assert_eq!(harness.scene().animation.keys[1].value, view);
    assert_eq!(harness.editor().undo_label(), Some("Add camera key"));
    // The key is selected: its values are in the inspector.
    harness.type_into("time", "3.5");
    assert_eq!(times(&harness), [0.0, 3.5]);
    harness.type_into("position x", "12");
    assert_eq!(harness.scene().animation.keys[1].value.position.x, 12.0);
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(times(&harness), [0.0]);
    for expected in [
        vec![0.0, 3.5],
        vec![0.0, 3.5],
        vec![0.0, 2.0],
        vec![0.0, 2.0],
    ] {
        harness.press(Modifiers::COMMAND, Key::Z);
        assert_eq!(times(&harness), expected);
    }
}

#[test]
fn keys_made_anew_keep_the_time_that_the_flight_was_given() {
    let mut editor = recovered(Document::of(flight()));
    survey_flight(&mut editor);
    let said = editor.timeline().worst.expect("a recording");
    assert!(
        (0.5..2.0).contains(&said.deviation),
        "known as soon as it is opened: {said:?}"
    );
    let before = editor.scene().clone();
    let fourth: Keys = [KeyId::of_camera(3)].into();
    editor.apply(Action::Select(fourth.clone().into()));
    editor.apply(Action::Select(Selection::Camera));
    assert!(editor.selection().keys().is_empty(), "something else is");
    editor.apply(Action::Select(fourth.clone().into()));
    editor.apply(Action::Time(Time::Simplify(5.0)));
    assert!(editor.scene().animation.keys.len() < before.animation.keys.len());
    assert_eq!(editor.scene().animation.frame_count(), 202);
    assert!(editor.timeline().worst.expect("measured").deviation <= 5.0 * (1.0 + 1e-6));
    assert_eq!(editor.timeline().tolerance, 5.0);
    editor.apply(Action::Undo);
    assert_eq!(editor.scene().animation, before.animation);
    assert_eq!(
        editor.timeline().worst,
        Some(said),
        "what is said is true again"
    );
    assert_eq!(
        *editor.selection().keys(),
        fourth,
        "the same key is selected again"
    );
}

#[test]
fn an_end_that_is_taken_away_or_added_does_not_stretch_the_recording() {
    let mut editor = recovered(Document::of(flight()));
    survey_flight(&mut editor);
    let said = editor.timeline().worst.expect("a recording").deviation;
    let before = editor.scene().animation.clone();
    let last = before.keys.len() - 1;
    let shorter = before.without_keys(&[KeyId::of_camera(last)].into());
    let view = editor.scene().camera.clone();
    let (longer, _) = before.with_key(before.duration() + 5.0, view);
    let mut stretched = before.without_keys(&[KeyId::of_camera(0)].into());
    for key in &mut stretched.keys {
        key.time *= 1.7;
    }
    let mut trimmed = before.without_keys(&[KeyId::of_camera(0)].into());
    let start = trimmed.keys[0].time;
    for key in &mut trimmed.keys {
        key.time -= start;
    }
    for (edited, seconds) in [
        (shorter, before.duration()),
        (longer, before.duration()),
        (stretched, before.duration() * 1.7),
        (trimmed, before.duration()),
    ] {
        editor.apply(Action::Edit(Edit::animation(edited, "Edit")));
        let off = editor.timeline().worst.expect("measured").deviation;
        // With its last key removed, or another one added, the last curve changes.
        assert!(off < 5.0 * said, "{off} px where {said} were said");
        editor.apply(Action::Time(Time::Simplify(5.0)));
        let duration = editor.scene().animation.duration();
        assert!(
            (duration - seconds).abs() < 1e-6,
            "{duration} s, not {seconds}"
        );
        editor.apply(Action::Undo);
        editor.apply(Action::Undo);
        assert_eq!(editor.scene().animation, before);
    }
}

#[test]
fn keys_are_dragged_copied_and_picked_with_the_mouse() {
    let mut harness = animation(&[(0.0, 0.0), (1.0, 30.0), (2.0, 10.0), (4.0, 60.0)]);
    let second = points_per_second(&harness);
    let at = place_of(&harness, "Key 2");
    drag(&mut harness, at, vec2(0.5 * second, 0.0), Modifiers::NONE);
    assert_eq!(times(&harness), [0.0, 1.5, 2.0, 4.0]);
    assert_eq!(harness.editor().undo_label(), Some("Move keys"));
    let at = place_of(&harness, "Key 2");
    drag(&mut harness, at, vec2(1.5 * second, 0.0), CTRL);
    assert_eq!(times(&harness), [0.0, 1.5, 2.0, 3.0, 4.0], "a copy");
    assert_eq!(harness.editor().undo_label(), Some("Copy keys"));
    let keys = &harness.scene().animation.keys;
    assert_eq!(keys[1].value, keys[3].value);
    // Two keys are moved together; the later one replaces the key at its new time.
    select_two_keys(&mut harness);
    assert_eq!(harness.editor().selection().keys().len(), 2);
    let at = place_of(&harness, "Key 2");
    drag(&mut harness, at, vec2(1.0 * second, 0.0), Modifiers::NONE);
    assert_eq!(times(&harness), [0.0, 2.5, 3.0, 4.0]);
    let words = "This has replaced 1 key; undo brings it back";
    harness.assert_says(words);
    // Keys cannot be moved before the start.
    let at = place_of(&harness, "Key 2");
    drag(&mut harness, at, vec2(-9.0 * second, 0.0), Modifiers::NONE);
    assert_eq!(times(&harness)[0], 0.0);
    for _ in 0..4 {
        harness.press(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(
        times(&harness),
        [0.0, 1.0, 2.0, 4.0],
        "one step for each drag"
    );
    // The time of the earliest selected key is typed; the others follow.
    select_two_keys(&mut harness);
    harness.window.get_by_label("2 keys");
    harness.type_into("first at", "1.25");
    assert_eq!(times(&harness), [0.0, 1.25, 2.25, 4.0]);
    assert_eq!(harness.editor().undo_label(), Some("Key: time"));
    harness.type_into("duration", "1.5");
    assert_eq!(times(&harness), [0.0, 1.25, 2.75, 4.0]);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(times(&harness), [0.0, 1.25, 2.25, 4.0]);
    harness.type_into("first at", "3");
    assert_eq!(times(&harness), [0.0, 3.0, 4.0]);
    harness.assert_says(words);
}

#[test]
fn the_playhead_is_dragged_and_stepped_and_the_picture_follows() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 60.0)]);
    let at_rest = harness.picture();
    let second = points_per_second(&harness);
    let start = Pos2::new(
        place_of(&harness, "Key 1").x,
        place_of(&harness, "Playhead").y,
    );
    drag(
        &mut harness,
        start,
        vec2(1.23 * second, 0.0),
        Modifiers::NONE,
    );
    assert_eq!(harness.editor().shown_time(), 1.2, "it snaps to frames");
    assert!(harness.picture() != at_rest);
    let scene = Arc::new(harness.scene().clone());
    let there = shot(&scene, &CameraPath::new(&scene.animation.keys), 1.2);
    let size = harness.picture();
    let expected = RenderRequest::of(&there, size.width as u32, size.height as u32);
    let direct = picture(&there, &expected).0;
    assert!(harness.picture() == direct, "what is shown is the frame");
    assert_eq!(harness.editor().undo_label(), None, "looking is no edit");
    harness.press(Modifiers::NONE, Key::Period);
    assert!((harness.editor().shown_time() - 1.3).abs() < 1e-12);
    harness.press(Modifiers::NONE, Key::Comma);
    harness.press(Modifiers::NONE, Key::Comma);
    assert!((harness.editor().shown_time() - 1.1).abs() < 1e-12);
    harness.press(Modifiers::NONE, Key::End);
    assert_eq!(harness.editor().shown_time(), 2.0);
    harness.press(CTRL, Key::Home);
    assert_eq!(harness.editor().shown_time(), 0.0);
}

#[test]
fn playing_is_real_time_whatever_the_frames() {
    for (repeat, seconds, expected) in [
        (Repeat::Loop, 1.5, 1.5),
        (Repeat::Loop, 2.5, 0.5),
        // The last frame lasts as long as the others.
        (Repeat::PingPong, 2.5, 1.5 + 1.0 / 14.0),
        (Repeat::PingPong, 4.5, 0.5),
        (Repeat::Once, 3.0, 2.0),
    ] {
        let mut editor = Editor::demo();
        let mut scene = Scene::demo();
        scene.animation_mut().keys = vec![
            SceneKey::new(0.0, scene.camera.clone()),
            SceneKey::new(2.0, scene.camera.clone()),
        ];
        let animation = scene.animation;
        editor.apply(Action::Edit(Edit::Animation(animation, "keys")));
        editor.apply(Action::Time(Time::Repeat(repeat)));
        editor.apply(Action::Time(Time::Play(true)));
        for _ in 0..(seconds * 100.0) as u32 {
            editor.apply(Action::Time(Time::Tick(0.01)));
        }
        let playhead = editor.timeline().playhead;
        assert!(
            (playhead - expected).abs() < 1e-6,
            "{repeat:?} {seconds}: {playhead}"
        );
        assert_eq!(editor.timeline().is_playing, repeat != Repeat::Once);
    }
}

#[test]
fn the_last_frame_is_played_and_a_round_is_as_long_as_its_frames() {
    for (repeat, expected) in [
        (Repeat::Loop, [1, 2, 3, 1, 2, 3, 1]),
        (Repeat::PingPong, [1, 2, 3, 2, 1, 2, 3]),
        (Repeat::Once, [1, 2, 3, 3, 3, 3, 3]),
    ] {
        let mut editor = Editor::demo();
        let light = Target::LightIntensity("Light 1".to_owned());
        let mut animation = Animation {
            frames_per_second: 1.0,
            ..Animation::default()
        };
        for time in [0.0, 1.0, 2.0] {
            animation = animation.with_value(&light, time, Value::Number(time / 2.0));
        }
        editor.apply(Action::Edit(Edit::animation(animation, "keys")));
        editor.apply(Action::Time(Time::Repeat(repeat)));
        editor.apply(Action::Time(Time::Play(true)));
        editor.apply(Action::Time(Time::Tick(0.5)));
        let frames = expected.map(|_| {
            let shown = editor.shown_time();
            editor.apply(Action::Time(Time::Tick(1.0)));
            shown as u32 + 1
        });
        assert_eq!(frames, expected, "{repeat:?}");
        // At the last frame, playback starts from the beginning.
        if repeat == Repeat::Once {
            editor.apply(Action::Time(Time::Play(true)));
            assert_eq!(editor.shown_time(), 0.0);
        }
    }
}

#[test]
fn the_next_frame_comes_when_it_is_said_to_there_and_back() {
    let mut editor = Editor::demo();
    let light = Target::LightIntensity("Light 1".to_owned());
    let animation = Animation {
        frames_per_second: 5.0,
        ..Animation::default()
    };
    let animation = animation.with_value(&light, 0.0, Value::Number(0.0));
    let animation = animation.with_value(&light, 1.0, Value::Number(1.0));
    editor.apply(Action::Edit(Edit::animation(animation, "keys")));
    editor.apply(Action::Time(Time::Repeat(Repeat::PingPong)));
    editor.apply(Action::Time(Time::Play(true)));
    for _ in 0..30 {
        let before = editor.shown_time();
        let remaining = editor
            .timeline()
            .time_to_next_frame(&editor.scene().animation);
        editor.apply(Action::Time(Time::Tick(remaining * 0.9)));
        assert_eq!(editor.shown_time(), before);
        editor.apply(Action::Time(Time::Tick(remaining * 0.1 + 1e-4)));
        assert_ne!(editor.shown_time(), before);
    }
}

#[test]
fn what_is_over_at_once_is_not_played_for_ever() {
    let mut editor = Editor::demo();
    let mut scene = Scene::demo();
    let key = SceneKey::new(0.0, scene.camera.clone());
    scene.animation_mut().keys = vec![key];
    editor.apply(Action::Edit(Edit::Animation(scene.animation, "key")));
    editor.apply(Action::Time(Time::Play(true)));
    editor.apply(Action::Time(Time::Tick(0.01)));
    assert!(!editor.timeline().is_playing);
}

#[test]
fn a_key_that_is_set_or_moved_again_is_selected() {
    let mut harness = animation(&[(0.0, 0.0), (1.0, 30.0), (2.0, 10.0)]);
    harness.click("Key 1");
    harness.type_into("time", "1.5");
    let moved = harness.editor().selection().clone();
    assert_eq!(times(&harness), [1.0, 1.5, 2.0]);
    // Two clicks on one row would be a double click.
    for light in ["Light 1", "Light 2"] {
        harness.press(Modifiers::COMMAND, Key::Z);
        harness.click(light);
        harness.press(Modifiers::COMMAND, Key::Y);
        assert_eq!(*harness.editor().selection(), moved);
    }
}

#[test]
fn the_window_plays_and_pauses() {
    let mut harness = animation(&[(0.0, 0.0), (20.0, 60.0)]);
    harness.window.key_press(Key::G);
    (0..61).for_each(|_| harness.window.step());
    let playhead = harness.editor().timeline().playhead;
    assert!(
        (0.9..1.1).contains(&playhead),
        "a second of steps: {playhead}"
    );
    assert!(harness.editor().looks_through());
    harness.assert_says(" of 10 fps");
    harness.press(Modifiers::NONE, Key::G);
    assert!(!harness.editor().timeline().is_playing);
    assert_eq!(
        harness.editor().timeline().playhead,
        harness.editor().shown_time()
    );
    harness.press(Modifiers::NONE, Key::C);
    assert!(!harness.editor().looks_through());
    assert_eq!(harness.editor().shown().camera, harness.scene().camera);
    // Playback also works from outside the shot, and the user can fly meanwhile.
    harness.window.key_press(Key::G);
    harness.window.key_down(Key::S);
    (0..30).for_each(|_| harness.window.step());
    harness.window.key_up(Key::S);
    harness.window.step();
    let timeline = harness.editor().timeline();
    assert!(timeline.is_playing && !harness.editor().looks_through());
    assert!(timeline.playhead > playhead);
    harness.press(Modifiers::NONE, Key::C);
    assert!(harness.editor().looks_through());
}

#[test]
fn what_the_timeline_cannot_be_is_told_and_not_taken() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 60.0)]);
    let before = harness.scene().clone();
    for (field, text, words) in [
        (
            "length of the flight",
            "-1",
            "length of the flight must be greater than 0",
        ),
        (
            "length of the flight",
            "1e9",
            "length of the flight must be between",
        ),
        (
            "frames per second",
            "1000",
            "frames per second must be between 1 and 240",
        ),
        ("playback speed", "fast", "“fast” is not a number"),
    ] {
        harness.type_into(field, text);
        harness.assert_says(words);
        assert_eq!(harness.scene(), &before, "{field}: {text}");
    }
    assert_eq!(harness.editor().timeline().speed, 1.0);
    harness.type_into("length of the flight", "3 s");
    harness.type_into("frames per second", "12,5 fps");
    let animation = &harness.scene().animation;
    assert_eq!(animation.keys[1].time, 3.0);
    assert_eq!(animation.frames_per_second, 12.5);
}

#[test]
fn escape_gives_the_drag_of_a_number_of_the_timeline_up() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 60.0)]);
    let before = harness.scene().clone();
    for field in [
        "length of the flight",
        "frames per second",
        "playback speed",
    ] {
        let at = harness.give_up_dragging(field, |harness| {
            let is_faster = harness.editor().timeline().speed != 1.0;
            assert!(is_faster || harness.scene() != &before, "{field}");
        });
        harness.window.drop_at(at);
        harness.settle();
        assert_eq!(harness.scene(), &before, "{field}");
        assert_eq!(harness.editor().timeline().speed, 1.0);
        assert_eq!(harness.editor().undo_label(), None, "{field}");
    }
}

#[test]
fn a_length_that_only_a_file_can_have_is_left_in_silence() {
    let mut harness = animation(&[(0.0, 0.0), (0.05, 60.0)]);
    let before = harness.scene().clone();
    let field = "length of the flight";
    harness.put_cursor_into(field);
    harness.press(Modifiers::NONE, Key::Enter);
    assert_eq!(harness.scene(), &before);
    let words = "length of the flight must be between";
    assert!(!harness.sees(words));
}

#[test]
fn a_flight_that_nothing_can_stretch_stays_as_it_is() {
    let mut scene = Scene::demo();
    let camera = scene.camera.clone();
    let keys = [0.0, 0.05].map(|time| SceneKey::new(time, camera.clone()));
    scene.animation_mut().keys = keys.into();
    let last = Value::Number(0.5);
    let with_last = scene
        .animation
        .with_value(&Target::AmbientIntensity, MAX_SECONDS, last);
    *scene.animation_mut() = with_last;
    let mut harness = EditorHarness::on(scene);
    let before = harness.scene().clone();
    harness.type_into("length of the flight", "1");
    harness.assert_says("length of the flight must be between");
    assert_eq!(harness.scene(), &before);
}

#[test]
fn a_hand_on_the_shot_moves_nothing_behind_it_and_a_click_looks_through_it() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 60.0)]);
    let mut steps = 0..1000;
    while harness.window.query_by_label("Shot").is_none() {
        assert!(steps.next().is_some(), "it never came");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.window.step();
    }
    let before = harness.scene().clone();
    let place = harness.window.get_by_label("Shot").rect();
    harness.window.drag_at(place.center());
    harness.window.step();
    harness.window.hover_at(place.left_top() + vec2(4.0, 4.0));
    harness.window.step();
    harness.window.drop_at(place.left_top() + vec2(4.0, 4.0));
    harness.settle();
    assert_eq!(harness.scene(), &before);
    assert!(!harness.editor().looks_through());
    harness.click("Shot");
    assert!(harness.editor().looks_through());
    assert!(harness.window.query_by_label("Shot").is_none());
    // The second click of a double click does not hit what is behind it.
    let before = harness.editor().selection().clone();
    harness.press(Modifiers::NONE, Key::Escape);
    while harness.window.query_by_label("Shot").is_none() {
        assert!(steps.next().is_some(), "it never came again");
        std::thread::sleep(std::time::Duration::from_millis(2));
        harness.window.step();
    }
    (0..60).for_each(|_| harness.window.step());
    for _ in 0..2 {
        harness.window.drag_at(place.center());
        harness.window.step();
        harness.window.drop_at(place.center());
        harness.window.step();
    }
    harness.settle();
    assert!(harness.editor().looks_through());
    assert_eq!(harness.editor().selection(), &before);
}

#[test]
fn a_key_is_dragged_in_the_view() {
    let mut harness = animation(&[(0.0, -60.0), (2.0, 40.0)]);
    // From farther back, the flight is in view.
    harness.hold(Key::S, 60);
    let before = harness.scene().animation.keys[1].value.clone();
    let at = place_of(&harness, "Key 2 in the view");
    drag(&mut harness, at, vec2(0.0, -60.0), Modifiers::NONE);
    let after = harness.scene().animation.keys[1].value.clone();
    assert_eq!(harness.editor().undo_label(), Some("Move key in the view"));
    let moved = after.position - before.position;
    let view = harness.scene().camera.basis().expect("a basis");
    assert!(moved.dot(view.y_axis) > 5.0, "up in the view: {moved:?}");
    assert!(
        moved.dot(view.z_axis).abs() < 1e-6 * moved.length(),
        "in its plane"
    );
    assert_eq!(after.look_at, before.look_at);
    let there = place_of(&harness, "Key 2 in the view");
    assert!(
        (there - (at + vec2(0.0, -60.0))).length() < 2.0,
        "{there:?} from {at:?}"
    );
    harness.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.scene().animation.keys[1].value, before, "one step");
    // Escape cancels a drag in progress, and leaves the key selected.
    let selected = harness.editor().selection().clone();
    harness.window.drag_at(at);
    harness.window.step();
    for part in 1..=3 {
        harness.window.hover_at(at + vec2(0.0, -20.0 * part as f32));
        harness.window.step();
    }
    assert_ne!(harness.scene().animation.keys[1].value, before);
    harness.window.key_press(Key::Escape);
    harness.window.step();
    harness.window.drop_at(at);
    harness.settle();
    assert_eq!(harness.scene().animation.keys[1].value, before);
    assert_eq!(*harness.editor().selection(), selected);
    assert_eq!(harness.editor().redo_label(), Some("Move key in the view"));
}

#[test]
fn undo_of_a_movement_out_of_the_shot_looks_through_it_again() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 60.0)]);
    harness.press(Modifiers::NONE, Key::C);
    assert!(harness.editor().looks_through());
    harness.hold(Key::W, 20);
    assert!(!harness.editor().looks_through());
    harness.press(Modifiers::COMMAND, Key::Z);
    assert!(harness.editor().looks_through());
    harness.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(!harness.editor().looks_through());
}

#[test]
fn what_has_keys_is_keyed_by_changing_it() {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 0.0)]);
    harness.click("Light 1");
    harness.click("key intensity");
    assert_eq!(harness.scene().animation.tracks.len(), 1);
    harness.press(Modifiers::NONE, Key::End);
    harness.type_into("intensity", "0.8");
    let track = &harness.scene().animation.tracks[0];
    let values: Vec<(f64, Value)> = track.keys.iter().map(|key| (key.time, key.value)).collect();
    assert_eq!(
        values,
        [(0.0, Value::Number(0.2)), (2.0, Value::Number(0.8))]
    );
    assert_eq!(
        harness.scene().lights[0].intensity,
        0.2,
        "the scene's own stays"
    );
    assert_eq!(harness.editor().shown().lights[0].intensity, 0.8);
    // Changing other properties of the same light sets no keys.
    harness.type_into("position x", "90");
    assert_eq!(harness.scene().lights[0].position.x, 90.0);
    assert_eq!(harness.scene().lights[0].intensity, 0.2);
    assert_eq!(harness.scene().animation.tracks[0].keys.len(), 2);
    harness.press(CTRL, Key::Home);
    for _ in 0..10 {
        harness.press(Modifiers::NONE, Key::Period);
    }
    assert!(
        (harness.editor().shown().lights[0].intensity - 0.5).abs() < 1e-9,
        "halfway"
    );
    // Keys follow a change of the name, and are deleted with the light.
    harness.type_name("name", "Sun");
    assert_eq!(
        harness.scene().animation.tracks[0].target.owner(),
        Some(Owner::Light("Sun"))
    );
    harness.press(Modifiers::NONE, Key::Delete);
    assert!(harness.scene().animation.tracks.is_empty());
    let told = "Delete Sun: keys were deleted too (Sun: intensity)";
    harness.assert_says(told);
}

#[test]
fn a_hand_on_what_has_keys_stops_what_plays() {
    let (mut harness, _) = brightening();
    harness.press(CTRL, Key::Home);
    harness.window.key_press(Key::G);
    (0..20).for_each(|_| harness.window.step());
    assert!(harness.editor().timeline().is_playing);
    harness.drag("intensity", 30.0);
    assert!(!harness.editor().timeline().is_playing);
    assert_eq!(harness.scene().animation.tracks[0].keys.len(), 3);
}

/// A window in which the camera has keys at 0 and 2 seconds, and a light's intensity, too, from 0.2 to 0.8. Also
/// returns the name of that row.
fn brightening() -> (EditorHarness, String) {
    let mut harness = animation(&[(0.0, 0.0), (2.0, 0.0)]);
    harness.click("Light 1");
    harness.click("key intensity");
    harness.press(Modifiers::NONE, Key::End);
    harness.type_into("intensity", "0.8");
    let track = harness.scene().animation.tracks[0].target.name();
    (harness, track)
}

#[test]
fn delete_is_meant_for_the_key_of_a_value_that_was_clicked_last() {
    let (mut harness, track) = brightening();
    harness.click(&format!("{track} key 2"));
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(harness.scene().animation.tracks[0].keys.len(), 1);
    assert_eq!(harness.scene().lights.len(), 2);
    // A thing that is clicked next is what Delete applies to again.
    harness.click(&format!("{track} key 1"));
    harness.click("Light 1");
    harness.press(Modifiers::NONE, Key::Delete);
    assert_eq!(harness.scene().lights.len(), 1);
    assert!(harness.scene().animation.tracks.is_empty());
}

#[test]
fn keys_of_values_are_edited_like_those_of_the_camera() {
    let (mut harness, track) = brightening();
    harness.click(&format!("{track} key 2"));
    harness.type_into("intensity", "0.5");
    harness.type_into("time", "1.5");
    let [_, key] = &harness.scene().animation.tracks[0].keys[..] else {
        panic!("two keys");
    };
    assert_eq!((key.time, key.value), (1.5, Value::Number(0.5)));
    assert_eq!(harness.scene().lights[0].intensity, 0.2, "its own stays");
    // It is still selected; with a camera key added, both are moved by the same amount.
    harness.click_with(Modifiers::SHIFT, "Key 2");
    assert_eq!(harness.editor().selection().keys().len(), 2);
    let at = place_of(&harness, "Key 2");
    let by = vec2(0.5 * points_per_second(&harness), 0.0);
    drag(&mut harness, at, by, Modifiers::NONE);
    let of_value = |harness: &EditorHarness| {
        let keys = harness.scene().animation.tracks[0].keys.iter();
        keys.map(|key| key.time).collect::<Vec<_>>()
    };
    assert_eq!(times(&harness), [0.0, 2.5]);
    assert_eq!(of_value(&harness), [0.0, 2.0]);
    // A marquee around keys of two rows; keys outside it are deselected.
    let (first, last) = (
        place_of(&harness, "Key 1"),
        place_of(&harness, &format!("{track} key 1")),
    );
    drag(
        &mut harness,
        first + vec2(12.0, 0.0),
        last - first + vec2(-24.0, 4.0),
        Modifiers::NONE,
    );
    let selected = harness.editor().selection().keys();
    assert_eq!(
        *selected,
        [None, Some(0)]
            .map(|track| KeyId { track, index: 0 })
            .into()
    );
    // Undo restores the selection at the time of the edit; Shift makes a marquee add to it, and Escape cancels a
    // marquee.
    harness.press(CTRL, Key::Z);
    assert_eq!(times(&harness), [0.0, 2.0]);
    assert_eq!(harness.editor().selection().keys().len(), 2);
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::Z);
    harness.click("Key 2");
    let (from, to) = (last + vec2(30.0, 3.0), first - vec2(12.0, 3.0));
    drag(&mut harness, from, to - from, Modifiers::SHIFT);
    assert_eq!(harness.editor().selection().keys().len(), 3);
    harness.window.drag_at(from);
    harness.window.step();
    harness.window.hover_at(to);
    harness.window.step();
    harness.window.step();
    assert_eq!(harness.editor().selection().keys().len(), 2);
    harness.window.key_press(Key::Escape);
    harness.window.step();
    harness.window.drop_at(to);
    harness.settle();
    assert_eq!(harness.editor().selection().keys().len(), 3);
    // All keys of both rows, with the pointer over the timeline.
    hover_over_line(&mut harness);
    harness.press(CTRL, Key::A);
    assert_eq!(harness.editor().selection().keys().len(), 4);
    harness.press(Modifiers::NONE, Key::Delete);
    assert!(harness.scene().animation.is_still());
    harness.press(CTRL, Key::Z);
    assert_eq!(of_value(&harness), [0.0, 2.0]);
    // A click on a row's label selects the keys of the row, and a marquee can start there.
    let row = place_of(&harness, &format!("{track} key 1"));
    let at = pos2(30.0, row.y);
    harness.click_at(at);
    let all = [0, 1].map(|index| KeyId {
        track: Some(0),
        index,
    });
    assert_eq!(*harness.editor().selection().keys(), all.into());
    drag(&mut harness, at, vec2(row.x - 20.0, 2.0), Modifiers::NONE);
    assert_eq!(*harness.editor().selection().keys(), [all[0]].into());
}

#[test]
fn an_object_with_keys_moves_and_its_corners_do_not_drift() {
    let mut editor = Editor::demo();
    let mut scene = Scene::demo();
    let index = scene.objects.len() - 2;
    let target = glint::scene::Target::ObjectPosition(scene.objects[index].name.clone());
    let own = scene.objects[index].shape.clone();
    let from = own.position();
    let to = from + DVec3::new(0.1, 33.3, -7.7);
    scene.animation = scene
        .animation
        .with_value(&target, 0.0, Value::Point(from))
        .into();
    scene.animation = scene
        .animation
        .with_value(&target, 2.0, Value::Point(to))
        .into();
    let animation = scene.animation;
    editor.apply(Action::Edit(Edit::Animation(animation, "keys")));
    for step in 0..30 {
        editor.apply(Action::Time(Time::Seek(f64::from(step) / 14.0)));
        let mut object = editor.shown().objects[index].clone();
        object.visible = step % 2 == 0;
        editor.apply(Action::Edit(Edit::object(index, object, "visible")));
        assert_eq!(editor.scene().objects[index].shape, own, "bit by bit");
        assert_eq!(editor.scene().animation.tracks[0].keys.len(), 2);
    }
}

fn open_presets(harness: &mut EditorHarness) {
    let menu = harness
        .window
        .get_by_role_and_label(Role::Button, "Animate");
    menu.click();
    harness.settle();
    let flights = harness.window.get_by_label_contains("Ready-made flight");
    flights.click();
    harness.settle();
}

#[test]
fn ready_made_flights_and_other_timings_are_one_step_each() {
    let mut harness = EditorHarness::new();
    let presets = Preset::ALL.map(|preset| preset.words().0);
    open_presets(&mut harness);
    for name in presets {
        harness.window.get_by_label(name);
    }
    harness.click("Turntable");
    assert_eq!(harness.scene().animation.keys.len(), 5);
    assert!(matches!(
        harness.scene().animation.keys[0].interpolation,
        Interpolation::Orbit { .. }
    ));
    assert_eq!(harness.editor().undo_label(), Some("Turntable"));
    harness.type_into("length of the flight", "12");
    assert_eq!(times(&harness), [0.0, 3.0, 6.0, 9.0, 12.0]);
    assert_eq!(harness.editor().undo_label(), Some("Stretch"));
    harness.press(Modifiers::COMMAND, Key::Z);
    hover_over_line(&mut harness);
    harness.press(CTRL, Key::A);
    assert_eq!(harness.editor().selection().keys().len(), 5);
    harness.press(Modifiers::COMMAND, Key::Z);
    assert!(harness.scene().animation.is_still());
}

#[test]
fn paths_go_out_to_a_table_and_come_back() {
    let text = std::fs::read_to_string(FLIGHT).expect("readable");
    let mut harness = EditorHarness::with(
        |folder| {
            vec![
                (Ask::ExportPath, Some(folder.join("path.csv"))),
                (Ask::ImportPath, Some(folder.join("path.csv"))),
                (Ask::ImportPath, Some(folder.join("path.csv"))),
                (Ask::ImportPath, Some(folder.join("broken.csv"))),
                (Ask::ExportPath, Some(folder.join("circle.csv"))),
            ]
        },
        Some(&text),
    );
    let before = harness.scene().animation.keys.clone();
    harness.choose("Animate", "Export path…");
    let table = std::fs::read_to_string(harness.folder.path().join("path.csv")).expect("written");
    assert_eq!(table.lines().count(), 1 + before.len());
    harness.choose("Animate", "Import path…");
    let after = &harness.scene().animation.keys;
    assert_eq!(after.len(), before.len());
    for (was, is) in before.iter().zip(after) {
        assert_eq!((was.time, was.value.position), (is.time, is.value.position));
        assert!((was.value.look_at - is.value.look_at).length() < 1e-9);
    }
    harness.choose("Animate", "Import path…");
    harness.assert_says("camera already has the");
    let broken = harness.folder.path().join("broken.csv");
    std::fs::write(&broken, "time,x,y,z\n0,1,2,3\n0,1,2,3\n").expect("written");
    let kept = harness.scene().animation.keys.clone();
    harness.choose("Animate", "Import path…");
    harness.assert_says("line 3: there are two lines for the time 0");
    assert_eq!(
        harness.scene().animation.keys,
        kept,
        "a bad table changes nothing"
    );
    open_presets(&mut harness);
    harness.click("Turntable");
    harness.choose("Animate", "Export path…");
    harness.assert_says("circle.csv without interpolation and easing of the keys");
}

/// A frame rendered on the command line equals the frame at the playhead in the window, byte by byte.
#[test]
fn a_frame_is_the_same_from_the_command_line_and_in_the_window() {
    let mut scene = flight();
    (scene.render.width, scene.render.height) = (160, 120);
    let mut harness = EditorHarness::on(scene);
    let frame = 77;
    let time = harness.scene().animation.time_of(frame);
    assert!(!harness.editor().is_dirty(), "opening changes nothing");
    harness.press(CTRL, Key::Home);
    for _ in 1..frame {
        harness.window.key_press(Key::Period);
        harness.window.step();
    }
    harness.settle();
    assert_eq!(harness.editor().shown_time(), time);
    harness.press(Modifiers::NONE, Key::H);
    let picture = harness.picture();
    assert_eq!((picture.width, picture.height), (160, 120));
    let file = harness.folder.path().join("given.ron");
    let output = harness.folder.path().join("frame.ppm");
    let status = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["render", "--frame", "77", "-o"])
        .args([&output, &file])
        .status();
    assert!(status.expect("it runs").success());
    let bytes = std::fs::read(&output).expect("written");
    assert!(bytes.starts_with(b"P6"));
    let shown: Vec<u8> = picture
        .pixels
        .iter()
        .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    assert_eq!(bytes.len() - shown.len(), b"P6\n160 120 255\n".len());
    let body = &bytes[bytes.len() - shown.len()..];
    let differ = body.iter().zip(&shown).filter(|(a, b)| a != b).count();
    assert_eq!(differ, 0, "bytes that differ, of {}", shown.len());
}

#[test]
fn the_published_flight_is_what_it_says() {
    let scene = flight();
    let animation: &Animation = &scene.animation;
    assert_eq!(animation.frame_count(), 202);
    assert_eq!(animation.frames_per_second, 14.0);
    let take = animation.take.as_ref().expect("the recording is kept");
    let (samples, keys) = (take.samples.len(), animation.keys.len());
    assert!(samples > 500 && keys * 6 <= samples, "{keys} of {samples}");
    let path = CameraPath::new(&animation.keys);
    for frame in 1..=202 {
        let camera = path.at(animation.time_of(frame)).expect("a camera");
        assert!(camera.basis().is_some());
        assert_eq!(camera.projection, Projection::Perspective);
    }
}

#[test]
fn small_pictures_are_plain_renders_and_come_in_their_order() {
    let scene = Arc::new(Scene::demo());
    let worker = Worker::new(Some(2), || ()).expect("a render thread");
    let sketch = |name: u64| ThumbnailJob {
        name,
        scene: Arc::clone(&scene),
        size: (40, 30),
    };
    worker.request_thumbnails(vec![sketch(3), sketch(1)]);
    worker.request_thumbnails(vec![sketch(7)]);
    let start = std::time::Instant::now();
    let mut pictures = Vec::new();
    while pictures.len() < 3 && start.elapsed().as_secs() < 60 {
        pictures.extend(worker.take_thumbnails());
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let mut names: Vec<u64> = pictures.iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    assert_eq!(names, [1, 3, 7]);
    let plain = RenderRequest {
        sampling: glint::scene::Sampling::Centres,
        ..RenderRequest::of(&scene, 40, 30)
    };
    let direct = picture(&scene, &plain).0;
    assert!(pictures.iter().all(|(_, image)| *image == direct));
}

#[test]
fn a_pace_for_several_keys_leaves_their_ways() {
    let mut scene = flight();
    let animation = scene.animation_mut();
    animation.keys[1].interpolation = Interpolation::Hold;
    let ways: Vec<Interpolation> = animation.keys.iter().map(|key| key.interpolation).collect();
    let mut harness = EditorHarness::on(scene);
    hover_over_line(&mut harness);
    harness.press(CTRL, Key::A);
    harness.unfold("easing");
    harness.click("slow start");
    let keys = &harness.scene().animation.keys;
    let left: Vec<Interpolation> = keys.iter().map(|key| key.interpolation).collect();
    assert_eq!(left, ways);
    assert!(keys.iter().all(|key| key.easing == keys[0].easing));
    assert_eq!(harness.editor().undo_label(), Some("Key: easing"));
    // Choosing the value that the first key already has applies it to all.
    harness
        .window
        .get_by_label("Not the same for all: interpolation");
    harness.unfold("interpolation");
    harness.click(ways[0].name());
    let keys = &harness.scene().animation.keys;
    assert!(keys.iter().all(|key| key.interpolation == ways[0]));
}
