//! Copies of files that are about to be replaced.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::reading::read_file;
use super::writing::{NewFile, write_beside};

/// Most backups of one file.
const MAX_BACKUPS: u32 = 1000;

/// Replaces a file, see [`super::write_atomic`]. If something else is there and `is_kept` holds for it, it is kept as
/// `NAME.bak`, or as `NAME.bak2` and so on if that is there; returns the path of the backup.
///
/// # Errors
/// Any error of the system; the file at `path` is then unchanged.
pub fn replace(
    path: &Path,
    bytes: &[u8],
    is_kept: impl FnOnce(&[u8]) -> bool,
) -> io::Result<Option<PathBuf>> {
    let existing = read_file(path).ok();
    let is_lost = existing.is_some_and(|existing| existing != bytes && is_kept(&existing));
    // Written first: if there is no room for it, there is no backup either.
    let new_file = write_beside(path, bytes)?;
    let backup = is_lost.then(|| back_up(path)).transpose()?;
    new_file.place_durably()?;
    Ok(backup)
}

/// Copies a file to `NAME.bak`, or to `NAME.bak2` and so on if that has other contents, with its permissions; returns
/// the path.
fn back_up(path: &Path) -> io::Result<PathBuf> {
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
                let new_file = NewFile::beside(&backup)?;
                // Before it holds anything.
                let permissions = fs::metadata(path)?.permissions();
                new_file.as_file().set_permissions(permissions)?;
                new_file.as_file().write_all(&bytes)?;
                new_file.place_durably()?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_backup_is_no_more_readable_than_its_file() {
        use std::os::unix::fs::PermissionsExt as _;

        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("scene.ron");
        let mode = |path: &Path| fs::metadata(path).expect("there").permissions().mode() & 0o777;
        fs::write(&path, "old").expect("written");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("set");
        let backup = replace(&path, b"new", |old| old == b"old").expect("replaced");
        let backup = backup.expect("the old file is kept");
        assert_eq!((mode(&path), mode(&backup)), (0o600, 0o600));
        assert_eq!(fs::read(&backup).expect("readable"), b"old");
        assert_eq!(replace(&path, b"new", |_| true).expect("replaced"), None);
        assert_eq!(replace(&path, b"newer", |_| false).expect("replaced"), None);
        assert_eq!(fs::read(&path).expect("readable"), b"newer");
    }
}
