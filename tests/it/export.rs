//! Exported frame sequences: the real program and real files, with the program killed and files damaged in between.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glint::export::{
    ExportError, ExportStep, Exporting, Frames, Pattern, Sequence, Video, VideoError,
};
use glint::image::Format;
use glint::plan::RenderRequest;
use glint::scene::{Document, Sampling, Scene};
use glint::trace::{RenderControl, Threads};
use glint::ui::Ask;
use glint::worker::Worker;
use image::AnimationDecoder as _;

use crate::harness::{CTRL, EditorHarness};
use crate::pictures::picture;
use crate::program::{FLIGHT, done, glint, names, run, stderr_of, wait_until};
use crate::random::flight;

/// Exports small frames of the published flight into a folder.
fn export(folder: &Path, more: &[&str]) -> Command {
    let mut command = glint(&["export", FLIGHT, "--width", "48", "--threads", "2"]);
    command.arg("-o").arg(folder).args(more);
    command
}

/// The files of a folder except the notes, which contain times.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = names(folder)
        .into_iter()
        .filter(|name| name != "glint-frames.txt");
    let files = names.filter(|name| folder.join(name).is_file());
    files
        .map(|name| {
            let bytes = fs::read(folder.join(&name)).expect("readable");
            (name, bytes)
        })
        .collect()
}

/// The published flight in pictures of this size.
fn sized_flight(width: u32, height: u32) -> Scene {
    let mut scene = flight();
    (scene.render.width, scene.render.height) = (width, height);
    scene
}

/// Frames of a scene, all of them if none are given, that are to be in a folder.
fn sequence(scene: Scene, frames: Option<&str>, format: Format, folder: &Path) -> Sequence {
    let frames = frames.map(|frames| Frames::parse(frames).expect("frames"));
    let (pattern, folder) = (Pattern::default(), folder.to_owned());
    let sequence = Sequence::new(Arc::new(scene), frames, pattern, format, folder);
    sequence.expect("they are there")
}

#[test]
fn a_killed_export_goes_on_and_ends_as_if_nothing_had_been() {
    let folder = tempfile::tempdir().expect("a folder");
    let (whole, killed) = (folder.path().join("whole"), folder.path().join("killed"));
    done(&mut export(&whole, &[]));
    let expected = files(&whole);
    assert_eq!(expected.len(), 202);
    let mut kills = 0;
    for n in 0..200_u64 {
        if kills == 30 {
            break;
        }
        let mut child = export(&killed, &[])
            .stdout(Stdio::null())
            .spawn()
            .expect("it runs");
        sleep(Duration::from_micros(4_000 + n * n * 7_919 % 37_000));
        if child.try_wait().expect("a child").is_none() {
            child.kill().expect("killed");
            kills += 1;
        }
        child.wait().expect("ended");
        // If it got to the end, some frames are removed, so that it can be killed again.
        let frames: Vec<_> = fs::read_dir(&killed)
            .map(Iterator::collect)
            .unwrap_or_default();
        if frames.len() > 150 {
            for frame in 1..=100 {
                let _ = fs::remove_file(killed.join(format!("rayTrace{frame}.ppm")));
            }
        }
    }
    assert_eq!(kills, 30);
    done(&mut export(&killed, &[]));
    assert!(files(&killed) == expected, "the same files, byte by byte");
}

#[test]
fn only_what_is_not_there_as_it_should_be_is_made() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    let twelve = ["--frames", "1-12"];
    let said = done(&mut export(&frames, &twelve));
    assert!(
        said.contains("12 frames written, 0 already there"),
        "{said}"
    );
    let before = files(&frames);
    assert!(before.contains_key("rayTrace1.ppm") && before.contains_key("rayTrace12.ppm"));
    // Truncated, empty, missing, and another program's.
    let path = |frame: u32| frames.join(format!("rayTrace{frame}.ppm"));
    let bytes = fs::read(path(2)).expect("there");
    fs::write(path(2), &bytes[..bytes.len() / 2]).expect("written");
    fs::write(path(3), "").expect("written");
    fs::remove_file(path(4)).expect("removed");
    let mut foreign = bytes.clone();
    *foreign.last_mut().expect("bytes") ^= 1;
    fs::write(path(5), foreign).expect("written");
    let said = done(export(&frames, &twelve).arg("--dry-run"));
    assert!(said.contains("4 frames of 12 to make: 2-5"), "{said}");
    let said = done(&mut export(&frames, &twelve));
    assert!(said.contains("4 frames written, 8 already there"), "{said}");
    assert!(files(&frames) == before);
    // A truncated note counts as none.
    let notes = frames.join("glint-frames.txt");
    let text = fs::read_to_string(&notes).expect("there");
    let lines: Vec<&str> = text.lines().collect();
    let cut = format!("{}\n{}", lines[..5].join("\n"), &lines[5][..40]);
    fs::write(&notes, cut).expect("written");
    let said = done(&mut export(&frames, &twelve));
    assert!(said.contains("8 frames written, 4 already there"), "{said}");
    // A frame also depends on the render settings.
    let said = done(export(&frames, &twelve).args(["--antialias", "none"]));
    assert!(said.contains("12 frames written"), "{said}");
}

/// Both find the same frames missing, and write them at the same time under the same names.
#[test]
fn two_exports_into_one_folder_do_not_hurt_each_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = folder.path().join("whole");
    done(&mut export(&whole, &["--frames", "1-6"]));
    let expected = files(&whole);
    for pair in 0..50 {
        let both = folder.path().join(format!("both {pair}"));
        let start = || {
            let mut command = export(&both, &["--frames", "1-6"]);
            command.stdout(Stdio::null()).stderr(Stdio::piped());
            command.spawn().expect("it runs")
        };
        for child in [start(), start()] {
            let output = child.wait_with_output().expect("it ends");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "pair {pair}: {said}");
        }
        assert!(files(&both) == expected, "pair {pair}");
    }
}

#[test]
fn what_dead_programs_left_is_removed_and_what_others_write_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let left = folder.path().join(".glint-unfinished-AbCdEf-rayTrace1.ppm");
    let written = folder.path().join(".glint-unfinished-GhIjKl-rayTrace2.ppm");
    fs::write(&left, "half a frame").expect("written");
    let other = fs::File::create(&written).expect("made");
    other.lock().expect("locked");
    let somebodys = ".glint-notes";
    fs::write(folder.path().join(somebodys), "buy milk").expect("written");
    done(&mut export(folder.path(), &["--frames", "1-2"]));
    let names: Vec<_> = files(folder.path()).into_keys().collect();
    let kept = ".glint-unfinished-GhIjKl-rayTrace2.ppm";
    assert_eq!(names, [somebodys, kept, "rayTrace1.ppm", "rayTrace2.ppm"]);
}

