//! Takes and their keys, retiming, text formats, and tracks.

use std::sync::Arc;

use super::*;
use crate::scene::{Animation, Document, Lens, MAX_SECONDS, Take, Target, Track, Value};

/// A hand-flown take: uneven times, pauses, a wobble.
fn take() -> Take {
    let mut take = Take::default();
    let mut time: f64 = 0.0;
    for n in 0..240_u32 {
        let share = time / 5.7;
        let place = DVec3::new(
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

/// The same flight, with the yaw of sample `n` increased by `by(n)`.
fn turned(calm: &Take, by: impl Fn(usize) -> f64) -> Take {
    let mut take = Take::default();
    for (n, sample) in calm.samples.iter().enumerate() {
        let angles = Orientation {
            yaw: sample.2 + by(n),
            pitch: sample.3,
            roll: sample.4,
        };
        let camera = angles.apply(&calm.camera(n).expect("a sample"));
        take.push(sample.0, &camera, angles);
    }
    take
}

/// Alternates in sign from sample to sample.
fn tremor(sample: usize, size: f64) -> f64 {
    if sample.is_multiple_of(2) {
        size
    } else {
        -size
    }
}

/// Returns what every sample sees: a grid of points at a distance of 60.
fn seen(take: &Take) -> Vec<Vec<Landmark>> {
    let of = |sample: usize| {
        let camera = take.camera(sample).expect("a sample");
        let framing = camera.framing().expect("a basis");
        let place = |n: u32| {
            let at = [f64::from(n % 3) * 0.4 - 0.4, f64::from(n / 3) * 0.4 - 0.4];
            let (origin, direction) = framing.ray(at);
            Landmark {
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
            simplified.worst.deviation <= tolerance,
            "{} of {tolerance}",
            simplified.worst.deviation
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
fn a_trembling_hand_costs_few_keys_where_the_tolerance_allows_it() {
    let shaken = turned(&take(), |n| tremor(n, 0.002));
    let seen = seen(&shaken);
    let keys = |pixels: f64| simplify(&shaken, &seen, pixels / 1024.0).keys.len();
    assert!(keys(1.0) > 100, "the tremor is more than a pixel");
    assert!(keys(8.0) < 20, "{} keys", keys(8.0));
}

/// The view leaps from one sample to the next, as when a script moves the mouse, or a touchpad is touched again.
#[test]
fn a_hand_that_jumps_costs_a_few_keys_and_no_accuracy() {
    let calm = take();
    let jumpy = turned(&calm, |n| {
        let leaps = [60, 61, 130, 190].iter().filter(|leap| n >= **leap);
        tremor(n, 0.001) + 0.4 * leaps.count() as f64
    });
    let seen = seen(&jumpy);
    let found = simplify(&jumpy, &seen, 6.0 / 1024.0);
    assert_eq!(found.jumps, 4);
    assert!(found.worst.deviation * 1024.0 <= 6.0, "{:?}", found.worst);
    assert!(found.keys.len() < 40, "{} keys", found.keys.len());
    assert_eq!(simplify(&calm, &self::seen(&calm), 6.0 / 1024.0).jumps, 0);
    // A cut to another projection is no jump of the hand.
    let mut cut = calm.clone();
    let lens = cut.lenses[0];
    cut.lenses.push(Lens {
        from: 90,
        projection: Projection::Orthographic,
        ..lens
    });
    let found = simplify(&cut, &self::seen(&cut), 6.0 / 1024.0);
    assert_eq!(found.jumps, 0);
    // Tapping a key turns the view for a few samples, between rests.
    let tapped = turned(&calm, |n| (n.clamp(20, 24) - 20) as f64 * 0.1);
    assert_eq!(
        simplify(&tapped, &self::seen(&tapped), 6.0 / 1024.0).jumps,
        0
    );
}

#[test]
fn the_tolerance_is_kept_through_pauses_and_kinks() {
    let mut take = Take::default();
    let mut x = 0.0;
    for n in 0..300_u32 {
        // Starts and stops abruptly, as with keys on a keyboard.
        x += if n / 40 % 2 == 1 { 1.0 } else { 0.0 };
        let yaw = f64::from(n.clamp(100, 180)) * 0.01;
        let angles = Orientation {
            yaw,
            ..Orientation::default()
        };
        let camera = angles.apply(&Camera {
            position: DVec3::new(x, 5.0, 0.0),
            ..Camera::default()
        });
        take.push(f64::from(n) / 60.0, &camera, angles);
    }
    let seen = seen(&take);
    for pixels in [0.1, 0.3, 0.7, 1.5, 2.5, 5.0, 12.0, 40.0] {
        let Simplified { keys, worst, .. } = simplify(&take, &seen, pixels / 1024.0);
        assert!(
            worst.deviation * 1024.0 <= pixels * (1.0 + 1e-9),
            "{} at {pixels}",
            worst.deviation * 1024.0
        );
        assert_eq!(
            worst,
            worst_deviation(&CameraPath::new(&keys), &take, &seen, ends_of(&keys))
        );
        // Stretched in time, it is the same flight.
        let slower = CameraPath::new(&stretched_keys(&keys, 20.0));
        let off = worst_deviation(&slower, &take, &seen, ends_of(slower.keys())).deviation * 1024.0;
        assert!(
            (off - worst.deviation * 1024.0).abs() < 0.05,
            "{off} stretched"
        );
    }
}

#[test]
fn a_take_is_replayed_bit_by_bit_from_its_file() {
    let take = take();
    let mut scene = Scene::demo();
    scene.animation_mut().take = Some(Arc::new(take.clone()));
    let key = |n: usize| Key::new(take.samples[n].0, take.camera(n).expect("a sample"));
    scene.animation_mut().keys = (0..take.samples.len()).map(key).collect();
    let text = Document::of(scene);
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
            ..camera(DVec3::new(f64::from(n), 0.0, 0.0), 0.0, 0.0)
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
    // The easing does not matter.
    let mut paced = on_x(&[(0.0, 0.0), (2.0, 80.0)]).keys().to_vec();
    paced[0].easing = Easing::InOut;
    let even = CameraPath::new(&Retime::ConstantSpeed.apply(&paced));
    for time in times(&even, 20) {
        let x = at(&even, time).position.x;
        assert!((x - 40.0 * time).abs() < 0.5, "{x} at {time}");
    }
    // Rotations alone have a speed, too.
    let here = DVec3::splat(0.0);
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
    // A zoom is not a pause, with or without movement.
    let mut zooms = path.keys().to_vec();
    for key in &mut zooms[2..] {
        key.value.projection_distance *= 2.0;
    }
    assert_eq!(paused_seconds(&zooms), 0.0);
    let alone: Vec<_> = zooms[1..3].to_vec();
    assert_eq!(Retime::TrimPauses.apply(&alone), alone);
    assert_eq!(Retime::TrimPauses.apply(&zooms), zooms);
    let longer = stretched_keys(path.keys(), 10.0);
    assert_eq!(longer[2].time, 8.0);
    assert_eq!(longer[3].value, path.keys()[3].value);
}

#[test]
fn a_stretched_flight_takes_the_keys_of_values_along() {
    let path = on_x(&[(1.0, 0.0), (3.0, 30.0)]);
    let target = Target::AmbientIntensity;
    let mut animation = Animation {
        keys: path.keys().to_vec(),
        ..Animation::default()
    };
    for time in [0.5, 2.0, 4.0] {
        animation = animation.with_value(&target, time, Value::Number(time));
    }
    let longer = stretched(&animation, 4.0);
    assert_eq!(longer.keys[1].time, 5.0);
    let times: Vec<f64> = longer.tracks[0].keys.iter().map(|key| key.time).collect();
    assert_eq!(times, [0.5, 3.0, 7.0], "what is before it stays");
    let longest = longest_flight(&animation);
    assert_eq!(longest, (MAX_SECONDS - 1.0) * 2.0 / 3.0);
    let longest = stretched(&animation, 2.0 * longest);
    assert_eq!(longest.tracks[0].keys[2].time, MAX_SECONDS);
}

#[test]
fn smoothing_takes_corners_off_and_keeps_the_ends() {
    let path = on_x(&[(0.0, 0.0), (1.0, 30.0), (2.0, 20.0), (3.0, 30.0)]);
    let smooth = Retime::Smooth.apply(path.keys());
    let x: Vec<f64> = smooth.iter().map(|key| key.value.position.x).collect();
    assert_eq!(x, [0.0, 20.0, 25.0, 30.0]);
    // A circle has no corners.
    let round = Preset::Turntable.keys(&Camera::default(), DVec3::ZERO, 8.0);
    assert_eq!(Retime::Smooth.apply(&round), round);
}

#[test]
fn the_columns_of_a_table_go_on_where_a_round_ends() {
    let round = Preset::Turntable.keys(&Camera::default(), DVec3::ZERO, 8.0);
    let table = to_table(round.iter().map(|key| (key.time, &key.value)));
    let yaw = |line: &str| -> f64 {
        line.split(',')
            .nth(4)
            .expect("a column")
            .parse()
            .expect("a number")
    };
    let yaws: Vec<f64> = table.lines().skip(1).map(yaw).collect();
    let steps = yaws.array_windows().map(|[one, next]| (next - one).abs());
    for step in steps {
        assert!((step - 90.0).abs() < 1e-6, "{yaws:?}");
    }
}

#[test]
fn the_flight_of_a_scene_is_a_path() {
    let mut scene = Scene::demo();
    scene.animation_mut().keys = Preset::Turntable.keys(&Camera::default(), DVec3::ZERO, 8.0);
    let header = "// by hand\n".to_owned();
    let document = Document { header, scene };
    let read = from_text(&document.to_text().expect("a text"));
    assert_eq!(read.as_ref(), Ok(&document.scene.animation.keys));
    let error = from_text("\u{feff}/* by hand */\nScene(\n  version: 1,\n  lights: 7,\n)")
        .expect_err("broken");
    assert_eq!(error.line, 4, "{error}");
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
    assert_eq!(few[0].value.position, DVec3::new(1.0, 2.0, 3.0));
    let error = from_table("time,x,y,z\n0,1,2,3\n1,1,oops,3\n", &Camera::default());
    assert_eq!(
        error.expect_err("bad").to_string(),
        "line 3: y must be a number, found \"oops\""
    );
    let words = "\n  \r\ntime;x;y;z;projection\n2,5;0;0;0;orthographic\n1;0;0;0;PERSPECTIVE\n";
    let read = from_table(words, &Camera::default()).expect("a table");
    assert_eq!(read[1].time, 2.5);
    assert_eq!(read[1].value.projection, Projection::Orthographic);
    let late = from_table("\ntime,x,y,z\n0,0,0,0\n-1,0,0,0\n", &Camera::default());
    let late = late.expect_err("too early").to_string();
    assert!(late.contains("line 4") && late.contains("86400"), "{late}");
    assert!(from_table("time,x,y\n", &Camera::default()).is_err());
    assert!(from_table("", &Camera::default()).is_err());
    let quoted = "\u{feff}\"time\",\"x\",y,\"z\"\r\n\r\n\"0\",\"1\", 2,3\r\n";
    let quoted = from_table(quoted, &Camera::default()).expect("a table");
    assert_eq!(quoted[0].value.position, DVec3::new(1.0, 2.0, 3.0));
    let error = from_table(
        "time,x,y,z\n\n0,1,2,\"3\n\"\n1,1,no,3\n",
        &Camera::default(),
    );
    assert_eq!(error.map_err(|error| error.line).err(), Some(5));
    assert_eq!(from_text("[\nKey(time: 0)]").expect_err("bad").line, 2);
    let key = "[Key(time: 1, value: Camera())]";
    let commented = format!("// my path\n/* by hand */ {key}");
    assert_eq!(from_text(&commented), from_text(key));
    assert!(from_text(key).is_ok());
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
    let (from, to) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(5.0, 2.0, -3.0));
    scene.animation_mut().tracks = vec![
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
    assert!((half.lights[0].position - DVec3::new(3.0, 2.0, 0.0)).length() < 1e-9);
    let moved = &half.objects.last().expect("objects").shape;
    assert_eq!(moved.kind(), shape.kind());
    assert!((moved.position() - DVec3::new(3.0, 2.0, 0.0)).length() < 1e-9);
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
