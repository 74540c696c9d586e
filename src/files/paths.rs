//! What paths refer to.

use std::path::{Component, Path, PathBuf};
use std::{fs, io};

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

/// Follows symbolic links to the file that a path refers to, whether or not it exists yet.
pub fn resolve_links(path: &Path) -> io::Result<PathBuf> {
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
