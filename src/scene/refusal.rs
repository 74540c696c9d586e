//! Why a text is refused: where, and in which words.

use std::fmt;

/// Largest number of characters of a line that an error shows: files of a single line stay readable.
const MAX_EXCERPT: usize = 64;

/// Why a text was refused: position, message and an excerpt of the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// The file name, or a name for the text.
    pub name: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong and what was expected, as a sentence without its full stop.
    pub sentence: String,
    /// The line around the column, at most [`MAX_EXCERPT`] characters.
    excerpt: String,
    /// Characters of the excerpt before the caret.
    indent: usize,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self {
            name,
            line,
            column,
            sentence,
            excerpt,
            indent,
        } = self;
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        let caret = format!("{:indent$}^", "");
        write!(
            f,
            "{name}:{line}:{column}: {sentence}\n {number} | {excerpt}\n {margin} | {caret}"
        )
    }
}

impl Refusal {
    /// Refuses a text for what is at a byte offset.
    pub fn at(name: &str, text: &str, at: usize, sentence: String) -> Self {
        let start = text[..at].rfind('\n').map_or(0, |newline| newline + 1);
        let before: Vec<char> = text[start..at].chars().collect();
        let after = text[at..].chars().take_while(|&c| c != '\n' && c != '\r');
        let indent = before.len().min(MAX_EXCERPT / 2);
        let shown = before[before.len() - indent..]
            .iter()
            .copied()
            .chain(after)
            .take(MAX_EXCERPT);
        Self {
            name: name.to_owned(),
            line: text[..at].matches('\n').count() + 1,
            column: before.len() + 1,
            sentence,
            excerpt: shown
                .map(|c| if c.is_control() { ' ' } else { c })
                .collect(),
            indent,
        }
    }
}

/// Returns the byte offset of a 1-based line and column in characters, moved past white space: the parser reports
/// where it stopped, but readers look for the token there.
pub fn offset_of(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text
        .split_inclusive('\n')
        .take(line.saturating_sub(1))
        .map(str::len)
        .sum();
    let within = text[start..].char_indices().nth(column.saturating_sub(1));
    let at = within.map_or(text.len(), |(index, _)| start + index);
    let space = text[at..].len() - text[at..].trim_start().len();
    if at + space == text.len() {
        at
    } else {
        at + space
    }
}
