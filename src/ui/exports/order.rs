//! What is needed to take an export up again, kept on disk until it has ended: a program that is killed
//! forgets nothing of it.

use std::path::Path;
use std::sync::Arc;

use super::fields::{Settings, SettingsError};
use crate::editor::Editor;
use crate::export::Sequence;
use crate::scene::{Document, Leftover, Recovery, Scene};
use crate::worker::Background;

/// What messages about exports are about.
pub const EXPORT: &str = "export";
/// What messages are about that tell of exports that end with the program.
pub const UNKEPT: &str = "Exports that are not kept";

/// First line of the scene that is kept: what is asked for follows.
const MARK: &str = "// export: ";
/// The folder of these files, in that of the program's data.
const FOLDER: &str = "exports";

/// An export that was asked for.
pub struct ExportOrder {
    /// What it is called.
    pub name: String,
    /// What is asked for.
    pub settings: Settings,
    /// Why it ended without being finished, if the program lived on.
    pub why: Option<String>,
    /// The scene as it was then.
    pub scene: Arc<Scene>,
    /// Where it is kept; nowhere, if the system gives no place.
    place: Option<Arc<Recovery>>,
    /// The text on its way there; why it did not arrive.
    writing: Background<Result<(), String>>,
}

impl ExportOrder {
    /// An order for the scene of an editor, kept in the folder of the program's data.
    pub fn new(settings: Settings, editor: &Editor, folder: Option<&Path>) -> Self {
        // The next program may run elsewhere.
        let settings = settings.at_home();
        let place = folder.map(|folder| Recovery::new(&folder.join(FOLDER)));
        let place = place.map(|place| place.map(Arc::new).map_err(|error| error.to_string()));
        // With the triangles of its meshes: their files may be others when it goes on.
        let document = Document::of(editor.scene().taken_in());
        let path = editor.path().map(Path::to_owned);
        let writing = place.clone().map(|place| {
            let settings = settings.clone();
            Background::start("glint-order", move || {
                let place = place?;
                let text = text_of(&settings, document).ok_or("it has no text")?;
                let kept = place.keep(&text, path.as_deref(), None);
                kept.map_err(|error| error.to_string())
            })
        });
        Self {
            name: settings.describe(&editor.title()),
            settings,
            why: None,
            scene: Arc::clone(editor.scene()),
            place: place.and_then(Result::ok),
            writing: writing.unwrap_or_default(),
        }
    }

    /// Why it cannot be kept, once that is known: if the program is killed, it has to be asked for again.
    pub fn take_problem(&mut self) -> Option<String> {
        let kept = self.writing.take()?;
        kept.unwrap_or_else(|no_answer| Err(no_answer.to_string()))
            .err()
    }

    /// What ended programs have left unfinished.
    pub fn left_in(folder: &Path) -> Vec<Self> {
        let folder = folder.join(FOLDER);
        let (mut found, mut unread) = (Vec::new(), Vec::new());
        while folder.is_dir()
            && let Ok(place) = Recovery::new(&folder)
            && let Some(leftover) = place.take_leftover(None)
        {
            match Self::read(leftover, place) {
                Ok(order) => found.push(order),
                // Another version of the program may know what it means: its place is kept until all are seen.
                Err(place) => unread.push(place),
            }
        }
        found
    }

    /// An order that was left; its place, if it is none.
    fn read(leftover: Leftover, place: Recovery) -> Result<Self, Recovery> {
        let Leftover { document, path, .. } = leftover;
        let line = document.header.lines().next();
        let line = line.and_then(|line| line.strip_prefix(MARK));
        let settings = line.and_then(|line| serde_json::from_str::<Settings>(line).ok());
        let Some(settings) = settings else {
            return Err(place);
        };
        let title = path.as_deref().and_then(Path::file_name);
        let title = title.map_or("a new scene".into(), |title| title.to_string_lossy());
        Ok(Self {
            name: settings.describe(&title),
            settings,
            why: None,
            scene: Arc::new(document.scene),
            place: Some(Arc::new(place)),
            writing: Background::default(),
        })
    }

    /// The frames, as they were asked for.
    ///
    /// # Errors
    /// [`SettingsError`], if the program has learnt since that they mean nothing.
    pub fn sequence(&self) -> Result<Sequence, SettingsError> {
        self.settings.sequence(&self.scene)
    }

    /// The same, with why it was not finished.
    pub fn failed(self, why: String) -> Self {
        Self {
            why: Some(why),
            ..self
        }
    }

    /// There is nothing left to take up.
    pub fn end(self) {
        // What is still being written must not be there afterwards.
        self.writing.finish();
        if let Some(place) = self.place {
            place.clear();
        }
    }
}

fn text_of(settings: &Settings, mut document: Document) -> Option<String> {
    let settings = serde_json::to_string(settings).ok()?;
    document.header = format!("{MARK}{settings}\n");
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
        let place = Recovery::new(&orders).expect("a place");
        let text = format!("{MARK}{{\"of\": \"a later version\"}}\n{DEMO_TEXT}");
        place.keep(&text, None, None).expect("kept");
        drop(place);
        for _ in 0..2 {
            assert!(ExportOrder::left_in(folder.path()).is_empty());
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
            ExportOrder::left_in(folder.path()).is_empty(),
            "its program still runs"
        );
        drop(order);
        // Found, and left again.
        for _ in 0..2 {
            let found = ExportOrder::left_in(folder.path());
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
        ExportOrder::left_in(folder.path())
            .into_iter()
            .for_each(ExportOrder::end);
        assert!(ExportOrder::left_in(folder.path()).is_empty());
    }
}
