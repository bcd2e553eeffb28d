//! Numbers with their uncertainty, by least squares.

use nalgebra::{SMatrix, SVector};
use serde::Serialize;

/// A number and how far it may be off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UncertainValue {
    /// The number.
    pub value: f64,
    /// What 95 of 100 are off by at the most: twice the standard deviation, more where few equations tell that.
    pub uncertainty: f64,
}

impl UncertainValue {
    /// From a standard deviation.
    #[must_use]
    pub const fn new(value: f64, deviation: f64) -> Self {
        Self {
            value,
            uncertainty: 2.0 * deviation,
        }
    }

    /// The same in another unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            uncertainty: (self.uncertainty * factor).abs(),
        }
    }

    /// The product with another number that is independent of it.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            uncertainty: (self.uncertainty * other.value).hypot(other.uncertainty * self.value),
        }
    }

    /// The product with itself.
    #[must_use]
    pub fn squared(self) -> Self {
        Self {
            value: self.value.powi(2),
            uncertainty: (2.0 * self.value * self.uncertainty).abs(),
        }
    }

    /// The same number where its factor may be off by a part of it.
    #[must_use]
    pub fn widened(self, part: f64) -> Self {
        Self {
            uncertainty: self.uncertainty.hypot(part * self.value),
            ..self
        }
    }

    /// One divided by it.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self {
            value: self.value.recip(),
            uncertainty: self.uncertainty / self.value.powi(2),
        }
    }

    /// The mean with another number that is independent of it.
    #[must_use]
    pub fn mean(self, other: Self) -> Self {
        Self {
            value: 0.5 * (self.value + other.value),
            uncertainty: 0.5 * self.uncertainty.hypot(other.uncertainty),
        }
    }

    /// The mean with another number of the same fit, which may be off the same way.
    #[must_use]
    pub fn mean_of_one_fit(self, other: Self) -> Self {
        Self {
            value: 0.5 * (self.value + other.value),
            uncertainty: 0.5 * (self.uncertainty + other.uncertainty),
        }
    }

    /// The mean of what was measured again and again: as uncertain as the numbers themselves, or as they differ.
    #[must_use]
    pub fn mean_of_repeated(numbers: &[Self]) -> Self {
        let count = numbers.len().max(1) as f64;
        let value = numbers.iter().map(|one| one.value).sum::<f64>() / count;
        let own: f64 = numbers.iter().map(|one| one.uncertainty.powi(2)).sum();
        let apart: f64 = numbers.iter().map(|one| (one.value - value).powi(2)).sum();
        let free = numbers.len().saturating_sub(1).max(1);
        let deviation = (apart / (count * free as f64)).sqrt();
        let spread = 2.0 * student_part(free) * deviation;
        Self {
            value,
            uncertainty: (own.sqrt() / count).max(spread),
        }
    }

    /// Whether it is greater than what it may be off.
    #[must_use]
    pub fn is_certain(self) -> bool {
        self.uncertainty < self.value.abs()
    }

    /// Its uncertainty as a part of it.
    #[must_use]
    pub fn part(self) -> f64 {
        self.uncertainty / self.value.abs()
    }
}

/// One equation: the factors of the unknowns, and what their products sum up to.
pub(super) type Equation<const N: usize> = ([f64; N], f64);

/// By how much more than two standard deviations 95 of 100 numbers are off, where so many equations more than unknowns tell the
/// deviation: Student's t by the first terms of its series, within 3 % from two equations on; for one by a table.
fn student_part(free: usize) -> f64 {
    if free == 1 {
        return 12.706 / 2.0;
    }
    let one = 1.0 / free as f64;
    (1.960 + one * (2.372 + one * (2.823 + one * 2.556))) / 2.0
}

