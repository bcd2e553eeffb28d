//! What load cells show.

use super::super::CONTRADICTED_PART;
use super::*;
use crate::sensors::CODE_MAX;

#[test]
fn a_cell_is_saturated_stale_or_stuck() {
    for (allowed, code) in [(64, 62), (CODE_MAX - 66, CODE_MAX - 62)] {
        is_no_fault("a code in range", |_, s| {
            s.sensors.cell_codes[AXIS] = allowed
        });
        is_fault(Fault::CellSaturated, 1, |_, s| {
            s.sensors.cell_codes[AXIS] = code;
        });
    }
    // Whether the leg is driven or not: a cell that is not there is known before it is armed.
    for driven in [true, false] {
        let unfresh = |s: &mut Seen| {
            (s.driven, s.sensors.cell_fresh[AXIS]) = (driven, false);
        };
        is_fault(Fault::CellStale, cycles(limits().stale_time_s), |_, s| {
            unfresh(s);
        });
        is_fault(Fault::CellStale, cycles(limits().stale_time_s), |_, s| {
            unfresh(s);
            s.lives = false;
        });
        is_fault(Fault::CellStuck, cycles(limits().stuck_time_s), |_, s| {
            (s.driven, s.lives) = (driven, false);
        });
    }
}

#[test]
fn a_tension_is_slack_or_too_high() {
    let slack = |n: f32| {
        move |limits: &Limits, s: &mut Seen| {
            s.measured.tensions_n[AXIS] = f64::from(limits.slack_n + n);
        }
    };
    // The way there is a jump, unless the drivers are off.
    is_no_fault("tension enough", |l, s| {
        slack(0.01)(l, s);
        s.driven = false;
    });
    is_fault(Fault::Slack, cycles(limits().slack_time_s), |l, s| {
        slack(-0.01)(l, s);
        s.driven = false;
    });
    is_no_fault("may be slack", |l, s| {
        slack(-0.01)(l, s);
        s.driven = false;
        s.tensioned = false;
    });
    is_no_fault("the drivers are off", |_, s| {
        (s.driven, s.measured.tensions_n[AXIS]) = (false, 1e3);
    });
}

/// A tension that has come there slowly.
fn too_much(more_n: f64, change: impl Fn(&mut Seen)) -> Option<(FaultSet, u16)> {
    let mut watched = Watched::new();
    let (f_max_n, limits) = (watched.settings.f_max_n, watched.limits());
    let mut seen = Seen::sound();
    let highest_n = f64::from(f_max_n) * (1.0 + f64::from(limits.over_tension_part));
    while seen.measured.tensions_n[AXIS] < highest_n - 5.0 {
        seen.measured.tensions_n[AXIS] += 4.0;
        assert_eq!(watched.cycle(&seen), FaultSet::NONE);
    }
    seen.measured.tensions_n[AXIS] = highest_n + more_n;
    change(&mut seen);
    watched.faults_after(&seen)
}

/// By a cell that the others contradict nothing is called too much tension: what it shows is a residual while the motors are
/// led by it.
#[test]
fn too_much_tension_is_that_of_a_trusted_cell() {
    let after = |fault| Some((FaultSet::single(fault), 4));
    assert_eq!(too_much(-0.01, |_| ()), None);
    assert_eq!(too_much(0.01, |_| ()), after(Fault::OverTension));
    assert_eq!(too_much(0.01, |s| s.driven = false), None);
    let residual = too_much(0.01, |s| s.trusted = false);
    assert_eq!(residual, after(Fault::Residual));
    let not_led = too_much(0.01, |s| (s.trusted, s.led) = (false, false));
    assert_eq!(not_led, None);
    let doubted = too_much(0.01, |s| s.excess = Excess::Doubted);
    assert_eq!(doubted, after(Fault::Residual));
    assert_eq!(too_much(0.01, |s| s.excess = Excess::Open), None);
}

