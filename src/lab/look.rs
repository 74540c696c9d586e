//! How what was measured is drawn and named.

/// How a picture of a chart looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureLook {
    /// Whether it is light.
    pub is_light: bool,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// A word with a large first letter.
pub fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
