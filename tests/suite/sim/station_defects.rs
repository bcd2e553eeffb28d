//! Sensors, motors and loads that fail while the leg keeps station.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{Excursion, armed, faults, keeping, paper, pass};
use crate::common::require_said;
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_sim::plant::Defect;

/// How far a cell that reads wrong may lead the tip of a leg at rest, mm.
const LIES_MM: f64 = 0.5;

/// One sensor that reads wrong while the leg keeps station: the tip stays where it is, and most are found.
#[test]
fn a_sensor_that_reads_wrong_ends_it_in_hold_or_moves_nothing() {
    let found_always: [fn(usize) -> Defect; 15] = [
        Defect::CellStuck,
        Defect::CellSaturated,
        Defect::CellDead,
        Defect::CellStale,
        Defect::CellDrifting,
        Defect::CellExcitationLost,
        Defect::CellFades,
        Defect::CellWanders,
        Defect::CellHum,
        Defect::CellGainStep,
        Defect::CellGainStepDown,
        Defect::CellOffsetStep,
        Defect::CellOffsetStepDown,
        Defect::CellReversed,
        Defect::CellCrosstalk,
    ];
    let found_sometimes: [fn(usize) -> Defect; 6] = [
        Defect::CellGainDrift,
        Defect::CellGainDriftDown,
        Defect::CellFollows,
        Defect::CellSticks,
        Defect::CellLate,
        Defect::CellPwmNoise,
    ];
    let both = found_always.map(|defect| (defect, true)).into_iter();
    let both = both.chain(found_sometimes.map(|defect| (defect, false)));
    let sound = keeping(&paper(), [30.0, 20.0], 1.0, 21);
    let home_m = sound.truth.tip_m;
    for (number, (defect, always)) in both.flat_map(|one| [one; 3]).enumerate() {
        let defect = defect(number % 3);
        let mut bench = sound.clone();
        bench.plant().set_defect(defect, true);
        let found = Excursion::new(&mut bench, home_m, if always { 2.5 } else { 5.0 });
        assert!(found.largest_mm < LIES_MM, "{defect:?}: {found:?}");
        let held = bench.state() == State::Held;
        assert!(
            held || !always && bench.state() == State::KeepingStation,
            "{defect:?}"
        );
        assert_eq!(held, faults(&bench).stopping().any(), "{defect:?}");
    }
    for (defect, fault) in [
        (Defect::ExcitationLost, None),
        (Defect::ExcitationSags, Some(Fault::TensionJump)),
        (Defect::SupplySag, Some(Fault::SupplyLow)),
        (Defect::SupplySurge, Some(Fault::SupplyHigh)),
        (Defect::LateTicks, Some(Fault::LateTick)),
    ] {
        let mut bench = sound.clone();
        bench.plant().set_defect(defect, true);
        let found = Excursion::new(&mut bench, home_m, 1.0);
        assert!(found.largest_mm < LIES_MM, "{defect:?}: {found:?}");
        assert_eq!(bench.state(), State::Held, "{defect:?}");
        assert!(
            fault.is_none_or(|fault| faults(&bench).has(fault)),
            "{defect:?}"
        );
    }
}

/// A cell that drifts to the maximum tension has the leg lower its pretension: the other tendons change by more than the cell, as they would by a
/// load, and may stretch otherwise than by their curves. It is found all the same, whether the leg keeps station or follows.
#[test]
fn a_cell_that_drifts_to_the_maximum_tension_is_found() {
    const FOUND_S: f64 = 6.0;
    let mut rig = paper();
    rig.pretension_n = 94.0;
    let mut keeping = keeping(&rig, [132.0, 30.0], 1.37, 32);
    let mut following = armed(&rig, [132.0, 30.0], 1.37, 33);
    for bench in [&mut keeping, &mut following] {
        let home_m = bench.truth.tip_m;
        bench.plant().set_defect(Defect::CellDrifting(1), true);
        let found = Excursion::new(bench, home_m, FOUND_S);
        assert!(found.largest_mm < 1.4, "{found:?}");
        assert_eq!(bench.state(), State::Held);
        assert!(faults(bench).has(Fault::Residual), "{:?}", faults(bench));
    }
}

