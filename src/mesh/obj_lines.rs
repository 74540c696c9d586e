//! Reader that passes on the lines of an OBJ file that matter, in a form that `tobj` reads reliably.
//!
//! Left out are texture coordinates and normals, whose indices `tobj` can overflow on; lines and free-form curves;
//! and weights or colours after the coordinates of a point, which `tobj` accepts only on every point or on none.
//! Lines continued by a backslash are joined. Corners are counted while reading, so that reading stops before a file
//! with too many exhausts the memory.

use std::io::{self, BufRead, Read};

use super::error::Fault;
use super::limits::{check_faces, check_groups, check_points};
use super::mtl::Libraries;

/// Kind of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineKind {
    Point,
    Face,
    Group,
    Material,
    Library,
    Remark,
    Other,
}

impl LineKind {
    pub(super) fn of(line: &str) -> Self {
        match line.split_ascii_whitespace().next() {
            Some("v") => Self::Point,
            Some("f") => Self::Face,
            Some("o" | "g") => Self::Group,
            // `usemtl` without a name is an error to `tobj`; here it has no effect.
            Some("usemtl") if line.len() > "usemtl".len() => Self::Material,
            Some("mtllib") => Self::Library,
            Some(word) if word.starts_with('#') => Self::Remark,
            _ => Self::Other,
        }
    }

    /// Returns whether a trailing backslash continues a line of this kind: names of files and groups may end with
    /// one, and so may comments.
    pub(super) fn can_continue(self) -> bool {
        matches!(self, Self::Point | Self::Face | Self::Other)
    }
}

/// Implements [`BufRead`] over the lines, piece by piece.
pub(super) struct ObjLines<'a> {
    rest: &'a str,
    /// The piece that is read next.
    piece: &'a [u8],
    /// The separator after the piece: a line break, or a space before a continuation line.
    separator: &'static [u8],
    /// What follows the separator, up to the end of the line.
    rest_of_line: &'a str,
    /// The kind of the current line, if the next line continues it.
    continued_kind: Option<LineKind>,
    corners: usize,
    faces: usize,
    points: usize,
    groups: usize,
    /// The material files that have been read so far.
    libraries: &'a Libraries<'a>,
    /// For each line that begins a group or an object, the number of polygons before it.
    pub(super) group_starts: Vec<usize>,
    polygons: usize,
    /// Whether any point has a colour.
    pub(super) has_colors: bool,
    /// The fault because of which reading stopped early.
    pub(super) fault: Option<Fault>,
}

impl<'a> ObjLines<'a> {
    pub(super) fn new(text: &'a str, libraries: &'a Libraries<'a>) -> Self {
        Self {
            rest: text,
            piece: b"",
            separator: b"",
            rest_of_line: "",
            continued_kind: None,
            corners: 0,
            faces: 0,
            points: 0,
            groups: 0,
            libraries,
            group_starts: Vec::new(),
            polygons: 0,
            has_colors: false,
            fault: None,
        }
    }

