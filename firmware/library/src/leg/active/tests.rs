#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{Active, GIVEN_WAY_STEPS, Phase, StationKeeping};
use crate::command::Compensation;
use crate::control::{Measured, PretensionDemand};
use crate::leg::shared::{Checked, Shared};
use crate::set_point::{PointRefusal, SetPoint, StreamPart};
use crate::settings::Settings;
use crate::supervisor::{Fault, SETTLE_CYCLES};
use leg_model::{Direction, Error, TensionBounds};

/// The first set-point of a stream straight down.
const FIRST_POINT: SetPoint = SetPoint {
    part: StreamPart::First,
    tick: 4000,
    direction: [0.0; 2],
    rate: [0.0; 2],
    acceleration: None,
    tension: None,
};

/// What is measured of a leg at rest with these tensions.
fn measured(tensions_n: [f64; 3]) -> Measured<f64> {
    Measured::resting([0.0; 3], tensions_n)
}

/// A leg that was armed just now with tendons at this tension, N, and the minimum tension, N.
fn armed(part: f64) -> (Active<f64>, Shared<f64>, f64) {
    let settings = Settings::table_1().unwrap();
    let f_min_n = f64::from(settings.f_min_n);
    let mut shared = Shared::new(&settings, Checked::new(&settings).unwrap());
    shared.zero_m = Some([0.2; 3]);
    let active = Active::begin(&mut shared, &measured([part * f_min_n; 3]));
    (active, shared, f_min_n)
}

/// Every tendon has to pull by half of what any target asks for: a leg that was led down is left with more, one that was
/// paid out with less. Nothing is followed before.
#[test]
fn tendons_that_pull_already_are_not_taken_up_from_slack() {
    let settings = Settings::table_1().unwrap();
    let f_min_n = f64::from(settings.f_min_n);
    for (parts, taut) in [
        ([1.0; 3], true),
        ([0.51; 3], true),
        ([0.49; 3], false),
        ([0.0; 3], false),
        ([9.0, 0.49, 9.0], false),
        ([9.0, 9.0, 0.51], true),
    ] {
        let tensions_n = parts.map(|part| part * f_min_n);
        let measured = measured(tensions_n);
        let mut shared = Shared::new(&settings, Checked::new(&settings).unwrap());
        let mut active = Active::begin(&mut shared, &measured);
        assert_eq!(active.slack.taken_up(), taut, "{tensions_n:?}");
        assert!(!active.tensioned);
        let followed = active.follow(&mut shared, 0, &FIRST_POINT);
        let expected = if taut {
            Ok(())
        } else {
            Err(PointRefusal::NotTaut)
        };
        assert_eq!(followed, expected);
    }
}

/// A leg that can be left where it is rests at its target, taut and with its load compensated, and the settings allow it. Each of these is
/// needed; a command that was refused is no matter.
#[test]
fn station_is_kept_only_where_the_leg_can_be_left() {
    let ready = || {
        let (mut active, mut shared, _) = armed(1.0);
        active.tensioned = true;
        shared.station.allowed = true;
        (active, shared)
    };
    let (active, mut shared) = ready();
    shared.refused = true;
    assert!(active.may_keep_station(&shared));
    type Spoil = fn(&mut Active<f64>, &mut Shared<f64>);
    let spoils: [Spoil; 7] = [
        |active, _| active.tensioned = false,
        |active, shared| active.go(shared, &Direction::from_xy(0.1, 0.0).unwrap()),
        |active, _| active.station = StationKeeping::Releasing([1e-4; 3]),
        |_, shared| shared.station.allowed = false,
        |active, _| active.without_target = true,
        |_, shared| shared.compensation = Compensation::Off,
        |_, shared| shared.compensation = Compensation::Frozen,
    ];
    for (i, spoil) in spoils.iter().enumerate() {
        let (mut active, mut shared) = ready();
        spoil(&mut active, &mut shared);
        assert!(!active.may_keep_station(&shared), "{i}");
    }
}

/// A leg counts as tensioned from when every tendon is above the minimum tension, and stays so whatever comes then.
#[test]
fn a_leg_is_tensioned_once_every_tendon_is_above_the_minimum() {
    let (mut active, mut shared, f_min_n) = armed(1.0);
    for (parts, tensioned) in [
        ([1.1, 1.1, 0.9], false),
        ([0.9, 1.1, 1.1], false),
        ([0.9; 3], false),
        ([1.1; 3], true),
        ([0.9; 3], true),
    ] {
        // The pose is no matter.
        let _ = active.estimate(&mut shared, &measured(parts.map(|part| part * f_min_n)));
        assert_eq!(active.tensioned, tensioned, "{parts:?}");
    }
}

