//! Recovery files: unsaved changes, kept on disk so that a crash or a killed process loses no edit. Each running
//! program has its own recovery file and holds a lock next to it; a file whose lock is free was left behind.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::file::Document;
use crate::files::{Stamp, is_same_file, make_folder, write_atomic};

/// Start of the first line of a recovery file, followed by the path of the document.
const PATH_MARK: &str = "// unsaved changes of: ";

/// Start of the second line, if the document's file has been read or written, followed by the hash of its contents.
const BASE_MARK: &str = "// of the file that was: ";

/// Prefix of the names of recovery files.
const FILE_PREFIX: &str = "unsaved-";

/// The recovery file of this program.
#[derive(Debug)]
pub struct Recovery {
    path: PathBuf,
    /// Held until the process ends, in whatever way.
    _lock: File,
}

/// Unsaved changes that an ended program left behind.
#[derive(Debug)]
pub struct Leftover {
    /// The scene.
    pub document: Document,
    /// The file of the document, if it had one.
    pub path: Option<PathBuf>,
    /// Contents of that file when the changes began.
    pub stamp: Option<Stamp>,
}

impl Recovery {
    /// Reserves a recovery file in `folder`, which is created if needed.
    ///
    /// # Errors
    /// Any I/O error; the program then works without recovery.
    pub fn new(folder: &Path) -> io::Result<Self> {
        make_folder(folder)?;
        let mut number = std::process::id();
        loop {
            let path = folder.join(format!("{FILE_PREFIX}{number}.ron"));
            let lock = File::create(lock_path_of(&path))?;
            match lock.try_lock() {
                // A leftover file with this number must not be overwritten.
                Ok(()) if !path.exists() => return Ok(Self { path, _lock: lock }),
                Ok(()) | Err(TryLockError::WouldBlock) => number = number.wrapping_add(1),
                Err(TryLockError::Error(error)) => return Err(error),
            }
        }
    }

    /// Writes the unsaved changes of the document at `path`, a file whose contents match `stamp`.
    ///
    /// # Errors
    /// Any I/O error; the previously kept state is then still there.
    pub fn keep(&self, text: &str, path: Option<&Path>, stamp: Option<&Stamp>) -> io::Result<()> {
        let name = path.map_or(String::new(), |path| path.display().to_string());
        // The path must be on one line.
        let name = if name.contains(['\n', '\r']) {
            serde_json::Value::from(name).to_string()
        } else {
            name
        };
        let base = stamp.map_or(String::new(), |stamp| {
            format!("{BASE_MARK}{}\n", stamp.hash())
        });
        write_atomic(
            &self.path,
            format!("{PATH_MARK}{name}\n{base}{text}").as_bytes(),
        )
    }

    /// Removes the recovery file: there are no unsaved changes (any more).
    pub fn clear(&self) {
        // A file that cannot be removed is merely offered for recovery once too often.
        let _ = fs::remove_file(&self.path);
    }

    /// Takes one recovery file that an ended program left in the folder, for the document at `wanted` or for any. It
    /// replaces this program's own recovery file.
    pub fn take_leftover(&self, wanted: Option<&Path>) -> Option<Leftover> {
        let entries = fs::read_dir(self.path.parent()?).ok()?;
        let files = entries.filter_map(|entry| Some(entry.ok()?.path()));
        // A file that was being written when its program was killed has a different name; the previous version is
        // used.
        let is_leftover = |path: &PathBuf| {
            let name = path.file_name().map(|name| name.to_string_lossy());
            name.is_some_and(|name| name.starts_with(FILE_PREFIX) && name.ends_with(".ron"))
                && *path != self.path
        };
        files
            .filter(is_leftover)
            .find_map(|path| take_over(&path, wanted, &self.path))
    }
}

impl Drop for Recovery {
    fn drop(&mut self) {
        let _ = fs::remove_file(lock_path_of(&self.path));
    }
}

/// The lock of a recovery file.
fn lock_path_of(path: &Path) -> PathBuf {
    path.with_extension("lock")
}

