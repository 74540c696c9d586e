//! Effects of timeline actions on the document: playback, recording, making keys of a recording.

use std::collections::HashSet;
use std::sync::Arc;

use super::action::Mode;
use super::animation_state::Pending;
use super::document::Editor;
use super::edit::Edit;
use super::item::ItemKind;
use super::timeline::{REFERENCE_HEIGHT, Recording, Time};
use crate::animate::{Landmark, WorstDeviation, resampled, simplify};
use crate::scene::{Animation, Camera, Key, MAX_SECONDS, Owner, Sample, Take, Target};
use crate::words::counted;

/// Most keys that a recording should become: a base number, and more per second. About as many as can be edited by
/// hand.
const MAX_KEYS_WANTED: (f64, f64) = (8.0, 2.5);
/// Largest tolerance that is tried, in pixels: a larger deviation would be visible.
const MAX_TOLERANCE: f64 = 6.0;
/// The user is told of steps of the mouse if more than one in this many samples was interpolated.
const STEPPED_SHARE: usize = 5;

impl Editor {
    pub(super) fn apply_time(&mut self, time: Time) {
        let scene = Arc::clone(&self.scene);
        let animation = &scene.animation;
        let is_making_keys = self.is_making_keys();
        let timeline = &mut self.animation_state.timeline;
        match time {
            Time::Seek(seconds) => {
                // Beyond the end is allowed, too: the next key may go there.
                timeline.seek(animation, seconds.clamp(0.0, MAX_SECONDS));
                self.show_sought();
            }
            Time::Stretched(from, by) => timeline.stretch(from, by),
            Time::Step(frames) => {
                let frame = animation.frame_at(timeline.playhead);
                // A playhead beyond the end steps back from where it is, but no farther ahead.
                let last = animation.frame_count().max(frame);
                let frame = frame.saturating_add_signed(frames).clamp(1, last);
                timeline.is_playing = false;
                timeline.seek(animation, animation.time_of(frame));
                self.show_sought();
            }
            Time::Play(is_playing) => {
                timeline.play(is_playing, animation);
                if is_playing {
                    timeline.is_flown = false;
                    self.show_time();
                }
            }
            Time::Tick(seconds) => timeline.tick(seconds, animation),
            Time::Repeat(repeat) => timeline.repeat = repeat,
            Time::Speed(speed) => timeline.speed = speed,
            Time::LookThrough(looks_through) => {
                timeline.wants_shot = looks_through;
                timeline.stays_outside = !looks_through;
                timeline.is_flown = false;
                self.leave_still();
            }
            Time::Record if is_making_keys => {
                self.notify("The last flight is still being reduced to keys".to_owned());
            }
            Time::Record => {
                let camera = self.animation_state.shown.camera.clone();
                self.edit(Edit::Camera(camera, "move"));
                self.animation_state.timeline.record();
                self.leave_still();
            }
            Time::Sample(now) => {
                let angles = self.orientation();
                let camera = &self.animation_state.shown.camera;
                self.animation_state.timeline.sample(now, camera, angles);
                if self.timeline().is_full() {
                    self.notify(
                        "The recording has reached its maximum length and ends here".to_owned(),
                    );
                    self.apply_time(Time::Stop);
                }
            }
            Time::Stop => {
                if let Some(Recording { take, .. }) = timeline.recording.take() {
                    self.stop_recording(&take);
                }
            }
            Time::Surveyed(take, seen) => self.survey_arrived(take, seen),
            Time::Simplify(pixels) => {
                timeline.tolerance = pixels;
                if let Some(take) = animation.take.clone() {
                    self.after_survey(Pending::Simplify(take, pixels));
                }
            }
        }
    }

    /// Shows the scene as it is now. A still picture that still shows it stays.
    pub(super) fn show_scene(&mut self) {
        let before = self.shown_revision();
        self.animation_state.update(&self.scene);
        if self.shown_revision() != before {
            self.leave_still();
        }
    }

    /// Returns from the still picture, which is out of date, to the live view.
    pub(super) fn leave_still(&mut self) {
        if self.mode == Mode::HighRes {
            self.mode = Mode::Live;
        }
    }

    /// Shows another time. Whoever gives keys to a thing moves it in their own view.
    fn show_sought(&mut self) {
        if !self.animation_state.timeline.wants_shot && self.is_selection_keyed() {
            self.leave_still();
        } else {
            self.show_time();
        }
    }

    /// Whether an item with keys is selected.
    fn is_selection_keyed(&self) -> bool {
        let items = self.selection.items();
        let owners = self.scene.animation.targets().filter_map(Target::owner);
        let owners: HashSet<Owner> = owners.collect();
        items.iter().any(|item| {
            let name = item.name(&self.scene).unwrap_or_default();
            match item.kind {
                ItemKind::Light => owners.contains(&Owner::Light(name)),
                ItemKind::Object => owners.contains(&Owner::Object(name)),
                ItemKind::Pack => false,
            }
        })
    }

