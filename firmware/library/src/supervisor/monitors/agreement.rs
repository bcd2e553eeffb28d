//! Whether lengths and tensions agree over time.
//!
//! Three counters and three load cells watch a leg of two freedoms that carries a load of two components: one number is left
//! over, the mean by which measured lengths exceed those of the estimated pose. A motion, a load and a push leave it as it is.
//! A leg that can twist has a third freedom, but no load turns it about its own axis, and so the tensions show how far it
//! twists. A wrong load cell changes the mean by a third of its error over the stiffness of the tendon, and a lost count by a
//! third of its length.

use crate::control::{CYCLE_S, LengthError, LowPass, bounds::clamp_symmetric};
use crate::settings::Settings;
use leg_model::Scalar;

/// Time constant of the filter of what is beyond the allowed change, s: a load cell that loses its tension is found within a
/// third of it, before the filters of the load have moved the leg.
const FILTER_TIME_S: f32 = 0.02;

/// Time constant of the filter that shows how fast an elongation changes, s, and the part of what it shows that may be missing: a
/// tendon is damped, and pulls otherwise than by its curve while the leg swings. A fifth of the period of a swing.
const SWING_TIME_S: f32 = 0.02;
const SWING_PART: f32 = 0.5;

/// Time constant with which the elongations are forgotten from which changes count, s: longer than any swing of the leg.
const FORGET_TIME_S: f32 = 1.0;

/// Part of the change of the elongations that tendons may stretch otherwise than by their curves. A single wrong cell changes
/// the mean by about a third of its elongation, which is the mean change of elongations: eight times this.
const CURVE_PART: f32 = 0.12;

/// Part of a change that both filters take over in a cycle.
const FORGET_GAIN: f32 = CYCLE_S / (FORGET_TIME_S + CYCLE_S);
const SWING_GAIN: f32 = CYCLE_S / (SWING_TIME_S + CYCLE_S);

/// What is allowed for the sum of the three changes before that, of the elongations from which changes count and of swings; and what is
/// learned of the first.
const STRETCH_ALLOWED: f32 = CURVE_PART / 3.0 * (1.0 - FORGET_GAIN);
const STRETCH_LEARNED: f32 = CURVE_PART / 3.0 * FORGET_GAIN;
const SWING_ALLOWED: f32 = SWING_PART / 3.0 * (1.0 - SWING_GAIN);

/// How fast the error may grow that is taken for one of the geometry or of a curve, m/s.
#[derive(Clone, Copy, Debug)]
pub struct ErrorGrowth(f32);

impl ErrorGrowth {
    /// In motion a tenth of a millimetre over the workspace, which the leg crosses in a second.
    pub const MOVING: Self = Self(1e-4);
    /// At rest what a tendon creeps.
    pub const RESTING: Self = Self(1e-6);
    /// A leg that keeps station would follow a load cell that drifts as slowly: 0.03 N/s are left.
    pub const KEEPING_STATION: Self = Self(1e-7);
}

/// Cycles after the last tendon came taut in which the error is not watched yet, 0.1 s: a tendon that is reeled in is damped, and
/// shows up to a newton more than its elongation.
pub const SETTLE_CYCLES: u16 = 200;

/// A swing that may falsify the error by more than this while the last tendon comes taut, m, is a hard one, as after a push that took a
/// tendon's tension: four times the change that is a fault. What the error is then is in doubt by as much, and the doubt fades in this
/// time, s.
const HARD_SWING_M: f32 = 4e-5;
const DOUBT_TIME_S: f32 = 1.0;

/// Cycles after which nothing of it is left, 5 s.
const FADE_CYCLES: u16 = 10_000;

/// Watches for a change that neither motion nor load explains.
#[derive(Clone, Copy, Debug)]
pub struct Agreement<T> {
    reference: Option<Reference<T>>,
    /// How far the change is beyond what is allowed, m.
    beyond: LowPass<T>,
    /// The same now, with nothing allowed for a swing.
    beyond_now_m: T,
    change_max_m: T,
}

#[derive(Clone, Copy, Debug)]
struct Reference<T> {
    mean_m: T,
    /// Elongation of each tendon, slowly forgotten and quickly.
    elongations_m: [[T; 2]; 3],
    /// Cycles until nothing is in doubt; in the first [`SETTLE_CYCLES`] of them the error is not watched yet.
    young_cycles: u16,
    /// By how much the mean may be off that a hard swing began with, m.
    doubt_m: T,
}

