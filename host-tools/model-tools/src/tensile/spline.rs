//! The curve of least squares through rows: cubic between knots, smooth at them.

use super::TestRow;
use leg_model::CurvePoint;
use nalgebra::{DMatrix, DVector};

/// How much the bending of the curve counts beside the rows: next to nothing, but it decides what they leave open.
const BENDING: f64 = 1e-12;

/// Half the distance of Gauss's two points, in parts of the interval: they integrate a squared straight line exactly.
const GAUSS: f64 = 0.288_675_134_594_812_9;

/// Between two knots the slope at either stays below this multiple of the average, so that the curve rises (after Fritsch
/// and Carlson, 1980; the model refuses 3).
const STEEPEST: f64 = 2.9;

/// The smallest slope at a knot, as a part of the smaller average beside it.
const FLATTEST: f64 = 0.1;

/// Elongation over force.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spline {
    /// Where the pieces join, N, rising.
    knots: Vec<f64>,
    /// Elongation there, m.
    elongations: Vec<f64>,
    /// Slope of the elongation there, m/N.
    slopes: Vec<f64>,
}

impl Spline {
    /// The spline nearest to the rows, with slopes kept where it rises. None when the rows do not settle it.
    pub(super) fn nearest(rows: &[TestRow], knots: Vec<f64>) -> Option<Self> {
        let [first, .., last] = knots[..] else {
            return None;
        };
        // All unknowns are lengths then.
        let unit = last - first;
        let mut equations = Vec::new();
        for row in rows {
            let (piece, place, width) = locate(&knots, row.force_n);
            let weights = value_weights(place, width / unit);
            equations.push(equation(2 * piece, weights, row.elongation_m, 1.0));
        }
        let bending = BENDING * rows.len() as f64;
        for piece in 0..knots.len() - 1 {
            let width = (knots[piece + 1] - knots[piece]) / unit;
            for place in [0.5 - GAUSS, 0.5 + GAUSS] {
                let weights = bending_weights(place, width);
                equations.push(equation(2 * piece, weights, 0.0, bending * 0.5 * width));
            }
        }
        let solution = solve(&equations, 2 * knots.len())?;
        let (elongations, slopes) = solution
            .as_slice()
            .chunks_exact(2)
            .map(|pair| (pair[0], pair[1] / unit))
            .unzip();
        let spline = Self {
            knots,
            elongations,
            slopes,
        };
        Some(spline.rising())
    }

    fn rising(mut self) -> Self {
        let average = |i: usize| {
            (self.elongations[i + 1] - self.elongations[i]) / (self.knots[i + 1] - self.knots[i])
        };
        let averages: Vec<f64> = (0..self.knots.len() - 1).map(average).collect();
        for (i, slope) in self.slopes.iter_mut().enumerate() {
            let neighbours = &averages[i.saturating_sub(1)..averages.len().min(i + 1)];
            let smaller = neighbours.iter().copied().fold(f64::INFINITY, f64::min);
            *slope = slope.min(STEEPEST * smaller).max(FLATTEST * smaller);
        }
        self
    }

    /// Elongation at a force between the first knot and the last, m.
    pub(super) fn elongation(&self, force_n: f64) -> f64 {
        let (piece, place, width) = locate(&self.knots, force_n);
        let [e0, s0, e1, s1] = value_weights(place, width);
        e0 * self.elongations[piece]
            + s0 * self.slopes[piece]
            + e1 * self.elongations[piece + 1]
            + s1 * self.slopes[piece + 1]
    }

    /// The elongation at which the straight line through the first knot reaches zero force, m.
    pub(super) fn elongation_at_zero_force_m(&self) -> f64 {
        self.elongations[0] - self.knots[0] * self.slopes[0]
    }

    /// The points of the curve that goes on in that line to zero force, and counts its elongation from there.
    pub(super) fn points(&self) -> Vec<CurvePoint<f64>> {
        let zero = self.elongation_at_zero_force_m();
        let point = |tension_n: f64, elongation_m: f64, slope: f64| CurvePoint {
            tension_n,
            elongation_m,
            stiffness_n_per_m: slope.recip(),
        };
        let slack = point(0.0, 0.0, self.slopes[0]);
        let knots = self.knots.iter().zip(&self.elongations).zip(&self.slopes);
        let taut =
            knots.map(|((&knot, &elongation), &slope)| point(knot, elongation - zero, slope));
        [slack].into_iter().chain(taut).collect()
    }
}

/// The piece of a force, where in it (0 to 1), and how wide it is.
fn locate(knots: &[f64], force_n: f64) -> (usize, f64, f64) {
    let inner = &knots[1..knots.len() - 1];
    let piece = inner.partition_point(|knot| *knot <= force_n);
    let width = knots[piece + 1] - knots[piece];
    (piece, (force_n - knots[piece]) / width, width)
}

/// What elongation and slope at the two ends of a piece add to the elongation in it.
fn value_weights(s: f64, width: f64) -> [f64; 4] {
    let end = s * s * (3.0 - 2.0 * s);
    let (rest, inner) = (1.0 - s, s * (1.0 - s));
    [1.0 - end, width * inner * rest, end, -width * inner * s]
}

/// The same for the second derivative.
fn bending_weights(s: f64, width: f64) -> [f64; 4] {
    let end = (6.0 - 12.0 * s) / (width * width);
    [-end, (6.0 * s - 4.0) / width, end, (6.0 * s - 2.0) / width]
}

/// An equation of weighted least squares: the unknown that it begins at, the weights of that and the next ones, its value.
type Equation = (usize, [f64; 4], f64);

/// An equation whose squared error counts `importance` times.
fn equation(first: usize, weights: [f64; 4], value: f64, importance: f64) -> Equation {
    let root = importance.sqrt();
    (first, weights.map(|weight| root * weight), root * value)
}

/// The solution of least squares, by orthogonal factors: normal equations would lose the bending in rounding.
fn solve(equations: &[Equation], unknowns: usize) -> Option<DVector<f64>> {
    let mut matrix = DMatrix::zeros(equations.len(), unknowns);
    for (i, (first, weights, _)) in equations.iter().enumerate() {
        for (j, weight) in weights.iter().enumerate() {
            matrix[(i, first + j)] = *weight;
        }
    }
    let values = equations.iter().map(|(.., value)| *value);
    let mut right = DVector::from_iterator(equations.len(), values);
    let factors = matrix.qr();
    factors.q_tr_mul(&mut right);
    let right = right.rows(0, unknowns).into_owned();
    let solution = factors.r().solve_upper_triangular(&right)?;
    let finite = solution.iter().all(|value| value.is_finite());
    finite.then_some(solution)
}
