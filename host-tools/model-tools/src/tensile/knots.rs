//! Where the points of a curve are needed, and how many.

use super::spline::Spline;
use super::{TensileError, TestRow};
use leg_model::{CURVE_POINTS_MAX, TendonCurve};

/// The first point of a curve is the slack tendon; the others are knots.
const KNOTS_MAX: usize = CURVE_POINTS_MAX - 1;

/// A curve this near to the rows is near enough, in parts of the largest elongation.
const NEAR: f64 = 1e-5;

/// The spline with the lowest Bayesian information criterion: a close fit with few knots. Knots are added one by one where
/// the squared distances of the rows are largest.
pub(super) fn best(rows: &[TestRow]) -> Result<Spline, TensileError> {
    let mut best: Option<(f64, Spline)> = None;
    let mut refused = TensileError::TooNear;
    let mut knots = vec![0, rows.len() - 1];
    loop {
        let forces = knots.iter().map(|&row| rows[row].force_n).collect();
        let Some(spline) = Spline::nearest(rows, forces) else {
            break;
        };
        let squares = squares(&spline, rows);
        let score = criterion(&squares, knots.len(), rows);
        let better = best.as_ref().is_none_or(|(lowest, _)| score < *lowest);
        match TendonCurve::new(&spline.points()) {
            Ok(_) if better => best = Some((score, spline)),
            Ok(_) => {}
            Err(error) => refused = TensileError::NoCurve(error),
        }
        let next = (knots.len() < KNOTS_MAX).then(|| next(&knots, &squares));
        let Some(row) = next.flatten() else { break };
        knots.push(row);
        knots.sort_unstable();
    }
    best.map(|(_, spline)| spline).ok_or(refused)
}

fn squares(spline: &Spline, rows: &[TestRow]) -> Vec<f64> {
    let square = |row: &TestRow| (spline.elongation(row.force_n) - row.elongation_m).powi(2);
    rows.iter().map(square).collect()
}

/// The criterion of Schwarz (1978): lower is better. Each knot has an elongation and a slope.
fn criterion(squares: &[f64], knots: usize, rows: &[TestRow]) -> f64 {
    let largest = rows.last().map_or(0.0, |row| row.elongation_m) - rows[0].elongation_m;
    let count = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / count;
    count * mean.max((NEAR * largest).powi(2)).ln() + 2.0 * knots as f64 * count.ln()
}

/// The row that halves the squares of the piece that has most of them; none when no piece has a row inside.
fn next(knots: &[usize], squares: &[f64]) -> Option<usize> {
    let inner = |pair: &[usize]| (pair[0] + 1, pair[1]);
    let sum = |(start, end): (usize, usize)| squares[start..end].iter().sum::<f64>();
    let (start, end) = knots
        .windows(2)
        .map(inner)
        .filter(|(start, end)| start < end)
        .max_by(|a, b| sum(*a).total_cmp(&sum(*b)))?;
    let half = 0.5 * sum((start, end));
    let mut reached = 0.0;
    (start..end).find(|&row| {
        reached += squares[row];
        reached >= half
    })
}
