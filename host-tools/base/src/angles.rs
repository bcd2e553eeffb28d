//! Azimuth and tilt in degrees, as people give them, to components in frame {A}.

/// The horizontal unit vector at an azimuth.
#[must_use]
pub fn unit_vector(azimuth_deg: f64) -> [f64; 2] {
    let (sin, cos) = azimuth_deg.to_radians().sin_cos();
    [cos, sin]
}

/// The horizontal components of the leg's direction, a unit vector. A negative tilt is the opposite azimuth.
#[must_use]
pub fn direction(azimuth_deg: f64, tilt_deg: f64) -> [f64; 2] {
    let sine = tilt_deg.to_radians().sin();
    unit_vector(azimuth_deg).map(|component| sine * component)
}
