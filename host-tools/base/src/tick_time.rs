//! The time of ticks.

use leg_firmware::sensors::TICK_HZ;

/// Time of so many ticks, s.
#[must_use]
pub fn seconds(ticks: u64) -> f64 {
    // Divided, not multiplied: what is a short decimal stays one.
    ticks as f64 / f64::from(TICK_HZ)
}

/// Time of a tick, s.
#[must_use]
pub fn tick_s() -> f64 {
    1.0 / f64::from(TICK_HZ)
}