#[test]
fn a_note_that_was_cut_off_costs_its_own_frame_only() {
    let folder = tempfile::tempdir().expect("a folder");
    done(&mut export(folder.path(), &["--frames", "1-3"]));
    let notes = folder.path().join("glint-frames.txt");
    let text = fs::read_to_string(&notes).expect("readable");
    fs::write(&notes, &text[..text.len() - 9]).expect("written");
    let said = done(&mut export(folder.path(), &["--frames", "1-4"]));
    assert!(said.contains("2 frames written, 2 already there"), "{said}");
    let said = done(&mut export(folder.path(), &["--frames", "1-4"]));
    assert!(said.contains("0 frames written, 4 already there"), "{said}");
}

#[test]
fn asking_what_is_missing_makes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    let said = done(&mut export(&frames, &["--frames", "1-3", "--dry-run"]));
    assert!(said.contains("3 frames of 3 to make"), "{said}");
    assert!(!frames.exists());
    let video = |path: &Path| {
        let mut asking = export(&frames, &["--frames", "1-3", "--dry-run", "--video"]);
        run(asking.arg(path))
    };
    assert!(video(&frames.join("flight.gif")).status.success());
    assert!(!frames.exists());
    let output = video(&folder.path().join("gone/flight.gif"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        !output.status.success() && said.contains("gone does not exist"),
        "{said}"
    );
}

#[test]
fn names_that_no_system_takes_are_told_and_others_are_taken() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    for (length, is_fine) in [(240, true), (300, false)] {
        let name = format!("{}%d", "a".repeat(length));
        let output = run(&mut export(&frames, &["--frames", "1", "--name", &name]));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.success(), is_fine, "{said}");
        assert!(
            is_fine || said.contains("a1.ppm: File name too long"),
            "{said}"
        );
        assert!(!said.contains("unfinished"), "{said}");
    }
}

#[cfg(unix)]
#[test]
fn notes_that_are_a_link_to_nowhere_are_told_before_the_first_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let notes = folder.path().join("glint-frames.txt");
    std::os::unix::fs::symlink("gone", &notes).expect("linked");
    let said = stderr_of(&mut export(folder.path(), &["--frames", "1"]), 1);
    assert!(
        said.contains("glint-frames.txt: it is a broken link"),
        "{said}"
    );
    assert!(!folder.path().join("rayTrace1.ppm").exists());
}

#[cfg(unix)]
#[test]
fn pipes_in_place_of_files_and_folders_are_refused_and_not_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = |path: &Path| {
        let made = Command::new("mkfifo").arg(path).status();
        assert!(made.expect("a command of every Unix").success());
    };
    let refused = |command: &mut Command, words: &str| {
        let output = run(command);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(words), "{said}");
    };
    let frames = folder.path().join("frames");
    fs::create_dir(&frames).expect("made");
    pipe(&frames.join(".glint-unfinished-pipe"));
    done(&mut export(&frames, &["--frames", "1-3"]));
    // The next export would remove such frames.
    let mut hidden = export(&frames, &["--name", ".glint-unfinished-%d"]);
    refused(&mut hidden, "taken for that of an unfinished file");
    fs::remove_file(frames.join("rayTrace2.ppm")).expect("there");
    pipe(&frames.join("rayTrace2.ppm"));
    let mut missing = export(&frames, &["--frames", "1-3", "--dry-run"]);
    assert!(done(&mut missing).contains("1 frame of 3 to make: 2"));
    fs::remove_file(frames.join("glint-frames.txt")).expect("there");
    pipe(&frames.join("glint-frames.txt"));
    let mut again = export(&frames, &["--frames", "1-3"]);
    refused(&mut again, "glint-frames.txt is not a file");

    let scene = folder.path().join("scene.ron");
    pipe(&scene);
    let scene = scene.to_str().expect("plain");
    let words = ["convert", "scenes/knot.ply", "-o", scene];
    refused(&mut glint(&words), "and is not a file");
    let mut into_pipe = export(Path::new(scene), &["--frames", "1"]);
    refused(&mut into_pipe, "and is not a folder");
}

#[test]
fn a_video_that_cannot_be_is_told_before_the_first_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let (frames, video) = (
        folder.path().join("frames"),
        folder.path().join("gone/x.gif"),
    );
    let video = video.to_str().expect("a plain name");
    let words = ["--frames", "1-3", "--video", video];
    let said = stderr_of(&mut export(&frames, &words), 1);
    assert!(said.contains("gone does not exist"), "{said}");
    assert!(!frames.exists());
    let inside = frames.join("x.gif");
    let inside = inside.to_str().expect("a plain name");
    done(&mut export(
        &frames,
        &["--frames", "1-3", "--video", inside],
    ));
    assert!(files(&frames).contains_key("x.gif"));
}

/// Exports the flight at another frame rate and size; `words` select the frames.
fn at_rate(folder: &Path, fps: &str, size: (u32, u32), words: &[&str]) -> Command {
    let text = fs::read_to_string(FLIGHT).expect("readable");
    let rate = format!("frames_per_second: {fps}");
    let text = text.replace("frames_per_second: 14", &rate);
    assert!(text.contains(&rate));
    let scene = folder.join("rated.ron");
    fs::write(&scene, text).expect("written");
    let mut command = glint(&["export", "-o"]);
    let (width, height) = (size.0.to_string(), size.1.to_string());
    command
        .args([folder.join("frames"), scene])
        .args(["--width", &width, "--height", &height])
        .args(words);
    command
}

#[test]
fn what_no_video_can_show_is_told_and_what_it_shows_otherwise_as_well() {
    let folder = tempfile::tempdir().expect("a folder");
    let video = |name: &str| folder.path().join(name).to_str().expect("plain").to_owned();
    for name in ["a.mp4", "a.mkv"] {
        let words = ["--frames", "1", "--video", &video(name)];
        let said = stderr_of(&mut at_rate(folder.path(), "14", (1, 8), &words), 2);
        assert!(said.contains("at least 2 × 2 pixels"), "{said}");
        assert!(!folder.path().join("frames").exists());
    }
    // Frames too short for the clock of a GIF are left out, but never all of them.
    for (fps, frames, told, shown) in [
        ("120", "1-8", "4 of 8 are left out", 4),
        ("240", "1-2", "1 of 2 are left out", 1),
        ("50", "1-8", "", 8),
    ] {
        let gif = video("fast.gif");
        let words = ["--frames", frames, "--video", &gif];
        let said = stderr_of(&mut at_rate(folder.path(), fps, (8, 8), &words), 0);
        assert!(
            said.contains(told) && told.is_empty() != said.contains("are left out"),
            "{said}"
        );
        assert_eq!(gif_frames(&gif).len(), shown, "{fps}");
    }
}

