//! Videos made by ffmpeg.

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::error::{VideoError, last_lines};
use super::frame_file::{as_ppm, frame_bytes};
use super::program::wait_for_exit;
use super::sequence::Sequence;
use crate::files::absolute;
use crate::image::Format;
use crate::words::for_shell;

/// Maximum number of frames that a command line names one by one.
const MAX_NAMED_FILES: usize = 8;

/// Has ffmpeg make a video in the file `unfinished`, which is to be moved to `path`, with these arguments for the
/// codec.
///
/// # Errors
/// [`VideoError`].
pub fn make_with_ffmpeg(
    sequence: &Sequence,
    (unfinished, path): (&Path, &Path),
    codec: &str,
    mut go_on: impl FnMut(usize) -> bool,
) -> Result<(), VideoError> {
    let mut ffmpeg = match start(sequence, unfinished, codec) {
        Ok(ffmpeg) => ffmpeg,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let how = advice_without_ffmpeg(sequence, path, codec);
            return Err(VideoError::NoFfmpeg { how });
        }
        Err(error) => {
            let output = format!("it cannot be started: {error}");
            return Err(VideoError::Ffmpeg { output });
        }
    };
    // Its output is read while it is fed: it would block on a full pipe.
    let stderr = ffmpeg.stderr.take();
    let listener = thread::spawn(move || {
        let mut output = Vec::new();
        // On an error, what was read so far is kept.
        let _ = stderr.map(|mut stderr| stderr.read_to_end(&mut output));
        output
    });
    // Frames are fed by a thread of their own: a write to an ffmpeg that takes no more would block, and could not be
    // cancelled.
    let fed = Arc::new(AtomicUsize::new(0));
    let feeder = thread::spawn({
        let (sequence, pipe) = (sequence.clone(), ffmpeg.stdin.take());
        let fed = Arc::clone(&fed);
        move || feed(&sequence, pipe, &fed)
    });
    let is_wanted = || go_on(fed.load(Ordering::Relaxed));
    let exit =
        wait_for_exit(&mut ffmpeg, is_wanted).map_err(|error| VideoError::disk(path, error))?;
    let status = exit.ok_or(VideoError::Stopped)?;
    let output = listener.join().unwrap_or_default();
    let took_all_frames = feeder.join().unwrap_or(Ok(false))?;
    let is_written = || fs::metadata(unfinished).is_ok_and(|file| file.len() > 0);
    let why = if status.code().is_none() {
        format!("it was killed ({status})\n")
    } else if !status.success() {
        String::new()
    } else if !took_all_frames {
        "it ended before it had received all frames\n".to_owned()
    } else if !is_written() {
        "it wrote nothing\n".to_owned()
    } else {
        return Ok(());
    };
    let output = format!("{why}{}", last_lines(&output));
    Err(VideoError::Ffmpeg { output })
}

fn start(sequence: &Sequence, unfinished: &Path, codec: &str) -> io::Result<Child> {
    let fps = sequence.frames_per_second().to_string();
    let frames = match sequence.format {
        Format::Png => "png",
        Format::Ppm | Format::Exr => "ppm",
    };
    // Without `-xerror`, ffmpeg reports a full disk but exits successfully.
    let common_args = ["-hide_banner", "-loglevel", "error", "-xerror", "-y"];
    Command::new("ffmpeg")
        .args(common_args)
        .args(["-f", "image2pipe", "-c:v", frames, "-framerate", &fps])
        .args(["-i", "-"])
        .args(codec.split(' '))
        .arg(unfinished)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
}

/// Feeds it the frames. Returns whether it took all of them: it closes the pipe when it fails.
fn feed(
    sequence: &Sequence,
    pipe: Option<ChildStdin>,
    fed: &AtomicUsize,
) -> Result<bool, VideoError> {
    let Some(mut pipe) = pipe else {
        return Ok(false);
    };
    for (index, frame) in sequence.frames.iter().enumerate() {
        let bytes = match sequence.format {
            // In a pipe, the end of an EXR frame cannot be found.
            Format::Exr => as_ppm(sequence, frame)?,
            Format::Png | Format::Ppm => frame_bytes(sequence, frame)?,
        };
        if pipe.write_all(&bytes).is_err() {
            return Ok(false);
        }
        fed.store(index + 1, Ordering::Relaxed);
    }
    Ok(true)
}

/// Tells how to make the video once ffmpeg is installed: by a command line if one suffices.
fn advice_without_ffmpeg(sequence: &Sequence, path: &Path, codec: &str) -> String {
    match command(sequence, path, codec) {
        Some(command) => format!("this command makes the video from them:\n{command}"),
        None => "exporting again makes the video from them once ffmpeg is installed".to_owned(),
    }
}

/// The command line that makes the video by hand; `None` if there is none.
fn command(sequence: &Sequence, path: &Path, codec: &str) -> Option<String> {
    if sequence.format == Format::Exr {
        // In a pipe, the end of an EXR frame cannot be found, and ffmpeg converts light to other 8-bit levels than
        // Glint.
        return None;
    }
    // Paths are absolute: ffmpeg gives a meaning to what a name may begin with or contain.
    let fps = sequence.frames_per_second();
    let codec: Vec<String> = codec.split(' ').map(for_shell).collect();
    let output = for_shell(&absolute(path).display().to_string());
    let codec = codec.join(" ");
    let first = sequence.frames.iter().next().unwrap_or(1);
    let count = sequence.frames.count();
    let consecutive = first..first + count as u64;
    if sequence.frames.iter().eq(consecutive) {
        // ffmpeg takes the whole path for a pattern, so each `%` in the folder is escaped.
        let folder = absolute(&sequence.folder).display().to_string();
        let folder = folder.replace('%', "%%");
        let names = format!("{}.{}", sequence.pattern.text(), sequence.format.ending());
        let input = for_shell(&Path::new(&folder).join(names).display().to_string());
        return Some(format!(
            "ffmpeg -framerate {fps} -start_number {first} -i {input} -frames:v {count} {codec} {output}"
        ));
    }
    if count > MAX_NAMED_FILES {
        return None;
    }
    let files = sequence.frames.iter();
    let files =
        files.map(|frame| for_shell(&absolute(&sequence.path(frame)).display().to_string()));
    let files = files.collect::<Vec<String>>().join(" ");
    Some(format!(
        "cat {files} | ffmpeg -f image2pipe -framerate {fps} -i - {codec} {output}"
    ))
}
