//! The data needed to resume an export, kept on disk until it has ended, so that a killed program loses none of it.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use super::fields::Settings;
use crate::editor::Editor;
use crate::export::Sequence;
use crate::scene::{Document, Leftover, Recovery, Scene};
use crate::worker::Background;

/// Topic of messages about exports.
pub const EXPORT_TOPIC: &str = "export";
/// Topic of messages about orders that could not be written to disk, so that these exports cannot be resumed.
pub const UNSTORED_TOPIC: &str = "Exports that are not kept";

/// Prefix of the first line of a stored scene; the export settings follow it as JSON.
const SETTINGS_PREFIX: &str = "// export: ";
/// Subfolder of the data folder for these files.
const FOLDER: &str = "exports";

/// An export that the user ordered.
pub struct ExportOrder {
    /// Name shown in the list.
    pub name: String,
    /// The export settings.
    pub settings: Settings,
    /// Why it ended unfinished, if it did so while the program was running.
    pub failure: Option<String>,
    /// The scene at the time of the order.
    pub scene: Arc<Scene>,
    /// The file it is kept in; `None` if the system offers no place.
    recovery: Option<Arc<Recovery>>,
    /// The write to disk in progress; its error is a message.
    writing: Background<Result<(), String>>,
}

impl ExportOrder {
    /// Creates an order for the editor's scene, kept in the program's data folder.
    pub fn new(settings: Settings, editor: &Editor, folder: Option<&Path>) -> Self {
        // The next run may start in another working directory.
        let settings = settings.with_absolute_folder();
        let recovery = folder.map(|folder| Recovery::new(&folder.join(FOLDER)));
        let recovery =
            recovery.map(|recovery| recovery.map(Arc::new).map_err(|error| error.to_string()));
        // Mesh triangles are stored inline: the mesh files may have changed when the export is resumed.
        let document = Document::of(editor.scene().inlined());
        let path = editor.path().map(Path::to_owned);
        let writing = recovery.clone().map(|recovery| {
            let settings = settings.clone();
            Background::start("glint-order", move || {
                let recovery = recovery?;
                let text =
                    text_of(&settings, document).ok_or("the scene cannot be written as text")?;
                let kept = recovery.keep(&text, path.as_deref(), None);
                kept.map_err(|error| error.to_string())
            })
        });
        Self {
            name: settings.describe(&editor.title()),
            settings,
            failure: None,
            scene: Arc::clone(editor.scene()),
            recovery: recovery.and_then(Result::ok),
            writing: writing.unwrap_or_default(),
        }
    }

    /// Returns why the order could not be kept on disk, once that is known: if the program is then killed, the user
    /// has to order the export again.
    pub fn take_problem(&mut self) -> Option<String> {
        let kept = self.writing.take()?;
        kept.unwrap_or_else(|no_answer| Err(no_answer.to_string()))
            .err()
    }

    /// Returns the unfinished orders of ended programs.
    pub fn unfinished_in(folder: &Path) -> Vec<Self> {
        let folder = folder.join(FOLDER);
        let (mut found, mut unreadable) = (Vec::new(), Vec::new());
        while folder.is_dir()
            && let Ok(recovery) = Recovery::new(&folder)
            && let Some(leftover) = recovery.take_leftover(None)
        {
            match Self::read(leftover, recovery) {
                Ok(order) => found.push(order),
                // Possibly written by another version. Its lock is held until all files are seen, so that it is not
                // found again.
                Err(recovery) => unreadable.push(recovery),
            }
        }
        found
    }

