//! The frequency of a decaying oscillation.

use super::estimate::{Equation, UncertainValue, least_squares};
use std::f64::consts::TAU;

/// What is searched: frequencies, Hz, and rates of decay as a part of the angular frequency.
const LOWEST_HZ: f64 = 2.0;
const HIGHEST_HZ: f64 = 60.0;
const STEPS: u32 = 120;
const DAMPINGS: [f64; 5] = [0.01, 0.03, 0.07, 0.15, 0.3];

/// Corrections of the best of them; each about squares what it is off by.
const CORRECTIONS: u32 = 20;

/// A decaying oscillation about a mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// The frequency without damping, Hz.
    pub frequency_hz: UncertainValue,
    /// Rate of decay as a part of the angular frequency.
    pub damping: UncertainValue,
    /// Amplitude at the start.
    pub amplitude: f64,
    /// What is left over, root mean square.
    pub noise: f64,
    numbers: Numbers,
}

/// Mean, cosine and sine at the start, rate of decay 1/s, angular frequency rad/s.
type Numbers = [f64; 5];

impl Ring {
    /// The oscillation of points (s, value) that decays; none where there is no such.
    #[must_use]
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let mut numbers = coarse(points)?;
        for _ in 0..CORRECTIONS {
            let correction = least_squares(&equations(points, &numbers), 0.0)?;
            for (number, by) in numbers.iter_mut().zip(correction) {
                *number += by.value;
            }
        }
        let corrections = least_squares(&equations(points, &numbers), 0.0)?;
        let [_, _, _, decay_off, angular_off] = corrections.map(|left| 0.5 * left.uncertainty);
        let [_, cosine, sine, decay, angular] = numbers;
        let natural = angular.hypot(decay);
        let left = |&(time, value): &(f64, f64)| (value - value_at(&numbers, time)).powi(2);
        let noise = (points.iter().map(left).sum::<f64>() / points.len() as f64).sqrt();
        let found = angular > TAU * LOWEST_HZ && angular < TAU * HIGHEST_HZ && decay > 0.0;
        found.then_some(Self {
            frequency_hz: UncertainValue::new(natural / TAU, angular_off / TAU),
            damping: UncertainValue::new(decay / natural, decay_off / natural),
            amplitude: cosine.hypot(sine),
            noise,
            numbers,
        })
    }

    /// What it is at a time, s.
    #[must_use]
    pub fn value(&self, time_s: f64) -> f64 {
        value_at(&self.numbers, time_s)
    }
}

/// The best of the searched ones.
fn coarse(points: &[(f64, f64)]) -> Option<Numbers> {
    let mut best: Option<(f64, Numbers)> = None;
    for step in 0..=STEPS {
        let part = f64::from(step) / f64::from(STEPS);
        let angular = TAU * LOWEST_HZ * (HIGHEST_HZ / LOWEST_HZ).powf(part);
        for damping in DAMPINGS {
            let decay = damping * angular;
            let shapes = points.iter().map(|&(time, value)| {
                let [cosine, sine] = shape(decay, angular, time);
                ([1.0, cosine, sine], value)
            });
            let equations: Vec<Equation<3>> = shapes.collect();
            let Some(found) = least_squares(&equations, 0.0) else {
                continue;
            };
            let [mean, cosine, sine] = found.map(|estimate| estimate.value);
            let numbers = [mean, cosine, sine, decay, angular];
            let squares = points
                .iter()
                .map(|&(time, value)| (value - value_at(&numbers, time)).powi(2))
                .sum();
            if best.is_none_or(|(least, _)| squares < least) {
                best = Some((squares, numbers));
            }
        }
    }
    best.map(|(_, numbers)| numbers)
}

fn shape(decay: f64, angular: f64, time: f64) -> [f64; 2] {
    let size = (-decay * time).exp();
    let (sine, cosine) = (angular * time).sin_cos();
    [size * cosine, size * sine]
}

fn value_at([mean, a, b, decay, angular]: &Numbers, time: f64) -> f64 {
    let [cosine, sine] = shape(*decay, *angular, time);
    mean + a * cosine + b * sine
}

/// By how much each number has to change, to first order.
fn equations(points: &[(f64, f64)], numbers: &Numbers) -> Vec<Equation<5>> {
    let [_, a, b, decay, angular] = *numbers;
    let equation = |&(time, value): &(f64, f64)| {
        let [cosine, sine] = shape(decay, angular, time);
        let by_decay = -time * (a * cosine + b * sine);
        let by_angular = time * (b * cosine - a * sine);
        let left = value - value_at(numbers, time);
        ([1.0, cosine, sine, by_decay, by_angular], left)
    };
    points.iter().map(equation).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Ring;
    use std::f64::consts::TAU;

    /// Frequency, damping, amplitude and noise.
    fn points(hz: f64, damping: f64, amplitude: f64, noise: f64) -> Vec<(f64, f64)> {
        let mut rng = fastrand::Rng::with_seed(1);
        let angular = TAU * hz * (1.0 - damping * damping).sqrt();
        let decay = TAU * hz * damping;
        (0..200)
            .map(|i| {
                let time = 2e-3 * f64::from(i);
                let ring = (-decay * time).exp() * (angular * time + 0.4).cos();
                (time, 50.0 + amplitude * ring + noise * (rng.f64() - 0.5))
            })
            .collect()
    }

    #[test]
    fn a_ring_is_found_in_noise() {
        for (hz, damping) in [(5.0, 0.02), (11.3, 0.09), (14.0, 0.15), (31.0, 0.05)] {
            let ring = Ring::fit(&points(hz, damping, 0.5, 0.17)).unwrap();
            let found = ring.frequency_hz;
            println!("{hz} {damping}: {ring:?}");
            assert!((found.value / hz - 1.0).abs() < 0.02, "{found:?}");
            assert!((found.value - hz).abs() < 2.0 * found.uncertainty);
            assert!((ring.noise - 0.05).abs() < 0.02);
        }
    }

    #[test]
    fn noise_alone_is_no_ring_that_is_certain() {
        let ring = Ring::fit(&points(10.0, 0.1, 0.0, 0.17));
        assert!(ring.is_none_or(|ring| ring.amplitude < 0.2 || ring.damping.part() > 0.3));
    }
}
