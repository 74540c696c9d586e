//! The commands in the README: those that render, check and export are run, and their output must be what the
//! README shows.

use std::fs;
use std::path::Path;
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Commands that need other programs, take minutes, or change the tester's desktop.
const ELSEWHERE: [&str; 6] = [
    "glint chart",
    "glint stability",
    "glint referee",
    "glint --install-desktop",
    "glint convert model.obj",
    "openjd",
];

/// The contents of the code blocks in this language.
fn blocks(language: &str) -> Vec<String> {
    let text = fs::read_to_string(Path::new(ROOT).join("README.md")).expect("the README");
    let parts = text.split("\n```").skip(1).step_by(2);
    let own = parts.filter_map(|part| part.split_once('\n'));
    let own = own.filter(|(name, _)| *name == language);
    own.map(|(_, block)| block.to_owned()).collect()
}

/// A folder laid out like the project, and a `PATH` on which the program is found by its name.
fn workplace() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a folder");
    for own in ["scenes", "screenshots"] {
        fs::create_dir(folder.path().join(own)).expect("made");
    }
    for scene in fs::read_dir(Path::new(ROOT).join("scenes")).expect("scenes") {
        let from = scene.expect("read").path();
        let name = from.file_name().expect("a name");
        fs::copy(&from, folder.path().join("scenes").join(name)).expect("copied");
    }
    let program = Path::new(env!("CARGO_BIN_EXE_glint"))
        .parent()
        .expect("a folder");
    let rest = std::env::var("PATH").unwrap_or_default();
    let path = format!("{}:{rest}", program.display());
    (folder, path)
}

/// Runs a command; returns its success, and its output on both streams interleaved.
fn run(line: &str, (folder, path): (&Path, &str)) -> (bool, String) {
    let output = Command::new("sh")
        .args(["-c", &format!("{{ {line}\n}} 2>&1")])
        .current_dir(folder)
        .env("PATH", path)
        .output()
        .expect("a shell");
    let said = String::from_utf8(output.stdout).expect("text");
    (output.status.success(), said)
}

#[test]
fn lines_of_the_readme_work() {
    let (folder, path) = workplace();
    let mut count = 0;
    for line in blocks("sh").iter().flat_map(|block| block.lines()) {
        let is_own = line.starts_with("glint ");
        if !is_own || ELSEWHERE.iter().any(|other| line.starts_with(other)) {
            continue;
        }
        let (done, said) = run(line, (folder.path(), &path));
        assert!(done, "{line}\n{said}");
        let mut words = line.split_whitespace();
        if words.any(|word| word == "-o") {
            let made = folder.path().join(words.next().expect("a file"));
            assert!(made.exists(), "{line}");
        }
        count += 1;
    }
    assert!(count >= 12, "{count} lines are found");
}

#[test]
fn what_the_readme_shows_is_what_is_said() {
    let (folder, path) = workplace();
    let mut count = 0;
    for block in blocks("console") {
        for part in block.split("$ ").skip(1) {
            let (line, shown) = part.split_once('\n').unwrap_or((part, ""));
            let (_, said) = run(line, (folder.path(), &path));
            assert_eq!(said.trim_end(), shown.trim_end(), "{line}");
            count += 1;
        }
    }
    assert!(count >= 3, "{count} lines are found");
}