#[test]
fn after_an_edit_only_the_frames_that_change_are_made_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("edited.ron");
    let mut document = Document::load(FLIGHT.as_ref()).expect("a scene");
    let frames = folder.path().join("frames");
    let mut again = |scene: &Scene| {
        document.scene = scene.clone();
        fs::write(&file, document.to_text().expect("a text")).expect("written");
        let mut export = glint(&["export", "--width", "24", "-o"]);
        done(export.args([&frames, &file]))
    };
    let mut scene = flight();
    assert!(again(&scene).contains("202 frames written"));
    // The last key is moved: frames before its neighbour stay.
    let last = scene.animation.keys.len() - 1;
    scene.animation_mut().keys[last].value.position.y += 1.0;
    let said = again(&scene);
    let made: u32 = said
        .split_whitespace()
        .nth(1)
        .and_then(|word| word.parse().ok())
        .expect("a number");
    assert!((1..60).contains(&made), "{said}");
    scene.background.x = 9.0;
    assert!(
        again(&scene).contains("202 frames written"),
        "all of them show the sky's colour"
    );
    // The recording does not affect the pictures.
    scene.animation_mut().take = None;
    assert!(again(&scene).contains("0 frames written, 202 already there"));
}

#[test]
fn what_cannot_be_written_is_told_and_leaves_no_parts() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    // A folder has the name of a frame.
    let obstacle = frames.join("rayTrace7.ppm");
    fs::create_dir_all(&obstacle).expect("made");
    let said = stderr_of(&mut export(&frames, &["--frames", "1-12"]), 1);
    assert!(
        said.contains("rayTrace7.ppm") && said.contains("resumes the export"),
        "{said}"
    );
    fs::remove_dir(&obstacle).expect("removed");
    let made = files(&frames);
    assert!(
        made.keys().all(|name| !name.starts_with(".glint-")),
        "{:?}",
        made.keys()
    );
    assert!((6..12).contains(&made.len()));
    done(&mut export(&frames, &["--frames", "1-12"]));
    assert_eq!(files(&frames).len(), 12);
    // A file has the name of the folder.
    let said = stderr_of(export(&obstacle, &[]).arg("--dry-run"), 1);
    // A dry run writes nothing, so the error is about reading.
    assert!(said.contains("cannot read"), "{said}");
}

/// The system lets a program write only so many bytes, as a full disk does: half a frame.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told_and_gone_on_from() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    done(&mut export(&frames, &["--frames", "1-4"]));
    let whole = export(&frames, &["--frames", "1-9"]);
    let mut limited = Command::new("sh");
    limited.args(["-c", "trap '' XFSZ; ulimit -f 3; exec \"$0\" \"$@\""]);
    limited.arg(whole.get_program()).args(whole.get_args());
    let said = stderr_of(&mut limited, 1);
    assert!(said.contains(".ppm: File too large"), "{said}");
    assert_eq!(files(&frames).len(), 4, "nothing half under a name");
    done(&mut export(&frames, &["--frames", "1-9"]));
    assert_eq!(files(&frames).len(), 9);
}

#[test]
fn a_folder_that_vanishes_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    let sequence = sequence(flight(), None, Format::Ppm, &frames);
    let mut exporting = Exporting::new(sequence).expect("a folder");
    let control = RenderControl::default();
    assert!(matches!(exporting.step(&control), ExportStep::Going));
    fs::remove_dir_all(&frames).expect("removed");
    let error = loop {
        match exporting.step(&control) {
            ExportStep::Failed(error) => break error,
            ExportStep::Going => {}
            other => panic!("{other:?}"),
        }
    };
    assert!(error.to_string().contains("cannot write"), "{error}");
    assert!(
        !frames.exists(),
        "it is not made again behind the user's back"
    );
}

#[test]
fn frames_that_another_export_has_replaced_are_told_before_anything_is_made_of_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = sized_flight(16, 16);
    let mut darker = scene.clone();
    darker.ambient_intensity *= 0.5;
    let begin = |scene: &Scene, frames: &str| {
        let sequence = sequence(scene.clone(), Some(frames), Format::Ppm, folder.path());
        Exporting::new(sequence).expect("a folder")
    };
    let control = RenderControl::default();
    let mut own = begin(&scene, "1-3");
    for _ in 0..2 {
        assert!(matches!(own.step(&control), ExportStep::Going));
    }
    // The same frames written by another program do not count as changed.
    for (scene, is_told) in [(&scene, false), (&darker, true)] {
        let mut other = begin(scene, "1");
        while !matches!(other.step(&control), ExportStep::Done) {}
        other.finish().expect("written");
        while matches!(own.step(&control), ExportStep::Going) {}
        let finished = own.finish();
        assert_eq!(finished.is_err(), is_told, "{finished:?}");
        if let Err(error) = finished {
            let said = error.to_string();
            assert!(
                said.contains("rayTrace1.ppm is no longer the frame"),
                "{said}"
            );
        }
    }
}

#[test]
fn a_frame_too_large_for_the_memory_is_the_whole_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = sized_flight(8200, 2100);
    scene.render.antialias = Sampling::Grid(1);
    let sequence = sequence(scene, Some("7"), Format::Ppm, folder.path());
    let begin = || Exporting::new(sequence.clone()).expect("a folder");
    let mut exporting = begin().side_by_side();
    let control = RenderControl::default();
    control.stop();
    assert!(matches!(exporting.step(&control), ExportStep::Stopped));
    assert!(files(folder.path()).is_empty(), "it is begun again");
    let control = RenderControl::default();
    assert!(matches!(exporting.step(&control), ExportStep::Going));
    let last = exporting.last().expect("what it shows, in small");
    assert_eq!((last.width, last.height), (249, 64));
    assert!(matches!(exporting.step(&control), ExportStep::Done));
    assert_eq!(exporting.finish().expect("written").written, 1);

    let mut again = begin();
    while !matches!(again.step(&control), ExportStep::Done) {}
    assert_eq!(again.finish().expect("there").kept, 1, "its hash is noted");
    let shown = sequence.shown(7);
    let (whole, _) = picture(&shown, &RenderRequest::still(&shown));
    let mut expected = Cursor::new(Vec::new());
    let encoded = whole.encode(Format::Ppm, &mut expected);
    encoded.expect("encodes");
    let (name, bytes) = files(folder.path()).pop_first().expect("a file");
    assert!(bytes == expected.into_inner(), "{name}");
}

#[test]
fn frames_side_by_side_are_the_same_and_none_is_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let exported = |threads: usize, stops: bool| {
        let frames = folder.path().join(format!("{threads} {stops}"));
        let sequence = sequence(sized_flight(48, 48), Some("1-30"), Format::Png, &frames);
        let exporting = Exporting::new(sequence).expect("a folder");
        let mut exporting = exporting.side_by_side();
        let threads = Threads::new(Some(threads)).expect("threads");
        threads.run(|| {
            for round in 0.. {
                let control = RenderControl::default();
                let is_stopped = stops && round % 2 == 1;
                if is_stopped {
                    control.stop();
                }
                match exporting.step(&control) {
                    ExportStep::Going => assert!(!is_stopped),
                    ExportStep::Stopped => assert!(is_stopped),
                    ExportStep::Done => return,
                    ExportStep::Failed(error) => panic!("{error}"),
                }
            }
        });
        let done = exporting.finish().expect("written");
        assert_eq!((done.written, done.kept), (30, 0));
        files(&frames)
    };
    let one = exported(1, false);
    assert_eq!(one.len(), 30);
    assert!(exported(40, false) == one);
    assert!(exported(40, true) == one);
}

