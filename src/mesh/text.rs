//! Texts of mesh files, in any encoding and with any line breaks.

use std::borrow::Cow;

/// What some editors write before a text.
const MARK: &[u8] = "\u{feff}".as_bytes();

/// Without a byte order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(MARK).unwrap_or(bytes)
}

/// A text whose lines are in UTF-8, or else in Latin-1, in which different names stay different; with line breaks as we
/// know them: old programs end lines with a carriage return alone.
pub(super) fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    let bytes = without_mark(bytes);
    let line = |line| match str::from_utf8(line) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(line.iter().map(|&byte| char::from(byte)).collect()),
    };
    let text = str::from_utf8(bytes).map_or_else(
        |_| {
            Cow::Owned(
                bytes
                    .split_inclusive(|&byte| byte == b'\n')
                    .map(line)
                    .collect(),
            )
        },
        Cow::Borrowed,
    );
    if text.contains('\r') && !text.contains('\n') {
        Cow::Owned(text.replace('\r', "\n"))
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_encoding_stay_different() {
        assert_eq!(text_of("\u{feff}rotä".as_bytes()), "rotä");
        assert_eq!(text_of(b"rot\xe4\rrot\xf6"), "rotä\nrotö");
        assert_eq!(text_of(b"a\r\nb"), "a\r\nb");
        let mixed = [b"# B\xfcro\n", "usemtl rotä".as_bytes()].concat();
        assert_eq!(text_of(&mixed), "# Büro\nusemtl rotä");
    }
}
