//! What is on show of a scene that moves, and what the timeline's actions do.

use std::sync::Arc;

use super::timeline::{MEASURED_AT, Recording, Time, Timeline};
use super::{Edit, Editor, Mode, Selection};
use crate::animate::{CameraPath, Seen, Simplified, pose, shot, simplify, worst_off};
use crate::scene::{Animation, Camera, Key, Scene, Take, Target};

/// Keys that a recording becomes, at first, and for each second: about as many as a hand can edit.
const FEW: (f64, f64) = (8.0, 2.5);
/// Where the search for a tolerance ends, in pixels.
const COARSEST: f64 = 32.0;
/// The finest tolerance of the slider, in pixels.
const FINEST: f64 = 0.05;

/// What waits for the survey of a take.
#[derive(Clone, Debug)]
enum Pending {
    /// A flight that was recorded becomes keys.
    Keep(Arc<Take>),
    /// The keys of the take are made anew, as near as so many pixels.
    Simplify(Arc<Take>, f64),
    /// How far the keys are off is measured.
    Measure(Arc<Take>),
}

impl Pending {
    fn take(&self) -> &Arc<Take> {
        match self {
            Self::Keep(take) | Self::Simplify(take, _) | Self::Measure(take) => take,
        }
    }
}

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
    /// What the samples of a take see: to find out takes rays, which are not traced here.
    survey: Option<(Arc<Take>, Vec<Vec<Seen>>)>,
    /// What is done with the survey once it is there.
    pending: Option<Pending>,
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
            survey: None,
            pending: None,
        };
        animation_state.measure();
        animation_state
    }

    /// Measures how far the keys are off the recording, as soon as it is known what that saw. The slider
    /// stands there, until it is moved.
    fn measure(&mut self) {
        let animation = &self.scene.animation;
        let take = animation.take.as_ref();
        let take = take.filter(|_| !animation.keys.is_empty()).cloned();
        self.timeline.worst = None;
        // A recorded flight that waits is not to be forgotten.
        self.pending
            .take_if(|pending| matches!(pending, Pending::Measure(_)));
        let Some(take) = take else {
            return;
        };
        let Some(seen) = self.seen_by(&take) else {
            self.pending.get_or_insert(Pending::Measure(take));
            return;
        };
        let worst = worst_off(&self.path, &take, seen) * MEASURED_AT;
        self.timeline.worst = Some(worst);
        if worst.is_finite() {
            // As the slider shows it: a hundredth more or less is no wish of the user's.
            self.timeline.tolerance = (worst.max(FINEST) * 100.0).ceil() / 100.0;
        }
    }

    /// What the samples of a take see, if that is known.
    fn seen_by(&self, take: &Arc<Take>) -> Option<&[Vec<Seen>]> {
        let (of, seen) = self.survey.as_ref()?;
        Arc::ptr_eq(of, take).then_some(seen.as_slice())
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
                    self.stop_recording(take);
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

    /// The take whose survey is waited for: someone is to trace it, and to answer with
    /// [`Time::Surveyed`].
    pub fn wanted_survey(&self) -> Option<&Arc<Take>> {
        self.animation_state.pending.as_ref().map(Pending::take)
    }

    /// Whether a recorded flight is about to become keys.
    pub fn is_making_keys(&self) -> bool {
        matches!(self.animation_state.pending, Some(Pending::Keep(_)))
    }

    /// Does what waits, at once if what the take saw is known.
    fn after_survey(&mut self, pending: Pending) {
        if self.animation_state.seen_by(pending.take()).is_some() {
            self.finish_pending(pending);
        } else if !self.is_making_keys() {
            self.animation_state.pending = Some(pending);
        }
    }

    fn survey_arrived(&mut self, take: Arc<Take>, seen: Vec<Vec<Seen>>) {
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
            Pending::Keep(take) => self.keep(take),
            Pending::Simplify(take, pixels) => {
                let animation = &self.scene.animation;
                // An edit on the way may have replaced the take.
                if !animation
                    .take
                    .as_ref()
                    .is_some_and(|own| Arc::ptr_eq(own, &take))
                {
                    return;
                }
                self.animation_state.timeline.tolerance = pixels;
                let old = Arc::clone(&self.scene);
                let animation = Animation {
                    keys: in_the_time_of(&old.animation.keys, self.simplified(&take)),
                    ..old.animation.clone()
                };
                self.edit(Edit::Animation(Box::new(animation), "Simplify"));
                self.animation_state.timeline.tolerance = pixels;
            }
            Pending::Measure(_) => self.animation_state.measure(),
        }
    }

    /// A recorded flight is kept, and made into keys as soon as it is known what it saw.
    fn stop_recording(&mut self, take: Take) {
        if take.samples.len() < 2 {
            return self.notify("Nothing was recorded".to_owned());
        }
        self.after_survey(Pending::Keep(Arc::new(take)));
    }

    /// Keeps a recorded flight, and makes its keys.
    fn keep(&mut self, take: Arc<Take>) {
        let count = take.samples.len();
        let seconds = take.samples.last().map_or(0.0, |last| last.0);
        let few = (FEW.0 + FEW.1 * seconds) as usize;
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

    /// Keys in place of a take whose survey is known.
    fn simplified(&mut self, take: &Arc<Take>) -> Vec<Key<Camera>> {
        let state = &mut self.animation_state;
        let seen = state.seen_by(take).unwrap_or_default();
        let Simplified { keys, worst } =
            simplify(take, seen, state.timeline.tolerance / MEASURED_AT);
        state.timeline.worst = Some(worst * MEASURED_AT);
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
