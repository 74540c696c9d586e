//! The state of an animated scene at the playhead, and the timeline's effect on it.

use std::sync::Arc;

use super::edit::Replaced;
use super::timeline::{REFERENCE_HEIGHT, Timeline};
use crate::animate::{CameraPath, Landmark, WorstDeviation, ends_of, pose, shot, worst_deviation};
use crate::scene::{Animation, Camera, Key, Owners, Scene, Take, Target};

/// Smallest tolerance of the slider, in pixels.
const MIN_TOLERANCE: f64 = 0.05;
/// Deviation from the recording, in pixels, beyond which keys must have been moved by hand: nobody chooses a
/// tolerance that coarse.
const HAND_EDITED_DEVIATION: f64 = 100.0;
/// Most key lists made of recordings that are remembered.
const MAX_REMEMBERED: usize = 16;
/// Keys looked at from each end of a flight to find out which time span the recording covers.
const KEYS_PROBED: usize = 8;

/// Work that waits for the survey of a take: what its samples see.
#[derive(Clone, Debug)]
pub enum Pending {
    /// Turn a recorded flight into keys.
    Keep(Arc<Take>),
    /// Simplify the take again, with this tolerance in pixels.
    Simplify(Arc<Take>, f64),
    /// Measure how far the keys deviate from the take.
    Measure(Arc<Take>),
}

impl Pending {
    /// The take whose survey is awaited.
    pub fn take(&self) -> &Arc<Take> {
        match self {
            Self::Keep(take) | Self::Simplify(take, _) | Self::Measure(take) => take,
        }
    }
}

/// A scene with its camera path and timeline, and the scene as shown at the playhead.
#[derive(Debug)]
pub struct AnimationState {
    pub timeline: Timeline,
    /// The scene that the other fields are derived from.
    scene: Arc<Scene>,
    pub path: CameraPath,
    pub shown: Arc<Scene>,
    /// The time in seconds that `shown` was made for, and whether through the shot camera.
    shown_for: (f64, bool),
    pub revision: u64,
    /// What the samples of a take see. Finding out requires tracing rays, which is done elsewhere.
    pub survey: Option<(Arc<Take>, Vec<Vec<Landmark>>)>,
    /// What to do once the survey arrives.
    pub pending: Option<Pending>,
    simplified_keys: Vec<SimplifiedKeys>,
}

/// A key list made of a recording.
#[derive(Debug)]
struct SimplifiedKeys {
    take: Arc<Take>,
    /// The tolerance it was made with, in pixels.
    tolerance: f64,
    keys: Vec<Key<Camera>>,
    /// Whether they were made during a drag that may go on, which replaces them.
    is_passing: bool,
}

impl AnimationState {
    pub fn new(scene: &Arc<Scene>) -> Self {
        let mut animation_state = Self {
            timeline: Timeline::default(),
            scene: Arc::clone(scene),
            path: CameraPath::new(&scene.animation.keys),
            shown: pose(scene, 0.0),
            shown_for: (0.0, false),
            revision: 1,
            survey: None,
            pending: None,
            simplified_keys: Vec::new(),
        };
        animation_state.measure();
        animation_state
    }

    /// Measures how far the keys deviate from the recording, or waits for the survey that this needs. Until the
    /// tolerance slider is moved, it is set to that deviation.
    pub fn measure(&mut self) {
        let animation = &self.scene.animation;
        let take = animation.take.as_ref();
        let take = take.filter(|_| !animation.keys.is_empty()).cloned();
        self.timeline.worst = None;
        // Only a pending measurement may be dropped: a recorded flight that waits to become keys must not be lost.
        self.pending
            .take_if(|pending| matches!(pending, Pending::Measure(_)));
        let Some(take) = take else {
            return;
        };
        let Some(seen) = self.seen_by(&take) else {
            self.pending.get_or_insert(Pending::Measure(take));
            return;
        };
        let recorded_span = self.recorded_span(&animation.keys);
        let WorstDeviation { deviation, time } =
            worst_deviation(&self.path, &take, seen, recorded_span);
        let deviation = deviation * REFERENCE_HEIGHT;
        self.timeline.worst = Some(WorstDeviation { deviation, time });
        let is_known = self.simplified_of(&take).next().is_some();
        let tolerance = self
            .simplified_of(&take)
            .find_map(|known| (known.keys == animation.keys).then_some(known.tolerance));
        self.timeline.is_edited = tolerance.is_none() && is_known;
        if let Some(tolerance) = tolerance {
            self.timeline.tolerance = tolerance;
        } else if deviation > HAND_EDITED_DEVIATION && !is_known {
            self.timeline.is_edited = true;
        } else if deviation.is_finite() && !is_known {
            // Rounded up to hundredths, as the slider shows it, so that reading the slider back is not taken for a
            // change.
            self.timeline.tolerance = (deviation.max(MIN_TOLERANCE) * 100.0).ceil() / 100.0;
            let keys = animation.keys.clone();
            self.remember_simplified(take, self.timeline.tolerance, keys);
        }
    }

