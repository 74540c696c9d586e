//! Wavefront OBJ, read by `tobj`.

use std::path::Path;

use glam::DVec3;
use indexmap::IndexMap;
use tobj::{LoadOptions, Model};

use super::error::Fault;
use super::mtl::{Libraries, colors_of};
use super::obj_fault::find_fault;
use super::obj_lines::ObjLines;
use super::part::{MeshFile, NOTE_POINT_COLORS, Part};
use super::polygon::{fan, mend_fan, note_of_uncut};
use super::text::text_of;
use super::triangles::Triangles;

/// Only positions are used: the corners of a face need no texture coordinates or normals.
const OPTIONS: LoadOptions = LoadOptions {
    single_index: false,
    // A fan would be wrong for concave polygons.
    triangulate: false,
    ignore_points: true,
    ignore_lines: true,
};

/// The name that `tobj` gives to faces before the first group.
const UNNAMED: &str = "unnamed_object";

/// Reads the groups and objects of an OBJ file. Each is split into one part per material.
pub(super) fn read(bytes: &[u8], folder: &Path, stem: &str) -> Result<MeshFile, Fault> {
    // Names may be in any encoding; everything else is ASCII.
    let text = &*text_of(bytes);
    let libraries = Libraries::new(folder);
    let mut lines = ObjLines::new(text, &libraries);
    let loaded = tobj::load_obj_buf(&mut lines, &OPTIONS, |name| libraries.load(name));
    let (models, materials) = match (lines.fault, loaded) {
        (Some(fault), _) => return Err(fault),
        (None, Ok(loaded)) => loaded,
        (None, Err(error)) => return Err(find_fault(text, &error.to_string())),
    };
    let materials = materials.unwrap_or_default();
    let mut pieces: IndexMap<_, Vec<Model>> = IndexMap::new();
    let mut polygons = 0;
    // Faces without corners make models without any.
    for model in models.into_iter().filter(|model| 0 < polygons_of(model)) {
        let group = lines
            .group_starts
            .partition_point(|&start| start <= polygons);
        polygons += polygons_of(&model);
        let same_part = pieces.entry((group, model.mesh.material_id)).or_default();
        same_part.push(model);
    }
    let mut uncut = 0;
    let parts = pieces.into_iter().map(|((_, material), models)| {
        let name = match models[0].name.as_str() {
            "" | UNNAMED => stem.to_owned(),
            name => name.to_owned(),
        };
        let material = material.and_then(|id| materials.get(id));
        let triangles = models.iter().map(|model| triangles_of(model, &mut uncut));
        let triangles = triangles
            .collect::<Result<Vec<_>, _>>()
            .and_then(Triangles::join)
            .map_err(|_| find_fault(text, "a point has a coordinate that is out of range"))?;
        Ok(Part {
            name,
            colors: material.and_then(colors_of),
            triangles,
        })
    });
    let parts = parts.collect::<Result<Vec<_>, Fault>>()?;
    let has_lost_colors = lines.has_colors && parts.iter().any(|part| part.colors.is_none());
    let colors = has_lost_colors.then(|| NOTE_POINT_COLORS.to_owned());
    let omission_notes = libraries.omission_notes();
    let notes = libraries
        .note()
        .into_iter()
        .chain(omission_notes)
        .chain(colors);
    let notes = notes.chain(note_of_uncut(uncut)).collect();
    Ok(MeshFile { parts, notes })
}

fn polygons_of(model: &Model) -> usize {
    match model.mesh.face_arities.len() {
        // `tobj` leaves the arities empty if all faces are triangles.
        0 => model.mesh.indices.len() / 3,
        // Faces of fewer than three corners are points and lines.
        _ => model
            .mesh
            .face_arities
            .iter()
            .filter(|&&corners| corners > 2)
            .count(),
    }
}

/// Returns the triangles of a model, and adds to `uncut` the number of faces that may cover their notches.
fn triangles_of(model: &Model, uncut: &mut usize) -> Result<Triangles, Fault> {
    let (points, _) = model.mesh.positions.as_chunks::<3>();
    let point = |index: usize| DVec3::from_array(points[index]);
    // `tobj` leaves the arities empty if all faces are triangles.
    if model.mesh.face_arities.is_empty() {
        let (faces, _) = model.mesh.indices.as_chunks::<3>();
        return Triangles::weld(points.len(), point, faces.iter().copied());
    }
    let mut faces = Vec::new();
    let mut corners = &model.mesh.indices[..];
    for &count in &model.mesh.face_arities {
        let (polygon, rest) = corners.split_at(count as usize);
        corners = rest;
        let start = faces.len();
        faces.extend(fan(polygon));
        let is_uncut = mend_fan(&mut faces[start..], |corner| point(corner as usize));
        *uncut += usize::from(is_uncut);
    }
    Triangles::weld(points.len(), point, faces.into_iter())
}