/// A change is counted over a millisecond: two cycles.
#[test]
fn a_tension_that_jumps_up_or_down_is_a_fault() {
    let jump_n = f64::from(limits().jump_n);
    for sign in [1.0, -1.0] {
        let to =
            |change_n: f64| move |_: &Limits, s: &mut Seen| s.measured.tensions_n[AXIS] += change_n;
        is_no_fault("a change", to(sign * (jump_n - 0.01)));
        is_fault(Fault::TensionJump, 1, to(sign * (jump_n + 0.01)));
    }
    let mut watched = Watched::new();
    let mut seen = Seen::sound();
    seen.measured.tensions_n[AXIS] += 0.6 * jump_n;
    assert_eq!(watched.cycle(&seen), FaultSet::NONE);
    seen.measured.tensions_n[AXIS] += 0.6 * jump_n;
    let jump = FaultSet::single(Fault::TensionJump);
    assert_eq!(watched.cycle(&seen), jump);
    assert_eq!(watched.cycle(&seen), FaultSet::NONE);
}

/// What the lengths contradict is a jump by less, which lasts until the tension is back within half of it.
#[test]
fn a_tension_that_the_lengths_contradict_jumps_by_less() {
    let least_n = f64::from(CONTRADICTED_PART * limits().jump_n);
    let to = |change_n: f64, contradicted: bool| {
        move |_: &Limits, s: &mut Seen| {
            s.measured.tensions_n[AXIS] += change_n;
            s.contradicted = contradicted;
        }
    };
    for sign in [1.0, -1.0] {
        is_no_fault("no jump", to(sign * (least_n - 0.01), true));
        is_fault(Fault::TensionJump, 1, to(sign * (least_n + 0.01), true));
        is_no_fault("a knock", to(sign * (least_n + 0.01), false));
        let mut watched = Watched::new();
        let mut seen = Seen::sound();
        to(sign * 10.0, true)(&watched.limits(), &mut seen);
        watched.cycle(&seen);
        for (back_n, stays) in [(0.0, true), (4.9, true), (5.1, false)] {
            let mut tensions_n = seen.measured.tensions_n;
            tensions_n[AXIS] -= sign * back_n;
            assert_eq!(watched.monitors.stay_jumped(&tensions_n), stays, "{back_n}");
        }
    }
}

/// A jump lasts until the tension is back within half of what counts as one. One of a leg that is held already counts where its cells
/// are trusted.
#[test]
fn a_jump_lasts_until_the_tension_comes_back() {
    // By half of the least that counts as one, however far it jumped.
    for (led, trusted, jumps, counts) in [
        (true, false, 1.01, true),
        (true, false, 3.0, true),
        (false, true, 1.01, true),
        (false, false, 1.01, false),
    ] {
        let mut watched = Watched::new();
        let jump_n = f64::from(limits().jump_n);
        let mut seen = Seen::sound();
        (seen.led, seen.trusted) = (led, trusted);
        let stays = |watched: &Watched, off_n: f64| {
            let mut tensions_n = Seen::sound().measured.tensions_n;
            tensions_n[AXIS] += off_n;
            watched.monitors.stay_jumped(&tensions_n)
        };
        assert!(!stays(&watched, 100.0));
        seen.measured.tensions_n[AXIS] += jumps * jump_n;
        assert!(watched.cycle(&seen).has(Fault::TensionJump));
        // Back, which is another jump.
        (seen.led, seen.trusted) = (true, true);
        seen.measured.tensions_n = Seen::sound().measured.tensions_n;
        watched.cycle(&seen);
        for (part, away) in [(0.49, false), (0.51, true)] {
            assert_eq!(stays(&watched, part * jump_n), away && counts);
            assert_eq!(stays(&watched, -part * jump_n), away && counts);
        }
        assert_eq!(stays(&watched, f64::NAN), counts);
        watched.monitors.forget_jumps();
        assert!(!stays(&watched, 0.51 * jump_n));
    }
}
