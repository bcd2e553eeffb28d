//! What the tests across the crates share.

pub mod chip;
pub mod chip_bus;
pub mod chip_patches;
pub mod homed_chip;
pub mod panic_free;
pub mod python;
pub mod quoted_tests;
pub mod sources;
pub mod stalls;
pub mod unlike;

pub use leg_base::numeric;
pub use leg_model_tools::plain_vectors as reference;

use leg_boards::image::{FirmwareImage, workspace_root};
use leg_boards::qemu::{QemuConfig, QemuSession};
use leg_boards::setup;
use leg_model::{Error, Scalar, Tendon};
use serde_json::Value;

/// The firmware under QEMU; installs and builds first what is missing.
///
/// # Errors
/// What is missing and cannot be had.
pub fn qemu() -> Result<QemuSession, Box<dyn std::error::Error>> {
    setup::ensure_target(&mut |_| {})?;
    let qemu = setup::ensure_qemu(&mut |_| {})?;
    Ok(QemuSession::open(&QemuConfig::new(
        qemu,
        FirmwareImage::Qemu.build()?,
    ))?)
}

/// Requires words of a page of the repository, whatever the breaks of its lines.
///
/// # Panics
/// Where the page has not got them.
pub fn require_said(page: &str, words: &[String]) {
    let text = std::fs::read_to_string(workspace_root().join(page)).unwrap_or_default();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in words {
        assert!(text.contains(words), "{page} does not say: {words}");
    }
}

/// Memory of this process that is in use, MiB.
///
/// # Panics
/// Where the system has no /proc.
#[must_use]
pub fn memory_mib() -> f64 {
    proc_status("VmRSS:")
}

fn proc_status(key: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(key));
    let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse::<f64>().ok());
    match kib {
        Some(kib) => kib / 1024.0,
        None => panic!("/proc/self/status has no {key}"),
    }
}

/// Three tendons of one constant stiffness, N/m.
///
/// # Errors
/// A stiffness that no tendon has.
pub fn constant_tendons<T: Scalar>(stiffness_n_per_m: T) -> Result<[Tendon<T>; 3], Error> {
    Ok([Tendon::constant(stiffness_n_per_m)?; 3])
}

/// The numbers of a JSON value, those of nested arrays one after the other.
///
/// What is neither a number nor an array gives NaN, which is near to nothing.
#[must_use]
pub fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        _ => vec![value.as_f64().unwrap_or(f64::NAN)],
    }
}

/// The largest difference between two arrays, relative to the largest magnitude in `expected`.
///
/// An entry that should vanish is so judged beside its neighbours. Arrays of zeros are compared absolutely; arrays
/// of different lengths differ by infinity.
#[must_use]
pub fn difference(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let scale = expected
        .iter()
        .fold(0.0, |scale: f64, value| scale.max(value.abs()));
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let differences = found
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).abs() / scale);
    differences.fold(0.0, |largest: f64, next| {
        if next > largest || next.is_nan() {
            next
        } else {
            largest
        }
    })
}

#[cfg(test)]
mod tests {
    use super::difference;

    #[test]
    fn entries_are_judged_beside_the_largest() {
        assert_eq!(difference(&[1e-9, 2.0], &[0.0, 2.0]), 5e-10);
        assert_eq!(difference(&[1e-9], &[0.0]), 1e-9);
    }

    #[test]
    fn another_length_and_nan_are_far() {
        assert_eq!(difference(&[1.0], &[1.0, 0.0]), f64::INFINITY);
        assert!(difference(&[f64::NAN, 1.0], &[1.0, 1.0]).is_nan());
    }
}
