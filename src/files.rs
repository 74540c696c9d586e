//! Atomic writing of files, and other file operations that all modules share.

use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf, is_separator};
use std::time::SystemTime;

use tempfile::NamedTempFile;

/// Prefix of the names of unfinished files, and of no others.
pub const UNFINISHED: &str = ".glint-unfinished-";

/// Writes `bytes` to `path` so that readers find either the whole old file or the whole new one: through a temporary
/// file in the same folder, which is flushed to disk and renamed. Symbolic links are followed, and the permissions of
/// an existing file are kept. Also removes what killed processes have left in the folder.
///
/// # Errors
/// Any error of the system; the file at `path` is then unchanged.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let new_file = NewFile::beside(path)?;
    remove_leftovers(&new_file.folder);
    new_file.as_file().write_all(bytes)?;
    new_file.place_durably()
}

/// Returns whether a path that a file in `folder` names stays within that folder, with symbolic links followed.
/// Nothing else is read, because the file may come from a stranger.
pub fn stays_inside(folder: &Path, path: &Path) -> bool {
    let mut depth = 0;
    let is_within = path.components().all(|part| {
        depth += match part {
            Component::Normal(_) => 1,
            Component::CurDir => 0,
            Component::ParentDir => -1,
            Component::RootDir | Component::Prefix(_) => return false,
        };
        0 <= depth
    });
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let leads_inside = |real: PathBuf| {
        let folder = folder.canonicalize();
        folder.is_ok_and(|folder| real.starts_with(folder))
    };
    // A path that does not exist is harmless.
    is_within && folder.join(path).canonicalize().map_or(true, leads_inside)
}

/// Most backups of one file.
const MAX_BACKUPS: u32 = 1000;

/// Copies a file to `NAME.bak`, or to `NAME.bak2` and so on if that has other contents; returns the path.
///
/// # Errors
/// Any error of the system.
pub fn back_up(path: &Path) -> io::Result<PathBuf> {
    let bytes = fs::read(path)?;
    for number in 1..MAX_BACKUPS {
        let mut name = path.as_os_str().to_owned();
        name.push(".bak");
        if number > 1 {
            name.push(number.to_string());
        }
        let backup = PathBuf::from(name);
        match fs::read(&backup) {
            Ok(existing) if existing == bytes => return Ok(backup),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                write_atomic(&backup, &bytes)?;
                return Ok(backup);
            }
            // Another backup, or something of that name that is not a file.
            Ok(_) => {}
            Err(_) if backup.exists() => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("there are already too many backups of it"))
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

/// Makes a path absolute, so that it stays valid when the working directory changes; unchanged if that fails.
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Returns whether two paths refer to the same file, with symbolic links followed.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let found = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    one == other || found(one) == found(other)
}

/// Returns whether a file name has this extension, in upper or lower case.
pub fn has_ending(path: &Path, ending: &str) -> bool {
    let extension = path.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case(ending))
}

/// Returns whether the system says that nothing exists at a path. A path that cannot be accessed may exist.
pub fn is_missing(path: &Path) -> bool {
    let found = fs::metadata(path);
    found.is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
}

/// Rewrites a path in `folder` with the separators of this system: one that was written on Windows may have
/// backslashes.
pub fn with_separators(folder: &Path, path: &str) -> String {
    if path.contains('\\') && is_missing(&folder.join(path)) {
        path.replace('\\', "/")
    } else {
        path.to_owned()
    }
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

/// Follows symbolic links to the file that a path refers to, whether or not it exists yet.
fn resolve_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    // Systems follow no more than 40 links either.
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&target) else {
            return Ok(target);
        };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("it is a link that points back to itself"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn links_that_lead_out_of_a_folder_do_not_stay_inside() {
        let place = tempfile::tempdir().expect("a folder");
        let (inside, outside) = (place.path().join("scene"), place.path().join("secret.ply"));
        fs::create_dir(&inside).expect("made");
        for file in [&outside, &inside.join("own.ply")] {
            fs::write(file, "ply").expect("written");
        }
        for (name, leads_to) in [("out.ply", &outside), ("in.ply", &inside.join("own.ply"))] {
            std::os::unix::fs::symlink(leads_to, inside.join(name)).expect("linked");
        }
        std::os::unix::fs::symlink(place.path(), inside.join("up")).expect("linked");
        let stays = |path: &str| stays_inside(&inside, Path::new(path));
        assert!(stays("own.ply") && stays("./own.ply") && stays("in.ply") && stays("gone.ply"));
        assert!(stays("new/../own.ply") && !stays("new/../../scene/own.ply"));
        assert!(!stays("out.ply") && !stays("up/secret.ply") && !stays("../secret.ply"));
        assert!(!stays(&outside.display().to_string()));
    }
}
