//! What is on show of a scene that moves, and what the timeline's actions do.

use std::sync::Arc;

use super::edit::Replaced;
use super::timeline::{MEASURED_AT, Timeline, ViewState};
use crate::animate::{CameraPath, Landmark, Worst, ends_of, pose, shot, worst_off};
use crate::scene::{Animation, Camera, Key, Owners, Scene, Take, Target};

/// The finest tolerance of the slider, in pixels.
const FINEST: f64 = 0.05;
/// Keys that are more pixels off a recording were moved by hand: nobody asks for as rough ones.
const FARTHEST: f64 = 100.0;
/// Flights that were made of recordings are known, so many of them.
const MOST_MADE: usize = 16;
/// Keys from both ends of a flight that may tell when it was recorded.
const TELLING: usize = 8;

/// What waits for the survey of a take.
#[derive(Clone, Debug)]
pub enum Pending {
    /// A flight that was recorded becomes keys.
    Keep(Arc<Take>),
    /// The keys of the take are made anew, as near as so many pixels.
    Simplify(Arc<Take>, f64),
    /// How far the keys are off is measured.
    Measure(Arc<Take>),
}

impl Pending {
    /// The take that waits.
    pub fn take(&self) -> &Arc<Take> {
        match self {
            Self::Keep(take) | Self::Simplify(take, _) | Self::Measure(take) => take,
        }
    }
}