#[test]
fn words_are_checked_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    for (words, expected) in [
        (
            &["--frames", "1-203"][..],
            "there is no frame 203: the animation has 202 frames",
        ),
        (&["--frames", "3-1"], "1 comes before 3"),
        (&["--frames", "-3"], "expected frames such as 1-202"),
        (&["--name", "frame"], "the name needs %d"),
        (&["--name", "../%d"], "the name must not contain folders"),
        (&["--video", "a.avi"], "use .mp4, .mov, .mkv, .gif or .apng"),
        (&["--format", "JPG"], "expected ppm, png or exr"),
        (&["--format", "PNG", "--name", "frame"], "the name needs %d"),
    ] {
        let said = stderr_of(&mut export(&frames, words), 2);
        assert!(said.contains(expected), "{words:?}: {said}");
    }
    assert!(!frames.exists());
}

#[test]
fn runners_are_told_how_far_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let said = done(&mut export(
        folder.path(),
        &["--frames", "1,4-5", "--openjd"],
    ));
    let lines: Vec<&str> = said.lines().collect();
    assert!(lines.contains(&"openjd_progress: 100"), "{said}");
    assert!(said.contains("openjd_status: "), "{said}");
    let shares = lines
        .iter()
        .filter_map(|line| line.strip_prefix("openjd_progress: "));
    let shares: Vec<f64> = shares
        .map(|share| share.parse().expect("a number"))
        .collect();
    // Each only once, as a runner keeps every line.
    assert!(
        shares.windows(2).all(|pair| pair[0] < pair[1]),
        "{shares:?}"
    );
}

/// The frames of a GIF as RGBA.
fn gif_frames(path: &str) -> Vec<gif::Frame<'static>> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let file = std::io::BufReader::new(fs::File::open(path).expect("there"));
    let frames = options.read_info(file).expect("a GIF").into_iter();
    frames.map(|frame| frame.expect("whole")).collect()
}

#[test]
fn videos_without_ffmpeg_hold_every_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let video = |name: &str| folder.path().join(name).to_str().expect("plain").to_owned();
    let (gif, apng) = (video("flight.gif"), video("flight.apng"));
    let frames = folder.path().join("frames");
    done(&mut export(
        &frames,
        &["--frames", "1-9:2", "--video", &gif, "--format", "png"],
    ));
    done(&mut export(
        &frames,
        &["--frames", "1-9:2", "--video", &apng, "--format", "png"],
    ));
    let shown = gif_frames(&gif);
    assert_eq!(shown.len(), 5);
    assert_eq!(
        shown[0].delay, 14,
        "2/14 s in hundredths: every second frame plays at the speed of all"
    );
    // Each matches its own frame best, although several are encoded in parallel.
    let plain = |frame| image::open(frames.join(format!("rayTrace{frame}.png"))).expect("there");
    let plain: Vec<Vec<u8>> = (1..=9)
        .step_by(2)
        .map(|frame| plain(frame).to_rgba8().into_raw())
        .collect();
    for (place, shown) in shown.iter().enumerate() {
        let off = |plain: &&Vec<u8>| -> u32 {
            let both = shown.buffer.iter().zip(plain.iter());
            both.map(|(a, b)| u32::from(a.abs_diff(*b))).sum()
        };
        assert_eq!(
            plain.iter().min_by_key(off),
            plain.get(place),
            "frame {place}"
        );
    }
    let file = std::io::BufReader::new(fs::File::open(&apng).expect("there"));
    let decoder = image::codecs::png::PngDecoder::new(file).expect("a PNG");
    let shown = decoder
        .apng()
        .expect("animated")
        .into_frames()
        .collect_frames()
        .expect("frames");
    assert_eq!(shown.len(), 5);
    for (frame, shown) in (1..=9).step_by(2).zip(&shown) {
        let plain = image::open(frames.join(format!("rayTrace{frame}.png"))).expect("there");
        assert_eq!(
            shown.buffer(),
            &plain.to_rgba8(),
            "frame {frame} is lossless"
        );
    }
    // Without ffmpeg, the error shows the exact command; with it, there is a video.
    let mp4 = video("flight.mp4");
    let words = ["--frames", "1-9:2", "--video", &mp4];
    let said = stderr_of(export(&frames, &words).env("PATH", ""), 1);
    assert!(
        said.contains("ffmpeg -framerate 7") || said.contains("ffmpeg -f image2pipe"),
        "{said}"
    );
    // Of consecutive frames no more than requested, even where others exist in the folder.
    let few = ["--frames", "3-5", "--video", &mp4];
    let said = stderr_of(export(&frames, &few).env("PATH", ""), 1);
    assert!(said.contains("-frames:v 3 "), "{said}");
    let left = names(folder.path());
    assert!(left.iter().all(|name| !name.contains("part")), "{left:?}");
}

#[test]
#[ignore = "needs ffmpeg"]
fn ffmpeg_makes_videos_of_all_frames() {
    let folder = tempfile::tempdir().expect("a folder");
    let frames = folder.path().join("frames");
    for (name, format) in [("a.mp4", "ppm"), ("b.mov", "png"), ("c.mkv", "ppm")] {
        let video = folder.path().join(name);
        let path = video.to_str().expect("plain");
        done(&mut export(
            &frames,
            &["--frames", "1-28", "--video", path, "--format", format],
        ));
        let mut probe = Command::new("ffprobe");
        probe.args([
            "-v",
            "error",
            "-count_frames",
            "-show_entries",
            "stream=nb_read_frames,r_frame_rate",
        ]);
        let said = done(probe.args(["-of", "csv=p=0", path]));
        assert_eq!(said.trim(), "14/1,28", "{name}");
    }
    // Without this information, players guess the colour space from the size.
    for name in ["a.mp4", "b.mov"] {
        let mut probe = Command::new("ffprobe");
        probe.args(["-v", "error", "-show_entries"]);
        probe.args(["stream=color_range,color_space,color_transfer,color_primaries"]);
        let said = done(probe.args(["-of", "csv=p=0"]).arg(folder.path().join(name)));
        assert_eq!(said.trim(), "tv,bt709,bt709,bt709", "{name}");
    }
    // Byte by byte the same every time.
    let path = |name: &str| folder.path().join(name).to_str().expect("plain").to_owned();
    for name in ["a.mp4", "b.mov", "c.mkv"] {
        let first = fs::read(folder.path().join(name)).expect("there");
        done(&mut export(
            &frames,
            &["--frames", "1-28", "--video", &path(name)],
        ));
        assert!(
            fs::read(folder.path().join(name)).expect("there") == first,
            "{name}"
        );
    }
    // Frames that were left out are not waited for.
    let uneven = ["--frames", "1,5,6", "--video", &path("uneven.gif")];
    let said = stderr_of(&mut export(&frames, &uneven), 0);
    assert!(said.contains("not equally far apart"), "{said}");
    // H.264 requires even sides.
    let odd = ["--frames", "1-2", "--video", &path("odd.mp4")];
    let said = stderr_of(&mut at_rate(folder.path(), "14", (31, 17), &odd), 0);
    assert!(said.contains("it shows 30 × 16 pixels"), "{said}");
    for name in ["stopped.mp4", "stopped.mov", "stopped.mkv"] {
        gives_up(&frames, name);
    }
}