/// A leg that was armed taut begins so only as long as its sensors settle; one that was armed slack does not.
#[test]
fn a_leg_begins_taut_while_its_sensors_settle() {
    for (part, taut) in [(0.9, true), (0.0, false)] {
        let (mut active, mut shared, f_min_n) = armed(part);
        let shown = measured([part * f_min_n; 3]);
        for _ in 0..SETTLE_CYCLES {
            assert_eq!(active.begins_taut(), taut);
            let _ = active.estimate(&mut shared, &shown);
        }
        assert_eq!(active.begins_taut(), taut);
        let _ = active.estimate(&mut shared, &shown);
        assert!(!active.begins_taut());
    }
}

/// Nor is it slack while it searches where it begins without its load.
#[test]
fn a_leg_whose_load_is_left_out_begins_taut_too() {
    for (part, taut) in [(0.9, true), (0.0, false)] {
        let (_, mut shared, f_min_n) = armed(part);
        shared.compensation = Compensation::Off;
        let mut active = Active::begin(&mut shared, &measured([part * f_min_n; 3]));
        assert_eq!(active.unloaded.is_some(), taut);
        assert_eq!(active.begins_taut(), taut);
        active.unloaded = None;
        active.slack.left_m = taut.then_some(0.0);
        assert_eq!(active.begins_taut(), taut);
    }
}

/// A leg rests without a target from when there is none until there is one, it is sent anywhere, or it is led down to be disarmed.
#[test]
fn a_leg_rests_without_a_target_until_it_has_one_or_is_sent() {
    let stayed = || {
        let (mut active, mut shared, _) = armed(8.0);
        assert!(!active.rests_without_target());
        active.stay(&mut shared);
        assert!(active.rests_without_target());
        (active, shared)
    };
    let (mut active, mut shared) = stayed();
    active.go(&mut shared, &Direction::straight_down());
    assert!(!active.rests_without_target());
    let (mut active, mut shared) = stayed();
    active.disarm(&mut shared);
    active.stay(&mut shared);
    assert!(!active.rests_without_target() && active.led_down());
    let (mut active, mut shared) = stayed();
    let _ = active.estimate(&mut shared, &measured([64.0; 3]));
    active.aim(&mut shared, &measured([64.0; 3])).unwrap();
    assert!(!active.rests_without_target());
}

/// Where there is no target in the middle of a move the motors are led nowhere in the same tick, and the move is over.
#[test]
fn a_leg_that_loses_its_target_stops_in_the_same_tick() {
    let (mut active, mut shared, f_min_n) = armed(8.0);
    let measured = measured([8.0 * f_min_n; 3]);
    let away = Direction::from_xy(0.3, 0.0).unwrap();
    active.go(&mut shared, &away);
    active.pretensioned = true;
    for _ in 0..100 {
        cycle(&mut active, &mut shared, &measured);
    }
    let led = |shared: &Shared<f64>| shared.axes.iter().any(|axis| axis.led_m() != 0.0);
    assert!(active.moving() && led(&shared));
    // What is left between the bounds leans the leg no farther.
    let most_n = 1.001 * f_min_n;
    shared.mechanism.bounds = TensionBounds::new(f_min_n, most_n).unwrap();
    shared.mechanism.holding_max_n = most_n;
    let lost = active.step(Phase::Target, &mut shared, &measured);
    assert_eq!(lost, Err(Error::Infeasible));
    assert!(!led(&shared) && active.rests_without_target() && shared.refused);
}

/// Where the compensation is frozen the load stays as it is, and then until the leg has come to rest: neither its way nor the command alone
/// ends that.
#[test]
fn a_load_that_was_frozen_stays_so_until_the_leg_rests() {
    use Compensation::{Estimated, Frozen, Off};
    let away = Direction::from_xy(0.1, 0.0).unwrap();
    for (before, compensation, moves, frozen) in [
        (false, Frozen, false, true),
        (false, Frozen, true, true),
        (false, Estimated, false, false),
        (false, Estimated, true, false),
        (false, Off, true, false),
        (true, Frozen, false, true),
        (true, Estimated, true, true),
        (true, Estimated, false, false),
        (true, Off, false, false),
    ] {
        let (mut active, mut shared, f_min_n) = armed(2.0);
        active.tensioned = true;
        active.frozen = before;
        active.pretensioned = true;
        shared.compensation = compensation;
        if moves {
            active.go(&mut shared, &away);
        }
        // The pose is no matter.
        let _ = active.estimate(&mut shared, &measured([2.0 * f_min_n; 3]));
        assert_eq!(active.frozen, frozen, "{before} {compensation:?} {moves}");
    }
}

