//! `glint plan`: what a scene needs, and why.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use super::{fail, refuse, say};
use crate::plan::{RenderRequest, needs};
use crate::scene::Document;

#[derive(Debug, Args)]
pub struct PlanArgs {
    /// The scene file (RON)
    scene: PathBuf,
    /// Print one JSON array of {rule, what, why, saves}
    #[arg(long)]
    json: bool,
}

/// One line per rule of the plan on stdout.
pub fn run(words: &PlanArgs) -> ExitCode {
    let scene = match Document::load(&words.scene) {
        Ok(document) => document.scene,
        Err(error) => return refuse(&error.to_string()),
    };
    let needs = needs(&scene, &RenderRequest::still(&scene));
    if words.json {
        return match serde_json::to_string_pretty(&needs) {
            Ok(json) => {
                say(&json);
                ExitCode::SUCCESS
            }
            Err(error) => fail(&error.to_string()),
        };
    }
    for need in needs {
        say(&format!(
            "{:<12} {}\n             why:   {}\n             saves: {}",
            need.rule, need.what, need.why, need.saves
        ));
    }
    ExitCode::SUCCESS
}
