//! What can be drawn of what was measured.

use super::growth::Growth;
use super::scaling::SharedPicture;
use super::stability::Map;
use super::study::Study;

/// How a picture of a chart looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureLook {
    /// Whether it is light.
    pub is_light: bool,
    /// Width and height in pixels.
    pub size: (u32, u32),
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