/// Starts to make a video of existing frames, and cancels it.
fn gives_up(frames: &Path, name: &str) {
    let sequence = sequence(sized_flight(48, 48), Some("1-9"), Format::Ppm, frames);
    let path = frames.join(name);
    let video = Video::of_path(&path).expect("known");
    let made = video.make(&sequence, &path, |_| false);
    assert!(matches!(made, Err(VideoError::Stopped)), "{name}: {made:?}");
    let left = files(frames).into_keys();
    let left: Vec<String> = left.filter(|name| !name.starts_with("rayTrace")).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn no_video_is_made_of_frames_that_another_export_has_put_there() {
    let folder = tempfile::tempdir().expect("a folder");
    done(&mut export(folder.path(), &["--frames", "1-9"]));
    let sequence = sequence(
        sized_flight(48, 48),
        Some("1-9"),
        Format::Ppm,
        folder.path(),
    );
    let path = folder.path().join("a.apng");
    let video = Video::of_path(&path).expect("known");
    let made = video.make(&sequence, &path, |count| {
        // Of the same size, while other frames are being read.
        if count == 3 {
            let other = ["--frames", "7", "--antialias", "none"];
            done(&mut export(folder.path(), &other));
        }
        true
    });
    let is_told = matches!(&made, Err(VideoError::Export(ExportError::Changed { path })) if *path == sequence.path(7));
    assert!(is_told, "{made:?}");
    assert!(!path.exists());
}

#[test]
fn a_video_that_is_not_wanted_any_more_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    done(&mut export(folder.path(), &["--frames", "1-9"]));
    for name in ["a.gif", "b.apng"] {
        gives_up(folder.path(), name);
    }
}

/// Programs named `ffmpeg` that misbehave.
#[test]
#[cfg(unix)]
fn what_ffmpeg_says_is_heard_and_what_it_does_not_write_takes_no_ones_place() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a folder");
    let video = folder.path().join("d.mp4");
    let path = video.to_str().expect("plain");
    let others = std::env::var("PATH").unwrap_or_default();
    for (script, sentence) in [
        (
            "echo no such codec >&2\nexit 3",
            "ffmpeg failed:\nno such codec",
        ),
        ("cat >/dev/null\nexit 0", "it wrote nothing"),
        ("exit 0", "it ended before it had received all frames"),
        ("printf 'a\\033[2Jb' >&2\nexit 3", "ffmpeg failed:\na [2Jb"),
        // More than a pipe holds, before it reads frames that are more than a pipe holds as well.
        ("seq 100000 >&2\ncat >/dev/null\nexit 3", "99999\n100000"),
    ] {
        let program = folder.path().join("ffmpeg");
        fs::write(&program, format!("#!/bin/sh\n{script}\n")).expect("written");
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("ours");
        fs::write(&video, "older").expect("written");
        let words = ["--frames", "1-28", "--video", path];
        let mut command = at_rate(folder.path(), "14", (64, 64), &words);
        let search = format!("{}:{others}", folder.path().display());
        let said = stderr_of(command.env("PATH", search), 1);
        assert!(said.contains(sentence), "{script}: {said}");
        assert_eq!(
            fs::read_to_string(&video).expect("there"),
            "older",
            "{script}"
        );
    }
}

#[test]
#[cfg(unix)]
fn what_may_only_be_read_is_not_replaced() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("kept.png");
    fs::write(&picture, "a photograph").expect("written");
    fs::set_permissions(&picture, fs::Permissions::from_mode(0o444)).expect("ours");
    let path = picture.to_str().expect("plain");
    let said = stderr_of(
        &mut glint(&["render", FLIGHT, "--width", "8", "-o", path]),
        1,
    );
    assert!(
        said.contains("kept.png") && said.contains("the file is read-only"),
        "{said}"
    );
    assert_eq!(fs::read_to_string(&picture).expect("there"), "a photograph");
    // The name of a folder is refused before anything is traced, too.
    let csv = format!("{}/new.csv/", folder.path().display());
    let said = stderr_of(&mut glint(&["chart", FLIGHT, "--csv", &csv]), 1);
    assert!(said.contains("this is the name of a folder"), "{said}");
}

#[test]
fn a_job_is_a_template_with_its_scene_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let template = folder.path().join("job.yaml");
    let path = template.to_str().expect("plain");
    let said = done(&mut glint(&["job", FLIGHT, "-o", path, "--frames", "1-12"]));
    assert!(said.contains("a job of 12 frames"), "{said}");
    let text = fs::read_to_string(&template).expect("written");
    for expected in [
        "jobtemplate-2023-09",
        "\"1-12\"",
        "CHUNK[INT]",
        "dependsOn: Render",
        "\"flight.ron\"",
    ] {
        assert!(text.contains(expected), "{expected} in {text}");
    }
    let copy = fs::read(folder.path().join("flight.ron")).expect("copied");
    assert!(copy == fs::read(FLIGHT).expect("there"));
}

#[test]
fn a_job_has_a_name_that_farms_take_whatever_the_scene_is_called() {
    let folder = tempfile::tempdir().expect("a folder");
    let template = folder.path().join("job.yaml");
    let path = template.to_str().expect("plain");
    for (name, expected) in [
        ("a {{{Param.Scene}}}\tb".to_owned(), "a { {Param.Scene} }b"),
        ("n".repeat(200), &*"n".repeat(128)),
    ] {
        let scene = folder.path().join(format!("{name}.ron"));
        fs::copy(FLIGHT, &scene).expect("copied");
        done(glint(&["job", "-o", path]).arg(scene));
        let text = fs::read_to_string(&template).expect("written");
        let line = format!("\nname: \"{expected}\"\n");
        assert!(text.contains(&line), "{text}");
    }
}

/// Waits until no export is running.
fn finish(harness: &mut EditorHarness) {
    harness.wait_for("the end of the export", |harness| {
        !harness.window.state().is_exporting()
    });
    harness.settle();
}

/// Waits until the window shows a text.
fn see(harness: &mut EditorHarness, text: &str) {
    harness.wait_for(text, |harness| harness.sees(text));
}

