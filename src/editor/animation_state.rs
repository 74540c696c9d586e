//! What is on show of a scene that moves, and what the timeline's actions do.

use std::sync::Arc;

use super::timeline::{MEASURED_AT, Recording, Time, Timeline, watched};
use super::{Edit, Editor, Mode, Selection};
use crate::animate::{CameraPath, Seen, Simplified, pose, shot, simplify, worst_off};
use crate::scene::{Animation, Camera, Key, Scene, Take, Target};

/// Keys that a recording becomes, at first, and for each second: about as many as a hand can edit.
const FEW: (f64, f64) = (8.0, 2.5);
/// Where the search for a tolerance ends, in pixels.
const COARSEST: f64 = 32.0;
/// The finest tolerance of the slider, in pixels.
const FINEST: f64 = 0.05;

/// A scene, its path and its timeline, and what they come to at the time of the playhead.
#[derive(Debug)]
pub(super) struct AnimationState {
    timeline: Timeline,
    /// The scene that the rest was made from.
    scene: Arc<Scene>,
    path: CameraPath,
    shown: Arc<Scene>,
    /// Time and camera that `shown` was made for.
    made_for: (f64, bool),
    revision: u64,
    /// What the samples of a take saw, once it was asked for.
    watched: Option<(Arc<Take>, Vec<Vec<Seen>>)>,
}

impl AnimationState {
    pub fn new(scene: &Arc<Scene>) -> Self {
        let mut animation_state = Self {
            timeline: Timeline::default(),
            scene: Arc::clone(scene),
            path: CameraPath::new(&scene.animation.keys),
            shown: pose(scene, 0.0),
            made_for: (0.0, false),
            revision: 1,
            watched: None,
        };
        animation_state.measure();
        animation_state
    }

    /// How far the keys are off the recording. The slider stands there, until it is moved.
    fn measure(&mut self) {
        let scene = Arc::clone(&self.scene);
        let take = scene.animation.take.as_ref();
        let take = take.filter(|_| !scene.animation.keys.is_empty());
        self.timeline.worst = take.map(|take| {
            self.control(take);
            let seen = self.watched.as_ref().map_or(&[][..], |(_, seen)| seen);
            worst_off(&self.path, take, seen) * MEASURED_AT
        });
        if let Some(worst) = self.timeline.worst.filter(|worst| worst.is_finite()) {
            // As the slider shows it: a hundredth more or less is no wish of the user's.
            self.timeline.tolerance = (worst.max(FINEST) * 100.0).ceil() / 100.0;
        }
    }

    /// Finds out what the samples of a take see, unless that is known.
    fn control(&mut self, take: &Arc<Take>) {
        let is_watched = matches!(&self.watched, Some((of, _)) if Arc::ptr_eq(of, take));
        if !is_watched {
            self.watched = Some((Arc::clone(take), watched(take, &self.scene)));
        }
    }

    /// No key is selected any more.
    pub fn deselect_keys(&mut self) {
        self.timeline.selected.clear();
    }

    /// For another document; how it is played stays.
    pub fn start_again(&self, scene: &Arc<Scene>) -> Self {
        let mut new = Self::new(scene);
        new.timeline.repeat = self.timeline.repeat;
        new.timeline.speed = self.timeline.speed;
        new.revision = self.revision + 1;
        new
    }

    pub fn timeline(&self) -> &Timeline {
        &self.timeline
    }

    pub fn path(&self) -> &CameraPath {
        &self.path
    }

    pub fn shown(&self) -> &Arc<Scene> {
        &self.shown
    }

    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// The picture is that of the view from now on.
    pub fn look_at_view(&mut self) {
        // From outside one may fly while it plays.
        self.timeline.is_playing &= !self.timeline.looks_through;
        self.timeline.looks_through = false;
    }

    /// Takes up what has changed: the scene, the time, the camera that is looked through.
    pub fn follow(&mut self, scene: &Arc<Scene>) {
        let is_new = !Arc::ptr_eq(scene, &self.scene);
        if is_new {
            let (new, old) = (&scene.animation, &self.scene.animation);
            let is_flown_otherwise = new.keys != old.keys || new.take != old.take;
            if new.keys != old.keys {
                self.path = CameraPath::new(&new.keys);
                let count = new.keys.len();
                self.timeline.selected.retain(|&place| place < count);
            }
            self.scene = Arc::clone(scene);
            if is_flown_otherwise {
                self.measure();
            }
        }
        let animation = &scene.animation;
        let time = self.timeline.shown_time(animation);
        let looks_through = self.timeline.looks_through && !animation.keys.is_empty();
        if !is_new && self.made_for == (time, looks_through) {
            return;
        }
        self.made_for = (time, looks_through);
        let shown = if looks_through {
            shot(scene, &self.path, time)
        } else {
            pose(scene, time)
        };
        if is_new || shown != self.shown {
            self.revision += 1;
        }
        self.shown = shown;
    }

    /// What has keys gets one at the time that is on show, where the edit from `scene` to `next`
    /// has changed it; the scene's own value stays.
    pub fn key_tracked(&self, scene: &Scene, next: &mut Scene) {
        let time = self.timeline.shown_time(&next.animation);
        let targets: Vec<Target> = next
            .animation
            .tracks
            .iter()
            .map(|track| track.target.clone())
            .collect();
        for target in targets {
            let (own, shown) = (target.get(scene), target.get(&self.shown));
            let (Some(own), Some(new)) = (own, target.get(next)) else {
                continue;
            };
            if new != own && Some(new) != shown {
                next.animation = next.animation.with_value(&target, time, new);
            }
            if new != own {
                restore(&target, scene, &self.shown, next);
            }
        }
    }
}