/// A scene, its path and its timeline, and what they come to at the time of the playhead.
#[derive(Debug)]
pub struct AnimationState {
    pub timeline: Timeline,
    /// The scene that the rest was made from.
    scene: Arc<Scene>,
    pub path: CameraPath,
    pub shown: Arc<Scene>,
    /// Time and camera that `shown` was made for.
    made_for: (f64, bool),
    pub revision: u64,
    /// What the samples of a take see: to find out takes rays, which are not traced here.
    pub survey: Option<(Arc<Take>, Vec<Vec<Landmark>>)>,
    /// What is done with the survey once it is there.
    pub pending: Option<Pending>,
    /// Keys that were made of recordings, and how far they might be off, in pixels.
    made: Vec<(f64, Vec<Key<Camera>>)>,
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
            made: Vec::new(),
        };
        animation_state.measure();
        animation_state
    }

    /// Measures how far the keys are off the recording, as soon as it is known what that saw. The slider
    /// stands there, until it is moved.
    pub fn measure(&mut self) {
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
        let flown = self.flown(&animation.keys);
        let Worst { off, time } = worst_off(&self.path, &take, seen, flown);
        let off = off * MEASURED_AT;
        self.timeline.worst = Some(Worst { off, time });
        let mut made = self.made.iter();
        let made = made.find(|(_, keys)| *keys == animation.keys);
        self.timeline.is_edited = made.is_none() && !self.made.is_empty();
        if let Some((tolerance, _)) = made {
            self.timeline.tolerance = *tolerance;
        } else if off > FARTHEST && self.made.is_empty() {
            self.timeline.is_edited = true;
        } else if off.is_finite() && self.made.is_empty() {
            // As the slider shows it: a hundredth more or less is no wish of the user's.
            self.timeline.tolerance = (off.max(FINEST) * 100.0).ceil() / 100.0;
            let keys = animation.keys.clone();
            self.note_made(self.timeline.tolerance, keys);
        }
    }

    /// From when to when the recording is flown in these keys: what is left of those that were made of it tells, by
    /// their times, whether the flight was stretched; where nothing is known of it, the first and the last key.
    pub fn flown(&self, keys: &[Key<Camera>]) -> Option<(f64, f64)> {
        let made = self.made.iter().rev().map(|(_, made)| made);
        let mut told = made.filter_map(|made| {
            // Where a flight waits, or comes back, several are alike and tell nothing.
            let times = |key: &Key<Camera>| {
                let mut same = made.iter().filter(|other| other.value == key.value);
                let only = same.next().filter(|_| same.next().is_none())?;
                Some((only.time, key.time))
            };
            let first = keys.iter().take(TELLING).find_map(times)?;
            let last = keys.iter().rev().take(TELLING).find_map(times)?;
            let (start, end) = ends_of(made)?;
            let scale = (last.1 - first.1) / (last.0 - first.0);
            let at = |time: f64| first.1 + (time - first.0) * scale;
            (scale.is_finite() && scale > 0.0).then(|| (at(start), at(end)))
        });
        let ends = || ends_of(keys).filter(|(first, last)| first < last);
        told.next().or_else(ends)
    }

    /// These keys were made of the recording with this tolerance.
    pub fn note_made(&mut self, tolerance: f64, keys: Vec<Key<Camera>>) {
        self.made.retain(|(_, other)| *other != keys);
        self.made.push((tolerance, keys));
        let excess = self.made.len().saturating_sub(MOST_MADE);
        self.made.drain(..excess);
    }

    /// What the samples of a take see, if that is known.
    pub fn seen_by(&self, take: &Arc<Take>) -> Option<&[Vec<Landmark>]> {
        let (of, seen) = self.survey.as_ref()?;
        Arc::ptr_eq(of, take).then_some(seen.as_slice())
    }

    /// For another document; how it is played stays.
    pub fn start_again(&self, scene: &Arc<Scene>) -> Self {
        let mut new = Self::new(scene);
        new.timeline.repeat = self.timeline.repeat;
        new.timeline.speed = self.timeline.speed;
        new.revision = self.revision + 1;
        new
    }

    /// The picture is that of the view from now on.
    pub fn look_at_view(&mut self) {
        // From outside one may fly while it plays.
        self.timeline.is_playing &= !self.timeline.wants_shot;
        self.timeline.wants_shot = false;
        self.timeline.is_flown = true;
    }

    /// Looks at what was looked at before a step that is taken back, or done again, on the way to this scene.
    pub fn look_again(&mut self, before: ViewState, there: &Scene) {
        self.timeline.look_again(before, &self.scene, there);
    }

    /// Takes up what has changed: the scene, the time, the camera that is looked through.
    pub fn update(&mut self, scene: &Arc<Scene>) {
        let is_new = !Arc::ptr_eq(scene, &self.scene);
        if is_new {
            let (new, old) = (&scene.animation, &self.scene.animation);
            let is_flown_otherwise = new.keys != old.keys || new.take != old.take;
            if new.keys != old.keys {
                self.path = CameraPath::new(&new.keys);
            }
            self.scene = Arc::clone(scene);
            if is_flown_otherwise {
                self.measure();
            }
        }
        let animation = &scene.animation;
        let time = self.timeline.shown_time(animation);
        let looks_through = self.timeline.looks_through(animation);
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

    /// The scene with the objects in these places as they are on show.
    pub fn posed(&self, scene: &Scene, places: &[usize]) -> Scene {
        let mut posed = scene.clone();
        for &index in places {
            let shown = self.shown.objects.get(index);
            let own = scene.objects.get(index);
            if let Some((shown, own)) = shown.zip(own)
                && shown.shape != own.shape
                && let Some(object) = posed.objects.get_mut(index)
            {
                object.shape.clone_from(&shown.shape);
            }
        }
        posed
    }

    /// What plays stops where it is on show: a drag of what has keys would leave one in every frame.
    pub fn pause(&mut self, animation: &Animation) {
        if self.timeline.is_playing {
            self.timeline.play(false, animation);
        }
    }

    /// What has keys gets one at the time that is on show, where the edit from `scene` to `next`
    /// has changed it, or has put something else in place of what is on show; the scene's own value stays. Whether
    /// anything gets one.
    pub fn key_tracked(&self, scene: &Scene, next: &mut Scene, replaced: &Replaced) -> bool {
        let time = self.timeline.shown_time(&next.animation);
        let targets: Vec<Target> = next
            .animation
            .tracks
            .iter()
            .map(|track| track.target.clone())
            .collect();
        // Positions in lists stay; each scene has its own.
        let scenes = [scene, &self.shown, &*next];
        let [in_scene, in_shown, in_next] = scenes.map(|scene| Owners::of(scene, &targets));
        // To put one value back may put others of the same object back: all are looked at before.
        let values = |(track, target): (usize, &Target)| {
            let (own, new) = (in_scene.get(scene, target)?, in_next.get(next, target)?);
            let is_touched = new != own || replaced.holds(target, in_scene.index(target));
            let is_keyed = is_touched && Some(new) != in_shown.get(&self.shown, target);
            Some((track, own, new, is_keyed))
        };
        let values: Vec<_> = targets.iter().enumerate().filter_map(values).collect();
        let is_any_keyed = values.iter().any(|(.., is_keyed)| *is_keyed);
        for (track, own, new, is_keyed) in values {
            if is_keyed {
                next.animation_mut().put_value(track, (time, new));
            }
            let target = &targets[track];
            let places = [&in_scene, &in_shown, &in_next].map(|owners| owners.index(target));
            if new != own && !restore_shape(target, places, (scene, &self.shown), next) {
                in_next.set(next, target, own);
            }
        }
        is_any_keyed
    }
}

/// Puts the own shape of an object of `scene` back into `next`, where it is as shown but for its place: moved to and fro,
/// its corners would be rounded. Whether that is so; given are its places in the three.
fn restore_shape(
    target: &Target,
    places: [Option<usize>; 3],
    (scene, shown): (&Scene, &Scene),
    next: &mut Scene,
) -> bool {
    let (Target::ObjectPosition(_), [Some(own), Some(there), Some(here)]) = (target, places) else {
        return false;
    };
    if next.objects[here].shape != shown.objects[there].shape {
        return false;
    }
    if let Some(object) = next.objects.get_mut(here) {
        object.shape.clone_from(&scene.objects[own].shape);
    }
    true
}
