//! STL, as text and binary, read by `mesh-loader`.

use glam::DVec3;
use mesh_loader::Scene;

use super::error::Fault;
use super::limits::{check_faces, check_points};
use super::part::MeshFile;
use super::triangles::Triangles;

/// Bytes before the first triangle of a binary file: 80 arbitrary ones, and the number of triangles.
const HEADER_BYTES: usize = 84;
/// Bytes per triangle of a binary file.
const TRIANGLE_BYTES: usize = 50;
/// First word of a text file.
const KEYWORD: &[u8] = b"solid";
/// Least number of bytes per triangle of a text file.
const MIN_TEXT_TRIANGLE: usize = 80;

/// Reads an STL file; several solids become one part.
pub(super) fn read(mut bytes: Vec<u8>, stem: &str) -> Result<MeshFile, Fault> {
    let is_text = is_text(&bytes);
    let ((name, vertices), note, loaded) = if is_text {
        (prepare_text(&mut bytes)?, None, load_text(&bytes))
    } else {
        let note = prepare_binary(&mut bytes)?;
        (
            (None, Vec::new()),
            note,
            mesh_loader::stl::from_slice(&bytes),
        )
    };
    let scene = loaded.map_err(|error| fault_of(&error, is_text))?;
    drop(bytes);
    // Each face has three points of its own.
    let solids = scene.meshes.into_iter().map(|mesh| mesh.vertices);
    let points = solids.reduce(|mut all, more| {
        all.extend(more);
        all
    });
    let points = points.unwrap_or_default();
    check_points(points.len())?;
    let has_full_precision = vertices.len() == points.len();
    let point = |index: usize| {
        if has_full_precision {
            vertices[index]
        } else {
            DVec3::from_array(points[index].map(f64::from))
        }
    };
    let faces = (0..points.len() as u32 / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]);
    let triangles = Triangles::weld(points.len(), point, faces)?;
    let name = name.unwrap_or_else(|| stem.to_owned());
    let mut file = MeshFile::of_one(name, triangles);
    file.notes.extend(note);
    Ok(file)
}

/// Returns whether this is the text form. The header of a binary file may begin with the same word.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let is_word =
        start.len() > KEYWORD.len() && start[..KEYWORD.len()].eq_ignore_ascii_case(KEYWORD);
    is_word
        && start[KEYWORD.len()].is_ascii_whitespace()
        && promised_by_header(bytes).is_none_or(|(_, length)| length != bytes.len() as u64)
        && !bytes.iter().take(HEADER_BYTES).any(|&byte| byte == 0)
}

/// Returns the number of triangles that the header of a binary file promises, and the file length that follows from
/// it. Programs that write in one pass, before they know the number, leave 0 or the largest number there: then the
/// number follows from the length of the file.
fn promised_by_header(bytes: &[u8]) -> Option<(usize, u64)> {
    let (_, count) = bytes.get(..HEADER_BYTES)?.split_last_chunk()?;
    let found = bytes.len() - HEADER_BYTES;
    let count = match u32::from_le_bytes(*count) {
        0 | u32::MAX if found.is_multiple_of(TRIANGLE_BYTES) => found / TRIANGLE_BYTES,
        count => count as usize,
    };
    Some((
        count,
        HEADER_BYTES as u64 + count as u64 * TRIANGLE_BYTES as u64,
    ))
}

/// Truncates a binary file to what its header promises; returns the note on the rest, if there is one.
fn prepare_binary(bytes: &mut Vec<u8>) -> Result<Option<String>, Fault> {
    let found = bytes.len();
    let Some((count, length)) = promised_by_header(bytes) else {
        return Err(Fault::new(format!(
            "not an STL file: it does not begin with `solid`, and is too short to be binary, with {found} of at least {HEADER_BYTES} bytes"
        )));
    };
    if length > found as u64 {
        return Err(Fault::new(format!(
            "the header declares {count} triangles, which take {length} bytes, but the file ends after {found}"
        )));
    }
    check_faces(count)?;
    let extra = found as u64 - length;
    // Fewer bytes need no note: some programs append a few of their own.
    let note = (extra >= TRIANGLE_BYTES as u64).then(|| {
        format!("{extra} bytes after the {count} triangles that the header declares are not read")
    });
    bytes.truncate(HEADER_BYTES + count * TRIANGLE_BYTES);
    // So that the reader does not take the header for text.
    bytes[..HEADER_BYTES].fill(0);
    Ok(note)
}

