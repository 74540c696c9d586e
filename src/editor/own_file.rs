//! The state of the document's file.

/// State of the document's file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OwnFile {
    /// The file exists unharmed, or the document has none.
    #[default]
    Whole,
    /// Moved or deleted.
    Gone,
    /// Overwritten by another program with something that cannot be read.
    Broken,
}
