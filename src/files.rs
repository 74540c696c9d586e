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

/// What a file held when it was read or written last.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stamp {
    hash: blake3::Hash,
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    /// Of a file that holds these bytes.
    pub fn of(path: &Path, bytes: &[u8]) -> Self {
        let modified = fs::metadata(path).and_then(|metadata| metadata.modified());
        Self {
            hash: blake3::hash(bytes),
            length: bytes.len() as u64,
            modified: modified.ok(),
        }
    }

    /// Whether the file holds something else by now. One that is gone holds nothing that could be lost.
    pub fn is_outdated(&self, path: &Path) -> bool {
        let Ok(metadata) = fs::metadata(path) else {
            return false;
        };
        let is_touched = metadata.len() != self.length || metadata.modified().ok() != self.modified;
        is_touched && fs::read(path).is_ok_and(|bytes| blake3::hash(&bytes) != self.hash)
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
