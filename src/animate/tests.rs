//! Paths where naive ones fail: duplicates, reversals, uneven spacing, opposite directions, poles.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::lanes::Vec3;
use crate::scene::{
    Animation, Camera, Document, Easing, Interpolation, Key, Orientation, Projection, Scene, Take,
    Target, Track, Value,
};

fn camera(position: Vec3<f64>, yaw: f64, pitch: f64) -> Camera {
    let angles = Orientation {
        yaw: yaw.to_radians(),
        pitch: pitch.to_radians(),
        roll: 0.0,
    };
    angles.apply(&Camera {
        position,
        ..Camera::default()
    })
}

fn on_x(places: &[(f64, f64)]) -> CameraPath {
    let key = |&(time, x): &(f64, f64)| Key::new(time, camera(Vec3::new(x, 0.0, 0.0), 0.0, 0.0));
    CameraPath::new(&places.iter().map(key).collect::<Vec<_>>())
}

fn at(path: &CameraPath, time: f64) -> Camera {
    path.at(time).expect("a camera")
}

/// Times at even steps from the first key to the last.
fn times(path: &CameraPath, steps: u32) -> Vec<f64> {
    let (first, last) = (path.keys()[0].time, path.keys().last().expect("a key").time);
    let time = |n| first + (last - first) * f64::from(n) / f64::from(steps);
    (0..=steps).map(time).collect()
}

#[test]
fn no_key_and_one_key_are_no_flight() {
    assert_eq!(CameraPath::new(&[]).at(1.0), None);
    let one = on_x(&[(2.0, 5.0)]);
    for time in [-1.0, 0.0, 2.0, 9.0] {
        assert_eq!(at(&one, time), one.keys()[0].value);
    }
}

#[test]
fn a_key_is_met_exactly() {
    let path = on_x(&[(0.0, 0.1), (0.3, 7.7), (1.1, 7.7), (1.7, -3.3)]);
    for key in path.keys() {
        assert_eq!(at(&path, key.time), key.value);
    }
}