#[test]
fn the_window_exports_what_the_command_line_does_and_edits_do_not_leak() {
    let mut harness = EditorHarness::on(flight());
    let folder = harness.folder.path().join("frames");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    harness.type_name("folder", folder.to_str().expect("plain"));
    harness.type_name("frames", "1-40:3");
    harness.type_into("export width", "48");
    harness.type_into("export height", "48");
    harness.assert_says("rayTrace0001.png … rayTrace0040.png");
    see(&mut harness, "14 frames to make");
    harness.click("gif");
    harness.click("Start export");
    // Edit the scene during the export.
    for frame in 0..20 {
        harness
            .window
            .key_press(if frame % 2 == 0 { Key::U } else { Key::I });
        harness.window.step();
    }
    harness.press(Modifiers::NONE, Key::U);
    assert!(!harness.scene().light_visualization);
    finish(&mut harness);
    let mut made = files(&folder);
    assert!(
        made.remove("frames.gif")
            .is_some_and(|gif| gif.starts_with(b"GIF89a"))
    );
    let alone = harness.folder.path().join("alone");
    let format = ["--format", "png", "--name", "rayTrace%04d"];
    done(export(&alone, &format).args(["--frames", "1-40:3"]));
    assert!(
        made == files(&alone),
        "the same bytes, as the scene was at the start"
    );
    harness.assert_says("14 frames in");
    harness.assert_says("png + gif");
    harness.assert_says("14 frames and frames.gif");
    harness.click("Remove");
    // With the lights' markers hidden, the frames that showed one are different.
    see(&mut harness, "replace older files");
    harness.window.get_by_label("Start export").click();
    harness.window.step();
    // A second click requests nothing more.
    see(&mut harness, "These files are being written");
    harness.window.get_by_label("Start export").click();
    finish(&mut harness);
    let rows = harness
        .window
        .query_all_by_label_contains("14 frames and frames.gif");
    assert_eq!(rows.count(), 1);
    see(&mut harness, "all 14 frames already exist, then frames.gif");
    harness.type_name("frames", "nonsense");
    harness.assert_says("expected frames such as");
}

#[test]
fn an_export_that_failed_says_why_and_can_be_taken_up() {
    let mut harness = EditorHarness::on(flight());
    let folder = harness.folder.path().join("frames");
    fs::write(&folder, "no folder").expect("written");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    harness.type_name("folder", folder.to_str().expect("plain"));
    harness.type_name("frames", "1-2");
    harness.type_into("export width", "16");
    harness.click("Start export");
    finish(&mut harness);
    // Once in the message, once in the list.
    let why = harness
        .window
        .query_all_by_label_contains("is not a folder");
    assert_eq!(why.count(), 2);
    assert!(harness.window.query_by_label("Not finished").is_none());
    fs::remove_file(&folder).expect("removed");
    harness.click("Resume");
    finish(&mut harness);
    assert_eq!(files(&folder).len(), 2);
    assert!(harness.window.query_by_label("Resume").is_none());
}

#[test]
fn the_size_of_frames_keeps_the_shape_of_the_picture_until_it_is_freed() {
    let wide = fs::read_to_string("scenes/mirrors.ron").expect("readable");
    let mut harness = EditorHarness::with(|_| Vec::new(), Some(&wide));
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    let size = |harness: &EditorHarness| {
        ["export width", "export height"].map(|side| {
            let field = harness.window.get_by_role_and_label(Role::SpinButton, side);
            field.value().expect("a number")
        })
    };
    harness.type_into("export width", "640");
    assert_eq!(size(&harness), ["640 px", "400 px"]);
    harness.type_into("export height", "1600");
    assert_eq!(size(&harness), ["2560 px", "1600 px"]);
    harness.click("keep aspect ratio");
    harness.type_into("export width", "320");
    assert_eq!(size(&harness), ["320 px", "1600 px"]);
}

#[test]
fn quitting_asks_while_frames_are_exported_and_the_next_window_resumes_them() {
    let data = tempfile::tempdir().expect("a folder");
    let mut harness = EditorHarness::kept_in(data.path(), FLIGHT.into());
    let folder = data.path().join("frames");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    harness.type_name("folder", folder.to_str().expect("plain"));
    harness.type_into("export width", "512");
    harness.type_into("export height", "512");
    see(&mut harness, "202 frames to make");
    harness.window.get_by_label("Start export").click();
    harness.window.step();
    see(&mut harness, "/202");
    harness.window.key_press_modifiers(CTRL, Key::Q);
    see(&mut harness, "Quit while exporting?");
    harness.assert_says("Export animation can resume it next time");
    harness.window.get_by_label("Stay").click();
    harness.window.step();
    harness.window.step();
    assert!(
        harness
            .window
            .query_by_label("Quit while exporting?")
            .is_none()
    );
    assert!(harness.window.state().is_exporting());
    wait_until("a frame", || folder.join("rayTrace0003.png").exists());
    // With unsaved changes, a single question covers both.
    harness.window.key_press(Key::O);
    harness.window.step();
    harness.window.key_press_modifiers(CTRL, Key::Q);
    see(&mut harness, "Export animation can resume it next time");
    harness.window.get_by_label("Don't save").click();
    for _ in 0..3 {
        harness.window.step();
    }
    assert!(!harness.window.state().is_asking());
    drop(harness);

    // The next window opens another scene, and makes the frames of this one.
    let mut harness = EditorHarness::kept_in(data.path(), "scenes/mirrors.ron".into());
    see(&mut harness, "An export is not finished");
    let before = fs::read_dir(&folder).expect("there").count();
    assert!((2..203).contains(&before), "{before} files");
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    harness.window.get_by_label("Not finished");
    harness.click("Resume");
    finish(&mut harness);
    harness.assert_says("202 frames in");
    assert!(harness.window.query_by_label("Not finished").is_none());
    drop(harness);
    let pattern = Pattern::parse("rayTrace%04d").expect("a pattern");
    let flight = Arc::new(sized_flight(512, 512));
    let sequence = Sequence::new(flight, None, pattern, Format::Png, folder);
    let sequence = sequence.expect("these frames exist");
    assert_eq!(sequence.missing().expect("readable").count(), 0);
    // It has ended, so it is not reported again.
    let harness = EditorHarness::kept_in(data.path(), FLIGHT.into());
    let told = harness.window.query_by_label_contains("interrupted");
    assert!(told.is_none());
}

#[test]
fn frames_of_light_hold_what_eight_bits_round() {
    let folder = tempfile::tempdir().expect("a folder");
    let (light, levels) = (folder.path().join("exr"), folder.path().join("png"));
    let gif = folder.path().join("flight.gif");
    let gif = gif.to_str().expect("plain");
    done(&mut export(
        &light,
        &["--frames", "1-5:2", "--format", "exr", "--video", gif],
    ));
    done(&mut export(
        &levels,
        &["--frames", "1-5:2", "--format", "png"],
    ));
    for frame in [1, 3, 5] {
        let light = image::open(light.join(format!("rayTrace{frame}.exr"))).expect("an EXR");
        let levels = image::open(levels.join(format!("rayTrace{frame}.png"))).expect("a PNG");
        assert!(light.as_rgb32f().is_some(), "32 bits a channel");
        let (light, levels) = (light.to_rgb32f().into_raw(), levels.to_rgb8().into_raw());
        let off = light.iter().zip(&levels);
        let off = off.map(|(light, level)| (light * 255.0 - f32::from(*level)).abs());
        assert!(off.fold(0.0, f32::max) < 0.501, "frame {frame}");
        let is_between = |light: &&f32| (**light * 255.0).fract() != 0.0;
        assert!(light.iter().filter(is_between).count() > 100);
    }
    // Valid existing frames stay.
    let said = done(&mut export(
        &light,
        &["--frames", "1-5:2", "--format", "exr"],
    ));
    assert!(said.contains("3 already there"), "{said}");
}

