//! Numbers of the command line, checked.

use leg_base::angles;
use std::ops::RangeInclusive;
use std::time::Duration;

/// The longest time that a command is given, s: a year.
const SECONDS_MAX: f64 = 31_536_000.0;

/// The longest lead of a path, s: an hour, of the three days in which the leg's count of ticks tells before from after.
const LEAD_MAX_S: f64 = 3600.0;

/// A finite number.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) => Err(format!("{value} is no finite number")),
        Err(_) => Err("it is no number".into()),
    }
}

/// A number in a range; `unit` begins with a space.
fn number_in_range(text: &str, range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if range.contains(&value) {
        return Ok(value);
    }
    let (start, end) = (range.start(), range.end());
    Err(format!("it is not within {start} to {end}{unit}"))
}

/// An azimuth, degrees: ten turns in either direction.
pub(crate) fn azimuth_deg(text: &str) -> Result<f64, String> {
    number_in_range(text, -3600.0..=3600.0, " degrees")
}

/// A tilt, degrees: what the model serves.
pub(crate) fn tilt_deg(text: &str) -> Result<f64, String> {
    number_in_range(text, -60.0..=60.0, " degrees")
}

/// A payload, kg: what the model serves.
pub(crate) fn payload_kg(text: &str) -> Result<f64, String> {
    number_in_range(text, 0.0..=1e6, " kg")
}

/// How far a leg is from the centre of a body of several, m.
pub(crate) fn radius_m(text: &str) -> Result<f64, String> {
    number_in_range(text, 0.01..=10.0, " m")
}

/// The mass of such a body, kg.
pub(crate) fn body_kg(text: &str) -> Result<f64, String> {
    number_in_range(text, 0.001..=1e3, " kg")
}

/// A time of the day, s since 1970: in a recording it is an integer of ns, of 64 bits.
pub(crate) fn unix_s(text: &str) -> Result<f64, String> {
    number_in_range(text, 0.0..=1.8e10, " s")
}

/// Telemetry of `leg monitor` per second, Hz.
pub(crate) fn monitor_rate_hz(text: &str) -> Result<f64, String> {
    number_in_range(text, 0.1..=100.0, " Hz")
}

/// A number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value > 0.0 => Ok(value),
        _ => Err("it is not above zero".into()),
    }
}

/// A number of at least zero.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        _ => Err("it is below zero".into()),
    }
}

/// A time above zero, s.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    time_up_to(text, SECONDS_MAX)
}

/// How long before its time a point is sent, s.
pub(crate) fn lead_s(text: &str) -> Result<Duration, String> {
    time_up_to(text, LEAD_MAX_S)
}

fn time_up_to(text: &str, max_s: f64) -> Result<Duration, String> {
    let seconds = finite(text)?;
    if seconds > 0.0 && seconds <= max_s {
        return Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string());
    }
    Err(format!("it is not above 0 and at most {max_s} s"))
}

/// The horizontal unit vector of an azimuth.
pub(crate) fn unit_vector(azimuth_deg: f64) -> [f32; 2] {
    angles::unit_vector(azimuth_deg).map(|component| component as f32)
}

/// The horizontal components of the direction of a pose.
pub(crate) fn direction(azimuth_deg: f64, tilt_deg: f64) -> [f32; 2] {
    angles::direction(azimuth_deg, tilt_deg).map(|component| component as f32)
}

#[cfg(test)]
mod tests {
    use super::{lead_s, seconds};
    use std::time::Duration;

    #[test]
    fn a_time_that_no_clock_holds_is_refused() {
        assert_eq!(seconds("1.5"), Ok(Duration::from_millis(1500)));
        for wrong in ["1e20", "1e9", "0", "-1", "inf", "NaN", "soon"] {
            assert!(seconds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_lead_that_the_count_of_ticks_does_not_hold_is_refused() {
        assert_eq!(lead_s("3600"), Ok(Duration::from_secs(3600)));
        for wrong in ["3601", "300000", "0", "-1"] {
            let range = "it is not above 0 and at most 3600 s";
            assert_eq!(lead_s(wrong), Err(range.into()), "{wrong}");
        }
    }
}
