//! Figures that can be drawn of measurements.

use super::growth::Growth;
use super::scaling::SharedPicture;
use super::stability::Map;
use super::study::Study;

/// Smallest width and height in pixels of one of several charts, so that its dots can be told apart.
const MIN_CHART_SIZE: (u32, u32) = (480, 280);
/// Height in pixels of the legend that several charts share.
const LEGEND_HEIGHT: u32 = 120;

/// Appearance of a picture of charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureLook {
    /// Whether the theme is light.
    pub is_light: bool,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

impl PictureLook {
    /// The columns and rows of the grid in which this number of charts is laid out.
    pub fn grid_of(charts: usize) -> (u32, u32) {
        let charts = charts.max(1);
        let columns = (charts as f64).sqrt().ceil() as usize;
        (columns as u32, charts.div_ceil(columns) as u32)
    }

    /// The smallest size of a picture that shows this number of charts completely.
    pub fn least_size(charts: usize) -> (u32, u32) {
        let (columns, rows) = Self::grid_of(charts);
        (
            columns * MIN_CHART_SIZE.0,
            LEGEND_HEIGHT + rows * MIN_CHART_SIZE.1,
        )
    }
}

/// Measurements to be drawn as a picture.
#[derive(Debug)]
pub enum Figure {
    /// Charts of studies.
    Chart {
        /// The studies, each with the name of its scene.
        studies: Vec<(String, Study)>,
        /// The machine that they were measured on.
        machine: String,
        /// Appearance of the picture.
        look: PictureLook,
    },
    /// Growth of the cost with the number of primitives.
    Growth(Growth, PictureLook),
    /// Simulated speedup by more cores.
    Scaling(Vec<SharedPicture>, PictureLook),
    /// Maps of where formulas fail.
    Stability(Vec<Map>),
}