    /// Reads a leftover order; returns its recovery file as the error if it is not an order.
    fn read(leftover: Leftover, recovery: Recovery) -> Result<Self, Recovery> {
        let Leftover { document, path, .. } = leftover;
        let line = document.header.lines().next();
        let line = line.and_then(|line| line.strip_prefix(SETTINGS_PREFIX));
        let settings = line.and_then(|line| serde_json::from_str::<Settings>(line).ok());
        let Some(settings) = settings else {
            return Err(recovery);
        };
        let title = path.as_deref().and_then(Path::file_name);
        let title = title.map_or("a new scene".into(), |title| title.to_string_lossy());
        Ok(Self {
            name: settings.describe(&title),
            settings,
            failure: None,
            scene: Arc::new(document.scene),
            recovery: Some(Arc::new(recovery)),
            writing: Background::default(),
        })
    }

    /// The frame sequence of the order.
    ///
    /// # Errors
    /// Why this version of the program does not accept the settings, in words for the user.
    pub fn sequence(&self) -> Result<Sequence, Box<dyn Error>> {
        self.settings.sequence(&self.scene)
    }

    /// The same order with the reason why it is unfinished.
    pub fn failed(self, failure: String) -> Self {
        Self {
            failure: Some(failure),
            ..self
        }
    }

    /// Removes the order from disk: nothing is left to resume.
    pub fn end(self) {
        // A write still in progress would put the file back.
        self.writing.finish();
        if let Some(recovery) = self.recovery {
            recovery.clear();
        }
    }
}

fn text_of(settings: &Settings, mut document: Document) -> Option<String> {
    let settings = serde_json::to_string(settings).ok()?;
    document.header = format!("{SETTINGS_PREFIX}{settings}\n");
    document.to_text().ok()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::scene::DEMO_TEXT;

    #[test]
    fn what_another_version_wrote_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let orders = folder.path().join(FOLDER);
        let recovery = Recovery::new(&orders).expect("a place");
        let text = format!("{SETTINGS_PREFIX}{{\"of\": \"a later version\"}}\n{DEMO_TEXT}");
        recovery.keep(&text, None, None).expect("kept");
        drop(recovery);
        for _ in 0..2 {
            assert!(ExportOrder::unfinished_in(folder.path()).is_empty());
            let files = std::fs::read_dir(&orders).expect("there");
            let names = files.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
            let kept: Vec<String> = names.filter(|name| name.contains(".ron")).collect();
            assert_eq!(kept.len(), 1, "{kept:?}");
        }
    }

    #[test]
    fn an_order_that_cannot_be_kept_says_so() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a file");
        std::fs::write(&file, "").expect("written");
        let editor = Editor::demo();
        for (folder, is_told) in [(Some(&*file), true), (None, false)] {
            let mut order = ExportOrder::new(Settings::of(&editor), &editor, folder);
            let written = order.writing.take_within(Duration::from_secs(10));
            assert_eq!(
                written.is_some_and(|it| it.is_ok_and(|it| it.is_err())),
                is_told
            );
        }
    }

    #[test]
    fn an_order_outlives_the_program_and_one_that_has_ended_does_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let editor = Editor::demo();
        let settings = Settings::of(&editor);
        let mut order = ExportOrder::new(settings.clone(), &editor, Some(folder.path()));
        let name = order.name.clone();
        let written = order.writing.take_within(Duration::from_mins(1));
        assert_eq!(written, Some(Ok(Ok(()))));
        assert!(
            ExportOrder::unfinished_in(folder.path()).is_empty(),
            "its program still runs"
        );
        drop(order);
        // Found twice: an order that is dropped without being ended stays on disk.
        for _ in 0..2 {
            let found = ExportOrder::unfinished_in(folder.path());
            let [order] = &found[..] else {
                panic!("{} orders", found.len());
            };
            assert!(Path::new(&order.settings.folder).is_absolute());
            assert!(order.settings.folder.ends_with(&settings.folder));
            assert_eq!(order.scene, *editor.scene());
            assert_eq!(
                order.name.split_once(" · ").map(|(_, rest)| rest),
                name.split_once(" · ").map(|(_, rest)| rest)
            );
        }
        ExportOrder::unfinished_in(folder.path())
            .into_iter()
            .for_each(ExportOrder::end);
        assert!(ExportOrder::unfinished_in(folder.path()).is_empty());
    }
}
