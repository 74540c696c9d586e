//! What can be drawn of what was measured.

use super::growth::Growth;
use super::scaling::SharedPicture;
use super::stability::Map;
use super::study::Study;

/// Sides in pixels of a chart beside others, so that its dots are told apart.
const TILE: (u32, u32) = (480, 280);
/// Rows of pixels for what several charts have in common.
const LEGEND: u32 = 120;

/// How a picture of a chart looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureLook {
    /// Whether it is light.
    pub is_light: bool,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

impl PictureLook {
    /// In how many columns and rows so many charts stand.
    pub fn grid_of(charts: usize) -> (u32, u32) {
        let charts = charts.max(1);
        let columns = (charts as f64).sqrt().ceil() as usize;
        (columns as u32, charts.div_ceil(columns) as u32)
    }

    /// The smallest size of a picture of several charts that shows all of each.
    pub fn least_size(charts: usize) -> (u32, u32) {
        let (columns, rows) = Self::grid_of(charts);
        (columns * TILE.0, LEGEND + rows * TILE.1)
    }
}

/// A picture of measurements that is to be drawn.
#[derive(Debug)]
pub enum Figure {
    /// Charts of studies.
    Chart {
        /// The studies, each with the name of its scene.
        studies: Vec<(String, Study)>,
        /// What was measured on.
        machine: String,
        /// How the picture looks.
        look: PictureLook,
    },
    /// How cost grows.
    Growth(Growth, PictureLook),
    /// How pictures would be shared between cores.
    Scaling(Vec<SharedPicture>, PictureLook),
    /// Where formulas break.
    Stability(Vec<Map>),
}
