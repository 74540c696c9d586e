//! The render thread: the newest request wins, nothing is traced twice, and nothing waits long.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use glint::lab::Study;
use glint::plan::RenderRequest;
use glint::scene::{MAX_GRID, Object, Sampling, Scene, Sphere};
use glint::worker::{
    Activity, BUDGET, Event, Frame, LiveJob, Pace, StillJob, ThumbnailJob, Worker,
};

use crate::PATIENCE;
use crate::pictures::picture;
use crate::program::wait_until;

fn live(revision: u64, scene: &Arc<Scene>, side: u32) -> LiveJob {
    let picture = RenderRequest::sized(side, side);
    LiveJob {
        revision,
        scene: Arc::clone(scene),
        request: picture,
        pace: Pace::Within(BUDGET),
    }
}

fn still(revision: u64, scene: &Arc<Scene>, side: u32) -> StillJob {
    let picture = RenderRequest::sized(side, side);
    StillJob {
        revision,
        scene: Arc::clone(scene),
        request: picture,
        save_to: None,
    }
}

/// Waits for a frame that satisfies `fits`; returns all frames received until then.
fn wait_for(worker: &Worker, fits: impl Fn(&Frame) -> bool) -> Vec<Frame> {
    let start = Instant::now();
    let mut frames = Vec::new();
    while start.elapsed() < PATIENCE {
        if let Some(frame) = worker.take_frame() {
            let is_it = fits(&frame);
            frames.push(frame);
            if is_it {
                return frames;
            }
        }
        std::thread::sleep(Duration::from_micros(200));
    }
    panic!(
        "no such frame came; the render thread is {:?}",
        worker.activity()
    );
}

/// Thousands of spheres: about 20 µs per pixel.
fn slow_scene() -> Arc<Scene> {
    let mut scene = Scene::demo();
    for n in 0..2000_u32 {
        let center = DVec3::new(f64::from(n % 50) * 8.0, 3.0, f64::from(n / 50) * -8.0);
        scene.objects.push(Object::new(
            format!("Ball {n}"),
            "sphere 1",
            Sphere {
                center,
                radius: 3.0,
            },
        ));
    }
    Arc::new(scene)
}

#[test]
fn many_submissions_end_in_the_last_ones_picture() {
    let worker = Worker::new(Some(2), || {}).expect("a render thread");
    let mut scene = Scene::demo();
    let mut last = Arc::new(scene.clone());
    for revision in 1..=200_u32 {
        scene.ambient_intensity = f64::from(revision) / 200.0;
        scene.camera.position.x = 100.0 + f64::from(revision);
        last = Arc::new(scene.clone());
        worker.submit(live(u64::from(revision), &last, 300));
        if revision % 10 == 0 {
            std::thread::sleep(Duration::from_millis(3));
        }
    }
    let frames = wait_for(&worker, |frame| frame.revision == 200 && frame.step == 1);
    assert!(
        frames
            .windows(2)
            .all(|pair| pair[0].revision <= pair[1].revision),
        "never backwards"
    );
    let direct = picture(&last, &RenderRequest::sized(300, 300)).0;
    assert_eq!(*frames.last().expect("one").image, direct);
}

#[test]
fn refinement_traces_every_pixel_once_and_ends_byte_equal() {
    let worker = Worker::new(Some(2), || {}).expect("a render thread");
    let scene = Arc::new(Scene::demo());
    worker.submit(live(1, &scene, 640));
    let frames = wait_for(&worker, |frame| frame.step == 1);
    let finished = frames.last().expect("one");
    assert_eq!(finished.cost.rays.camera, 640 * 640);
    let (direct, rays) = picture(&scene, &RenderRequest::sized(640, 640));
    assert_eq!(*finished.image, direct);
    assert_eq!(finished.cost.rays, rays);
}

#[test]
fn a_new_render_thread_shows_a_coarse_picture_first() {
    let worker = Worker::new(Some(1), || {}).expect("a render thread");
    worker.submit(live(1, &slow_scene(), 512));
    let first = wait_for(&worker, |_| true).remove(0);
    assert!(first.step > 1);
    assert_eq!(first.full_size, (512, 512));
    assert_eq!(first.image.width, 512_usize.div_ceil(first.step));
    assert!(first.image.width >= 64);
}

