//! Validation of animations.

use std::collections::HashSet;

use super::camera::{check_camera, check_lens};
use super::place::{At, Check, no_such};
use crate::scene::animation::{
    Animation, FRAME_RATES, Interpolation, Key, MAX_KEYS, MAX_SECONDS, Take, Target, Track, Value,
};
use crate::scene::notation::format_number;
use crate::scene::shape::Shape;
use crate::scene::target::Owners;
use crate::scene::whole::Scene;

/// Smallest time between two keys, in seconds: slopes between them are still finite.
const MIN_GAP: f64 = 0.999_9e-6;

pub fn check_animation(at: &At, scene: &Scene) -> Check {
    let animation: &Animation = &scene.animation;
    let rate = at.field("frames_per_second");
    rate.within(animation.frames_per_second, FRAME_RATES)?;
    let list_at = at.field("keys");
    check_keys(&list_at, &animation.keys)?;
    for (index, key) in animation.keys.iter().enumerate() {
        check_camera(&list_at.index(index).field("value"), &key.value)?;
    }
    let list_at = at.field("tracks");
    let owners = Owners::of(scene, animation.targets());
    let mut known = HashSet::new();
    for (index, track) in animation.tracks.iter().enumerate() {
        let at = list_at.index(index);
        if !known.insert(&track.target) {
            let name = track.target.name();
            return at
                .field("target")
                .refuse(format!("there is another track for {name:?}"));
        }
        let Some(current) = owners.get(scene, &track.target) else {
            return at.field("target").refuse(no_owner(scene, &track.target));
        };
        check_track(&at, current, track)?;
    }
    match &animation.take {
        Some(take) => check_take(&at.field("take"), take),
        None => Ok(()),
    }
}

fn check_keys<T>(at: &At, keys: &[Key<T>]) -> Check {
    if keys.len() > MAX_KEYS {
        return at.refuse(format!("there may be at most {MAX_KEYS} keys"));
    }
    let mut last: Option<f64> = None;
    for (index, key) in keys.iter().enumerate() {
        let at = at.index(index);
        let time = at.field("time");
        time.within(key.time, 0.0..=MAX_SECONDS)?;
        if let Some(last) = last.filter(|last| key.time - last < MIN_GAP) {
            return time.refuse(format!(
                "keys must be in order of time, at least a microsecond apart: {} does not come after {}",
                format_number(key.time),
                format_number(last)
            ));
        }
        last = Some(key.time);
        if let Interpolation::Orbit { around } = key.interpolation {
            at.field("interpolation").field("around").point(around)?;
        }
    }
    Ok(())
}

/// Returns the message for a track whose target does not exist.
fn no_owner(scene: &Scene, target: &Target) -> String {
    let objects = scene.objects.iter();
    let lights = scene.lights.iter().map(|light| &*light.name);
    match target {
        // Every scene has an ambient intensity.
        Target::AmbientIntensity => String::new(),
        Target::LightIntensity(name) | Target::LightPosition(name) => {
            no_such("light", name, lights)
        }
        Target::ObjectPosition(name) => no_such("object", name, objects.map(|one| &*one.name)),
        Target::ObjectRotation(name) => {
            let meshes = objects.filter(|object| matches!(object.shape, Shape::Mesh(_)));
            no_such("mesh", name, meshes.map(|one| &*one.name))
        }
    }
}

fn check_track(at: &At, current: Value, track: &Track) -> Check {
    let at = at.field("keys");
    if track.keys.is_empty() {
        return at.refuse("a track needs at least one key".to_owned());
    }
    check_keys(&at, &track.keys)?;
    let what = match track.target {
        Target::AmbientIntensity | Target::LightIntensity(_) => "an intensity",
        Target::ObjectPosition(_) | Target::LightPosition(_) => "a position",
        Target::ObjectRotation(_) => "a rotation",
    };
    for (index, key) in track.keys.iter().enumerate() {
        let key_at = at.index(index);
        let is_orbit = matches!(key.interpolation, Interpolation::Orbit { .. });
        if is_orbit && !track.target.is_position() {
            let at = key_at.field("interpolation");
            return at.refuse(format!("{what} cannot orbit a point: use Smooth or Linear"));
        }
        let at = key_at.field("value");
        match (key.value, current) {
            (Value::Number(number), Value::Number(_)) => at.within(number, 0.0..=1.0)?,
            (Value::Point(point), Value::Point(_)) => at.point(point)?,
            (_, Value::Number(_)) => {
                return at.refuse(format!("{what} must be one number, 0–1"));
            }
            (_, Value::Point(_)) => {
                return at.refuse(format!("{what} must be three numbers such as (1, 2, 3)"));
            }
        }
    }
    Ok(())
}

fn check_take(at: &At, take: &Take) -> Check {
    let list_at = at.field("samples");
    if take.samples.is_empty() || take.samples.len() > MAX_KEYS {
        return list_at.refuse(format!("a take must have between 1 and {MAX_KEYS} samples"));
    }
    let mut last = -1.0;
    for (index, sample) in take.samples.iter().enumerate() {
        let at = list_at.index(index);
        at.index(0).within(sample.0, 0.0..=MAX_SECONDS)?;
        if sample.0 <= last {
            return at
                .index(0)
                .refuse("samples must be in order of time".to_owned());
        }
        last = sample.0;
        at.index(1).point(sample.1)?;
        at.finite(&[sample.2, sample.3, sample.4])?;
    }
    let list_at = at.field("lenses");
    let mut least_start = 0;
    for (index, lens) in take.lenses.iter().enumerate() {
        let at = list_at.index(index);
        if (index == 0 && lens.from != 0) || lens.from < least_start {
            return at
                .field("from")
                .refuse("lenses must start at sample 0 and be in order".to_owned());
        }
        if lens.from >= take.samples.len() {
            let most = take.samples.len() - 1;
            return at
                .field("from")
                .refuse(format!("the last sample of this take is {most}"));
        }
        least_start = lens.from + 1;
        check_lens(&at, lens.projection_distance, lens.orthographic_height)?;
    }
    if take.lenses.is_empty() {
        return list_at.refuse("a take needs a lens for its first sample".to_owned());
    }
    Ok(())
}
