//! A leg that is led to where no tensions hold what it carries.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, faults, paper, pass, ticks};
use crate::common::require_said;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

/// Part of the maximum tension that a leg which loses its target at full speed stays within.
const WITHIN: f64 = 1.6;

/// Two kilograms that the leg does not know, on a rig that holds less of them the farther it leans: it stops at once, swings, and is held.
#[test]
fn a_leg_that_loses_its_target_on_its_way_is_held() {
    require_said(
        "firmware/SAFETY.md",
        &[format!(
            "tension is up to {WITHIN} of the maximum, and it is held"
        )],
    );
    let mut ready = READY_RIGS.iter();
    let ready = ready.find(|ready| ready.name == "compliant_pivot").unwrap();
    let mut rig = RigFile::parse(ready.name, ready.text).unwrap();
    rig.pretension_n = 60.0;
    // What the swing raises: a tension beyond what its cell shows, or a pose that does not follow so soon.
    for (azimuth_deg, raised) in [(0.0, Fault::CellSaturated), (40.0, Fault::Residual)] {
        let mut stand = armed(&rig, [azimuth_deg, 5.0], 2.0, 91);
        stand.command(&move_to([azimuth_deg, 30.0])).unwrap();
        let lost = |stand: &Stand| faults(stand).has(Fault::Infeasible);
        stand.tick_until(3.0, "no target", lost).unwrap();
        let mut highest_n = 0.0_f64;
        for _ in 0..ticks(1.0) {
            stand.tick().unwrap();
            highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
        }
        let part = highest_n / rig.f_max_n;
        println!("azimuth {azimuth_deg}°: {part:.2} of the maximum");
        assert!(part < WITHIN, "{part}");
        assert_eq!(stand.state(), State::Held);
        assert!(stand.faults().has(raised), "{:?}", stand.faults());
    }
}

/// A pose beyond the workspace that was asked for and refused is no reason to hold a leg that can be left where it is.
#[test]
fn a_move_that_was_refused_does_not_end_the_station() {
    let mut stand = armed(&paper(), [40.0, 15.0], 0.5, 92);
    stand.command(&Command::Move { x: 0.7, y: 0.0 }).unwrap();
    pass(&mut stand, 0.1);
    assert!(faults(&stand).has(Fault::Infeasible));
    stand.command(&Command::KeepStation).unwrap();
    pass(&mut stand, 0.1);
    assert_eq!(stand.state(), State::KeepingStation);
}
