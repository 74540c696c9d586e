//! Reading of files, and how to recognise that they have changed.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;
use std::time::SystemTime;

/// Opens a file for reading. Checks first that it is one: opening a pipe would wait for a writer.
///
/// # Errors
/// Any error of the system, and if `path` is not a file.
pub fn open_file(path: &Path) -> io::Result<File> {
    if !fs::metadata(path)?.is_file() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        return Err(io::Error::other(format!("{name} is not a file")));
    }
    File::open(path)
}

/// Reads a file whole.
///
/// # Errors
/// See [`open_file`].
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_file(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads an open file or pipe; the inner error is its length if that exceeds `limit` bytes.
///
/// # Errors
/// Any error of the system, and if there is not enough memory.
pub fn read_at_most(file: File, limit: u64) -> io::Result<Result<Vec<u8>, u64>> {
    let length = file.metadata()?.len();
    if length > limit {
        return Ok(Err(length));
    }
    let mut bytes = Vec::new();
    let size = usize::try_from(length).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(size.saturating_add(1))?;
    // The file may grow while it is read, and the length of a pipe is unknown.
    let read = file.take(limit + 1).read_to_end(&mut bytes)? as u64;
    Ok(if read > limit { Err(read) } else { Ok(bytes) })
}

/// Time of the last modification of a file, if the system tells it.
pub fn time_of(path: &Path) -> Option<SystemTime> {
    file_marks(path).map(|(time, _)| time)
}

/// Modification time and length of a file, which usually differ once it has changed.
pub type Marks = (SystemTime, u64);

/// The marks of a file; `None` if the system does not tell.
pub fn file_marks(path: &Path) -> Option<Marks> {
    let metadata = fs::metadata(path).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Identifies the contents of a file when it was last read or written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stamp {
    hash: blake3::Hash,
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    /// The stamp of a file with these contents that was written no earlier than at that time.
    pub fn of(bytes: &[u8], modified: Option<SystemTime>) -> Self {
        Self {
            hash: blake3::hash(bytes),
            length: bytes.len() as u64,
            modified,
        }
    }

    /// The stamp of a file as it is now; `None` if it cannot be read.
    pub fn read(path: &Path) -> Option<Self> {
        let modified = time_of(path);
        read_file(path).ok().map(|bytes| Self::of(&bytes, modified))
    }

    /// The stamp of a file that had this [`Self::hash`], with its time and length if its contents are the same now.
    pub fn of_hash(hash: &str, path: &Path) -> Option<Self> {
        let hash = blake3::Hash::from_hex(hash).ok()?;
        let now = Self::read(path).filter(|now| now.hash == hash);
        Some(now.unwrap_or(Self {
            hash,
            length: 0,
            modified: None,
        }))
    }

    /// The hash of the contents, in hexadecimal.
    pub fn hash(&self) -> String {
        self.hash.to_hex().to_string()
    }

    /// Returns whether the file may have changed, by its length and modification time.
    pub fn is_touched(&self, path: &Path) -> bool {
        let metadata = fs::metadata(path).ok();
        metadata.is_some_and(|metadata| {
            metadata.len() != self.length || metadata.modified().ok() != self.modified
        })
    }

    /// Returns whether the contents of the file have changed. A file that no longer exists has nothing that could be
    /// lost.
    pub fn is_outdated(&self, path: &Path) -> bool {
        read_file(path).is_ok_and(|bytes| blake3::hash(&bytes) != self.hash)
    }
}
