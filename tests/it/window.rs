//! The real program in a real window, on a virtual display.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use image::RgbaImage;

use crate::program::{self, wait_until};

/// Another program, which is stopped at the end of the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual display.
struct Display {
    _server: Running,
    name: String,
}

impl Display {
    fn new() -> Self {
        let mut server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1280x800x24",
                "-nolisten",
                "tcp",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed (Debian package xvfb)");
        let mut line = String::new();
        let out = server.stdout.take().expect("piped");
        BufReader::new(out)
            .read_line(&mut line)
            .expect("the display's number");
        Self {
            _server: Running(server),
            name: format!(":{}", line.trim()),
        }
    }

    fn tool(&self, program: &str, words: &[&str]) -> String {
        let run = Command::new(program)
            .args(words)
            .env("DISPLAY", &self.name)
            .output();
        let run = run.unwrap_or_else(|error| panic!("{program} is installed: {error}"));
        String::from_utf8_lossy(&run.stdout).trim().to_owned()
    }

    /// A screenshot of the display.
    fn look(&self) -> RgbaImage {
        let run = Command::new("import")
            .args(["-window", "root", "png:-"])
            .env("DISPLAY", &self.name)
            .output()
            .expect("import is installed (Debian package imagemagick)");
        image::load_from_memory(&run.stdout)
            .expect("a picture")
            .to_rgba8()
    }

    fn key(&self, key: &str) {
        self.tool("xdotool", &["key", key]);
    }
}

/// The program, in a folder of its own.
struct Program {
    child: Running,
    folder: tempfile::TempDir,
}

impl Program {
    fn start(display: &Display, words: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let child = command(display, folder.path())
            .args(words)
            .spawn()
            .expect("the program starts");
        let child = Running(child);
        let program = Self { child, folder };
        wait_for("the window", || {
            !display
                .tool("xdotool", &["search", "--name", "^Glint"])
                .is_empty()
        });
        wait_for("the first picture", || is_violet(middle(&display.look())));
        // Only a mapped window takes the focus, and there is no window manager to give it.
        let window = display.tool("xdotool", &["search", "--name", "^Glint"]);
        let window = window.lines().next().expect("a window").to_owned();
        display.tool("xdotool", &["windowfocus", "--sync", &window]);
        // Move the pointer out of the picture, which would show the name of what it hovers; a display without
        // clients forgets the pointer's position.
        display.tool("xdotool", &["mousemove", "1270", "792"]);
        wait_for("rest", || {
            let before = display.look();
            std::thread::sleep(Duration::from_millis(500));
            changed(&before, &display.look()) == 0
        });
        program
    }

    fn end(&mut self) -> ExitStatus {
        let mut status = None;
        wait_for("the end", || {
            status = self.child.0.try_wait().expect("asked");
            status.is_some()
        });
        status.expect("ended")
    }
}

/// Waits until the screen, say, is as wanted; looks at it now and then, since that takes time from the program.
fn wait_for(what: &str, mut is_true: impl FnMut() -> bool) {
    wait_until(what, || {
        std::thread::sleep(Duration::from_millis(50));
        is_true()
    });
}

fn command(display: &Display, folder: &Path) -> Command {
    let mut command = program::glint(&[]);
    command
        .current_dir(folder)
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("XDG_DATA_HOME", folder)
        .stdout(Stdio::null());
    command
}

/// The colour in the middle of the picture area, which is inside the demo's violet sphere.
fn middle(screen: &RgbaImage) -> [u8; 3] {
    let [r, g, b, _] = screen.get_pixel(590, 420).0;
    [r, g, b]
}

/// Returns whether a colour is the violet of the demo's first sphere.
fn is_violet([r, g, b]: [u8; 3]) -> bool {
    r > 100 && b > 100 && g < r && g < b
}