/// Puts the own value of `scene` back into `next`.
fn restore(target: &Target, scene: &Scene, shown: &Scene, next: &mut Scene) {
    if let Target::ObjectPosition(name) = target {
        let shape = |scene: &Scene| {
            let mut objects = scene.objects.iter();
            let object = objects.find(|object| object.name == *name);
            object.map(|object| object.shape.clone())
        };
        let is_only_moved = shape(next) == shape(shown);
        if let (true, Some(own)) = (is_only_moved, shape(scene)) {
            // Moved to and fro, its corners would be rounded.
            let mut objects = next.objects.iter_mut();
            if let Some(object) = objects.find(|object| object.name == *name) {
                object.shape = own;
            }
            return;
        }
    }
    if let Some(own) = target.get(scene) {
        target.set(next, own);
    }
}

impl Editor {
    pub(super) fn apply_time(&mut self, time: Time) {
        let scene = Arc::clone(&self.scene);
        let animation = &scene.animation;
        let timeline = &mut self.animation_state.timeline;
        match time {
            Time::Seek(seconds) => {
                timeline.seek(animation, seconds.clamp(0.0, last_time(animation)));
                self.show_time();
            }
            Time::Step(frames) => {
                let frame = animation.frame_at(timeline.playhead);
                let last = animation.frame_count();
                let frame = frame.saturating_add_signed(frames).clamp(1, last);
                timeline.is_playing = false;
                timeline.seek(animation, animation.time_of(frame));
                self.show_time();
            }
            Time::Play(is_playing) => {
                timeline.play(is_playing, animation);
                if is_playing {
                    self.show_time();
                }
            }
            Time::Tick(seconds) => timeline.tick(seconds, animation.duration()),
            Time::Repeat(repeat) => timeline.repeat = repeat,
            Time::Speed(speed) => timeline.speed = speed,
            Time::LookThrough(looks_through) => {
                timeline.looks_through = looks_through;
                timeline.stays_outside = !looks_through;
                self.leave_still();
            }
            Time::SelectKeys(places) => {
                self.selection = if places.is_empty() {
                    Selection::Camera
                } else {
                    Selection::Keys
                };
                timeline.selected = places;
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
            }
            Time::Stop => {
                if let Some(Recording { take, .. }) = timeline.recording.take() {
                    self.keep(take);
                }
            }
            Time::Simplify(pixels) => {
                timeline.tolerance = pixels;
                if let Some(take) = animation.take.clone() {
                    let animation = Animation {
                        keys: in_the_time_of(&animation.keys, self.simplified(&take)),
                        ..animation.clone()
                    };
                    self.edit(Edit::Animation(Box::new(animation), "Simplify"));
                    self.animation_state.timeline.tolerance = pixels;
                }
            }
        }
    }

    /// A still picture is of another time.
    fn leave_still(&mut self) {
        if self.mode == Mode::HighRes {
            self.mode = Mode::Live;
        }
    }

    /// What moves is looked at as it moves: through the shot camera, unless the user has chosen to
    /// stay outside.
    fn show_time(&mut self) {
        self.animation_state.timeline.looks_through = !self.animation_state.timeline.stays_outside;
        self.leave_still();
    }

    /// Keeps a recorded flight, and makes its keys.
    fn keep(&mut self, take: Take) {
        let count = take.samples.len();
        if count < 2 {
            return self.notify("Nothing was recorded".to_owned());
        }
        let seconds = take.samples.last().map_or(0.0, |last| last.0);
        let few = (FEW.0 + FEW.1 * seconds) as usize;
        let take = Arc::new(take);
        self.animation_state.timeline.tolerance = 1.0;
        let mut keys = self.simplified(&take);
        // A trembling hand would leave a key in every frame.
        while keys.len() > few && self.animation_state.timeline.tolerance < COARSEST {
            self.animation_state.timeline.tolerance *= 1.5;
            keys = self.simplified(&take);
        }
        let said = keys.len();
        let worst = self.animation_state.timeline.worst.unwrap_or(0.0);
        let animation = Animation {
            keys,
            take: Some(take),
            ..self.scene.animation.clone()
        };
        self.end_gesture();
        self.edit(Edit::Animation(Box::new(animation), "Record flight"));
        self.end_gesture();
        self.animation_state.timeline.playhead = 0.0;
        self.animation_state.timeline.stays_outside = false;
        self.show_time();
        self.notify(format!(
            "{count} samples became {said} keys, never more than {worst:.1} px off at 1024²"
        ));
    }

    fn simplified(&mut self, take: &Arc<Take>) -> Vec<Key<Camera>> {
        let animation_state = &mut self.animation_state;
        animation_state.control(take);
        let seen = animation_state
            .watched
            .as_ref()
            .map_or(&[][..], |(_, seen)| seen);
        let Simplified { keys, worst } =
            simplify(take, seen, animation_state.timeline.tolerance / MEASURED_AT);
        animation_state.timeline.worst = Some(worst * MEASURED_AT);
        keys
    }
}

/// New keys for a flight that had been given another length.
fn in_the_time_of(old: &[Key<Camera>], new: Vec<Key<Camera>>) -> Vec<Key<Camera>> {
    let ([first, .., last], [start, .., end]) = (old, &new[..]) else {
        return new;
    };
    let scale = (last.time - first.time) / (end.time - start.time);
    let (from, to) = (start.time, first.time);
    let at = |time: f64| to + (time - from) * scale;
    let keys = new.into_iter();
    keys.map(|key| Key {
        time: at(key.time),
        ..key
    })
    .collect()
}

/// How far the playhead goes.
fn last_time(animation: &Animation) -> f64 {
    animation.time_of(animation.frame_count())
}
