//! External faults: the program is killed or suspended, the disk is full, the folder belongs to somebody else.
//! Existing files are not lost, and failures are reported.
#![cfg(unix)]

use std::fmt::Write as _;
use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use glam::DVec3;
use glint::scene::{Document, Object, Recovery, Scene, Sphere};

use crate::program::{self, FLIGHT, done, names, stderr_of, wait_until};
use crate::random::Dice;

/// Number of programs that are killed while they save.
const KILLS: usize = 300;

fn glint(folder: &Path, words: &[&str]) -> Command {
    let mut command = program::glint(words);
    command.current_dir(folder);
    command
}

/// Writes a mesh file of two parts with this many faces; converted, it gives a scene file that contains them.
fn write_mesh(path: &Path, faces: usize) {
    let mut text = String::new();
    for face in 0..faces {
        let _ = writeln!(
            text,
            "{}v {face} 0 0\nv {face} 1 0\nv {face} 0 {face}.5\nf -3 -2 -1",
            if face % (faces / 2) == 0 {
                format!("g part{face}\n")
            } else {
                String::new()
            }
        );
    }
    fs::write(path, text).expect("written");
}

#[test]
fn whoever_is_killed_while_saving_leaves_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let saved = folder.join("scene.ron");
    let save = |mesh: &str| glint(folder, &["convert", mesh, "-o", "scene.ron"]);
    let mut whole = Vec::new();
    let mut longest = Duration::ZERO;
    for (mesh, faces) in [("one.obj", 2000), ("other.obj", 3000)] {
        write_mesh(&folder.join(mesh), faces);
        let start = Instant::now();
        done(&mut save(mesh));
        longest = longest.max(start.elapsed());
        whole.push(fs::read(&saved).expect("saved"));
    }
    let mut dice = Dice(11);
    let (mut kills, mut left) = (0, 0);
    for mesh in ["one.obj", "other.obj"].into_iter().cycle() {
        if kills == KILLS {
            break;
        }
        let mut child = save(mesh).stdout(Stdio::null()).spawn().expect("it runs");
        sleep(longest.mul_f64(dice.real(0.1, 1.0)));
        if child.try_wait().expect("a child").is_none() {
            child.kill().expect("killed");
            kills += 1;
        }
        child.wait().expect("ended");
        left = left.max(names(folder).len());
        let bytes = fs::read(&saved).expect("there is always one");
        assert!(
            whole.contains(&bytes),
            "after {kills} kills: {} bytes",
            bytes.len()
        );
    }
    assert!(left > 5, "no program was killed while it wrote");
    done(&mut save("one.obj"));
    // Each of the two scenes was replaced by the other one, and is kept once.
    let backups = ["scene.ron.bak", "scene.ron.bak2"];
    assert_eq!(
        names(folder),
        [&["one.obj", "other.obj", "scene.ron"][..], &backups].concat(),
        "what dead programs left is gone"
    );
    for backup in backups {
        let bytes = fs::read(folder.join(backup)).expect("readable");
        assert!(whole.contains(&bytes), "{backup}: {} bytes", bytes.len());
    }
}

/// Environment variable with the folder in which [`keeps_unsaved_work_until_it_is_killed`] works.
const KEPT_IN: &str = "GLINT_TEST_KEPT_IN";

#[test]
#[ignore = "is what the test of kills while unsaved work is kept runs and kills"]
fn keeps_unsaved_work_until_it_is_killed() {
    let Some(folder) = std::env::var_os(KEPT_IN) else {
        return;
    };
    let place = Recovery::new(Path::new(&folder)).expect("a place");
    for step in 1.. {
        let text = unsaved(step).to_text().expect("text");
        place.keep(&text, None, None).expect("kept");
    }
}

/// The document after a number of steps; the file grows within each hundred steps.
fn unsaved(step: usize) -> Document {
    let mut document = Document::of(Scene::empty());
    document.scene.ambient_intensity = 1.0 / step as f64;
    for number in 0..200 + 10 * (step % 100) {
        let center = DVec3::splat(number as f64);
        let ball = Sphere {
            center,
            radius: 1.0,
        };
        document
            .scene
            .objects
            .push(Object::new(format!("Ball {number}"), "pack 1", ball));
    }
    document
}

