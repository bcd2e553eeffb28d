//! A curve of few points through the loading branch of a test.

use super::branches::split;
use super::hysteresis::Hysteresis;
use super::knots;
use super::{TensileError, TestRow};
use leg_model::{CurvePoint, Elasticity, TendonCurve};

/// Rows below this part of the largest force are slack, unless the user says otherwise.
const TAUT: f64 = 1e-3;

/// What a test gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The points of the curve.
    pub points: Vec<CurvePoint<f64>>,
    /// The taut rows of the loading branch, their elongation from zero force.
    pub rows: Vec<TestRow>,
    /// Elongation before the tendon was taut, m.
    pub take_up_m: f64,
    /// The force from which it is taken as taut, N.
    pub taut_n: f64,
    /// Largest distance of a row from the curve, m.
    pub error_max_m: f64,
    /// Root of the mean square distance, m.
    pub error_rms_m: f64,
    /// What is lost on the way back; none without an unloading branch.
    pub hysteresis: Option<Hysteresis>,
}

impl Fit {
    /// Fits a curve. Rows below `taut_n` (N; a thousandth of the largest force if left out) are the slack that is
    /// taken up; below the first taut row the curve goes on to zero force in a straight line.
    ///
    /// # Errors
    /// A [`TensileError`] with the line.
    pub fn new(test: &[TestRow], taut_n: Option<f64>) -> Result<Self, TensileError> {
        let largest = test.iter().map(|row| row.force_n).fold(0.0, f64::max);
        let pushed = test.iter().find(|row| row.force_n < 0.0);
        if let Some(row) = pushed.filter(|_| largest <= 0.0) {
            return Err(TensileError::Compression(row.line));
        }
        let taut_n = taut_n.unwrap_or(TAUT * largest).max(f64::MIN_POSITIVE);
        let branches = split(test, taut_n)?;
        let spline = knots::best(&branches.loading)?;
        let points = spline.points();
        let curve = TendonCurve::new(&points).map_err(TensileError::NoCurve)?;
        let take_up_m = spline.elongation_at_zero_force_m();
        let rows = shifted(branches.loading, take_up_m);
        let unloading = shifted(branches.unloading, take_up_m);
        let errors = errors(&curve, &rows)?;
        let squares = errors.iter().map(|error| error * error).sum::<f64>();
        Ok(Self {
            error_max_m: errors.iter().copied().fold(0.0, f64::max),
            error_rms_m: (squares / errors.len() as f64).sqrt(),
            hysteresis: Hysteresis::new(&curve, &unloading).map_err(TensileError::NoCurve)?,
            points,
            rows,
            take_up_m,
            taut_n,
        })
    }
}

/// The rows with their elongation from zero force.
fn shifted(rows: Vec<TestRow>, take_up_m: f64) -> Vec<TestRow> {
    let shift = |row: TestRow| TestRow {
        elongation_m: row.elongation_m - take_up_m,
        ..row
    };
    rows.into_iter().map(shift).collect()
}

fn errors(curve: &TendonCurve<f64>, rows: &[TestRow]) -> Result<Vec<f64>, TensileError> {
    let error = |row: &TestRow| {
        let elongation = curve.elongation(row.force_n)?;
        Ok((elongation - row.elongation_m).abs())
    };
    let errors: Result<Vec<f64>, leg_model::Error> = rows.iter().map(error).collect();
    errors.map_err(TensileError::NoCurve)
}
