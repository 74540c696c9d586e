//! Atomic writing of files.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf, is_separator};
use std::time::SystemTime;

use tempfile::NamedTempFile;

use super::paths::resolve_links;
use super::reading::{open_file, time_of};

/// Prefix of the names of unfinished files, and of no others.
pub const UNFINISHED: &str = ".glint-unfinished-";

/// Writes `bytes` to `path` so that readers find either the whole old file or the whole new one: through a temporary
/// file in the same folder, which is flushed to disk and renamed. Symbolic links are followed, and the permissions of
/// an existing file are kept. Also removes what killed processes have left in the folder.
///
/// # Errors
/// Any error of the system; the file at `path` is then unchanged.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    write_beside(path, bytes)?.place_durably()
}

/// Writes `bytes` to a temporary file for `path`, and removes what killed processes have left in the folder.
///
/// # Errors
/// Any error of the system.
pub fn write_beside(path: &Path, bytes: &[u8]) -> io::Result<NewFile> {
    let new_file = NewFile::beside(path)?;
    remove_leftovers(&new_file.folder);
    new_file.as_file().write_all(bytes)?;
    Ok(new_file)
}

/// A temporary file beside the file that it will replace. No other process writes to it. Dropping it removes it;
/// [`remove_leftovers`] removes it if the process was killed.
#[derive(Debug)]
pub struct NewFile {
    file: NamedTempFile,
    target: PathBuf,
    folder: PathBuf,
}

impl NewFile {
    /// Creates a temporary file for `path`. Symbolic links are followed, and the permissions of an existing file are
    /// kept.
    ///
    /// # Errors
    /// Any error of the system; also if the folder does not exist, if `path` is not a file, or if it is read-only.
    pub fn beside(path: &Path) -> io::Result<Self> {
        let target = resolve_links(path)?;
        let existing = match fs::metadata(&target) {
            Ok(existing) => Some(existing),
            // An invalid name, such as one that is too long, is reported before anything is created for it.
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => return Err(error),
            Err(_) => None,
        };
        if let Some(existing) = &existing {
            let refused = |why: &str| Err(io::Error::other(why));
            if !existing.is_file() {
                return refused("something with this name exists and is not a file");
            }
            // Renaming over a file that may not be written would work: that needs permission for its folder only.
            if existing.permissions().readonly() {
                return refused("the file is read-only");
            }
            fs::OpenOptions::new().append(true).open(&target)?;
        } else if path.to_string_lossy().ends_with(is_separator) {
            return Err(io::Error::other("this is the name of a folder"));
        }
        let folder = match target.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        }
        .to_owned();
        if !folder.is_dir() {
            let sentence = format!("the folder {} does not exist", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, sentence));
        }
        let file = locked_file_in(&folder, &target)?;
        if let Some(existing) = existing {
            file.as_file().set_permissions(existing.permissions())?;
        }
        Ok(Self {
            file,
            target,
            folder,
        })
    }

    /// Path of the temporary file. It has the extension of the target.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// The path, for another program to write to. On Windows this unlocks the file, because others cannot write to
    /// it.
    pub fn lend(&self) -> &Path {
        if cfg!(windows) {
            let _ = self.as_file().unlock();
        }
        self.path()
    }

    /// The open file.
    pub fn as_file(&self) -> &File {
        self.file.as_file()
    }

    /// Renames it to its target.
    ///
    /// # Errors
    /// Any error of the system; the target is then unchanged.
    pub fn place(self) -> io::Result<()> {
        let placed = self.file.persist(&self.target);
        placed.map(|_| ()).map_err(|error| error.error)
    }

    /// Renames it to its target, so that the file survives a power failure.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn place_durably(self) -> io::Result<()> {
        self.as_file().sync_all()?;
        let folder = self.folder.clone();
        self.place()?;
        // If the system cannot sync folders, there is no more to be done.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// Removes unfinished files that killed processes have left in a folder.
pub fn remove_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        // A process that still writes to the file holds its lock. On some network shares, only a shared lock can be had
        // of a file that is open for reading.
        if name.to_string_lossy().starts_with(UNFINISHED)
            && let Ok(file) = open_file(&entry.path())
            && file.try_lock_shared().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Creates a temporary file and locks it. Until it is locked, another process may take it for a leftover and remove
/// it.
fn locked_file_in(folder: &Path, target: &Path) -> io::Result<NamedTempFile> {
    loop {
        let file = new_file_in(folder, target)?;
        // If files cannot be locked, leftovers of killed processes stay.
        let is_locked = file.as_file().lock().is_ok();
        if !is_locked || file.path().exists() {
            return Ok(file);
        }
    }
}

fn new_file_in(folder: &Path, target: &Path) -> io::Result<NamedTempFile> {
    // Encoders derive the format from the extension.
    let ending = target.extension().unwrap_or_default().to_string_lossy();
    let ending = format!(".{ending}");
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED).suffix(&ending);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let created = builder.tempfile_in(folder).map_err(without_path);
    created.map_err(|error| match error.kind() {
        // The existing file may be writable, so the message says that the folder is the reason.
        kind @ io::ErrorKind::PermissionDenied => {
            let why = format!("writing to its folder is not permitted: {error}");
            io::Error::new(kind, why)
        }
        _ => error,
    })
}

/// Strips the path, which means nothing to users, from the end of an error about a temporary file.
pub fn without_path(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path ") {
        Some((why, _)) => io::Error::new(error.kind(), why),
        None => error,
    }
}

/// Creates a folder and its parent folders.
///
/// # Errors
/// Any error of the system.
pub fn make_folder(path: &Path) -> io::Result<()> {
    let target = resolve_links(path)?;
    if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_dir()) {
        return Err(io::Error::other(
            "something with this name exists and is not a folder",
        ));
    }
    // Without dots in the path: no folder can be created under such a name.
    fs::create_dir_all(target.components().collect::<PathBuf>())
}

/// Removes the oldest files of a folder until at most `max_files` are left.
pub fn remove_oldest(folder: &Path, max_files: usize) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<(SystemTime, PathBuf)> = entries
        .filter_map(|entry| Some((time_of(&entry.path())?, entry.path())))
        .collect();
    files.sort();
    let surplus = files.len().saturating_sub(max_files);
    for (_, path) in &files[..surplus] {
        let _ = fs::remove_file(path);
    }
}
