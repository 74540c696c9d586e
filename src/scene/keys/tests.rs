use super::*;

/// Returns the times of the keys of the only track.
fn times(animation: &Animation) -> Vec<f64> {
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
    // At this low frame rate, three successive keys are less than a quarter of a frame apart.
    animation.frames_per_second = 1.0;
    let track = Some(0);
    let third = KeyId { track, index: 2 };
    let one = Keys::from([third]);
    let without = animation.without_keys(&one);
    assert_eq!(times(&without), [0.0, 1.0, 1.4, 3.0]);
    let (moved, new) = animation.with_moved(&one, 0.8, false);
    assert_eq!(times(&moved), [0.0, 1.0, 1.4, 2.0, 3.0]);
    assert_eq!(new, [KeyId { track, index: 3 }].into());
    let (moved, _) = animation.with_moved(&one, 1.7, false);
    assert_eq!(times(&moved), [0.0, 1.0, 1.4, 2.9], "onto the last");
    let (copied, new) = animation.with_moved(&one, 0.8, true);
    assert_eq!(times(&copied), [0.0, 1.0, 1.2, 1.4, 2.0, 3.0]);
    assert_eq!(copied.tracks[0].keys[4].value, Value::Number(0.12));
    assert_eq!(new, [KeyId { track, index: 4 }].into());
    let nearest = animation.value_at(0, 1.15);
    assert_eq!(nearest, Some(third));
    let none = animation.without_keys(&animation.all_keys());
    assert!(none.is_still());
}

#[test]
fn keys_are_stretched_from_the_first_of_them_on() {
    let target = Target::AmbientIntensity;
    let mut animation = Animation::default();
    for time in [0.0, 1.0, 1.5, 3.0, 6.0] {
        animation = animation.with_value(&target, time, Value::Number(time / 10.0));
    }
    let key = |index| KeyId {
        track: Some(0),
        index,
    };
    let three: Keys = (1..4).map(key).collect();
    let (stretched, new) = animation.with_stretched(&three, 4.0);
    assert_eq!(times(&stretched), [0.0, 1.0, 2.0, 5.0, 6.0]);
    assert_eq!(new, three);
    let (onto_the_last, new) = animation.with_stretched(&three, 5.0);
    assert_eq!(times(&onto_the_last), [0.0, 1.0, 2.25, 6.0]);
    assert_eq!(new, three);
    assert_eq!(onto_the_last.tracks[0].keys[3].value, Value::Number(0.3));
    let (shrunk, _) = animation.with_stretched(&three, 1.0);
    assert_eq!(times(&shrunk), [0.0, 1.0, 1.25, 2.0, 6.0]);
    let (longest, _) = animation.with_stretched(&three, 2.0 * MAX_SECONDS);
    assert_eq!(times(&longest).last(), Some(&MAX_SECONDS));
    let (alone, new) = animation.with_stretched(&[key(2)].into(), 4.0);
    assert_eq!((alone, new), (animation, [key(2)].into()));
}

#[test]
fn keys_of_the_camera_and_of_values_are_moved_and_paced_together() {
    let camera = |time: f64| Key::new(time, Camera::default());
    let animation = Animation {
        frames_per_second: 10.0,
        keys: [1.0, 2.0].map(camera).into(),
        ..Animation::default()
    };
    let target = Target::AmbientIntensity;
    let animation = animation.with_value(&target, 0.5, Value::Number(0.3));
    let animation = animation.with_value(&target, 4.0, Value::Number(0.4));
    let places: Keys = animation.all_keys().into_iter().take(3).collect();
    // All keys move by the same amount, so that none is before the start.
    let (moved, new) = animation.with_moved(&places, -2.0, false);
    assert_eq!(new, places);
    let of_camera: Vec<f64> = moved.keys.iter().map(|key| key.time).collect();
    assert_eq!((of_camera, times(&moved)), (vec![0.5, 1.5], vec![0.0, 4.0]));
    let paced = animation.with_pace(&places, |(way, _)| *way = Interpolation::Hold);
    let there = |place| paced.time_and_pace_of(place);
    let held = paced.all_keys().into_iter().filter_map(there);
    let held = held.filter(|(_, (way, _))| *way == Interpolation::Hold);
    let held: Vec<f64> = held.map(|(time, _)| time).collect();
    assert_eq!(held, [1.0, 2.0, 0.5]);
}

