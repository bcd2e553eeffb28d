//! The time of the day. The leg's own time never follows from it: a recording tells by it when it was made.

use web_time::SystemTime;

/// Tells the time, s since 1970; none where nothing knows it.
pub type WallClock = fn() -> Option<f64>;

/// The clock of the machine or of the browser.
#[must_use]
pub fn system() -> Option<f64> {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.ok().map(|since| since.as_secs_f64())
}