#[test]
fn the_window_writes_a_farm_job_and_its_scene() {
    let answer = |folder: &Path| vec![(Ask::ExportJob, Some(folder.join("job.yaml")))];
    let mut harness = EditorHarness::with(answer, None);
    harness.choose("File", "Export farm job…");
    harness.assert_says("job.yaml and ");
    let template = fs::read_to_string(harness.folder.path().join("job.yaml")).expect("written");
    assert!(template.contains("\"job.ron\"") && template.contains("\"1\""));
    let scene = Document::load(&harness.folder.path().join("job.ron"))
        .expect("a scene")
        .scene;
    assert_eq!(&scene, harness.scene());
}

#[test]
fn the_window_and_the_command_line_write_the_same_scene_for_povray() {
    let answer = |folder: &Path| vec![(Ask::ExportPovray, Some(folder.join("demo.pov")))];
    let mut harness = EditorHarness::with(answer, None);
    harness.choose("File", "Export for POV-Ray…");
    harness.assert_says("Saved ");
    let by_window = fs::read_to_string(harness.folder.path().join("demo.pov")).expect("written");
    assert_eq!(by_window.matches("\ntriangle {").count(), 6);
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("demo.pov");
    let to = to.to_str().expect("a plain name");
    let demo = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron");
    let said = done(&mut glint(&["convert", demo, "-o", to]));
    assert!(said.contains("povray +I"), "{said}");
    assert_eq!(fs::read_to_string(to).expect("written"), by_window);
    // Independent of the name of the scene's file.
    let other = folder.path().join("demo.txt");
    fs::copy(demo, &other).expect("copied");
    fs::remove_file(to).expect("there");
    done(glint(&["convert", "-o", to]).arg(other));
    assert_eq!(fs::read_to_string(to).expect("written"), by_window);
}

#[test]
fn a_mesh_that_is_converted_over_a_scene_leaves_a_backup_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("mine.ron");
    let document = Document::of(flight());
    document.save(&scene).expect("saved");
    let before = fs::read(&scene).expect("readable");
    let convert = || {
        let mut convert = glint(&["convert", "scenes/knot.ply", "-o"]);
        convert.arg(&scene);
        done(&mut convert);
        names(folder.path())
    };
    assert_eq!(convert(), ["mine.ron", "mine.ron.bak"]);
    let backup = fs::read(folder.path().join("mine.ron.bak")).expect("readable");
    assert!(backup == before && before != fs::read(&scene).expect("readable"));
    assert_eq!(convert(), ["mine.ron", "mine.ron.bak"], "nothing is lost");
}

#[test]
fn an_export_waits_goes_on_and_is_given_up() {
    let folder = tempfile::tempdir().expect("a folder");
    let sequence = |name: &str, frames: &str| {
        let folder = folder.path().join(name);
        sequence(flight(), Some(frames), Format::Ppm, &folder)
    };
    let worker = Worker::new(Some(2), || ()).expect("a render thread");
    let first = worker.export(sequence("first", "1-202")).expect("a folder");
    let second = worker.export(sequence("second", "1-3")).expect("a folder");
    let state = |id: u64| worker.exports().into_iter().find(|state| state.id == id);
    wait_until("it starts", || {
        state(first).is_some_and(|state| state.done.written > 2)
    });
    worker.pause_export(first, true);
    // While the first is paused, the second is made.
    wait_until("the second ends", || {
        state(second).is_some_and(|state| state.ended == Some(Ok(())))
    });
    let at = state(first).expect("listed").done.written;
    sleep(Duration::from_millis(50));
    let still = state(first).expect("listed").done.written;
    assert!(
        still <= at + 3,
        "only what was on its way came: {at} {still}"
    );
    assert!(state(first).expect("listed").last.is_some());
    worker.pause_export(first, false);
    wait_until("it goes on", || {
        state(first).is_some_and(|state| state.done.written > still + 3)
    });
    worker.forget_export(first);
    worker.forget_export(second);
    let third = worker.export(sequence("second", "1-3")).expect("a folder");
    assert!(third > second, "no name is given twice");
    wait_until("the third ends", || {
        state(third).is_some_and(|state| state.done.kept == 3)
    });
    wait_until("and is done", || !worker.is_exporting());
    assert!(state(first).is_none() && !worker.is_exporting());
    drop(worker);
    // Frames that were written stay complete, and the next export uses them.
    let left = sequence("first", "1-202")
        .missing()
        .expect("readable")
        .count();
    assert!(left < 202 - still, "{left} left");
}

/// The template is run by the reference runner, in chunks, and gives the same bytes as the program alone.
#[test]
#[ignore = "needs openjd-cli from PyPI on the PATH"]
fn a_farm_makes_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let template = folder.path().join("job.yaml");
    let path = template.to_str().expect("plain");
    done(&mut glint(&[
        "job", FLIGHT, "-o", path, "--frames", "1-12", "--width", "48",
    ]));
    let (farm, alone) = (folder.path().join("farm"), folder.path().join("alone"));
    let parameter = |name: &str, value: &str| format!("{name}={value}");
    let program = parameter("Glint", env!("CARGO_BIN_EXE_glint"));
    let output = parameter("Output", farm.to_str().expect("plain"));
    let mut openjd = Command::new("openjd");
    openjd.args(["run", path, "--step", "Encode", "--run-dependencies"]);
    openjd.args(["-p", &program, "-p", &output, "-p", "Video=flight.gif"]);
    done(openjd.args(["--extensions", "TASK_CHUNKING"]));
    done(&mut export(&alone, &["--frames", "1-12"]));
    let mut made = files(&farm);
    assert!(
        made.remove("flight.gif")
            .is_some_and(|gif| gif.starts_with(b"GIF89a"))
    );
    assert!(made == files(&alone));
}

/// The commands of the README, run by Slurm with one node and by GNU parallel.
#[test]
#[ignore = "needs Slurm and GNU parallel (Debian packages slurmctld, slurmd, slurm-client, munge, parallel)"]
fn clusters_make_the_same_bytes_by_the_lines_of_the_readme() {
    let of_project = |path: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let mut script = Command::new("bash");
    script.arg(of_project("tests/it/farm.sh"));
    script.arg(env!("CARGO_BIN_EXE_glint")).arg(FLIGHT);
    let said = done(script.arg(of_project("README.md")));
    assert_eq!(said.matches("202 frames").count(), 2, "{said}");
}

