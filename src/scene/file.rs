//! Reading and writing scene files in RON. Both either succeed completely or change nothing.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use ron::extensions::Extensions;
use ron::ser::PrettyConfig;

use super::check::{Problem, check};
use super::locate::{PathStep, claimed_version, has_inner_comments, header, locate, locate_items};
use super::parse_errors::sentence;
use super::refusal::{Refusal, offset_of};
use super::whole::{MAX_BYTES, Scene, VERSION};
use crate::files::{Stamp, absolute, read_at_most, replace, time_of};
use crate::mesh::is_mesh_file;
use crate::words::for_shell;

/// The RON text of the demo scene, as embedded in the program.
pub const DEMO_TEXT: &str = include_str!("../../scenes/demo.ron");

/// Largest nesting depth of brackets; a scene needs five.
const MAX_DEPTH: usize = 32;

/// A scene and the comment header of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// Comments before the scene, kept when saving; empty or ending with a line break.
    pub header: String,
    /// The scene.
    pub scene: Scene,
}

/// Why a scene could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// The text is not a valid scene.
    #[error("{0}")]
    Refused(Refusal),
    /// The file name is that of a mesh file; nothing was read.
    #[error("{path} is a mesh file, not a scene: `glint convert {quoted} -o NAME.ron` converts it to a scene, and Import mesh in the File menu of the editor adds it to one", path = .path.display(), quoted = for_shell(&.path.display().to_string()))]
    Mesh {
        /// The file.
        path: PathBuf,
    },
    /// The file is larger than the limit for scenes; nothing was read.
    #[error("{path}: a scene file may have at most {limit} bytes; this one has {found}", path = .path.display(), limit = MAX_BYTES)]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its length in bytes.
        found: u64,
    },
    /// The scene cannot be serialized; no file was touched.
    #[error("the scene cannot be written: {0}")]
    Unwritable(ron::Error),
    /// An I/O error.
    #[error("cannot {verb} {path}: {source}", path = .path.display())]
    Disk {
        /// What was attempted: `read` or `write`.
        verb: &'static str,
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
}

impl Scene {
    /// The demo scene: two spheres, a tetrahedron and a mirror under two lights.
    ///
    /// # Panics
    /// Never: a test reads the embedded text.
    #[expect(
        clippy::expect_used,
        reason = "the embedded text is tested to be a valid scene"
    )]
    pub fn demo() -> Self {
        Document::from_text(DEMO_TEXT)
            .expect("the embedded demo scene is valid")
            .scene
    }
}

