//! The rules of the house: who may import whom, and where each tool lives.

use std::fs;
use std::path::{Path, PathBuf};

/// A tool, by the text that uses it, and the only places that may.
const HOMES: &[(&[&str], &[&str])] = &[
    (&["egui::", "eframe::"], &["ui/"]),
    (
        &["std::fs"],
        &["scene/file.rs", "scene/recovery.rs", "export/", "cli/"],
    ),
    (
        &["std::thread::", "rayon::"],
        &["worker/", "trace/tiles.rs", "trace/threads.rs"],
    ),
    (
        &["println!", "std::io::stdout", "std::io::stderr"],
        &["cli/", "main.rs"],
    ),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// The modules of `lib.rs`, in the order in which it declares them.
fn rooms(lib: &str) -> Vec<&str> {
    lib.lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .collect()
}

/// The room that a file lives in, by its path below `src`.
fn room_of(path: &str) -> &str {
    path.split(['/', '.']).next().unwrap_or_default()
}

/// The faults of one file: `path:line: what`.
fn faults(rooms: &[&str], path: &str, text: &str) -> Vec<String> {
    let mut faults = Vec::new();
    let place = |room: &str| rooms.iter().position(|other| *other == room);
    let here = place(room_of(path));
    // What tests use is their own business.
    let lines = text
        .lines()
        .take_while(|line| !line.starts_with("#[cfg(test)]"));
    for (number, line) in lines
        .enumerate()
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
    {
        let mut report_error =
            |what: String| faults.push(format!("src/{path}:{}: {what}", number + 1));
        for target in line.split("crate::").skip(1) {
            let room = target
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .next()
                .unwrap_or_default();
            let (Some(here), Some(there)) = (here, place(room)) else {
                continue;
            };
            let is_between_doors = matches!((room_of(path), room), ("ui", "cli") | ("cli", "ui"));
            if there > here || is_between_doors {
                report_error(format!("{} must not import {room}", room_of(path)));
            }
        }
        for (tools, homes) in HOMES {
            let used = tools.iter().find(|tool| line.contains(**tool));
            if let Some(tool) = used.filter(|_| !homes.iter().any(|home| path.starts_with(home))) {
                report_error(format!("`{tool}` belongs in {}", homes.join(", ")));
            }
        }
    }
    faults
}

#[test]
fn imports_point_one_way_and_tools_stay_at_home() {
    let lib = fs::read_to_string(source().join("lib.rs")).expect("readable");
    let rooms = rooms(&lib);
    assert!(rooms.starts_with(&["lanes", "scene"]), "{rooms:?}");
    let mut found = Vec::new();
    files(&source(), &mut found);
    assert!(found.len() > 30);
    let mut all = Vec::new();
    for file in found {
        let path = file
            .strip_prefix(source())
            .expect("below src")
            .to_string_lossy()
            .replace('\\', "/");
        let text = fs::read_to_string(&file).expect("readable");
        all.extend(faults(&rooms, &path, &text));
        let lines = text.lines().count();
        if lines > 450 {
            all.push(format!(
                "src/{path}: {lines} lines are more than one can hold in the head"
            ));
        }
    }
    assert!(all.is_empty(), "\n{}", all.join("\n"));
}

#[test]
fn the_test_sees_what_it_looks_for() {
    let rooms = ["lanes", "scene", "trace", "ui", "cli"];
    let seen = |path, text| !faults(&rooms, path, text).is_empty();
    assert!(seen("scene/mod.rs", "use crate::trace::Ray;"));
    assert!(seen("ui/app.rs", "use crate::cli::run;"));
    assert!(seen("cli/mod.rs", "    crate::ui::run();"));
    assert!(seen("trace/mod.rs", "use std::fs;"));
    assert!(seen("trace/shade.rs", "    println!(\"x\");"));
    assert!(seen("scene/mod.rs", "fn f(ui: &mut egui::Ui) {}"));
    assert!(!seen("trace/mod.rs", "use crate::scene::Scene;"));
    assert!(!seen("trace/mod.rs", "// crate::ui is far away"));
}
