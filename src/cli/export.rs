//! `glint export`: writes an animation as files, resuming where it was left; `glint job`: the same for a render farm.

use std::path::{PathBuf, absolute};
use std::sync::Arc;
use std::time::Instant;

use clap::{Args, ValueHint};
use indicatif::ProgressBar;

use super::args::{SizeArgs, ThreadsArgs};
use super::bar::{TICK, progress_bar, restyle};
use super::error::{CliError, report_warning, say};
use super::scene::read_whole_document;
use crate::export::{
    ExportError, ExportStep, Exported, Exporting, Frames, JobError, LOOP_HINT, Pattern, Sequence,
    Video, check_writable, write_job,
};
use crate::image::Format;
use crate::scene::{Method as _, Sampling, Scene};
use crate::trace::{RenderControl, Threads};
use crate::words::counted;

/// Arguments that `export` and `job` share.
#[derive(Debug, Args)]
struct SequenceArgs {
    /// The scene file (RON)
    scene: PathBuf,
    /// Frames, counted from 1: 1-202, 1,4 or 1-10:3 [default: all]
    #[arg(long, value_parser = Frames::parse, allow_hyphen_values = true)]
    frames: Option<Frames>,
    /// File names of the frames: %d stands for the number, %05d for five digits
    #[arg(long, value_name = "PATTERN", default_value = "rayTrace%d", value_parser = Pattern::parse)]
    name: Pattern,
    /// Format of the frames: ppm, png or exr (the same values, 0–1, unrounded)
    #[arg(long, default_value = "ppm", value_parser = parse_format, value_hint = ValueHint::Other)]
    format: Format,
    #[command(flatten)]
    size: SizeArgs,
    #[arg(long, value_name = "METHOD", value_parser = Sampling::parse, help = antialias_help(), value_hint = ValueHint::Other)]
    antialias: Option<Sampling>,
}

fn antialias_help() -> String {
    let methods = Sampling::syntax();
    format!("Antialiasing of edges: {methods} [default: the scene's own]")
}

#[derive(Debug, Args)]
pub struct ExportArgs {
    #[command(flatten)]
    what: SequenceArgs,
    /// Folder for the frames
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Video to make from the frames: .mp4, .mov and .mkv need ffmpeg, .gif and .apng do not
    #[arg(long, value_name = "FILE")]
    video: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadsArgs,
    /// Only list which frames would be made, and how many
    #[arg(long)]
    dry_run: bool,
    /// Report progress in the format that Open Job Description runners read
    #[arg(long)]
    openjd: bool,
}

