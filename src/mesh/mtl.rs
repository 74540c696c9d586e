//! Colours of OBJ files, from MTL files.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::HashSet;
use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use tobj::{LoadError, MTLLoadResult, Material};

use super::error::{MAX_NAME_CHARS, excerpt};
use super::limits::read_bounded;
use super::part::{NOTE_EMISSIVE, NOTE_TEXTURES, NOTE_TRANSPARENT, PartColors};
use super::text::text_of;
use crate::files::stays_inside;

/// Most bytes of all material files of one OBJ file together: room for thousands of materials.
const MAX_BYTES: u64 = 4 << 20;
/// Most files that are searched for by a name that differs in case only.
const MAX_SEARCHES: u32 = 32;
/// The illumination models with traced reflections: Alias/Wavefront, "Object files", appendix B1.
const MIRRORING: RangeInclusive<u8> = 3..=7;

/// Names that exporters write for faces without a material.
const NO_MATERIAL: [&str; 2] = ["None", "(null)"];

/// Reads the material files that one OBJ file names.
pub(super) struct Libraries<'a> {
    folder: &'a Path,
    /// Bytes that may still be read, so that a file that is named a million times does not cost as many reads.
    left: Cell<u64>,
    /// How many files may still be searched for by a name that differs in case.
    searches: Cell<u32>,
    /// Names of the materials that were read.
    names: RefCell<HashSet<String>>,
    /// The first material file that could not be read.
    missing: RefCell<Option<String>>,
    /// The first material that was used and is in no file.
    unknown: RefCell<Option<String>>,
    /// The first material that was used before any file was read.
    used_early: RefCell<Option<String>>,
    /// Whether a material has a texture.
    has_textures: Cell<bool>,
    /// Whether a material is transparent.
    is_clear: Cell<bool>,
    /// Whether a material emits light.
    glows: Cell<bool>,
}

impl<'a> Libraries<'a> {
    /// Material files are searched for in `folder`, that of the OBJ file.
    pub(super) fn new(folder: &'a Path) -> Self {
        Self {
            folder,
            left: Cell::new(MAX_BYTES),
            searches: Cell::new(MAX_SEARCHES),
            names: RefCell::default(),
            missing: RefCell::default(),
            unknown: RefCell::default(),
            used_early: RefCell::default(),
            has_textures: Cell::default(),
            is_clear: Cell::default(),
            glows: Cell::default(),
        }
    }

    /// The notes on properties of materials that are left out.
    pub(super) fn omission_notes(&self) -> impl Iterator<Item = String> {
        let notes = [
            (&self.has_textures, NOTE_TEXTURES),
            (&self.is_clear, NOTE_TRANSPARENT),
            (&self.glows, NOTE_EMISSIVE),
        ];
        let notes = notes.into_iter().filter(|(is_there, _)| is_there.get());
        notes.map(|(_, note)| note.to_owned())
    }

    /// The note on material files that could not be read, or materials that are not in them.
    pub(super) fn note(&self) -> Option<String> {
        if let Some(missing) = self.missing.take() {
            let name = excerpt(&missing, MAX_NAME_CHARS);
            return Some(format!(
                "its colours are missing: there is no readable file {name} beside it, of at most {} MiB",
                MAX_BYTES >> 20
            ));
        }
        if let Some(unknown) = self.unknown.take() {
            let name = excerpt(&unknown, MAX_NAME_CHARS);
            return Some(format!(
                "it uses the material {name}, which is in none of its material files"
            ));
        }
        let has_any = !self.names.borrow().is_empty();
        let used_early = self.used_early.take().filter(|_| has_any)?;
        let name = excerpt(&used_early, MAX_NAME_CHARS);
        Some(format!(
            "some colours are missing: it uses {name} before naming its material file"
        ))
    }

