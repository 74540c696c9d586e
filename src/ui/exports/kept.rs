//! What was asked of exports, for the next time.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::fields::Settings;
use crate::editor::Editor;

/// Documents whose settings are kept from one run to the next.
const MOST_KEPT: usize = 32;

/// The document that settings belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum SettingsOwner {
    /// One with a file.
    File(PathBuf),
    /// One without, see [`Editor::documents`].
    Unnamed(u64),
}

impl SettingsOwner {
    /// That of what is edited.
    pub fn of(editor: &Editor) -> Self {
        let path = editor.path().map(Path::to_owned);
        path.map_or(Self::Unnamed(editor.documents()), Self::File)
    }
}

/// What was asked for last, for each document, the newest last.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct KeptSettings(Vec<(SettingsOwner, Settings)>);

impl KeptSettings {
    /// Puts settings away, for the next time that their document is exported.
    pub fn keep(&mut self, owner: SettingsOwner, settings: Settings) {
        // The next program may run elsewhere.
        let settings = settings.at_home();
        self.0.retain(|(other, _)| *other != owner);
        self.0.push((owner, settings));
    }

    /// What was asked for last of this document.
    pub fn of(&self, owner: &SettingsOwner) -> Option<&Settings> {
        let found = self.0.iter().find(|(of, _)| of == owner);
        found.map(|(_, settings)| settings)
    }

    /// Those of documents with a file, which the next run can know again.
    pub fn named(&self) -> Self {
        let is_named =
            |(owner, _): &&(SettingsOwner, Settings)| matches!(owner, SettingsOwner::File(_));
        let named = self.0.iter().filter(is_named);
        let skipped = named.clone().count().saturating_sub(MOST_KEPT);
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
            // As the window keeps what it remembers.
            let text = ron::to_string(&kept).expect("a text");
            assert!(text.contains(&format!("video:\"{word}\"")), "{text}");
            let kept: KeptSettings = ron::from_str(&text).expect("the same");
            assert_eq!(kept.of(&owner), Some(&settings.at_home()));
        }
    }
}
