//! What can be done to keys: each gives a changed animation, for one step in the history.

use std::collections::{BTreeSet, HashMap, HashSet};

use glam::DVec3;

use super::animation::{
    Animation, Easing, Interpolation, Key, MAX_SECONDS, Owner, SAME_TIME, Target, Track, Value,
};
use super::camera::Camera;

/// Keys nearer to each other than this share of a frame are one.
const SAME: f64 = 0.25;

/// Where a key is among all of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct KeyPlace {
    /// Place of the track that it belongs to; `None` for the camera.
    pub track: Option<usize>,
    /// Its place there, in order of time.
    pub index: usize,
}

/// Where several keys are.
pub type Keys = BTreeSet<KeyPlace>;
/// The way and the pace from a key to the next one.
pub type Pace = (Interpolation, Easing);

impl KeyPlace {
    /// That of a key of the camera.
    pub fn of_camera(index: usize) -> Self {
        Self { track: None, index }
    }
}

impl Animation {
    fn is_same_time(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < SAME / self.frames_per_second
    }

    /// Place of the key that counts as being at this time, the nearest, if there is one: those of a recorded flight are
    /// between frames, and the playhead is on one.
    fn place_at<T>(&self, keys: &[Key<T>], time: f64) -> Option<usize> {
        let off = |index: &usize| (keys[*index].time - time).abs();
        let near = (0..keys.len()).filter(|&index| self.is_near(keys[index].time, time));
        near.min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    /// Place of the camera key at this time, if there is one.
    pub fn key_at(&self, time: f64) -> Option<usize> {
        self.place_at(&self.keys, time)
    }

    /// Whether a key that is moved takes the place of another: where it comes to be near it. Those that were near
    /// each other before are two on purpose, as on both sides of a jump.
    fn replaces(&self, (from, to): (f64, f64), other: f64) -> bool {
        let were_apart = !self.is_same_time(from, other);
        self.is_near(to, other) && (were_apart || (to - other).abs() < SAME_TIME)
    }

    /// Whether times are of one frame, or nearly the same at the border between two.
    fn is_near(&self, a: f64, b: f64) -> bool {
        self.nearest_frame(a) == self.nearest_frame(b) || self.is_same_time(a, b)
    }

    /// With a camera key at this time, in place of one that is there; and its place.
    pub fn with_key(&self, time: f64, camera: Camera) -> (Self, usize) {
        let mut animation = self.clone();
        let index = put(&mut animation.keys, self.key_at(time), (time, camera));
        (animation, index)
    }

    /// Where all keys are, those of the camera first.
    pub fn places(&self) -> Keys {
        let tracks = self.tracks.iter().enumerate();
        let rows = tracks.map(|(track, own)| (Some(track), own.keys.len()));
        std::iter::once((None, self.keys.len()))
            .chain(rows)
            .flat_map(|(track, count)| (0..count).map(move |index| KeyPlace { track, index }))
            .collect()
    }

    /// Whether the same things have as many keys as in another animation.
    pub fn has_places_of(&self, other: &Self) -> bool {
        let is_same =
            |(a, b): (&Track, &Track)| a.target == b.target && a.keys.len() == b.keys.len();
        let are_as_many =
            self.keys.len() == other.keys.len() && self.tracks.len() == other.tracks.len();
        are_as_many && self.tracks.iter().zip(&other.tracks).all(is_same)
    }

    /// When the key in a place is, and how it goes on from there; `None` if there is no such key.
    pub fn at_place(&self, place: KeyPlace) -> Option<(f64, Pace)> {
        match place.track {
            None => self.keys.get(place.index).map(time_and_pace),
            Some(track) => {
                let keys = &self.tracks.get(track)?.keys;
                keys.get(place.index).map(time_and_pace)
            }
        }
    }

    /// What the key in a place is called.
    pub fn name_of(&self, KeyPlace { track, index }: KeyPlace) -> String {
        let number = index + 1;
        match track.and_then(|track| self.tracks.get(track)) {
            Some(track) => format!("{} key {number}", track.target.name()),
            None => format!("Key {number}"),
        }
    }

    /// Without these keys; without a track, if those were all it had.
    pub fn without_keys(&self, places: &Keys) -> Self {
        let mut animation = self.clone();
        retain_others(&mut animation.keys, None, places);
        for (track, own) in animation.tracks.iter_mut().enumerate() {
            retain_others(&mut own.keys, Some(track), places);
        }
        animation.tracks.retain(|track| !track.keys.is_empty());
        animation
    }

    /// When the first and the last of these keys are, in seconds from the start.
    pub fn span_of(&self, places: &Keys) -> Option<(f64, f64)> {
        let times = places.iter().filter_map(|place| self.at_place(*place));
        let spans = times.map(|(time, _)| (time, time));
        spans.reduce(|(first, last), (time, _)| (time.min(first), time.max(last)))
    }

    /// With these keys, or copies of them, so many seconds later; each replaces what it lands on, and none goes before
    /// the start or behind [`MAX_SECONDS`]. Also their new places.
    pub fn with_moved(&self, places: &Keys, later: f64, are_copies: bool) -> (Self, Keys) {
        let (first, last) = self.span_of(places).unwrap_or((0.0, MAX_SECONDS));
        let way = (later.clamp(-first, MAX_SECONDS - last), are_copies);
        let (mut animation, mut new) = (self.clone(), Keys::new());
        let mut note = |track, indices: Vec<usize>| {
            let place = |index| KeyPlace { track, index };
            new.extend(indices.into_iter().map(place));
        };
        let moved = indices(places, None);
        note(None, move_row(self, &mut animation.keys, &moved, way));
        for (track, own) in animation.tracks.iter_mut().enumerate() {
            let moved = indices(places, Some(track));
            note(Some(track), move_row(self, &mut own.keys, &moved, way));
        }
        (animation, new)
    }

    /// With the camera keys among these changed.
    pub fn with_each(&self, places: &Keys, change: impl Fn(&mut Key<Camera>)) -> Self {
        let mut animation = self.clone();
        for index in indices(places, None) {
            if let Some(key) = animation.keys.get_mut(index) {
                change(key);
            }
        }
        animation
    }

    /// With another way or pace from each of these keys.
    pub fn with_pace(&self, places: &Keys, change: impl Fn(&mut Pace)) -> Self {
        let mut animation = self.with_each(places, |key| set_pace(key, &change));
        for place in places {
            let track = place
                .track
                .and_then(|track| animation.tracks.get_mut(track));
            if let Some(key) = track.and_then(|track| track.keys.get_mut(place.index)) {
                set_pace(key, &change);
            }
        }
        animation
    }

    /// Place of the key that the track in a place has at this time, if it has one.
    pub fn value_at(&self, track: usize, time: f64) -> Option<KeyPlace> {
        let index = self.place_at(&self.tracks.get(track)?.keys, time)?;
        let track = Some(track);
        Some(KeyPlace { track, index })
    }

    /// Where the tracks are that move some of these, by what they move.
    pub fn track_places<'t>(
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

    /// With a key of a track at this time, in place of one that is there.
    pub fn with_value(&self, target: &Target, time: f64, value: Value) -> Self {
        self.with_values([(target, value)], time)
    }

    /// With keys of several tracks at this time; of each, in place of one that is there.
    pub fn with_values<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a Target, Value)>,
        time: f64,
    ) -> Self {
        let values: Vec<_> = values.into_iter().collect();
        let places = self.track_places(values.iter().map(|(target, _)| *target));
        let mut animation = self.clone();
        for (target, value) in values {
            let place = places.get(target).copied().unwrap_or_else(|| {
                animation.tracks.push(Track {
                    target: target.clone(),
                    keys: Vec::new(),
                });
                animation.tracks.len() - 1
            });
            animation.put_value(place, (time, value));
        }
        animation
    }

    /// Puts a key into the track in a place, instead of one that is there at this time.
    pub fn put_value(&mut self, track: usize, key: (f64, Value)) {
        let there = self.place_at(&self.tracks[track].keys, key.0);
        put(&mut self.tracks[track].keys, there, key);
    }

    /// What belongs to a light or object follows its new name.
    pub fn follow_name(&mut self, owner: Owner, to: &str) {
        let tracks = self.tracks.iter_mut();
        for track in tracks.filter(|track| track.target.owner() == Some(owner)) {
            track.target = track.target.renamed(to);
        }
    }

    /// What belongs to those that are gone goes, too.
    pub fn forget(&mut self, gone: &HashSet<Owner>) {
        let is_gone = |track: &Track| track.target.owner().is_some_and(|it| gone.contains(&it));
        self.tracks.retain(|track| !is_gone(track));
    }
}

