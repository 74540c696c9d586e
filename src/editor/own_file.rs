//! What has become of the file of a document.

/// How the file of a document is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OwnFile {
    /// There, or there is none.
    #[default]
    Whole,
    /// Moved or deleted.
    Gone,
    /// Another program has written what cannot be read.
    Broken,
}
