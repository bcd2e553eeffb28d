//! Numbers that a leg can be given.

use std::ops::RangeInclusive;
use std::time::Duration;

/// The longest time that a command is given, s: a year.
const SECONDS_MAX: f64 = 31_536_000.0;

fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) => Err(format!("{value} is no number that a leg can be given")),
        Err(_) => Err("it is no number".into()),
    }
}

fn within(value: f64, range: &RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    if range.contains(&value) {
        return Ok(value);
    }
    Err(format!(
        "it is not within {} to {} {unit}",
        range.start(),
        range.end()
    ))
}

/// An azimuth, degrees, within ten turns.
pub(super) fn azimuth_deg(text: &str) -> Result<f64, String> {
    within(finite(text)?, &(-3600.0..=3600.0), "degrees")
}

/// A tilt, degrees: what the model serves.
pub(super) fn tilt_deg(text: &str) -> Result<f64, String> {
    within(finite(text)?, &(-60.0..=60.0), "degrees")
}

/// A number above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value > 0.0 => Ok(value),
        _ => Err("it is not above zero".into()),
    }
}

/// A time above zero, s.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = within(positive(text)?, &(0.0..=SECONDS_MAX), "s")?;
    Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())
}

/// A number of at least zero.
pub(super) fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        _ => Err("it is below zero".into()),
    }
}

/// A unit vector towards an azimuth.
pub(super) fn towards(azimuth_deg: f64) -> [f32; 2] {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    [cos as f32, sin as f32]
}

/// The horizontal components of a direction.
pub(super) fn direction(azimuth_deg: f64, tilt_deg: f64) -> [f32; 2] {
    let sine = tilt_deg.to_radians().sin();
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    [(sine * cos) as f32, (sine * sin) as f32]
}

#[cfg(test)]
mod tests {
    use super::seconds;
    use std::time::Duration;

    #[test]
    fn a_time_that_no_clock_holds_is_refused() {
        assert_eq!(seconds("1.5"), Ok(Duration::from_millis(1500)));
        for wrong in ["1e20", "1e9", "0", "-1", "inf", "NaN", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }
}
