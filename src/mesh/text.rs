//! Decoding of text in mesh files, in any encoding and with any line breaks.

use std::borrow::Cow;

/// Byte order mark, which some editors write at the start of a text.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Strips a byte order mark.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes)
}

/// Decodes a text. Lines that are not UTF-8 are read as Latin-1, which keeps different names different. Carriage
/// returns alone, with which old programs end lines, become line feeds.
pub(super) fn text_of(bytes: &[u8]) -> Cow<'_, str> {
    if let Some(text) = from_utf16(bytes) {
        return Cow::Owned(text);
    }
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

/// Decodes UTF-16, as some editors on Windows save it, if there is a byte order mark.
fn from_utf16(bytes: &[u8]) -> Option<String> {
    let (order, bytes): (fn([u8; 2]) -> u16, _) = match bytes {
        [0xff, 0xfe, rest @ ..] => (u16::from_le_bytes, rest),
        [0xfe, 0xff, rest @ ..] => (u16::from_be_bytes, rest),
        _ => return None,
    };
    let units: Vec<u16> = bytes
        .as_chunks()
        .0
        .iter()
        .map(|&pair| order(pair))
        .collect();
    Some(String::from_utf16_lossy(&units))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_any_encoding_stay_different() {
        assert_eq!(text_of("\u{feff}rotä".as_bytes()), "rotä");
        assert_eq!(text_of(b"rot\xe4\rrot\xf6"), "rotä\nrotö");
        assert_eq!(text_of(b"a\r\nb"), "a\r\nb");
        assert_eq!(text_of(b"\xff\xfev\0 \x001\0"), "v 1");
        assert_eq!(text_of(b"\xfe\xff\0v\0 \x001"), "v 1");
        let mixed = [b"# B\xfcro\n", "usemtl rotä".as_bytes()].concat();
        assert_eq!(text_of(&mixed), "# Büro\nusemtl rotä");
    }
}
