//! `glint check`: validates scenes.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::error::{WRONG, report_error, say};
use super::scene::missing_meshes;
use crate::scene::{Document, Scene};
use crate::words::counted;

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scene files (RON)
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
}

/// Prints one line per valid file to stdout, and one message per refused file or missing mesh to stderr.
pub fn run(args: &CheckArgs) -> ExitCode {
    let mut code = ExitCode::SUCCESS;
    for path in &args.scenes {
        let problems = match Document::load(path) {
            Ok(Document { scene, .. }) => {
                let missing = missing_meshes(path, &scene, "");
                if missing.is_empty() {
                    say(&format!("{}: ok, {}", path.display(), contents(&scene)));
                }
                missing
            }
            Err(error) => vec![error.to_string()],
        };
        for problem in problems {
            report_error(&problem);
            code = WRONG.into();
        }
    }
    code
}

fn contents(scene: &Scene) -> String {
    let objects = counted(scene.objects.len(), "object");
    let lights = counted(scene.lights.len(), "light");
    let packs = counted(scene.color_packs.len(), "color pack");
    format!("{objects}, {lights}, {packs}")
}
