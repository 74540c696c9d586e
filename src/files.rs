//! Files that are the old one or the new one, whole: what every room writes with.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Writes `bytes` to `path` so that a reader finds either the old file or the new one, whole: they
/// go to a new file beside it, to the disk, and then under the name. Links are followed and the
/// permissions of an existing file kept.
///
/// # Errors
/// Whatever the system answers; the file at `path` is then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let target = behind_links(path);
    let existing = fs::metadata(&target).ok();
    if existing
        .as_ref()
        .is_some_and(|metadata| !metadata.is_file())
    {
        return Err(io::Error::other(
            "there is something of that name that is not a file",
        ));
    }
    let folder = match target.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        let sentence = format!("the folder {} does not exist", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, sentence));
    }
    let mut beside = new_file_builder().tempfile_in(folder)?;
    beside.write_all(bytes)?;
    if let Some(existing) = existing {
        beside.as_file().set_permissions(existing.permissions())?;
    }
    beside.as_file().sync_all()?;
    beside.persist(&target).map_err(|error| error.error)?;
    // The rename itself must survive a power cut too; where folders cannot be synced, it is the
    // system's business.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

/// Makes a folder, and those that it is in.
///
/// # Errors
/// What the system answered.
pub fn make_folder(path: &Path) -> io::Result<()> {
    fs::create_dir_all(path)
}

/// When a file was written last, where the system tells.
pub fn time_of(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).ok()?.modified().ok()
}

/// Whether two paths are those of one file, links followed.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let found = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    one == other || found(one) == found(other)
}

/// What a file held when it was read or written last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stamp {
    hash: blake3::Hash,
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    /// Of a file that holds these bytes, and was written at that time at the earliest.
    pub fn of(bytes: &[u8], modified: Option<SystemTime>) -> Self {
        Self {
            hash: blake3::hash(bytes),
            length: bytes.len() as u64,
            modified,
        }
    }

    /// Whether the file may hold something else by now, by its length and time.
    pub fn is_touched(&self, path: &Path) -> bool {
        let metadata = fs::metadata(path).ok();
        metadata.is_some_and(|metadata| {
            metadata.len() != self.length || metadata.modified().ok() != self.modified
        })
    }

    /// Whether the file holds something else by now. One that is gone holds nothing that could be lost.
    pub fn is_outdated(&self, path: &Path) -> bool {
        let is_file = fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
        is_file && fs::read(path).is_ok_and(|bytes| blake3::hash(&bytes) != self.hash)
    }
}

/// The file that a path means, links followed, whether or not it exists yet.
fn behind_links(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    // A system follows no more than 40 links either.
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&target) else {
            break;
        };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    target
}

fn new_file_builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".glint-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}