    /// Returns a `usemtl` line without a comment after the name. The name itself may contain a `#`.
    pub(super) fn without_comment<'t>(&self, line: &'t str) -> &'t str {
        let name = |line: &'t str| Some(line.split_once([' ', '\t'])?.1.trim());
        let names = self.names.borrow();
        let is_known = |line: &'t str| name(line).is_some_and(|name| names.contains(name));
        let stripped = line.split_once('#').map(|(before, _)| before.trim_end());
        if is_known(line) {
            return line;
        }
        if let Some(stripped) = stripped.filter(|stripped| is_known(stripped)) {
            return stripped;
        }
        // Some names stand for no material. If no file is read at all, no colours are expected, or the missing file
        // is noted already.
        if let Some(name) = name(line).filter(|name| !NO_MATERIAL.contains(name)) {
            let slot = if names.is_empty() {
                &self.used_early
            } else {
                &self.unknown
            };
            slot.borrow_mut().get_or_insert_with(|| name.to_owned());
        }
        line
    }

    /// Loads a material file. If it is missing, outside the folder or unreadable, the mesh merely has no colours.
    pub(super) fn load(&self, name: &Path) -> MTLLoadResult {
        let loaded = self.load_file(name);
        if let Ok((_, numbers)) = &loaded {
            self.names.borrow_mut().extend(numbers.keys().cloned());
        } else if !name.as_os_str().is_empty() {
            let mut missing = self.missing.borrow_mut();
            missing.get_or_insert_with(|| name.to_string_lossy().into_owned());
        }
        loaded
    }

    fn load_file(&self, name: &Path) -> MTLLoadResult {
        // Exporters on Windows write backslashes.
        let name = name.to_string_lossy().replace('\\', "/");
        let name = name.trim_matches('"');
        // A path may be one of the machine that wrote it: try the file name alone.
        let beside = || self.text(name.rsplit('/').next()?);
        let text = match self.text(name).or_else(beside) {
            Some(text) => text,
            // A line may name several files, or one whose name contains spaces.
            None => name
                .split_whitespace()
                .filter_map(|name| self.text(name))
                .reduce(|all, one| format!("{all}\n{one}"))
                .ok_or(LoadError::OpenFileFailed)?,
        };
        for line in text.lines() {
            let mut words = line.split_whitespace();
            let keyword = words.next().unwrap_or_default();
            let mut numbers = words.filter_map(|word| word.parse::<f64>().ok());
            match keyword {
                "d" if numbers.next().is_some_and(|share| share < 1.0) => self.is_clear.set(true),
                "Ke" if numbers.any(|light| light > 0.0) => self.glows.set(true),
                word if word.starts_with("map_") => self.has_textures.set(true),
                _ => {}
            }
        }
        let lines = text.lines().map(|line| whole_color(line.trim()));
        let lines = lines.filter(|line| is_color(line));
        let kept = lines.collect::<Vec<_>>().join("\n");
        let (mut materials, mut numbers) = tobj::load_mtl_buf(&mut kept.as_bytes())?;
        // A comment may follow a name. Some names contain a `#` themselves: `Material #25`.
        for (number, material) in materials.iter_mut().enumerate() {
            let before = material.name.split_once("# ").map(|(name, _)| name);
            let name = before.filter(|name| name.ends_with([' ', '\t']));
            if let Some(name) = name.map(|name| name.trim_end().to_owned()) {
                numbers.entry(name.clone()).or_insert(number);
                material.name = name;
            }
        }
        Ok((materials, numbers))
    }

    /// Reads a file as text; `None` if it is not allowed, missing, or longer than what may still be read.
    fn text(&self, name: &str) -> Option<String> {
        let is_allowed = |name: &Path| stays_inside(self.folder, name);
        let name = Some(Path::new(name)).filter(|name| is_allowed(name))?;
        let name = Some(self.spelled(name)).filter(|name| is_allowed(name))?;
        let left = self.left.get();
        let bytes = read_bounded(&self.folder.join(name), left).ok()??;
        // Empty files have a cost too.
        self.left
            .set(left.saturating_sub(bytes.len() as u64 + 1024));
        Some(text_of(&bytes).into_owned())
    }

    /// Returns the name of a file as it is spelled on disk: exporters on Windows ignore case.
    fn spelled(&self, name: &Path) -> PathBuf {
        let place = self.folder.join(name);
        // The number of searches is limited, in case a million missing files are named.
        if place.exists() || self.searches.get() == 0 {
            return name.to_owned();
        }
        self.searches.set(self.searches.get() - 1);
        let folder = place.parent().unwrap_or(self.folder);
        let wanted = place.file_name().unwrap_or_default();
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names = entries.map(|entry| entry.file_name());
        let same = names.find(|name| name.eq_ignore_ascii_case(wanted));
        same.map_or(name.to_owned(), |same| name.with_file_name(same))
    }
}

/// Expands a colour of one number, which is grey, to three: `tobj` does not know the short form.
fn whole_color(line: &str) -> Cow<'_, str> {
    let mut words = line.split_whitespace();
    match (words.next(), words.next(), words.next()) {
        (Some(word @ ("Kd" | "Ks" | "Ka")), Some(grey), None) => {
            Cow::Owned(format!("{word} {grey} {grey} {grey}"))
        }
        _ => Cow::Borrowed(line),
    }
}

/// Returns whether a line is a complete statement about colours: `tobj` panics where a number is missing.
fn is_color(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let keyword = words.next();
    let numbers = |count| {
        let is_number = |word: &str| word.parse::<f64>().is_ok_and(f64::is_finite);
        words
            .clone()
            .take(count)
            .filter(|word| is_number(word))
            .count()
            == count
    };
    match keyword {
        Some("newmtl") => words.clone().next().is_some(),
        Some("Kd" | "Ks" | "Ka") => numbers(3),
        Some("Ns") => numbers(1),
        Some("illum") => words.next().is_some_and(|word| word.parse::<u8>().is_ok()),
        _ => false,
    }
}

/// The colours of a material, if it has a diffuse colour.
pub(super) fn colors_of(material: &Material) -> Option<PartColors> {
    let clamp = |color: [f64; 3]| color.map(|channel| channel.clamp(0.0, 1.0));
    // The first two models have no highlights. An exponent below 1, which some exporters write for rough materials,
    // would give a highlight over the whole lit side, as bright as the light.
    let is_matte = material.illumination_model.is_some_and(|model| model < 2)
        || material.shininess.is_some_and(|exponent| exponent < 1.0);
    let specular = material.specular.filter(|_| !is_matte);
    Some(PartColors {
        name: material.name.clone(),
        diffuse: clamp(material.diffuse?),
        specular: specular.map(clamp).or(is_matte.then_some([0.0; 3])),
        exponent: material.shininess.map(|exponent| exponent.max(0.0)),
        reflective: material
            .illumination_model
            .is_some_and(|model| MIRRORING.contains(&model)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_number_is_grey() {
        assert_eq!(whole_color("Kd 0.5"), "Kd 0.5 0.5 0.5");
        assert_eq!(whole_color("Kd 0.5 1 0"), "Kd 0.5 1 0");
        assert_eq!(whole_color("Ns 10"), "Ns 10");
    }

    #[test]
    fn lines_that_would_panic_are_left_out() {
        for good in ["newmtl red", "Kd 1 0 0", "Ka 1 1 1 1", "Ns 10", "illum 3"] {
            assert!(is_color(good), "{good}");
        }
        for bad in [
            "newmtl",
            "Kd 1 0",
            "Ks spectral a.rfl",
            "Ns",
            "Kd nan 0 0",
            "map_Kd a",
            "illum",
            "illum 1000",
        ] {
            assert!(!is_color(bad), "{bad}");
        }
    }
}
