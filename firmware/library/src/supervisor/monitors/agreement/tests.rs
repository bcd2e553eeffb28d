//! Swings, curves and wrong load cells.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{
    Agreement, CURVE_PART, ErrorGrowth, FAR_CYCLES, KEPT_PART, LengthError, SETTLE_CYCLES,
};
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
                ..Settings::table_1().unwrap()
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
            &ErrorGrowth::MOVING
        } else {
            &ErrorGrowth::RESTING
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
fn misread(error: &mut LengthError<f64>, cell: usize, off_m: f64) {
    error.elongations_m[cell] += off_m;
    error.mean_m += off_m / 3.0;
}

#[test]
fn a_cell_that_reads_wrong_is_found_before_the_load_is_believed() {
    for cell in 0..3 {
        for off_m in [6e-5, -6e-5, 5e-4, -1e-3] {
            let found_s = Leg::taut().disagrees_after(|_, error| misread(error, cell, off_m));
            assert!(found_s.is_some_and(|s| s < 0.05), "{off_m}: {found_s:?}");
        }
    }
}

#[test]
fn a_cell_that_fades_in_seconds_is_found_while_little_is_missing() {
    let found_s = Leg::taut().disagrees_after(|s, error| misread(error, 1, -1e-4 * s));
    assert!(found_s.is_some_and(|s| s < 0.6), "{found_s:?}");
}

/// A cell that steps contradicts the others before it is a fault; nothing does before the sensors are watched.
#[test]
fn a_step_contradicts_at_once() {
    for off_m in [4e-5, -4e-5] {
        let mut leg = Leg::taut();
        leg.watch(false);
        assert!(!leg.agreement.contradicts());
        misread(&mut leg.error, 1, off_m);
        leg.watch(false);
        assert!(leg.agreement.contradicts() && leg.agreement.agree());
        leg.agreement.end();
        assert!(!leg.agreement.contradicts());
    }
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

/// What tendons stretch otherwise than by their curves stays allowed to a part of it: over seconds they may be off by less than at once.
#[test]
fn what_changes_slowly_is_explained_to_a_part() {
    let found = |growth: &ErrorGrowth, part: f64| {
        let mut leg = Leg::taut();
        let begun_m = leg.error.mean_m;
        // A millimetre in ten seconds, of every tendon.
        (1..=20_000).any(|cycle| {
            let stretched_m = 5e-8 * f64::from(cycle);
            leg.error.elongations_m = [ELONGATION_M - stretched_m; 3];
            leg.error.mean_m = begun_m + part * stretched_m;
            leg.agreement.watch(&leg.error, growth);
            !leg.agreement.agree()
        })
    };
    let kept = f64::from(KEPT_PART);
    for growth in [&ErrorGrowth::RESTING, &ErrorGrowth::STANDING] {
        assert!(!found(growth, kept));
        assert!(found(growth, 1.5 * kept));
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
                for (elongation, part) in error.elongations_m.iter_mut().zip([1.0, -0.5, -0.5]) {
                    *elongation += 6e-4 * part;
                }
                error.mean_m += part_of_it * f64::from(CURVE_PART) * 4e-4;
            })
        };
        assert_eq!(found(0.9), None, "{support:?}");
        assert!(found(1.5).is_some_and(|s| s < 0.1), "{support:?}");
    }
}

/// While a leg is tensioned its tendons may be of another make, by three tenths of their curves.
#[test]
fn what_tendons_of_another_make_do_is_no_lie_while_they_are_tensioned() {
    let agrees = |growth: &ErrorGrowth, part: f64| {
        let mut leg = Leg::taut();
        let begun_m = leg.error.mean_m;
        // The pretension rises in half a second.
        (1..=1000).all(|cycle| {
            let stretched_m = 4e-7 * f64::from(cycle);
            leg.error.elongations_m = [ELONGATION_M + stretched_m; 3];
            leg.error.mean_m = begun_m + part * stretched_m;
            leg.agreement.watch(&leg.error, growth);
            leg.agreement.agree()
        })
    };
    for sign in [1.0, -1.0] {
        assert!(agrees(&ErrorGrowth::TENSIONING, sign * 0.29));
        assert!(!agrees(&ErrorGrowth::TENSIONING, sign * 0.35));
        assert!(!agrees(&ErrorGrowth::RESTING, sign * 0.29));
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
    assert!(agrees_after(&ErrorGrowth::RESTING));
    assert!(!agrees_after(&ErrorGrowth::STANDING));
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
        let found_s = leg.disagrees_after(|_, error| misread(error, 1, -1e-4));
        assert!(!agrees || found_s.is_some_and(|s| s < 0.05), "{found_s:?}");
        agrees
    };
    assert!(agrees(6e-4, 1e-4));
    // What no hard swing explains is a wrong reading.
    assert!(!agrees(1e-4, 1e-4));
}

/// A cell that is wrong by a third of what is a fault is not close. Nor is what is no number.
#[test]
fn sensors_agree_closely_within_a_quarter_of_what_is_a_fault() {
    for (part, close) in [(0.2, true), (0.3, false), (f64::NAN, false)] {
        let mut leg = Leg::taut();
        assert!(leg.agreement.close);
        leg.error.mean_m += part * leg.agreement.change_max_m;
        leg.watch(false);
        assert_eq!(leg.agreement.close, close, "{part}");
    }
}

/// What is far for longer than half a swing stays far; once it was close, or another state has begun, that begins anew.
#[test]
fn sensors_stay_far_after_three_tenths_of_a_second() {
    let mut leg = Leg::taut();
    let sound_m = leg.error.mean_m;
    for state_ends in [false, true] {
        leg.error.mean_m = sound_m + 0.5 * leg.agreement.change_max_m;
        leg.watch(false);
        for _ in 1..FAR_CYCLES {
            assert!(!leg.agreement.stays_far());
        }
        assert!(leg.agreement.stays_far() && leg.agreement.trusts());
        if state_ends {
            leg.agreement.forget_far();
        } else {
            leg.error.mean_m = sound_m;
            leg.watch(false);
        }
        assert!(!leg.agreement.stays_far());
    }
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
    let found_s = leg.disagrees_after(|_, error| misread(error, 1, -1e-4));
    assert!(found_s.is_some_and(|s| s < 0.05), "{found_s:?}");
}

#[test]
fn nothing_is_watched_after_the_end() {
    let mut leg = Leg::taut();
    leg.agreement.end();
    assert!(leg.agreement.agree() && !leg.agreement.watches());
}
