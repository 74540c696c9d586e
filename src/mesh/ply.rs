//! PLY: `ply-rs-bw` reads the header and the binary elements, one element at a time so that nothing is stored twice.
//! Lines of text are parsed here: the crate refuses `5.` and `.5`, which programs write.

use std::io::ErrorKind;
use std::ops::Range;

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType};

use super::error::Fault;
use super::limits::{check_faces, check_points};
use super::part::{MeshFile, NOTE_POINT_COLORS};
use super::ply_element::{Element, is_corners, least_bytes};
use super::polygon::{fan, mend_fan, note_of_uncut, strip};
use super::triangles::{Triangles, out_of_range};

/// Longest header in bytes, so that gigabytes are not searched for a missing end.
const MAX_HEADER: usize = 1 << 20;

/// Reads a PLY file; polygons are triangulated.
pub(super) fn read(bytes: &[u8], stem: &str) -> Result<MeshFile, Fault> {
    let parser = Parser::<Element>::new();
    // Comments may be in any encoding, but the crate requires UTF-8.
    let to_ascii = |&byte: &u8| if byte.is_ascii() { byte } else { b'?' };
    let start: Vec<u8> = bytes.iter().take(MAX_HEADER).map(to_ascii).collect();
    let mut reader = Reader::new(start.as_slice());
    let header = parser
        .read_header(&mut reader)
        .map_err(|error| header_fault(&error, bytes))?;
    let rest = &bytes[start.len() - reader.get_ref().len()..];
    let mut body = Body {
        parser,
        encoding: header.encoding,
        rest,
        line: reader.line(),
    };
    let Polygons {
        points,
        mut faces,
        fans,
    } = body.read(&header)?;
    let mut uncut = 0;
    for fan in fans {
        uncut += usize::from(mend_fan(&mut faces[fan], |corner| points[corner as usize]));
    }
    let triangles = Triangles::weld(points.len(), |index| points[index], faces.into_iter())?;
    let mut file = MeshFile::of_one(stem.to_owned(), triangles);
    if has_colors(&header) {
        file.notes.push(NOTE_POINT_COLORS.to_owned());
    }
    file.notes.extend(note_of_uncut(uncut));
    Ok(file)
}

/// Returns whether points or faces have colours.
fn has_colors(header: &Header) -> bool {
    let elements = ["vertex", "face"].map(|name| header.elements.get(name));
    let is_color = |name: &String| matches!(name.as_str(), "red" | "diffuse_red");
    let mut elements = elements.into_iter().flatten();
    elements.any(|element| element.properties.iter().any(|(name, _)| is_color(name)))
}

fn header_fault(error: &ParseError, bytes: &[u8]) -> Fault {
    if !bytes.starts_with(b"ply") {
        return Fault::new("not a PLY file: it does not begin with `ply`");
    }
    match (error.kind(), error.line()) {
        (ErrorKind::UnexpectedEof, _) => Fault::new("the header has no `end_header`"),
        (_, Some(line)) => Fault::in_line(line, "this is not a valid line of a PLY header"),
        (_, None) => Fault::new("the header does not name the PLY format"),
    }
}

/// Points and triangles, and the ranges of triangles that are fans of one polygon.
struct Polygons {
    points: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
    fans: Vec<Range<usize>>,
}

/// The part of the file after the header.
struct Body<'a> {
    parser: Parser<Element>,
    encoding: Encoding,
    rest: &'a [u8],
    /// The line that is read next, counted from 1.
    line: usize,
}