/// The unknowns that leave the smallest squares. `deviation` is the least that an equation is off by: what is left over may be
/// less by chance. None where the equations do not determine them.
pub(super) fn least_squares<const N: usize>(
    equations: &[Equation<N>],
    deviation: f64,
) -> Option<[UncertainValue; N]> {
    let mut normal = SMatrix::<f64, N, N>::zeros();
    let mut right = SVector::<f64, N>::zeros();
    for (factors, sum) in equations {
        let factors = SVector::from(*factors);
        normal += factors * factors.transpose();
        right += factors * *sum;
    }
    // Unknowns of very different size would hide that they are not determined.
    let scale = normal.diagonal().map(f64::sqrt);
    let scaled = SMatrix::<f64, N, N>::from_fn(|row, column| {
        normal[(row, column)] / (scale[row] * scale[column])
    });
    let inverse = scaled.cholesky()?.inverse();
    let unknowns: SVector<f64, N> = (inverse * right.component_div(&scale)).component_div(&scale);
    let squares = equations.iter().map(|(factors, sum)| {
        let left = sum - SVector::from(*factors).dot(&unknowns);
        left * left
    });
    let free = equations.len().checked_sub(N).filter(|&free| free > 0)?;
    let left = student_part(free) * (squares.sum::<f64>() / free as f64).sqrt();
    let left = left.max(deviation);
    let estimates = std::array::from_fn(|i| {
        UncertainValue::new(unknowns[i], left * inverse[(i, i)].sqrt() / scale[i])
    });
    let finite =
        |estimate: &UncertainValue| estimate.value.is_finite() && estimate.uncertainty.is_finite();
    estimates.iter().all(finite).then_some(estimates)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{UncertainValue, least_squares, student_part};

    #[test]
    fn a_line_through_points_is_found_with_its_uncertainty() {
        let points = [(0.0, 1.01), (1.0, 2.99), (2.0, 5.01), (3.0, 6.99)];
        let equations = points.map(|(x, y)| ([1.0, x], y));
        let [offset, slope] = least_squares(&equations, 0.0).unwrap();
        assert!((offset.value - 1.006).abs() < 1e-9, "{offset:?}");
        assert!((slope.value - 1.996).abs() < 1e-9, "{slope:?}");
        assert!((slope.value - 2.0).abs() < slope.uncertainty);
        // What each equation may be off by counts where little is left over.
        let [_, coarse] = least_squares(&equations, 0.2).unwrap();
        assert!(coarse.uncertainty > 5.0 * slope.uncertainty);
    }

    /// The quantiles of Student's t in any table.
    #[test]
    fn few_equations_tell_less() {
        for (free, quantile) in [
            (1, 12.706),
            (2, 4.303),
            (4, 2.776),
            (13, 2.160),
            (200, 1.972),
        ] {
            assert!((2.0 * student_part(free) / quantile - 1.0).abs() < 0.035);
        }
    }

    /// By numbers with noise, of which as many are off by more as is said.
    #[test]
    fn five_of_a_hundred_are_off_by_more() {
        let mut rng = fastrand::Rng::with_seed(1);
        let mut off = 0;
        for _ in 0..4000 {
            // The sum of twelve even numbers is as good as normal.
            let mut noise = || (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0;
            let equations: [_; 6] =
                std::array::from_fn(|i| ([1.0, i as f64], 3.0 + 2.0 * i as f64 + noise()));
            let [_, slope] = least_squares(&equations, 0.0).unwrap();
            off += u32::from((slope.value - 2.0).abs() > slope.uncertainty);
        }
        assert!((160..240).contains(&off), "{off}");
    }

    /// As many of three numbers that were measured again and again, whose own uncertainty says nothing.
    #[test]
    fn five_of_a_hundred_means_are_off_by_more() {
        let mut rng = fastrand::Rng::with_seed(2);
        for count in [2, 3, 4] {
            let mut off = 0;
            for _ in 0..4000 {
                let mut noise = || (0..12).map(|_| rng.f64()).sum::<f64>() - 6.0;
                let numbers: Vec<_> = (0..count)
                    .map(|_| UncertainValue::new(noise(), 0.0))
                    .collect();
                let mean = UncertainValue::mean_of_repeated(&numbers);
                off += u32::from(mean.value.abs() > mean.uncertainty);
            }
            assert!((160..240).contains(&off), "{count}: {off}");
        }
    }

    #[test]
    fn a_square_is_twice_as_uncertain_as_a_part_of_it() {
        let square = UncertainValue::new(3.0, 0.1).squared();
        assert!((square.part() - 0.4 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_determined_is_none() {
        let same = [([1.0, 2.0], 3.0); 5];
        assert_eq!(least_squares(&same, 0.1), None);
        assert_eq!(
            least_squares(&[([1.0, 0.0], 1.0), ([0.0, 1.0], 1.0)], 0.1),
            None
        );
    }
}
