//! The rules of the architecture: which modules may import which, and where each external tool is used.
//!
//! `lib.rs` and every `mod.rs` declare their modules in the order of dependence: a file imports only from modules
//! declared before its own, within its folder and at the top level. What a `mod.rs` defines itself comes on top of
//! its folder, and nothing in the folder imports it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A tool, given by the paths that use it, and the only modules in which these may occur.
const HOMES: &[(&[&str], &[&str])] = &[
    (&["egui", "eframe"], &["ui"]),
    (
        &["std::fs"],
        &[
            "files",
            "mesh",
            "scene/file",
            "scene/recovery",
            "export",
            "cli",
        ],
    ),
    (
        &["std::thread", "rayon"],
        &[
            "worker",
            "export/exporting",
            "export/writers",
            "export/frame_file",
            "export/ffmpeg",
            "export/program",
            "plan/grouping",
            "plan/borders",
            "plan/culled_faces",
            "plan/packed_mesh",
            "plan/smooth",
            "plan/thickness",
            "trace/tracer",
            "trace/threads",
            "trace/query",
        ],
    ),
    (&["std::io::stdout", "std::io::stderr"], &["cli", "main"]),
    (&["fearless_simd"], &["simd"]),
];

/// The modules that compute with SIMD vectors; all others use geometric types.
const SIMD_ROOMS: &[&str] = &["simd", "primitive", "plan", "trace", "image", "lab"];
/// The items of the `simd` module that are not vectors: the number of lanes that can be requested.
const NO_VECTORS: &[&str] = &["Level"];

/// Maximum length of a file in lines, so that a reader can keep an overview of it.
const LONGEST: usize = 450;

/// A module, as the names on its path from the crate's root.
type Module = Vec<String>;

/// The source of a crate, by module.
struct House {
    texts: BTreeMap<Module, String>,
    /// Modules that contain other modules.
    rooms: BTreeSet<Module>,
}

/// A path named in a file, with its line.
struct Named {
    line: usize,
    path: Vec<String>,
    /// Whether it is re-exported: `pub use`.
    is_passed_on: bool,
}

/// The text without comments and tests, with the same lines and lengths.
fn code(text: &str) -> String {
    let lines = text
        .lines()
        .take_while(|line| !line.starts_with("#[cfg(test)]"));
    let lines = lines.map(|line| line.split("//").next().unwrap_or_default());
    lines.collect::<Vec<_>>().join("\n")
}

fn words(path: &str) -> Vec<String> {
    path.split("::")
        .map(|word| word.trim().to_owned())
        .collect()
}

/// Expands the tree of a `use` into its paths.
fn expand(tree: &str, before: &str, paths: &mut Vec<String>) {
    let tree = tree.trim();
    let joined = |last: &str| {
        let last = last.split(" as ").next().unwrap_or_default().trim();
        format!("{before}{last}")
    };
    let Some(open) = tree.find('{') else {
        return paths.push(joined(tree));
    };
    let before = format!("{before}{}", &tree[..open]);
    let (mut depth, mut start) = (0, 0);
    let inner = &tree[open + 1..tree.rfind('}').unwrap_or(tree.len())];
    for (index, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                expand(&inner[start..index], &before, paths);
                start = index + 1;
            }
            _ => {}
        }
    }
    if !inner[start..].trim().is_empty() {
        expand(&inner[start..], &before, paths);
    }
}

/// Every path that the code of a file names, in `use` and elsewhere.
fn named(text: &str) -> Vec<Named> {
    let code = code(text);
    let mut found = Vec::new();
    let line_of = |at: usize| code[..at].matches('\n').count() + 1;
    let mut rest = String::new();
    let mut at = 0;
    for statement in code.split_inclusive([';', '\n']) {
        let trimmed = statement.trim_start();
        let is_passed_on =
            trimmed.starts_with("pub use ") || trimmed.starts_with("pub(crate) use ");
        if trimmed.starts_with("use ") || is_passed_on {
            // The statement may span several lines.
            let from = at + statement.len() - trimmed.len();
            let end = code[from..].find(';').map_or(code.len(), |end| from + end);
            let tree = code[from..end].trim_start_matches("pub ");
            let mut paths = Vec::new();
            expand(tree.trim_start_matches("use "), "", &mut paths);
            found.extend(paths.iter().map(|path| Named {
                line: line_of(from),
                path: words(path),
                is_passed_on,
            }));
        } else {
            rest.push_str(statement);
        }
        at += statement.len();
    }
    for (number, line) in code.lines().enumerate() {
        let is_use = line.trim_start().starts_with("use ") || line.starts_with("pub use ");
        for start in [
            "crate::", "super::", "std::", "egui::", "eframe::", "rayon::",
        ] {
            for (at, _) in line.match_indices(start).filter(|_| !is_use) {
                let is_inner = line[..at].ends_with(|c: char| c.is_alphanumeric() || c == ':');
                let path: String = line[at..]
                    .chars()
                    .take_while(|c| c.is_alphanumeric() || matches!(c, ':' | '_'))
                    .collect();
                if !is_inner {
                    found.push(Named {
                        line: number + 1,
                        path: words(path.trim_end_matches(':')),
                        is_passed_on: false,
                    });
                }
            }
        }
    }
    found
}

