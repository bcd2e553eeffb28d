//! The payload by the moments that it makes: a Kalman filter of one state.

use super::bounds::{clamp_symmetric, max, min};
use crate::settings::Settings;
use leg_model::Scalar;

/// Gravity by which moments are judged, whatever that of the rig is: where a payload weighs nothing it shows by its inertia alone.
const EARTH_M_PER_S2: f32 = 9.81;

/// Sine of the tilt from which a leg at rest shows its payload: 8.6°. At 0.03 a leg that leans by 5° still estimates 0.4 kg of a payload
/// that was taken off; at 0.4 one that leans by 20° sags farther than its bar when a payload changes. `tests/suite/sim/station.rs` holds
/// both.
const SHOWN_SINE: f32 = 0.15;

/// Variance of a payload of which nothing is known, kg²: a deviation of half of the 2 kg that the paper's leg carries. At 0.05 it is found
/// so late in a move that the tip leaves its trajectory, at 20 what a leg has unlike its settings is taken for it and moves the tip.
/// `tests/suite/bench/moves.rs` holds both.
const UNKNOWN_KG2: f32 = 1.0;

/// How much that grows in a cycle of a leg at rest, kg²: a payload of a leg that leans by 15° is followed with a
/// time constant of 0.3 s.
const CHANGE_KG2: f32 = 1e-5;

/// The same where nothing shows the payload, kg²: after two seconds it may have been changed.
const HIDDEN_CHANGE_KG2: f32 = 1e-4;

/// The same of a leg that moves, kg²: then the friction of joint and tendons looks like a payload.
const MOVING_CHANGE_KG2: f32 = 7e-7;

/// Variance of a moment in a cycle, as a part of the square of that of 1 kg on a horizontal leg: a swing of 5 % over 0.05 s.
const NOISE_PART: f32 = 0.2;

/// Part of its variance, 1/kg, that is added to a payload for the inertia that is moved: where nothing has shown it, half of the 2 kg that
/// the paper's leg carries is in the middle of what it may be. `tests/suite/bench/moves.rs` holds what that saves.
const MOVED_PART: f32 = 0.7;

/// The payload, kg, and its variance.
#[derive(Clone, Copy, Debug)]
pub struct PayloadEstimate<T> {
    /// Below zero where something lifts the leg.
    pub kg: T,
    variance_kg2: T,
    noise: T,
    /// Square of the moment of 1 kg, N·m/kg, from which the payload shows.
    shown: T,
    /// What the tendons could hold at the farthest tilt; what pulls harder is a push.
    max_kg: T,
}

impl<T: Scalar> PayloadEstimate<T> {
    /// Nothing is known.
    pub fn new(settings: &Settings) -> Self {
        let rig = &settings.rig;
        let lever = EARTH_M_PER_S2 * (rig.joint_length_m + rig.leg_length_m);
        let shown = lever * SHOWN_SINE;
        let anchors = &rig.leg_anchors_m;
        let reach_m: f32 = anchors
            .iter()
            .map(|[x, y]| Scalar::sqrt(x * x + y * y))
            .sum();
        let held_nm = 0.5 * reach_m * settings.f_max_n;
        Self {
            kg: T::zero(),
            variance_kg2: T::from(UNKNOWN_KG2),
            noise: T::from(NOISE_PART * lever * lever),
            shown: T::from(shown * shown),
            max_kg: T::from(held_nm / (lever * settings.tilt_max_sine)),
        }
    }

    /// The standard deviation, kg.
    #[inline(always)]
    pub fn deviation_kg(&self) -> T {
        self.variance_kg2.sqrt()
    }

    /// The payload whose inertia is moved, kg: by what may be hidden more than what is known. Nothing weighs less than nothing.
    #[inline(always)]
    pub fn moved_kg(&self) -> T {
        max(self.kg, T::zero()) + self.variance_kg2 * T::from(MOVED_PART)
    }

    /// Nothing is known any more.
    pub fn forget(&mut self) {
        self.kg = T::zero();
        self.variance_kg2 = T::from(UNKNOWN_KG2);
    }

    /// By a moment, N·m, and that which 1 kg makes, with those of now alone. Where the payload does not show it stays. It may have been
    /// changed meanwhile: nothing is certain.
    pub fn set(&mut self, moment: [T; 2], per_kg: [T; 2]) {
        self.variance_kg2 = T::from(UNKNOWN_KG2);
        let square = dot(per_kg, per_kg);
        if square > self.shown {
            self.kg = clamp_symmetric(dot(moment, per_kg) / square, self.max_kg);
        }
    }

    /// By a moment, N·m, and that which 1 kg makes, once a cycle; gives by how much the payload has changed, kg.
    #[inline(always)]
    pub fn step(&mut self, moment: [T; 2], per_kg: [T; 2], moving: bool) -> T {
        let before_kg = self.kg;
        let square = dot(per_kg, per_kg);
        let missing = dot(moment, per_kg) - before_kg * square;
        let change = if moving {
            MOVING_CHANGE_KG2
        } else if square > self.shown {
            CHANGE_KG2
        } else {
            HIDDEN_CHANGE_KG2
        };
        let before = min(self.variance_kg2 + T::from(change), T::from(UNKNOWN_KG2));
        let gain = before / (square * before + self.noise);
        self.variance_kg2 = gain * self.noise;
        // A push near the vertical looks like less than nothing, the more the farther the leg gives way: it stays a push.
        let least_kg = if moving || square > self.shown {
            -self.max_kg
        } else {
            T::zero()
        };
        self.kg = max(min(before_kg + gain * missing, self.max_kg), least_kg);
        self.kg - before_kg
    }
}