impl Document {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`SceneError`] if the file is unreadable, too large or refused. Nothing is loaded partially.
    pub fn load(path: &Path) -> Result<Self, SceneError> {
        Self::load_stamped(path).map(|(document, _)| document)
    }

    /// Like [`Self::load`], but also returns a stamp of the file's contents.
    ///
    /// # Errors
    /// See [`Self::load`].
    pub fn load_stamped(path: &Path) -> Result<(Self, Stamp), SceneError> {
        if is_mesh_file(path) {
            let path = path.to_owned();
            return Err(SceneError::Mesh { path });
        }
        // Taken before reading, so that a write during the read counts as a later change.
        let modified = time_of(path);
        let bytes = read_bounded(path)?;
        let stamp = Stamp::of(&bytes, modified);
        let name = path.display().to_string();
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid_length = error.utf8_error().valid_up_to();
            let start = String::from_utf8_lossy(&error.as_bytes()[..valid_length]).into_owned();
            refuse(
                &name,
                &start,
                start.len(),
                "the file is not UTF-8 text".to_owned(),
            )
        })?;
        let mut document = Self::parse(&name, &text)?;
        document.scene.load_meshes(Some(&folder_of(path)));
        Ok((document, stamp))
    }

    /// Reads and checks a scene from RON text.
    ///
    /// # Errors
    /// [`SceneError::Refused`], with `scene` as the name of the text.
    pub fn from_text(text: &str) -> Result<Self, SceneError> {
        Self::parse("scene", text)
    }

    fn parse(name: &str, text: &str) -> Result<Self, SceneError> {
        let text = without_mark(text);
        let refuse_problem =
            |Problem { path, sentence }| refuse(name, text, locate(text, &path), sentence);
        if let Some(version) = claimed_version(text).filter(|&version| version > VERSION) {
            let newer = Scene {
                version,
                ..Scene::empty()
            };
            check(&newer).map_err(refuse_problem)?;
        }
        let scene: Scene = options().from_str(text).map_err(|error| {
            let offset = offset_of(text, error.span.start.line, error.span.start.col);
            // At the end of the last line, the parser's position is one character too early.
            if !text[offset..].contains('\n')
                && !text.ends_with(char::is_whitespace)
                && let Err(error) = Self::parse(name, &format!("{text}\n"))
            {
                return error;
            }
            // The parser stops inside a comment at the end of the file.
            let is_empty = text[header(text).len()..].trim().is_empty();
            let at = match &error.code {
                _ if is_empty => text.trim_end().len(),
                // The parser's position is after the sign of a number that must not have one.
                ron::Error::IntegerOutOfBounds if text[..offset].ends_with('-') => offset - 1,
                // … and after the quotation mark of a text that is refused.
                ron::Error::Message(_) if text[..offset].ends_with('"') => offset - 1,
                _ => offset,
            };
            let sentence = sentence(&error.code, text.split_at(at), MAX_DEPTH);
            let is_end = text[at..].trim().is_empty() && error.code != ron::Error::Eof;
            let prefix = if is_end { "the file ends here; " } else { "" };
            refuse(name, text, at, format!("{prefix}{sentence}"))
        })?;
        check(&scene).map_err(refuse_problem)?;
        Ok(Self {
            header: header(text).to_owned(),
            scene,
        })
    }

    /// Creates a document without a header.
    pub fn of(scene: Scene) -> Self {
        Self {
            header: String::new(),
            scene,
        }
    }

    /// Returns the text of the file: the header, then the scene in the standard layout.
    ///
    /// # Errors
    /// [`SceneError::Unwritable`]; no scene is known for which this happens.
    pub fn to_text(&self) -> Result<String, SceneError> {
        let scene = pretty(&self.scene)?;
        // The animation's lists are as long as the scene's: it is laid out in the same way, and put last.
        let animation = pretty(&self.scene.animation)?.replace('\n', "\n    ");
        let scene = scene.strip_suffix(')').unwrap_or(&scene);
        Ok(format!(
            "{}{scene}    animation: {animation},\n)\n",
            self.header
        ))
    }

    /// Writes the scene to `path`, completely or not at all. If the existing file has comments that the new text
    /// lacks, it is copied to `NAME.bak` first; the path of the copy is returned.
    ///
    /// # Errors
    /// [`SceneError`], also if the text is too long to be read again; the file at `path` is then unchanged.
    pub fn save(&self, path: &Path) -> Result<Option<PathBuf>, SceneError> {
        self.for_path(path).save_stamped(path).map(|(copy, _)| copy)
    }

    /// Returns the document as it is saved at `path`: meshes whose files are not in that folder become inline, and
    /// mesh files that could not be read before are looked for there.
    #[must_use]
    pub fn for_path(&self, path: &Path) -> Self {
        let folder = &folder_of(path);
        Self {
            header: self.header.clone(),
            scene: self.scene.inlined_for(folder).reloaded_from(folder),
        }
    }

    /// Checks that a text to be written to `path` is short enough to be read again.
    ///
    /// # Errors
    /// [`SceneError::TooLarge`].
    pub fn check_length(path: &Path, text: &str) -> Result<(), SceneError> {
        let found = text.len() as u64;
        if found <= MAX_BYTES {
            return Ok(());
        }
        Err(too_large(path, found))
    }

    /// Like [`Self::save`], for a document that [`Self::for_path`] returned for this path. Also returns the new stamp.
    ///
    /// # Errors
    /// See [`Self::save`].
    pub fn save_stamped(&self, path: &Path) -> Result<(Option<PathBuf>, Stamp), SceneError> {
        let loses_comments = |existing: &[u8]| {
            let text = str::from_utf8(existing);
            text.is_ok_and(|text| self.loses_comments_of(text))
        };
        let text = self.to_text()?;
        let backup = write(path, &text, loses_comments)?;
        Ok((backup, Stamp::of(text.as_bytes(), time_of(path))))
    }

    /// Writes the document to a file that may hold anything else, of which a backup is then kept. Returns the path of
    /// the backup.
    ///
    /// # Errors
    /// See [`Self::save`].
    pub fn save_over(&self, path: &Path) -> Result<Option<PathBuf>, SceneError> {
        write(path, &self.to_text()?, |_| true)
    }

    /// Returns whether `text`, a scene file, has comments that this document lacks.
    fn loses_comments_of(&self, text: &str) -> bool {
        let text = without_mark(text);
        let header = header(text);
        let plain = |text: &str| text.replace('\r', "").trim().to_owned();
        let own_header = plain(header);
        !own_header.is_empty() && own_header != plain(&self.header) || has_inner_comments(text)
    }
}