#[derive(Debug, Args)]
pub struct JobArgs {
    #[command(flatten)]
    what: SequenceArgs,
    /// Template to write (YAML); the scene is copied next to it if it is in another folder or uses mesh files
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

fn parse_format(word: &str) -> Result<Format, String> {
    Format::of_ending(word).ok_or_else(|| "expected ppm, png or exr".to_owned())
}

impl SequenceArgs {
    /// The frames to be made of a scene.
    fn sequence(&self, mut scene: Scene, folder: PathBuf) -> Result<Sequence, CliError> {
        let render = &mut scene.render;
        (render.width, render.height) = self.size.of((render.width, render.height))?;
        render.antialias = self.antialias.unwrap_or(render.antialias);
        let (frames, name) = (self.frames.clone(), self.name.clone());
        Sequence::new(Arc::new(scene), frames, name, self.format, folder)
            .map_err(|error| CliError::usage(format!("{}: {error}", self.scene.display())))
    }
}

/// Writes the frames that are missing or outdated, then the video.
///
/// # Errors
/// [`CliError`], if the arguments do not fit the scene, or if frames or the video cannot be written.
pub fn run(args: &ExportArgs) -> Result<(), CliError> {
    let video = args.video.as_deref();
    let video = video.map(|path| Video::of_path(path).map(|video| (path, video)));
    let video = video.transpose().map_err(CliError::usage)?;
    let scene = read_whole_document(&args.what.scene)?.scene;
    let sequence = args.what.sequence(scene, args.output.clone())?;
    if let Some((path, video)) = video {
        let remark = video.check(&sequence).map_err(CliError::usage)?;
        // The video may go into the folder of the frames, which need not exist yet.
        let video_folder = path.parent().and_then(|folder| absolute(folder).ok());
        let is_with_frames =
            video_folder.is_some() && video_folder == absolute(&sequence.folder).ok();
        if is_with_frames && !args.dry_run {
            sequence.prepare()?;
        }
        if !is_with_frames || sequence.folder.exists() {
            check_writable(path)?;
        }
        if let Some(remark) = remark {
            report_warning(&remark);
        }
        if sequence.is_loop() {
            report_warning(&format!("{}: {LOOP_HINT}", path.display()));
        }
    }
    if args.dry_run {
        return report_missing(&sequence);
    }
    let threads = args.threads.start()?;
    let start = Instant::now();
    let mut reporter = ProgressReporter::new(&sequence, args.openjd);
    let done = export(sequence.clone(), &threads, &mut reporter)?;
    let seconds = start.elapsed().as_secs_f64();
    if let Some((path, video)) = video {
        reporter.clear();
        reporter.say_status("encoding");
        let bar = bar(
            &sequence,
            args.openjd,
            "{spinner} {bar:32} {pos}/{len} frames encoded",
        );
        let on_frame = |frames| {
            bar.set_position(frames as u64);
            true
        };
        let result = threads.run(|| video.make(&sequence, path, on_frame));
        bar.finish_and_clear();
        result.map_err(CliError::failed)?;
    }
    reporter.end();
    if let Some((path, video)) = video {
        let frames = counted(video.frames_of(&sequence), "frame");
        say(&format!("{}: a video of {frames}", path.display()));
    }
    say(&format!(
        "{}: {} written, {} already there, {seconds:.1} s, {:.1} frames/s",
        args.output.display(),
        counted(done.written, "frame"),
        done.kept,
        done.written as f64 / seconds
    ));
    Ok(())
}

fn report_missing(sequence: &Sequence) -> Result<(), CliError> {
    let missing = sequence.missing()?;
    let total = sequence.frames.count();
    let count = counted(missing.count(), "frame");
    let colon = if missing.count() > 0 { ": " } else { "" };
    say(&format!("{count} of {total} to make{colon}{missing}"));
    Ok(())
}

fn export(
    sequence: Sequence,
    threads: &Threads,
    reporter: &mut ProgressReporter,
) -> Result<Exported, CliError> {
    let hint =
        "; finished frames are kept: once this is fixed, the same command resumes the export";
    let failed = |error: ExportError| CliError::failed(format!("{error}{hint}"));
    let mut exporting = Exporting::new(sequence)?.side_by_side();
    let control = RenderControl::default();
    threads.run(|| {
        loop {
            match exporting.step(&control) {
                ExportStep::Going => reporter.report(exporting.done()),
                ExportStep::Done | ExportStep::Stopped => break,
                ExportStep::Failed(error) => return Err(failed(error)),
            }
        }
        let done = exporting.finish().map_err(failed)?;
        reporter.report(done);
        Ok(done)
    })
}

/// A bar with one step per frame of a sequence; hidden if a job runner reads the output.
fn bar(sequence: &Sequence, is_openjd: bool, style: &str) -> ProgressBar {
    if is_openjd {
        return ProgressBar::hidden();
    }
    let bar = progress_bar(sequence.frames.count() as u64, style);
    // The first frame may take a while.
    bar.enable_steady_tick(TICK);
    bar
}

/// Reports progress: as a bar on a terminal, or as lines for a job runner.
struct ProgressReporter {
    bar: ProgressBar,
    is_openjd: bool,
    /// What was last reported: the number of finished frames, and the line with their share.
    reported: Option<usize>,
    line: String,
}

impl ProgressReporter {
    fn new(sequence: &Sequence, is_openjd: bool) -> Self {
        // Without a time left: it is unknown before the first frame.
        let bar = bar(sequence, is_openjd, "{spinner} {bar:32} {pos}/{len} frames");
        Self {
            bar,
            is_openjd,
            reported: None,
            line: String::new(),
        }
    }

    fn report(&mut self, done: Exported) {
        let so_far = done.so_far();
        if self.reported.replace(so_far) == Some(so_far) {
            return;
        }
        if self.bar.position() == 0 && so_far > 0 {
            let style = "{spinner} {bar:32} {pos}/{len} frames  {per_sec}  {eta} left";
            restyle(&self.bar, style);
        }
        self.bar.set_position(so_far as u64);
        // 100 % is reported by `end`, when the video is done, too.
        if self.is_openjd && so_far < done.total {
            let share = so_far as f64 * 100.0 / done.total.max(1) as f64;
            let line = format!("openjd_progress: {share:.1}");
            if self.line != line {
                say(&line);
                self.line = line;
            }
        }
        self.say_status(&format!("{so_far} of {} frames", done.total));
    }

    fn say_status(&self, status: &str) {
        if self.is_openjd {
            say(&format!("openjd_status: {status}"));
        }
    }

    /// Removes the bar, to make room for another one.
    fn clear(&self) {
        self.bar.finish_and_clear();
    }

    fn end(&self) {
        self.clear();
        if self.is_openjd {
            say("openjd_progress: 100");
        }
    }
}

/// Writes the job template, and the scene beside it.
///
/// # Errors
/// [`CliError`], if the arguments do not fit the scene, or if a file cannot be written.
pub fn run_job(args: &JobArgs) -> Result<(), CliError> {
    let (file, path) = (&args.what.scene, &args.output);
    let document = read_whole_document(file)?;
    let sequence = args
        .what
        .sequence(document.scene.clone(), PathBuf::from("frames"))?;
    let job = write_job(&document, Some(file), &sequence, path);
    let job = job.map_err(|error| match error {
        JobError::IsScene { .. } | JobError::TooManyPieces(_) => CliError::usage(error),
        other => CliError::failed(other),
    })?;
    let frames = counted(sequence.frames.count(), "frame");
    say(&format!("{}: a job of {frames}", path.display()));
    if job.is_copied {
        let scene = job.scene.display();
        say(&format!(
            "{scene}: a copy of the scene, with everything it needs"
        ));
    }
    for (file, backup) in job.replaced {
        let (file, backup) = (file.display(), backup.display());
        say(&format!(
            "{file} was replaced: its old content is kept as {backup}, and whatever reads {file} gets the new one now"
        ));
    }
    Ok(())
}
