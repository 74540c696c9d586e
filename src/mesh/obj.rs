//! Wavefront OBJ, read by `tobj`.

use std::path::Path;

use glam::DVec3;
use tobj::{LoadOptions, Model};

use super::error::Fault;
use super::mtl::{Libraries, colors_of};
use super::obj_fault::find_fault;
use super::obj_lines::ObjLines;
use super::part::Part;
use super::triangles::Triangles;

/// Only positions matter: the corners of a face need no texture coordinates or normals.
const OPTIONS: LoadOptions = LoadOptions {
    single_index: false,
    triangulate: true,
    ignore_points: true,
    ignore_lines: true,
};

/// What `tobj` calls faces before the first group.
const UNNAMED: &str = "unnamed_object";

/// Reads the groups and objects of an OBJ file.
pub(super) fn read(bytes: &[u8], folder: &Path, stem: &str) -> Result<Vec<Part>, Fault> {
    // Names may be in any encoding; everything else is ASCII.
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut lines = ObjLines::new(text);
    let libraries = Libraries::new(folder);
    let loaded = tobj::load_obj_buf(&mut lines, &OPTIONS, |name| libraries.load(name));
    let (models, materials) = match (lines.fault, loaded) {
        (Some(fault), _) => return Err(fault),
        (None, Ok(loaded)) => loaded,
        (None, Err(error)) => return Err(find_fault(text, &error.to_string())),
    };
    let materials = materials.unwrap_or_default();
    models
        .into_iter()
        .map(|model| {
            let material = model.mesh.material_id.and_then(|id| materials.get(id));
            let colors = material.and_then(colors_of);
            let triangles = triangles_of(&model)
                .map_err(|_| find_fault(text, "a point is not where numbers can be"))?;
            let name = match model.name.as_str() {
                "" | UNNAMED => stem.to_owned(),
                _ => model.name,
            };
            Ok(Part {
                name,
                colors,
                triangles,
            })
        })
        .collect()
}

fn triangles_of(model: &Model) -> Result<Triangles, Fault> {
    let (points, _) = model.mesh.positions.as_chunks::<3>();
    let (faces, _) = model.mesh.indices.as_chunks::<3>();
    Triangles::weld(
        points.len(),
        |index| DVec3::from_array(points[index]),
        faces.iter().copied(),
    )
}
