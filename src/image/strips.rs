//! Pictures traced strip by strip while they are written: their size is limited by the disk, not by memory.

use std::io::{self, Seek, Write};
use std::ops::Range;
use std::time::Duration;

use image::ImageError;

use super::buffer::LinearRgb;
use super::encode::{Format, write_levels, write_light};
use super::render::RenderCost;
use super::rows::{Rows, unwanted};
use crate::plan::{Planner, RenderRequest};
use crate::scene::Scene;
use crate::trace::{Pixel, Rays, RenderControl, Tracer};

/// A picture whose rows are traced on demand; only one strip is in memory.
#[derive(Debug)]
pub struct Strips<'a, P> {
    tracer: Tracer,
    control: &'a RenderControl,
    /// Number of rows of a strip.
    strip_rows: usize,
    /// The pixels of the current strip.
    strip: &'a mut Vec<P>,
    /// The rows of the current strip.
    rows: Range<usize>,
    time: Duration,
    rays: Rays,
}

impl<'a, P: Pixel + Copy + Default> Strips<'a, P> {
    /// Plans a picture, to be traced into this memory unless `control` is stopped.
    pub fn new(
        strip: &'a mut Vec<P>,
        planner: &mut Planner,
        (scene, request): (&Scene, &RenderRequest),
        control: &'a RenderControl,
    ) -> Self {
        let watch = control.stopwatch();
        let tracer = Tracer::planned(scene, request, planner);
        Self {
            strip_rows: tracer.strip(),
            tracer,
            control,
            strip,
            rows: 0..0,
            time: watch.elapsed(),
            rays: Rays::default(),
        }
    }

    /// Traces the next strip, if any.
    fn trace_next(&mut self) -> io::Result<()> {
        if self.rows.end < self.tracer.height() {
            self.trace(self.rows.end).ok_or_else(unwanted)?;
        }
        Ok(())
    }

    /// Traces all remaining strips.
    fn finish(&mut self) -> io::Result<()> {
        while self.rows.end < self.tracer.height() {
            self.trace_next()?;
        }
        Ok(())
    }

    /// The cost of tracing, without the use of the pixels.
    fn cost(self) -> RenderCost {
        RenderCost {
            time: self.time,
            rays: self.rays,
            lanes: self.tracer.lanes(),
        }
    }

    fn trace(&mut self, row: usize) -> Option<()> {
        let watch = self.control.stopwatch();
        let first = row / self.strip_rows * self.strip_rows;
        let rows = first..(first + self.strip_rows).min(self.tracer.height());
        self.strip
            .resize(rows.len() * self.tracer.width(), P::default());
        self.rays += self.tracer.rows(self.strip, first, self.control)?;
        self.rows = rows;
        self.time += watch.elapsed();
        Some(())
    }
}

/// A picture that is traced strip by strip for a file, in 8 bits or in linear light.
#[derive(Debug)]
pub enum Drawing<'a> {
    /// For 8-bit formats.
    Levels(Strips<'a, [u8; 4]>),
    /// For formats that hold linear light.
    Linear(Strips<'a, LinearRgb>),
}

impl Drawing<'_> {
    /// Traces the first strip. A picture of a single strip is then complete before its file is begun, so that killing
    /// the program during the tracing leaves no unfinished file.
    ///
    /// # Errors
    /// [`io::ErrorKind::Interrupted`] if `control` was stopped.
    pub fn start(&mut self) -> io::Result<()> {
        match self {
            Self::Levels(strips) => strips.trace_next(),
            Self::Linear(strips) => strips.trace_next(),
        }
    }

    /// Traces what is left, without using it.
    ///
    /// # Errors
    /// [`io::ErrorKind::Interrupted`] if `control` was stopped.
    pub fn finish(&mut self) -> io::Result<()> {
        match self {
            Self::Levels(strips) => strips.finish(),
            Self::Linear(strips) => strips.finish(),
        }
    }

    /// Writes the picture, tracing what is left of it, in the format that the film is for.
    ///
    /// # Errors
    /// Errors of the encoder or of the system; [`io::ErrorKind::Interrupted`] if `control` was stopped.
    pub fn encode(
        &mut self,
        format: Format,
        file: &mut (impl Write + Seek),
    ) -> Result<(), ImageError> {
        match self {
            Self::Levels(strips) => write_levels(strips, format, file),
            Self::Linear(strips) => write_light(strips, file),
        }
    }

    /// The cost of tracing, without writing.
    pub fn cost(self) -> RenderCost {
        match self {
            Self::Levels(strips) => strips.cost(),
            Self::Linear(strips) => strips.cost(),
        }
    }
}

impl<P: Pixel + Copy + Default> Rows<P> for Strips<'_, P> {
    fn size(&self) -> (usize, usize) {
        (self.tracer.width(), self.tracer.height())
    }

    fn row(&mut self, row: usize) -> Option<&[P]> {
        if !self.rows.contains(&row) {
            self.trace(row)?;
        }
        let first = (row - self.rows.start) * self.tracer.width();
        self.strip.get(first..first + self.tracer.width())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::image::Film;
    use crate::scene::Sampling;

    #[test]
    fn a_file_of_strips_is_that_of_the_whole_picture() {
        let (scene, control) = (Scene::demo(), RenderControl::default());
        let request = RenderRequest {
            sampling: Sampling::Grid(2),
            ..RenderRequest::sized(70, 150)
        };
        let mut planner = Planner::default();
        for format in Format::ALL {
            let mut film = Film::new(format);
            film.expose(&mut planner, &scene, &request, &control)
                .expect("not stopped");
            let [mut whole, mut strips] = [(); 2].map(|()| Cursor::new(Vec::new()));
            film.encode(format, &mut whole).expect("encodes");
            let mut film = Film::new(format);
            let mut drawing = film.draw(&mut planner, (&scene, &request), &control);
            match &mut drawing {
                // With grid sampling, strips of any height show the same as the whole picture.
                Drawing::Levels(strips) => strips.strip_rows = 64,
                Drawing::Linear(strips) => strips.strip_rows = 64,
            }
            drawing.start().expect("not stopped");
            drawing.encode(format, &mut strips).expect("encodes");
            let rays = drawing.cost().rays.camera;
            assert_eq!(rays, 70 * 150 * 4, "{format:?}: every row is traced once");
            assert!(strips == whole, "{format:?}");
        }
    }

    #[test]
    fn a_picture_that_nobody_wants_any_more_becomes_no_file() {
        let (scene, control) = (Scene::demo(), RenderControl::default());
        let request = RenderRequest::sized(40, 30);
        control.stop();
        for format in Format::ALL {
            let mut film = Film::new(format);
            let mut drawing = film.draw(&mut Planner::default(), (&scene, &request), &control);
            let error = drawing.encode(format, &mut Cursor::new(Vec::new()));
            match error.expect_err("stopped") {
                ImageError::IoError(error) => {
                    assert_eq!(error.kind(), io::ErrorKind::Interrupted, "{format:?}");
                }
                other => panic!("{format:?}: {other}"),
            }
        }
    }
}
