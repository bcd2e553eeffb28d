//! The payload by the moments that it makes: a Kalman filter of one state.

use super::bounds::{max, min};
use crate::settings::Settings;
use leg_model::Scalar;

/// Variance of a payload of which nothing is known, kg².
const UNKNOWN_KG2: f32 = 1.0;

/// How much that grows in a cycle where the payload shows, kg²: it is followed within a second.
const CHANGE_KG2: f32 = 7e-7;

/// The same where the payload hardly shows, kg²: it may be changed there, and nobody sees it. After five seconds nothing is known.
const HIDDEN_CHANGE_KG2: f32 = 1e-4;

/// Variance of a moment in a cycle, as a part of the square of that of 1 kg on a horizontal leg: a swing of 5 % over 0.05 s.
const NOISE_PART: f32 = 0.2;

/// The payload, kg, and its variance.
#[derive(Clone, Copy, Debug)]
pub struct PayloadEstimate<T> {
    /// Below zero where something lifts the leg.
    pub kg: T,
    variance_kg2: T,
    noise: T,
    /// Square of the moment of 1 kg, N·m/kg, from which the payload shows.
    shown: T,
    max_kg: T,
}

impl<T: Scalar> PayloadEstimate<T> {
    /// Nothing is known.
    pub fn new(settings: &Settings) -> Self {
        let estimation = &settings.estimation;
        let rig = &settings.rig;
        let lever = rig.gravity_m_per_s2 * (rig.joint_length_m + rig.leg_length_m);
        let shown = lever * estimation.payload_sine;
        Self {
            kg: T::zero(),
            variance_kg2: T::from(UNKNOWN_KG2),
            noise: T::from(NOISE_PART * lever * lever),
            shown: T::from(shown * shown),
            max_kg: estimation.payload_max_kg.into(),
        }
    }

    /// Nothing is known any more.
    pub fn forget(&mut self) {
        self.kg = T::zero();
        self.variance_kg2 = T::from(UNKNOWN_KG2);
    }

    /// By a moment, N·m, and that which 1 kg makes; gives by how much the payload has changed, kg. `immediate` takes what they show
    /// now.
    #[inline(always)]
    pub fn step(&mut self, [x, y]: [T; 2], [x_per_kg, y_per_kg]: [T; 2], immediate: bool) -> T {
        let before_kg = self.kg;
        let square = x_per_kg * x_per_kg + y_per_kg * y_per_kg;
        let product = x * x_per_kg + y * y_per_kg;
        if immediate {
            if square > self.shown {
                self.kg = product / square;
            }
        } else {
            let change = if square > self.shown {
                CHANGE_KG2
            } else {
                HIDDEN_CHANGE_KG2
            };
            let before = min(self.variance_kg2 + T::from(change), T::from(UNKNOWN_KG2));
            let gain = before / (square * before + self.noise);
            self.kg += gain * (product - self.kg * square);
            self.variance_kg2 = gain * self.noise;
        }
        self.kg = max(min(self.kg, self.max_kg), -self.max_kg);
        self.kg - before_kg
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::PayloadEstimate;
    use crate::settings::Settings;

    /// Moment of 1 kg on the paper's leg that leans by 20°, N·m/kg.
    const LEANING: [f64; 2] = [0.0, 0.735];

    fn estimate() -> PayloadEstimate<f64> {
        PayloadEstimate::new(&Settings::for_table_1().unwrap())
    }

    /// Cycles until an estimate is within 5 % of a payload that shows by a moment per kg.
    fn cycles(estimate: &mut PayloadEstimate<f64>, kg: f64, per_kg: [f64; 2]) -> u32 {
        let close = |now_kg: f64| (now_kg - kg).abs() < 0.05 * kg;
        (0..)
            .find(|_| {
                estimate.step(per_kg.map(|moment| moment * kg), per_kg, false);
                close(estimate.kg)
            })
            .unwrap()
    }

    /// A payload of which nothing is known is found within 0.1 s of a motion; one that has long been known takes a second to change.
    #[test]
    fn what_is_unknown_is_found_fast() {
        let mut estimate = estimate();
        let first = cycles(&mut estimate, 2.0, [0.0, 0.35]);
        assert!((20..300).contains(&first), "{first}");
        for _ in 0..20_000 {
            estimate.step(LEANING.map(|moment| 2.0 * moment), LEANING, false);
        }
        let changed = cycles(&mut estimate, 1.0, LEANING);
        assert!((1_500..8_000).contains(&changed), "{changed}");
    }

    /// At the vertical nothing shows a payload: the last one stands, and is ever less certain.
    #[test]
    fn at_the_vertical_the_last_one_stands() {
        let mut estimate = estimate();
        cycles(&mut estimate, 1.0, LEANING);
        let (known_kg, before) = (estimate.kg, estimate.variance_kg2);
        for _ in 0..10_000 {
            assert_eq!(estimate.step([0.5, 0.0], [0.0; 2], false), 0.0);
        }
        assert_eq!(estimate.kg, known_kg);
        assert!(estimate.variance_kg2 > before);
        estimate.step([0.5, 0.0], [0.0, 0.1], true);
        assert_eq!(estimate.kg, known_kg);
    }

    /// What would be more than the heaviest payload is a push.
    #[test]
    fn a_hard_push_is_no_payload() {
        for sign in [-1.0, 1.0] {
            let mut estimate = estimate();
            for _ in 0..5_000 {
                estimate.step([0.0, 5.0 * sign], LEANING, false);
            }
            assert_eq!(estimate.kg, 3.0 * sign);
            estimate.step([0.0, 5.0 * sign], LEANING, true);
            assert_eq!(estimate.kg, 3.0 * sign);
        }
    }
}
