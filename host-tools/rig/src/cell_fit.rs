//! A load cell by known weights: the line through what its codes were under them.

use leg_base::failure::Failure;
use leg_firmware::sensors::CODE_MAX;

/// How far a weight may be off the straight line, as a part of the heaviest.
const RESIDUAL_PART: f64 = 0.01;

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

impl CellFit {
    /// Fails where no straight line explains the weights of a cell, 1 to 3: one was not what was said, or hung somewhere else.
    ///
    /// # Errors
    /// That [`Failure`].
    pub fn require_straight(&self, cell: u8, weighings: &[KnownWeight]) -> Result<(), Failure> {
        let newtons = weighings.iter().map(|weighing| weighing.newtons);
        if self.residual_n <= RESIDUAL_PART * newtons.fold(0.0, f64::max) {
            return Ok(());
        }
        Err(Failure::failed(
            format!(
                "load cell {cell} is off a straight line by {:.3} N, more than {} % of the heaviest weight",
                self.residual_n,
                RESIDUAL_PART * 100.0
            ),
            "hang the weights again, in the order in which they were given; nothing was set",
        ))
    }
}

/// Codes that a whole calibration has to span.
const SPAN_MIN: f64 = 50.0;

/// One weight does not determine both zero and gain.
pub fn too_few_weights() -> Failure {
    Failure::refused(
        "two different weights are needed at least",
        "give more weights, as --weights 0,1,2,5",
    )
}

/// Fits a straight line to weighings by the least squares of the codes' errors. Weighings that determine no line are refused.
pub fn fit(weighings: &[KnownWeight]) -> Result<CellFit, Failure> {
    let count = weighings.len() as f64;
    let mean = |of: fn(&KnownWeight) -> f64| weighings.iter().map(of).sum::<f64>() / count;
    let (newtons, code) = (mean(|one| one.newtons), mean(|one| one.code));
    let (mut variance, mut covariance, mut span) = (0.0, 0.0, 0.0_f64);
    for weighing in weighings {
        if weighing.code < 1.0 || weighing.code > f64::from(CODE_MAX) - 1.0 {
            return Err(Failure::refused(
                "a code is at an end of its range: the cell is saturated",
                "use smaller weights; check the cell's wiring and range",
            ));
        }
        let (newtons, code) = (weighing.newtons - newtons, weighing.code - code);
        variance += newtons * newtons;
        covariance += newtons * code;
        span = span.max(code.abs());
    }
    if variance <= 0.0 {
        return Err(too_few_weights());
    }
    if span < SPAN_MIN {
        return Err(Failure::refused(
            "the cell's codes hardly change with the weight",
            "see that the weight hangs on this cell, and check its wiring",
        ));
    }
    let codes_per_n = covariance / variance;
    if codes_per_n <= 0.0 {
        return Err(Failure::refused(
            "more weight gives a lower code",
            "swap the signal wires of the cell",
        ));
    }
    let n_per_code = codes_per_n.recip();
    let zero_code = code - newtons * codes_per_n;
    let residual_n = |one: &KnownWeight| ((one.code - zero_code) * n_per_code - one.newtons).abs();
    Ok(CellFit {
        n_per_code,
        zero_code,
        residual_n: weighings.iter().map(residual_n).fold(0.0, f64::max),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{KnownWeight, fit};

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
        for (codes, expected) in [
            (&[5000.0][..], "two different weights are needed at least"),
            (&[], "two different weights are needed at least"),
            (
                &[5000.0, 5001.0],
                "the cell's codes hardly change with the weight",
            ),
            (&[9000.0, 8000.0], "more weight gives a lower code"),
            (
                &[5000.0, 65_520.0],
                "a code is at an end of its range: the cell is saturated",
            ),
        ] {
            assert_eq!(fit(&weighings(codes)).unwrap_err().to_string(), expected);
        }
    }
}