#[test]
fn whoever_is_killed_while_work_is_kept_leaves_all_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let is_kept = |name: &String| name.starts_with("unsaved") && name.contains(".ron");
    let mut dice = Dice(12);
    let mut found = 0;
    for _ in 0..KILLS / 3 {
        let program = std::env::current_exe().expect("this test");
        let helper = "faults::keeps_unsaved_work_until_it_is_killed";
        let mut child = Command::new(program)
            .args(["--exact", "--ignored", helper])
            .env(KEPT_IN, folder.path())
            .stdout(Stdio::null())
            .spawn()
            .expect("it runs");
        wait_until("kept work", || names(folder.path()).iter().any(is_kept));
        sleep(Duration::from_secs_f64(dice.real(0.0, 0.05)));
        child.kill().expect("killed");
        child.wait().expect("ended");
        let next = Recovery::new(folder.path()).expect("a place");
        while let Some(leftover) = next.take_leftover(None) {
            let scene = leftover.document.scene;
            let step = (1.0 / scene.ambient_intensity).round() as usize;
            assert_eq!(
                scene.objects.len(),
                200 + 10 * (step % 100),
                "after {step} steps"
            );
            found += 1;
        }
        assert!(
            names(folder.path()).iter().any(is_kept),
            "it is kept where it was taken to"
        );
        next.clear();
        assert!(
            !names(folder.path()).iter().any(is_kept),
            "it is taken once"
        );
    }
    assert_eq!(found, KILLS / 3);
    let next = Recovery::new(folder.path()).expect("a place");
    let text = unsaved(1).to_text().expect("text");
    next.keep(&text, None, None).expect("kept");
    let unfinished = |name: &String| name.starts_with(".glint-");
    assert!(
        !names(folder.path()).iter().any(unfinished),
        "what dead programs left is gone"
    );
}

#[test]
fn a_program_that_sleeps_goes_on_where_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let words = |to| {
        [
            "export", FLIGHT, "-o", to, "--frames", "1-60", "--width", "96",
        ]
    };
    done(&mut glint(folder.path(), &words("whole")));
    let mut child = glint(folder.path(), &words("slept"))
        .stdout(Stdio::null())
        .spawn()
        .expect("it runs");
    let signal = |name: &str| {
        let status = Command::new("kill")
            .args([name, &child.id().to_string()])
            .status();
        assert!(status.expect("the system has kill").success());
    };
    sleep(Duration::from_millis(20));
    signal("-STOP");
    sleep(Duration::from_millis(300));
    signal("-CONT");
    assert!(child.wait().expect("it ends").success());
    for frame in 1..=60 {
        let [whole, slept] = ["whole", "slept"]
            .map(|to| folder.path().join(to).join(format!("rayTrace{frame}.ppm")));
        assert!(
            fs::read(whole).expect("made") == fs::read(slept).expect("made"),
            "frame {frame}"
        );
    }
}

/// Returns whether the system lets this user write into a write-protected folder, as it does the administrator.
fn is_administrator(folder: &Path) -> bool {
    fs::write(folder.join("try"), "").is_ok_and(|()| fs::remove_file(folder.join("try")).is_ok())
}

#[test]
fn a_folder_that_must_not_be_written_to_is_named_and_left_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let shut = folder.path().join("shut");
    fs::create_dir(&shut).expect("made");
    write_mesh(&folder.path().join("mesh.obj"), 4);
    fs::write(shut.join("scene.ron"), "what was there").expect("written");
    for (path, mode) in [(folder.path(), 0o755), (&shut, 0o555)] {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("set");
    }
    let nobody = is_administrator(&shut).then_some(65534);
    // The program itself may be in a folder that only its owner may read.
    let program = folder.path().join("glint");
    fs::copy(env!("CARGO_BIN_EXE_glint"), &program).expect("copied");
    for words in [
        ["convert", "mesh.obj", "-o", "shut/scene.ron"],
        ["render", FLIGHT, "-o", "shut/picture.png"],
        ["export", FLIGHT, "-o", "shut/frames"],
    ] {
        let scene = folder.path().join("flight.ron");
        fs::copy(FLIGHT, &scene).expect("copied");
        let mut command = Command::new(&program);
        command.args(words.map(|word| if word == FLIGHT { "flight.ron" } else { word }));
        command.current_dir(folder.path());
        if let Some(nobody) = nobody {
            command.uid(nobody).gid(nobody);
        }
        let said = stderr_of(&mut command, 1);
        assert!(
            said.contains("shut")
                && said.contains("Permission denied")
                && !said.contains("unfinished"),
            "{words:?}: {said}"
        );
    }
    assert_eq!(names(&shut), ["scene.ron"]);
    assert_eq!(
        fs::read(shut.join("scene.ron")).expect("there"),
        b"what was there"
    );
    fs::set_permissions(&shut, fs::Permissions::from_mode(0o755)).expect("set");
}

