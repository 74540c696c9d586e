//! What can be done to keys: each gives a changed animation, for one step in the history.

use std::collections::BTreeSet;

use super::animation::{Animation, Key, Target, Track, Value};
use super::camera::Camera;

/// Keys nearer to each other than this share of a frame are one.
const SAME: f64 = 0.25;
/// Keys nearer to each other than this are at the same time, in seconds.
const EQUAL: f64 = 1e-6;

impl Animation {
    fn is_same_time(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < SAME / self.frames_per_second
    }

    /// Place of the key that counts as being at this time, the nearest, if there is one.
    fn place_at<T>(&self, keys: &[Key<T>], time: f64) -> Option<usize> {
        let off = |index: &usize| (keys[*index].time - time).abs();
        let near = (0..keys.len()).filter(|&index| self.is_same_time(keys[index].time, time));
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
        self.is_same_time(to, other) && (were_apart || (to - other).abs() < EQUAL)
    }

    /// With a camera key at this time, in place of one that is there; and its place.
    pub fn with_key(&self, time: f64, camera: Camera) -> (Self, usize) {
        let mut animation = self.clone();
        if let Some(index) = self.key_at(time) {
            animation.keys[index].value = camera;
            return (animation, index);
        }
        let index = self.keys.partition_point(|key| key.time < time);
        animation.keys.insert(index, Key::new(time, camera));
        (animation, index)
    }

    /// Without these camera keys.
    pub fn without_keys(&self, indices: &BTreeSet<usize>) -> Self {
        let kept = self.keys.iter().enumerate();
        let kept = kept.filter(|(index, _)| !indices.contains(index));
        Self {
            keys: kept.map(|(_, key)| key.clone()).collect(),
            ..self.clone()
        }
    }

    /// With these camera keys, or copies of them, so many seconds later; they replace what they
    /// land on, and none goes before the start. Also their new places.
    pub fn with_moved(
        &self,
        indices: &BTreeSet<usize>,
        later: f64,
        are_copies: bool,
    ) -> (Self, BTreeSet<usize>) {
        let moved = indices.iter().filter_map(|&index| self.keys.get(index));
        let first = moved
            .clone()
            .map(|key| key.time)
            .fold(f64::INFINITY, f64::min);
        let later = later.max(-first);
        let moved: Vec<Key<Camera>> = moved
            .map(|key| Key {
                time: key.time + later,
                ..key.clone()
            })
            .collect();
        // A copy was nowhere before.
        let from = |moved: &Key<Camera>| {
            if are_copies {
                f64::INFINITY
            } else {
                moved.time - later
            }
        };
        let others = self.keys.iter().enumerate();
        let others = others.filter(|(index, _)| are_copies || !indices.contains(index));
        let is_free = |key: &Key<Camera>| {
            !moved
                .iter()
                .any(|moved| self.replaces((from(moved), moved.time), key.time))
        };
        let others = others.map(|(_, key)| key).filter(|key| is_free(key));
        let mut keys: Vec<Key<Camera>> = others.cloned().chain(moved.iter().cloned()).collect();
        keys.sort_by(|a, b| a.time.total_cmp(&b.time));
        let is_moved = |key: &Key<Camera>| moved.iter().any(|moved| moved.time == key.time);
        let new = (0..keys.len())
            .filter(|&index| is_moved(&keys[index]))
            .collect();
        let animation = Self {
            keys,
            ..self.clone()
        };
        (animation, new)
    }

    /// With these camera keys changed.
    pub fn with_each(&self, indices: &BTreeSet<usize>, change: impl Fn(&mut Key<Camera>)) -> Self {
        let mut animation = self.clone();
        for &index in indices {
            if let Some(key) = animation.keys.get_mut(index) {
                change(key);
            }
        }
        animation
    }

    /// The track that moves something, if one does.
    pub fn track(&self, target: &Target) -> Option<&Track> {
        self.tracks.iter().find(|track| track.target == *target)
    }

    /// Place of the key that something has at this time, if it has one.
    pub fn value_at(&self, target: &Target, time: f64) -> Option<usize> {
        self.place_at(&self.track(target)?.keys, time)
    }

    /// With a key of a track at this time, in place of one that is there.
    pub fn with_value(&self, target: &Target, time: f64, value: Value) -> Self {
        let there = self.value_at(target, time);
        let mut animation = self.clone();
        let tracks = &mut animation.tracks;
        let index = tracks.iter().position(|track| track.target == *target);
        let index = index.unwrap_or_else(|| {
            tracks.push(Track {
                target: target.clone(),
                keys: Vec::new(),
            });
            tracks.len() - 1
        });
        let keys = &mut tracks[index].keys;
        if let Some(there) = there {
            keys[there].value = value;
        } else {
            let at = keys.partition_point(|key| key.time < time);
            keys.insert(at, Key::new(time, value));
        }
        animation
    }