#[test]
fn an_edit_during_a_still_picture_is_picked_up_at_once() {
    let worker = Worker::new(None, || {}).expect("a render thread");
    let slow = slow_scene();
    let quick = Arc::new(Scene::demo());
    for round in 0..5_u64 {
        let revision = round * 2 + 1;
        worker.request_still(still(revision, &slow, 4096));
        let is_under_way = |activity| matches!(activity, Activity::Still { done, .. } if done > 0);
        wait_until("a running still picture", || {
            is_under_way(worker.activity())
        });
        worker.submit(live(revision + 1, &quick, 64));
        wait_for(&worker, |frame| {
            !frame.is_still && frame.revision == revision + 1
        });
    }
    wait_until("rest", || worker.activity() == Activity::Idle);
    assert!(
        worker.take_frame().is_none_or(|frame| !frame.is_still),
        "the old still picture is given up"
    );
}

#[test]
fn a_picture_whose_every_tile_takes_minutes_gives_way_at_once() {
    let worker = Worker::new(None, || {}).expect("a render thread");
    let mut endless = still(1, &slow_scene(), 512);
    endless.request.sampling = Sampling::Grid(MAX_GRID);
    worker.request_still(endless);
    wait_until("a running still picture", || {
        matches!(worker.activity(), Activity::Still { .. })
    });
    // Long enough for the first tiles to be started.
    std::thread::sleep(Duration::from_millis(200));
    worker.submit(live(2, &Arc::new(Scene::demo()), 64));
    wait_for(&worker, |frame| !frame.is_still && frame.revision == 2);
}

#[test]
fn a_cancelled_still_picture_never_comes() {
    let worker = Worker::new(None, || {}).expect("a render thread");
    worker.request_still(still(1, &slow_scene(), 2048));
    wait_until(
        "progress",
        || matches!(worker.activity(), Activity::Still { done, .. } if done > 0),
    );
    worker.cancel_still();
    wait_until("rest", || worker.activity() == Activity::Idle);
    assert!(worker.take_frame().is_none());
}

#[test]
fn a_picture_that_is_to_be_saved_outlives_edits() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("still.png");
    let worker = Worker::new(None, || {}).expect("a render thread");
    let slow = slow_scene();
    worker.request_still(StillJob {
        save_to: Some(path.clone()),
        ..still(1, &slow, 256)
    });
    wait_until(
        "progress",
        || matches!(worker.activity(), Activity::Still { done, .. } if done > 0),
    );
    worker.submit(live(2, &Arc::new(Scene::demo()), 64));
    let mut events = Vec::new();
    wait_until("the file", || {
        events.extend(worker.take_events());
        !events.is_empty()
    });
    assert_eq!(events, [Event::Saved(path.clone())]);
    let saved = ::image::open(&path).expect("a picture").to_rgba8();
    let direct = picture(&slow, &RenderRequest::sized(256, 256)).0;
    assert_eq!(
        saved.into_raw(),
        direct.pixels.concat(),
        "it shows the scene as it was asked for"
    );
}

#[test]
fn a_picture_that_is_written_goes_on_where_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let worker = Worker::new(None, || {}).expect("a render thread");
    let mut slow = still(1, &slow_scene(), 192);
    slow.request.sampling = Sampling::Grid(16);
    slow.save_to = Some(folder.path().join("still.png"));
    worker.request_still(slow);
    let quick = Arc::new(Scene::demo());
    let mut last = 0;
    let mut revision = 1;
    while worker.is_saving() {
        let mut done = 0;
        wait_until("the picture, a little further", || {
            if let Activity::Still { done: now, .. } = worker.activity() {
                assert!(now >= last, "{now} pixels, {last} before: begun anew");
                done = now;
            }
            done > last || !worker.is_saving()
        });
        last = done;
        revision += 1;
        worker.submit(live(revision, &quick, 64));
        worker.request_thumbnails(vec![ThumbnailJob {
            name: revision,
            scene: Arc::clone(&quick),
            size: (64, 48),
        }]);
        wait_for(&worker, |frame| {
            !frame.is_still && frame.revision == revision
        });
    }
    assert!(revision > 3, "it was made to wait {revision} times");
    assert!(matches!(worker.take_events().as_slice(), [Event::Saved(_)]));
}

#[test]
fn a_picture_that_is_on_screen_is_written_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let worker = Worker::new(Some(1), || {}).expect("a render thread");
    let demo = Arc::new(Scene::demo());
    worker.request_still(still(1, &demo, 16));
    let frames = wait_for(&worker, |frame| frame.is_still);
    let shown = &frames.last().expect("a picture").image;
    // Another scene of the same revision, which there is not, shows what is traced.
    let other = Arc::new(Scene::empty());
    for (name, revision, is_as_it_is) in
        [("a.png", 1, true), ("a.exr", 1, false), ("b.png", 2, false)]
    {
        let path = folder.path().join(name);
        worker.request_still(StillJob {
            save_to: Some(path.clone()),
            ..still(revision, &other, 16)
        });
        wait_until("the file", || !worker.take_events().is_empty());
        let decoded = ::image::open(&path).expect("a picture").to_rgb8();
        let own = shown.pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]);
        let is_same = decoded.pixels().map(|pixel| pixel.0).eq(own);
        assert_eq!(is_same, is_as_it_is, "{name}");
    }
}

