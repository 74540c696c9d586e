//! Triangle meshes out of files: OBJ with MTL, STL, PLY, and the triangles of glTF and GLB.
//!
//! Every format comes out the same: points that are equal are one, in the order in which faces
//! need them; faces are triangles with an area, each once, clockwise seen from outside. Memory is
//! bounded by what a file holds, not by what its header claims.

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

use crate::files::{Marks, has_ending, marks_of};

pub use error::MeshError;
pub use part::{MeshFile, Part, PartColors};
pub use solids::{SOLIDS, Solid, icosphere};
pub use triangles::{FARTHEST, Triangles, are_closed, place_key};

/// What a mesh is written in.
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

/// Whether the ending of a file's name, in any case, is one of a mesh file.
pub fn is_mesh_file(path: &Path) -> bool {
    MeshFormat::of_path(path).is_some()
}

/// What marks a mesh file now; of a glTF file, together with the file of the same name with its numbers, which most
/// programs write beside it, and may write later. `None` where the system does not say.
pub fn marks_of_mesh(path: &Path) -> Option<Marks> {
    let (time, length) = marks_of(path)?;
    let is_gltf = has_ending(path, "gltf");
    let numbers = is_gltf.then(|| marks_of(&path.with_extension("bin")));
    let (later, more) = numbers.flatten().unwrap_or((time, 0));
    Some((time.max(later), length.saturating_add(more)))
}

/// Reads the parts of a mesh file that have triangles.
///
/// # Errors
/// [`MeshError`]: which file, where in it, and what is wrong. Nothing is half-read.
pub fn read_mesh_file(path: &Path) -> Result<MeshFile, MeshError> {
    let Some(format) = MeshFormat::of_path(path) else {
        return Err(MeshError::UnknownFormat {
            path: path.to_owned(),
        });
    };
    let mut bytes = limits::read_mesh_bytes(path)?;
    let marked = bytes.len() - text::without_mark(&bytes).len();
    // The header of a binary STL file is anything.
    if format != MeshFormat::Stl || stl::is_text(&bytes[marked..]) {
        bytes.drain(..marked);
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let read = match format {
        MeshFormat::Obj => obj::read(&bytes, folder, &stem),
        MeshFormat::Stl => stl::read(bytes, &stem),
        MeshFormat::Ply => ply::read(&bytes, &stem),
        MeshFormat::Gltf => gltf_scene::read(&bytes, folder, &stem),
    };
    let mut file = read.map_err(|fault| fault.of(path))?;
    file.parts.retain(|part| !part.triangles.faces().is_empty());
    if file.parts.is_empty() {
        return Err(MeshError::Empty {
            path: path.to_owned(),
        });
    }
    Ok(file)
}

/// Reads a PLY file that is part of the program.
///
/// # Errors
/// [`MeshError`]: where in it what is wrong.
pub fn read_ply(bytes: &[u8]) -> Result<Triangles, MeshError> {
    let path = Path::new("the program's own mesh");
    let file = ply::read(bytes, "").map_err(|fault| fault.of(path))?;
    let triangles = file.parts.into_iter().next().map(|part| part.triangles);
    Ok(triangles.unwrap_or_default())
}

/// Reads all parts of a mesh file as one mesh, in the coordinates of the file.
///
/// # Errors
/// [`MeshError`]: which file, where in it, and what is wrong.
pub fn read_triangles(path: &Path) -> Result<Triangles, MeshError> {
    let mut file = read_mesh_file(path)?;
    match file.parts.as_mut_slice() {
        [only] => Ok(std::mem::take(&mut only.triangles)),
        several => Triangles::join(several.iter().map(|part| &part.triangles))
            .map_err(|fault| fault.of(path)),
    }
}

#[cfg(test)]
mod tests;
