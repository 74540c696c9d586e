//! Pictures row by row, for encoders that look at no more of them at a time.

use std::io;

use super::buffer::Raster;

/// A picture whose rows are looked at from the top.
pub trait Rows<P> {
    /// Width and height in pixels.
    fn size(&self) -> (usize, usize);

    /// The pixels of a row; `None` once nobody wants the picture any more.
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

/// What to say where no row comes.
pub fn unwanted() -> io::Error {
    io::Error::new(
        io::ErrorKind::Interrupted,
        "the picture is no longer needed",
    )
}
