//! What can be done to keys: each gives a changed animation, for one step in the history.

use std::collections::BTreeSet;

use super::animation::{Animation, Key, Target, Track, Value};
use super::camera::Camera;

/// Keys nearer to each other than this share of a frame are one.
const SAME: f64 = 0.25;

impl Animation {
    fn is_same_time(&self, a: f64, b: f64) -> bool {
        (a - b).abs() < SAME / self.frames_per_second
    }

    /// Place of the camera key at this time, if there is one.
    pub fn key_at(&self, time: f64) -> Option<usize> {
        let mut keys = self.keys.iter();
        keys.position(|key| self.is_same_time(key.time, time))
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
        let others = self.keys.iter().enumerate();
        let others = others.filter(|(index, _)| are_copies || !indices.contains(index));
        let is_free = |key: &Key<Camera>| {
            !moved
                .iter()
                .any(|moved| self.is_same_time(moved.time, key.time))
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

    /// Whether something has a key of its own at this time.
    pub fn has_value(&self, target: &Target, time: f64) -> bool {
        self.track(target).is_some_and(|track| {
            let mut keys = track.keys.iter();
            keys.any(|key| self.is_same_time(key.time, time))
        })
    }

    /// With a key of a track at this time, in place of one that is there.
    pub fn with_value(&self, target: &Target, time: f64, value: Value) -> Self {
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
        let there = keys
            .iter_mut()
            .find(|key| self.is_same_time(key.time, time));
        if let Some(key) = there {
            key.value = value;
        } else {
            let at = keys.partition_point(|key| key.time < time);
            keys.insert(at, Key::new(time, value));
        }
        animation
    }

    /// Without the key that a track has at this time; without the track, if that was its last.
    pub fn without_value(&self, target: &Target, time: f64) -> Self {
        let mut animation = self.clone();
        for track in &mut animation.tracks {
            if track.target == *target {
                track.keys.retain(|key| !self.is_same_time(key.time, time));
            }
        }
        animation.tracks.retain(|track| !track.keys.is_empty());
        animation
    }

    /// With the key that a track has at one time moved to another; it replaces what it lands on.
    pub fn with_value_moved(&self, target: &Target, from: f64, to: f64) -> Self {
        let key = self.track(target).and_then(|track| {
            let mut keys = track.keys.iter();
            keys.find(|key| self.is_same_time(key.time, from))
        });
        let Some(key) = key else {
            return self.clone();
        };
        let mut animation = self.clone();
        for track in &mut animation.tracks {
            if track.target == *target {
                track.keys.retain(|other| {
                    !self.is_same_time(other.time, from) && !self.is_same_time(other.time, to)
                });
                let at = track.keys.partition_point(|key| key.time < to);
                let moved = Key {
                    time: to,
                    ..key.clone()
                };
                track.keys.insert(at, moved);
            }
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
