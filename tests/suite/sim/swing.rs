//! A leg that swings, and what interrupts its brake.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, paper, pass, ticks};
use crate::common::require_said;
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::{Command, Compensation};
use leg_firmware::supervisor::{Fault, State};
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::plant::Defect;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Tick};

/// Commands take every cycle that the brake of the swing has not: many of them, one after the other, leave the leg braked.
#[test]
fn commands_in_the_middle_of_a_swing_leave_the_leg_at_rest() {
    let commands = "{ pretension_n = 70 },".repeat(8);
    let burst = format!("{{ wait_s = 0.03 }}, {commands}").repeat(6);
    let text = format!(
        "title = \"burst\"\nsteps = [\n\
         {{ await = {{ state = \"disarmed\", timeout_s = 1 }} }}, \"arm\", {{ wait_s = 0.5 }},\n\
         {{ payload = {{ kg = 1.5, over_s = 0.3 }} }},\n\
         {{ move = {{ azimuth_deg = 30, tilt_deg = 15 }} }}, {{ arrive = {{ then_s = 1, timeout_s = 5 }} }},\n\
         \"mark\", {{ push = {{ azimuth_deg = 90, force_n = 5, for_s = 0.1 }} }}, {burst}\n\
         {{ wait_s = 2 }},\n\
         {{ measure = {{ name = \"tip\", quantity = \"tip_error_mm\", between = [0, 0.02] }} }},\n\
         {{ measure = {{ name = \"tension\", quantity = \"tension_max_n\", between = [70, 130] }} }},\n]\n"
    );
    let scenario = Scenario::parse("burst", &text).unwrap();
    let rig = RigFile::load(None).unwrap();
    let simulation = Simulation::new(&scenario, &rig).unwrap();
    let summary = simulation.run(&mut InProcess::new(), &mut |_| ()).unwrap();
    assert!(
        summary.passes(),
        "{:#?} {:?}",
        summary.measurements,
        summary.faults
    );
}

/// The motors of a leg that is stopped in the middle of a swing, while they brake it, go on by a tenth of a millimetre at the most.
#[test]
fn a_leg_that_swings_is_held_where_it_is() {
    for wait_ms in [110, 130, 150, 170] {
        let text = format!(
            "title = \"stop\"\nsteps = [\n\
             {{ await = {{ state = \"disarmed\", timeout_s = 1 }} }}, \"arm\", {{ wait_s = 0.5 }},\n\
             {{ payload = {{ kg = 1.5, over_s = 0.3 }} }}, {{ wait_s = 1.5 }},\n\
             {{ push = {{ azimuth_deg = 90, force_n = 6, for_s = 0.1 }} }},\n\
             {{ wait_s = {} }}, \"stop\", {{ wait_s = 0.3 }},\n\
             {{ measure = {{ name = \"tension\", quantity = \"tension_max_n\", between = [70, 165] }} }},\n]\n",
            f64::from(wait_ms) / 1000.0
        );
        let scenario = Scenario::parse("stop", &text).unwrap();
        let rig = RigFile::load(None).unwrap();
        let simulation = Simulation::new(&scenario, &rig).unwrap();
        let mut pulled_m: Vec<[f32; 3]> = Vec::new();
        let mut braked = false;
        let mut watch = |tick: &Tick<'_>| {
            let telemetry = tick.telemetry;
            if telemetry.state == State::Held {
                pulled_m.push(telemetry.pulled_m);
            } else {
                braked |= tick.drive.duty.iter().any(|duty| duty.abs() > 0.05);
            }
        };
        let summary = simulation.run(&mut InProcess::new(), &mut watch).unwrap();
        assert!(summary.passes(), "{wait_ms} ms: {:?}", summary.measurements);
        assert!(braked, "{wait_ms} ms: nothing was braked");
        let (first, last) = (pulled_m[0], pulled_m[pulled_m.len() - 1]);
        for (before, after) in first.iter().zip(last) {
            let moved_m = (after - before).abs();
            assert!(moved_m < 1e-4, "{wait_ms} ms: {moved_m} m");
        }
    }
}