/// Writes the text of a scene, see [`replace`].
fn write(
    path: &Path,
    text: &str,
    is_kept: impl FnOnce(&[u8]) -> bool,
) -> Result<Option<PathBuf>, SceneError> {
    Document::check_length(path, text)?;
    replace(path, text.as_bytes(), is_kept).map_err(|source| disk_error("write", path, source))
}

/// Returns a text without the byte-order mark that some editors put in front.
fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// Returns the absolute path of the folder of a file.
fn folder_of(path: &Path) -> PathBuf {
    absolute(path)
        .parent()
        .map(Path::to_owned)
        .unwrap_or_default()
}

/// Serializes a value with one list item per line. Line breaks in strings are escaped.
fn pretty(value: &impl serde::Serialize) -> Result<String, SceneError> {
    let config = PrettyConfig::new()
        .struct_names(true)
        .depth_limit(2)
        .new_line("\n")
        .compact_maps(false);
    let options = options().with_default_extension(Extensions::UNWRAP_VARIANT_NEWTYPES);
    let text = options.to_string_pretty(value, config);
    text.map_err(SceneError::Unwritable)
}

/// Reads a text file, which must not be longer than a scene file may be.
///
/// # Errors
/// [`SceneError`] if the file is unreadable, too large or not UTF-8.
pub fn read_text(path: &Path) -> Result<String, SceneError> {
    let bytes = read_bounded(path)?;
    String::from_utf8(bytes).map_err(|error| {
        let source = io::Error::new(io::ErrorKind::InvalidData, error);
        disk_error("read", path, source)
    })
}

fn read_bounded(path: &Path) -> Result<Vec<u8>, SceneError> {
    let read = File::open(path).and_then(|file| read_at_most(file, MAX_BYTES));
    read.map_err(|source| disk_error("read", path, source))?
        .map_err(|found| too_large(path, found))
}

fn disk_error(verb: &'static str, path: &Path, source: io::Error) -> SceneError {
    let path = path.to_owned();
    SceneError::Disk { verb, path, source }
}

fn too_large(path: &Path, found: u64) -> SceneError {
    let path = path.to_owned();
    SceneError::TooLarge { path, found }
}

fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_recursion_limit(MAX_DEPTH)
}

/// Returns messages about objects of a scene file that was read before, given by their indices, at their lines and
/// columns if the file can still be read.
pub fn messages_about_objects(path: &Path, sentences: Vec<(usize, String)>) -> Vec<String> {
    let name = path.display().to_string();
    // A pipe cannot be read a second time.
    let text = path.is_file().then(|| read_text(path).ok());
    let text = text.flatten().unwrap_or_default();
    let text = without_mark(&text);
    let offsets = locate_items(text, &[PathStep::Field("objects")]);
    let sentences = sentences.into_iter();
    let messages = sentences.map(|(index, sentence)| match offsets.get(index) {
        Some(&at) => refuse(&name, text, at, sentence).to_string(),
        None => format!("{name}: {sentence}"),
    });
    messages.collect()
}

fn refuse(name: &str, text: &str, at: usize, sentence: String) -> SceneError {
    SceneError::Refused(Refusal::at(name, text, at, sentence))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::scene::List;

    #[test]
    fn what_a_file_leaves_out_is_what_the_demo_has() {
        let demo = Scene::demo();
        let sparse = Document::from_text("Scene(version: 1, objects: [])")
            .expect("valid")
            .scene;
        let mut expected = Scene {
            objects: List::new(),
            ..demo
        };
        for light in expected.lights.iter_mut() {
            light.marker = None;
        }
        assert_eq!(sparse, expected);
    }

    #[test]
    fn remarks_of_another_scene_are_kept_when_it_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.ron");
        let text = format!(
            "// precious\n{}",
            Document::of(Scene::empty()).to_text().expect("a text")
        );
        fs::write(&path, &text).expect("written");
        let own = Document::load(&path).expect("a scene");
        assert_eq!(own.save(&path).expect("saved"), None, "it has them");
        let backup = Document::of(Scene::demo()).save(&path).expect("saved");
        assert_eq!(
            fs::read_to_string(backup.expect("kept")).expect("read"),
            text
        );
    }

    #[test]
    fn the_empty_scene_is_valid() {
        assert_eq!(check(&Scene::empty()), Ok(()));
    }
}
