//! Pictures accessed row by row, for encoders that need no more at a time.

use std::io;

use super::buffer::Raster;

/// A picture whose rows are read from the top.
pub trait Rows<P> {
    /// Width and height in pixels.
    fn size(&self) -> (usize, usize);

    /// The pixels of a row; `None` if the picture is no longer wanted.
    fn row(&mut self, row: usize) -> Option<&[P]>;
}

impl<P> Rows<P> for &Raster<P> {
    fn size(&self) -> (usize, usize) {
        (self.width, self.height)
    }

    fn row(&mut self, row: usize) -> Option<&[P]> {
        let first = row * self.width;
        self.pixels.get(first..first + self.width)
    }
}

/// The error if a row is missing because the picture is no longer wanted.
pub fn unwanted() -> io::Error {
    io::Error::new(
        io::ErrorKind::Interrupted,
        "the picture is no longer needed",
    )
}
