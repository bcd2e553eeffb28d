//! Numbers that a leg can be given.

use std::ops::RangeInclusive;

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
