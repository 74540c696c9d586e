//! Limits on what is read, so that no file, broken or hostile, can exhaust the memory.

use std::io;
use std::path::Path;

use super::error::{Fault, MeshError};
use crate::files::{open_file, read_at_most};

/// Largest file that is read, in bytes.
const MAX_BYTES: u64 = 2 << 30;
/// Most triangles per file.
const MAX_FACES: usize = 16_000_000;
/// Most points per file: no file needs more than three per face.
const MAX_POINTS: usize = 3 * MAX_FACES;
/// Most groups per file; each is a part with its own name.
const MAX_GROUPS: usize = 1_000_000;

/// Fails if there are more faces than the limit.
pub(super) fn check_faces(count: usize) -> Result<(), Fault> {
    check("faces", count, MAX_FACES)
}

/// Fails if there are more points than the limit.
pub(super) fn check_points(count: usize) -> Result<(), Fault> {
    check("points", count, MAX_POINTS)
}

/// Fails if there are more groups than the limit.
pub(super) fn check_groups(count: usize) -> Result<(), Fault> {
    check("groups", count, MAX_GROUPS)
}

/// Fails if there are more of `what`, in the plural, than the limit.
pub(super) fn check(what: &'static str, count: usize, limit: usize) -> Result<(), Fault> {
    if count > limit {
        return Err(Fault::TooMany { what, limit });
    }
    Ok(())
}

/// Reads a mesh file whole.
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

/// Reads a file that a mesh file refers to.
pub(super) fn read_companion(path: &Path) -> io::Result<Vec<u8>> {
    read_bounded(path, MAX_BYTES)?.ok_or_else(|| io::ErrorKind::FileTooLarge.into())
}

/// Reads a file whole; `None` if it has more than `limit` bytes.
pub(super) fn read_bounded(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    Ok(read_at_most(open_file(path)?, limit)?.ok())
}