    /// Returns the start and end time of the recording within `keys`. Keys left over from those made of the recording
    /// show, by their times, whether the flight was stretched; if no such key is known, the first and the last key
    /// are taken as the ends.
    pub fn recorded_span(&self, keys: &[Key<Camera>]) -> Option<(f64, f64)> {
        let take = self.scene.animation.take.as_ref();
        let simplified = take.into_iter().flat_map(|take| self.simplified_of(take));
        let mut spans = simplified
            .map(|simplified| &simplified.keys)
            .filter_map(|simplified| {
                // A flight that pauses or returns has several equal keys, which tell nothing.
                let times_if_unique = |key: &Key<Camera>| {
                    let mut equal = simplified.iter().filter(|other| other.value == key.value);
                    let only = equal.next().filter(|_| equal.next().is_none())?;
                    Some((only.time, key.time))
                };
                let mut from_start = keys.iter().take(KEYS_PROBED);
                let mut from_end = keys.iter().rev().take(KEYS_PROBED);
                let first = from_start.find_map(times_if_unique)?;
                let last = from_end.find_map(times_if_unique)?;
                let (start, end) = ends_of(simplified)?;
                let scale = (last.1 - first.1) / (last.0 - first.0);
                let at = |time: f64| first.1 + (time - first.0) * scale;
                (scale.is_finite() && scale > 0.0).then(|| (at(start), at(end)))
            });
        let ends = || ends_of(keys).filter(|(first, last)| first < last);
        spans.next().or_else(ends)
    }

    /// The key lists made of a recording, the newest first.
    fn simplified_of(&self, take: &Arc<Take>) -> impl Iterator<Item = &SimplifiedKeys> {
        let simplified = self.simplified_keys.iter().rev();
        simplified.filter(move |one| one.take == *take)
    }

    /// Keeps the keys made so far, whatever a drag makes next.
    pub fn keep_simplified(&mut self) {
        for simplified in &mut self.simplified_keys {
            simplified.is_passing = false;
        }
    }

    /// Notes that `keys` were made of a recording with this tolerance, in pixels, instead of those made earlier in the
    /// same drag.
    pub fn remember_simplified(&mut self, take: Arc<Take>, tolerance: f64, keys: Vec<Key<Camera>>) {
        self.simplified_keys.retain(|other| !other.is_passing);
        self.simplified_keys.push(SimplifiedKeys {
            take,
            tolerance,
            keys,
            is_passing: true,
        });
        let excess = self.simplified_keys.len().saturating_sub(MAX_REMEMBERED);
        self.simplified_keys.drain(..excess);
    }

    /// What the samples of `take` see, if its survey has arrived.
    pub fn seen_by(&self, take: &Arc<Take>) -> Option<&[Vec<Landmark>]> {
        let (surveyed, seen) = self.survey.as_ref()?;
        Arc::ptr_eq(surveyed, take).then_some(seen.as_slice())
    }

    /// Returns the state for another document; the playback settings stay.
    pub fn for_new_document(&self, scene: &Arc<Scene>) -> Self {
        let mut new = Self::new(scene);
        new.timeline.repeat = self.timeline.repeat;
        new.timeline.speed = self.timeline.speed;
        new.revision = self.revision + 1;
        new
    }

    /// Switches the picture from the shot camera to the view.
    pub fn switch_to_view(&mut self) {
        // Playback goes on if the view was outside the shot camera already: one may fly while it plays.
        self.timeline.is_playing &= !self.timeline.wants_shot;
        self.timeline.wants_shot = false;
        self.timeline.is_flown = true;
    }

    /// Updates the shown scene after a change of the scene, the time or the camera that is looked through.
    pub fn update(&mut self, scene: &Arc<Scene>) {
        let is_new = !Arc::ptr_eq(scene, &self.scene);
        if is_new {
            let (new, old) = (&scene.animation, &self.scene.animation);
            let is_flight_changed = new.keys != old.keys || new.take != old.take;
            if new.keys != old.keys {
                self.path = CameraPath::new(&new.keys);
            }
            self.scene = Arc::clone(scene);
            if is_flight_changed {
                self.measure();
            }
        }
        let animation = &scene.animation;
        let time = self.timeline.shown_time(animation);
        let looks_through = self.timeline.looks_through(animation);
        if !is_new && self.shown_for == (time, looks_through) {
            return;
        }
        self.shown_for = (time, looks_through);
        let shown = if looks_through {
            shot(scene, &self.path, time)
        } else {
            pose(scene, time)
        };
        // Bookmarks and keys need not change anything in the picture.
        let looks_new =
            |shown: &Scene| shown.camera != self.shown.camera || !shown.looks_same_as(&self.shown);
        if looks_new(&shown) {
            self.revision += 1;
        }
        self.shown = shown;
    }

