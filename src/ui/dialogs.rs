//! Asking for a path: with the desktop's own dialog, on a separate thread, or with a prompt in the window if the
//! desktop offers none.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use egui::Context;

use crate::worker::Background;

/// The purpose of a path that is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ask {
    /// A scene to open.
    OpenScene,
    /// A mesh to add to the scene.
    ImportMesh,
    /// Where to write the scene.
    SaveScene,
    /// Where to write the picture.
    SaveImage,
    /// A camera path whose keys are imported.
    ImportPath,
    /// Where to write the camera path.
    ExportPath,
    /// Where to write the job for a render farm.
    ExportJob,
    /// Where to write the scene for POV-Ray.
    ExportPovray,
    /// The folder for exported frames.
    ExportFolder,
}

impl Ask {
    /// The title of the dialog.
    pub fn title(&self) -> &'static str {
        match self {
            Self::OpenScene => "Open scene",
            Self::ImportMesh => "Import mesh",
            Self::SaveScene => "Save scene",
            Self::SaveImage => "Save image",
            Self::ImportPath => "Import camera path",
            Self::ExportPath => "Export camera path",
            Self::ExportJob => "Export farm job",
            Self::ExportPovray => "Export for POV-Ray",
            Self::ExportFolder => "Folder for the frames",
        }
    }

    /// Whether something is written to the path.
    pub fn writes(&self) -> bool {
        !matches!(
            self,
            Self::OpenScene | Self::ImportMesh | Self::ImportPath | Self::ExportFolder
        )
    }

    /// Returns the path with the usual ending if it has none. A path of an existing file to be read stays as it is.
    /// Scenes always get their own ending, after any other one.
    pub fn with_ending(&self, mut path: PathBuf) -> PathBuf {
        if !self.writes() && path.is_file() {
            return path;
        }
        let own_ending = self.endings()[0];
        let doubled = format!(".{own_ending}.{own_ending}");
        let name = path.to_string_lossy();
        if name.ends_with(&doubled) && !path.exists() {
            // The name was typed in front of an ending that was there already.
            return path.with_extension("");
        }
        let ending = path.extension().unwrap_or_default();
        if ending.is_empty() {
            return path.with_extension(own_ending);
        }
        if *self == Self::SaveScene && !ending.eq_ignore_ascii_case(own_ending) {
            path.as_mut_os_string().push(format!(".{own_ending}"));
        }
        path
    }

    /// Whether a file of this name will do: the ending of a picture or a camera path decides its format.
    pub fn accepts(&self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        !matches!(self, Self::SaveImage | Self::ExportPath)
            || self.endings().iter().any(|known| ending == *known)
    }

    /// The endings of such files; the first one is added to a path without an ending.
    pub fn endings(&self) -> &'static [&'static str] {
        match self {
            Self::OpenScene | Self::SaveScene => &["ron"],
            Self::ImportMesh => &["obj", "stl", "ply", "glb", "gltf"],
            Self::SaveImage => &["png", "ppm", "exr"],
            Self::ImportPath | Self::ExportPath => &["csv", "ron"],
            Self::ExportJob => &["yaml"],
            Self::ExportPovray => &["pov"],
            Self::ExportFolder => &[""],
        }
    }
}

/// Something that asks the user for a path.
pub trait Dialogs {
    /// Asks, starting from `suggested`. The answer arrives later; `None` means cancelled.
    fn ask(&mut self, ctx: &Context, ask: &Ask, suggested: PathBuf) -> Background<Option<PathBuf>>;
}

/// The folder and the file name with which a dialog starts, given the suggested path: a file that is written is in its
/// folder, and anything else is looked for in the suggested folder itself.
fn start_of<'a>(ask: &Ask, suggested: &'a Path) -> (Option<&'a Path>, Option<&'a OsStr>) {
    if ask.writes() {
        (suggested.parent(), suggested.file_name())
    } else {
        (Some(suggested), None)
    }
}

/// The desktop's dialogs.
#[derive(Debug)]
pub struct NativeDialogs;

impl Dialogs for NativeDialogs {
    fn ask(&mut self, ctx: &Context, ask: &Ask, suggested: PathBuf) -> Background<Option<PathBuf>> {
        let (ask, wake) = (ask.clone(), ctx.clone());
        Background::start("glint-dialog", move || {
            let mut dialog = rfd::FileDialog::new().set_title(ask.title());
            dialog = match ask {
                Ask::OpenScene | Ask::SaveScene => dialog.add_filter("Glint scene", ask.endings()),
                Ask::ImportMesh => dialog.add_filter("Mesh", ask.endings()),
                Ask::SaveImage => dialog.add_filter("Picture", ask.endings()),
                Ask::ExportJob => dialog.add_filter("Open Job Description", ask.endings()),
                Ask::ExportPovray => dialog.add_filter("POV-Ray scene", ask.endings()),
                Ask::ExportFolder => dialog,
                Ask::ImportPath | Ask::ExportPath => {
                    dialog.add_filter("Camera path", ask.endings())
                }
            };
            let (folder, name) = start_of(&ask, &suggested);
            if let Some(folder) = folder.filter(|folder| folder.is_dir()) {
                dialog = dialog.set_directory(folder);
            }
            if let Some(name) = name {
                dialog = dialog.set_file_name(name.to_string_lossy());
            }
            let path = if ask == Ask::ExportFolder {
                dialog.pick_folder()
            } else if ask.writes() {
                dialog.save_file()
            } else {
                dialog.pick_file()
            };
            wake.request_repaint();
            path
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_without_an_ending_can_be_opened_and_is_not_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("scene");
        let with = folder.path().join("scene.ron");
        assert_eq!(Ask::OpenScene.with_ending(path.clone()), with);
        std::fs::write(&path, "").expect("written");
        assert_eq!(Ask::OpenScene.with_ending(path.clone()), path);
        assert_eq!(Ask::SaveScene.with_ending(path), with);
    }

    #[test]
    fn a_dialog_starts_in_the_folder_that_is_suggested() {
        let (folder, name) = (Path::new("scenes"), OsStr::new("a.ron"));
        let with_slash = folder.join("");
        for ask in [Ask::OpenScene, Ask::ExportFolder] {
            assert_eq!(start_of(&ask, &with_slash), (Some(folder), None));
        }
        let written = folder.join(name);
        let found = start_of(&Ask::SaveScene, &written);
        assert_eq!(found, (Some(folder), Some(name)));
    }
}
