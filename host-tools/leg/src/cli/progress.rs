//! Progress of long work, on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of `length` steps, named by what they are.
pub(super) fn bar(length: u64, steps: &str) -> ProgressBar {
    let template = format!("{{bar:40}} {{pos}}/{{len}} {steps}, {{eta}} left");
    let bar = ProgressBar::new(length);
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A sign of life for work of unknown length, named by what it counts.
pub(super) fn spinner(steps: &str) -> ProgressBar {
    let template = format!("{{spinner}} {{pos}} {steps}, {{per_sec}}");
    let bar = ProgressBar::new_spinner();
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A sign of life that says what is going on.
pub(super) fn telling() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    match ProgressStyle::with_template("{spinner} {msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
