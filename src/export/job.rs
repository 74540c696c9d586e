//! A job for a render farm: an Open Job Description template.
//!
//! <https://github.com/OpenJobDescription/openjd-specifications>, version 2023-09 with task chunking.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::ExportError;
use super::save::{check_writable, disk_error};
use super::sequence::Sequence;
use crate::files::{is_same_file, replace};
use crate::scene::{Document, SceneError};

/// Most characters of a job's name: Open Job Description, template schemas 2023-09, `<JobName>`.
const MAX_NAME_LENGTH: usize = 128;

/// Frames per task, unless the farm says otherwise.
const CHUNK: u32 = 10;

/// The template, with a key between @ signs for each value.
const TEMPLATE: &str = include_str!("../../assets/job_template.yaml");

/// The reason why a job could not be written.
#[derive(Debug, thiserror::Error)]
pub enum JobError {
    /// The template or the copy of the scene could not be written.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The scene cannot be serialized.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The template would have the name of the scene.
    #[error("{path} is the scene file: give the job another name, such as {other}", path = .path.display(), other = .other.display())]
    IsScene {
        /// Where the template was to go.
        path: PathBuf,
        /// Where it could go.
        other: PathBuf,
    },
    /// The text of the frame set is longer than a job can hold.
    #[error(
        "the frames {0:.40}… have too many ranges for one job: make several jobs, or one of all frames"
    )]
    TooManyPieces(String),
}

/// Most characters of a value in a template, according to the standard.
const MAX_VALUE_LENGTH: usize = 1024;

/// The files that [`write_job`] has written.
#[derive(Debug)]
pub struct JobFiles {
    /// The scene that is rendered, beside the template.
    pub scene: PathBuf,
    /// Whether that is a copy made for the job.
    pub is_copied: bool,
    /// Files that held something else, each with the path of its backup.
    pub replaced: Vec<(PathBuf, PathBuf)>,
}

/// Writes the template of a job to `path`, and the scene beside it, unless `file`, which holds this document, is that
/// very file. A farm gets no other files: meshes in files of their own are stored in the scene, in a copy of another
/// name.
///
/// # Errors
/// [`JobError`]: what could not be written.
pub fn write_job(
    document: &Document,
    file: Option<&Path>,
    sequence: &Sequence,
    path: &Path,
) -> Result<JobFiles, JobError> {
    let name_source = file.unwrap_or(path);
    let stem = name_source
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let has_files = document.scene.has_mesh_files();
    let suffix = if has_files { "-whole" } else { "" };
    let name = format!("{stem}{suffix}.ron");
    let scene = path.with_file_name(&name);
    if path == scene || file.is_some_and(|file| is_same_file(file, path)) {
        let (path, other) = (path.to_owned(), path.with_extension("yaml"));
        return Err(JobError::IsScene { path, other });
    }
    let frames = sequence.frames.to_string();
    if frames.len() > MAX_VALUE_LENGTH {
        return Err(JobError::TooManyPieces(frames));
    }
    // Checked first, so that no file is moved to a backup for a template that cannot be written.
    check_writable(path)?;
    let is_copied = !file.is_some_and(|file| is_same_file(file, &scene));
    let backup = if is_copied {
        write_scene(document, file.filter(|_| !has_files), &scene)?
    } else {
        None
    };
    let scene_backup = backup.map(|backup| (scene.clone(), backup));
    // An older template written by Glint is overwritten without a backup.
    let is_edited = |existing: &[u8]| !is_template(&String::from_utf8_lossy(existing));
    let text = job_template(sequence, &stem, &name);
    let backup = replace(path, text.as_bytes(), is_edited);
    let backup = backup.map_err(|source| disk_error(path, source))?;
    let template_backup = backup.map(|backup| (path.to_owned(), backup));
    Ok(JobFiles {
        scene,
        is_copied,
        replaced: scene_backup.into_iter().chain(template_backup).collect(),
    })
}

/// Writes a document to `path`: the contents of `file` if that is given. Returns the path of the backup if something
/// else was at `path`.
fn write_scene(
    document: &Document,
    file: Option<&Path>,
    path: &Path,
) -> Result<Option<PathBuf>, JobError> {
    let disk_error = |source| disk_error(path, source);
    // Regular files only: a pipe can be read only once.
    let text = if let Some(file) = file.filter(|file| file.is_file()) {
        fs::read(file).map_err(disk_error)?
    } else {
        let (header, scene) = (document.header.clone(), document.scene.inlined());
        let text = Document { header, scene }.to_text()?;
        Document::check_length(path, &text)?;
        text.into_bytes()
    };
    Ok(replace(path, &text, |_| true).map_err(disk_error)?)
}

/// Returns a job name for a scene of this name. Double braces are broken up, as they delimit what the farm
/// substitutes.
fn job_name(scene: &str) -> String {
    let name = scene.replace("{{", "{ ").replace("}}", "} ");
    let plain = name.chars().filter(|letter| !letter.is_control());
    plain.take(MAX_NAME_LENGTH).collect()
}

/// Whether a text is the template with the values of some scene, and nothing written by hand.
fn is_template(text: &str) -> bool {
    let template = TEMPLATE.replace("@CHUNK@", &CHUNK.to_string());
    // All parts of the template between its keys must occur verbatim.
    let mut parts = template.split('@').step_by(2);
    let remaining = parts.next().and_then(|first| text.strip_prefix(first));
    let remaining = parts.try_fold(remaining.unwrap_or_default(), |remaining, part| {
        let (value, remaining) = remaining.split_once(part)?;
        (!value.contains('\n')).then_some(remaining)
    });
    remaining == Some("")
}

/// Fills in the template: frames in chunks, then a video of all of them. The scene is an attached file, which lies
/// beside the template under the name `scene`; `name` is the name of the job.
fn job_template(sequence: &Sequence, name: &str, scene: &str) -> String {
    // A JSON string is also a YAML string.
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let (width, height) = sequence.size();
    // Every second part of the template is a key.
    let parts = TEMPLATE.split('@').map(|part| match part {
        "NAME" => quoted(&job_name(name)),
        "SCENE" => quoted(scene),
        "FRAMES" => quoted(&sequence.frames.to_string()),
        "PATTERN" => quoted(&sequence.pattern.text()),
        "FORMAT" => quoted(sequence.format.ending()),
        "WIDTH" => width.to_string(),
        "HEIGHT" => height.to_string(),
        "ANTIALIAS" => quoted(&sequence.antialias()),
        "CHUNK" => CHUNK.to_string(),
        text => text.to_owned(),
    });
    parts.collect()
}
