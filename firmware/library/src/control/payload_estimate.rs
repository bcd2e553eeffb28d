//! The payload by the moments that it makes: a Kalman filter of one state.

use super::bounds::{clamp_symmetric, max, min};
use super::payload_moments::PayloadMoments;
use crate::settings::Settings;
use leg_model::Scalar;

/// Gravity by which moments are judged, whatever that of the rig is: where a payload weighs nothing it shows by its inertia alone.
const EARTH_M_PER_S2: f32 = 9.81;

/// Sine of the tilt from which a payload is set to what a leg at rest shows, and may be below zero, where something lifts the leg: 8.6°.
/// Nearer to the vertical what lifts it stays a push.
const SHOWN_SINE: f32 = 0.15;

/// Sine of the tilt at which a leg at rest shows half as much of its payload as it seems to: 1.9°. Below it, what load cells are off looks like a payload.
const HIDDEN_SINE: f32 = 0.033;

/// Sine of the tilt at which the tendons shall hold a payload, even of a leg that leans by less: that of 30°. Such a leg would take a push near
/// the vertical for more than any tensions hold where it goes.
const HELD_SINE: f32 = 0.5;

/// Variance of a payload of which nothing is known, kg²: a deviation of half of the 2 kg that the paper's leg carries.
/// `tests/suite/bench/moves.rs` holds it.
const UNKNOWN_KG2: f32 = 1.0;

/// How much that grows in a step of a leg at rest, kg²: a payload of a leg that leans by 15° is followed with a
/// time constant of 0.2 s. At half of that some heavy legs ring down by less than 0.2. `tests/suite/sim/ring_down.rs` holds it.
const CHANGE_KG2: f32 = 2e-7;

/// How much it grows beside that where nothing shows the payload, kg²: after some seconds it may have been changed.
const HIDDEN_CHANGE_KG2: f32 = 2e-4;

/// The same of a leg that moves, kg²: then the friction of joint and tendons looks like a payload.
const MOVING_CHANGE_KG2: f32 = 7e-9;

/// Variance of a moment in a step, as a part of the square of that of 1 kg on a horizontal leg: a deviation of 2 %. At ten times as much
/// a payload is found too late by a leg that sets out from straight down. `tests/suite/bench/moves.rs` holds it.
const NOISE_PART: f32 = 5e-4;

/// Square of what a moment may be off by the load cells of a leg at rest, (N·m)²: 0.04 N·m. The brake of the swing is made
/// for a payload that is heavier by that.
const OFF_NM2: f32 = 1.6e-3;

/// Part of its variance, 1/kg, that is added to a payload for the inertia that is moved: 0.9 kg where nothing has shown it, of the up to
/// 2 kg that the paper's leg carries. At 1 a soft leg without a payload leaves its trajectory, at 0.7 one with 1.7 kg swings.
/// `tests/suite/bench/moves.rs` holds both.
const MOVED_PART: f32 = 0.9;

/// The payload whose inertia is moved where nothing has shown one yet, kg.
pub const UNKNOWN_MOVED_KG: f32 = UNKNOWN_KG2 * MOVED_PART;

/// The payload, kg, and its variance.
#[derive(Clone, Copy, Debug)]
pub struct PayloadEstimate<T> {
    /// Below zero where something lifts the leg.
    pub kg: T,
    variance_kg2: T,
    /// Its variance by what the load cells of a leg at rest may be off, kg²; none on the way.
    off_kg2: T,
    /// Variance of a moment in a step.
    noise: T,
    /// Square of the moment of 1 kg, N·m/kg, from which the payload shows; and the square of that at which it shows half as much.
    shown: T,
    hidden: T,
    /// What the tendons could hold at the farthest tilt, or at 30°; what pulls harder is a push.
    max_kg: T,
}

