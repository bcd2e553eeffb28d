//! What a rig file says of controller, actuators and sensors reaches the board's settings and the simulated leg.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_firmware::settings::{SECTIONS, Settings};
use leg_rig::actuator::Actuator;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::link::InProcess;
use leg_sim::scenario::Scenario;
use leg_sim::simulation::{Simulation, Summary};

/// The default rig with more sections.
fn rig(more: &str) -> RigFile {
    RigFile::parse("more", &[READY_RIGS[0].text, more].concat()).unwrap()
}

/// A scenario that tilts the leg with 1 kg and measures, with more sections.
fn scenario(more: &str) -> Scenario {
    let steps = "title = \"test\"\nsteps = [ { wait_s = 0.1 }, \"arm\", { wait_s = 0.5 }, \
                 { move = { azimuth_deg = 30, tilt_deg = 15 } }, { arrive = { then_s = 2, timeout_s = 4 } }, \
                 { measure = { name = \"payload\", quantity = \"payload_kg\", between = [0, 9] } }, \
                 { measure = { name = \"tip\", quantity = \"tip_error_mm\", between = [0, 9] } } ]\n\
                 [start.held]\nazimuth_deg = 0\ntilt_deg = 0\npretension_n = 70\npayload_kg = 1\n";
    Scenario::parse("test", &[steps, more].concat()).unwrap()
}

fn settings(rig: &RigFile, scenario: &Scenario) -> Settings {
    Simulation::new(scenario, rig).unwrap().settings().clone()
}

/// What comes out, and the bits of every duty.
fn run(rig: &RigFile) -> (Summary, Vec<[u32; 3]>) {
    let mut bits = Vec::new();
    let simulation = Simulation::new(&scenario(""), rig).unwrap();
    let summary = simulation
        .run(&mut InProcess::new(), &mut |tick| {
            bits.push(tick.drive.duty.map(f32::to_bits));
        })
        .unwrap();
    assert!(summary.divergence.stays(), "{:?}", summary.divergence);
    (summary, bits)
}

#[test]
fn a_scenarios_gain_wins_over_the_rigs_and_the_rigs_over_the_default() {
    let rig = rig(
        "[control.servo]\nposition_gain_per_s = 90\nduty_max = 0.8\n[control.homing]\ntouch_n = 3\n",
    );
    let scenario = scenario("[control.servo]\nduty_max = 0.5\n[control.limits]\njump_n = 40\n");
    let found = settings(&rig, &scenario);
    assert_eq!(found.servos[1].position_gain_per_s, 90.0, "the rig's");
    assert_eq!(found.servos[1].duty_max, 0.5, "the scenario's");
    assert_eq!(found.limits.jump_n, 40.0, "the scenario's");
    assert_eq!(found.homing.touch_n, 3.0, "the rig's");
    let by_default = settings(&RigFile::load(None).unwrap(), &self::scenario(""));
    let mut others = found;
    assert_eq!(
        others.servos[1].speed_gain_v_s_per_m, 1300.0,
        "by the rig's gain"
    );
    for (servo, default) in others.servos.iter_mut().zip(by_default.servos) {
        servo.speed_gain_v_s_per_m = default.speed_gain_v_s_per_m;
        servo.integral_time_s = default.integral_time_s;
        servo.speed_m_per_s = default.speed_m_per_s;
        servo.position_gain_per_s = default.position_gain_per_s;
        servo.duty_max = default.duty_max;
    }
    others.homing.speed_m_per_s = by_default.homing.speed_m_per_s;
    others.limits.ramp_m_per_s = by_default.limits.ramp_m_per_s;
    others.motion.acceleration_rad_per_s2 = by_default.motion.acceleration_rad_per_s2;
    others.motion.pretension_rate_n_per_s = by_default.motion.pretension_rate_n_per_s;
    others.limits.jump_n = by_default.limits.jump_n;
    others.homing.touch_n = by_default.homing.touch_n;
    assert_eq!(others, by_default, "nothing else");
}

/// Whatever gain a file gives within its range, the board takes; beyond its ends, no file can give it.
#[test]
fn every_gain_reaches_the_board_at_the_ends_of_its_range_and_not_beyond() {
    for (section, fields) in SECTIONS {
        for field in fields {
            for (end, beyond) in [(field.range[0], -1.0), (field.range[1], 1.0)] {
                let text = |value: f32| format!("[control.{section}]\n{} = {value}\n", field.name);
                let found = settings(&rig(""), &scenario(&text(end)));
                assert!(found.check().is_ok(), "{section}.{}", field.name);
                let text = [READY_RIGS[0].text, &text(end + beyond)].concat();
                let error = RigFile::parse("beyond", &text).unwrap_err().to_string();
                let expected = format!("`{}` is outside", field.name);
                assert!(error.starts_with(&expected), "{error}");
            }
        }
    }
}

