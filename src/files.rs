//! Files that are the old one or the new one, whole: what every room writes with.

use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};
use std::time::SystemTime;

use tempfile::NamedTempFile;

/// How the names of unfinished files begin, and no others.
pub const UNFINISHED: &str = ".glint-unfinished-";

/// Writes `bytes` to `path` so that a reader finds either the old file or the new one, whole: they
/// go to a new file beside it, to the disk, and then under the name. Links are followed and the
/// permissions of an existing file kept. What killed programs have left beside it goes.
///
/// # Errors
/// Whatever the system answers; the file at `path` is then untouched.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let beside = NewFile::beside(path)?;
    remove_leftovers(&beside.folder);
    beside.as_file().write_all(bytes)?;
    beside.place_durably()
}

/// Whether a path that a file in a folder names leads to that folder, or to one within it, links followed: nothing is
/// read elsewhere, because the file may come from a stranger.
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
    let leads_there = |real: PathBuf| {
        let folder = folder.canonicalize();
        folder.is_ok_and(|folder| real.starts_with(folder))
    };
    // What is not there, nobody reads.
    is_within && folder.join(path).canonicalize().map_or(true, leads_there)
}

/// More backups of a file than anybody wants.
const MOST_BACKUPS: u32 = 1000;

/// Copies a file to `NAME.bak`, or to `NAME.bak2` and so on where that holds something else: that path.
///
/// # Errors
/// Whatever the system answers.
pub fn back_up(path: &Path) -> io::Result<PathBuf> {
    let bytes = fs::read(path)?;
    for number in 1..MOST_BACKUPS {
        let mut name = path.as_os_str().to_owned();
        name.push(".bak");
        if number > 1 {
            name.push(number.to_string());
        }
        let backup = PathBuf::from(name);
        match fs::read(&backup) {
            Ok(there) if there == bytes => return Ok(backup),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                write_atomic(&backup, &bytes)?;
                return Ok(backup);
            }
            // Another backup, or something of that name that is no file.
            Ok(_) => {}
            Err(_) if backup.exists() => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::Error::other("there are already too many backups of it"))
}

/// A new file beside the one whose place it will take: nobody else writes to it, and where it does not come to
/// that, it is removed; [`remove_leftovers`] does so where the program was killed.
#[derive(Debug)]
pub struct NewFile {
    file: NamedTempFile,
    target: PathBuf,
    folder: PathBuf,
}

