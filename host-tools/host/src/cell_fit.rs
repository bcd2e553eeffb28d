//! Calibration of a load cell by known weights.

use leg_firmware::sensors::CODE_MAX;

/// A weight on a load cell and what the cell then reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownWeight {
    /// N.
    pub newtons: f64,
    /// Mean of its codes.
    pub code: f64,
}

/// What a load cell's codes mean.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CellFit {
    /// Tension by code, N.
    pub n_per_code: f64,
    /// Code without tension.
    pub zero_code: f64,
    /// Greatest distance of a weight from what its code means, N.
    pub residual_n: f64,
}

/// Why weighings give no calibration.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CellFitError {
    /// One weight gives no zero and gain.
    #[error("two different weights are needed at least")]
    OneWeight,
    /// The code does not follow the weight.
    #[error("the cell's codes hardly change with the weight")]
    Dead,
    /// More weight is a lower code.
    #[error("more weight gives a lower code")]
    Reversed,
    /// A code is at an end of the range.
    #[error("a code is at an end of its range: the cell is saturated")]
    Saturated,
}

impl CellFitError {
    /// What to do about it.
    #[must_use]
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::OneWeight => "give more weights, as --weights 0,1,2,5",
            Self::Dead => "see that the weight hangs on this cell, and check its wiring",
            Self::Reversed => "swap the signal wires of the cell",
            Self::Saturated => "use smaller weights; check the cell's wiring and range",
        }
    }
}

/// Codes that a whole calibration has to span.
const SPAN_MIN: f64 = 50.0;

/// The straight line through weighings with the least squares of what the codes are off.
///
/// # Errors
/// A [`CellFitError`].
pub fn fit(weighings: &[KnownWeight]) -> Result<CellFit, CellFitError> {
    let count = weighings.len() as f64;
    let mean = |of: fn(&KnownWeight) -> f64| weighings.iter().map(of).sum::<f64>() / count;
    let (newtons, code) = (
        mean(|weighing| weighing.newtons),
        mean(|weighing| weighing.code),
    );
    let (mut spread, mut together, mut span) = (0.0, 0.0, 0.0_f64);
    for weighing in weighings {
        if weighing.code < 1.0 || weighing.code > f64::from(CODE_MAX) - 1.0 {
            return Err(CellFitError::Saturated);
        }
        let (heavier, higher) = (weighing.newtons - newtons, weighing.code - code);
        spread += heavier * heavier;
        together += heavier * higher;
        span = span.max(higher.abs());
    }
    if spread <= 0.0 {
        return Err(CellFitError::OneWeight);
    }
    if span < SPAN_MIN {
        return Err(CellFitError::Dead);
    }
    let codes_per_n = together / spread;
    if codes_per_n <= 0.0 {
        return Err(CellFitError::Reversed);
    }
    let n_per_code = codes_per_n.recip();
    let zero_code = code - newtons * codes_per_n;
    let off = |weighing: &KnownWeight| {
        ((weighing.code - zero_code) * n_per_code - weighing.newtons).abs()
    };
    Ok(CellFit {
        n_per_code,
        zero_code,
        residual_n: weighings.iter().map(off).fold(0.0, f64::max),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{CellFitError, KnownWeight, fit};

    fn weighings(codes: &[f64]) -> Vec<KnownWeight> {
        let weights = [0.0, 10.0, 20.0, 50.0];
        weights
            .into_iter()
            .zip(codes)
            .map(|(newtons, &code)| KnownWeight { newtons, code })
            .collect()
    }

    #[test]
    fn a_straight_cell_is_found_exactly() {
        let found = fit(&weighings(&[5000.0, 7500.0, 10_000.0, 17_500.0])).unwrap();
        assert!((found.n_per_code - 0.004).abs() < 1e-15);
        assert!((found.zero_code - 5000.0).abs() < 1e-9);
        assert!(found.residual_n < 1e-12);
    }

    #[test]
    fn a_bent_cell_shows_in_the_residual() {
        let found = fit(&weighings(&[5000.0, 7500.0, 10_000.0, 17_400.0])).unwrap();
        assert!(
            (0.05..0.4).contains(&found.residual_n),
            "{}",
            found.residual_n
        );
    }

    #[test]
    fn what_is_no_calibration_is_named() {
        let wrong = |codes: &[f64]| fit(&weighings(codes)).unwrap_err();
        assert_eq!(wrong(&[5000.0]), CellFitError::OneWeight);
        assert_eq!(wrong(&[]), CellFitError::OneWeight);
        assert_eq!(wrong(&[5000.0, 5001.0]), CellFitError::Dead);
        assert_eq!(wrong(&[9000.0, 8000.0]), CellFitError::Reversed);
        assert_eq!(wrong(&[5000.0, 65_520.0]), CellFitError::Saturated);
    }
}