impl<T: Scalar> Agreement<T> {
    /// With the limits of the settings.
    pub fn new(settings: &Settings) -> Self {
        Self {
            reference: None,
            beyond: LowPass::new(FILTER_TIME_S, CYCLE_S),
            beyond_now_m: T::zero(),
            change_max_m: settings.limits.residual_change_m.into(),
        }
    }

    /// Forgets everything: the tendons need not pull any more.
    pub fn end(&mut self) {
        self.reference = None;
        self.beyond.set(T::zero());
    }

    /// Nothing can be compared now, but what was known holds; nothing is trusted meanwhile.
    #[inline(always)]
    pub fn pause(&mut self) {
        self.beyond_now_m = self.change_max_m;
    }

    /// Whether every tendon has pulled since the last end.
    #[inline(always)]
    pub fn watches(&self) -> bool {
        self.reference
            .as_ref()
            .is_some_and(|reference| reference.young_cycles <= FADE_CYCLES)
    }

    /// Whether the sensors agree: not where the change is no number.
    #[inline(always)]
    pub fn agree(&self) -> bool {
        self.beyond.value() <= T::zero()
    }

    /// Whether the sensors are watched, and agree at this moment: a fault is not yet one.
    #[inline(always)]
    pub fn trusts(&self) -> bool {
        self.watches() && self.beyond_now_m <= T::zero()
    }

    /// One cycle while every tendon should pull.
    #[inline(always)]
    pub fn watch(&mut self, error: &LengthError<T>, growth: ErrorGrowth) {
        let Some(reference) = &mut self.reference else {
            self.reference = Some(Reference::new(error));
            return;
        };
        let (mut stretched_m, mut swings_m) = (T::SUM_START, T::SUM_START);
        for ([slow_m, fast_m], &now_m) in
            reference.elongations_m.iter_mut().zip(&error.elongations_m)
        {
            let (from_slow_m, from_fast_m) = (now_m - *slow_m, now_m - *fast_m);
            *slow_m += from_slow_m * T::from(FORGET_GAIN);
            *fast_m += from_fast_m * T::from(SWING_GAIN);
            stretched_m += from_slow_m.abs();
            swings_m += from_fast_m.abs();
        }
        let swings_m = swings_m * T::from(SWING_ALLOWED);
        let mut allowed_m = self.change_max_m + stretched_m * T::from(STRETCH_ALLOWED);
        // What a changed elongation was allowed to change stays.
        let mut learned_m = T::from(growth.0 * CYCLE_S) + stretched_m * T::from(STRETCH_LEARNED);
        if reference.young_cycles > 0 {
            reference.young_cycles -= 1;
            if reference.young_cycles < FADE_CYCLES {
                learned_m += reference.fade();
                allowed_m += reference.doubt_m;
            } else {
                reference.mean_m = error.mean_m;
                if swings_m > T::from(HARD_SWING_M) {
                    reference.doubt(swings_m);
                }
            }
        }
        let change_m = error.mean_m - reference.mean_m;
        reference.mean_m += clamp_symmetric(change_m, learned_m);
        self.beyond_now_m = change_m.abs() - allowed_m;
        self.beyond.step(self.beyond_now_m - swings_m);
    }
}

impl<T: Scalar> Reference<T> {
    fn new(error: &LengthError<T>) -> Self {
        Self {
            mean_m: error.mean_m,
            elongations_m: error.elongations_m.map(|now_m| [now_m; 2]),
            young_cycles: SETTLE_CYCLES + FADE_CYCLES,
            doubt_m: T::zero(),
        }
    }

    /// The mean may be off by a hard swing, m.
    #[cold]
    fn doubt(&mut self, swings_m: T) {
        if swings_m > self.doubt_m {
            self.doubt_m = swings_m;
        }
    }