/// How far the motors go from when it is held, m, until they rest, and how far the tip swings about its end, mm.
fn held_ways(stand: &mut Stand) -> (f64, f64) {
    let pulled_m = stand.telemetry.unwrap().pulled_m;
    let mut tips_m = Vec::new();
    for _ in 0..ticks(1.0) {
        stand.tick().unwrap();
        tips_m.push(stand.truth.tip_m);
    }
    assert_eq!(stand.state(), State::Held);
    let gone = stand.telemetry.unwrap().pulled_m;
    let farthest_m = gone.iter().zip(pulled_m).fold(0.0_f64, |farthest, (a, b)| {
        farthest.max(f64::from(a - b).abs())
    });
    let end_m = tips_m[tips_m.len() - 1];
    let swings = tips_m.iter().map(|tip| (tip - end_m).norm() * 1e3);
    (farthest_m, swings.fold(0.0, f64::max))
}

/// A leg at rest whose compensation comes on is led by its motors: stopped, they brake; held by a load cell in doubt, they stand within
/// a few counts, for what they did may have been its error.
#[test]
fn a_leg_at_rest_is_held_at_once_where_a_load_cell_is_in_doubt() {
    let mut rising = armed(&paper(), [0.0, 25.0], 2.0, 5);
    rising
        .command(&Command::Compensation(Compensation::Off))
        .unwrap();
    pass(&mut rising, 2.0);
    rising
        .command(&Command::Compensation(Compensation::Estimated))
        .unwrap();
    pass(&mut rising, 0.3);
    assert_eq!(rising.state(), State::Active);
    let mut stopped = rising.clone();
    stopped.command(&Command::Stop).unwrap();
    pass(&mut stopped, 0.002);
    assert!(stopped.moving(), "it brakes");
    let (braking_m, swing_mm) = held_ways(&mut stopped);
    println!("stopped: {braking_m} m, swing {swing_mm} mm");
    assert!(braking_m > 2e-5 && swing_mm < 2.0);
    let mut doubted = rising;
    doubted.plant().set_defect(Defect::CellSaturated(0), true);
    while doubted.state() == State::Active {
        doubted.tick().unwrap();
    }
    assert!(!doubted.moving(), "it is held at once");
    let (gone_m, swing_mm) = held_ways(&mut doubted);
    println!("in doubt: {gone_m} m, swing {swing_mm} mm");
    assert!(gone_m < 1e-5 && swing_mm < 2.0);
}

/// Time from one push of a hand that shakes a leg to the next, s: a period of 4 Hz has two.
const SHAKE_S: f64 = 0.125;

/// Shakes a leg for as long, or until it is no longer active; `between` comes before each push.
fn shake(stand: &mut Stand, force_n: f64, pushes: u32, mut between: impl FnMut(&mut Stand, u32)) {
    let across = stand.plant().transverse(90.0);
    for push in 0..pushes {
        between(stand, push);
        let force_n = if push % 2 == 0 { force_n } else { -force_n };
        stand.plant().push(across * force_n, 0.06, 0.01);
        pass(stand, SHAKE_S);
        if stand.state() != State::Active {
            return;
        }
    }
}

/// On its way it swings by what it is asked for, too, so that a greater swing alone stops it. In how many seconds, the page of single faults says.
#[test]
fn a_leg_that_is_shaken_is_held_and_on_its_way_by_a_greater_swing_alone() {
    const PUSHES: u32 = 16;
    let within_s = f64::from(PUSHES) * SHAKE_S;
    let words = format!("{within_s} s; {} s on its way", 2.0 * within_s);
    require_said("host-tools/docs/fmea.md", &[words]);
    let resting = armed(&paper(), [0.0, 10.0], 0.5, 5);
    for (force_n, moves, pushes, held) in [
        (4.0, false, PUSHES, true),
        (1.0, false, PUSHES, true),
        (1.0, true, 2 * PUSHES, false),
        (4.0, true, 2 * PUSHES, true),
    ] {
        let mut stand = resting.clone();
        shake(&mut stand, force_n, pushes, |stand, push| {
            if moves && push % 3 == 0 {
                let tilt_deg = if push % 2 == 0 { 25.0 } else { 10.0 };
                stand.command(&move_to([0.0, tilt_deg])).unwrap();
            }
        });
        let what = format!("{force_n} N, moves {moves}: {:?}", stand.faults());
        assert_eq!(stand.state() == State::Held, held, "{what}");
        assert_eq!(stand.faults().has(Fault::Swings), held, "{what}");
    }
}
