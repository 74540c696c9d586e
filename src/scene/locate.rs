//! Finding the position of a value in RON text. The parser's positions are lost once the scene is deserialized; for
//! a problem found by a later check, the text is scanned again for the field concerned.

/// One step of a path from a value to one of its parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathStep {
    /// A named field of a struct.
    Field(&'static str),
    /// An item of a list or tuple, counted from 0.
    Index(usize),
    /// The value of a map key.
    Key(String),
}

/// Returns the byte offset of the value at `path`, or of the last existing value along it: a missing field is
/// reported at the position of its struct.
pub fn locate(text: &str, path: &[PathStep]) -> usize {
    let mut cursor = Cursor::at_value(text);
    for step in path {
        let here = cursor.at;
        if !cursor.enter(step) {
            return here;
        }
    }
    cursor.at
}

/// Returns the byte offsets of all items of the list at `path`; empty if there is none.
pub fn locate_items(text: &str, path: &[PathStep]) -> Vec<usize> {
    let mut cursor = Cursor::at_value(text);
    let mut offsets = Vec::new();
    if path.iter().all(|step| cursor.enter(step)) && cursor.open() {
        while cursor.is_at_item() {
            offsets.push(cursor.at);
            cursor.skip_item();
        }
    }
    offsets
}

/// Returns the `version` that the text states, if it has the form of a scene. It is read first, so that a file of a
/// newer version is refused for its version and not for unknown fields.
pub fn claimed_version(text: &str) -> Option<u32> {
    let mut cursor = Cursor::at_value(text);
    if !cursor.enter(&PathStep::Field("version")) {
        return None;
    }
    let digits = cursor.rest().split(|c: char| !c.is_ascii_digit()).next()?;
    digits.parse().ok()
}

/// Returns whether the top-level value of the text has a field of this name.
pub fn names_field(text: &str, name: &'static str) -> bool {
    Cursor::at_value(text).enter(&PathStep::Field(name))
}

/// Returns the comments and blank lines before the first value.
pub fn header(text: &str) -> &str {
    let mut cursor = Cursor { text, at: 0 };
    cursor.skip_space();
    &text[..cursor.at]
}

/// Returns whether there are comments after the first value, which saving would lose.
pub fn has_inner_comments(text: &str) -> bool {
    let mut cursor = Cursor {
        text,
        at: header(text).len(),
    };
    while let Some(next) = cursor.peek() {
        if cursor.rest().starts_with("//") || cursor.rest().starts_with("/*") {
            return true;
        }
        cursor.skip_token(next);
    }
    false
}

struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    /// The first value of a text, behind comments and `#![enable(…)]` attributes.
    fn at_value(text: &'a str) -> Self {
        let mut cursor = Self { text, at: 0 };
        cursor.skip_space();
        while cursor.rest().starts_with("#!") {
            let end = cursor.rest().find(']');
            cursor.at = end.map_or(text.len(), |end| cursor.at + end + 1);
            cursor.skip_space();
        }
        cursor
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    /// Skips white space and comments (block comments nest).
    fn skip_space(&mut self) {
        loop {
            let rest = self.rest();
            if let Some(after) = rest.strip_prefix("//") {
                self.at += 2 + after.find('\n').unwrap_or(after.len());
            } else if rest.starts_with("/*") {
                self.skip_block_comment();
            } else if let Some(space) = rest.chars().next().filter(|c| c.is_whitespace()) {
                self.at += space.len_utf8();
            } else {
                return;
            }
        }
    }

    fn skip_block_comment(&mut self) {
        let mut depth = 0_usize;
        while let Some(next) = self.peek() {
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.at += next.len_utf8();
            }
        }
    }

    /// Skips a string, or a single character of anything else.
    fn skip_token(&mut self, next: char) {
        let raw = self.rest().strip_prefix('r').map(|after| {
            let hashes = after.len() - after.trim_start_matches('#').len();
            (hashes, after[hashes..].starts_with('"'))
        });
        match (next, raw) {
            ('"', _) => self.skip_string(),
            ('r', Some((hashes, true))) => {
                let end = format!("\"{}", "#".repeat(hashes));
                let body = self.at + 2 + hashes;
                self.at = self.text[body..]
                    .find(&end)
                    .map_or(self.text.len(), |i| body + i + end.len());
            }
            _ => self.at += next.len_utf8(),
        }
    }

    fn skip_string(&mut self) {
        let mut escaped = false;
        for (index, c) in self.rest().char_indices().skip(1) {
            if c == '"' && !escaped {
                self.at += index + 1;
                return;
            }
            escaped = c == '\\' && !escaped;
        }
        self.at = self.text.len();
    }

    fn identifier(&mut self) -> &'a str {
        let rest = self.rest();
        let end = rest
            .find(|c: char| !(c.is_alphanumeric() || c == '_'))
            .unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// Skips a whole value, up to the comma or bracket that ends it.
    fn skip_value(&mut self) {
        let mut depth = 0_usize;
        loop {
            self.skip_space();
            match self.peek() {
                None => return,
                Some(',' | ':' | ')' | ']' | '}') if depth == 0 => return,
                Some(next) => {
                    match next {
                        '(' | '[' | '{' => depth += 1,
                        ')' | ']' | '}' => depth -= 1,
                        _ => {}
                    }
                    self.skip_token(next);
                }
            }
        }
    }

    /// Moves into the part `step` of the value at the cursor. Returns false, with the cursor anywhere, if there is
    /// none.
    fn enter(&mut self, step: &PathStep) -> bool {
        if !self.open() {
            return false;
        }
        let mut index = 0;
        while self.is_at_item() {
            if self.item_matches(step, index) {
                return true;
            }
            self.skip_item();
            index += 1;
        }
        false
    }

    /// Moves into a struct, list, tuple or map, behind its opening bracket. Returns whether there is one.
    fn open(&mut self) -> bool {
        let name = self.identifier();
        self.skip_space();
        let is_open = matches!(self.peek(), Some('(' | '[' | '{'));
        self.at += usize::from(is_open);
        if is_open && name == "Some" {
            // An option that is written out stands for what is in it.
            self.skip_space();
            return self.open();
        }
        is_open
    }

    /// Moves to the next token, and returns whether it is one of an item.
    fn is_at_item(&mut self) -> bool {
        self.skip_space();
        !matches!(self.peek(), None | Some(')' | ']' | '}'))
    }

    /// Moves behind an item and its comma.
    fn skip_item(&mut self) {
        self.skip_value();
        if self.peek() == Some(',') {
            self.at += 1;
        }
    }

    /// With the cursor at an item, moves to its value and returns whether it is the one that `step` means.
    fn item_matches(&mut self, step: &PathStep, index: usize) -> bool {
        let start = self.at;
        let found = match step {
            PathStep::Index(wanted) => return *wanted == index,
            PathStep::Field(name) => self.identifier() == *name,
            PathStep::Key(key) => {
                self.skip_value();
                ron::from_str::<String>(self.text[start..self.at].trim()).is_ok_and(|k| k == *key)
            }
        };
        self.skip_space();
        if self.peek() == Some(':') {
            self.at += 1;
            self.skip_space();
            return found;
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"// header (with: brackets)
/* and /* nested */ */
Scene(
    version: 1, // inner
    color_packs: { "a\"b": ColorPack(ambient: (1, 2, 3)), "c": ColorPack(ambient: (4, 5, 6)) },
    objects: [Object(name: "x, ]", shape: Sphere(radius: 1)), Object(name: r"y", shape: Sphere(radius: 22))],
)"#;

    fn found(path: &[PathStep]) -> &str {
        &TEXT[locate(TEXT, path)..][..2]
    }

    #[test]
    fn values_are_found_behind_strings_and_comments() {
        let field = PathStep::Field;
        let key = |name: &str| PathStep::Key(name.to_owned());
        assert_eq!(found(&[field("version")]), "1,");
        assert_eq!(
            found(&[
                field("color_packs"),
                key("c"),
                field("ambient"),
                PathStep::Index(1)
            ]),
            "5,"
        );
        assert_eq!(
            found(&[field("color_packs"), key("a\"b"), field("ambient")]),
            "(1"
        );
        assert_eq!(
            found(&[
                field("objects"),
                PathStep::Index(1),
                field("shape"),
                field("radius")
            ]),
            "22"
        );
    }

    #[test]
    fn all_items_of_a_list_are_found_at_once() {
        let objects = PathStep::Field("objects");
        let places = locate_items(TEXT, std::slice::from_ref(&objects));
        let one = |index| locate(TEXT, &[objects.clone(), PathStep::Index(index)]);
        assert_eq!(places, [one(0), one(1)]);
        assert!(locate_items(TEXT, &[PathStep::Field("lights")]).is_empty());
    }

    #[test]
    fn what_was_left_out_is_reported_at_its_struct() {
        let path = [
            PathStep::Field("objects"),
            PathStep::Index(0),
            PathStep::Field("color_pack"),
        ];
        assert_eq!(found(&path), "Ob");
        assert_eq!(found(&[PathStep::Field("lights")]), "Sc");
    }

    #[test]
    fn headers_and_inner_comments_are_told_apart() {
        assert!(header(TEXT).ends_with("*/ */\n"));
        assert!(has_inner_comments(TEXT));
        assert!(!has_inner_comments(
            "// only\nScene(objects: [\"// not one\"])"
        ));
        assert_eq!(claimed_version(TEXT), Some(1));
    }

    #[test]
    fn no_text_makes_it_panic() {
        for end in (0..TEXT.len()).filter(|&end| TEXT.is_char_boundary(end)) {
            let cut = &TEXT[..end];
            assert!(locate(cut, &[PathStep::Field("objects"), PathStep::Index(1)]) <= cut.len());
            let _ = (claimed_version(cut), has_inner_comments(cut));
        }
    }
}
