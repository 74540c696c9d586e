//! The manifest of a folder of frames: a text file with a line for each frame that was written.

use std::collections::HashMap;
use std::fmt::Write as _;
use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::files::{open_file, read_file};
use crate::words::milliseconds;

/// The file's name.
pub const MANIFEST: &str = "glint-frames.txt";
/// Its first line.
const HEADER: &str =
    "# Frames by Glint: file, hash of its bytes, fingerprint of what it shows, milliseconds";

/// Hash of a file or of a scene; 64 hexadecimal digits in the manifest.
pub type Hash = blake3::Hash;

/// The entry for a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Entry {
    content: Hash,
    fingerprint: Hash,
}

/// The manifest of a folder. The last line about a file counts; truncated lines are ignored.
#[derive(Debug)]
pub struct Manifest {
    folder: PathBuf,
    entries: HashMap<String, Entry>,
}

impl Manifest {
    /// Reads the manifest of a folder; without one, there are no entries.
    ///
    /// # Errors
    /// Any error of the system but that the file does not exist.
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
        let entries = text.split_inclusive('\n').filter_map(parse_entry);
        Ok(Self {
            folder: folder.to_owned(),
            entries: entries.collect(),
        })
    }

    /// Whether there is an entry for the file, and a file of that name exists.
    pub fn has_file(&self, file: &str) -> bool {
        self.entries.contains_key(file) && self.folder.join(file).exists()
    }

    /// Whether a file has been written since, according to a newer manifest.
    pub fn is_rewritten(&self, newer: &Self, file: &str) -> bool {
        self.entries.get(file) != newer.entries.get(file)
    }

    /// Whether there is an entry for the file with another fingerprint.
    pub fn has_other_fingerprint(&self, file: &str, fingerprint: &Hash) -> bool {
        let entry = self.entries.get(file);
        entry.is_some_and(|entry| entry.fingerprint != *fingerprint)
    }

    /// Whether the file exists, is unchanged since it was written, and has this fingerprint.
    pub fn is_valid(&self, file: &str, fingerprint: &Hash) -> bool {
        let Some(entry) = self.entries.get(file) else {
            return false;
        };
        let is_same = entry.fingerprint == *fingerprint;
        let content = || open_file(&self.folder.join(file)).and_then(|file| hash_file(&file));
        is_same && content().is_ok_and(|found| found == entry.content)
    }
}

fn parse_entry(line: &str) -> Option<(String, Entry)> {
    let line = line.strip_suffix('\n')?;
    let mut cells = line.split('\t');
    let (file, content, fingerprint) = (cells.next()?, cells.next()?, cells.next()?);
    let entry = Entry {
        content: Hash::from_hex(content).ok()?,
        fingerprint: Hash::from_hex(fingerprint).ok()?,
    };
    // The time is not used, but a line without it was truncated.
    cells.next().map(|_| (file.to_owned(), entry))
}

/// Returns the hash of a file from its current position on.
///
/// # Errors
/// Any error of the system.
pub fn hash_file(file: &File) -> io::Result<Hash> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file)?;
    Ok(hasher.finalize())
}

/// Appends a line about a file with this hash. Lines are appended in one write, so that several programs may write
/// frames into one folder.
///
/// # Errors
/// Any error of the system.
pub fn append_entry(
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
        milliseconds(time)
    );
    manifest.write_all(line.as_bytes())
}

/// Opens the manifest for appending; returns it with what to write before the next line: the missing line break of a
/// truncated line, which would spoil the next one. Of programs that write at the same time, the one that creates the
/// file writes its head.
fn open(path: &Path) -> io::Result<(File, String)> {
    let mut options = OpenOptions::new();
    options.append(true).read(true);
    match options.clone().create_new(true).open(path) {
        Ok(mut file) => {
            file.write_all(format!("{HEADER}\n").as_bytes())?;
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