/// A leg that gives way to its maximum tension for 8 ms has stayed behind: only one at rest, whose tendons have all pulled since it was armed, and
/// not where that ends before.
#[test]
fn a_leg_at_rest_that_gives_way_for_long_stays_behind() {
    let away = Direction::from_xy(0.1, 0.0).unwrap();
    for (tensioned, moves, part, pause, behind) in [
        (true, false, 0.96, None, true),
        (true, false, 0.94, None, false),
        (false, false, 0.96, None, false),
        (true, true, 0.96, None, false),
        (true, false, 0.96, Some(GIVEN_WAY_STEPS - 1), false),
    ] {
        let (mut active, mut shared, _) = armed(2.0);
        let f_max_n = shared.mechanism.f_max_n;
        active.tensioned = tensioned;
        shared.compensation = Compensation::Off;
        active.pretensioned = true;
        if moves {
            active.go(&mut shared, &away);
        }
        for step in 1..=GIVEN_WAY_STEPS {
            for axis in &mut shared.axes {
                axis.rest(6e-5);
            }
            let part = if pause == Some(step) { 0.9 } else { part };
            let shown = measured([part * f_max_n, 20.0, 20.0]);
            let stepped = active.step(Phase::Offsets, &mut shared, &shown);
            assert_eq!(stepped, Ok(()));
            let stays_behind = active.faults.has(Fault::Following);
            let expected = behind && step == GIVEN_WAY_STEPS;
            assert_eq!(stays_behind, expected, "{tensioned} {moves} {part} {step}");
        }
    }
}

/// One cycle, without what comes every other one.
fn cycle(active: &mut Active<f64>, shared: &mut Shared<f64>, measured: &Measured<f64>) {
    for phase in [Phase::Estimate, Phase::Target, Phase::Plan] {
        active.step(phase, shared, measured).unwrap();
    }
}

/// A leg that was armed at the minimum tension and sent away at once, and what is measured of it.
fn sent() -> (Active<f64>, Shared<f64>, Measured<f64>) {
    let (mut active, mut shared, f_min_n) = armed(1.0);
    active.go(&mut shared, &Direction::from_xy(0.1, 0.0).unwrap());
    (active, shared, measured([f_min_n; 3]))
}

/// A leg sets out on a move once its pretension has come up to within 5 %, and not before: until then it moves for its host, and rests for itself.
#[test]
fn a_move_waits_for_the_pretension() {
    let (mut active, mut shared, shown) = sent();
    let wish_n = shared.pretension.pretension_n();
    let mut planned = 0;
    for _ in 0..5000 {
        cycle(&mut active, &mut shared, &shown);
        let up = shared.target.unwrap().pretension_n >= 0.95 * wish_n;
        assert!(active.moving());
        assert_eq!(active.has_set_out(), up);
        planned += usize::from(up);
        if active.trajectory.ticks_to_end().is_some() {
            assert!(up && planned < 20, "{planned}");
            return;
        }
    }
    panic!("it does not set out");
}

/// A move does not wait for a pretension that the bounds do not allow, nor for one that falls.
#[test]
fn no_move_waits_for_a_pretension_that_does_not_come_up() {
    let (mut active, mut shared, shown) = sent();
    shared.pretension.demand(PretensionDemand::Pretension(1e3));
    for _ in 0..5000 {
        cycle(&mut active, &mut shared, &shown);
    }
    let target = shared.target.unwrap();
    assert!(active.pretensioned && target.pretension_n > 0.9 * target.distribution.pretension_max);
    let (mut active, mut shared, f_min_n) = armed(10.0);
    shared
        .pretension
        .demand(PretensionDemand::Pretension(2.0 * f_min_n));
    cycle(&mut active, &mut shared, &measured([10.0 * f_min_n; 3]));
    assert!(active.pretensioned);
}

/// A stream has its own times, and a leg that is led down may be so with less.
#[test]
fn a_stream_and_a_disarm_do_not_wait_for_the_pretension() {
    let (mut active, mut shared, shown) = sent();
    active.hold(&mut shared);
    assert!(!active.moving());
    active.follow(&mut shared, 0, &FIRST_POINT).unwrap();
    cycle(&mut active, &mut shared, &shown);
    assert!(active.has_set_out() && active.pretensioned);
    let (mut active, mut shared, shown) = sent();
    active.disarm(&mut shared);
    cycle(&mut active, &mut shared, &shown);
    assert!(active.has_set_out());
}

/// A hold of a leg that has not set out leaves it where it is.
#[test]
fn a_move_that_waits_is_over_with_a_hold() {
    let (mut active, mut shared, shown) = sent();
    cycle(&mut active, &mut shared, &shown);
    active.hold(&mut shared);
    for _ in 0..5000 {
        cycle(&mut active, &mut shared, &shown);
        assert!(!active.moving());
    }
    assert!(active.pretensioned);
}
