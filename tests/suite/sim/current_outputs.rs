//! Drivers whose current outputs show no more than a magnitude, all the time or while the bridge drives.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::{require_shadow, scenario};
use super::station_stand::{armed, pass};
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, FaultSet};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::plant::{Defect, Start};
use leg_sim::simulation::{Simulation, Summary};

const OUTPUTS: [&str; 2] = ["magnitude", "magnitude_when_driven"];

fn rig(output: &str) -> RigFile {
    let more = format!("[actuator]\ncurrent_output = \"{output}\"\n");
    RigFile::parse(output, &[READY_RIGS[0].text, &more].concat()).unwrap()
}

fn run(name: &str, rig: &RigFile) -> Summary {
    let simulation = Simulation::new(&scenario(name), rig).unwrap();
    let summary = simulation.run(&mut InProcess::new(), &mut |_| {}).unwrap();
    require_shadow(&summary, name);
    summary
}

/// Homes, goes round its workspace with a payload, follows a circle, jogs; and finds what the current shows.
#[test]
fn a_leg_with_such_outputs_does_what_any_leg_does() {
    for output in OUTPUTS {
        let rig = rig(output);
        for name in [
            "homing",
            "tour",
            "circle",
            "jog",
            "fault_over_current",
            "fault_current_disagrees",
        ] {
            let summary = run(name, &rig);
            for found in &summary.measurements {
                assert!(found.passes(), "{output}, {name}: {found:?}");
            }
            assert_eq!(summary.stopped, None, "{output}, {name}");
            let unexpected = &summary.unexpected;
            assert!(unexpected.is_empty(), "{output}, {name}: {unexpected:?}");
        }
    }
}

/// Outputs of three kinds on one leg.
#[test]
fn outputs_may_differ() {
    let more = "[actuator.1]\ncurrent_output = \"magnitude\"\n\
                [actuator.3]\ncurrent_output = \"magnitude_when_driven\"\n";
    let rig = RigFile::parse("differ", &[READY_RIGS[0].text, more].concat()).unwrap();
    let summary = run("tour", &rig);
    let passed = summary.measurements.iter().all(|found| found.passes());
    assert!(passed && summary.unexpected.is_empty(), "{summary:?}");
}

/// What a defect raises while a leg moves there and back with 1 kg.
fn moves_with(output: &str, defect: Option<Defect>) -> FaultSet {
    let rig = rig(output);
    let mut stand = armed(&rig, [0.0, 0.0], 1.0, 13);
    if let Some(defect) = defect {
        stand.plant().set_defect(defect, true);
    }
    let mut found = FaultSet::NONE;
    for tilt_deg in [25.0, 0.0] {
        // A leg that a fault has stopped refuses.
        let _ = stand.command(&move_to([0.0, tilt_deg]));
        for _ in 0..200 {
            pass(&mut stand, 0.01);
            found = found.union(stand.faults());
        }
    }
    found
}

/// Whatever shows while the motors are driven is found; an output that is dead reads as one that shows nothing.
#[test]
fn a_defect_of_such_an_output_is_found_while_the_motor_is_driven() {
    for output in OUTPUTS {
        assert_eq!(moves_with(output, None), FaultSet::NONE, "{output}");
        for (defect, fault) in [
            (Defect::CurrentFullScale(0), Fault::OverCurrent),
            (Defect::CurrentOffset(0), Fault::OverCurrent),
            (Defect::CurrentDead(0), Fault::CurrentDisagrees),
            (Defect::CurrentZero(0), Fault::CurrentDisagrees),
            (Defect::MotorJammed(0), Fault::EncoderStill),
        ] {
            let found = moves_with(output, Some(defect));
            assert!(found.has(fault), "{output}, {defect:?}: {found:?}");
        }
    }
}

/// An output that reads full scale is found at a leg that rests, too: its motors are hardly driven.
#[test]
fn an_output_that_reads_full_scale_is_found_at_rest() {
    for output in OUTPUTS {
        let mut stand = armed(&rig(output), [0.0, 20.0], 0.5, 13);
        pass(&mut stand, 2.0);
        assert_eq!(stand.faults(), FaultSet::NONE, "{output}");
        stand.plant().set_defect(Defect::CurrentFullScale(2), true);
        pass(&mut stand, 0.05);
        assert!(stand.faults().has(Fault::OverCurrent), "{output}");
    }
}

/// The zero of such an output is near code 0. What is too far from there is refused, and the leg does not home.
#[test]
fn the_zero_of_such_an_output_is_at_the_low_end() {
    for output in OUTPUTS {
        for (offset_a, taken) in [(0.2, true), (0.6, false)] {
            let mut rig = rig(output);
            rig.plant.current_offset_a = [0.0, offset_a, 0.0];
            let start = Start::Slack { slack_mm: 3.0 };
            let mut stand = Stand::new(&rig, &rig.plant, start, 13).unwrap();
            pass(&mut stand, 0.01);
            stand.command(&Command::Home).unwrap();
            pass(&mut stand, 12.0);
            let homed = stand.telemetry.unwrap().homed;
            assert_eq!(homed, taken, "{output}, {offset_a} A: {:?}", stand.faults());
        }
    }
}

/// Without its load cell a current ends homing: at such an output below its shortest pulse, too.
#[test]
fn without_its_load_cell_the_current_ends_homing() {
    // At 2 mm/s all of homing is below the shortest pulse.
    for (defect, speed_m_per_s, time_s) in [
        (Defect::CellExcitationLost(1), 1e-2, 12.0),
        (Defect::ExcitationLost, 1e-2, 12.0),
        (Defect::ExcitationLost, 2e-3, 60.0),
    ] {
        for output in OUTPUTS {
            let mut rig = rig(output);
            rig.gains.homing.speed_m_per_s = speed_m_per_s;
            let start = Start::Slack { slack_mm: 3.0 };
            let mut stand = Stand::new(&rig, &rig.plant, start, 13).unwrap();
            pass(&mut stand, 0.01);
            stand.plant().set_defect(defect, true);
            stand.command(&Command::Home).unwrap();
            let mut highest_n: f64 = 0.0;
            while stand.time_s() < time_s {
                pass(&mut stand, 0.01);
                highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
            }
            let what = format!("{output}, {defect:?}, {speed_m_per_s} m/s: {highest_n:.1} N");
            println!("{what}, {:?}", stand.faults());
            assert!(stand.faults().has(Fault::HomingFailed), "{what}");
            assert!(highest_n < 25.0, "{what}");
        }
    }
}
