//! Paths for which simple implementations fail: duplicate keys, reversals, uneven spacing, opposite directions,
//! poles.

mod takes;

use std::sync::Arc;

use proptest::prelude::*;

use glam::DVec3;

use super::*;
use crate::scene::{
    Animation, Camera, Easing, Interpolation, Key, Orientation, Projection, Scene, Target, Track,
    Value,
};

fn camera(position: DVec3, yaw: f64, pitch: f64) -> Camera {
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
    let key = |&(time, x): &(f64, f64)| Key::new(time, camera(DVec3::new(x, 0.0, 0.0), 0.0, 0.0));
    CameraPath::new(&places.iter().map(key).collect::<Vec<_>>())
}

fn at(path: &CameraPath, time: f64) -> Camera {
    path.at(time).expect("a camera")
}

fn stretched_keys(keys: &[Key<Camera>], seconds: f64) -> Vec<Key<Camera>> {
    let keys = keys.to_vec();
    let animation = Animation {
        keys,
        ..Animation::default()
    };
    stretched(&animation, seconds).keys
}

/// Returns times at equal steps from the first key to the last.
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
        // Spacing of 100 : 1 in space, then in time, a reversal, and a rest.
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
    keys[1].value = camera(DVec3::new(7.7, 0.0, 0.0), 33.3, 12.1);
    keys[2].value = keys[1].value.clone();
    let path = CameraPath::new(&keys);
    for n in 0..=150 {
        assert_eq!(at(&path, 1.0 + f64::from(n) / 100.0), keys[1].value);
    }
}

