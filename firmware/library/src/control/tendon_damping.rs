//! What the damping of the tendons does while their tensions change.

use super::CYCLE_S;
use crate::settings::Settings;
use leg_model::Scalar;

/// A tendon of stiffness k and damping c follows the elongation of its tension with a time constant c/k: until then the damping carries
/// the rest of the tension.
#[derive(Clone, Copy, Debug)]
pub struct TendonDamping<T> {
    /// Damping by the time of a cycle, N/m.
    n_per_m: T,
    /// The part of what is new in an elongation that a tendon follows in a cycle.
    follows: [T; 3],
    /// The elongations that the tendons have, m.
    elongations_m: [T; 3],
    /// By how much these are larger than those of the tensions, m.
    damped_m: [T; 3],
}

impl<T: Scalar> TendonDamping<T> {
    /// At rest.
    pub fn new(settings: &Settings) -> Self {
        Self {
            n_per_m: T::from(settings.motion.tendon_damping_n_s_per_m / CYCLE_S),
            follows: [T::one(); 3],
            elongations_m: [T::zero(); 3],
            damped_m: [T::zero(); 3],
        }
    }

    /// At rest: until stiffnesses come, the tendons follow at once.
    pub fn rest(&mut self) {
        self.follows = [T::one(); 3];
        self.damped_m = [T::zero(); 3];
    }

    /// Takes the stiffnesses of the tendons from now on, N/m.
    #[inline(always)]
    pub fn set_stiffnesses(&mut self, stiffnesses_n_per_m: &[T; 3]) {
        for (follows, &stiffness) in self.follows.iter_mut().zip(stiffnesses_n_per_m) {
            *follows = stiffness / (stiffness + self.n_per_m);
        }
    }

    /// The elongations in a cycle with these by the tensions, m.
    #[inline(always)]
    pub fn step(&mut self, by_tensions_m: &[T; 3]) -> &[T; 3] {
        for (i, elongation) in self.elongations_m.iter_mut().enumerate() {
            *elongation += (by_tensions_m[i] - *elongation) * self.follows[i];
            self.damped_m[i] = *elongation - by_tensions_m[i];
        }
        &self.elongations_m
    }

    /// By how much the last ones are larger than those of the tensions, m.
    #[inline(always)]
    pub fn damped_m(&self) -> &[T; 3] {
        &self.damped_m
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{CYCLE_S, TendonDamping};
    use crate::settings::Settings;

    const STIFFNESSES: [f64; 3] = [15e3, 100e3, 200e3];

    /// The difference after a cycle with an elongation by all tensions, m.
    fn damped_m(damping: &mut TendonDamping<f64>, elongation_m: f64) -> [f64; 3] {
        let elongations_m = *damping.step(&[elongation_m; 3]);
        let damped_m = *damping.damped_m();
        for (damped, elongation) in damped_m.iter().zip(elongations_m) {
            assert!((elongation_m + damped - elongation).abs() < 1e-12);
        }
        damped_m
    }

    /// A tension that grows steadily stretches a tendon with a delay of c/k.
    #[test]
    fn a_tendon_is_behind_its_tension_by_its_time_constant() {
        let settings = Settings::table_1().unwrap();
        let mut damping = TendonDamping::<f64>::new(&settings);
        damping.set_stiffnesses(&STIFFNESSES);
        let n_s_per_m = f64::from(settings.motion.tendon_damping_n_s_per_m);
        let step_m = 1e-6;
        let ramp = (0..1000).map(|i| damped_m(&mut damping, f64::from(i) * step_m));
        for (stiffness, damped_m) in STIFFNESSES.iter().zip(ramp.last().unwrap()) {
            let expected_m = -step_m * n_s_per_m / stiffness / f64::from(CYCLE_S);
            let part = damped_m / expected_m;
            assert!((part - 1.0).abs() < 1e-6, "{damped_m} {expected_m}");
        }
    }

    /// At rest, without damping, and before a stiffness is known there is none.
    #[test]
    fn a_tension_that_stays_has_no_damping() {
        let mut settings = Settings::table_1().unwrap();
        let mut damping = TendonDamping::<f64>::new(&settings);
        assert_eq!(damped_m(&mut damping, 1e-3), [0.0; 3]);
        assert_eq!(damped_m(&mut damping, 2e-3), [0.0; 3]);
        damping.set_stiffnesses(&STIFFNESSES);
        assert_eq!(damped_m(&mut damping, 2e-3), [0.0; 3]);
        let [soft, _, stiff] = damped_m(&mut damping, 3e-3);
        assert!(soft < stiff && stiff < 0.0);
        damping.rest();
        assert_eq!(*damping.damped_m(), [0.0; 3]);
        assert_eq!(damped_m(&mut damping, 1e-3), [0.0; 3]);
        settings.motion.tendon_damping_n_s_per_m = 0.0;
        let mut damping = TendonDamping::<f64>::new(&settings);
        damping.set_stiffnesses(&STIFFNESSES);
        damped_m(&mut damping, 1e-3);
        let without_m = damped_m(&mut damping, 2e-3);
        assert!(without_m.iter().all(|damped_m| damped_m.abs() < 1e-12));
    }
}
