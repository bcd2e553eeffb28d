//! Random numbers that follow from a seed.

use fastrand::Rng;

/// A number of mean 0 and variance 1, close to normal: a sum of twelve even ones, whose bits are the same everywhere.
pub(super) fn gaussian(rng: &mut Rng) -> f64 {
    (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0
}

/// Random numbers of the defects: others than those of the sensors' noise, which a defect must not change.
pub(super) fn defect_rng(seed: u64) -> Rng {
    Rng::with_seed(seed ^ 0x6465_6665_6374)
}