#[test]
fn turns_take_the_shorter_way_at_an_even_pace() {
    let turn = |from: f64, to: f64| {
        let here = DVec3::splat(0.0);
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
    // Exactly and nearly opposite directions.
    for off in [0.0, 1e-9, 1e-3] {
        assert!((turn(0.0, 180.0 - off) - (180.0 - off)).abs() < 1e-6);
    }
    assert_eq!(turn(90.0, 90.0), 0.0);
}

#[test]
fn turns_count_about_every_axis() {
    let from = camera(DVec3::ZERO, 0.0, -80.0);
    for (yaw, pitch, turn) in [
        (30.0, -80.0, 30.0),
        (0.0, -50.0, 30.0),
        (180.0, -80.0, 180.0),
    ] {
        let to = camera(DVec3::ZERO, yaw, pitch);
        let found = motion_between(&from, &to).turn;
        assert!((found - turn).abs() < 1e-5, "{found} of {turn}");
    }
}

#[test]
fn a_camera_that_tips_over_the_top_keeps_its_basis() {
    let here = DVec3::splat(0.0);
    let keys = [
        Key::new(0.0, camera(here, 0.0, 89.99)),
        Key::new(1.0, camera(here, 120.0, 90.0)),
        Key::new(2.0, camera(here, -60.0, -90.0)),
    ];
    let path = CameraPath::new(&keys);
    for time in times(&path, 500) {
        let basis = at(&path, time).basis().expect("a basis");
        assert!(basis.x_axis.dot(basis.z_axis).abs() < 1e-6);
    }
}

#[test]
fn a_turntable_is_a_circle_that_looks_at_its_middle() {
    let target = DVec3::new(10.0, 20.0, -30.0);
    let start = camera(DVec3::new(100.0, 60.0, 5.0), 10.0, 0.0);
    let path = CameraPath::new(&Preset::Turntable.keys(&start, target, 8.0));
    let radius = (start.position - target).length();
    for time in times(&path, 997) {
        let camera = at(&path, time);
        let arm = camera.position - target;
        assert!((arm.length() / radius - 1.0).abs() < 1e-12);
        let look = camera.look_at.try_normalize().expect("a direction");
        assert!((look + arm * (1.0 / radius)).length() < 1e-9);
    }
    assert_eq!(at(&path, 8.0).position, at(&path, 0.0).position);
}

#[test]
fn an_eight_from_above_does_not_turn_the_picture_and_there_is_no_ellipse() {
    let target = DVec3::new(10.0, 20.0, -30.0);
    let start = camera(target + DVec3::Y * 100.0, 10.0, -90.0);
    let path = CameraPath::new(&Preset::FigureEight.keys(&start, target, 8.0));
    let up = |time: f64| at(&path, time).basis().expect("a basis").y_axis;
    let far = |time: f64| (at(&path, time).position - start.position).length();
    assert!(far(2.0) > 50.0, "{}", far(2.0));
    for time in times(&path, 80) {
        assert!(up(time).dot(up(0.0)) > 0.7, "{time}: {}", up(time));
    }
    let ellipse = Preset::Ellipse.keys(&start, target, 8.0);
    assert!(ellipse.iter().all(|key| key.value == ellipse[0].value));
}

#[test]
fn a_turntable_from_above_turns_the_picture_evenly() {
    let target = DVec3::new(10.0, 20.0, -30.0);
    let start = camera(target + DVec3::Y * 100.0, 10.0, -90.0);
    let keys = Preset::Turntable.keys(&start, target, 8.0);
    assert_eq!(keys[0].value, keys[4].value, "a round");
    // A camera that was tilted at first still looks at the target.
    let tilted = camera(start.position, 10.0, -60.0);
    for (one, other) in Preset::Turntable
        .keys(&tilted, target, 8.0)
        .iter()
        .zip(&keys)
    {
        assert_eq!(one.value.look_at, other.value.look_at);
        assert!((one.value.up - other.value.up).length() < 1e-12);
    }
    let path = CameraPath::new(&keys);
    for time in times(&path, 80) {
        let ahead = at(&path, time).basis().expect("a basis").y_axis;
        let first = at(&path, 0.0).basis().expect("a basis").y_axis;
        let angle = (time / 8.0 * 360.0).to_radians();
        assert!(
            (ahead.dot(first) - angle.cos()).abs() < 1e-9,
            "{time}: {ahead}"
        );
    }
}

#[test]
fn a_dolly_comes_nearer_in_both_projections() {
    let target = DVec3::new(10.0, 20.0, -30.0);
    for projection in [Projection::Perspective, Projection::Orthographic] {
        let start = Camera {
            projection,
            ..camera(DVec3::new(100.0, 60.0, 5.0), 10.0, 0.0)
        };
        let keys = Preset::Dolly.keys(&start, target, 8.0);
        let ends = [&keys[0].value, &keys[keys.len() - 1].value];
        // Size in the picture of an object at the target.
        let height = ends.map(|camera| {
            let framing = camera.framing().expect("a framing");
            let up = camera.basis().expect("a basis").y_axis;
            let places = [target, target + up].map(|point| framing.project(point));
            let [low, high] = places.map(|place| place.expect("in front"));
            (high[1] - low[1]).abs()
        });
        assert!(height[1] > 1.5 * height[0], "{projection:?} {height:?}");
    }
}

#[test]
fn a_table_of_a_spreadsheet_is_a_path() {
    let like = Camera::default();
    let keys = |text: &str| from_table(text, &like);
    let plain = keys("time,x,y,z,yaw\n0,1.5,2,3,10\n1.25,-4,2,3,20\n").expect("keys");
    assert_eq!(plain[1].time, 1.25);
    for text in [
        "Time;X;Y;Z;Yaw\r\n0;1,5;2;3;10\r\n1,25;-4;2;3;20\r\n",
        "time\tx\ty\tz\tyaw\n0\t1.5\t2\t3\t10\n1,25\t-4\t2\t3\t20\n",
    ] {
        assert_eq!(keys(text).as_ref(), Ok(&plain), "{text}");
    }
    // The lines may be in any order.
    let sorted = keys("time,x,y,z,yaw\n1.25,-4,2,3,20\n0,1.5,2,3,10\n");
    assert_eq!(sorted.as_ref(), Ok(&plain));
    let error = keys("time,x,y,z\n1,1,2,3\n0,1,2,3\n1,4,2,3\n").expect_err("twice");
    let twice = (4, "there are two lines for the time 1");
    assert_eq!((error.line, &*error.what), twice);
    let error = keys("time;x;y;z\n0;1;2;1,2,3\n").expect_err("no number");
    assert_eq!(
        (error.line, &*error.what),
        (2, "z must be a number, found \"1,2,3\"")
    );
}

#[test]
fn an_orbit_from_or_to_its_axis_turns_nowhere() {
    let around = DVec3::new(1.0, 2.0, 3.0);
    // Positions on the axis may be off by rounding.
    for beside in [0.0, 1e-15] {
        let top = around + DVec3::new(beside, 5.0, -beside);
        for turn in 0..16 {
            let (sine, cosine) = (f64::from(turn) * 0.4).sin_cos();
            let side = around + DVec3::new(5.0 * cosine, 0.0, 5.0 * sine);
            for (from, to) in [(side, top), (top, side)] {
                for step in 0..=10 {
                    let place = path::orbit(around, from, to, f64::from(step) / 10.0) - around;
                    let ahead = place.x * cosine + place.z * sine;
                    let across = place.x * sine - place.z * cosine;
                    assert!(ahead > -1e-9 && across.abs() < 1e-9, "{turn}: {place}");
                }
            }
        }
    }
}

#[test]
fn every_preset_starts_where_the_camera_is_and_looks_at_the_target() {
    let target = DVec3::new(1.0, 2.0, 3.0);
    for preset in Preset::ALL {
        // From straight above, there is no horizontal direction to the target; the path must still be valid.
        for place in [
            DVec3::new(30.0, 10.0, -4.0),
            target + DVec3::new(0.0, 5.0, 0.0),
            target,
        ] {
            let start = camera(place, 0.0, 0.0);
            let keys = preset.keys(&start, target, 4.0);
            assert!((keys[0].value.position - place).length() < 1e-12);
            let mut scene = Scene::demo();
            scene.animation_mut().keys = keys;
            assert_eq!(
                crate::scene::check(&scene),
                Ok(()),
                "{preset:?} from {place:?}"
            );
        }
    }
    // The splines of the round paths do not oscillate.
    let start = camera(DVec3::new(50.0, 0.0, 0.0), 0.0, 0.0);
    let path = CameraPath::new(&Preset::Ellipse.keys(&start, DVec3::splat(0.0), 4.0));
    for time in times(&path, 500) {
        let position = at(&path, time).position;
        let round = (position.x / 50.0).hypot(position.z / (50.0 * 1.6));
        assert!((round - 1.0).abs() < 4e-4, "{round} at {time}");
    }
}

#[test]
fn a_round_goes_on_at_its_seam_as_anywhere_else() {
    let start = camera(DVec3::new(50.0, 0.0, 0.0), 0.0, 0.0);
    let upright = Preset::Ellipse.keys(&start, DVec3::splat(0.0), 4.0);
    // Upside down, the roll at the seam is half a turn, one way or the other by rounding.
    let mut upside_down = upright.clone();
    for (key, aside) in upside_down
        .iter_mut()
        .zip([1e-13].into_iter().chain(std::iter::repeat(-1e-13)))
    {
        key.value.up = DVec3::new(0.0, -1.0, aside);
    }
    for keys in [upright, upside_down] {
        let path = CameraPath::new(&keys);
        let step = 1e-4;
        let motion = |a: f64, b: f64| at(&path, b).position - at(&path, a).position;
        let (out, back) = (motion(0.0, step), motion(4.0 - step, 4.0));
        assert!(
            (out - back).length() < 0.01 * out.length(),
            "{out:?} {back:?}"
        );
    }
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
    let here = camera(DVec3::splat(0.0), 0.0, 0.0);
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

fn any_keys() -> impl Strategy<Value = Vec<Key<Camera>>> {
    let part = prop_oneof![Just(0.0), -1e3..1e3_f64, -1e-9..1e-9_f64, -1e12..1e12_f64];
    let place = (part.clone(), part.clone(), part).prop_map(|(x, y, z)| DVec3::new(x, y, z));
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
    // Half of the positions are that of the first key: duplicates and reversals are common.
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
        let retimed = Retime::ALL.map(|retime| (retime.words().0, retime.apply(&keys)));
        let all = retimed.into_iter().chain([("stretched", stretched_keys(&keys, seconds))]);
        for (retime, new) in all {
            prop_assert!(!new.is_empty());
            for pair in new.windows(2) {
                prop_assert!(pair[1].time > pair[0].time, "{retime}: {} {}", pair[0].time, pair[1].time);
            }
            for key in &new {
                prop_assert!(key.value.basis().is_some() && key.time.is_finite());
            }
        }
    }
}

/// The places of a ball at equal times from its first key to its last.
fn places_of_ball(keys: &[(f64, DVec3)]) -> Vec<DVec3> {
    let mut scene = Scene::demo();
    let target = Target::ObjectPosition(scene.objects[0].name.clone());
    let keys: Vec<_> = keys
        .iter()
        .map(|(time, at)| Key::new(*time, Value::Point(*at)))
        .collect();
    let end = keys.last().expect("keys").time;
    scene.animation_mut().tracks = vec![Track { target, keys }];
    let scene = Arc::new(scene);
    let time = |n: u32| end * f64::from(n) / 120.0;
    let place = |n| pose(&scene, time(n)).objects[0].shape.position();
    (0..=120).map(place).collect()
}

#[test]
fn what_falls_and_rests_does_not_sink_and_what_circles_stays_round() {
    let (high, low) = (DVec3::Y * 100.0, DVec3::Y * 10.0);
    let aside = DVec3::new(100.0, 10.0, 0.0);
    let fallen = places_of_ball(&[(0.0, high), (1.0, low), (2.0, low), (3.0, aside)]);
    for place in fallen {
        assert!(place.y >= 10.0 - 1e-9 && place.x >= -1e-9, "{place}");
    }
    let corner = |n: usize| {
        let angle = (n as f64 + 0.5) * std::f64::consts::FRAC_PI_2;
        (n as f64, DVec3::new(angle.cos(), 0.0, angle.sin()) * 100.0)
    };
    let round = places_of_ball(&(0..9).map(corner).collect::<Vec<_>>());
    for place in &round[15..105] {
        assert!((place.length() - 100.0).abs() < 12.0, "{place}");
    }
}

#[test]
fn a_camera_on_an_orbit_turns_with_it() {
    let on_circle = |degrees: f64, aside: f64| {
        let angle = degrees.to_radians();
        let position = DVec3::new(angle.cos(), 0.0, angle.sin()) * 100.0;
        camera(position, degrees - 90.0 + aside, 0.0)
    };
    let facing = |camera: &Camera| camera.look_at.normalize().dot(-camera.position.normalize());
    for (turn, aside) in [
        (170.0, 15.0),
        (-170.0, -15.0),
        (180.0, 0.0),
        (170.0, -15.0),
        (90.0, 15.0),
    ] {
        let keys = [(0.0, on_circle(0.0, 0.0)), (1.0, on_circle(turn, aside))];
        let mut keys = keys.map(|(time, camera)| Key::new(time, camera));
        keys[0].interpolation = Interpolation::Orbit {
            around: DVec3::ZERO,
        };
        let path = CameraPath::new(&keys);
        for time in times(&path, 40) {
            let facing = facing(&at(&path, time));
            assert!(
                facing > 0.96,
                "{facing} at {time} of {turn} with {aside} aside"
            );
        }
    }
    // A camera that does not turn stays as it is, even on half a turn.
    let mut keys = [0.0, 180.0].map(|degrees| {
        let mut camera = on_circle(degrees, 0.0);
        camera.look_at = DVec3::NEG_Z;
        Key::new(degrees, camera)
    });
    keys[0].interpolation = Interpolation::Orbit {
        around: DVec3::ZERO,
    };
    let middle = at(&CameraPath::new(&keys), 90.0);
    assert!(middle.look_at.normalize().abs_diff_eq(DVec3::NEG_Z, 1e-9));
}
