//! The lab: time against error of every way of tracing the open scene, each a dot that can be looked
//! at and adopted.

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

pub use atlas::stability_picture;
pub use growth::growth_picture;
pub use panel::{Lab, LabRequest};
pub use pictures::chart_picture;
pub use scaling::scaling_picture;