#[inline(always)]
fn dot<T: Scalar>([x, y]: [T; 2], [a, b]: [T; 2]) -> T {
    x * a + y * b
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::PayloadEstimate;
    use crate::settings::Settings;

    /// Moment of 1 kg on the paper's leg that leans by 20°, N·m/kg.
    const LEANING: [f64; 2] = [0.0, 0.735];

    fn estimate() -> PayloadEstimate<f64> {
        PayloadEstimate::new(&Settings::table_1().unwrap())
    }

    /// Cycles until an estimate is within 5 % of a payload on a leg that leans.
    fn cycles(estimate: &mut PayloadEstimate<f64>, kg: f64, moving: bool) -> u32 {
        let close = |now_kg: f64| (now_kg - kg).abs() < 0.05 * kg;
        (0..)
            .find(|_| {
                estimate.step(LEANING.map(|moment| moment * kg), LEANING, moving);
                close(estimate.kg)
            })
            .unwrap()
    }

    /// A payload is set to what it shows, up to what can be held. Near the vertical it shows nothing, and stays.
    #[test]
    fn a_payload_is_set_where_it_shows() {
        let mut estimate = estimate();
        let mut set = |kg: f64, per_kg: [f64; 2]| {
            estimate.set(per_kg.map(|moment| moment * kg), per_kg);
            estimate.kg
        };
        assert!((set(1.5, LEANING) - 1.5).abs() < 1e-9);
        assert!((set(-0.3, LEANING) + 0.3).abs() < 1e-9);
        assert!((set(1.5, [1e-4, 1e-4]) + 0.3).abs() < 1e-9);
        let most_kg = set(1e3, LEANING);
        assert!(most_kg > 1.5 && most_kg < 1e3);
    }

    /// A payload of which nothing is known is found within 0.1 s of a motion; one that is known changes slowly then, and within a
    /// second at rest.
    #[test]
    fn what_is_unknown_is_found_fast() {
        let mut estimate = estimate();
        let first = cycles(&mut estimate, 2.0, true);
        assert!((20..200).contains(&first), "{first}");
        cycles(&mut estimate, 1.0, false);
        for moving in [true, false] {
            let kg = if moving { 2.0 } else { 1.0 };
            let mut known = estimate;
            for _ in 0..20_000 {
                known.step(LEANING.map(|moment| moment * (3.0 - kg)), LEANING, moving);
            }
            let changed = cycles(&mut known, kg, moving);
            let expected = if moving { 3_000..8_000 } else { 800..2_000 };
            assert!(expected.contains(&changed), "{moving}: {changed}");
        }
    }

    /// What may be hidden is moved, and little beside what is known.
    #[test]
    fn a_payload_that_is_hidden_is_moved_in_part() {
        let mut estimate = estimate();
        assert!((0.5..1.0).contains(&estimate.moved_kg()));
        cycles(&mut estimate, 1.0, false);
        for _ in 0..5_000 {
            estimate.step(LEANING, LEANING, false);
        }
        assert!(
            (1.0..1.02).contains(&estimate.moved_kg()),
            "{}",
            estimate.moved_kg()
        );
    }

    /// At the vertical nothing shows a payload: the last one stands, and is ever less certain.
    #[test]
    fn at_the_vertical_the_last_one_stands() {
        let mut estimate = estimate();
        cycles(&mut estimate, 1.0, false);
        let (known_kg, before) = (estimate.kg, estimate.variance_kg2);
        for _ in 0..10_000 {
            assert_eq!(estimate.step([0.5, 0.0], [0.0; 2], false), 0.0);
        }
        assert_eq!(estimate.kg, known_kg);
        assert!(estimate.variance_kg2 > before);
        estimate.set([0.5, 0.0], [0.0, 0.1]);
        assert_eq!(estimate.kg, known_kg);
    }

    /// Without gravity a payload shows by what its acceleration takes, and at rest by nothing.
    #[test]
    fn without_gravity_every_number_stays_finite() {
        let mut settings = Settings::table_1().unwrap();
        settings.rig.gravity_m_per_s2 = 0.0;
        let mut estimate = PayloadEstimate::<f64>::new(&settings);
        for per_kg in [[0.0; 2], [0.1, 0.0], [0.0; 2]] {
            for _ in 0..2_000 {
                estimate.step(per_kg.map(|moment| moment * 1.5), per_kg, true);
            }
            assert!(estimate.kg.is_finite() && estimate.variance_kg2 > 0.0);
        }
        assert!((estimate.kg - 1.5).abs() < 0.1, "{}", estimate.kg);
    }

    /// What would be more than the heaviest payload is a push.
    #[test]
    fn a_hard_push_is_no_payload() {
        for sign in [-1.0, 1.0] {
            let mut estimate = estimate();
            for _ in 0..5_000 {
                estimate.step([0.0, 5.0 * sign], LEANING, false);
            }
            assert!(
                (4.9..5.2).contains(&(estimate.kg * sign)),
                "{}",
                estimate.kg
            );
            let heaviest_kg = estimate.kg;
            estimate.set([0.0, 5.0 * sign], LEANING);
            assert_eq!(estimate.kg, heaviest_kg);
        }
    }
}
