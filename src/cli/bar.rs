//! Progress bars on a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Delay before a bar is shown, and interval between its updates.
pub const TICK: Duration = Duration::from_millis(100);

/// Template for work without countable steps.
pub const SHARE_TEMPLATE: &str = "{bar:32} {percent:>3} %  {eta} left";

/// A bar of `length` steps. Draws to stderr, and only if that is a terminal.
pub fn progress_bar(length: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    restyle(&bar, template);
    bar
}

/// Changes the template of a bar.
pub fn restyle(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}
