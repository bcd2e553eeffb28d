//! Azimuth and tilt in degrees, as people give them, to components in frame {A} and back. The functions are those of `libm`:
//! the same bits on every system.

/// The horizontal unit vector at an azimuth.
#[must_use]
pub fn unit_vector(azimuth_deg: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(azimuth_deg.to_radians());
    [cos, sin]
}

/// The horizontal components of the leg's direction, a unit vector. A negative tilt is the opposite azimuth.
#[must_use]
pub fn direction(azimuth_deg: f64, tilt_deg: f64) -> [f64; 2] {
    let sine = libm::sin(tilt_deg.to_radians());
    unit_vector(azimuth_deg).map(|component| sine * component)
}

/// Azimuth (0 to 360) and tilt of a direction, degrees, to a ten-thousandth.
#[must_use]
pub fn angles_deg([x, y]: [f64; 2]) -> [f64; 2] {
    let tilt_deg = libm::asin(libm::hypot(x, y).min(1.0)).to_degrees();
    let azimuth_deg = libm::atan2(y, x).to_degrees().rem_euclid(360.0);
    [azimuth_deg, tilt_deg].map(|deg| (deg * 1e4).round() / 1e4)
}