#[test]
fn no_number_of_actuator_or_simulation_may_leave_its_range() {
    let sections = [
        ("actuator", Actuator::FIELDS),
        ("simulation", PlantSettings::FIELDS),
    ];
    for (section, fields) in sections {
        for field in fields {
            for value in [field.range[0] - 1e-9, 1.01 * field.range[1]] {
                let more = format!("[{section}]\n{} = {value:e}\n", field.name);
                let text = [READY_RIGS[0].text, &more].concat();
                let error = RigFile::parse("beyond", &text).unwrap_err().to_string();
                let expected = format!("`{}` is outside", field.name);
                assert!(error.starts_with(&expected), "{more}{error}");
            }
        }
    }
}

#[test]
fn the_motor_tells_the_servo_unless_the_file_does() {
    let found = settings(&rig("[actuator]\nresistance_ohm = 4\n"), &scenario(""));
    assert_eq!(found.servos[1].resistance_ohm, 4.0);
    let more = "[actuator]\nresistance_ohm = 4\n[control.servo]\nresistance_ohm = 4.5\n";
    let found = settings(&rig(more), &scenario(""));
    assert_eq!(found.servos[1].resistance_ohm, 4.5);
}

#[test]
fn calibrations_reach_the_board_axis_by_axis() {
    let more = "[calibration]\ncounts_sign = [1, -1, 1]\nm_per_count = [1.1e-7, 1.2e-7, 1.3e-7]\n\
                cell_n_per_code = [3.81e-3, 3.82e-3, 3.83e-3]\ncell_zero_code = [5000, 5100, 5200]\n\
                current_a_per_code = [3.6e-4, 3.7e-4, 3.8e-4]\n";
    let found = settings(&rig(more), &scenario("")).axes;
    let m_per_count = [1.1e-7, -1.2e-7, 1.3e-7];
    assert_eq!(found.map(|axis| axis.m_per_count), m_per_count);
    let n_per_code = [3.81e-3, 3.82e-3, 3.83e-3];
    assert_eq!(found.map(|axis| axis.cell_n_per_code), n_per_code);
    let zeros = [5000.0, 5100.0, 5200.0];
    assert_eq!(found.map(|axis| axis.cell_zero_code), zeros);
    let a_per_code = [3.6e-4, 3.7e-4, 3.8e-4];
    assert_eq!(found.map(|axis| axis.current_a_per_code), a_per_code);
}

/// The simulated encoders are wired as the calibration says, so that the same duties come out.
#[test]
fn encoders_that_count_down_move_the_leg_alike() {
    let (up, up_bits) = run(&rig(""));
    let (down, down_bits) = run(&rig("[calibration]\ncounts_sign = [-1, 1, -1]\n"));
    assert!(up_bits == down_bits);
    assert_eq!(up.measurements, down.measurements);
    assert!(down.faults.is_empty(), "{:?}", down.faults);
}

/// The simulated load cells are by their data sheet: one that is calibrated otherwise is off.
#[test]
fn a_wrong_calibration_of_the_cells_shows() {
    let (right, _) = run(&rig(""));
    let measured = 250.0 / 65520.0;
    let same = format!("[calibration]\ncell_n_per_code = [{measured}, {measured}, {measured}]\n");
    assert_eq!(run(&rig(&same)).0.measurements, right.measurements);
    let off = format!(
        "[calibration]\ncell_n_per_code = [{}, {}, {measured}]\n",
        1.01 * measured,
        0.99 * measured
    );
    let (wrong, _) = run(&rig(&off));
    let [right_mm, wrong_mm] = [right, wrong].map(|summary| summary.measurements[1].value);
    assert!(right_mm < 0.03, "{right_mm} mm");
    assert!(wrong_mm > 3.0 * right_mm, "{wrong_mm} mm");
}

/// Another gear, with counts to match, leads to the same place.
#[test]
fn a_leg_with_another_actuator_follows() {
    let more = "[actuator]\ngear_ratio = 5.2\nlead_m = 1.2e-3\ncounts_per_turn = 4096\ncell_range_n = [-10, 300]\n";
    let (summary, bits) = run(&rig(more));
    assert!(summary.faults.is_empty(), "{:?}", summary.faults);
    let [payload, tip] = &summary.measurements[..] else {
        panic!("two findings")
    };
    assert!((payload.value - 1.0).abs() < 0.05, "{} kg", payload.value);
    assert!(tip.value < 0.05, "{} mm", tip.value);
    assert!(bits != run(&rig("")).1);
}

/// The rig's noise is the scenario's unless that has its own; its other errors are none.
#[test]
fn the_simulated_leg_is_as_the_rig_says_with_the_scenarios_errors() {
    let rig = rig(
        "[simulation]\njoint_damping_nm_s_per_rad = 0.01\ncell_noise_n = 0.2\n\
                   leg_transverse_inertia_kg_m2 = 0.02\n",
    );
    let plant = scenario("").plant(&rig);
    assert_eq!(plant.joint_damping_nm_s_per_rad, 0.01);
    assert_eq!(plant.leg_transverse_inertia_kg_m2, Some(0.02));
    assert_eq!((plant.cell_noise_n, plant.cell_offset_n), (0.2, [0.0; 3]));
    let own = scenario("[plant]\ncell_noise_n = 0.0\n");
    assert_eq!(own.plant(&rig).cell_noise_n, 0.0);
}
