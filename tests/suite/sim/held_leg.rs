//! A leg that is held: for how long, and that no tension moves it.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, faults, paper, pass, ticks};
use crate::common::require_said;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_rig::rig_file::RigFile;
use leg_sim::plant::{Defect, Start};
use nalgebra::Vector3;

/// How little the tip of a leg moves that stands still, mm: its estimates' noise moves nothing.
const STILL_MM: f64 = 0.01;

/// A leg whose motors have to stand.
struct Standing {
    pulled_m: [f32; 3],
    unstretched_m: [f64; 3],
    tip_m: Vector3<f64>,
}

impl Standing {
    fn new(stand: &Stand) -> Self {
        Self {
            pulled_m: stand.telemetry.unwrap().pulled_m,
            unstretched_m: stand.truth.unstretched_m,
            tip_m: stand.truth.tip_m,
        }
    }

    /// A tick of a leg that is held: its drivers are on, and no motor is driven or turns.
    fn tick(&self, stand: &mut Stand) {
        stand.tick().unwrap();
        assert_eq!(stand.state(), State::Held);
        assert!(stand.motors.enabled);
        assert_eq!(stand.motors.duty, [0.0; 3]);
        assert_eq!(stand.telemetry.unwrap().pulled_m, self.pulled_m);
        for (now_m, before_m) in stand.truth.unstretched_m.iter().zip(self.unstretched_m) {
            assert!((now_m - before_m).abs() < 1e-6, "{now_m} m");
        }
    }

    fn moved_mm(&self, stand: &Stand) -> f64 {
        (stand.truth.tip_m - self.tip_m).norm() * 1e3
    }
}

/// A leg that was stopped at rest or on its way, and has come to rest.
fn held(pretension_n: f64, pose_deg: [f64; 2], payload_kg: f64, moves: bool) -> Stand {
    let mut rig = paper();
    rig.pretension_n = pretension_n;
    let mut stand = armed(&rig, pose_deg, payload_kg, 81);
    if moves {
        stand.command(&move_to([60.0, 10.0])).unwrap();
        pass(&mut stand, 0.2);
        assert!(stand.moving());
    }
    stand.command(&Command::Stop).unwrap();
    pass(&mut stand, 0.5);
    assert_eq!(stand.state(), State::Held);
    stand
}

/// Whether it was stopped or has lost its host, and whether a host is there.
#[test]
fn a_held_leg_stays_where_it_is_with_or_without_a_host() {
    let pose_deg = [60.0, 20.0];
    let stopped = held(70.0, pose_deg, 1.0, false);
    let mut silent = stopped.clone();
    silent.silence();
    let mut lost = armed(&paper(), pose_deg, 1.0, 81);
    lost.silence();
    pass(&mut lost, 0.5);
    let lost_faults = FaultSet::single(Fault::CommandTimeout);
    for (mut stand, expected, time_s) in [
        (stopped, FaultSet::NONE, 5.0),
        (silent, FaultSet::NONE, 60.0),
        (lost, lost_faults, 60.0),
    ] {
        let standing = Standing::new(&stand);
        for _ in 0..ticks(time_s) {
            standing.tick(&mut stand);
            assert_eq!(faults(&stand), expected);
            let moved_mm = standing.moved_mm(&stand);
            assert!(moved_mm < STILL_MM, "{moved_mm} mm");
        }
    }
}

/// A payload and pushes from all sides, on a leg that is held by high tensions: up to a tenth above the maximum, and down to slack tendons.
#[test]
fn a_held_leg_is_moved_by_no_tension() {
    let f_max_n = paper().f_max_n;
    let mut range_n = [f64::INFINITY, 0.0_f64];
    let mut moved_mm = 0.0_f64;
    for (pretension_n, payload_kg, moves) in [
        (110.0, 2.0, false),
        (110.0, 2.0, true),
        (30.0, 0.0, false),
        (30.0, 0.0, true),
    ] {
        let start = held(pretension_n, [60.0, 20.0], 0.5, moves);
        for azimuth_deg in (0..360).step_by(60) {
            let mut stand = start.clone();
            let standing = Standing::new(&stand);
            let plant = stand.plant();
            plant.set_payload(payload_kg, 1.0);
            plant.push(plant.transverse(f64::from(azimuth_deg)) * 8.0, 2.0, 1.0);
            for _ in 0..ticks(2.5) {
                let highest_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
                // Beyond a tenth more it is let down.
                if highest_n > 1.09 * f_max_n {
                    break;
                }
                standing.tick(&mut stand);
                for tension_n in stand.truth.tensions_n {
                    range_n = [range_n[0].min(tension_n), range_n[1].max(tension_n)];
                }
                moved_mm = moved_mm.max(standing.moved_mm(&stand));
            }
        }
    }
    println!("{range_n:?} N, the tip by {moved_mm} mm");
    assert!(range_n[1] > 1.05 * f_max_n, "{range_n:?} N");
    assert!(range_n[0] < 0.5 * paper().f_min_n, "{range_n:?} N");
}

