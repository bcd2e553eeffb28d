//! The payload by the moments that it makes: a Kalman filter of one state.

use super::bounds::{max, min};
use crate::settings::Settings;
use leg_model::Scalar;

/// Variance of a payload of which nothing is known, kg².
const UNKNOWN_KG2: f32 = 1.0;

/// How much that grows in a cycle while nothing shows the payload, kg²: after three minutes at the vertical nothing is known.
const CHANGE_KG2: f32 = 7e-7;

/// Variance of a moment in a cycle, as a part of the square of that of 1 kg on a horizontal leg: a swing of 5 % over 0.05 s.
const NOISE_PART: f32 = 0.2;

/// The payload, kg, and its variance.
#[derive(Clone, Copy, Debug)]
pub struct PayloadEstimate<T> {
    /// Below zero where something lifts the leg.
    pub kg: T,
    variance_kg2: T,
    noise: T,
    /// Square of the moment of 1 kg, N·m/kg, from which the payload is taken at once.
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
            let before = min(
                self.variance_kg2 + T::from(CHANGE_KG2),
                T::from(UNKNOWN_KG2),
            );
            let gain = before / (square * before + self.noise);
            self.kg += gain * (product - self.kg * square);
            self.variance_kg2 = gain * self.noise;
        }
        self.kg = max(min(self.kg, self.max_kg), -self.max_kg);
        self.kg - before_kg
    }
}