fn take_over(path: &Path, wanted: Option<&Path>, target: &Path) -> Option<Leftover> {
    let lock_path = lock_path_of(path);
    let lock = File::create(&lock_path).ok()?;
    lock.try_lock().ok()?;
    let leftover = take_locked(path, wanted, target);
    // Whether it was taken or not, no program uses it.
    let _ = fs::remove_file(&lock_path);
    leftover
}

fn take_locked(path: &Path, wanted: Option<&Path>, target: &Path) -> Option<Leftover> {
    let text = fs::read_to_string(path).ok()?;
    let (original, body) = text.strip_prefix(PATH_MARK)?.split_once('\n')?;
    let escaped: Option<String> = serde_json::from_str(original).ok();
    let original = escaped.as_deref().unwrap_or(original);
    if wanted.is_some_and(|wanted| !is_same_file(wanted, Path::new(original))) {
        return None;
    }
    let (base, body) = match body.strip_prefix(BASE_MARK) {
        Some(rest) => rest.split_once('\n')?,
        None => ("", body),
    };
    let stamp = Stamp::of_hash(base, Path::new(original));
    let mut document = Document::from_text(body).ok()?;
    // A file that cannot be renamed is not taken: it would be found again and again.
    fs::rename(path, target).ok()?;
    document.scene.load_meshes(Path::new(original).parent());
    Some(Leftover {
        document,
        path: (!original.is_empty()).then(|| PathBuf::from(original)),
        stamp,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::DEMO_TEXT;

    #[test]
    fn work_of_an_ended_program_is_found_and_of_a_running_one_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Recovery::new(folder.path()).expect("a place");
        first
            .keep(DEMO_TEXT, Some(Path::new("/a/b.ron")), None)
            .expect("kept");
        let second = Recovery::new(folder.path()).expect("another place");
        assert!(
            second.take_leftover(None).is_none(),
            "the first program still runs"
        );
        drop(first);
        let other = Some(Path::new("/c.ron"));
        assert!(
            second.take_leftover(other).is_none(),
            "another file was asked for"
        );
        let locks = fs::read_dir(folder.path()).expect("files").flatten();
        let locks = locks.filter(|file| file.path().extension().is_some_and(|it| it == "lock"));
        assert_eq!(locks.count(), 1, "its own");
        let leftover = second.take_leftover(None).expect("left behind");
        assert_eq!(leftover.path.as_deref(), Some(Path::new("/a/b.ron")));
        assert_eq!(leftover.document.to_text().expect("text"), DEMO_TEXT);
        assert!(second.take_leftover(None).is_none(), "it is taken once");
        drop(second);
        // The second program has ended as well, without writing the recovery file again.
        let third = Recovery::new(folder.path()).expect("a third place");
        assert!(third.take_leftover(None).is_some());
        let odd = Path::new("/a/b\nc.ron");
        third.keep(DEMO_TEXT, Some(odd), None).expect("kept");
        drop(third);
        let fourth = Recovery::new(folder.path()).expect("a fourth place");
        let leftover = fourth.take_leftover(Some(odd)).expect("left behind");
        assert_eq!(leftover.path.as_deref(), Some(odd));
    }

    #[test]
    fn work_is_found_under_any_spelling_of_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.ron");
        fs::write(&file, DEMO_TEXT).expect("written");
        fs::create_dir(folder.path().join("sub")).expect("made");
        let first = Recovery::new(folder.path()).expect("a place");
        let spelling = folder.path().join("sub/../a.ron");
        first.keep(DEMO_TEXT, Some(&spelling), None).expect("kept");
        drop(first);
        let second = Recovery::new(folder.path()).expect("a place");
        assert!(second.take_leftover(Some(&file)).is_some());
    }

    #[test]
    fn cleared_work_is_gone() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Recovery::new(folder.path()).expect("a place");
        first.keep(DEMO_TEXT, None, None).expect("kept");
        first.clear();
        drop(first);
        assert!(
            Recovery::new(folder.path())
                .expect("a place")
                .take_leftover(None)
                .is_none()
        );
    }
}
