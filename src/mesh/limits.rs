//! How much is read, so that no file, broken or hostile, can fill the memory.

use std::io;
use std::path::Path;

use super::error::{Fault, MeshError};
use crate::files::{open_file, read_at_most};

/// Longest file that is read, in bytes.
const MAX_BYTES: u64 = 2 << 30;
/// Most triangles of a file.
const MAX_FACES: usize = 16_000_000;
/// Most points of a file: more than three a face are of no use.
const MAX_POINTS: usize = 3 * MAX_FACES;
/// Most groups of a file, each of which is a part with a name of its own.
const MAX_GROUPS: usize = 1_000_000;

/// Refuses more faces than are read.
pub(super) fn check_faces(count: usize) -> Result<(), Fault> {
    check("faces", count, MAX_FACES)
}

/// Refuses more points than are read.
pub(super) fn check_points(count: usize) -> Result<(), Fault> {
    check("points", count, MAX_POINTS)
}

/// Refuses more groups than are read.
pub(super) fn check_groups(count: usize) -> Result<(), Fault> {
    check("groups", count, MAX_GROUPS)
}

fn check(what: &'static str, count: usize, limit: usize) -> Result<(), Fault> {
    if count > limit {
        return Err(Fault::TooMany { what, limit });
    }
    Ok(())
}

/// The bytes of a mesh file.
pub(super) fn read_mesh_bytes(path: &Path) -> Result<Vec<u8>, MeshError> {
    let bytes = read_bounded(path, MAX_BYTES).map_err(|source| MeshError::Disk {
        path: path.to_owned(),
        source,
    })?;
    bytes.ok_or_else(|| MeshError::TooLarge {
        path: path.to_owned(),
        limit: MAX_BYTES,
    })
}

/// The bytes of a file beside a mesh file.
pub(super) fn read_companion(path: &Path) -> io::Result<Vec<u8>> {
    read_bounded(path, MAX_BYTES)?.ok_or_else(|| io::ErrorKind::FileTooLarge.into())
}

/// The bytes of a file, or nothing if there are more than `limit`.
pub(super) fn read_bounded(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    Ok(read_at_most(open_file(path)?, limit)?.ok())
}