/// A cell that drifts by 0.2 N/s, less than a leg at rest takes for creep, is found before it has led the tip away. One that drifts by
/// 0.02 N/s is not, and leads the tip by little in a minute.
#[test]
fn a_cell_that_drifts_slowly_does_not_lead_the_leg_away() {
    const SLOW_MM: f64 = 0.2;
    let [fast, slow] =
        [25, 250].map(|every| drifted(keeping(&paper(), [30.0, 20.0], 1.0, 31), 0, every));
    assert_eq!(
        (fast.1, fast.2),
        (State::Held, FaultSet::single(Fault::Residual))
    );
    assert!(fast.0 < LIES_MM, "{} mm", fast.0);
    assert_eq!((slow.1, slow.2), (State::KeepingStation, FaultSet::NONE));
    assert!(slow.0 < SLOW_MM, "{} mm", slow.0);
    let drifts = |every: u32| 5.0 / f64::from(every);
    require_said(
        "firmware/SAFETY.md",
        &[
            format!("moves its tip by less than {LIES_MM} mm"),
            format!("one that drifts by {} N/s", drifts(25)),
            format!("One that drifts by {} N/s is not found", drifts(250)),
            format!("than {SLOW_MM} mm in a minute"),
        ],
    );
}

/// A leg that follows, and whose pretension the maximum tension limits, would lower it for such a cell, too, and learns as little.
#[test]
fn a_cell_that_drifts_slowly_at_the_maximum_tension_is_found() {
    let mut rig = paper();
    rig.pretension_n = 94.0;
    let mut leg = armed(&rig, [132.0, 30.0], 1.37, 34);
    leg.command(&Command::Pretension(105.0)).unwrap();
    pass(&mut leg, 1.5);
    let telemetry = leg.telemetry.unwrap();
    assert!(telemetry.faults.has(Fault::Unreachable));
    let [first_n, second_n, third_n] = telemetry.target_tensions_n;
    assert!(second_n > first_n.max(third_n));
    const LED_MM: f64 = 0.7;
    const EVERY: u32 = 12;
    let (led_mm, state, faults) = drifted(leg, 1, EVERY);
    assert_eq!(state, State::Held);
    assert!(faults.has(Fault::Residual), "{faults:?}");
    assert!(led_mm < LED_MM, "{led_mm} mm");
    let drift = 5.0 / f64::from(EVERY);
    let words = format!("by less than {LED_MM} mm by one that drifts by {drift:.1} N/s");
    require_said("firmware/SAFETY.md", &[words]);
}

/// How far the tip is led in a minute, mm, by a cell that drifts by 5 N/s for one tick of so many; what the leg does, and its faults.
fn drifted(mut bench: Stand, cell: usize, every: u32) -> (f64, State, FaultSet) {
    let home_m = bench.truth.tip_m;
    let mut largest_mm = 0.0_f64;
    for _ in 0..60 * u32::from(TICK_HZ) / every {
        let drifting = Defect::CellDrifting(cell);
        bench.plant().set_defect(drifting, true);
        bench.tick().unwrap();
        bench.plant().set_defect(drifting, false);
        for _ in 1..every {
            bench.tick().unwrap();
        }
        largest_mm = largest_mm.max((bench.truth.tip_m - home_m).norm() * 1e3);
    }
    (largest_mm, bench.state(), faults(&bench))
}

