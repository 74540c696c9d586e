//! Operations on keys. Each returns a changed animation, for one undo step.

use std::collections::{BTreeSet, HashMap, HashSet};

use glam::DVec3;

use super::animation::{
    Animation, Easing, Interpolation, Key, MAX_SECONDS, Owner, SAME_TIME, Target, Track, Value,
};
use super::camera::Camera;

/// Share of a frame below which the distance of two keys counts as zero.
const SAME_TIME_IN_FRAMES: f64 = 0.25;

/// Identifies a key of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct KeyId {
    /// Index of its track; `None` for the camera.
    pub track: Option<usize>,
    /// Index in the track, in order of time.
    pub index: usize,
}

/// A set of keys.
pub type Keys = BTreeSet<KeyId>;
/// Interpolation and easing between a key and the next one.
pub type Pace = (Interpolation, Easing);

impl KeyId {
    /// Identifies a key of the camera.
    pub fn of_camera(index: usize) -> Self {
        Self { track: None, index }
    }
}

impl Animation {
    /// Yields what the tracks animate, in their order.
    pub fn targets(&self) -> impl Iterator<Item = &Target> {
        self.tracks.iter().map(|track| &track.target)
    }

    /// Returns the targets that have a track here, but none in `next`.
    pub fn targets_lost_in(&self, next: &Self) -> Vec<&Target> {
        let kept: HashSet<&Target> = next.targets().collect();
        let mut lost: Vec<&Target> = self.targets().collect();
        lost.retain(|target| !kept.contains(target));
        lost
    }

    fn is_same_time(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < SAME_TIME_IN_FRAMES / self.frames_per_second
    }

