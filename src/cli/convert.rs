//! `glint convert`: turns a mesh file into a scene, or a scene into a file for POV-Ray.

use std::path::{Path, PathBuf, absolute};

use clap::Args;

use super::error::{CliError, report_warning, say};
use super::scene::read_scene;
use crate::export::{povray_text, write_text};
use crate::files::has_ending;
use crate::mesh::is_mesh_file;
use crate::scene::{Document, Scene, check};
use crate::words::{counted, for_shell};

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// Mesh file (OBJ with MTL, STL, PLY, glTF or GLB) or scene file (RON)
    #[arg(value_name = "MESH|SCENE")]
    input: PathBuf,
    /// Scene file (RON) to write, which refers to a mesh file of one part in its folder or below it, and embeds any
    /// other; for a scene, the POV-Ray file (.pov) to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Writes a scene that shows the whole mesh, lit from two sides; or the scene in POV-Ray's language.
///
/// # Errors
/// [`CliError`], if a file cannot be read or written.
pub fn run(args: &ConvertArgs) -> Result<(), CliError> {
    let output = args.output.display();
    match (is_mesh_file(&args.input), &args.output) {
        (false, path) if has_ending(path, "pov") => write_povray(args),
        (false, _) if has_ending(&args.input, "ron") => Err(CliError::usage(format!(
            "{output}: a scene is converted to a POV-Ray file, which must end in .pov"
        ))),
        (_, path) if has_ending(path, "ron") => write_scene(args),
        _ => Err(CliError::usage(format!(
            "{output}: a scene file must end in .ron"
        ))),
    }
}

fn write_povray(args: &ConvertArgs) -> Result<(), CliError> {
    let scene = read_scene(&args.input)?;
    write_text(&args.output, &povray_text(&scene))?;
    let (width, height) = (scene.render.width, scene.render.height);
    let path = args.output.display().to_string();
    if path.contains(['\\', '"']) || !path.is_ascii() {
        let sentence = "POV-Ray cannot read a file with this name: rename it first";
        say(&format!("{path}: {sentence}"));
        return Ok(());
    }
    let input = input_option(&path);
    say(&format!(
        "{path}: draw it with povray {input} +W{width} +H{height} -A File_Gamma=1.0 Dither=off"
    ));
    Ok(())
}

/// The option that gives POV-Ray its input file, quoted for a shell. POV-Ray parses the argument once more.
fn input_option(path: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "/._-".contains(letter);
    if path.chars().all(is_plain) {
        return format!("+I{path}");
    }
    for_shell(&format!("+I\"{path}\""))
}

/// Resolves links and `..` in the folder of a path, if the folder exists.
fn in_real_folder(path: PathBuf) -> PathBuf {
    let folder = path.parent().and_then(|folder| folder.canonicalize().ok());
    match (folder, path.file_name()) {
        (Some(folder), Some(file)) => folder.join(file),
        _ => path,
    }
}

fn write_scene(args: &ConvertArgs) -> Result<(), CliError> {
    let absolute_path = |path: &Path| {
        let with_path = |error| CliError::usage(format!("{}: {error}", path.display()));
        absolute(path).map_err(with_path)
    };
    let (mut input, mut output) = (absolute_path(&args.input)?, absolute_path(&args.output)?);
    let is_below = |input: &Path, output: &Path| {
        let folder = output.parent();
        folder.is_some_and(|folder| input.starts_with(folder))
    };
    if !is_below(&input, &output) {
        // The same folder may have been given under two names.
        (input, output) = (in_real_folder(input), in_real_folder(output));
    }
    let read = Scene::of_mesh_file(&input, output.parent());
    let (scene, notes) = read.map_err(CliError::usage)?;
    for note in notes {
        report_warning(&format!("{}: {note}", args.input.display()));
    }
    check(&scene).map_err(|problem| {
        let (name, sentence) = (input.display(), problem.sentence);
        CliError::usage(format!(
            "{name}: a scene cannot hold all of this mesh: {sentence}"
        ))
    })?;
    let objects = scene.objects.len();
    let faces: usize = scene.faces();
    let backup = Document::of(scene).save_over(&output);
    if let Some(backup) = backup.map_err(CliError::failed)? {
        let (name, backup) = (args.output.display(), backup.display());
        report_warning(&format!("the previous {name} is kept as {backup}"));
    }
    say(&format!(
        "{}: {}, {}",
        args.output.display(),
        counted(objects, "object"),
        counted(faces, "triangle")
    ));
    Ok(())
}
