//! The moments by which a payload is found: at rest those of now, on the way filtered alike, for the leg as it truly turns.

use super::{SLOW_STEP_S, filter::TripleLowPass};
use leg_model::Scalar;

/// Time constant of each of three low-pass filters in series, s. At 0.004 noise hides the payload of a leg with 13 N, whose mode is slow;
/// at 0.01 a payload is found later. `tests/suite/bench/moves.rs` holds both.
const FILTER_S: f32 = 0.006;

/// Horizontal moments (x, y) of a load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadMoments<T> {
    /// What neither the leg's own weight nor its inertia explains, N·m.
    pub excess: [T; 2],
    /// What 1 kg at the tip makes by its weight and its inertia, N·m/kg.
    pub per_kg: [T; 2],
    /// The same of a leg that turns as its trajectory asks: what is compared is weighted by it, for it has none of the noise that
    /// `per_kg` has and that would make a payload look lighter. At rest it is the same.
    pub asked_per_kg: [T; 2],
}

impl<T: Scalar> PayloadMoments<T> {
    /// Of a leg that turns as its trajectory asks.
    #[inline(always)]
    pub fn unfiltered(excess: [T; 2], per_kg: [T; 2]) -> Self {
        Self {
            excess,
            per_kg,
            asked_per_kg: per_kg,
        }
    }
}

/// The inertias that a turn accelerates, kg·m², and how far the leg is turned from its trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation<T> {
    /// About x and y, rad.
    pub turned: [T; 2],
    /// Inertia of the leg without a payload, kg·m².
    pub leg_inertia: T,
    /// That of 1 kg at the tip, kg·m²/kg.
    pub payload_inertia: T,
}

/// Filters of the moments of one axis.
#[derive(Clone, Copy, Debug)]
struct AxisFilters<T> {
    excess: TripleLowPass<T>,
    per_kg: TripleLowPass<T>,
    turned: TripleLowPass<T>,
}

/// Filters moments alike. A payload that is not known yet has the leg lag behind its trajectory: how far it is turned from there shows
/// how it truly accelerates, by the second derivative of the filter.
#[derive(Clone, Copy, Debug)]
pub struct MomentFilter<T> {
    axes: [AxisFilters<T>; 2],
    /// Whether the leg was on its way in the last step.
    runs: bool,
}

impl<T: Scalar> MomentFilter<T> {
    /// Before the first way.
    pub fn new() -> Self {
        let filter = TripleLowPass::new(FILTER_S, SLOW_STEP_S);
        let axis = AxisFilters {
            excess: filter,
            per_kg: filter,
            turned: filter,
        };
        Self {
            axes: [axis; 2],
            runs: false,
        }
    }

    /// The leg rests: the next way starts anew.
    #[inline(always)]
    pub fn rest(&mut self) {
        self.runs = false;
    }

    /// The moments of a leg on its way, by those of one that turns as its trajectory asks.
    #[inline(always)]
    pub fn step(
        &mut self,
        excess: [T; 2],
        per_kg: [T; 2],
        deviation: &Deviation<T>,
    ) -> PayloadMoments<T> {
        let starts = !core::mem::replace(&mut self.runs, true);
        let mut moments = PayloadMoments::unfiltered(excess, per_kg);
        for (i, axis) in self.axes.iter_mut().enumerate() {
            let turned = deviation.turned[i];
            if starts {
                axis.excess.set(excess[i]);
                axis.per_kg.set(per_kg[i]);
                axis.turned.set(turned);
            }
            axis.turned.step(turned);
            let acceleration =
                axis.turned.second_difference() * T::from(1.0 / (FILTER_S * FILTER_S));
            let asked_per_kg = axis.per_kg.step(per_kg[i]);
            moments.asked_per_kg[i] = asked_per_kg;
            moments.per_kg[i] = asked_per_kg - acceleration * deviation.payload_inertia;
            moments.excess[i] = axis.excess.step(excess[i]) + acceleration * deviation.leg_inertia;
        }
        moments
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Deviation, MomentFilter};
    use crate::control::SLOW_STEP_S;

    const LEG_INERTIA: f64 = 0.02;
    const PAYLOAD_INERTIA: f64 = 0.05;

    /// A leg with a payload lags ever more behind a trajectory that accelerates ever more: filtered, the moments agree on the payload, which
    /// those that the trajectory asks for do not.
    #[test]
    fn a_leg_that_lags_shows_its_payload() {
        let payload_kg = 1.5;
        let mut filter = MomentFilter::<f64>::new();
        let mut last = None;
        for i in 0..100 {
            let time_s = f64::from(i) * f64::from(SLOW_STEP_S);
            // The trajectory's acceleration, and how the leg is turned from it: by a part of what it should have turned.
            let asked = 20.0 * time_s;
            let turned = -0.4 * 20.0 * time_s.powi(3) / 6.0;
            let true_acceleration = 0.6 * asked;
            let shown = -(LEG_INERTIA + payload_kg * PAYLOAD_INERTIA) * true_acceleration;
            let excess = shown + LEG_INERTIA * asked;
            let deviation = Deviation {
                turned: [turned, -turned],
                leg_inertia: LEG_INERTIA,
                payload_inertia: PAYLOAD_INERTIA,
            };
            let per_kg = -PAYLOAD_INERTIA * asked;
            last = Some(filter.step([excess, -excess], [per_kg, -per_kg], &deviation));
            if i == 99 {
                assert!(excess / per_kg < 0.7 * payload_kg);
            }
        }
        let moments = last.unwrap();
        for i in 0..2 {
            let found_kg = moments.excess[i] / moments.per_kg[i];
            assert!((found_kg - payload_kg).abs() < 0.02, "{found_kg}");
            assert!(moments.asked_per_kg[i].abs() > 1.2 * moments.per_kg[i].abs());
        }
    }

    /// The second way knows nothing of the first.
    #[test]
    fn a_way_starts_anew() {
        let deviation = |turned| Deviation {
            turned: [turned, 0.0],
            leg_inertia: LEG_INERTIA,
            payload_inertia: PAYLOAD_INERTIA,
        };
        let mut filter = MomentFilter::<f64>::new();
        filter.step([1.0, 2.0], [3.0, 4.0], &deviation(0.5));
        filter.rest();
        let moments = filter.step([0.1, 0.2], [0.3, 0.4], &deviation(-0.1));
        for (found, expected) in [
            (moments.excess, [0.1, 0.2]),
            (moments.per_kg, [0.3, 0.4]),
            (moments.asked_per_kg, [0.3, 0.4]),
        ] {
            for i in 0..2 {
                assert!((found[i] - expected[i]).abs() < 1e-12);
            }
        }
    }
}