/// Prepares the text for the reader: everything lower-case, anything but ASCII replaced, a space after `solid`. The
/// reader would take text that it does not recognise for binary data. Returns the name, and the points in full
/// precision, which the reader rounds.
fn prepare_text(bytes: &mut Vec<u8>) -> Result<(Option<String>, Vec<DVec3>), Fault> {
    let is_line_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let start = bytes.len() - bytes.trim_ascii_start().len();
    let line = bytes[start..].split(is_line_end).next().unwrap_or_default();
    if start + line.len() == bytes.len() {
        return Err(Fault::new("the file ends within its first line"));
    }
    let name = String::from_utf8_lossy(&line[KEYWORD.len()..])
        .trim()
        .to_owned();
    for byte in bytes.iter_mut() {
        *byte = if byte.is_ascii() {
            byte.to_ascii_lowercase()
        } else {
            b'?'
        };
    }
    let vertices = take_vertices(bytes);
    // Facets are counted only if the length of the file allows too many.
    if check_faces(bytes.len() / MIN_TEXT_TRIANGLE).is_err() {
        let facets = bytes.windows(8).filter(|window| *window == b"endfacet");
        check_faces(facets.count())?;
    }
    bytes.insert(start + KEYWORD.len(), b' ');
    // Pad to a length that no binary file has.
    while bytes.len() < HEADER_BYTES
        || (bytes.len() - HEADER_BYTES) % TRIANGLE_BYTES != TRIANGLE_BYTES / 2
    {
        bytes.push(b' ');
    }
    Ok(((!name.is_empty()).then_some(name), vertices))
}

/// Returns the coordinates of all points. Replaces normals, which are not used, by zeros: for faces without an area
/// some programs write ones that are not numbers, such as `-nan(ind)`.
fn take_vertices(text: &mut [u8]) -> Vec<DVec3> {
    let (mut at, mut normals_left, mut is_facet) = (0, 0, false);
    let (mut vertices, mut point, mut next_coordinate) = (Vec::new(), [0.0; 3], None);
    let mut is_loop = false;
    while at < text.len() {
        if text[at].is_ascii_whitespace() {
            // A number that is missing in a line is not taken from the next.
            normals_left = if text[at] == b'\n' { 0 } else { normals_left };
            at += 1;
            continue;
        }
        let rest = text[at..].iter();
        let length = rest.take_while(|byte| !byte.is_ascii_whitespace()).count();
        let word = &mut text[at..at + length];
        at += length;
        if normals_left > 0 {
            word.fill(b' ');
            word[0] = b'0';
            normals_left -= 1;
        } else if is_facet && word == b"normal" {
            normals_left = 3;
        }
        is_facet = word == b"facet";
        match next_coordinate {
            Some(index) => {
                let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                point[index] = number.unwrap_or(f64::NAN);
                next_coordinate = Some(index + 1).filter(|next| *next < point.len());
                if next_coordinate.is_none() {
                    vertices.push(DVec3::from_array(point));
                }
            }
            // Names may contain the word `vertex`, too.
            None if is_loop && word == b"vertex" => next_coordinate = Some(0),
            None => is_loop = word == b"loop",
        }
    }
    vertices
}

/// Reads a text. Later solids without a name need a space after `solid`, too.
fn load_text(bytes: &[u8]) -> std::io::Result<Scene> {
    let loaded = mesh_loader::stl::from_slice(bytes);
    match &loaded {
        Err(error) if error.to_string().contains("space after solid") => {
            let text = String::from_utf8_lossy(bytes);
            let spaced = text
                .replace("solid\n", "solid \n")
                .replace("solid\r", "solid \r");
            mesh_loader::stl::from_slice(spaced.as_bytes())
        }
        _ => loaded,
    }
}

/// Converts an error of the reader, whose message ends with line and column in brackets.
fn fault_of(error: &std::io::Error, is_text: bool) -> Fault {
    let message = error.to_string();
    let location = message.rsplit_once(" (").and_then(|(message, location)| {
        let (line, _) = location.split_once(':')?;
        Some((message, line.parse().ok()?))
    });
    match location {
        Some((message, line)) if is_text => Fault::in_line(line, message),
        Some((message, _)) => Fault::new(message),
        None => Fault::new(message),
    }
}