/// A push that loads a tendon by more than a tenth above the maximum tension ramps down a leg that was stopped. One that lost its host stays: once a fault is
/// latched no load cell is trusted.
#[test]
fn only_a_leg_that_is_held_without_a_fault_is_let_down() {
    let pose_deg = [60.0, 20.0];
    let stopped = held(110.0, pose_deg, 0.5, false);
    let mut rig = paper();
    rig.pretension_n = 110.0;
    let mut lost = armed(&rig, pose_deg, 0.5, 81);
    lost.silence();
    pass(&mut lost, 0.5);
    assert_eq!(faults(&lost), FaultSet::single(Fault::CommandTimeout));
    for (mut stand, let_down) in [(stopped, true), (lost, false)] {
        let plant = stand.plant();
        plant.push(plant.transverse(60.0) * 30.0, 2.0, 1.0);
        let mut highest_n = 0.0_f64;
        for _ in 0..ticks(2.5) {
            stand.tick().unwrap();
            highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
        }
        assert!(highest_n > 1.15 * rig.f_max_n, "{highest_n} N");
        assert_eq!(faults(&stand).has(Fault::OverTension), let_down);
        assert_eq!(
            stand.state() == State::Held,
            !let_down,
            "{:?}",
            stand.state()
        );
    }
}

/// What truly is too much for a held leg ramps it down, also with load cells and curves that are 2 % off, at once or in some seconds, on each kind of
/// support. What a single cell says does not: `a_held_leg_is_not_paid_out_by_a_cell_that_drifted`.
#[test]
fn a_held_leg_that_is_overloaded_is_ramped_down() {
    for name in ["table1", "spherical", "leaf_spring_universal"] {
        for (curve_error, sign) in [(0.02, 1.0), (-0.02, 1.0), (0.02, -1.0), (-0.02, -1.0)] {
            for (pretension_n, payload_kg, over_s) in [(70.0, 5.0, 5.0), (100.0, 4.0, 0.3)] {
                let mut rig = RigFile::load(Some(name.as_ref())).unwrap();
                rig.pretension_n = pretension_n;
                rig.plant.curve_error = curve_error;
                rig.plant.cell_gain_error = [0.02, -0.02, 0.01].map(|error| sign * error);
                let what = format!("{name}, curves {curve_error}, cells {sign}, {over_s} s");
                let mut stand = armed(&rig, [0.0, 25.0], 0.0, 83);
                stand.command(&Command::Stop).unwrap();
                pass(&mut stand, 0.5);
                assert_eq!(stand.state(), State::Held, "{what}");
                stand.plant().set_payload(payload_kg, over_s);
                let end_s = stand.time_s() + over_s + 1.0;
                while stand.state() == State::Held && stand.time_s() < end_s {
                    stand.tick().unwrap();
                }
                assert_eq!(stand.state(), State::RampingDown, "{what}");
                let found = faults(&stand);
                assert_eq!(found, FaultSet::single(Fault::OverTension), "{what}");
            }
        }
    }
}

/// A cell that drifts so slowly that a leg at rest would learn it as creep, 0.2 N/s, comes to show more than a tenth above the maximum. The control law in f64
/// finds it some milliseconds sooner or later.
#[test]
fn a_held_leg_is_not_let_down_by_a_cell_that_drifts_slowly() {
    let mut rig = paper();
    rig.pretension_n = 130.0;
    let start = Start::Held {
        azimuth_deg: 60.0,
        tilt_deg: 3.0,
        pretension_n: rig.pretension_n,
        payload_kg: 0.0,
    };
    let mut stand = Stand::unjudged(&rig, &rig.plant, start, 81).unwrap();
    stand.wait(0.1).unwrap();
    stand.command(&Command::Arm).unwrap();
    stand.wait(2.0).unwrap();
    stand.command(&Command::Stop).unwrap();
    pass(&mut stand, 0.5);
    let standing = Standing::new(&stand);
    let mut shown_n = 0.0;
    // The defect drifts by 5 N/s: for one tick of 25.
    for _ in 0..ticks(250.0) / 25 {
        stand.plant().set_defect(Defect::CellDrifting(0), true);
        standing.tick(&mut stand);
        stand.plant().set_defect(Defect::CellDrifting(0), false);
        for _ in 1..25 {
            standing.tick(&mut stand);
        }
        shown_n = stand.telemetry.unwrap().tensions_n[0].into();
        if shown_n > 1.12 * rig.f_max_n {
            break;
        }
    }
    assert!(shown_n > 1.12 * rig.f_max_n, "{shown_n} N");
    assert_eq!(faults(&stand), FaultSet::single(Fault::Residual));
}