impl House {
    /// Creates a house from files, given by their paths below `src`.
    fn new<'a>(files: impl IntoIterator<Item = (&'a str, &'a str)>) -> Self {
        let mut house = Self {
            texts: BTreeMap::new(),
            rooms: BTreeSet::new(),
        };
        for (path, text) in files {
            let stem = path.strip_suffix(".rs").unwrap_or(path);
            let mut module: Module = stem.split('/').map(str::to_owned).collect();
            if module
                .last()
                .is_some_and(|last| last == "mod" || last == "lib")
            {
                module.pop();
                house.rooms.insert(module.clone());
            }
            house.texts.insert(module, text.to_owned());
        }
        house
    }

    /// The modules within a module, in the order of their declaration.
    fn order(&self, room: &Module) -> Vec<String> {
        let text = self.texts.get(room).map_or("", String::as_str);
        let code = code(text);
        let names = code.lines().filter_map(|line| {
            let line = line.trim();
            let line = line.strip_prefix("pub ").unwrap_or(line);
            line.strip_prefix("mod ")?.strip_suffix(';')
        });
        names.map(str::to_owned).collect()
    }

    /// The module that defines what a path names, as seen from `here`, through re-exports. `None` for other crates.
    fn target(&self, here: &Module, path: &[String]) -> Option<Module> {
        let mut at: Module = match path.first()?.as_str() {
            "crate" => Vec::new(),
            "super" => here[..here.len().checked_sub(1)?].to_vec(),
            "self" => here.clone(),
            first if self.is_module(here, first) => {
                let mut at = here.clone();
                at.push(first.to_owned());
                at
            }
            _ => return None,
        };
        for word in &path[1..] {
            if word == "super" {
                at.pop();
                continue;
            }
            if self.is_module(&at, word) {
                at.push(word.clone());
                continue;
            }
            let passed_on = named(self.texts.get(&at).map_or("", String::as_str));
            let passed_on = passed_on
                .into_iter()
                .find(|named| named.is_passed_on && named.path.last() == Some(word));
            let from = passed_on.and_then(|named| self.target(&at, &named.path));
            return Some(from.filter(|from| *from != at).unwrap_or(at));
        }
        Some(at)
    }

    fn is_module(&self, at: &Module, name: &str) -> bool {
        let mut module = at.clone();
        module.push(name.to_owned());
        self.texts.contains_key(&module)
    }

    /// What is wrong with importing `to` from `from`, if anything.
    fn fault(&self, from: &Module, to: &Module) -> Option<String> {
        let shared = from.iter().zip(to).take_while(|(a, b)| a == b).count();
        let room = from[..shared].to_vec();
        let name = |module: &Module| module.join("/");
        let here = from.get(shared)?;
        let Some(there) = to.get(shared) else {
            // What a `mod.rs` defines must not be used by the modules within.
            return (self.rooms.contains(to) && !room.is_empty())
                .then(|| format!("{here} must not import what {}/mod.rs defines", name(&room)));
        };
        let order = self.order(&room);
        let place = |name: &String| order.iter().position(|other| other == name);
        let is_between_doors = room.is_empty()
            && matches!(
                (here.as_str(), there.as_str()),
                ("ui", "cli") | ("cli", "ui")
            );
        let is_upwards = matches!((place(here), place(there)), (Some(a), Some(b)) if b > a);
        (is_upwards || is_between_doors)
            .then(|| format!("{} must not import {}", name(from), name(to)))
    }

    /// Every violation, as `path:line: what`.
    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (module, text) in &self.texts {
            if module.iter().any(|name| name == "tests") {
                continue;
            }
            let path = module.join("/");
            for Named {
                line,
                path: named,
                is_passed_on,
            } in named(text)
            {
                let mut report = |what: String| faults.push(format!("src/{path}:{line}: {what}"));
                if let Some(target) = self.target(module, &named) {
                    let is_own = is_passed_on && target.starts_with(module);
                    if let Some(fault) = self.fault(module, &target).filter(|_| !is_own) {
                        report(fault);
                    }
                    let is_vector = target.first().is_some_and(|room| room == "simd")
                        && !named.iter().any(|word| NO_VECTORS.contains(&word.as_str()));
                    let room = module.first().map_or("", String::as_str);
                    if is_vector && !SIMD_ROOMS.contains(&room) && !room.is_empty() {
                        report("only kernels compute with vectors of the processor".to_owned());
                    }
                }
                let full = named.join("::");
                for (tools, homes) in HOMES {
                    let is_used = |tool: &&&str| {
                        full.strip_prefix(**tool)
                            .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
                    };
                    let is_home = homes.iter().any(|home| path.starts_with(home));
                    if let Some(tool) = tools.iter().find(is_used).filter(|_| !is_home) {
                        report(format!("`{tool}` belongs in {}", homes.join(", ")));
                    }
                }
            }
            let is_door = path.starts_with("cli") || path == "main";
            if code(text).contains("println!") && !is_door {
                faults.push(format!("src/{path}: printing belongs in cli"));
            }
            let lines = text.lines().count();
            if lines > LONGEST {
                faults.push(format!("src/{path}: {lines} lines are too many"));
            }
        }
        faults
    }
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

