//! The program's dependencies: the licence of every crate allows redistribution, and each direct dependency has a
//! comment that says what it is for.

use std::process::Command;

use serde_json::Value;

/// Licences that require no more than attribution.
const FREE: [&str; 12] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "0BSD",
    "ISC",
    "Zlib",
    "BSL-1.0",
    "CC0-1.0",
    "Unicode-3.0",
    "OFL-1.1",
    "Ubuntu-font-1.0",
];

/// Maximum number of crates that are built in several versions because others need them; an increase would be
/// noticed here.
const MAX_TWICE: usize = 16;

/// Returns whether an SPDX expression can be met with [`FREE`], and the rest of the text.
fn any_of(text: &str) -> (bool, &str) {
    let (mut is_free, mut rest) = all_of(text);
    while let Some(next) = rest.strip_prefix("OR ").or(rest.strip_prefix('/')) {
        let (other, left) = all_of(next);
        (is_free, rest) = (is_free | other, left.trim_start());
    }
    (is_free, rest)
}

fn all_of(text: &str) -> (bool, &str) {
    let (mut is_free, mut rest) = one(text);
    while let Some(next) = rest.strip_prefix("AND ") {
        let (other, left) = one(next);
        (is_free, rest) = (is_free & other, left);
    }
    (is_free, rest)
}

fn one(text: &str) -> (bool, &str) {
    let text = text.trim_start();
    if let Some(inner) = text.strip_prefix('(') {
        let (is_free, rest) = any_of(inner);
        return (is_free, rest.trim_start_matches(')').trim_start());
    }
    let end = text.find([' ', ')', '/']).unwrap_or(text.len());
    let (name, mut rest) = (&text[..end], text[end..].trim_start());
    // An exception only adds permissions.
    if let Some(exception) = rest.strip_prefix("WITH ") {
        let end = exception.find([' ', ')']).unwrap_or(exception.len());
        rest = exception[end..].trim_start();
    }
    (FREE.contains(&name), rest)
}

fn said(program: &str, words: &[&str]) -> String {
    let run = Command::new(program)
        .args(words)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("Rust's own tools");
    assert!(
        run.status.success(),
        "{}",
        String::from_utf8_lossy(&run.stderr)
    );
    String::from_utf8_lossy(&run.stdout).into_owned()
}

#[test]
fn licences_are_understood() {
    for (text, is_free) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("Apache-2.0 OR GPL-2.0-only", true),
        ("GPL-2.0-only OR Apache-2.0", true),
        ("MIT/Apache-2.0", true),
        ("(MIT OR Apache-2.0) AND OFL-1.1", true),
        ("(MIT OR Apache-2.0) AND GPL-2.0", false),
        ("Apache-2.0 WITH LLVM-exception OR GPL-2.0", true),
    ] {
        assert_eq!(any_of(text), (is_free, ""), "{text}");
    }
}

#[test]
fn every_crate_may_be_passed_on() {
    let version = said("rustc", &["-vV"]);
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    let words = [
        "metadata",
        "--format-version",
        "1",
        "--locked",
        "--filter-platform",
    ];
    let words = [&words[..], &[host.expect("a host")]].concat();
    let metadata: Value = serde_json::from_str(&said("cargo", &words)).expect("JSON");
    let used = metadata["resolve"]["nodes"].as_array().expect("a list");
    let used: Vec<&Value> = used.iter().map(|node| &node["id"]).collect();
    let packages = metadata["packages"].as_array().expect("a list");
    let mut names = Vec::new();
    for package in packages
        .iter()
        .filter(|package| used.contains(&&package["id"]))
    {
        let name = package["name"].as_str().expect("a name");
        let licence = package["license"].as_str().unwrap_or("none");
        assert_eq!(any_of(licence), (true, ""), "{name}: {licence}");
        names.push(name);
    }
    assert!(names.len() > 100, "{}", names.len());
    names.sort_unstable();
    let twice = names.windows(2).filter(|pair| pair[0] == pair[1]);
    let twice: Vec<&str> = twice.map(|pair| pair[0]).collect();
    assert!(twice.len() <= MAX_TWICE, "{twice:?}");
}

#[test]
fn every_dependency_says_what_it_is_for() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
    let text = text.expect("readable");
    let lists = text
        .split("\n[")
        .filter(|part| part.starts_with("dependencies]") || part.starts_with("dev-dependencies]"));
    for list in lists {
        let lines: Vec<&str> = list
            .lines()
            .skip(1)
            .filter(|line| !line.is_empty())
            .collect();
        for (number, line) in lines.iter().enumerate() {
            let is_told = number > 0 && lines[number - 1].starts_with("# ");
            // Dependencies that belong together may share a comment.
            let is_pair = line.starts_with("serde ");
            assert!(line.starts_with('#') || is_told || is_pair, "{line}");
        }
    }
}
