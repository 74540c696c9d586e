//! What is known about the frames in a folder: a text file with a line for each that was written.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::files::{open_file, read_file};

/// The file's name.
pub const MANIFEST: &str = "glint-frames.txt";
/// Its first line.
const HEAD: &str =
    "# Frames by Glint: file, hash of its bytes, fingerprint of what it shows, milliseconds";

/// What tells one content from another; 64 hexadecimal digits in the file.
pub type Hash = blake3::Hash;

/// What was noted about a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Note {
    content: Hash,
    fingerprint: Hash,
}

/// The notes of a folder. The newest line about a file counts; a line that was cut off is none.
#[derive(Debug)]
pub struct Manifest {
    folder: PathBuf,
    notes: HashMap<String, Note>,
}

impl Manifest {
    /// Reads the notes of a folder; none, if there are none.
    ///
    /// # Errors
    /// Whatever the system answers, except that the file is not there.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let path = folder.join(MANIFEST);
        let text = match read_file(&path) {
            Ok(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                if path.is_symlink() {
                    return Err(io::Error::other("it is a broken link"));
                }
                String::new()
            }
            Err(error) => return Err(error),
        };
        let notes = text.split_inclusive('\n').filter_map(note);
        Ok(Self {
            folder: folder.to_owned(),
            notes: notes.collect(),
        })
    }

    /// Whether the file was written, and something of its name is there.
    pub fn is_noted(&self, file: &str) -> bool {
        self.notes.contains_key(file) && self.folder.join(file).exists()
    }

    /// Whether a file was written since, by these newer notes.
    pub fn is_other(&self, newer: &Self, file: &str) -> bool {
        self.notes.get(file) != newer.notes.get(file)
    }

    /// Whether the file was written by somebody who shows something else in it.
    pub fn shows_other(&self, file: &str, fingerprint: &Hash) -> bool {
        let note = self.notes.get(file);
        note.is_some_and(|note| note.fingerprint != *fingerprint)
    }

    /// Whether the file is there, whole, as it was written, and shows what it would show now.
    pub fn is_valid(&self, file: &str, fingerprint: &Hash) -> bool {
        let Some(note) = self.notes.get(file) else {
            return false;
        };
        let is_same = note.fingerprint == *fingerprint;
        let content = || open_file(&self.folder.join(file)).and_then(|file| content_of(&file));
        is_same && content().is_ok_and(|found| found == note.content)
    }
}

fn note(line: &str) -> Option<(String, Note)> {
    let line = line.strip_suffix('\n')?;
    let mut cells = line.split('\t');
    let (file, content, fingerprint) = (cells.next()?, cells.next()?, cells.next()?);
    let note = Note {
        content: Hash::from_hex(content).ok()?,
        fingerprint: Hash::from_hex(fingerprint).ok()?,
    };
    // The time is not read, but a line without it was cut off.
    cells.next().map(|_| (file.to_owned(), note))
}

/// The hash of a file, from where it is read next.
///
/// # Errors
/// Whatever the system answers.
pub fn content_of(file: &File) -> io::Result<Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file)?;
    Ok(hasher.finalize())
}

/// Adds a line about a file with this hash. Lines are added whole, so that several programs may write frames into
/// one folder.
///
/// # Errors
/// Whatever the system answers.
pub fn add_note(
    folder: &Path,
    file: &str,
    content: &Hash,
    fingerprint: &Hash,
    time: Duration,
) -> io::Result<()> {
    let (mut manifest, mut line) = open(&folder.join(MANIFEST))?;
    let _ = writeln!(
        line,
        "{file}\t{content}\t{fingerprint}\t{:.3}",
        time.as_secs_f64() * 1e3
    );
    manifest.write_all(line.as_bytes())
}

/// The notes, to add to, and what has to stand before the next line: the end of one that was cut off, so that it does
/// not take the next one with it. The head is written by the one of all that write at the same time who makes the
/// file.
fn open(path: &Path) -> io::Result<(File, String)> {
    let mut options = OpenOptions::new();
    options.append(true).read(true);
    match options.clone().create_new(true).open(path) {
        Ok(mut file) => {
            file.write_all(format!("{HEAD}\n").as_bytes())?;
            return Ok((file, String::new()));
        }
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
        Err(error) => return Err(error),
    }
    let mut file = options.open(path)?;
    let is_whole = last_byte(&mut file)?.is_none_or(|byte| byte == b'\n');
    let end = if is_whole { "" } else { "\n" };
    Ok((file, end.to_owned()))
}

fn last_byte(file: &mut File) -> io::Result<Option<u8>> {
    if file.seek(SeekFrom::End(0))? == 0 {
        return Ok(None);
    }
    file.seek(SeekFrom::End(-1))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    Ok(Some(last[0]))
}