    /// Returns the index of the key that counts as being at this time, the nearest if there are several. Keys of a
    /// recorded flight are between frames, whereas the playhead is on one.
    fn index_at<T>(&self, keys: &[Key<T>], time: f64) -> Option<usize> {
        let distance = |index: &usize| (keys[*index].time - time).abs();
        let near = (0..keys.len()).filter(|&index| self.is_near(keys[index].time, time));
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Returns the index of the camera key at this time, if any.
    pub fn key_at(&self, time: f64) -> Option<usize> {
        self.index_at(&self.keys, time)
    }

    /// Returns whether a key that is moved from one time to another replaces the key at `other`, because it is near
    /// it then. If the two were near each other before, that was intended, as on both sides of a jump.
    fn replaces(&self, (from, to): (f64, f64), other: f64) -> bool {
        let were_apart = !self.is_same_time(from, other);
        self.is_near(to, other) && (were_apart || (to - other).abs() < SAME_TIME)
    }

    /// Returns whether two times belong to the same frame, or are nearly the same on both sides of a boundary.
    fn is_near(&self, a: f64, b: f64) -> bool {
        self.nearest_frame(a) == self.nearest_frame(b) || self.is_same_time(a, b)
    }

    /// Returns the animation with a camera key at this time, which replaces an existing one, and the key's index.
    pub fn with_key(&self, time: f64, camera: Camera) -> (Self, usize) {
        let mut animation = self.clone();
        let index = put_key(&mut animation.keys, self.key_at(time), (time, camera));
        (animation, index)
    }

    /// Returns all keys, those of the camera first.
    pub fn all_keys(&self) -> Keys {
        let tracks = self.tracks.iter().enumerate();
        let rows = tracks.map(|(track, row)| (Some(track), row.keys.len()));
        std::iter::once((None, self.keys.len()))
            .chain(rows)
            .flat_map(|(track, count)| (0..count).map(move |index| KeyId { track, index }))
            .collect()
    }

    /// Returns those of these keys from which the way to the next one is an orbit.
    pub fn orbiting(&self, keys: &Keys) -> Keys {
        let is_orbiting = |key: &KeyId| {
            let pace = self.time_and_pace_of(*key);
            pace.is_some_and(|(_, (way, _))| matches!(way, Interpolation::Orbit { .. }))
        };
        keys.iter().copied().filter(is_orbiting).collect()
    }

    /// The number of all keys.
    pub fn key_count(&self) -> usize {
        let rows = self.tracks.iter().map(|row| row.keys.len());
        self.keys.len() + rows.sum::<usize>()
    }

    /// Returns whether both animations have the same tracks, with equal numbers of keys.
    pub fn has_same_keys_as(&self, other: &Self) -> bool {
        let is_same =
            |(a, b): (&Track, &Track)| a.target == b.target && a.keys.len() == b.keys.len();
        let are_as_many =
            self.keys.len() == other.keys.len() && self.tracks.len() == other.tracks.len();
        are_as_many && self.tracks.iter().zip(&other.tracks).all(is_same)
    }

    /// Returns the time of a key, and interpolation and easing after it; `None` if there is no such key.
    pub fn time_and_pace_of(&self, id: KeyId) -> Option<(f64, Pace)> {
        match id.track {
            None => self.keys.get(id.index).map(time_and_pace),
            Some(track) => {
                let keys = &self.tracks.get(track)?.keys;
                keys.get(id.index).map(time_and_pace)
            }
        }
    }

    /// Returns a label for a key.
    pub fn name_of(&self, KeyId { track, index }: KeyId) -> String {
        let number = index + 1;
        match track.and_then(|track| self.tracks.get(track)) {
            Some(track) => format!("{} key {number}", track.target.name()),
            None => format!("Key {number}"),
        }
    }

    /// Returns the animation without these keys. Tracks that are empty then are removed.
    pub fn without_keys(&self, ids: &Keys) -> Self {
        let mut animation = self.clone();
        retain_others(&mut animation.keys, None, ids);
        for (track, row) in animation.tracks.iter_mut().enumerate() {
            retain_others(&mut row.keys, Some(track), ids);
        }
        animation.tracks.retain(|track| !track.keys.is_empty());
        animation
    }

    /// Returns the times of the first and the last of these keys, in seconds from the start.
    pub fn span_of(&self, ids: &Keys) -> Option<(f64, f64)> {
        let times = ids.iter().filter_map(|id| self.time_and_pace_of(*id));
        let spans = times.map(|(time, _)| (time, time));
        spans.reduce(|(first, last), (time, _)| (time.min(first), time.max(last)))
    }

    /// Returns the animation with these keys, or copies of them, moved by `shift` seconds, and their new ids.
    /// The shift is limited so that none is before the start or after [`MAX_SECONDS`]. Each moved key replaces the
    /// one it lands on.
    pub fn with_moved(&self, ids: &Keys, shift: f64, are_copies: bool) -> (Self, Keys) {
        let (first, last) = self.span_of(ids).unwrap_or((0.0, MAX_SECONDS));
        let shift = shift.clamp(-first, MAX_SECONDS - last);
        self.with_new_times(ids, (&|time| time + shift, are_copies))
    }

    /// Returns the animation with these keys spread over another duration, in seconds, from the first of them on, and
    /// their new ids. The last one stays at or before [`MAX_SECONDS`]. Each key replaces the one it lands on.
    pub fn with_stretched(&self, ids: &Keys, duration: f64) -> (Self, Keys) {
        let (first, last) = self.span_of(ids).unwrap_or((0.0, MAX_SECONDS));
        let factor = duration.min(MAX_SECONDS - first) / (last - first);
        if !factor.is_finite() {
            return (self.clone(), ids.clone());
        }
        self.with_new_times(ids, (&|time| first + (time - first) * factor, false))
    }

    fn with_new_times(&self, ids: &Keys, movement: Movement) -> (Self, Keys) {
        let (mut animation, mut new) = (self.clone(), Keys::new());
        let mut record = |track, indices: Vec<usize>| {
            let id = |index| KeyId { track, index };
            new.extend(indices.into_iter().map(id));
        };
        let moved = indices(ids, None);
        record(None, move_keys(self, &mut animation.keys, &moved, movement));
        for (track, row) in animation.tracks.iter_mut().enumerate() {
            let moved = indices(ids, Some(track));
            record(
                Some(track),
                move_keys(self, &mut row.keys, &moved, movement),
            );
        }
        (animation, new)
    }

    /// Returns the animation with `change` applied to the camera keys among these.
    pub fn with_each(&self, ids: &Keys, change: impl Fn(&mut Key<Camera>)) -> Self {
        let mut animation = self.clone();
        for index in indices(ids, None) {
            if let Some(key) = animation.keys.get_mut(index) {
                change(key);
            }
        }
        animation
    }

    /// Returns the animation with `change` applied to interpolation and easing of these keys.
    pub fn with_pace(&self, ids: &Keys, change: impl Fn(&mut Pace)) -> Self {
        let mut animation = self.with_each(ids, |key| set_pace(key, &change));
        for id in ids {
            let track = id.track.and_then(|track| animation.tracks.get_mut(track));
            if let Some(key) = track.and_then(|track| track.keys.get_mut(id.index)) {
                set_pace(key, &change);
            }
        }
        animation
    }

    /// Returns the key of a track at this time, if any.
    pub fn value_at(&self, track: usize, time: f64) -> Option<KeyId> {
        let index = self.index_at(&self.tracks.get(track)?.keys, time)?;
        let track = Some(track);
        Some(KeyId { track, index })
    }

    /// Returns the indices of the tracks that animate any of the wanted targets, by target.
    pub fn track_indices<'t>(
        &self,
        wanted: impl IntoIterator<Item = &'t Target>,
    ) -> HashMap<&Target, usize> {
        let wanted: HashSet<&Target> = wanted.into_iter().collect();
        let tracks = self.tracks.iter().enumerate();
        let tracks = tracks.filter(|(_, track)| wanted.contains(&track.target));
        tracks
            .map(|(index, track)| (&track.target, index))
            .collect()
    }

