//! Progress of long work, on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of `length` steps, named by what they are.
pub(crate) fn bar(length: u64, steps: &str) -> ProgressBar {
    let template = format!("{{bar:40}} {{pos}}/{{len}} {steps}, {{eta}} left");
    styled(ProgressBar::new(length), &template)
}

/// A spinner for work of unknown length, named by what it counts.
pub(crate) fn counter(steps: &str) -> ProgressBar {
    let template = format!("{{spinner}} {{pos}} {steps}, {{per_sec}}");
    styled(ProgressBar::new_spinner(), &template)
}

/// A spinner with a message.
pub(crate) fn message() -> ProgressBar {
    styled(ProgressBar::new_spinner(), "{spinner} {msg}")
}

fn styled(bar: ProgressBar, template: &str) -> ProgressBar {
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
