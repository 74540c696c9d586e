//! The lab: charts of time against error for every way of tracing the open scene. Each way is a dot whose picture
//! can be inspected and whose settings can be adopted.

mod axes;

mod labels;

mod marks;

mod chart;

mod dots;

mod pictures;

mod comparison;

mod growth;

mod scaling;

mod ramp;

mod heat;

mod rates;

mod atlas;

mod stability;

mod panel;

mod head;

mod details;

pub use panel::{Lab, LabRequest};

use crate::image::Image;
use crate::lab::Figure;

/// Renders a figure to a picture.
pub fn drawn(figure: &Figure) -> Image {
    match figure {
        Figure::Chart {
            studies,
            machine,
            look,
        } => pictures::chart_picture(studies, machine, *look),
        Figure::Growth(growth, look) => growth::growth_picture(growth, *look),
        Figure::Scaling(pictures, look) => scaling::scaling_picture(pictures, *look),
        Figure::Stability(maps) => atlas::stability_picture(maps),
    }
}
