//! A file that is read on another thread, while the window stays usable.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::outside::LoadedScene;
use crate::editor::Editor;
use crate::mesh::{MeshError, MeshFile, read_mesh_file};
use crate::scene::{Document, MeshSource, Scene};
use crate::worker::Background;

/// The outcome of reading.
pub enum ReadOutcome {
    /// A scene file with its meshes, which replaces the document.
    Scene(Box<LoadedScene>),
    /// A mesh file, whose parts become objects.
    Mesh(Result<MeshFile, MeshError>),
    /// The document's own file, which another program has written.
    External(Box<LoadedScene>),
    /// Mesh files of the scene, read again.
    ReloadedMeshes(Vec<MeshSource>),
    /// Nothing: the reading thread stopped.
    Nothing,
}

/// A file that is being read.
pub struct Reading {
    /// Path of the file.
    pub path: PathBuf,
    answer: Background<ReadOutcome>,
    /// Whether what is read replaces the document.
    pub is_scene: bool,
    since: Instant,
    /// The scene when reading began, and the number of its document, see [`Editor::documents`].
    initial_scene: Arc<Scene>,
    document: u64,
}

impl Reading {
    /// Starts to read a scene file.
    pub fn scene(editor: &Editor, path: &Path) -> Self {
        let read = |path: PathBuf| ReadOutcome::Scene(Box::new(Document::load_stamped(&path)));
        Self {
            is_scene: true,
            ..Self::start(editor, path, read)
        }
    }

    /// Starts to read the document's own file, which another program has written.
    pub fn external_version(editor: &Editor, path: &Path) -> Self {
        Self::start(editor, path, |path| {
            ReadOutcome::External(Box::new(Document::load_stamped(&path)))
        })
    }

    /// Starts to read a mesh file.
    pub fn parts(editor: &Editor, path: &Path) -> Self {
        Self::start(editor, path, |path| {
            ReadOutcome::Mesh(read_mesh_file(&path))
        })
    }

    /// Starts to read mesh files again, given as folders and paths within them; `None` if there are none.
    pub fn reload_meshes(editor: &Editor, files: Vec<(PathBuf, String)>) -> Option<Self> {
        let (folder, path) = files.first()?;
        let first = folder.join(path);
        Some(Self::start(editor, &first, |_| {
            let files = files.into_iter();
            let read = files.map(|(folder, path)| MeshSource::read_anew(&folder, path));
            ReadOutcome::ReloadedMeshes(read.collect())
        }))
    }

    fn start(
        editor: &Editor,
        path: &Path,
        read: impl FnOnce(PathBuf) -> ReadOutcome + Send + 'static,
    ) -> Self {
        let owned_path = path.to_owned();
        Self {
            path: path.to_owned(),
            answer: Background::start("glint-reader", move || read(owned_path)),
            is_scene: false,
            since: Instant::now(),
            initial_scene: Arc::clone(editor.scene()),
            document: editor.documents(),
        }
    }

    /// Returns what was read, if that is known within this time.
    pub fn wait(&mut self, timeout: Duration) -> Option<ReadOutcome> {
        let read = self.answer.take_within(timeout)?;
        Some(read.unwrap_or(ReadOutcome::Nothing))
    }

    /// Whether the document has changes since reading began that are not saved, or a flight is being recorded.
    pub fn is_outdated(&self, editor: &Editor) -> bool {
        let has_changed = !Arc::ptr_eq(&self.initial_scene, editor.scene());
        (editor.is_dirty() && has_changed) || editor.is_recording()
    }

    /// Whether another document is open by now.
    pub fn is_for_other_document(&self, editor: &Editor) -> bool {
        self.document != editor.documents()
    }

    /// Whether what was read is still the content of the document's file, and new to the document.
    pub fn is_external_version(&self, editor: &Editor) -> bool {
        editor.path() == Some(&self.path) && editor.is_changed_outside()
    }

    /// Returns the message about a mesh that arrived after its document was closed.
    pub fn describe_late(&self) -> String {
        let name = self.name();
        format!("{name} was not imported: the scene it was meant for is no longer open")
    }

    /// Returns the message about a reading thread that stopped because of an error of its own.
    pub fn describe_fault(&self) -> String {
        let path = self.path.display();
        format!("{path} could not be read: the reader stopped")
    }

    /// The name of the file.
    fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Describes the reading for the status line; if not `is_free`, what was read waits for an open question.
    pub fn describe(&self, is_free: bool) -> String {
        let name = self.name();
        if !is_free {
            return format!("{name} is waiting for your answer");
        }
        let seconds = self.since.elapsed().as_secs_f64();
        format!("reading {name}, {seconds:.0} s")
    }
}