impl<T: Scalar> PayloadEstimate<T> {
    /// Nothing is known.
    pub fn new(settings: &Settings) -> Self {
        let rig = &settings.rig;
        let lever = EARTH_M_PER_S2 * (rig.joint_length_m + rig.leg_length_m);
        let square = |sine: f32| T::from((lever * sine) * (lever * sine));
        let anchors = &rig.leg_anchors_m;
        let reach_m: f32 = anchors
            .iter()
            .map(|[x, y]| Scalar::sqrt(x * x + y * y))
            .sum();
        let held_nm = 0.5 * reach_m * settings.f_max_n;
        Self {
            kg: T::zero(),
            variance_kg2: T::from(UNKNOWN_KG2),
            off_kg2: T::zero(),
            noise: T::from(NOISE_PART * lever * lever),
            shown: square(SHOWN_SINE),
            hidden: square(HIDDEN_SINE) * square(HIDDEN_SINE),
            max_kg: T::from(held_nm / (lever * settings.tilt_max_sine.max(HELD_SINE))),
        }
    }

    /// The standard deviation, kg.
    #[inline(always)]
    pub fn deviation_kg(&self) -> T {
        max(self.variance_kg2, self.off_kg2).sqrt()
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

    /// By the moments of a leg that moves or rests, once a step; gives by how much the payload has changed, kg.
    ///
    /// Weighted by what the trajectory asks for, not by what the sensors show, which have noise: an instrumental variable.
    #[inline(always)]
    pub fn step(&mut self, moments: &PayloadMoments<T>, moving: bool) -> T {
        let before_kg = self.kg;
        let asked = moments.asked_per_kg;
        let square = dot(asked, asked);
        let lag = [moments.per_kg[0] - asked[0], moments.per_kg[1] - asked[1]];
        // Lengths that jump: no lag turns a leg by more than 2.4 times what it is asked to, or by much the other way. What noise turns the
        // other way counts: left out, it would make the payload look heavier or lighter.
        if dot(lag, lag) > square * T::TWO {
            return T::zero();
        }
        let missing = dot(moments.excess, asked) - before_kg * dot(moments.per_kg, asked);
        let (change, weight) = if moving {
            (T::from(MOVING_CHANGE_KG2), T::one())
        } else {
            let hidden = self.hidden / (square * square + self.hidden);
            let change = T::from(CHANGE_KG2) + T::from(HIDDEN_CHANGE_KG2) * hidden;
            (change, T::one() - hidden)
        };
        let before = min(self.variance_kg2 + change, T::from(UNKNOWN_KG2));
        let gain = before / (weight * square * before + self.noise);
        self.variance_kg2 = gain * self.noise;
        self.off_kg2 = if moving {
            T::zero()
        } else {
            T::from(UNKNOWN_KG2 * OFF_NM2) / (square + T::from(OFF_NM2))
        };
        // A push near the vertical looks like less than nothing, the more the farther the leg gives way: it stays a push.
        let least_kg = if moving || square > self.shown {
            -self.max_kg
        } else {
            T::zero()
        };
        self.kg = max(
            min(before_kg + gain * weight * missing, self.max_kg),
            least_kg,
        );
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
    use super::{PayloadEstimate, PayloadMoments};
    use crate::settings::Settings;

    /// Moment of 1 kg on the paper's leg that leans by 20°, N·m/kg.
    const LEANING: [f64; 2] = [0.0, 0.735];

    fn estimate() -> PayloadEstimate<f64> {
        PayloadEstimate::new(&Settings::table_1().unwrap())
    }

    /// Takes a moment and that of 1 kg.
    fn step(
        estimate: &mut PayloadEstimate<f64>,
        moment: [f64; 2],
        per_kg: [f64; 2],
        moving: bool,
    ) -> f64 {
        estimate.step(&PayloadMoments::unfiltered(moment, per_kg), moving)
    }

    /// Moment of 1 kg on the paper's leg that hangs straight down and accelerates by 0.6 rad/s², N·m/kg.
    const SETTING_OUT: [f64; 2] = [0.03, 0.0];

    /// Steps until an estimate is within 5 % of a payload by the moment of 1 kg.
    fn steps(estimate: &mut PayloadEstimate<f64>, per_kg: [f64; 2], kg: f64, moving: bool) -> u32 {
        let close = |now_kg: f64| (now_kg - kg).abs() < 0.05 * kg;
        (0..)
            .find(|_| {
                step(estimate, per_kg.map(|moment| moment * kg), per_kg, moving);
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

    /// A payload of which nothing is known is found within 0.05 s of a leg that sets out; one that is known changes slowly then, and within
    /// a second at rest.
    #[test]
    fn what_is_unknown_is_found_fast() {
        let mut estimate = estimate();
        let first = steps(&mut estimate, SETTING_OUT, 2.0, true);
        assert!((5..50).contains(&first), "{first}");
        steps(&mut estimate, LEANING, 1.0, false);
        for moving in [true, false] {
            let kg = if moving { 2.0 } else { 1.0 };
            let mut known = estimate;
            for _ in 0..10_000 {
                step(
                    &mut known,
                    LEANING.map(|moment| moment * (3.0 - kg)),
                    LEANING,
                    moving,
                );
            }
            let changed = steps(&mut known, LEANING, kg, moving);
            let expected = if moving { 1_500..4_000 } else { 400..1_000 };
            assert!(expected.contains(&changed), "{moving}: {changed}");
        }
    }

    /// A leg that lags behind what it is asked for has its moments compared by what it truly does.
    #[test]
    fn a_leg_that_lags_carries_what_it_shows() {
        let mut estimate = estimate();
        let half = SETTING_OUT.map(|moment| 0.5 * moment);
        for _ in 0..200 {
            let moments = PayloadMoments {
                excess: half.map(|moment| 1.5 * moment),
                per_kg: half,
                asked_per_kg: SETTING_OUT,
            };
            estimate.step(&moments, true);
        }
        // By what was asked for it would carry 0.75 kg.
        assert!((1.3..1.5).contains(&estimate.kg), "{}", estimate.kg);
    }

    /// A leg that seems to turn far more than it is asked to, or the other way, shows nothing: lengths that jump do that.
    #[test]
    fn what_no_lag_explains_shows_no_payload() {
        let mut estimate = estimate();
        for per_kg in [[0.1, 0.0], [-0.02, 0.0], [0.03, 0.05]] {
            let moments = PayloadMoments {
                excess: [0.2, 0.1],
                per_kg,
                asked_per_kg: SETTING_OUT,
            };
            assert_eq!(estimate.step(&moments, true), 0.0);
        }
        assert_eq!(estimate.kg, 0.0);
    }

    /// A leg that rests 0.2° from the vertical, and whose load cells are off by 0.03 N·m: by that alone it would carry 4 kg.
    #[test]
    fn what_load_cells_are_off_is_no_payload_near_the_vertical() {
        let mut estimate = estimate();
        for _ in 0..1_000 {
            step(&mut estimate, [0.03, 0.0], [0.0075, 0.0], false);
        }
        assert!((0.0..0.1).contains(&estimate.kg), "{}", estimate.kg);
    }

    /// What may be hidden is moved, and little beside what is known.
    #[test]
    fn a_payload_that_is_hidden_is_moved_in_part() {
        let mut estimate = estimate();
        assert!((0.5..1.0).contains(&estimate.moved_kg()));
        steps(&mut estimate, LEANING, 1.0, false);
        for _ in 0..5_000 {
            step(&mut estimate, LEANING, LEANING, false);
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
        steps(&mut estimate, LEANING, 1.0, false);
        let (known_kg, before) = (estimate.kg, estimate.variance_kg2);
        for _ in 0..10_000 {
            assert_eq!(step(&mut estimate, [0.5, 0.0], [0.0; 2], false), 0.0);
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
                step(
                    &mut estimate,
                    per_kg.map(|moment| moment * 1.5),
                    per_kg,
                    true,
                );
            }
            assert!(estimate.kg.is_finite() && estimate.variance_kg2 > 0.0);
        }
        assert!((estimate.kg - 1.5).abs() < 0.1, "{}", estimate.kg);
        let known_kg = estimate.kg;
        for _ in 0..2_000 {
            step(&mut estimate, [0.05, 0.0], [0.0; 2], false);
        }
        assert_eq!(estimate.kg, known_kg);
    }

    /// What would be more than the heaviest payload is a push.
    #[test]
    fn a_hard_push_is_no_payload() {
        for sign in [-1.0, 1.0] {
            let mut estimate = estimate();
            for _ in 0..5_000 {
                step(&mut estimate, [0.0, 5.0 * sign], LEANING, false);
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
