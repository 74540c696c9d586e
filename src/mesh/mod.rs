//! Reads triangle meshes from files: OBJ with MTL, STL, PLY, and the triangles of glTF and GLB.
//!
//! All formats give the same form: equal points are merged, in the order of their first use by a face; faces are
//! triangles of nonzero area without duplicates, wound clockwise seen from outside. Memory use is bounded by the size
//! of the file, not by what its header claims.

mod error;

mod limits;

mod triangles;

mod solids;

mod polygon;

mod part;

mod text;

mod mtl;

mod obj_lines;

mod obj_fault;

mod obj;

mod ply_element;

mod ply;

mod stl;

mod gltf_buffers;

mod gltf_skin;

mod gltf_scene;

use std::path::Path;

use crate::files::{Marks, file_marks, has_ending};

pub use error::MeshError;
pub use part::{MeshFile, Part, PartColors};
pub use solids::{SOLIDS, Solid, globe, icosphere};
pub use triangles::{MAX_COORDINATE, Triangles, are_closed, is_in_bounds, position_key};

/// File format of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MeshFormat {
    Obj,
    Stl,
    Ply,
    Gltf,
}

impl MeshFormat {
    fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }
}

/// Returns whether a path has the extension of a mesh file, in upper or lower case.
pub fn is_mesh_file(path: &Path) -> bool {
    MeshFormat::of_path(path).is_some()
}

/// Returns the current time and size of a mesh file, to detect changes. For a glTF file they include the `.bin` file
/// of the same name that most programs write beside it, possibly later. `None` if the system does not tell.
pub fn marks_of_mesh(path: &Path) -> Option<Marks> {
    let (time, length) = file_marks(path)?;
    let is_gltf = has_ending(path, "gltf");
    let bin_marks = is_gltf.then(|| file_marks(&path.with_extension("bin")));
    let (bin_time, bin_length) = bin_marks.flatten().unwrap_or((time, 0));
    Some((time.max(bin_time), length.saturating_add(bin_length)))
}

/// Reads the parts of a mesh file that have triangles.
///
/// # Errors
/// [`MeshError`] with the file, the place in it and what is wrong. Nothing is returned of a file with an error.
pub fn read_mesh_file(path: &Path) -> Result<MeshFile, MeshError> {
    let Some(format) = MeshFormat::of_path(path) else {
        return Err(MeshError::UnknownFormat {
            path: path.to_owned(),
        });
    };
    let mut bytes = limits::read_mesh_bytes(path)?;
    let mark_length = bytes.len() - text::without_mark(&bytes).len();
    // Only text: the header of a binary STL file may hold any bytes, also those of a byte order mark.
    if format != MeshFormat::Stl || stl::is_text(&bytes[mark_length..]) {
        bytes.drain(..mark_length);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let read = match format {
        MeshFormat::Obj => obj::read(&bytes, folder, &stem),
        MeshFormat::Stl => stl::read(bytes, &stem),
        MeshFormat::Ply => ply::read(&bytes, &stem),
        MeshFormat::Gltf => gltf_scene::read(&bytes, folder, &stem),
    };
    let mut file = read.map_err(|fault| fault.with_path(path))?;
    file.parts.retain(|part| !part.triangles.faces().is_empty());
    if file.parts.is_empty() {
        return Err(MeshError::Empty {
            path: path.to_owned(),
        });
    }
    Ok(file)
}

/// Reads a PLY file that is embedded in the program.
///
/// # Errors
/// [`MeshError`] with the place in the file and what is wrong.
pub fn read_ply(bytes: &[u8]) -> Result<Triangles, MeshError> {
    let path = Path::new("the program's own mesh");
    let file = ply::read(bytes, "").map_err(|fault| fault.with_path(path))?;
    let triangles = file.parts.into_iter().next().map(|part| part.triangles);
    Ok(triangles.unwrap_or_default())
}

/// Reads all parts of a mesh file as one mesh, in the coordinates of the file.
///
/// # Errors
/// [`MeshError`] with the file, the place in it and what is wrong.
pub fn read_triangles(path: &Path) -> Result<Triangles, MeshError> {
    let parts = read_mesh_file(path)?.parts.into_iter();
    let triangles = parts.map(|part| part.triangles).collect();
    Triangles::join(triangles).map_err(|fault| fault.with_path(path))
}

#[cfg(test)]
mod tests;