    /// Looks through the shot camera to show the animation, unless the user has chosen to stay outside.
    fn show_time(&mut self) {
        let timeline = &mut self.animation_state.timeline;
        // Outside the time of the shot camera's flight, a view that was flown to is kept: it may become the next key.
        let is_kept = timeline.is_flown && !timeline.is_in_flight(&self.scene.animation);
        // While recording, the camera is flown by hand, not by its existing keys.
        let is_free = timeline.stays_outside || timeline.recording.is_some() || is_kept;
        timeline.wants_shot = !is_free;
        timeline.is_flown &= is_free;
        self.leave_still();
    }

    /// The take whose survey is awaited: the caller is to trace it and to answer with [`Time::Surveyed`].
    pub fn wanted_survey(&self) -> Option<&Arc<Take>> {
        self.animation_state.pending.as_ref().map(Pending::take)
    }

    /// Whether the scene may change with every frame of the window.
    pub fn is_moving(&self) -> bool {
        self.is_in_gesture() || self.timeline().is_playing
    }

    /// Whether a flight is being recorded, or waits to become keys.
    pub fn is_recording(&self) -> bool {
        self.timeline().recorded().is_some() || self.is_making_keys()
    }

    /// Whether a recorded flight waits to become keys.
    pub fn is_making_keys(&self) -> bool {
        matches!(self.animation_state.pending, Some(Pending::Keep(_)))
    }

    /// Finishes pending work, at once if the survey of its take has arrived.
    fn after_survey(&mut self, pending: Pending) {
        if self.animation_state.seen_by(pending.take()).is_some() {
            self.finish_pending(pending);
        } else if !self.is_making_keys() {
            self.animation_state.pending = Some(pending);
        }
    }

    fn survey_arrived(&mut self, take: Arc<Take>, seen: Vec<Vec<Landmark>>) {
        let state = &mut self.animation_state;
        let pending = state
            .pending
            .take_if(|pending| Arc::ptr_eq(pending.take(), &take));
        state.survey = Some((take, seen));
        if let Some(pending) = pending {
            self.finish_pending(pending);
        }
    }

    fn finish_pending(&mut self, pending: Pending) {
        match pending {
            Pending::Keep(take) => self.store_recording(take),
            Pending::Simplify(take, pixels) => {
                let animation = &self.scene.animation;
                // An edit in the meantime may have replaced the take.
                if !animation
                    .take
                    .as_ref()
                    .is_some_and(|own| Arc::ptr_eq(own, &take))
                {
                    return self.animation_state.measure();
                }
                self.animation_state.timeline.tolerance = pixels;
                let old = Arc::clone(&self.scene);
                let recorded_span = self.animation_state.recorded_span(&old.animation.keys);
                let keys = fit_to_span(recorded_span, self.simplified(&take));
                if !self.is_in_gesture() {
                    self.animation_state.keep_simplified();
                }
                self.animation_state
                    .remember_simplified(take, pixels, keys.clone());
                let animation = Animation {
                    keys,
                    ..Animation::clone(&old.animation)
                };
                self.edit(Edit::animation(animation, "Simplify"));
            }
            Pending::Measure(_) => self.animation_state.measure(),
        }
    }

    /// Keeps a recorded flight, and makes keys of it once its survey has arrived.
    fn stop_recording(&mut self, take: &Take) {
        if take.samples.len() < 2 {
            return self.notify("Nothing was recorded".to_owned());
        }
        let first = take.samples[0];
        let is_unmoved =
            |sample: &Sample| Sample(first.0, sample.1, sample.2, sample.3, sample.4) == first;
        if take.lenses.len() < 2 && take.samples.iter().all(is_unmoved) {
            return self.notify("The camera did not move: nothing was recorded".to_owned());
        }
        let (take, interpolated) = resampled(take);
        if interpolated * STEPPED_SHARE > take.samples.len() {
            self.notify(format!(
                "The mouse moved in steps: {interpolated} of {} samples are interpolated",
                take.samples.len()
            ));
        }
        self.after_survey(Pending::Keep(Arc::new(take)));
    }

