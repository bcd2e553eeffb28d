//! Numbers without what nobody reads.

/// The nearest number of so many decimals, without the sign of a zero.
#[must_use]
pub fn rounded(value: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (value * scale).round() / scale + 0.0
}
