//! A leg that is armed and disarmed again before its tendons pull.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{paper, pass};
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::{FaultSet, State};
use leg_sim::plant::{Defect, Start};

/// How often, and for how long each time, s: half of what it takes until the tendons pull.
const TIMES: u32 = 12;
const ARMED_S: f64 = 0.1;

/// How far a tendon is paid out more than at first, m: what the servo leaves.
const MORE_M: f64 = 1e-4;

/// Travels that relax a leg which leans by 20°.
const STEPS: u32 = 2;

/// What a tendon may still pull by that was relaxed, N.
const RELAXED_N: f64 = 1.0;

/// A leg with tendons that pull, and motors that are off.
fn standing(tilt_deg: f64, payload_kg: f64) -> Stand {
    let rig = paper();
    let start = Start::Held {
        azimuth_deg: 40.0,
        tilt_deg,
        pretension_n: rig.pretension_n,
        payload_kg,
    };
    let mut stand = Stand::new(&rig, &rig.plant, start, 17).unwrap();
    stand.wait(0.1).unwrap();
    stand
}

fn arm(stand: &mut Stand, time_s: f64) {
    stand.command(&Command::Arm).unwrap();
    pass(stand, time_s);
    assert_eq!(stand.state(), State::Active);
}

fn disarm(stand: &mut Stand) {
    stand.command(&Command::Disarm).unwrap();
    pass(stand, 0.01);
    let disarmed = |stand: &Stand| stand.state() == State::Disarmed;
    stand.tick_until(10.0, "disarmed", disarmed).unwrap();
    pass(stand, 0.2);
}

/// Each of them would pay the tendons out by the whole travel, until the leg had to be homed, and could not be.
#[test]
fn a_leg_that_is_armed_often_is_paid_out_no_farther() {
    let mut stand = standing(0.0, 0.0);
    arm(&mut stand, 1.0);
    disarm(&mut stand);
    let relaxed_m = stand.telemetry.unwrap().pulled_m;
    for time in 0..TIMES {
        arm(&mut stand, ARMED_S);
        disarm(&mut stand);
        let now_m = stand.telemetry.unwrap().pulled_m;
        for (now, relaxed) in now_m.into_iter().zip(relaxed_m) {
            let more_m = f64::from(relaxed - now);
            assert!(more_m < MORE_M, "{time}: {more_m} m");
        }
    }
    arm(&mut stand, 3.0);
    assert_eq!(stand.faults(), FaultSet::NONE);
}

/// Its load cells show nothing while its tendons pull, as an emergency stop leaves them: what they show makes no tendon slack.
#[test]
fn a_leg_whose_load_cells_show_nothing_is_relaxed() {
    for armed_s in [0.01, ARMED_S] {
        let mut stand = standing(0.0, 0.0);
        arm(&mut stand, 1.0);
        disarm(&mut stand);
        arm(&mut stand, 3.0);
        stand.plant().press_emergency_stop(true);
        pass(&mut stand, 0.3);
        stand.plant().press_emergency_stop(false);
        pass(&mut stand, 0.3);
        stand.command(&Command::Clear).unwrap();
        pass(&mut stand, 0.2);
        assert_eq!(stand.state(), State::Disarmed);
        let [before_n, ..] = stand.truth.tensions_n;
        assert!(before_n > 50.0, "{before_n} N");
        stand.plant().set_defect(Defect::ExcitationLost, true);
        pass(&mut stand, 1.0);
        arm(&mut stand, armed_s);
        disarm(&mut stand);
        for tension_n in stand.truth.tensions_n {
            assert!(tension_n < RELAXED_N, "{armed_s} s: {tension_n} N");
        }
    }
}

/// One travel is not enough for it. It is paid out by as much each time until it is slack.
#[test]
fn a_leg_that_leans_with_dead_load_cells_is_relaxed_in_steps() {
    let mut stand = standing(20.0, 1.0);
    stand.plant().set_defect(Defect::ExcitationLost, true);
    pass(&mut stand, 1.0);
    for _ in 0..STEPS {
        arm(&mut stand, ARMED_S);
        disarm(&mut stand);
    }
    for tension_n in stand.truth.tensions_n {
        assert!(tension_n < RELAXED_N, "{tension_n} N");
    }
}
