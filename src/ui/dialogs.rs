//! Asking for a path: the desktop's own dialog, on a thread of its own, or a prompt in the window
//! where the desktop offers none.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::worker::Background;

/// What a path is asked for.
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
    /// A camera path to take the keys of.
    ImportPath,
    /// Where to write the camera path.
    ExportPath,
    /// Where to write the job for a render farm.
    ExportJob,
    /// Where to write the scene for POV-Ray.
    ExportPovray,
    /// The folder for frames.
    ExportFolder,
}

impl Ask {
    /// What the dialog is called.
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

    /// The path, with the ending that such files have if it has none, unless it is a file to be read; scenes have
    /// always that of scenes, whatever stands before it.
    pub fn with_ending(&self, mut path: PathBuf) -> PathBuf {
        if !self.writes() && path.is_file() {
            return path;
        }
        let own = self.endings()[0];
        let doubled = format!(".{own}.{own}");
        let name = path.to_string_lossy();
        if name.ends_with(&doubled) && !path.exists() {
            // Typed in front of an ending that was there already.
            return path.with_extension("");
        }
        match path.extension() {
            Some(ending) if ending.is_empty() => path.with_extension(own),
            Some(ending) if *self == Self::SaveScene && !ending.eq_ignore_ascii_case(own) => {
                path.as_mut_os_string().push(format!(".{own}"));
                path
            }
            Some(_) => path,
            None => path.with_extension(own),
        }
    }

    /// Whether a file of this name can be what is asked for: pictures and tables are written as their endings say.
    pub fn takes(&self, path: &Path) -> bool {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        !matches!(self, Self::SaveImage | Self::ExportPath)
            || self.endings().iter().any(|known| ending == *known)
    }

    /// The endings that files of this kind have; the first is added where there is none.
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
    /// Asks, starting from `suggested`; the answer, or `None` for cancelled, arrives later.
    fn ask(&mut self, ctx: &Context, ask: &Ask, suggested: PathBuf) -> Background<Option<PathBuf>>;
}

/// The desktop's dialogs.
#[derive(Debug)]
pub struct Native;

impl Dialogs for Native {
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
            if let Some(folder) = suggested.parent().filter(|folder| folder.is_dir()) {
                dialog = dialog.set_directory(folder);
            }
            if ask.writes()
                && let Some(name) = suggested.file_name()
            {
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
}