#[test]
fn a_picture_that_cannot_be_written_says_so() {
    let worker = Worker::new(Some(1), || {}).expect("a render thread");
    let path = std::path::PathBuf::from("/nowhere/at/all.png");
    worker.request_still(StillJob {
        save_to: Some(path),
        ..still(1, &Arc::new(Scene::demo()), 16)
    });
    let mut events = Vec::new();
    wait_until("the failure", || {
        events.extend(worker.take_events());
        !events.is_empty()
    });
    assert!(
        matches!(&events[0], Event::Failed(text) if text.starts_with("cannot write /nowhere/at/all.png: ")),
        "{events:?}"
    );
}

#[test]
fn a_fault_in_the_tracer_is_shown_and_the_lane_lives_on() {
    let worker = Worker::new(Some(1), || {}).expect("a render thread");
    // An object without its pack has no material; no file and no edit can make such a scene.
    let mut broken = Scene::demo();
    broken.packs_mut().clear();
    worker.submit(live(1, &Arc::new(broken), 64));
    let mut events = Vec::new();
    wait_until("the fault", || {
        events.extend(worker.take_events());
        !events.is_empty()
    });
    assert!(
        matches!(&events[0], Event::Fault(text) if text.contains("internal error")),
        "{events:?}"
    );
    worker.submit(live(2, &Arc::new(Scene::demo()), 64));
    wait_for(&worker, |frame| frame.revision == 2 && frame.step == 1);
}

#[test]
fn dropping_the_handle_ends_the_thread() {
    let worker = Worker::new(Some(2), || {}).expect("a render thread");
    worker.submit(live(1, &slow_scene(), 4096));
    wait_until("work", || {
        matches!(worker.activity(), Activity::Live { .. })
    });
    // Nothing else stops a first pass, so without this the test would hang.
    drop(worker);
}

#[test]
fn pictures_to_be_saved_wait_for_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let worker = Worker::new(None, || {}).expect("a render thread");
    let slow = slow_scene();
    let paths: Vec<_> = (0..3)
        .map(|n| folder.path().join(format!("{n}.ppm")))
        .collect();
    for path in &paths {
        worker.request_still(StillJob {
            save_to: Some(path.clone()),
            ..still(1, &slow, 200)
        });
    }
    worker.submit(live(2, &Arc::new(Scene::demo()), 64));
    worker.request_still(still(2, &Arc::new(Scene::demo()), 64));
    assert!(worker.is_saving());
    wait_until("rest", || worker.activity() == Activity::Idle);
    let saved: Vec<Event> = paths.iter().cloned().map(Event::Saved).collect();
    assert_eq!(worker.take_events(), saved);
    assert!(!worker.is_saving() && paths.iter().all(|path| path.exists()));
}

#[test]
fn a_study_goes_on_under_the_live_view_and_can_be_given_up() {
    let worker = Worker::new(Some(2), || {}).expect("a render thread");
    let scene = Arc::new(Scene::demo());
    worker.measure(Study::new(Arc::clone(&scene), 24, 24));
    let mut revision = 0;
    let mut last = 0.0;
    let mut measured = None;
    wait_until("the study's end", || {
        // An edit during a piece of work is served first, and the piece is repeated.
        revision += 1;
        worker.submit(live(revision, &scene, 32));
        wait_for(&worker, |frame| {
            frame.revision == revision && frame.step == 1
        });
        // The wait grows, so that even on a slow machine a piece is eventually done in time.
        std::thread::sleep(Duration::from_millis(100 + 2 * revision));
        if let Some(study) = worker.take_study() {
            assert!(study.progress() >= last);
            last = study.progress();
            measured = Some(study);
        }
        last == 1.0
    });
    let study = measured.expect("a study");
    wait_until("the end of the study", || !worker.is_measuring());
    assert!(revision > 3 && study.measurements.iter().all(|dot| dot.timing().is_some()));
    worker.measure(Study::new(scene, 96, 96));
    wait_until("a first piece", || worker.take_study().is_some());
    assert!(worker.is_measuring());
    worker.stop_measuring();
    assert!(!worker.is_measuring());
    wait_until("the end of the running piece", || {
        worker.activity() == Activity::Idle
    });
    std::thread::sleep(Duration::from_millis(50));
    assert!(worker.take_study().is_none(), "it was given up");
}
