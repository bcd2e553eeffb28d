//! Current sensors whose zeros are off: found at the start, or refused by name.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::ready_runs::{require_shadow, scenario};
use super::station_stand::pass;
use leg_bench::stand::Stand;
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, State};
use leg_firmware::telemetry::Telemetry;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::plant::{Defect, Start};
use leg_sim::simulation::{Simulation, Summary};

/// What a kit's current sensor may be off by, and more than what is taken as a zero, A.
const OFF_A: f64 = 0.3;
const TOO_FAR_A: f64 = 0.6;

fn rig(current_offset_a: [f64; 3]) -> RigFile {
    let mut rig = RigFile::load(None).unwrap();
    rig.plant.current_offset_a = current_offset_a;
    rig
}

fn run(name: &str, rig: &RigFile) -> Summary {
    let simulation = Simulation::new(&scenario(name), rig).unwrap();
    let summary = simulation.run(&mut InProcess::new(), &mut |_| {}).unwrap();
    require_shadow(&summary, name);
    summary
}

/// Homing, which a current of 0.24 A ends, and both checks of the currents.
#[test]
fn a_leg_whose_current_sensors_are_off_homes_and_finds_its_faults() {
    for offset_a in [OFF_A, -OFF_A] {
        let rig = rig([0.0, offset_a, 0.0]);
        for name in [
            "homing",
            "tour",
            "fault_current_disagrees",
            "fault_over_current",
        ] {
            let summary = run(name, &rig);
            let passed = summary.measurements.iter().all(|found| found.passes());
            assert!(passed, "{name}: {:?}", summary.measurements);
            assert_eq!(summary.stopped, None, "{name}");
            assert!(
                summary.unexpected.is_empty(),
                "{name}: {:?}",
                summary.unexpected
            );
        }
    }
}

/// What the currents show while the drivers are off, A, and the leg after a command to home; with a defect of motor 2 besides.
fn homes(offset_a: f64, defect: Option<Defect>) -> ([f32; 3], Telemetry<f32>) {
    let rig = rig([0.0, offset_a, 0.0]);
    let start = Start::Slack { slack_mm: 3.0 };
    let mut stand = Stand::new(&rig, &rig.plant, start, 13).unwrap();
    if let Some(defect) = defect {
        stand.plant().set_defect(defect, true);
    }
    pass(&mut stand, 0.01);
    assert_eq!(stand.state(), State::Disarmed);
    let shown_a = stand.telemetry.unwrap().motor_currents_a;
    stand.command(&Command::Home).unwrap();
    pass(&mut stand, 12.0);
    (shown_a, stand.telemetry.unwrap())
}

#[test]
fn without_its_zero_a_current_ends_homing() {
    let reads_full = Some(Defect::CurrentFullScaleDisabled(1));
    for (offset_a, defect, shows_a, failed) in [
        (OFF_A, None, 0.0, 0),
        // Refused.
        (OFF_A, reads_full, 12.0, 2),
        (TOO_FAR_A, None, TOO_FAR_A, 2),
        // The nominal zero is right: a driver that is off may read anything.
        (0.0, reads_full, 12.0, 0),
    ] {
        let (shown_a, telemetry) = homes(offset_a, defect);
        let case = format!("{offset_a} A, {defect:?}");
        for (shown, expected) in shown_a.into_iter().zip([0.0, shows_a, 0.0]) {
            assert!(
                (f64::from(shown) - expected).abs() < 1e-3,
                "{case}: {shown_a:?}"
            );
        }
        assert_eq!(telemetry.failed_tendon, failed, "{case}");
        assert_eq!(
            telemetry.faults.has(Fault::HomingFailed),
            failed > 0,
            "{case}"
        );
        assert_eq!(telemetry.homed, failed == 0, "{case}");
    }
}