/// A cell that begins to read wrong just after two kilograms were hung on the leg: the change of the load hides a part of the error, and not each
/// is found. The tip stays within what SAFETY.md says.
#[test]
fn a_cell_that_reads_wrong_after_a_payload_has_come_moves_the_tip_by_little() {
    let sound = keeping(&paper(), [60.0, 20.0], 0.0, 22);
    let home_m = sound.truth.tip_m;
    const AFTER_LOAD_MM: f64 = 0.8;
    const TAKEN_MM: f64 = 4.5;
    let mut farthest_mm = 0.0_f64;
    for defect in [
        Defect::CellOffsetStep,
        Defect::CellOffsetStepDown,
        Defect::CellCrosstalk,
        Defect::CellGainDrift,
    ] {
        for cell in 0..3 {
            let mut bench = sound.clone();
            bench.plant().set_payload(2.0, 0.2);
            pass(&mut bench, 0.3);
            bench.plant().set_defect(defect(cell), true);
            let found = Excursion::new(&mut bench, home_m, 7.0);
            if bench.state() == State::KeepingStation {
                farthest_mm = farthest_mm.max(found.end_mm);
            } else {
                assert_eq!(bench.state(), State::Held, "{:?}", defect(cell));
                // No farther than the payload took it.
                assert!(found.largest_mm < TAKEN_MM, "{:?}: {found:?}", defect(cell));
            }
        }
    }
    assert!(farthest_mm < AFTER_LOAD_MM, "{farthest_mm} mm");
    require_said(
        "firmware/SAFETY.md",
        &[
            format!("leads it by less than {AFTER_LOAD_MM} mm"),
            format!("no farther away than the payload has taken it, {TAKEN_MM} mm"),
        ],
    );
}

/// A motor or a counter that fails while the leg corrects switches it off or holds it, or the correction comes to its end. The tip goes
/// at most a millimetre beyond where the payload takes it.
#[test]
fn a_motor_that_fails_in_a_correction_ends_it() {
    let sound = keeping(&paper(), [60.0, 20.0], 0.0, 23);
    let home_m = sound.truth.tip_m;
    for defect in [
        Defect::EncoderLost,
        Defect::EncoderReversed,
        Defect::EncoderJumps,
        Defect::MotorJammed,
        Defect::HalfBridgeOpen,
        Defect::HalfBridgeOpenOutwards,
        Defect::CurrentOffset,
        Defect::CurrentZero,
        Defect::DriverFault,
    ] {
        for motor in 0..3 {
            let mut bench = sound.clone();
            bench.plant().set_payload(2.0, 0.2);
            pass(&mut bench, 0.5);
            bench.plant().set_defect(defect(motor), true);
            let found = Excursion::new(&mut bench, home_m, 4.0);
            let what = format!("{:?}: {found:?}", defect(motor));
            match bench.state() {
                State::Off | State::Held => assert!(faults(&bench).any(), "{what}"),
                state => assert!(
                    state == State::KeepingStation && found.end_mm < 0.1,
                    "{what}"
                ),
            }
            assert!(found.largest_mm < 4.9, "{what}");
        }
    }
}

/// What pulls a tendon above the maximum tension has it paid out: faster than a correction, and the leg comes back as slowly. The push
/// comes at once, and the tip swings beyond where it rests: by 10.8 mm, or 10.9 mm without a brake.
#[test]
fn a_push_to_the_maximum_tension_is_given_way_to() {
    const FARTHEST_MM: f64 = 11.0;
    const PUSH_N: f64 = 9.0;
    let mut bench = keeping(&paper(), [60.0, 20.0], 2.0, 24);
    let home_m = bench.truth.tip_m;
    let plant = bench.plant();
    plant.push(plant.transverse(60.0) * PUSH_N, 2.0, 0.0);
    let found = Excursion::new(&mut bench, home_m, 8.0);
    let words = format!("a push of {PUSH_N} N beside 2 kg moves the tip by up to {FARTHEST_MM} mm");
    require_said("firmware/SAFETY.md", &[words]);
    assert!(
        found.largest_mm < FARTHEST_MM && found.end_mm < 0.1,
        "{found:?}"
    );
    assert!(found.mm_per_s > 10.0, "it is held back: {found:?}");
    assert_eq!(bench.state(), State::KeepingStation);
    assert_eq!(faults(&bench), FaultSet::NONE);
}
