//! `glint plan`: what a scene needs, and why.

use std::path::PathBuf;

use clap::Args;

use super::error::{CliError, say};
use super::scene::read_scene;
use crate::plan::{ACCELERATOR, RenderRequest, needs, tests_spared};

#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The scene file (RON)
    scene: PathBuf,
    /// Print one JSON array of {rule, what, why, saves}
    #[arg(long)]
    json: bool,
}

/// Prints one line per rule of the plan to stdout.
///
/// # Errors
/// [`CliError::Usage`], if the scene is invalid.
pub fn run(args: &PlanArgs) -> Result<(), CliError> {
    let scene = read_scene(&args.scene)?;
    let request = RenderRequest::still(&scene);
    let mut needs = needs(&scene, &request);
    if let Some(spared) = tests_spared(&scene, &request)
        && let Some(tree) = needs.iter_mut().find(|need| need.rule == ACCELERATOR)
    {
        tree.saves = spared;
    }
    if args.json {
        say(&serde_json::to_string_pretty(&needs)?);
        return Ok(());
    }
    for need in needs {
        say(&format!(
            "{:<12} {}\n             why:   {}\n             saves: {}",
            need.rule, need.what, need.why, need.saves
        ));
    }
    Ok(())
}