    /// One cycle in which a doubt fades, if there is one: by how much, m.
    #[cold]
    fn fade(&mut self) -> T {
        if self.young_cycles == 0 || self.doubt_m == T::zero() {
            (self.young_cycles, self.doubt_m) = (0, T::zero());
        }
        let fading_m = self.doubt_m * T::from(CYCLE_S / DOUBT_TIME_S);
        self.doubt_m -= fading_m;
        fading_m
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{Agreement, CURVE_PART, ErrorGrowth, LengthError, SETTLE_CYCLES};
    use crate::control::CYCLE_S;
    use crate::settings::Settings;
    use core::f64::consts::TAU;
    use leg_model::SupportKind;

    /// Elongation of every tendon at first, m: that of the paper's leg at 70 N.
    const ELONGATION_M: f64 = 1e-3;

    struct Leg {
        agreement: Agreement<f64>,
        error: LengthError<f64>,
    }

    impl Leg {
        fn taut() -> Self {
            Self::taut_on(SupportKind::TorsionFree)
        }

        fn taut_on(support: SupportKind) -> Self {
            let mut leg = Self {
                agreement: Agreement::new(&Settings {
                    support,
                    ..Settings::for_table_1().unwrap()
                }),
                // What homing and the geometry leave over.
                error: LengthError {
                    mean_m: -4e-5,
                    elongations_m: [ELONGATION_M; 3],
                },
            };
            for _ in 0..=SETTLE_CYCLES {
                assert!(!leg.agreement.watches());
                leg.watch(false);
            }
            assert!(leg.agreement.trusts());
            leg
        }

        fn watch(&mut self, moving: bool) {
            let growth = if moving {
                ErrorGrowth::MOVING
            } else {
                ErrorGrowth::RESTING
            };
            self.agreement.watch(&self.error, growth);
        }

        /// Time until the sensors disagree, s, while `change` is made in every cycle; none within 20 s.
        fn disagrees_after(
            &mut self,
            mut change: impl FnMut(f64, &mut LengthError<f64>),
        ) -> Option<f64> {
            let begun = self.error;
            for cycle in 0..40_000 {
                let time_s = f64::from(cycle) * f64::from(CYCLE_S);
                self.error = begun;
                change(time_s, &mut self.error);
                self.watch(false);
                if !self.agreement.agree() {
                    return Some(time_s);
                }
            }
            None
        }
    }

    /// One cell shows `off_m` more than its tendon is stretched.
    fn lie(error: &mut LengthError<f64>, cell: usize, off_m: f64) {
        error.elongations_m[cell] += off_m;
        error.mean_m += off_m / 3.0;
    }

    #[test]
    fn a_cell_that_lies_is_found_before_the_load_is_believed() {
        for cell in 0..3 {
            for off_m in [6e-5, -6e-5, 5e-4, -1e-3] {
                let found_s = Leg::taut().disagrees_after(|_, error| lie(error, cell, off_m));
                assert!(found_s.is_some_and(|s| s < 0.05), "{off_m}: {found_s:?}");
            }
        }
    }

    #[test]
    fn a_cell_that_fades_in_seconds_is_found_while_little_is_missing() {
        let found_s = Leg::taut().disagrees_after(|s, error| lie(error, 1, -1e-4 * s));
        assert!(found_s.is_some_and(|s| s < 0.6), "{found_s:?}");
    }

    #[test]
    fn a_count_that_is_lost_is_found() {
        let found_s = Leg::taut().disagrees_after(|_, error| error.mean_m += 4e-5 / 3.0);
        assert!(found_s.is_some_and(|s| s < 0.1), "{found_s:?}");
    }

    /// A load stretches one tendon more and the others less; curves that are wrong by a fifth show there.
    #[test]
    fn a_load_is_no_lie() {
        for load_m in [1e-4, 6e-4, -6e-4] {
            let found_s = Leg::taut().disagrees_after(|_, error| {
                let stretched_m = [load_m, -0.5 * load_m, -0.5 * load_m];
                for (elongation, more) in error.elongations_m.iter_mut().zip(stretched_m) {
                    *elongation += more;
                }
                error.mean_m += 0.8 * f64::from(CURVE_PART) * 2.0 / 3.0 * load_m;
            });
            assert_eq!(found_s, None, "{load_m}");
        }
    }

    /// Tendons that stretch otherwise by a part of their curves explain so much, and no more: a twist is estimated by itself.
    #[test]
    fn what_curves_do_not_explain_is_a_lie_on_every_support() {
        for support in [
            SupportKind::TorsionFree,
            SupportKind::Universal,
            SupportKind::Spherical,
            SupportKind::ElasticUniversal,
        ] {
            let found = |part_of_it: f64| {
                Leg::taut_on(support).disagrees_after(|_, error| {
                    for (elongation, part) in error.elongations_m.iter_mut().zip([1.0, -0.5, -0.5])
                    {
                        *elongation += 6e-4 * part;
                    }
                    error.mean_m += part_of_it * f64::from(CURVE_PART) * 4e-4;
                })
            };
            assert_eq!(found(0.9), None, "{support:?}");
            assert!(found(1.5).is_some_and(|s| s < 0.1), "{support:?}");
        }
    }

    #[test]
    fn what_creeps_or_changes_with_the_pose_is_learned() {
        let mut leg = Leg::taut();
        let found_s = leg.disagrees_after(|s, error| error.mean_m += 0.9e-6 * s);
        assert_eq!(found_s, None);
        let mut leg = Leg::taut();
        for _ in 0..2_000 {
            leg.error.mean_m += 0.9e-4 * f64::from(CYCLE_S);
            leg.watch(true);
            assert!(leg.agreement.agree());
        }
    }

    /// A leg at rest learns it as creep; one that keeps station would follow it.
    #[test]
    fn what_drifts_is_no_creep_to_a_leg_that_keeps_station() {
        let agrees_after = |growth| {
            let mut leg = Leg::taut();
            for _ in 0..60_000 {
                leg.error.mean_m += 0.5e-6 * f64::from(CYCLE_S);
                leg.agreement.watch(&leg.error, growth);
            }
            leg.agreement.agree()
        };
        assert!(agrees_after(ErrorGrowth::RESTING));
        assert!(!agrees_after(ErrorGrowth::KEEPING_STATION));
    }

    /// A leg that swings as the last of its tendons comes taut, as after a push that took its tension: a damped tendon pulls otherwise than
    /// by its curve, so that the error is falsified when it is first looked at. It rings down within half a second.
    #[test]
    fn a_hard_swing_as_the_tendons_come_taut_is_no_lie() {
        let settled_s = f64::from(SETTLE_CYCLES) * f64::from(CYCLE_S);
        let agrees = |swing_m: f64, falsified_m: f64| {
            let mut leg = Leg::taut();
            leg.agreement.end();
            let begun = leg.error;
            let mut agrees = true;
            for cycle in 0..10_000 {
                let time_s = f64::from(cycle) * f64::from(CYCLE_S) - settled_s;
                let part = (-time_s.max(0.0) / 0.1).exp() * (TAU * 7.0 * time_s).cos();
                let stretched_m = [swing_m, -0.5 * swing_m, -0.5 * swing_m];
                leg.error = begun;
                for (elongation, more) in leg.error.elongations_m.iter_mut().zip(stretched_m) {
                    *elongation += more * part;
                }
                leg.error.mean_m += falsified_m * part;
                leg.watch(false);
                agrees &= leg.agreement.agree();
            }
            leg.error = begun;
            // Five seconds later nothing of it is left.
            let found_s = leg.disagrees_after(|_, error| lie(error, 1, -1e-4));
            assert!(!agrees || found_s.is_some_and(|s| s < 0.05), "{found_s:?}");
            agrees
        };
        assert!(agrees(6e-4, 1e-4));
        // What no hard swing explains is a lie.
        assert!(!agrees(1e-4, 1e-4));
    }

    #[test]
    fn what_is_no_number_is_no_agreement() {
        let mut leg = Leg::taut();
        leg.error.mean_m = f64::NAN;
        leg.watch(false);
        assert!(!leg.agreement.agree() && !leg.agreement.trusts());
    }

    #[test]
    fn a_pause_forgets_nothing_and_nothing_is_trusted_in_it() {
        let mut leg = Leg::taut();
        leg.agreement.pause();
        assert!(leg.agreement.watches() && leg.agreement.agree() && !leg.agreement.trusts());
        leg.watch(false);
        assert!(leg.agreement.trusts());
        leg.agreement.pause();
        let found_s = leg.disagrees_after(|_, error| lie(error, 1, -1e-4));
        assert!(found_s.is_some_and(|s| s < 0.05), "{found_s:?}");
    }

    #[test]
    fn nothing_is_watched_after_the_end() {
        let mut leg = Leg::taut();
        leg.agreement.end();
        assert!(leg.agreement.agree() && !leg.agreement.watches());
    }
}