#[test]
fn nothing_overshoots() {
    for places in [
        // 100 : 1 spacing in space, then in time, a reversal, and a rest.
        vec![(0.0, 0.0), (1.0, 100.0), (2.0, 101.0), (3.0, 102.0)],
        vec![(0.0, 0.0), (10.0, 1.0), (10.1, 2.0), (10.2, 3.0)],
        vec![(0.0, 0.0), (1.0, 10.0), (2.0, 0.0), (3.0, 10.0)],
        vec![(0.0, 0.0), (1.0, 10.0), (3.0, 10.0), (4.0, 0.0)],
    ] {
        let path = on_x(&places);
        for pair in places.windows(2) {
            let (low, high) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
            for n in 0..=200 {
                let time = pair[0].0 + (pair[1].0 - pair[0].0) * f64::from(n) / 200.0;
                let x = at(&path, time).position.x;
                assert!(
                    (low - 1e-9..=high + 1e-9).contains(&x),
                    "{x} at {time} of {places:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_held_stays_still_bit_by_bit() {
    let mut keys = on_x(&[(0.0, 0.3), (1.0, 7.7), (2.5, 7.7), (4.0, 1.0)])
        .keys()
        .to_vec();
    keys[1].value = camera(Vec3::new(7.7, 0.0, 0.0), 33.3, 12.1);
    keys[2].value = keys[1].value.clone();
    let path = CameraPath::new(&keys);
    for n in 0..=150 {
        assert_eq!(at(&path, 1.0 + f64::from(n) / 100.0), keys[1].value);
    }
}

#[test]
fn turns_take_the_shorter_way_at_an_even_pace() {
    let turn = |from: f64, to: f64| {
        let here = Vec3::splat(0.0);
        let keys = [
            Key::new(0.0, camera(here, from, 0.0)),
            Key::new(1.0, camera(here, to, 0.0)),
        ];
        let path = CameraPath::new(&keys);
        let cameras: Vec<Camera> = times(&path, 100).iter().map(|&t| at(&path, t)).collect();
        let steps: Vec<f64> = cameras
            .windows(2)
            .map(|pair| motion_between(&pair[0], &pair[1]).turn)
            .collect();
        let sum: f64 = steps.iter().sum();
        let worst = steps.iter().copied().fold(0.0, f64::max);
        assert!(
            worst <= 2.0 * sum / 100.0,
            "{from}° to {to}°: a step of {worst}°"
        );
        sum
    };
    assert!((turn(179.0, -179.0) - 2.0).abs() < 1e-9);
    assert!((turn(-179.0, 179.0) - 2.0).abs() < 1e-9);
    // Opposite directions, exactly and nearly.
    for off in [0.0, 1e-9, 1e-3] {
        assert!((turn(0.0, 180.0 - off) - (180.0 - off)).abs() < 1e-6);
    }
    assert_eq!(turn(90.0, 90.0), 0.0);
}

#[test]
fn a_camera_that_tips_over_the_top_keeps_its_basis() {
    let here = Vec3::splat(0.0);
    let keys = [
        Key::new(0.0, camera(here, 0.0, 89.99)),
        Key::new(1.0, camera(here, 120.0, 90.0)),
        Key::new(2.0, camera(here, -60.0, -90.0)),
    ];
    let path = CameraPath::new(&keys);
    for time in times(&path, 500) {
        let basis = at(&path, time).basis().expect("a basis");
        assert!(basis.u.dot(basis.w).abs() < 1e-6);
    }
}

#[test]
fn a_turntable_is_a_circle_that_looks_at_its_middle() {
    let target = Vec3::new(10.0, 20.0, -30.0);
    let start = camera(Vec3::new(100.0, 60.0, 5.0), 10.0, 0.0);
    let path = CameraPath::new(&Preset::Turntable.keys(&start, target, 8.0));
    let radius = (start.position - target).length();
    for time in times(&path, 997) {
        let camera = at(&path, time);
        let arm = camera.position - target;
        assert!((arm.length() / radius - 1.0).abs() < 1e-12);
        let look = camera.look_at.unit().expect("a direction");
        assert!((look + arm * (1.0 / radius)).length() < 1e-9);
    }
    assert_eq!(at(&path, 8.0).position, at(&path, 0.0).position);
}

#[test]
fn every_preset_starts_where_the_camera_is_and_looks_at_the_target() {
    let target = Vec3::new(1.0, 2.0, 3.0);
    for preset in Preset::ALL {
        // From straight above there is no level direction to the target; it must still be a path.
        for place in [
            Vec3::new(30.0, 10.0, -4.0),
            target + Vec3::new(0.0, 5.0, 0.0),
            target,
        ] {
            let start = camera(place, 0.0, 0.0);
            let keys = preset.keys(&start, target, 4.0);
            assert!((keys[0].value.position - place).length() < 1e-12);
            let mut scene = Scene::demo();
            scene.animation.keys = keys;
            assert_eq!(
                crate::scene::check(&scene),
                Ok(()),
                "{preset:?} from {place:?}"
            );
        }
    }
    // The splines of the round ones do not wobble.
    let start = camera(Vec3::new(50.0, 0.0, 0.0), 0.0, 0.0);
    let path = CameraPath::new(&Preset::Ellipse.keys(&start, Vec3::splat(0.0), 4.0));
    for time in times(&path, 500) {
        let position = at(&path, time).position;
        let round = (position.x / 50.0).hypot(position.z / (50.0 * 1.6));
        assert!((round - 1.0).abs() < 3e-4, "{round} at {time}");
    }
}

#[test]
fn a_round_goes_on_at_its_seam_as_anywhere_else() {
    let start = camera(Vec3::new(50.0, 0.0, 0.0), 0.0, 0.0);
    let path = CameraPath::new(&Preset::Ellipse.keys(&start, Vec3::splat(0.0), 4.0));
    let step = 1e-4;
    let motion = |a: f64, b: f64| at(&path, b).position - at(&path, a).position;
    let (out, back) = (motion(0.0, step), motion(4.0 - step, 4.0));
    assert!(
        (out - back).length() < 0.01 * out.length(),
        "{out:?} {back:?}"
    );
}

#[test]
fn cuts_hold_and_cameras_change_at_them() {
    let mut keys = on_x(&[(0.0, 0.0), (1.0, 10.0), (2.0, 20.0)])
        .keys()
        .to_vec();
    keys[0].interpolation = Interpolation::Hold;
    keys[1].value.projection = Projection::Orthographic;
    let path = CameraPath::new(&keys);
    assert_eq!(at(&path, 0.999_999), keys[0].value);
    assert_eq!(at(&path, 1.0), keys[1].value);
    assert_eq!(at(&path, 1.5).projection, Projection::Orthographic);
}

#[test]
fn zoom_is_even_in_the_logarithm() {
    let here = camera(Vec3::splat(0.0), 0.0, 0.0);
    let zoomed = |distance: f64| Camera {
        projection_distance: distance,
        ..here.clone()
    };
    let path = CameraPath::new(&[Key::new(0.0, zoomed(0.5)), Key::new(2.0, zoomed(8.0))]);
    assert!((at(&path, 1.0).projection_distance - 2.0).abs() < 1e-12);
}

#[test]
fn easing_starts_and_ends_slowly() {
    let mut keys = on_x(&[(0.0, 0.0), (1.0, 1.0)]).keys().to_vec();
    let mut x = |easing: Easing, time: f64| {
        keys[0].easing = easing;
        at(&CameraPath::new(&keys), time).position.x
    };
    assert!((x(Easing::Even, 0.25) - 0.25).abs() < 1e-12);
    assert!((x(Easing::In, 0.25) - 0.0625).abs() < 1e-12);
    assert!((x(Easing::Out, 0.25) - 0.4375).abs() < 1e-12);
    assert!((x(Easing::InOut, 0.25) - 0.15625).abs() < 1e-12);
    assert!((x(Easing::InOut, 0.5) - 0.5).abs() < 1e-12);
}

/// A flight by hand: uneven times, pauses, a wobble.
fn take() -> Take {
    let mut take = Take::default();
    let mut time: f64 = 0.0;
    for n in 0..240_u32 {
        let share = time / 5.7;
        let place = Vec3::new(
            share * 90.0,
            (share * 5.0).sin() * 10.0,
            40.0 - share * 30.0,
        );
        let angles = Orientation {
            yaw: (share * 3.0).sin() * 0.8,
            pitch: -0.3 + share * 0.2,
            roll: 0.0,
        };
        let camera = angles.apply(&Camera {
            position: place,
            ..Camera::default()
        });
        take.push(time, &camera, angles);
        time += 0.016 + 0.004 * f64::from(n % 5);
    }
    take
}

/// What every sample sees: a grid of points 60 ahead.
fn seen(take: &Take) -> Vec<Vec<Seen>> {
    let of = |sample: usize| {
        let camera = take.camera(sample).expect("a sample");
        let framing = camera.framing().expect("a basis");
        let place = |n: u32| {
            let at = [f64::from(n % 3) * 0.4 - 0.4, f64::from(n / 3) * 0.4 - 0.4];
            let (origin, direction) = framing.ray(at);
            Seen {
                at,
                what: origin + direction * 60.0,
                is_sky: false,
            }
        };
        (0..9).map(place).collect()
    };
    (0..take.samples.len()).map(of).collect()
}

#[test]
fn a_take_becomes_few_keys_within_its_tolerance() {
    let take = take();
    let seen = seen(&take);
    let mut last = usize::MAX;
    for pixels in [0.5, 2.0, 10.0, 60.0] {
        let tolerance = pixels / 1024.0;
        let simplified = simplify(&take, &seen, tolerance);
        let count = simplified.keys.len();
        assert!(
            simplified.worst <= tolerance,
            "{} of {tolerance}",
            simplified.worst
        );
        assert!(
            count <= last,
            "{count} keys at {pixels} pixels, {last} before"
        );
        last = count;
    }
    assert!((2..=5).contains(&last), "{last} keys at 60 pixels");
    let fine = simplify(&take, &seen, 0.5 / 1024.0).keys.len();
    assert!((6..=40).contains(&fine), "{fine} keys at half a pixel");
}

#[test]
fn a_take_is_replayed_bit_by_bit_from_its_file() {
    let take = take();
    let mut scene = Scene::demo();
    scene.animation.take = Some(Arc::new(take.clone()));
    let key = |n: usize| Key::new(take.samples[n].0, take.camera(n).expect("a sample"));
    scene.animation.keys = (0..take.samples.len()).map(key).collect();
    let text = Document {
        header: String::new(),
        scene,
    };
    let text = text.to_text().expect("writable");
    let read = Document::from_text(&text).expect("readable").scene;
    assert_eq!(read.animation.take.as_deref(), Some(&take));
    let path = CameraPath::new(&read.animation.keys);
    for (n, sample) in take.samples.iter().enumerate() {
        assert_eq!(path.at(sample.0), take.camera(n));
    }
    let bytes = text.split("take:").nth(1).expect("a take").len();
    assert!(bytes < 100 * take.samples.len(), "{bytes} bytes");
}

#[test]
fn a_changed_projection_is_a_cut_in_the_keys() {
    let mut take = Take::default();
    for n in 0..20_u32 {
        let projection = if n < 11 {
            Projection::Perspective
        } else {
            Projection::Orthographic
        };
        let camera = Camera {
            projection,
            ..camera(Vec3::new(f64::from(n), 0.0, 0.0), 0.0, 0.0)
        };
        take.push(f64::from(n) / 10.0, &camera, Orientation::of(&camera));
    }
    assert_eq!(take.lenses.len(), 2);
    let keys = simplify(&take, &seen(&take), 1e-3).keys;
    let path = CameraPath::new(&keys);
    for n in 0..20 {
        let was = take.camera(n).expect("a sample").projection;
        assert_eq!(at(&path, take.samples[n].0).projection, was, "sample {n}");
    }
}

#[test]
fn constant_speed_is_constant_and_takes_as_long() {
    let path = on_x(&[(0.0, 0.0), (1.0, 50.0), (4.0, 60.0), (5.0, 200.0)]);
    let even = CameraPath::new(&Retime::ConstantSpeed.apply(path.keys()));
    assert!((even.keys()[3].time - 5.0).abs() < 1e-9);
    for time in times(&even, 50) {
        let x = at(&even, time).position.x;
        assert!((x - 40.0 * time).abs() < 0.5, "{x} at {time}");
    }
    // Turns alone have a speed too.
    let here = Vec3::splat(0.0);
    let turns = [(0.0, 0.0), (1.0, 90.0), (9.0, 100.0)];
    let key = |&(time, yaw): &(f64, f64)| Key::new(time, camera(here, yaw, 0.0));
    let keys = Retime::ConstantSpeed.apply(&turns.iter().map(key).collect::<Vec<_>>());
    assert!((keys[1].time - 8.1).abs() < 0.05, "{}", keys[1].time);
}

#[test]
fn pauses_are_trimmed_and_flights_stretched() {
    let path = on_x(&[(0.0, 0.0), (1.0, 50.0), (4.0, 50.0), (5.0, 90.0)]);
    assert_eq!(paused_seconds(path.keys()), 3.0);
    let trimmed = Retime::TrimPauses.apply(path.keys());
    let times: Vec<f64> = trimmed.iter().map(|key| key.time).collect();
    assert_eq!(times, [0.0, 1.0, 2.0]);
    let longer = Retime::Stretch(10.0).apply(path.keys());
    assert_eq!(longer[2].time, 8.0);
    assert_eq!(longer[3].value, path.keys()[3].value);
}

#[test]
fn smoothing_takes_corners_off_and_keeps_the_ends() {
    let path = on_x(&[(0.0, 0.0), (1.0, 30.0), (2.0, 20.0), (3.0, 30.0)]);
    let smooth = Retime::Smooth.apply(path.keys());
    let x: Vec<f64> = smooth.iter().map(|key| key.value.position.x).collect();
    assert_eq!(x, [0.0, 20.0, 25.0, 30.0]);
}

#[test]
fn paths_survive_their_texts() {
    let keys = simplify(&take(), &seen(&take()), 1e-3).keys;
    assert_eq!(
        from_text(&to_text(&keys).expect("a text")).as_ref(),
        Ok(&keys)
    );
    let table = to_table(keys.iter().map(|key| (key.time, &key.value)));
    let read = from_table(&table, &Camera::default()).expect("a table");
    for (was, is) in keys.iter().zip(&read) {
        assert_eq!(was.time, is.time);
        assert_eq!(was.value.position, is.value.position);
        assert!((was.value.look_at - is.value.look_at).length() < 1e-12);
    }
    let few = from_table("x,time, y,z\n1,0,2,3\n", &Camera::default()).expect("a table");
    assert_eq!(few[0].value.position, Vec3::new(1.0, 2.0, 3.0));
    let error = from_table("time,x,y,z\n0,1,2,3\n1,1,oops,3\n", &Camera::default());
    assert_eq!(
        error.expect_err("bad").to_string(),
        "line 3: y must be a number, found \"oops\""
    );
    assert!(from_table("time,x,y\n", &Camera::default()).is_err());
    assert_eq!(from_text("[\nKey(time: 0)]").expect_err("bad").line, 2);
}

#[test]
fn tracks_move_lights_objects_and_the_ambience() {
    let mut scene = Scene::demo();
    let light = scene.lights[0].name.clone();
    let triangle = scene.objects.last().expect("objects").name.clone();
    let track = |target: Target, values: [Value; 2]| Track {
        target,
        keys: vec![Key::new(1.0, values[0]), Key::new(3.0, values[1])],
    };
    let (from, to) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(5.0, 2.0, -3.0));
    scene.animation.tracks = vec![
        track(
            Target::AmbientIntensity,
            [Value::Number(0.1), Value::Number(0.5)],
        ),
        track(
            Target::LightIntensity(light.clone()),
            [Value::Number(0.0), Value::Number(1.0)],
        ),
        track(
            Target::LightPosition(light),
            [Value::Point(from), Value::Point(to)],
        ),
        track(
            Target::ObjectPosition(triangle),
            [Value::Point(from), Value::Point(to)],
        ),
    ];
    assert_eq!(crate::scene::check(&scene), Ok(()));
    let shape = scene.objects.last().expect("objects").shape.clone();
    let scene = Arc::new(scene);
    let path = CameraPath::new(&[]);
    let half = shot(&scene, &path, 2.0);
    assert!((half.ambient_intensity - 0.3).abs() < 1e-12);
    assert!((half.lights[0].intensity - 0.5).abs() < 1e-12);
    assert!((half.lights[0].position - Vec3::new(3.0, 2.0, 0.0)).length() < 1e-9);
    let moved = &half.objects.last().expect("objects").shape;
    assert_eq!(moved.kind(), shape.kind());
    assert!((moved.position() - Vec3::new(3.0, 2.0, 0.0)).length() < 1e-9);
    assert_eq!(
        shot(&scene, &path, 0.0).lights[0].position,
        from,
        "before the first key"
    );
    assert_eq!(half.camera, scene.camera, "no camera keys, no other camera");
}

#[test]
fn frames_do_not_bend_the_curve() {
    let animation = |fps: f64| Animation {
        frames_per_second: fps,
        keys: on_x(&[(0.0, 0.0), (1.0, 7.0), (3.0, 1.0)]).keys().to_vec(),
        ..Animation::default()
    };
    let (slow, fast) = (animation(7.0), animation(21.0));
    assert_eq!((slow.frame_count(), fast.frame_count()), (22, 64));
    for frame in 1..=slow.frame_count() {
        let time = slow.time_of(frame);
        assert_eq!(slow.frame_at(time), frame);
        assert!((fast.time_of(frame * 3 - 2) - time).abs() < 1e-12);
    }
}

fn any_keys() -> impl Strategy<Value = Vec<Key<Camera>>> {
    let part = prop_oneof![Just(0.0), -1e3..1e3_f64, -1e-9..1e-9_f64, -1e12..1e12_f64];
    let place = (part.clone(), part.clone(), part).prop_map(|(x, y, z)| Vec3::new(x, y, z));
    let yaw = prop_oneof![Just(180.0), Just(-180.0), Just(0.0), -180.0..180.0_f64];
    let pitch = prop_oneof![Just(90.0), Just(-90.0), -90.0..90.0_f64];
    let way = prop_oneof![
        4 => Just(Interpolation::Smooth),
        1 => Just(Interpolation::Linear),
        1 => Just(Interpolation::Hold),
        1 => place.clone().prop_map(|around| Interpolation::Orbit { around }),
    ];
    let gap = prop_oneof![Just(1e-6), 1e-6..1e-3_f64, 0.01..10.0_f64];
    let easing = (0..4_usize).prop_map(|n| Easing::ALL[n]);
    // Of one place out of two, so that duplicates and reversals are common.
    let one = (gap, place, any::<bool>(), yaw, pitch, way, easing);
    prop::collection::vec(one, 1..8).prop_map(|parts| {
        let mut time = 0.0;
        let first = parts[0].1;
        let key = |(gap, place, again, yaw, pitch, way, easing)| {
            time += gap;
            let position = if again { first } else { place };
            Key {
                interpolation: way,
                easing,
                ..Key::new(time, camera(position, yaw, pitch))
            }
        };
        parts.into_iter().map(key).collect()
    })
}

proptest! {
    #[test]
    fn any_path_is_finite_and_orthonormal(keys in any_keys()) {
        let path = CameraPath::new(&keys);
        for time in times(&path, 97) {
            let camera = at(&path, time);
            prop_assert!(camera.position.to_array().iter().all(|part| part.is_finite()), "{camera:?}");
            let basis = camera.basis();
            prop_assert!(basis.is_some(), "{camera:?}");
            let (look, up) = (camera.look_at, camera.up);
            for error in [look.dot(look) - 1.0, up.dot(up) - 1.0, look.dot(up)] {
                prop_assert!(error.abs() <= 1e-6, "{error:e}");
            }
        }
    }

    #[test]
    fn smooth_angles_never_leave_their_keys(keys in any_keys()) {
        let path = CameraPath::new(&keys);
        for pair in keys.windows(2) {
            let pitch = |camera: &Camera| Orientation::of(camera).pitch;
            let (a, b) = (pitch(&pair[0].value), pitch(&pair[1].value));
            for n in 0..20 {
                let time = pair[0].time + (pair[1].time - pair[0].time) * f64::from(n) / 20.0;
                let here = pitch(&at(&path, time));
                prop_assert!((a.min(b) - 1e-7..=a.max(b) + 1e-7).contains(&here));
            }
        }
    }

    #[test]
    fn retimed_keys_are_keys(keys in any_keys(), seconds in 0.1..100.0_f64) {
        for retime in [Retime::Stretch(seconds), Retime::ConstantSpeed, Retime::TrimPauses, Retime::Smooth] {
            let new = retime.apply(&keys);
            prop_assert!(!new.is_empty());
            for pair in new.windows(2) {
                prop_assert!(pair[1].time > pair[0].time, "{retime:?}: {} {}", pair[0].time, pair[1].time);
            }
            for key in &new {
                prop_assert!(key.value.basis().is_some() && key.time.is_finite());
            }
        }
    }
}