/// The number of pixels of the picture area that differ.
fn changed(a: &RgbaImage, b: &RgbaImage) -> usize {
    let area = (240..940).flat_map(|x| (60..760).map(move |y| (x, y)));
    area.filter(|&(x, y)| a.get_pixel(x, y) != b.get_pixel(x, y))
        .count()
}

#[test]
#[ignore = "needs a display (Debian packages xvfb, xdotool, imagemagick, libgl1-mesa-dri)"]
fn the_window_shows_the_demo_follows_keys_and_closes() {
    let display = Display::new();
    let mut program = Program::start(&display, &[]);
    let start = display.look();
    display.key("o");
    wait_for("the orthographic picture", || {
        changed(&start, &display.look()) > 50_000
    });
    display.key("p");
    wait_for("the perspective picture", || {
        changed(&start, &display.look()) < 500
    });
    display.tool("xdotool", &["keydown", "w"]);
    std::thread::sleep(Duration::from_millis(300));
    display.tool("xdotool", &["keyup", "w"]);
    wait_for("the flight", || changed(&start, &display.look()) > 50_000);
    display.key("ctrl+z");
    wait_for("the way back", || changed(&start, &display.look()) < 500);
    display.key("h");
    wait_for("the high-res picture", || {
        changed(&start, &display.look()) > 2_000
    });
    display.key("Escape");
    wait_for("the live view", || changed(&start, &display.look()) < 500);
    // The first Escape only says how to quit.
    display.key("Escape");
    display.key("Escape");
    wait_for("the question", || changed(&start, &display.look()) > 50_000);
    // The next key does not quit either.
    display.key("Return");
    wait_for("the window again", || {
        changed(&start, &display.look()) < 500
    });
    display.key("ctrl+q");
    assert!(program.end().success());
}

#[test]
#[ignore = "needs a display (Debian packages xvfb, xdotool, imagemagick, libgl1-mesa-dri)"]
fn a_killed_program_loses_no_edit() {
    let display = Display::new();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.ron");
    let mut program = Program::start(&display, &[scene]);
    display.key("u");
    let kept = |folder: &Path| -> Option<PathBuf> {
        let files = std::fs::read_dir(folder.join("glint"))
            .ok()?
            .filter_map(Result::ok);
        files.map(|file| file.path()).find(|path| {
            path.extension().is_some_and(|e| e == "ron")
                && path.to_string_lossy().contains("unsaved")
        })
    };
    wait_for("the autosave", || kept(program.folder.path()).is_some());
    program.child.0.kill().expect("killed");
    program.end();
    let text =
        std::fs::read_to_string(kept(program.folder.path()).expect("kept")).expect("readable");
    assert!(
        text.starts_with(&format!("// unsaved changes of: {scene}\n")),
        "{text}"
    );
    assert!(text.contains("light_visualization: false"));
    // The next start restores the edit: the markers are gone from the picture.
    let again = command(&display, program.folder.path())
        .args([scene, "--screenshot", "again.png"])
        .status()
        .expect("the program starts");
    assert!(
        again.success(),
        "a picture of the window leaves the unsaved work alone"
    );
    assert!(kept(program.folder.path()).is_some());
    let child = command(&display, program.folder.path()).arg(scene).spawn();
    program.child = Running(child.expect("starts"));
    let marker = |screen: &RgbaImage| screen.get_pixel(307, 326).0[..3] == [255, 255, 0];
    wait_for("the recovered picture", || {
        let screen = display.look();
        is_violet(middle(&screen)) && !marker(&screen)
    });
}