    fn next_piece(&mut self) -> Result<&'a [u8], Fault> {
        if !self.separator.is_empty() {
            return Ok(std::mem::take(&mut self.separator));
        }
        if !self.rest_of_line.is_empty() {
            self.separator = b"\n";
            return Ok(std::mem::take(&mut self.rest_of_line).as_bytes());
        }
        while !self.rest.is_empty() {
            let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
            self.rest = rest;
            let line = line.trim_ascii();
            let begun_kind = self.continued_kind.take();
            let kind = begun_kind.unwrap_or_else(|| LineKind::of(line));
            let (line, continues) = match line.strip_suffix('\\') {
                Some(start) if kind.can_continue() => (start, !rest.is_empty()),
                _ => (line, false),
            };
            self.continued_kind = continues.then_some(kind);
            let line = match kind {
                LineKind::Point if begun_kind.is_none() && !continues => {
                    let point = point_prefix(line);
                    let extra_words = line[point.len()..].split_ascii_whitespace();
                    let colors = extra_words.take_while(|word| word.parse::<f64>().is_ok());
                    self.has_colors |= 3 <= colors.count();
                    point
                }
                LineKind::Material => self.libraries.without_comment(line),
                // Only on faces: names may contain a `#`.
                LineKind::Face => line.split('#').next().unwrap_or_default(),
                _ => line,
            };
            self.count(kind, line, continues)?;
            let separator: &[u8] = if continues { b" " } else { b"\n" };
            if matches!(kind, LineKind::Remark | LineKind::Other) {
                continue;
            }
            // An empty piece would signal the end of the text.
            if line.is_empty() {
                return Ok(separator);
            }
            if matches!(
                kind,
                LineKind::Group | LineKind::Material | LineKind::Library
            ) && let Some((word, name)) = line.split_once('\t')
                && !word.contains(' ')
            {
                // `tobj` recognises a name only after a space.
                (self.separator, self.rest_of_line) = (b" ", name.trim_ascii_start());
                return Ok(word.as_bytes());
            }
            self.separator = separator;
            return Ok(line.as_bytes());
        }
        Ok(b"")
    }

    fn count(&mut self, kind: LineKind, line: &str, continues: bool) -> Result<(), Fault> {
        match kind {
            LineKind::Point => {
                self.points += 1;
                check_points(self.points)
            }
            LineKind::Face => {
                self.corners += line.split_ascii_whitespace().count();
                // Do not count the first word, `f`.
                check_faces(self.faces + self.corners.saturating_sub(3))?;
                if !continues {
                    self.faces += self.corners.saturating_sub(3);
                    // Faces of fewer than three corners are points and lines, which `tobj` ignores.
                    self.polygons += usize::from(3 < self.corners);
                    self.corners = 0;
                }
                Ok(())
            }
            LineKind::Group | LineKind::Material => {
                self.groups += 1;
                if kind == LineKind::Group {
                    self.group_starts.push(self.polygons);
                }
                check_groups(self.groups)
            }
            LineKind::Library | LineKind::Remark | LineKind::Other => Ok(()),
        }
    }
}

/// Returns the start of a line: `v` and three numbers.
fn point_prefix(line: &str) -> &str {
    let mut words = 0;
    let mut in_word = false;
    for (at, byte) in line.bytes().enumerate() {
        let is_space = byte.is_ascii_whitespace();
        if in_word && is_space {
            words += 1;
            if words == 4 {
                return &line[..at];
            }
        }
        in_word = !is_space;
    }
    line
}

impl BufRead for ObjLines<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.piece.is_empty() {
            self.piece = self.next_piece().map_err(|fault| {
                self.fault = Some(fault);
                io::Error::other("too many")
            })?;
        }
        Ok(self.piece)
    }

    fn consume(&mut self, amount: usize) {
        self.piece = self.piece.get(amount..).unwrap_or_default();
    }
}

impl Read for ObjLines<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = self.fill_buf()?.read(into)?;
        self.consume(read);
        Ok(read)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn names_stand_behind_a_space_and_remarks_go() {
        let text = "mtllib\t\ta b.mtl\nusemtl\tred\nf 1 2 3 # all\nusemtl blue\tsky\n";
        let mut read = String::new();
        ObjLines::new(text, &Libraries::new(Path::new("")))
            .read_to_string(&mut read)
            .expect("text");
        let expected = "mtllib a b.mtl\nusemtl red\nf 1 2 3 \nusemtl blue\tsky\n";
        assert_eq!(read, expected);
    }

    #[test]
    fn only_what_matters_is_left() {
        let text = "# a cube of C:\\\r\nv 1 2\t3 0.5 0.5 0.5\nvt 1 1\n  f 1/1 \\\r\n 2 3\n\nl 1 2 \\\n3\nusemtl\n\tg a b\\\nf 1 2";
        let mut read = String::new();
        ObjLines::new(text, &Libraries::new(Path::new("")))
            .read_to_string(&mut read)
            .expect("text");
        assert_eq!(read, "v 1 2\t3\nf 1/1  2 3\ng a b\\\nf 1 2\n");
    }
}