/// So is one that is pushed for a short time, or was stopped on its way, and swings: whatever is named, nothing is said of its sensors.
#[test]
fn an_overload_of_a_leg_that_swings_is_no_doubt_of_its_sensors() {
    for name in ["table1", "spherical", "leaf_spring_universal"] {
        for sign in [1.0, -1.0] {
            let mut rig = RigFile::load(Some(name.as_ref())).unwrap();
            rig.pretension_n = 100.0;
            rig.plant.curve_error = 0.02 * sign;
            rig.plant.cell_gain_error = [0.02, -0.02, 0.01].map(|error| sign * error);
            let sound = armed(&rig, [0.0, 20.0], 1.0, 84);
            for (moves, force_n, push_s) in
                [(false, 8.0, 0.05), (false, 14.0, 0.1), (true, 14.0, 0.1)]
            {
                let mut stand = sound.clone();
                if moves {
                    stand.command(&move_to([180.0, 10.0])).unwrap();
                    pass(&mut stand, 0.4);
                }
                stand.command(&Command::Stop).unwrap();
                pass(&mut stand, if moves { 0.0 } else { 0.5 });
                let force = Vector3::new(-force_n, 0.0, 0.0);
                stand.plant().push(force, push_s, 0.0);
                pass(&mut stand, 1.5);
                let found = faults(&stand);
                let highest_n = stand.truth.tensions_n;
                println!("{name} {sign} {moves} {force_n} N: {found:?} {highest_n:.0?}");
                assert!(!found.has(Fault::Residual), "{name}: {found:?}");
            }
        }
    }
}

/// A leg whose load cell is dead is not cleared, and is as soon as the cell is there again: what was refused meanwhile counts for nothing.
#[test]
fn a_held_leg_whose_load_cell_is_repaired_is_cleared() {
    for tendon in 0..3 {
        let mut stand = armed(&paper(), [0.0, 0.0], 0.0, 85);
        stand.plant().set_defect(Defect::CellDead(tendon), true);
        pass(&mut stand, 0.2);
        assert_eq!(stand.state(), State::Held);
        stand.command(&Command::Clear).unwrap();
        pass(&mut stand, 0.01);
        assert_eq!(stand.state(), State::Held);
        assert!(faults(&stand).has(Fault::Residual));
        stand.plant().set_defect(Defect::CellDead(tendon), false);
        pass(&mut stand, 0.2);
        stand.command(&Command::Clear).unwrap();
        pass(&mut stand, 0.1);
        assert_eq!(stand.state(), State::Active);
    }
}

/// A payload that is hung on a held leg of little pretension takes the tension of a tendon. Cleared, the leg takes that up where it is: the
/// tendons that carry it are not paid out for the slack one. By laws that did, the tip moved by 2.6 and 4.4 mm.
#[test]
fn a_held_leg_with_a_slack_tendon_is_cleared_where_it_is() {
    const MOVES_MM: f64 = 1.0;
    let words = format!("its tip moves by up to {MOVES_MM} mm while that is taken up");
    require_said("firmware/SAFETY.md", &[words]);
    for payload_kg in [1.7, 2.0] {
        let rig = paper();
        let mut stand = armed(&rig, [40.0, 25.0], 1.0, 82);
        stand.command(&Command::Pretension(30.0)).unwrap();
        pass(&mut stand, 2.0);
        stand.command(&Command::Stop).unwrap();
        pass(&mut stand, 0.5);
        stand.plant().set_payload(payload_kg, 1.0);
        pass(&mut stand, 3.0);
        assert_eq!(stand.state(), State::Held);
        let least_n = stand.truth.tensions_n.into_iter().fold(f64::MAX, f64::min);
        assert!(least_n < 0.5 * rig.f_min_n, "{least_n}");
        let standing_m = stand.truth.tip_m;
        stand.command(&Command::Clear).unwrap();
        let (mut moved_m, mut highest_n) = (0.0_f64, 0.0_f64);
        for _ in 0..ticks(4.0) {
            stand.tick().unwrap();
            moved_m = moved_m.max((stand.truth.tip_m - standing_m).norm());
            highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
        }
        println!(
            "{payload_kg} kg: tip {:.2} mm, {highest_n:.0} N",
            moved_m * 1e3
        );
        assert_eq!(stand.state(), State::Active);
        assert!(1e3 * moved_m < MOVES_MM, "{payload_kg} kg: {moved_m} m");
    }
}
