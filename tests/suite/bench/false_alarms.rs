//! Uses of legs with which nothing is wrong: none may raise an alarm. `leg strikes --false-alarms` makes hours of them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::strikes::campaign;
use leg_bench::strikes::StrikeCampaign;
use leg_rig::ready_rigs::READY_RIGS;

/// Asserts that a part of a use of a seed, on its rig, goes on for so many seconds without an alarm that is not true.
fn require_no_alarm(seed: u64, part: u64, rig: &str, time_s: f64) {
    let usage = StrikeCampaign {
        seed,
        ..campaign("none")
    }
    .repeat_use(part, time_s);
    assert_eq!(usage.rig, rig);
    assert_eq!(usage.stopped, None);
    let alarms: Vec<_> = usage.alarms.iter().filter(|alarm| !alarm.beyond).collect();
    assert!(alarms.is_empty(), "{alarms:?}");
    assert!(usage.time_s >= time_s);
}

/// A use that once ended in an alarm: a leg that was stopped and armed in a push, which took a tendon's tension, swung by 160 N as that came
/// taut, and what its sensors showed then was taken for how they agree.
#[test]
fn a_leg_that_swings_hard_as_its_tendons_come_taut_raises_no_alarm() {
    require_no_alarm(660_014, 10, "compliant_pivot", 12.0);
}

/// Uses that once ended in **leg swings**: a push that lasts was taken for a swing that grows.
#[test]
fn a_leg_that_is_pushed_while_it_swings_raises_no_alarm() {
    require_no_alarm(61177, 0, "table1", 80.0);
    require_no_alarm(5503, 3, "compliant_pivot", 300.0);
}

/// A use that once ended in **motor stays behind**: a motor that the servo had slowed down near the maximum tension had not caught up yet
/// where its way ended.
#[test]
fn a_motor_that_is_slowed_down_near_the_maximum_tension_may_catch_up() {
    require_no_alarm(5502, 10, "compliant_pivot", 322.0);
}

/// A use that once ended in **motor runs away**: a motor that paid out at its highest speed was led to stop, and braked by all it had.
#[test]
fn a_motor_that_brakes_as_hard_as_it_can_does_not_run_away() {
    require_no_alarm(5502, 5, "notch_universal", 342.0);
}

/// A use that once ended in **motor runs away**: a motor that paid out was led to turn about, and was still 0.45 mm away as it braked.
#[test]
fn a_motor_that_brakes_as_it_pays_out_does_not_run_away() {
    require_no_alarm(20_261_129, 4, "elastic_rod_universal", 561.0);
}

/// A use that once ended in **sensors disagree**: a leg that can twist was armed with the torsion of its last target, which a frozen load that was
/// gone had been part of. Its estimated pose jumped by half a degree.
#[test]
fn a_leg_is_armed_with_the_torsion_that_its_tendons_show() {
    require_no_alarm(70707, 36, "spherical", 362.0);
}

/// A use that once ended in **sensors disagree**: a push that had come while the load was frozen was taken for 4 kg at once when the leg was on
/// its way, and its tensions jumped.
#[test]
fn a_frozen_load_is_let_go_where_the_leg_rests() {
    require_no_alarm(70707, 69, "leaf_spring_universal", 100.0);
}

/// A use that once ended in **sensors disagree**: a leg stayed where it was, as no tensions held the load that had been frozen. Its load left out, there was
/// a target again that was made for nine tenths of that load: led there, the motors turned by 0.1 mm at once.
#[test]
fn a_leg_without_a_target_goes_on_from_where_it_stays() {
    require_no_alarm(20_261_127, 49, "table1", 64.0);
}

/// A use that once ended in **sensors disagree**: a push and a payload that had been frozen together were told apart again off the target, where
/// the whole of the load was kept but not that at the target. Its tensions jumped by 12 N, and what the damping of a soft tendon was
/// to lag was taken for its length.
#[test]
fn a_load_that_is_let_go_off_the_target_moves_no_target() {
    require_no_alarm(20_261_201, 64, "spherical", 440.0);
}

/// A part of a use of each rig.
#[test]
fn a_leg_that_is_used_raises_no_alarm() {
    let usages = campaign("none").use_legs(20.0, |_| ());
    assert_eq!(usages.len(), READY_RIGS.len());
    for usage in &usages {
        assert_eq!(
            (usage.left_shadow, &usage.stopped),
            (0, &None),
            "{}",
            usage.rig
        );
        assert!(usage.time_s >= 20.0 && usage.uses > 10);
        let alarms: Vec<_> = usage.alarms.iter().filter(|alarm| !alarm.beyond).collect();
        assert!(alarms.is_empty(), "{alarms:?}");
    }
}