    /// Stores a recorded flight in the scene, with keys made of it.
    fn store_recording(&mut self, take: Arc<Take>) {
        let count = take.samples.len();
        let seconds = take.samples.last().map_or(0.0, |last| last.0);
        let max_keys = (MAX_KEYS_WANTED.0 + MAX_KEYS_WANTED.1 * seconds) as usize;
        self.animation_state.timeline.tolerance = 1.0;
        let mut keys = self.simplified(&take);
        // A coarser tolerance if needed: a trembling hand would leave a key in every frame.
        while keys.len() > max_keys && self.animation_state.timeline.tolerance < MAX_TOLERANCE {
            let coarser = self.animation_state.timeline.tolerance * 1.5;
            self.animation_state.timeline.tolerance = coarser.min(MAX_TOLERANCE);
            keys = self.simplified(&take);
        }
        let key_count = counted(keys.len(), "key");
        let replaced = match self.scene.animation.keys.len() {
            0 => String::new(),
            old => format!(", replacing the previous {old} (undo brings them back)"),
        };
        let timeline = &self.animation_state.timeline;
        let worst = timeline.worst.map_or(0.0, |worst| worst.deviation);
        let jumps = match timeline.jumps {
            0 => String::new(),
            1 => "; the view jumped once".to_owned(),
            jumps => format!("; the view jumped {jumps} times"),
        };
        let tolerance = timeline.tolerance;
        self.animation_state.keep_simplified();
        self.animation_state
            .remember_simplified(Arc::clone(&take), tolerance, keys.clone());
        let animation = Animation {
            keys,
            take: Some(take),
            ..Animation::clone(&self.scene.animation)
        };
        self.end_gesture();
        if !self.edit(Edit::animation(animation, "Record flight")) {
            return;
        }
        self.end_gesture();
        self.animation_state.timeline.playhead = 0.0;
        self.animation_state.timeline.stays_outside = false;
        self.show_time();
        self.notify_of_step(format!(
            "{count} samples became {key_count}{replaced}, never more than {worst:.1} px off at 1024²{jumps}"
        ));
    }

    /// Returns keys that replace a take, whose survey must be known.
    fn simplified(&mut self, take: &Arc<Take>) -> Vec<Key<Camera>> {
        let state = &mut self.animation_state;
        let seen = state.seen_by(take).unwrap_or_default();
        let tolerance = state.timeline.tolerance / REFERENCE_HEIGHT;
        let simplified = simplify(take, seen, tolerance);
        state.timeline.worst = Some(WorstDeviation {
            deviation: simplified.worst.deviation * REFERENCE_HEIGHT,
            ..simplified.worst
        });
        state.timeline.jumps = simplified.jumps;
        simplified.keys
    }
}

/// Fits new keys into the time span `span` of a flight, whose length may have been changed.
fn fit_to_span(span: Option<(f64, f64)>, new: Vec<Key<Camera>>) -> Vec<Key<Camera>> {
    let (Some((first, last)), [start, .., end]) = (span, &new[..]) else {
        return new;
    };
    let scale = (last - first) / (end.time - start.time);
    // If the beginning was deleted and the rest moved to the start of the timeline, `first` is negative; the new keys
    // have the beginning again and start at 0.
    let (from, first) = (start.time, first.max(0.0));
    let retimed = |time: f64| first + (time - from) * scale;
    let keys = new.into_iter();
    keys.map(|key| Key {
        time: retimed(key.time),
        ..key
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::Action;
    use crate::scene::{Key, Target, Value};

    #[test]
    fn a_scene_that_plays_is_in_time_with_what_is_recorded() {
        let mut editor = Editor::demo();
        let value = |time: f64| Value::Number(time / 10.0);
        let lit = [0.0, 4.0].iter().fold(Animation::default(), |lit, &time| {
            lit.with_value(&Target::AmbientIntensity, time, value(time))
        });
        editor.apply(Action::Edit(Edit::animation(lit, "light")));
        let time = |time| Action::Time(time);
        editor.apply(time(Time::Speed(3.0)));
        editor.apply(time(Time::Seek(1.0)));
        editor.apply(time(Time::Record));
        editor.apply(time(Time::Sample(10.0)));
        editor.apply(time(Time::Sample(12.0)));
        editor.apply(time(Time::Play(true)));
        assert_eq!(editor.timeline().playhead, 2.0);
        editor.apply(time(Time::Sample(15.0)));
        editor.apply(time(Time::Tick(3.0)));
        assert_eq!(editor.timeline().playhead, 5.0, "it does not begin again");
    }

    #[test]
    fn one_key_keeps_the_playhead_where_it_is() {
        let mut editor = Editor::demo();
        let still = Animation {
            keys: vec![Key::new(0.0, editor.scene().camera.clone())],
            ..Animation::default()
        };
        editor.apply(Action::Edit(Edit::animation(still, "key")));
        editor.end_gesture();
        editor.apply(Action::Edit(Edit::Ambient(0.1)));
        editor.apply(Action::Time(Time::Seek(2.0)));
        editor.apply(Action::Undo);
        editor.apply(Action::Time(Time::Play(true)));
        editor.apply(Action::Time(Time::Tick(0.1)));
        assert_eq!(editor.timeline().playhead, 2.0);
    }
}