impl Track {
    /// The same for a copy of what it moves, of another name, so far from it.
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

    /// Moves the points of all keys, and what they go around.
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

/// Puts a value at a time: in place of that of a key which is there, or as a new key. Its place. The way between two keys
/// stays what it was when there is one more on it: a cut is a cut, and a circle goes on.
fn put<T>(keys: &mut Vec<Key<T>>, there: Option<usize>, (time, value): (f64, T)) -> usize {
    if let Some(there) = there {
        keys[there].value = value;
        let is_behind = |before: &Key<T>| before.time + SAME_TIME < time;
        let is_before = |next: &Key<T>| time + SAME_TIME < next.time;
        let (before, others) = keys.split_at_mut(there);
        // At that time it is seen as it is put there, not only nearly.
        if before.last().is_none_or(is_behind) && others.get(1).is_none_or(is_before) {
            others[0].time = time;
        }
        return there;
    }
    let at = keys.partition_point(|key| key.time < time);
    let mut key = Key::new(time, value);
    if (1..keys.len()).contains(&at) {
        key.interpolation = keys[at - 1].interpolation;
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

/// Those of the places that are in one row, in order.
fn indices(places: &Keys, track: Option<usize>) -> Vec<usize> {
    let place = |index| KeyPlace { track, index };
    let own = places.range(place(0)..=place(usize::MAX));
    own.map(|place| place.index).collect()
}

fn retain_others<T>(keys: &mut Vec<Key<T>>, track: Option<usize>, places: &Keys) {
    let mut index = 0;
    keys.retain(|_| {
        let place = KeyPlace { track, index };
        index += 1;
        !places.contains(&place)
    });
}

/// Moves the keys of a row that are in these places, in order, or copies of them, so many seconds; their new places.
fn move_row<T: Clone>(
    animation: &Animation,
    keys: &mut Vec<Key<T>>,
    indices: &[usize],
    (later, are_copies): (f64, bool),
) -> Vec<usize> {
    let moved = indices.iter().filter_map(|&index| keys.get(index));
    let moved: Vec<Key<T>> = moved
        .map(|key| Key {
            time: key.time + later,
            ..key.clone()
        })
        .collect();
    if moved.is_empty() {
        return Vec::new();
    }
    let others = keys.iter().enumerate();
    let others = others.filter(|(index, _)| are_copies || indices.binary_search(index).is_err());
    let others: Vec<&Key<T>> = others.map(|(_, key)| key).collect();
    let near = 1.0 / animation.frames_per_second;
    // The nearest of those that a key might replace: recorded keys may be much closer together than frames.
    let replaced = |key: &Key<T>| {
        // A copy was nowhere before.
        let from = if are_copies {
            f64::INFINITY
        } else {
            key.time - later
        };
        let off = |other: &usize| (others[*other].time - key.time).abs();
        let first = others.partition_point(|other| other.time < key.time - near);
        let close = (first..others.len()).take_while(|other| off(other) <= near);
        let close = close.filter(|&other| animation.replaces((from, key.time), others[other].time));
        close.min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    let replaced: HashSet<usize> = moved.iter().filter_map(replaced).collect();
    let others = others.iter().enumerate();
    let others = others.filter(|(other, _)| !replaced.contains(other));
    let mut all: Vec<(Key<T>, bool)> = others.map(|(_, key)| (Key::clone(key), false)).collect();
    all.extend(moved.iter().map(|key| (key.clone(), true)));
    all.sort_by(|(a, _), (b, _)| a.time.total_cmp(&b.time));
    let new = (0..all.len()).filter(|&index| all[index].1).collect();
    *keys = all.into_iter().map(|(key, _)| key).collect();
    new
}

#[cfg(test)]
mod tests;