/// The source files with their contents.
fn texts() -> Vec<(String, String)> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    files(&source, &mut found);
    assert!(found.len() > 100);
    let texts = found.iter().map(|file| {
        let path = file.strip_prefix(&source).expect("below src");
        let path = path.to_string_lossy().replace('\\', "/");
        (path, fs::read_to_string(file).expect("readable"))
    });
    texts.collect()
}

/// The public types that a file defines.
fn public_types(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| {
        let line = line.strip_prefix("pub ")?;
        let kinds = ["struct ", "enum ", "trait "];
        let name = kinds.into_iter().find_map(|kind| line.strip_prefix(kind))?;
        name.split(|sign: char| !sign.is_alphanumeric()).next()
    })
}

#[test]
fn a_public_type_has_a_name_of_its_own() {
    assert!(public_types("pub struct Tile<R> {\n    pub struct Inner;\nstruct Own;").eq(["Tile"]));
    let mut homes = BTreeMap::new();
    for (path, text) in texts() {
        for name in public_types(&text) {
            let other = homes.insert(name.to_owned(), path.clone());
            assert_eq!(other, None, "{name} is something else in {path}");
        }
    }
}

#[test]
fn imports_point_one_way_and_tools_stay_at_home() {
    let texts = texts();
    let house = House::new(
        texts
            .iter()
            .map(|(path, text)| (path.as_str(), text.as_str())),
    );
    assert!(
        house
            .order(&Vec::new())
            .starts_with(&["words", "files", "mesh"].map(str::to_owned))
    );
    let faults = house.faults();
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
}

#[test]
fn the_test_sees_what_it_looks_for() {
    let lib = "pub mod files;\npub mod scene;\npub mod simd;\npub mod trace;\npub mod ui;\npub mod cli;\n";
    let trace = "mod stats;\nmod tile;\nmod shade;\npub use tile::Tile;\npub struct Top;\n";
    let seen = |path: &str, text: &str| {
        let mut files = BTreeMap::from([
            ("lib.rs", lib),
            ("files.rs", ""),
            (
                "scene/mod.rs",
                "mod shape;\nmod file;\npub use shape::Shape;\n",
            ),
            ("scene/shape.rs", ""),
            ("scene/file.rs", ""),
            ("simd.rs", ""),
            ("trace/mod.rs", trace),
            ("trace/stats.rs", ""),
            ("trace/tile.rs", ""),
            ("trace/shade.rs", ""),
            ("ui/mod.rs", "mod app;"),
            ("ui/app.rs", ""),
            ("cli/mod.rs", ""),
        ]);
        files.insert(path, text);
        !House::new(files).faults().is_empty()
    };
    // Between top-level modules.
    assert!(seen("scene/shape.rs", "use crate::trace::Tile;"));
    assert!(seen("scene/shape.rs", "use crate::{files, trace::Tile};"));
    assert!(seen("ui/app.rs", "use crate::cli::run;"));
    assert!(seen("cli/mod.rs", "    crate::ui::run();"));
    assert!(!seen("trace/tile.rs", "use crate::scene::Shape;"));
    assert!(!seen("trace/tile.rs", "// crate::ui is far away"));
    // Within a module: in the wrong order, through re-exports, and in circles.
    assert!(seen("trace/stats.rs", "use super::shade::Shader;"));
    assert!(seen(
        "trace/stats.rs",
        "use super::{\n    stats::X,\n    shade::Y,\n};"
    ));
    assert!(seen("trace/stats.rs", "use super::Tile;"));
    assert!(seen("trace/stats.rs", "use crate::trace::Tile;"));
    assert!(seen("trace/shade.rs", "use super::Top;"));
    assert!(seen("trace/stats.rs", "fn f() { super::tile::g() }"));
    assert!(!seen(
        "trace/shade.rs",
        "use super::Tile;\nuse super::stats::Rays;"
    ));
    // Two files that import each other cannot be in order.
    assert!(seen("scene/shape.rs", "use super::file::load;"));
    // Tools.
    assert!(seen("trace/tile.rs", "use std::fs;"));
    assert!(seen("trace/tile.rs", "use std::{fs, io};"));
    assert!(seen("trace/tile.rs", "use std::thread;"));
    assert!(seen("trace/shade.rs", "    println!(\"x\");"));
    assert!(seen("scene/shape.rs", "fn f(ui: &mut egui::Ui) {}"));
    assert!(seen("scene/shape.rs", "use crate::simd::Vec3;"));
    assert!(!seen("scene/file.rs", "use std::fs;"));
}
