//! A curve of few points through the loading branch of a test.

use super::branches::split;
use super::hysteresis::Hysteresis;
use super::{Row, TensileError, TensileTest};
use leg_model::{CURVE_POINTS_MAX, CurvePoint, Elasticity, TendonCurve};

/// Rows below this part of the largest force are slack, unless the user says otherwise.
const TAUT: f64 = 1e-3;

/// No more points are added when the curve is this near to every row, in parts of the largest elongation.
const NEAR: f64 = 1e-5;

/// How near to the limit of a rising curve a slope may be: three times the average between two points.
const STEEPNESS: f64 = 2.9;

/// What a test gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The points of the curve.
    pub points: Vec<CurvePoint<f64>>,
    /// The taut rows of the loading branch, their elongation from zero force.
    pub rows: Vec<Row>,
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
    /// taken up; from the first taut row the branch goes on to zero force in a straight line.
    ///
    /// # Errors
    /// A [`TensileError`] with the line.
    pub fn new(test: &TensileTest, taut_n: Option<f64>) -> Result<Self, TensileError> {
        let largest = test.rows.iter().map(|row| row.force_n).fold(0.0, f64::max);
        let taut_n = taut_n.unwrap_or(TAUT * largest).max(f64::MIN_POSITIVE);
        let branches = split(test, taut_n)?;
        let take_up_m = at_zero_force(&branches.loading);
        let shift = |rows: Vec<Row>| -> Vec<Row> {
            let shifted = rows.into_iter().map(|row| Row {
                elongation_m: row.elongation_m - take_up_m,
                ..row
            });
            shifted.collect()
        };
        let (rows, unloading) = (shift(branches.loading), shift(branches.unloading));
        let points = points(&rows)?;
        let curve = TendonCurve::new(&points).map_err(TensileError::NoCurve)?;
        let errors = errors(&curve, &rows)?;
        let squares = errors.iter().map(|error| error * error).sum::<f64>();
        Ok(Self {
            error_max_m: errors.iter().copied().fold(0.0, f64::max),
            error_rms_m: (squares / errors.len() as f64).sqrt(),
            hysteresis: Hysteresis::between(&rows, &unloading),
            points,
            rows,
            take_up_m,
            taut_n,
        })
    }
}

/// The elongation at which the first two rows' line reaches zero force, m.
fn at_zero_force(loading: &[Row]) -> f64 {
    match loading {
        [first, second, ..] => {
            let slope =
                (second.elongation_m - first.elongation_m) / (second.force_n - first.force_n);
            first.elongation_m - first.force_n * slope
        }
        _ => 0.0,
    }
}

/// The rows as points of a curve, thinned: the row farthest off is added until all are near.
fn points(rows: &[Row]) -> Result<Vec<CurvePoint<f64>>, TensileError> {
    let all = with_slopes(rows);
    let last = all.len() - 1;
    let near = NEAR * all[last].elongation_m;
    let mut chosen = vec![0, last];
    loop {
        let points = limited(chosen.iter().map(|&index| all[index]).collect());
        let curve = TendonCurve::new(&points).map_err(TensileError::NoCurve)?;
        let errors = errors(&curve, rows)?;
        let farthest = errors.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        // Row i is point i + 1: the first point is the slack tendon.
        let next = farthest
            .filter(|(_, error)| **error > near)
            .map(|(row, _)| row + 1);
        match next {
            Some(index) if chosen.len() < CURVE_POINTS_MAX && !chosen.contains(&index) => {
                chosen.push(index);
                chosen.sort_unstable();
            }
            _ => return Ok(points),
        }
    }
}

/// Zero and every row, with the slope that a curve through its neighbours has there (after Fritsch and Butland, 1984).
fn with_slopes(rows: &[Row]) -> Vec<CurvePoint<f64>> {
    let zero = (0.0, 0.0);
    let places: Vec<(f64, f64)> = [zero]
        .into_iter()
        .chain(rows.iter().map(|row| (row.force_n, row.elongation_m)))
        .collect();
    let width = |i: usize| places[i + 1].0 - places[i].0;
    let stiffness = |i: usize| width(i) / (places[i + 1].1 - places[i].1);
    let last = places.len() - 1;
    // The stiffness is the weighted mean of those beside it, the nearer one the heavier.
    let inner = |i: usize| {
        let (before, after) = (width(i - 1), width(i));
        (after * stiffness(i - 1) + before * stiffness(i)) / (before + after)
    };
    // At an end it goes on as it changed, but not below half of what is beside it.
    let end = |beside: f64, inner: f64| (2.0 * beside - inner).max(0.5 * beside);
    let at = |i: usize| match i {
        0 => end(stiffness(0), inner(1)),
        _ if i == last => end(stiffness(last - 1), inner(last - 1)),
        _ => inner(i),
    };
    let point = |(i, &(tension_n, elongation_m)): (usize, &(f64, f64))| CurvePoint {
        tension_n,
        elongation_m,
        stiffness_n_per_m: at(i),
    };
    places.iter().enumerate().map(point).collect()
}

/// The points with their stiffness raised where the curve would turn back between two of them.
fn limited(mut points: Vec<CurvePoint<f64>>) -> Vec<CurvePoint<f64>> {
    for i in 1..points.len() {
        let (before, after) = (points[i - 1], points[i]);
        let average =
            (after.tension_n - before.tension_n) / (after.elongation_m - before.elongation_m);
        for point in &mut points[i - 1..=i] {
            point.stiffness_n_per_m = point.stiffness_n_per_m.max(average / STEEPNESS);
        }
    }
    points
}

fn errors(curve: &TendonCurve<f64>, rows: &[Row]) -> Result<Vec<f64>, TensileError> {
    let error = |row: &Row| {
        let elongation = curve.elongation(row.force_n)?;
        Ok((elongation - row.elongation_m).abs())
    };
    let errors: Result<Vec<f64>, leg_model::Error> = rows.iter().map(error).collect();
    errors.map_err(TensileError::NoCurve)
}