impl NewFile {
    /// A new file for `path`. Links are followed, and the permissions of an existing file kept.
    ///
    /// # Errors
    /// Whatever the system answers, and where there is no folder for it, or something else of its name or a file that is
    /// only to be read.
    pub fn beside(path: &Path) -> io::Result<Self> {
        let target = behind_links(path)?;
        let existing = match fs::metadata(&target) {
            Ok(existing) => Some(existing),
            // Said of a name that is too long, before anything is made for it.
            Err(error) if error.kind() == io::ErrorKind::InvalidFilename => return Err(error),
            Err(_) => None,
        };
        if let Some(existing) = &existing {
            let refused = |why: &str| Err(io::Error::other(why));
            if !existing.is_file() {
                return refused("something with this name exists and is not a file");
            }
            // It could be replaced all the same: that asks its folder only.
            if existing.permissions().readonly() {
                return refused("the file is read-only");
            }
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

    /// Where it is until it is placed; it ends as the other file does.
    pub fn path(&self) -> &Path {
        self.file.path()
    }

    /// Where another program is to write it, which some systems allow with no file that is locked.
    pub fn lend(&self) -> &Path {
        if cfg!(windows) {
            let _ = self.as_file().unlock();
        }
        self.path()
    }

    /// The file itself.
    pub fn as_file(&self) -> &File {
        self.file.as_file()
    }

    /// Puts it in its place.
    ///
    /// # Errors
    /// Whatever the system answers; what was there is then untouched.
    pub fn place(self) -> io::Result<()> {
        let placed = self.file.persist(&self.target);
        placed.map(|_| ()).map_err(|error| error.error)
    }

    /// The same, so that it survives a power cut.
    ///
    /// # Errors
    /// As [`Self::place`].
    pub fn place_durably(self) -> io::Result<()> {
        self.as_file().sync_all()?;
        let folder = self.folder.clone();
        self.place()?;
        // Where folders cannot be synced, it is the system's business.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// Removes the files from a folder that killed programs have left there unfinished.
pub fn remove_leftovers(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_new_file = name.to_string_lossy().starts_with(UNFINISHED);
        if !is_new_file {
            continue;
        }
        // Whoever writes to it has locked it.
        if let Ok(file) = open_file(&entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Makes a folder, and those that it is in.
///
/// # Errors
/// What the system answered.
pub fn make_folder(path: &Path) -> io::Result<()> {
    let target = behind_links(path)?;
    if fs::metadata(&target).is_ok_and(|metadata| !metadata.is_dir()) {
        return Err(io::Error::other(
            "something with this name exists and is not a folder",
        ));
    }
    // No folder is made whose name is a dot.
    fs::create_dir_all(target.components().collect::<PathBuf>())
}

/// Opens a file to be read. Asked before: a pipe would wait for somebody who writes into it.
///
/// # Errors
/// What the system answered, and where something of that name is no file.
pub fn open_file(path: &Path) -> io::Result<File> {
    if !fs::metadata(path)?.is_file() {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        return Err(io::Error::other(format!("{name} is not a file")));
    }
    File::open(path)
}

/// What a file holds.
///
/// # Errors
/// See [`open_file`].
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_file(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// What an open file or pipe holds, or how much there is if that is more than `most` bytes.
///
/// # Errors
/// What the system answered; no memory for it.
pub fn read_at_most(file: File, most: u64) -> io::Result<Result<Vec<u8>, u64>> {
    let length = file.metadata()?.len();
    if length > most {
        return Ok(Err(length));
    }
    let mut bytes = Vec::new();
    let size = usize::try_from(length).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(size.saturating_add(1))?;
    // The file may grow while it is read, and a pipe has no length.
    let read = file.take(most + 1).read_to_end(&mut bytes)? as u64;
    Ok(if read > most { Err(read) } else { Ok(bytes) })
}

/// Removes files from a folder, those that were written first, until no more than `most` are left.
pub fn remove_oldest(folder: &Path, most: usize) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<(SystemTime, PathBuf)> = entries
        .filter_map(|entry| Some((time_of(&entry.path())?, entry.path())))
        .collect();
    files.sort();
    let surplus = files.len().saturating_sub(most);
    for (_, path) in &files[..surplus] {
        let _ = fs::remove_file(path);
    }
}

/// When a file was written last, where the system tells.
pub fn time_of(path: &Path) -> Option<SystemTime> {
    marks_of(path).map(|(time, _)| time)
}

/// When a file was written last, and how long it is: another one has others, mostly.
pub type Marks = (SystemTime, u64);

/// Those of a file; `None` where the system does not say.
pub fn marks_of(path: &Path) -> Option<Marks> {
    let about = fs::metadata(path).ok()?;
    Some((about.modified().ok()?, about.len()))
}

/// The path that means the same file wherever the program works next; itself where that is nowhere.
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Whether two paths are those of one file, links followed.
pub fn is_same_file(one: &Path, other: &Path) -> bool {
    let found = |path: &Path| fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    one == other || found(one) == found(other)
}

/// Whether the name of a file ends so, in capitals or not.
pub fn has_ending(path: &Path, ending: &str) -> bool {
    let own = path.extension();
    own.is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Whether the system says that there is nothing at a path: what is out of reach may be there.
pub fn is_missing(path: &Path) -> bool {
    let found = fs::metadata(path);
    found.is_err_and(|error| error.kind() == io::ErrorKind::NotFound)
}

/// A path below a folder as it is written here: on Windows it may have been written with separators that mean nothing
/// elsewhere.
pub fn with_separators(folder: &Path, path: &str) -> String {
    if path.contains('\\') && is_missing(&folder.join(path)) {
        path.replace('\\', "/")
    } else {
        path.to_owned()
    }
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

    /// Of a file as it is now; `None` if it cannot be read.
    pub fn read(path: &Path) -> Option<Self> {
        let modified = time_of(path);
        read_file(path).ok().map(|bytes| Self::of(&bytes, modified))
    }

    /// Of a file that had this hash, as [`Self::hash`] gives it: as it is now, if it holds the same still.
    pub fn of_hash(hash: &str, path: &Path) -> Option<Self> {
        let hash = blake3::Hash::from_hex(hash).ok()?;
        let now = Self::read(path).filter(|now| now.hash == hash);
        Some(now.unwrap_or(Self {
            hash,
            length: 0,
            modified: None,
        }))
    }

    /// What tells what the file held, in letters.
    pub fn hash(&self) -> String {
        self.hash.to_hex().to_string()
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
        read_file(path).is_ok_and(|bytes| blake3::hash(&bytes) != self.hash)
    }
}

/// The file that a path means, links followed, whether or not it exists yet.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    // A system follows no more than 40 links either.
    for _ in 0..40 {
        let Ok(next) = fs::read_link(&target) else {
            return Ok(target);
        };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(io::Error::other("it is a link that points back to itself"))
}

/// A new file that is locked. Until it is, another program may take it for one that was left, and remove it.
fn locked_file_in(folder: &Path, target: &Path) -> io::Result<NamedTempFile> {
    loop {
        let file = new_file_in(folder, target)?;
        // Where files cannot be locked, what a killed program leaves stays.
        let is_locked = file.as_file().lock().is_ok();
        if !is_locked || file.path().exists() {
            return Ok(file);
        }
    }
}

fn new_file_in(folder: &Path, target: &Path) -> io::Result<NamedTempFile> {
    // Encoders know the format by the ending.
    let ending = target.extension().unwrap_or_default().to_string_lossy();
    let ending = format!(".{ending}");
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED).suffix(&ending);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder).map_err(|error| {
        let error = without_path(error);
        match error.kind() {
            // Of a file that may be written to, nobody would look for the reason there.
            kind @ io::ErrorKind::PermissionDenied => io::Error::new(
                kind,
                format!("writing to its folder is not permitted: {error}"),
            ),
            _ => error,
        }
    })
}

/// Why a temporary file could not be made, without its path at the end, which nobody has asked for.
pub fn without_path(error: io::Error) -> io::Error {
    let words = error.to_string();
    match words.split_once(" at path ") {
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