    /// Returns the animation with a key for `target` at this time, which replaces an existing one.
    pub fn with_value(&self, target: &Target, time: f64, value: Value) -> Self {
        self.with_values([(target, value)], time)
    }

    /// Returns the animation with keys for several targets at this time, which replace existing ones.
    pub fn with_values<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Target, Value)>,
        time: f64,
    ) -> Self {
        let values: Vec<_> = values.into_iter().collect();
        let ids = self.track_indices(values.iter().map(|(target, _)| *target));
        let mut animation = self.clone();
        for (target, value) in values {
            let id = ids.get(target).copied().unwrap_or_else(|| {
                animation.tracks.push(Track {
                    target: target.clone(),
                    keys: Vec::new(),
                });
                animation.tracks.len() - 1
            });
            animation.put_value(id, (time, value));
        }
        animation
    }

    /// Adds a key to a track, or replaces an existing one at this time.
    pub fn put_value(&mut self, track: usize, key: (f64, Value)) {
        let existing = self.index_at(&self.tracks[track].keys, key.0);
        put_key(&mut self.tracks[track].keys, existing, key);
    }

    /// Renames the light or object that tracks refer to.
    pub fn rename_owner(&mut self, owner: Owner, to: &str) {
        let tracks = self.tracks.iter_mut();
        for track in tracks.filter(|track| track.target.owner() == Some(owner)) {
            track.target = track.target.renamed(to);
        }
    }

    /// Removes the tracks of lights and objects that no longer exist.
    pub fn forget(&mut self, gone: &HashSet<Owner>) {
        let is_gone = |track: &Track| track.target.owner().is_some_and(|it| gone.contains(&it));
        self.tracks.retain(|track| !is_gone(track));
    }
}

impl Track {
    /// Returns the track for a copy of its owner that has another name and is displaced by `by`.
    pub fn for_copy(&self, name: &str, by: DVec3) -> Self {
        let mut copy = Self {
            target: self.target.renamed(name),
            keys: self.keys.clone(),
        };
        if copy.target.is_position() {
            copy.shift(by);
        }
        copy
    }

    /// Moves the points of all keys, and the centres of orbits.
    pub fn shift(&mut self, by: DVec3) {
        for key in &mut self.keys {
            if let Value::Point(point) = &mut key.value {
                *point += by;
            }
            if let Interpolation::Orbit { around } = &mut key.interpolation {
                *around += by;
            }
        }
    }
}