#[test]
fn a_key_among_many_takes_the_place_of_one() {
    let key = |time: f64| Key::new(time, Camera::default());
    let animation = Animation {
        frames_per_second: 5.0,
        keys: [0.0, 1.0, 1.02, 1.04, 3.0].map(key).into(),
        ..Animation::default()
    };
    let last = Keys::from([KeyId::of_camera(4)]);
    let (moved, new) = animation.with_moved(&last, -1.975, false);
    let times: Vec<f64> = moved.keys.iter().map(|key| key.time).collect();
    assert_eq!(times, [0.0, 1.0, 1.025, 1.04]);
    assert_eq!(new, [KeyId::of_camera(2)].into());
}

#[test]
fn a_key_between_two_others_keeps_the_way_between_them() {
    let around = DVec3::X;
    for way in [Interpolation::Hold, Interpolation::Orbit { around }] {
        let mut animation = Animation::default();
        for time in [0.0, 2.0] {
            animation = animation.with_key(time, Camera::default()).0;
        }
        animation.keys[0].interpolation = way;
        for time in [1.0, 3.0, 0.0] {
            animation = animation.with_key(time, Camera::default()).0;
        }
        let ways: Vec<_> = animation.keys.iter().map(|key| key.interpolation).collect();
        let smooth = Interpolation::Smooth;
        assert_eq!(ways, [way, way, smooth, smooth]);
    }
}

#[test]
fn both_sides_of_a_jump_stay_two_keys() {
    let key = |time: f64| Key::new(time, Camera::default());
    let animation = Animation {
        frames_per_second: 10.0,
        keys: [0.0, 1.0, 1.02, 2.0].map(key).into(),
        ..Animation::default()
    };
    let one = Keys::from([KeyId::of_camera(1)]);
    for (later, are_copies, count) in [
        (0.01, false, 4),
        (0.02, false, 3),
        (1.0, false, 3),
        (0.01, true, 4),
    ] {
        let (moved, _) = animation.with_moved(&one, later, are_copies);
        assert_eq!(moved.keys.len(), count, "{later} {are_copies}");
    }
}

#[test]
fn a_key_set_on_an_eased_way_shares_the_easing() {
    let target = Target::AmbientIntensity;
    let ends = Animation::default().with_value(&target, 0.0, Value::Number(0.0));
    let ends = ends.with_value(&target, 2.0, Value::Number(1.0));
    for (easing, expected) in [
        (Easing::Even, (Easing::Even, Easing::Even)),
        (Easing::In, (Easing::In, Easing::Even)),
        (Easing::Out, (Easing::Even, Easing::Out)),
        (Easing::InOut, (Easing::In, Easing::Out)),
    ] {
        let eased = ends.with_pace(&ends.all_keys(), |(_, each)| *each = easing);
        let between = eased.with_value(&target, 1.0, Value::Number(0.5));
        let keys = &between.tracks[0].keys;
        assert_eq!((keys[0].easing, keys[1].easing), expected);
    }
}

#[test]
fn only_keys_that_orbit_have_an_axis() {
    let ways = [
        Interpolation::Hold,
        Interpolation::Orbit { around: DVec3::X },
        Interpolation::Linear,
    ];
    let key = |(time, interpolation): (usize, Interpolation)| Key {
        interpolation,
        ..Key::new(time as f64, Camera::default())
    };
    let animation = Animation {
        keys: ways.into_iter().enumerate().map(key).collect(),
        ..Animation::default()
    };
    let orbiting = animation.orbiting(&animation.all_keys());
    assert_eq!(orbiting, Keys::from([KeyId::of_camera(1)]));
}