#[test]
#[ignore = "needs a display (Debian packages xvfb, xdotool, imagemagick, libgl1-mesa-dri)"]
fn a_missing_system_library_ends_in_a_picture() {
    let display = Display::new();
    let libraries: [&[&str]; 3] = [
        &["libxkbcommon-x11.so.0", "libxkbcommon-x11.so"],
        &["libXcursor.so.1", "libXcursor.so"],
        &["libGL.so.1", "libGL.so", "libEGL.so.1", "libEGL.so"],
    ];
    for names in libraries {
        let folder = tempfile::tempdir().expect("a folder");
        // A file that is no library hides the real one from the loader.
        for name in names {
            std::fs::write(folder.path().join(name), "no library").expect("written");
        }
        let log = std::fs::File::create(folder.path().join("log")).expect("made");
        let child = command(&display, folder.path())
            .env("LD_LIBRARY_PATH", folder.path())
            .stderr(log)
            .spawn()
            .expect("the program starts");
        let child = Running(child);
        let mut program = Program { child, folder };
        let status = program.end();
        let said = std::fs::read_to_string(program.folder.path().join("log")).expect("readable");
        println!("{said}");
        assert!(status.success(), "{names:?}: {said}");
        assert!(
            said.contains("no window") && !said.contains("panicked"),
            "{names:?}: {said}"
        );
        assert!(
            program.folder.path().join("demo.png").exists(),
            "{names:?}: {said}"
        );
    }
}

#[test]
#[ignore = "needs a display (Debian packages xvfb, xdotool, imagemagick, libgl1-mesa-dri)"]
fn the_program_tells_how_long_it_takes_to_start() {
    let display = Display::new();
    let folder = tempfile::tempdir().expect("a folder");
    let output = command(&display, folder.path())
        .arg("--stats-start")
        .stdout(Stdio::piped())
        .output()
        .expect("it runs");
    assert!(output.status.success(), "{output:?}");
    let stats: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    println!("{stats}");
    let number = |key: &str| stats[key].as_f64().expect("a number");
    assert!(0.0 < number("window_ms") && number("window_ms") <= number("picture_ms"));
    assert!(number("resident_mib") > 10.0);
}

#[test]
#[ignore = "needs a display (Debian packages xvfb, xdotool, imagemagick, libgl1-mesa-dri)"]
fn the_window_takes_its_own_picture() {
    let display = Display::new();
    let folder = tempfile::tempdir().expect("a folder");
    let status = command(&display, folder.path())
        .args(["--screenshot", "window.png"])
        .status();
    assert!(status.expect("the program starts").success());
    let picture = image::open(folder.path().join("window.png"))
        .expect("a picture")
        .to_rgba8();
    assert!(is_violet(middle(&picture)));
    let bad = command(&display, folder.path())
        .args(["--screenshot", "none/window.png"])
        .output();
    let bad = bad.expect("the program starts");
    assert_eq!(bad.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&bad.stderr).contains("the folder none does not exist"));
}

/// A Wayland compositor without a screen.
struct Compositor {
    _server: Running,
    /// The folder of its socket.
    folder: tempfile::TempDir,
}

impl Compositor {
    const SOCKET: &str = "wayland-of-a-test";

    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let server = Command::new("weston")
            .args(["--backend=headless-backend.so", "--idle-time=0"])
            .args(["--width=1280", "--height=800"])
            .arg(format!("--socket={}", Self::SOCKET))
            .env("XDG_RUNTIME_DIR", folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("weston is installed (Debian package weston)");
        let socket = folder.path().join(Self::SOCKET);
        let compositor = Self {
            _server: Running(server),
            folder,
        };
        wait_for("the compositor", || socket.exists());
        compositor
    }
}

#[test]
#[ignore = "needs a compositor (Debian packages weston, libgl1-mesa-dri)"]
fn the_window_is_the_same_under_wayland() {
    let compositor = Compositor::new();
    let folder = tempfile::tempdir().expect("a folder");
    let status = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["--screenshot", "window.png"])
        .current_dir(folder.path())
        .env_remove("DISPLAY")
        .env("XDG_RUNTIME_DIR", compositor.folder.path())
        .env("WAYLAND_DISPLAY", Compositor::SOCKET)
        .env("XDG_DATA_HOME", folder.path())
        .status();
    assert!(status.expect("the program starts").success());
    let picture = image::open(folder.path().join("window.png")).expect("a picture");
    assert!(is_violet(middle(&picture.to_rgba8())));
}
