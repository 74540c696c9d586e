//! Export settings kept between runs.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::fields::Settings;
use crate::editor::Editor;

/// Maximum number of documents whose settings are kept from one run to the next.
const MAX_KEPT_DOCUMENTS: usize = 32;

/// The document that export settings belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SettingsOwner {
    /// A document with a file.
    File(PathBuf),
    /// A document without a file, identified by [`Editor::documents`].
    Unnamed(u64),
}

impl SettingsOwner {
    /// The document that is open in the editor.
    pub fn of(editor: &Editor) -> Self {
        let path = editor.path().map(Path::to_owned);
        path.map_or(Self::Unnamed(editor.documents()), Self::File)
    }
}

/// The last export settings of each document, newest last.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct KeptSettings(Vec<(SettingsOwner, Settings)>);

impl KeptSettings {
    /// Stores the settings for the next export of their document.
    pub fn keep(&mut self, owner: SettingsOwner, settings: Settings) {
        // The next run may start in another working directory.
        let settings = settings.with_absolute_folder();
        self.0.retain(|(other, _)| *other != owner);
        self.0.push((owner, settings));
    }

    /// The last settings of this document.
    pub fn of(&self, owner: &SettingsOwner) -> Option<&Settings> {
        let found = self.0.iter().find(|(of, _)| of == owner);
        found.map(|(_, settings)| settings)
    }

    /// The settings of documents with a file, which the next run can recognize.
    pub fn named(&self) -> Self {
        let is_named =
            |(owner, _): &&(SettingsOwner, Settings)| matches!(owner, SettingsOwner::File(_));
        let named = self.0.iter().filter(is_named);
        let skipped = named.clone().count().saturating_sub(MAX_KEPT_DOCUMENTS);
        Self(named.skip(skipped).cloned().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Video;

    #[test]
    fn settings_are_the_same_in_the_next_run() {
        let editor = Editor::demo();
        for (video, word) in [(None, "none"), (Some(Video::H264), "mp4")] {
            let mut settings = Settings::of(&editor);
            settings.video = video;
            let mut kept = KeptSettings::default();
            let owner = SettingsOwner::File("/a/demo.ron".into());
            kept.keep(owner.clone(), settings.clone());
            // The format in which the window stores its state.
            let text = ron::to_string(&kept).expect("a text");
            assert!(text.contains(&format!("video:\"{word}\"")), "{text}");
            let kept: KeptSettings = ron::from_str(&text).expect("the same");
            assert_eq!(kept.of(&owner), Some(&settings.with_absolute_folder()));
        }
    }
}