impl Body<'_> {
    fn read(&mut self, header: &Header) -> Result<Polygons, Fault> {
        let vertices = check_vertices(header)?;
        check_points(vertices)?;
        let (mut points, mut faces, mut fans) = (Vec::new(), Vec::new(), Vec::new());
        for (name, element) in &header.elements {
            self.check_length(element)?;
            match name.as_str() {
                "vertex" => {
                    points.reserve_exact(element.count);
                    self.read_each(element, |_, read| {
                        points.push(DVec3::from_array(read.position));
                        Ok(())
                    })?;
                }
                "face" => {
                    check_corners(element)?;
                    check_faces(element.count)?;
                    faces.reserve_exact(element.count);
                    self.read_each(element, |number, read| {
                        let start = faces.len();
                        add_fan(&mut faces, number, &read.corners, vertices)?;
                        if faces.len() > start + 1 {
                            fans.push(start..faces.len());
                        }
                        Ok(())
                    })?;
                    // Nothing after the faces is needed, if the points came first.
                    if points.len() == vertices && !header.elements.contains_key("tristrips") {
                        break;
                    }
                }
                "tristrips" => {
                    check_corners(element)?;
                    self.read_each(element, |number, read| {
                        add_strips(&mut faces, number, &read.corners, vertices)
                    })?;
                }
                _ => self.read_each(element, |_, _| Ok(()))?,
            }
        }
        Ok(Polygons {
            points,
            faces,
            fans,
        })
    }

    /// A header may claim any count: fails if the rest of the file is too short for it.
    fn check_length(&self, element: &ElementDef) -> Result<(), Fault> {
        let is_text = self.encoding == Encoding::Ascii;
        let least = least_bytes(element, is_text).saturating_mul(element.count);
        // The last line of a text may lack its line break.
        if least > self.rest.len() + usize::from(is_text) {
            return Err(Fault::new(format!(
                "the header declares {} of `{}`, which take at least {least} bytes, but the file has {} left",
                element.count,
                element.name,
                self.rest.len()
            )));
        }
        Ok(())
    }

    /// Reads all elements of a kind and passes them on, numbered from 1.
    fn read_each(
        &mut self,
        element: &ElementDef,
        mut on_element: impl FnMut(usize, Element) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        // Elements without properties take no bytes, whatever their count.
        if element.properties.is_empty() {
            return Ok(());
        }
        for number in 1..=element.count {
            let read = match self.encoding {
                Encoding::Ascii => Ok(self.next_line(number, element)?),
                Encoding::BinaryLittleEndian => self
                    .parser
                    .read_little_endian_element(&mut self.rest, element),
                Encoding::BinaryBigEndian => {
                    self.parser.read_big_endian_element(&mut self.rest, element)
                }
            };
            let read = read.map_err(|error| body_fault(&error, number, element))?;
            on_element(number, read).map_err(|fault| match fault {
                Fault::Refused { why, .. } if self.encoding == Encoding::Ascii => {
                    Fault::in_line(self.line - 1, why)
                }
                other => other,
            })?;
        }
        Ok(())
    }

    fn next_line(&mut self, number: usize, element: &ElementDef) -> Result<Element, Fault> {
        while !self.rest.is_empty() {
            let end = self.rest.iter().position(|&byte| byte == b'\n');
            let (line, rest) = self
                .rest
                .split_at(end.map_or(self.rest.len(), |end| end + 1));
            self.rest = rest;
            self.line += 1;
            let line = line.trim_ascii();
            if !line.is_empty() {
                return str::from_utf8(line)
                    .map_err(|_| "this line is not text".to_owned())
                    .and_then(|line| Element::from_text(line, element))
                    .map_err(|why| Fault::in_line(self.line - 1, why));
            }
        }
        Err(ends_within(number, element))
    }
}

fn body_fault(error: &ParseError, number: usize, element: &ElementDef) -> Fault {
    match error.kind() {
        ErrorKind::UnexpectedEof => ends_within(number, element),
        _ => Fault::new(format!(
            "{} {number} has a list of an invalid length or type",
            element.name
        )),
    }
}

fn ends_within(number: usize, element: &ElementDef) -> Fault {
    let ElementDef { name, count, .. } = element;
    Fault::new(format!("the file ends within {name} {number} of {count}"))
}

/// Returns the number of vertices; fails unless the header gives them scalar coordinates.
fn check_vertices(header: &Header) -> Result<usize, Fault> {
    let Some(element) = header.elements.get("vertex") else {
        return Err(Fault::new("the header has no element `vertex`"));
    };
    for name in ["x", "y", "z"] {
        let property = element.properties.get(name);
        let is_number = |data: &PropertyType| matches!(data, PropertyType::Scalar(_));
        if !property.is_some_and(|property| is_number(&property.data_type)) {
            let sentence = format!("the element `vertex` in the header has no number `{name}`");
            return Err(Fault::new(sentence));
        }
    }
    Ok(element.count)
}

fn check_corners(element: &ElementDef) -> Result<(), Fault> {
    let has_corners = element.properties.iter().any(|(name, property)| {
        is_corners(name) && matches!(property.data_type, PropertyType::List(..))
    });
    if !has_corners {
        return Err(Fault::new(format!(
            "the element `{}` in the header has no list `vertex_indices` or `vertex_index`",
            element.name
        )));
    }
    Ok(())
}

fn add_fan(
    faces: &mut Vec<[u32; 3]>,
    number: usize,
    corners: &[i64],
    vertices: usize,
) -> Result<(), Fault> {
    let index = |corner: i64| {
        let index = u32::try_from(corner).ok();
        index
            .filter(|&index| (index as usize) < vertices)
            .ok_or_else(|| out_of_range(number, corner, vertices))
    };
    check_faces(faces.len() + corners.len().saturating_sub(2))?;
    for [a, b, c] in fan(corners) {
        faces.push([index(a)?, index(b)?, index(c)?]);
    }
    Ok(())
}

/// Adds triangle strips, which are separated by -1.
fn add_strips(
    faces: &mut Vec<[u32; 3]>,
    number: usize,
    corners: &[i64],
    vertices: usize,
) -> Result<(), Fault> {
    let mut strips = corners.split(|&corner| corner == -1).flat_map(strip);
    strips.try_for_each(|corners| add_fan(faces, number, &corners, vertices))
}