/// Sets the value at a time, either of the key at the index `existing` or of a new one. Returns its index. A new key
/// takes the interpolation of the key before it, so that a cut stays a cut and an orbit continues, and its part of the
/// easing.
fn put_key<T>(keys: &mut Vec<Key<T>>, existing: Option<usize>, (time, value): (f64, T)) -> usize {
    if let Some(existing) = existing {
        keys[existing].value = value;
        let is_behind = |before: &Key<T>| before.time + SAME_TIME < time;
        let is_before = |next: &Key<T>| time + SAME_TIME < next.time;
        let (before, others) = keys.split_at_mut(existing);
        // Moves the key to exactly this time, so that the value is exact there.
        if before.last().is_none_or(is_behind) && others.get(1).is_none_or(is_before) {
            others[0].time = time;
        }
        return existing;
    }
    let at = keys.partition_point(|key| key.time < time);
    let mut key = Key::new(time, value);
    if (1..keys.len()).contains(&at) {
        let before = &mut keys[at - 1];
        key.interpolation = before.interpolation;
        // What starts or ends slowly still does so, and does not stop at the new key.
        (before.easing, key.easing) = match before.easing {
            Easing::Even => (Easing::Even, Easing::Even),
            Easing::In => (Easing::In, Easing::Even),
            Easing::Out => (Easing::Even, Easing::Out),
            Easing::InOut => (Easing::In, Easing::Out),
        };
    }
    keys.insert(at, key);
    at
}

fn time_and_pace<T>(key: &Key<T>) -> (f64, Pace) {
    (key.time, (key.interpolation, key.easing))
}

fn set_pace<T>(key: &mut Key<T>, change: &impl Fn(&mut Pace)) {
    let (_, mut pace) = time_and_pace(key);
    change(&mut pace);
    (key.interpolation, key.easing) = pace;
}

/// Returns the indices of the keys in `ids` that belong to one track, in order.
fn indices(ids: &Keys, track: Option<usize>) -> Vec<usize> {
    let id = |index| KeyId { track, index };
    let own = ids.range(id(0)..=id(usize::MAX));
    own.map(|id| id.index).collect()
}

fn retain_others<T>(keys: &mut Vec<Key<T>>, track: Option<usize>, ids: &Keys) {
    let mut index = 0;
    keys.retain(|_| {
        let id = KeyId { track, index };
        index += 1;
        !ids.contains(&id)
    });
}

/// The new time of a key, in seconds, by its old one, and whether a copy is moved.
type Movement<'a> = (&'a dyn Fn(f64) -> f64, bool);

/// Moves the keys at `indices` (ascending), or copies of them. Returns their new indices.
fn move_keys<T: Clone>(
    animation: &Animation,
    keys: &mut Vec<Key<T>>,
    indices: &[usize],
    (new_time, are_copies): Movement,
) -> Vec<usize> {
    let moved = indices.iter().filter_map(|&index| keys.get(index));
    // Each with its earlier time.
    let moved: Vec<(f64, Key<T>)> = moved
        .map(|key| {
            let moved = Key {
                time: new_time(key.time),
                ..key.clone()
            };
            (key.time, moved)
        })
        .collect();
    if moved.is_empty() {
        return Vec::new();
    }
    let others = keys.iter().enumerate();
    let others = others.filter(|(index, _)| are_copies || indices.binary_search(index).is_err());
    let others: Vec<&Key<T>> = others.map(|(_, key)| key).collect();
    let near = 1.0 / animation.frames_per_second;
    // The nearest of the keys that a moved key may replace: recorded keys may be much closer together than frames.
    let replaced = |(time, key): &(f64, Key<T>)| {
        // A copy has no earlier position.
        let from = if are_copies { f64::INFINITY } else { *time };
        let distance = |other: &usize| (others[*other].time - key.time).abs();
        let first = others.partition_point(|other| other.time < key.time - near);
        let nearby = (first..others.len()).take_while(|other| distance(other) <= near);
        let nearby =
            nearby.filter(|&other| animation.replaces((from, key.time), others[other].time));
        nearby.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    };
    let replaced: HashSet<usize> = moved.iter().filter_map(replaced).collect();
    let others = others.iter().enumerate();
    let others = others.filter(|(other, _)| !replaced.contains(other));
    let mut all: Vec<(Key<T>, bool)> = others.map(|(_, key)| (Key::clone(key), false)).collect();
    all.extend(moved.into_iter().map(|(_, key)| (key, true)));
    all.sort_by(|(a, _), (b, _)| a.time.total_cmp(&b.time));
    let new = (0..all.len()).filter(|&index| all[index].1).collect();
    *keys = all.into_iter().map(|(key, _)| key).collect();
    new
}

#[cfg(test)]
mod tests;