    /// Without the key in this place of a track; without the track, if that was its last.
    pub fn without_value(&self, target: &Target, index: usize) -> Self {
        let mut animation = self.clone();
        for track in &mut animation.tracks {
            if track.target == *target && index < track.keys.len() {
                track.keys.remove(index);
            }
        }
        animation.tracks.retain(|track| !track.keys.is_empty());
        animation
    }

    /// With the key in this place of a track moved to another time; it replaces what it lands on.
    pub fn with_value_moved(&self, target: &Target, index: usize, to: f64) -> Self {
        let mut animation = self.clone();
        let tracks = &mut animation.tracks;
        let track = tracks.iter_mut().find(|track| track.target == *target);
        let Some(track) = track.filter(|track| index < track.keys.len()) else {
            return animation;
        };
        let key = track.keys.remove(index);
        let way = (key.time, to);
        track.keys.retain(|other| !self.replaces(way, other.time));
        let at = track.keys.partition_point(|key| key.time < to);
        track.keys.insert(at, Key { time: to, ..key });
        animation
    }

    /// With a copy of the key in this place of a track at another time; it replaces what it lands on.
    pub fn with_value_copied(&self, target: &Target, index: usize, to: f64) -> Self {
        let key = self.track(target).and_then(|track| track.keys.get(index));
        let Some(key) = key else { return self.clone() };
        let mut animation = self.with_value(target, to, key.value);
        let place = animation.value_at(target, to);
        let tracks = &mut animation.tracks;
        let track = tracks.iter_mut().find(|track| track.target == *target);
        if let Some((track, place)) = track.zip(place) {
            (track.keys[place].interpolation, track.keys[place].easing) =
                (key.interpolation, key.easing);
        }
        animation
    }

    /// What belongs to a light or object follows its new name, or goes with it.
    pub fn follow_name(&mut self, is_light: bool, name: &str, to: Option<&str>) {
        let is_meant = |target: &Target| {
            let lights = matches!(target, Target::LightIntensity(_) | Target::LightPosition(_));
            lights == is_light && target.owner() == Some(name)
        };
        match to {
            Some(to) => {
                let tracks = self.tracks.iter_mut();
                for track in tracks.filter(|track| is_meant(&track.target)) {
                    track.target = track.target.renamed(to);
                }
            }
            None => self.tracks.retain(|track| !is_meant(&track.target)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(animation: &Animation) -> Vec<f64> {
        let keys = animation.tracks[0].keys.iter();
        keys.map(|key| (key.time * 1e3).round() / 1e3).collect()
    }

    #[test]
    fn keys_beside_each_other_are_deleted_and_moved_one_by_one() {
        let target = Target::AmbientIntensity;
        let mut animation = Animation {
            frames_per_second: 10.0,
            ..Animation::default()
        };
        for time in [0.0, 1.0, 1.2, 1.4, 3.0] {
            animation = animation.with_value(&target, time, Value::Number(time / 10.0));
        }
        // In slower pictures, three of them are within a quarter of a frame.
        animation.frames_per_second = 1.0;
        assert_eq!(
            places(&animation.without_value(&target, 2)),
            [0.0, 1.0, 1.4, 3.0]
        );
        let moved = animation.with_value_moved(&target, 2, 2.0);
        assert_eq!(places(&moved), [0.0, 1.0, 1.4, 2.0, 3.0]);
        let moved = animation.with_value_moved(&target, 2, 2.9);
        assert_eq!(places(&moved), [0.0, 1.0, 1.4, 2.9], "onto the last");
        let copied = animation.with_value_copied(&target, 2, 2.0);
        assert_eq!(places(&copied), [0.0, 1.0, 1.2, 1.4, 2.0, 3.0]);
        assert_eq!(copied.tracks[0].keys[4].value, Value::Number(0.12));
        assert_eq!(animation.value_at(&target, 1.15), Some(2), "the nearest");
    }

    #[test]
    fn both_sides_of_a_jump_stay_two_keys() {
        let key = |time: f64| Key::new(time, Camera::default());
        let animation = Animation {
            frames_per_second: 10.0,
            keys: [0.0, 1.0, 1.02, 2.0].map(key).into(),
            ..Animation::default()
        };
        let one = BTreeSet::from([1]);
        for (later, are_copies, count) in [
            (0.01, false, 4),
            (0.02, false, 3),
            (1.0, false, 3),
            (0.01, true, 3),
        ] {
            let (moved, _) = animation.with_moved(&one, later, are_copies);
            assert_eq!(moved.keys.len(), count, "{later} {are_copies}");
        }
    }
}
