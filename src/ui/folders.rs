//! The folder in which a path is first asked for: where the last path of that kind was.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::dialogs::Ask;
use crate::editor::Editor;

/// The folder that was chosen last for each kind of path, by the first ending of its files.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Folders(BTreeMap<String, PathBuf>);

impl Folders {
    /// Remembers the folder of a path that was chosen.
    pub fn note(&mut self, ask: &Ask, path: &Path) {
        let folder = match ask {
            Ask::ExportFolder => Some(path),
            _ => path.parent(),
        };
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder {
            self.0.insert(kind(ask), folder.to_owned());
        }
    }

    /// Returns the path to start from: in the folder of the last path of that kind, or that of the document; for files
    /// to be written, with the document's name.
    pub fn suggest(&self, editor: &Editor, ask: &Ask) -> PathBuf {
        let document_folder = editor.path().and_then(Path::parent);
        let document_folder = document_folder.filter(|folder| !folder.as_os_str().is_empty());
        let last = self.0.get(&kind(ask)).map(PathBuf::as_path);
        let last = last.filter(|folder| folder.is_dir());
        let current_dir = std::env::current_dir().unwrap_or_default();
        let folder = match ask {
            // A scene is saved next to its own file, if it has one.
            Ask::SaveScene => document_folder.or(last),
            _ => last.or(document_folder),
        };
        let folder = folder.unwrap_or(&current_dir);
        let stem = editor.stem();
        match ask {
            Ask::OpenScene | Ask::ImportMesh | Ask::ImportPath | Ask::ExportFolder => {
                folder.join("")
            }
            Ask::ExportPath => folder.join(format!("{stem} path.csv")),
            Ask::ExportJob => folder.join(format!("{stem} job.yaml")),
            Ask::SaveScene | Ask::SaveImage | Ask::ExportPovray => {
                folder.join(format!("{stem}.{}", ask.endings()[0]))
            }
        }
    }
}

fn kind(ask: &Ask) -> String {
    ask.endings()[0].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_the_folder_that_was_chosen_last() {
        let folder = tempfile::tempdir().expect("a folder");
        let editor = Editor::demo();
        let mut folders = Folders::default();
        let here = std::env::current_dir().expect("a folder");
        assert_eq!(folders.suggest(&editor, &Ask::OpenScene), here.join(""));
        folders.note(&Ask::ImportMesh, &folder.path().join("a.obj"));
        assert_eq!(
            folders.suggest(&editor, &Ask::ImportMesh),
            folder.path().join("")
        );
        assert_eq!(folders.suggest(&editor, &Ask::OpenScene), here.join(""));
        folders.note(&Ask::SaveImage, &folder.path().join("a.png"));
        let image = folders.suggest(&editor, &Ask::SaveImage);
        assert_eq!(image.parent(), Some(folder.path()));
        // A folder that no longer exists is not suggested.
        let gone = folder.path().join("gone/a.png");
        folders.note(&Ask::SaveImage, &gone);
        let image = folders.suggest(&editor, &Ask::SaveImage);
        assert_eq!(image.parent(), Some(here.as_path()));
    }
}
