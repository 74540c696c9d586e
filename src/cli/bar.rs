//! How far work is, on a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Time after which work is worth a bar, and between looks at it.
pub const TICK: Duration = Duration::from_millis(100);

/// Work of which nobody counts the pieces.
pub const SHARE: &str = "{bar:32} {percent:>3} %  {eta} left";

/// A bar of so many steps. Draws to stderr, and only where that is a terminal.
pub fn progress_bar(length: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    restyle(&bar, template);
    bar
}

/// Lets a bar say something else.
pub fn restyle(bar: &ProgressBar, template: &str) {
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
}