/// A disk of limited size.
struct Disk(PathBuf);

impl Disk {
    fn new(folder: &Path, bytes: usize) -> Self {
        let place = folder.join("disk");
        fs::create_dir(&place).expect("made");
        let size = format!("size={bytes}");
        let status = Command::new("mount")
            .args(["-t", "tmpfs", "-o", &size, "tmpfs"])
            .arg(&place)
            .status();
        assert!(
            status.expect("mount").success(),
            "only the administrator may"
        );
        Self(place)
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}

#[test]
#[ignore = "mounts a small disk, which only the administrator may, and needs ffmpeg"]
fn a_video_that_a_full_disk_cuts_short_takes_no_ones_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let disk = Disk::new(folder.path(), 256 << 10);
    let make = |frames: &str, width: &str| {
        let mut words = vec!["export", FLIGHT, "-o", frames, "--frames", frames];
        words.extend(["--width", width, "--video", "disk/v.mp4"]);
        glint(folder.path(), &words)
    };
    done(&mut make("1-2", "32"));
    let video = disk.0.join("v.mp4");
    let before = fs::read(&video).expect("there");
    // Leave space for a third of the next video.
    let fill = vec![0; 248 << 10];
    fs::write(disk.0.join("fill"), fill).expect("written");
    let said = stderr_of(&mut make("1-50", "100"), 1);
    assert!(said.contains("No space left on device"), "{said}");
    assert_eq!(names(&disk.0), ["fill", "v.mp4"]);
    assert!(fs::read(&video).expect("there") == before);
}

#[test]
#[ignore = "mounts a small disk, which only the administrator may"]
fn a_full_disk_loses_nothing_that_was_on_it() {
    let folder = tempfile::tempdir().expect("a folder");
    for (mesh, faces) in [("small.obj", 40), ("large.obj", 4000)] {
        write_mesh(&folder.path().join(mesh), faces);
    }
    let disk = Disk::new(folder.path(), 256 << 10);
    let place = |words: &[&str]| glint(folder.path(), words);
    done(&mut place(&[
        "convert",
        "small.obj",
        "-o",
        "disk/scene.ron",
    ]));
    done(&mut place(&[
        "render",
        FLIGHT,
        "-o",
        "disk/picture.png",
        "--width",
        "32",
    ]));
    let contents = || {
        let names = names(&disk.0).into_iter();
        let files = names.map(|name| fs::read(disk.0.join(name)).expect("there"));
        files.collect::<Vec<_>>()
    };
    let before = contents();
    let full = ["No space left on device", "disk"];
    for words in [
        &["convert", "large.obj", "-o", "disk/scene.ron"][..],
        &["render", FLIGHT, "-o", "disk/picture.ppm"],
        &[
            "render",
            FLIGHT,
            "-o",
            "disk/picture.png",
            "--width",
            "2000",
        ],
    ] {
        let said = stderr_of(&mut place(words), 1);
        assert!(
            full.iter().all(|word| said.contains(word)),
            "{words:?}: {said}"
        );
    }
    assert_eq!(names(&disk.0), ["picture.png", "scene.ron"]);
    assert!(before == contents(), "nothing has changed");

    // Frames stop with an error, and go on once there is space.
    let export = [
        "export",
        FLIGHT,
        "-o",
        "disk/frames",
        "--frames",
        "1-30",
        "--width",
        "64",
    ];
    let said = stderr_of(&mut place(&export), 1);
    assert!(full.iter().all(|word| said.contains(word)), "{said}");
    let status = Command::new("mount")
        .args(["-o", "remount,size=2m"])
        .arg(&disk.0)
        .status();
    assert!(status.expect("mount").success());
    done(&mut place(&export));
    assert_eq!(names(&disk.0.join("frames")).len(), 31);
}
