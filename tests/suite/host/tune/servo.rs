//! The servo of a motor as `leg tune` measures it: what its rig file would say if it were right.

use super::{drawn, jog, leg, ready_rig};
use leg_bench::bode::{GAIN_DB, PHASE_DEG};
use leg_firmware::jog::{JogDemand, JogDrive, JogEnd, ServoResponse};
use leg_firmware::supervisor::{Fault, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{UncertainValue, comparison};
use leg_sim::plant::Defect;

fn measured(rows: &[leg_rig::tune::ComparisonRow], name: &str) -> (UncertainValue, f64) {
    let row = rows.iter().find(|row| row.name == name).unwrap();
    println!("{row:?}");
    (row.measured, row.configured.unwrap())
}

/// Resistance, torque constant and friction are not those of the settings, and the rotor has up to twice the inertia.
#[test]
fn the_loop_of_a_servo_is_found() {
    let mut changed_deg = 0.0_f64;
    for (seed, inertia) in (1..).zip([0.85, 1.1, 1.35, 1.6, 1.85, 1.2]) {
        let configured = ready_rig(seed);
        let mut real = drawn(&configured, seed);
        real.actuators = [real.actuators[0]; 3];
        for actuator in &mut real.actuators {
            actuator.inertia_kg_m2 *= inertia;
        }
        // What the motors are, with the gains that they have.
        let known = RigFile {
            gains: configured.gains,
            ..real
        };
        let (_, mut operator, _) = leg(&configured, &real, seed);
        let motor = 1 + (seed % 3) as u8;
        let found = jog(&mut operator, motor, &mut |_| ()).unwrap();
        println!("{:?}", found.servo_finding);
        let rows = comparison(&found, None, &known);
        let (crossover, real_hz) = measured(&rows, "servo, crossover");
        let off = |found: UncertainValue, real: f64| (found.value - real).abs() / found.uncertainty;
        assert!(off(crossover, real_hz) < 1.5, "seed {seed}");
        let (phase, real_deg) = measured(&rows, "servo, phase margin");
        assert!(off(phase, real_deg) < 1.5, "seed {seed}");
        let (gain, real_db) = measured(&rows, "servo, gain margin");
        assert!(off(gain, real_db) < 1.5, "seed {seed}");
        assert!(phase.uncertainty < 2.0 && gain.uncertainty < 1.0 && crossover.part() < 0.03);
        let rows = comparison(&found, None, &configured);
        let (_, configured_deg) = measured(&rows, "servo, phase margin");
        changed_deg = changed_deg.max((configured_deg - real_deg).abs());
        let less = |margin: UncertainValue, bar: f64| margin.value + margin.uncertainty < bar;
        let rings = less(phase, PHASE_DEG) || less(gain, GAIN_DB);
        assert_eq!(found.servo_finding.is_some(), rings, "seed {seed}");
    }
    // It is measured, not taken from the rig file.
    assert!(changed_deg > 3.0, "{changed_deg}");
}

/// A servo whose gains are too high has less margin, and is said to be near to ringing.
#[test]
fn a_servo_that_nearly_rings_is_told() {
    let configured = RigFile::load(None).unwrap();
    let servos = [1.0_f32, 1.5].map(|part| {
        let mut sharp = configured;
        for servo in &mut sharp.gains.servos {
            servo.position_gain_per_s *= part;
            servo.speed_gain_v_s_per_m *= part;
        }
        let (_, mut operator, _) = leg(&sharp, &sharp, 1);
        let found = jog(&mut operator, 1, &mut |_| ()).unwrap();
        println!("{:?}", found.servo);
        assert_eq!(found.servo_finding.is_some(), part > 1.0);
        found.servo.unwrap()
    });
    let [sound, sharp] = servos;
    assert!(sound.overshoot.value < 0.01);
    assert!(sharp.phase_margin_deg.unwrap().value < sound.phase_margin_deg.unwrap().value - 10.0);
}

/// One that rings is no reason to know nothing of its motor: its constants are what the gains follow from.
#[test]
fn a_motor_is_measured_although_its_servo_rings() {
    let mut rig = RigFile::load(None).unwrap();
    for servo in &mut rig.gains.servos {
        servo.position_gain_per_s *= 4.0;
        servo.speed_gain_v_s_per_m *= 4.0;
    }
    let (_, mut operator, _) = leg(&rig, &rig, 1);
    let found = jog(&mut operator, 1, &mut |_| ()).unwrap();
    println!("{:?}", found.servo);
    assert_eq!(found.servo, None);
    let words = found.servo_finding.as_ref().unwrap();
    assert!(words.what.contains("servo of motor 1"), "{words:?}");
    assert!(words.remedy.contains("position_gain_per_s"), "{words:?}");
    let rows = comparison(&found, None, &rig);
    let (resistance, real_ohm) = measured(&rows, "resistance_ohm");
    assert!((resistance.value / real_ohm - 1.0).abs() < 0.05);
    assert!(rows.iter().all(|row| !row.name.starts_with("servo")));
}

/// A motor whose encoder counts nothing, the wrong way or at another motor, or that is jammed, ends a jog by its servo within bounds, mm.
#[test]
fn a_servo_jog_of_a_leg_with_a_mistake_ends_within_bounds() {
    use Defect as D;
    let configured = RigFile::load(None).unwrap();
    let sine = JogDrive::ServoSine {
        speed_m_per_s: 2.5e-3,
        amplitude_v: 0.4,
        period_ticks: 100,
    };
    for (drive, travel_m) in [
        (JogDrive::ServoStep, 2e-4),
        (JogDrive::ServoStep, -2e-4),
        (sine, 2e-3),
        (sine, -2e-3),
    ] {
        for (defect, moved_mm) in [
            (D::MotorJammed(0), 0.01),
            (D::EncoderLost(0), 0.2),
            (D::EncoderReversed(0), 0.1),
            (D::HalfBridgeOpen(0), 0.1),
        ] {
            // Its other half turns it that way.
            if defect == D::HalfBridgeOpen(0) && travel_m < 0.0 {
                continue;
            }
            let (line, mut operator, _) = leg(&configured, &configured, 1);
            let before = line.with_plant(|plant| {
                plant.set_defect(defect, true);
                plant.truth().unstretched_m
            });
            let demand = JogDemand {
                motor: 1,
                travel_m,
                drive,
            };
            let (report, telemetry) = operator.jog(&demand).unwrap();
            let after = line.with_plant(|plant| plant.truth().unstretched_m);
            let went_mm = 1000.0 * (after[0] - before[0]).abs();
            let case = format!(
                "{defect:?}, {drive:?}, {travel_m}: {:?}, {went_mm} mm",
                report.end
            );
            println!("{case}, {:?}", telemetry.faults);
            assert_ne!(report.end, JogEnd::Arrived, "{case}");
            assert_eq!(report.servo, None, "{case}");
            assert!(went_mm < moved_mm, "{case}");
            assert!(!telemetry.state.driven(), "{case}");
        }
    }
}

/// Jogs motor 1 of a leg whose load cells show next to nothing again and again: the highest tension, N, and how many jogs did not arrive.
fn jogged_without_cells(rig: &RigFile, drive: JogDrive, travel_m: f32) -> (f64, u32) {
    let (line, mut operator, _) = leg(rig, rig, 1);
    let mut settings = operator.settings().unwrap();
    for axis in &mut settings.axes {
        axis.cell_n_per_code *= 0.01;
    }
    operator.set_settings(&settings).unwrap();
    let demand = JogDemand {
        motor: 1,
        travel_m,
        drive,
    };
    let (mut highest_n, mut ended) = (0.0_f64, 0);
    // Each goes on from the tension that the last one has left.
    for _ in 0..60 {
        let (report, _) = operator.jog(&demand).unwrap();
        ended += u32::from(report.end != JogEnd::Arrived);
        highest_n = highest_n.max(line.with_plant(|plant| plant.truth().tensions_n[0]));
    }
    (highest_n, ended)
}

/// What the servo may drive keeps the tension low on every ready rig, however often it is jogged.
#[test]
fn without_its_load_cell_the_current_ends_a_servo_jog() {
    let sine = JogDrive::ServoSine {
        speed_m_per_s: 2.5e-3,
        amplitude_v: 0.4,
        period_ticks: 100,
    };
    for ready in 0..READY_RIGS.len() as u64 {
        let rig = ready_rig(ready);
        for (drive, travel_m) in [(JogDrive::ServoStep, 3e-4), (sine, 1e-2)] {
            let (highest_n, ended) = jogged_without_cells(&rig, drive, travel_m);
            println!("rig {ready}, {drive:?}: {highest_n} N, {ended} did not arrive");
            assert!(highest_n < 80.0 && ended > 10);
        }
    }
}

/// A step and a sine of a sound motor end where they were asked to, and the leg is disarmed.
#[test]
fn a_servo_jog_goes_as_far_as_it_was_asked() {
    let configured = RigFile::load(None).unwrap();
    let (_, mut operator, _) = leg(&configured, &configured, 1);
    let sine = JogDrive::ServoSine {
        speed_m_per_s: 2e-3,
        amplitude_v: 0.3,
        period_ticks: 80,
    };
    for (drive, travel_m) in [
        (JogDrive::ServoStep, 2e-4),
        (JogDrive::ServoStep, -3e-4),
        (sine, 1e-3),
        (sine, -1e-3),
    ] {
        let demand = JogDemand {
            motor: 2,
            travel_m,
            drive,
        };
        let (report, telemetry) = operator.jog(&demand).unwrap();
        assert_eq!(report.end, JogEnd::Arrived);
        assert_eq!(telemetry.state, State::Disarmed);
        assert!(!telemetry.faults.has(Fault::Following));
        assert!((report.pulled_m[1] - travel_m).abs() < 5e-5, "{report:?}");
        match report.servo.unwrap() {
            ServoResponse::Step {
                overshoot_m,
                settled_s,
            } => assert!(overshoot_m < 2e-5 && (0.005..0.1).contains(&settled_s)),
            // 0.5 s, of which the board waits for 0.2 s, in periods of 10 ms.
            ServoResponse::Sine { periods, .. } => assert_eq!(periods, 30),
        }
    }
}
