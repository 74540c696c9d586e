//! A file that is read beside the window, which stays live meanwhile.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::editor::Editor;
use crate::files::Stamp;
use crate::mesh::{MeshError, MeshFile, read_mesh_file};
use crate::scene::{Document, MeshSource, Scene, SceneError};
use crate::worker::Background;

/// What was read.
pub enum Read {
    /// A scene file with its meshes, which takes the place of the document.
    Scene(Box<Result<(Document, Stamp), SceneError>>),
    /// A mesh file, whose parts become objects.
    Mesh(Result<MeshFile, MeshError>),
    /// Files that meshes refer to, once more.
    Again(Vec<MeshSource>),
    /// Nothing: the reader stopped.
    Nothing,
}

/// A file that is being read.
pub struct Reading {
    /// Where it is.
    pub path: PathBuf,
    answer: Background<Read>,
    is_scene: bool,
    since: Instant,
    /// The document when its reading began, and which of them it was, see [`Editor::documents`].
    before: Arc<Scene>,
    document: u64,
}

impl Reading {
    /// Begins to read a scene.
    pub fn scene(editor: &Editor, path: &Path) -> Self {
        let read = |path: PathBuf| Read::Scene(Box::new(Document::load_stamped(&path)));
        Self {
            is_scene: true,
            ..Self::start(editor, path, read)
        }
    }

    /// Whether what is read takes the place of the document.
    pub fn is_scene(&self) -> bool {
        self.is_scene
    }

    /// Begins to read a mesh file.
    pub fn parts(editor: &Editor, path: &Path) -> Self {
        Self::start(editor, path, |path| Read::Mesh(read_mesh_file(&path)))
    }

    /// Begins to read once more what meshes refer to, if that is something: paths in their folders.
    pub fn again(editor: &Editor, files: Vec<(PathBuf, String)>) -> Option<Self> {
        let (folder, path) = files.first()?;
        let first = folder.join(path);
        Some(Self::start(editor, &first, |_| {
            let files = files.into_iter();
            let read = files.map(|(folder, path)| MeshSource::read_anew(&folder, path));
            Read::Again(read.collect())
        }))
    }

    fn start(
        editor: &Editor,
        path: &Path,
        read: impl FnOnce(PathBuf) -> Read + Send + 'static,
    ) -> Self {
        let own = path.to_owned();
        Self {
            path: path.to_owned(),
            answer: Background::start("glint-reader", move || read(own)),
            is_scene: false,
            since: Instant::now(),
            before: Arc::clone(editor.scene()),
            document: editor.documents(),
        }
    }

    /// What was read, if that is known within so long.
    pub fn wait(&mut self, most: Duration) -> Option<Read> {
        let read = self.answer.take_within(most)?;
        Some(read.unwrap_or(Read::Nothing))
    }

    /// Whether the document was changed since.
    pub fn is_outrun(&self, editor: &Editor) -> bool {
        let is_other = !Arc::ptr_eq(&self.before, editor.scene());
        (editor.is_dirty() && is_other) || editor.is_recording()
    }

    /// Whether another document is open by now.
    pub fn is_of_another(&self, editor: &Editor) -> bool {
        self.document != editor.documents()
    }

    /// What is said where it came too late.
    pub fn describe_late(&self) -> String {
        let name = self.name();
        format!("{name} was not imported: the scene it was meant for is no longer open")
    }

    /// What is said where the reader stopped with a fault of its own.
    pub fn describe_fault(&self) -> String {
        let path = self.path.display();
        format!("{path} could not be read: the reader stopped")
    }

    /// The name of the file.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// In words, for the status line; what was read may have to wait.
    pub fn describe(&self, is_free: bool) -> String {
        let name = self.name();
        if !is_free {
            return format!("{name} is waiting for your answer");
        }
        let seconds = self.since.elapsed().as_secs_f64();
        format!("reading {name}, {seconds:.0} s")
    }
}