    /// Returns the scene with the objects at these indices in the shape and place that is shown.
    pub fn posed(&self, scene: &Scene, indices: &[usize]) -> Scene {
        let mut posed = scene.clone();
        for &index in indices {
            let shown = self.shown.objects.get(index);
            let original = scene.objects.get(index);
            if let Some((shown, original)) = shown.zip(original)
                && shown.shape != original.shape
            {
                posed.objects[index].shape.clone_from(&shown.shape);
            }
        }
        posed
    }

    /// Pauses playback at the shown frame: dragging something that has keys would otherwise leave a key in every
    /// frame.
    pub fn pause(&mut self, animation: &Animation) {
        if self.timeline.is_playing {
            self.timeline.play(false, animation);
        }
    }

    /// Sets a key at the shown time for each tracked value that the edit from `scene` to `next` has changed, or
    /// overwritten, with something other than what is shown; in `next`, the scene's own value is restored. A value
    /// of a track that is gone keeps what is shown. Returns whether any key was set.
    pub fn key_tracked(&self, scene: &Scene, next: &mut Scene, replaced: &Replaced) -> bool {
        if replaced.animation {
            self.keep_unkeyed(scene, next);
        }
        let time = self.timeline.shown_time(&next.animation);
        let targets: Vec<Target> = next.animation.targets().cloned().collect();
        // Owners are resolved once for each scene, as their list indices may differ.
        let scenes = [scene, &self.shown, &*next];
        let [in_scene, in_shown, in_next] = scenes.map(|scene| Owners::of(scene, &targets));
        // Restoring one value may restore others of the same object, so all values are read first.
        let values = |(track, target): (usize, &Target)| {
            let (old, new) = (in_scene.get(scene, target)?, in_next.get(next, target)?);
            let is_touched = new != old || replaced.holds(target, in_scene.index(target));
            let is_keyed = is_touched && Some(new) != in_shown.get(&self.shown, target);
            Some((track, old, new, is_keyed))
        };
        let values: Vec<_> = targets.iter().enumerate().filter_map(values).collect();
        let is_any_keyed = values.iter().any(|(.., is_keyed)| *is_keyed);
        for (track, old, new, is_keyed) in values {
            if is_keyed {
                next.animation_mut().put_value(track, (time, new));
            }
            let target = &targets[track];
            let indices = [&in_scene, &in_shown, &in_next].map(|owners| owners.index(target));
            if new != old && !restore_shape(target, indices, (scene, &self.shown), next) {
                in_next.set(next, target, old);
            }
        }
        is_any_keyed
    }

    /// Writes the shown value of each target that has a track in `scene`, but none in `next`, to `next`, and the same
    /// for the camera: what loses its last key stays as it is seen.
    fn keep_unkeyed(&self, scene: &Scene, next: &mut Scene) {
        if self.timeline.looks_through(&scene.animation) && next.animation.keys.is_empty() {
            next.camera.clone_from(&self.shown.camera);
        }
        let gone = scene.animation.targets_lost_in(&next.animation);
        let [in_shown, in_next] =
            [&*self.shown, &*next].map(|scene| Owners::of(scene, gone.iter().copied()));
        for target in gone {
            if let Some(value) = in_shown.get(&self.shown, target) {
                in_next.set(next, target, value);
            }
        }
    }
}

/// Restores the object's shape from `scene` in `next`, if its shape there equals the shown one: moving it to the
/// shown place and back would round its corners. Returns whether it did; `indices` holds the object's index in
/// `scene`, `shown` and `next`.
fn restore_shape(
    target: &Target,
    indices: [Option<usize>; 3],
    (scene, shown): (&Scene, &Scene),
    next: &mut Scene,
) -> bool {
    let (Target::ObjectPosition(_), [Some(scene_index), Some(shown_index), Some(next_index)]) =
        (target, indices)
    else {
        return false;
    };
    if next.objects[next_index].shape != shown.objects[shown_index].shape {
        return false;
    }
    let own = &scene.objects[scene_index].shape;
    next.objects[next_index].shape.clone_from(own);
    true
}
