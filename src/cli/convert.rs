//! `glint convert`: a mesh file becomes a scene.

use std::path::{PathBuf, absolute};

use clap::Args;

use super::error::{CliError, say};
use crate::scene::{Document, Scene};

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// Mesh file: OBJ (with MTL), STL, PLY, glTF or GLB
    #[arg(value_name = "MESH")]
    input: PathBuf,
    /// Scene file (RON) to be written; refers to a mesh of one part beside it, and holds all others
    #[arg(short, long, value_name = "SCENE")]
    output: PathBuf,
}

/// Writes a scene that shows the mesh whole, lit from two sides.
///
/// # Errors
/// [`CliError`]: a mesh that cannot be read, or a scene that cannot be written.
pub fn run(args: &ConvertArgs) -> Result<(), CliError> {
    if args.output.extension().is_none_or(|ending| ending != "ron") {
        return Err(CliError::usage(format!(
            "{}: a scene file ends in .ron",
            args.output.display()
        )));
    }
    let input = absolute(&args.input).map_err(CliError::usage)?;
    let output = absolute(&args.output).map_err(CliError::usage)?;
    let scene = Scene::of_mesh_file(&input, output.parent()).map_err(CliError::usage)?;
    let objects = scene.objects.len();
    let faces: usize = scene.faces();
    let document = Document {
        header: String::new(),
        scene,
    };
    document.save(&output).map_err(CliError::failed)?;
    let parts = if objects == 1 { "object" } else { "objects" };
    say(&format!(
        "{}: {objects} {parts}, {faces} triangles",
        args.output.display()
    ));
    Ok(())
}
