//! How far the true tip is from a path that was streamed.

use nalgebra::Vector3;

/// What was seen since the path began.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FollowError {
    ticks: u64,
    largest_m: f64,
    /// Error by velocity, and velocity by itself, summed up, m²/s and m²/s².
    error_by_velocity: f64,
    velocity_square: f64,
}

impl FollowError {
    /// Takes where the tip is off the path now, m, and how the path moves, m/s.
    pub fn take(&mut self, error_m: &Vector3<f64>, velocity_m_per_s: &Vector3<f64>) {
        self.ticks += 1;
        self.largest_m = self.largest_m.max(error_m.norm());
        self.error_by_velocity += error_m.dot(velocity_m_per_s);
        self.velocity_square += velocity_m_per_s.norm_squared();
    }

    /// The largest distance, mm; not a number before a path was streamed.
    pub fn largest_mm(&self) -> f64 {
        if self.ticks == 0 {
            return f64::NAN;
        }
        self.largest_m * 1000.0
    }

    /// The time by which the tip is behind, ms: that which leaves the least squares of the errors, to the first order. None is
    /// behind a path that stands.
    pub fn lag_ms(&self) -> f64 {
        if self.ticks > 0 && self.velocity_square == 0.0 {
            return 0.0;
        }
        -self.error_by_velocity / self.velocity_square * 1000.0
    }
}
