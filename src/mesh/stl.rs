//! STL, as text and binary, read by `mesh-loader`.

use glam::DVec3;
use mesh_loader::Scene;

use super::error::Fault;
use super::limits::{check_faces, check_points};
use super::part::MeshFile;
use super::triangles::Triangles;

/// Bytes before the first triangle of a binary file: 80 arbitrary ones, and the number of triangles.
const HEADER: usize = 84;
/// Bytes per triangle of a binary file.
const TRIANGLE: usize = 50;
/// First word of a text file.
const WORD: &[u8] = b"solid";
/// Least number of bytes per triangle of a text file.
const SHORTEST: usize = 80;

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
    let is_whole = vertices.len() == points.len();
    let triangles = Triangles::weld(
        points.len(),
        |index| {
            let rounded = || DVec3::from_array(points[index].map(f64::from));
            if is_whole { vertices[index] } else { rounded() }
        },
        (0..points.len() as u32 / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]),
    )?;
    let name = name.unwrap_or_else(|| stem.to_owned());
    let mut file = MeshFile::of_one(name, triangles);
    file.notes.extend(note);
    Ok(file)
}

/// Returns whether this is the text form. The header of a binary file may begin with the same word.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    let start = bytes.trim_ascii_start();
    let is_word = start.len() > WORD.len() && start[..WORD.len()].eq_ignore_ascii_case(WORD);
    is_word
        && start[WORD.len()].is_ascii_whitespace()
        && promised(bytes).is_none_or(|(_, length)| length != bytes.len() as u64)
        && !bytes.iter().take(HEADER).any(|&byte| byte == 0)
}

/// Returns the number of triangles that the header of a binary file promises, and the file length that follows from
/// it. Programs that write in one pass, before they know the number, leave 0 or the largest number there: then the
/// number follows from the length of the file.
fn promised(bytes: &[u8]) -> Option<(usize, u64)> {
    let (_, count) = bytes.get(..HEADER)?.split_last_chunk()?;
    let found = bytes.len() - HEADER;
    let count = match u32::from_le_bytes(*count) {
        0 | u32::MAX if found.is_multiple_of(TRIANGLE) => found / TRIANGLE,
        count => count as usize,
    };
    Some((count, HEADER as u64 + count as u64 * TRIANGLE as u64))
}

/// Truncates a binary file to what its header promises; returns the note on the rest, if there is one.
fn prepare_binary(bytes: &mut Vec<u8>) -> Result<Option<String>, Fault> {
    let found = bytes.len();
    let Some((count, length)) = promised(bytes) else {
        return Err(Fault::new(format!(
            "not an STL file: it does not begin with `solid`, and is too short to be binary, with {found} of at least {HEADER} bytes"
        )));
    };
    if length > found as u64 {
        return Err(Fault::new(format!(
            "the header declares {count} triangles, which take {length} bytes, but the file ends after {found}"
        )));
    }
    check_faces(count)?;
    let more = found as u64 - length;
    // Fewer bytes need no note: some programs append a few of their own.
    let note = (more >= TRIANGLE as u64).then(|| {
        format!("{more} bytes after the {count} triangles that the header declares are not read")
    });
    bytes.truncate(HEADER + count * TRIANGLE);
    // So that the reader does not take the header for text.
    bytes[..HEADER].fill(0);
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
    let name = String::from_utf8_lossy(&line[WORD.len()..])
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
    if check_faces(bytes.len() / SHORTEST).is_err() {
        let facets = bytes.windows(8).filter(|window| *window == b"endfacet");
        check_faces(facets.count())?;
    }
    bytes.insert(start + WORD.len(), b' ');
    // Pad to a length that no binary file has.
    while bytes.len() < HEADER || (bytes.len() - HEADER) % TRIANGLE != TRIANGLE / 2 {
        bytes.push(b' ');
    }
    Ok(((!name.is_empty()).then_some(name), vertices))
}

/// Returns the coordinates of all points. Replaces normals, which are not used, by zeros: for faces without an area
/// some programs write ones that are not numbers, such as `-nan(ind)`.
fn take_vertices(text: &mut [u8]) -> Vec<DVec3> {
    let (mut at, mut left, mut is_facet) = (0, 0, false);
    let (mut vertices, mut point, mut read) = (Vec::new(), [0.0; 3], None);
    let mut is_loop = false;
    while at < text.len() {
        if text[at].is_ascii_whitespace() {
            // A number that is missing in a line is not taken from the next.
            left = if text[at] == b'\n' { 0 } else { left };
            at += 1;
            continue;
        }
        let rest = text[at..].iter();
        let length = rest.take_while(|byte| !byte.is_ascii_whitespace()).count();
        let word = &mut text[at..at + length];
        at += length;
        if left > 0 {
            word.fill(b' ');
            word[0] = b'0';
            left -= 1;
        } else if is_facet && word == b"normal" {
            left = 3;
        }
        is_facet = word == b"facet";
        match read {
            Some(index) => {
                let number = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                point[index] = number.unwrap_or(f64::NAN);
                read = Some(index + 1).filter(|next| *next < point.len());
                if read.is_none() {
                    vertices.push(DVec3::from_array(point));
                }
            }
            // Names may contain the word `vertex`, too.
            None if is_loop && word == b"vertex" => read = Some(0),
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
    let said = error.to_string();
    let place = said.rsplit_once(" (").and_then(|(said, place)| {
        let (line, _) = place.split_once(':')?;
        Some((said, line.parse().ok()?))
    });
    match place {
        Some((said, line)) if is_text => Fault::in_line(line, said),
        Some((said, _)) => Fault::new(said),
        None => Fault::new(said),
    }
}
