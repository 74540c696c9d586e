//! The rendered pictures of the published scenes stay the same, byte for byte, until a change is intended.
//!
//! `picture_hashes.txt` holds a line for each picture: the BLAKE3 hash of its PPM file and the arguments of
//! `glint render`. After an intended change, write it anew with
//!
//! ```sh
//! GLINT_WRITE_HASHES=1 cargo test --test it bytes::
//! ```

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::scenes::files_in;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Arguments with which every scene is rendered.
const EACH: [&str; 3] = [
    "--antialias none",
    "--antialias adaptive",
    "--antialias none --precision f64",
];

/// Additional arguments for particular scenes.
const MORE: [(&str, &str); 13] = [
    ("flight.ron", "--antialias none --frame 40"),
    ("flight.ron", "--antialias adaptive --frame 160"),
    ("demo.ron", "--antialias grid:3"),
    ("demo.ron", "--antialias adaptive --precision f64"),
    ("demo.ron", "--antialias adaptive --camera orthographic"),
    ("demo.ron", "--antialias none --sphere classic"),
    ("demo.ron", "--antialias none --offset fixed:0.1"),
    ("demo.ron", "--antialias none --offset wachter-binder"),
    ("demo.ron", "--antialias none --offset relative:0.0001"),
    ("demo.ron", "--antialias none --triangle edges"),
    ("demo.ron", "--antialias none --triangle moller-trumbore"),
    ("demo.ron", "--antialias none --triangle edge-planes"),
    (
        "mirrors.ron",
        "--antialias adaptive --accelerator bvh --specular log1p",
    ),
];

fn hash(folder: &Path, scene: &str, settings: &str) -> String {
    let picture = folder.join("picture.ppm");
    let run = Command::new(env!("CARGO_BIN_EXE_glint"))
        .arg("render")
        .arg(Path::new(ROOT).join("scenes").join(scene))
        .arg("-o")
        .arg(&picture)
        .args(["--width", "200"])
        .args(settings.split(' '))
        .output()
        .expect("the program starts");
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.success(), "{scene} {settings}: {said}");
    blake3::hash(&std::fs::read(&picture).expect("a picture")).to_string()
}

fn pictures() -> Vec<(String, &'static str)> {
    let scenes = files_in("scenes").into_iter();
    let names = scenes.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()));
    let each = names.flat_map(|name| EACH.map(|settings| (name.clone(), settings)));
    let more = MORE.map(|(name, settings)| (name.to_owned(), settings));
    each.chain(more).collect()
}

#[test]
fn published_scenes_keep_their_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut found = String::new();
    for (scene, settings) in pictures() {
        let hash = hash(folder.path(), &scene, settings);
        writeln!(found, "{hash} {scene} {settings}").expect("written");
    }
    let file = Path::new(ROOT).join("tests/it/picture_hashes.txt");
    if std::env::var_os("GLINT_WRITE_HASHES").is_some() {
        std::fs::write(&file, &found).expect("written");
    }
    let kept = std::fs::read_to_string(&file).expect("the hashes");
    for (kept, found) in kept.lines().zip(found.lines()) {
        assert_eq!(kept, found, "the picture has changed");
    }
    assert_eq!(kept, found);
}