#[test]
fn a_job_brings_its_meshes_and_keeps_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let template = folder.path().join("job.yaml");
    let path = template.to_str().expect("plain");
    let knot = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/knot.ron");
    done(&mut glint(&["job", knot, "-o", path, "--format", "exr"]));
    let text = fs::read_to_string(&template).expect("written");
    assert!(text.contains("\"knot-whole.ron\"") && text.contains("allowedValues: [ppm, png, exr]"));
    let load = |path: &Path| Document::load(path).expect("a scene").scene;
    let whole = load(&folder.path().join("knot-whole.ron"));
    assert_eq!(whole.mesh_problems().count(), 0);
    assert_eq!(whole.faces(), load(Path::new(knot)).faces());

    let other = folder.path().join("flight.ron");
    fs::write(&other, "what somebody else made").expect("written");
    let said = done(&mut glint(&["job", FLIGHT, "-o", path]));
    assert!(said.contains("kept as"), "{said}");
    let kept = fs::read_to_string(folder.path().join("flight.ron.bak")).expect("kept");
    assert_eq!(kept, "what somebody else made");
    assert!(fs::read(&other).expect("copied") == fs::read(FLIGHT).expect("there"));

    // An older template is replaced; a file that is none, or that was changed by hand, is kept.
    let backup = folder.path().join("job.yaml.bak");
    assert!(!backup.exists());
    let by_hand = fs::read_to_string(&template).expect("there") + "# for the night\n";
    fs::write(&template, &by_hand).expect("written");
    let said = done(&mut glint(&["job", FLIGHT, "-o", path]));
    assert!(said.contains("job.yaml.bak"), "{said}");
    assert_eq!(fs::read_to_string(&backup).expect("kept"), by_hand);
    let notes = folder.path().join("notes.txt");
    fs::write(&notes, "what to buy").expect("written");
    let path = notes.to_str().expect("plain");
    let said = done(&mut glint(&["job", FLIGHT, "-o", path]));
    assert!(said.contains("notes.txt.bak"), "{said}");
    let kept = fs::read_to_string(folder.path().join("notes.txt.bak"));
    assert_eq!(kept.expect("kept"), "what to buy");
}

#[test]
fn a_job_takes_no_ones_place_and_no_backup_that_of_another() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("s.ron");
    fs::copy(FLIGHT, &scene).expect("copied");
    let path = scene.to_str().expect("plain");
    let said = stderr_of(&mut glint(&["job", path, "-o", path]), 2);
    assert!(
        said.contains("is the scene") && said.contains("s.yaml"),
        "{said}"
    );
    assert!(fs::read(&scene).expect("there") == fs::read(FLIGHT).expect("there"));
    // Nothing is moved for a template that cannot be written.
    let blocked = folder.path().join("blocked");
    fs::create_dir_all(blocked.join("job.yaml")).expect("folders");
    fs::write(blocked.join("s.ron"), "mine").expect("written");
    let template = blocked.join("job.yaml");
    stderr_of(glint(&["job", path, "-o"]).arg(template), 1);
    assert_eq!(names(&blocked), ["job.yaml", "s.ron"]);
    assert_eq!(
        fs::read_to_string(blocked.join("s.ron")).expect("there"),
        "mine"
    );
    // A scene can be read from a pipe only once.
    let piped = folder.path().join("piped.yaml");
    let text = fs::File::open(&scene).expect("there");
    let mut cat = Command::new("cat")
        .stdin(text)
        .stdout(Stdio::piped())
        .spawn()
        .expect("cat");
    let pipe = cat.stdout.take().expect("a pipe");
    let mut job = glint(&["job", "/dev/stdin", "-o", piped.to_str().expect("plain")]);
    done(job.stdin(pipe));
    cat.wait().expect("ended");
    let copy = Document::load(&folder.path().join("stdin.ron")).expect("a scene");
    assert_eq!(copy.scene, Document::load(&scene).expect("a scene").scene);
    // Two other files under its name are both kept.
    let inner = folder.path().join("jobs");
    fs::create_dir(&inner).expect("a folder");
    let template = inner.join("job.yaml");
    for text in ["one", "another"] {
        fs::write(inner.join("s.ron"), text).expect("written");
        done(glint(&["job", path, "-o"]).arg(&template));
    }
    let kept =
        ["s.ron.bak", "s.ron.bak2"].map(|name| fs::read_to_string(inner.join(name)).expect("kept"));
    assert_eq!(kept, ["one", "another"]);
    // A thousand frames, every third one, in a single piece.
    let mut long = Document::load(FLIGHT.as_ref()).expect("a scene");
    long.scene.animation_mut().frames_per_second = 240.0;
    long.save(&scene).expect("saved");
    let mut job = glint(&["job", path, "--frames", "1-3000:3", "-o"]);
    done(job.arg(&template));
    assert!(
        fs::read_to_string(&template)
            .expect("there")
            .contains("\"1-2998:3\"")
    );
}

#[test]
fn no_frame_is_made_without_a_mesh_that_is_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("knot.ron");
    fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/knot.ron"),
        &scene,
    )
    .expect("copied");
    let path = scene.to_str().expect("plain");
    let made = folder.path().join("made.png");
    let place = made.to_str().expect("plain");
    for words in [
        ["export", path, "-o", place, "--frames", "1"],
        ["render", path, "-o", place, "--frame", "1"],
    ] {
        let said = stderr_of(glint(&words).args(["--width", "20"]), 1);
        assert!(
            said.contains(
                "knot.ron:21:9: \"Knot\" cannot be shown, and no frame is made without it: "
            ) && said.contains("knot.ply"),
            "{said}"
        );
        assert!(!made.exists());
    }
}

/// The disk is full at the last bytes of a GIF, which its encoder writes when it is dropped.
#[test]
#[cfg(target_os = "linux")]
fn a_video_that_is_cut_off_takes_no_ones_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let (frames, video) = (folder.path().join("frames"), folder.path().join("b.gif"));
    let words = [
        "--frames",
        "1-20",
        "--video",
        video.to_str().expect("plain"),
        "--format",
        "png",
    ];
    done(&mut export(&frames, &words));
    let whole = fs::read(&video).expect("there");
    fs::write(&video, "older").expect("written");
    let again = export(&frames, &words);
    let mut limited = Command::new("bash");
    limited.args(["-c", "trap '' XFSZ; ulimit -f $0; exec \"$@\""]);
    limited.arg(((whole.len() - 1) / 1024).to_string());
    limited.arg(again.get_program()).args(again.get_args());
    let said = stderr_of(&mut limited, 1);
    assert!(said.contains("b.gif: File too large"), "{said}");
    assert_eq!(fs::read_to_string(&video).expect("there"), "older");
}

#[test]
fn at_another_rate_all_frames_are_still_all() {
    let mut harness = EditorHarness::on(flight());
    harness.press(CTRL.plus(Modifiers::SHIFT), Key::E);
    see(&mut harness, "202 frames to make");
    harness.type_into("export frames per second", "28");
    see(&mut harness, "403 frames to make");
    harness.type_name("frames", "1-10");
    harness.type_into("export frames per second", "7");
    see(&mut harness, "10 frames to make");
}
