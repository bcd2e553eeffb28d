//! `leg tune` on simulated legs whose true values it is not told: what it measures is what they are.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod endings;
mod servo;
mod stopped;

use fastrand::Rng;
use leg_firmware::drive::Drive;
use leg_firmware::supervisor::State;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::transport::emulated::EmulatedLine;
use leg_host::tune::{OperatorTuneError, measure_motor, measure_swing, supply_v};
use leg_rig::actuator::Actuator;
use leg_rig::control_settings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{
    ComparisonRow, JogPlan, Jogged, MeasuredMotor, SwingPlan, comparison, section,
};
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::link::InProcess;
use leg_sim::plant::{Plant, Start};

/// How far the stretch of the paper's tendons is measured off, as a part of it.
pub const MEASURED_STRETCH: f64 = 0.005;

/// Nothing is driven: the screws hold.
const OFF: Drive<f32> = Drive {
    duty: [0.0; 3],
    enabled: false,
};

/// A leg that is not as configured: friction within a half of it, resistance and torque constant within a fifth, play from the half
/// to the double, each motor otherwise; tendons and inertia so that it swings at another frequency.
fn drawn(configured: &RigFile, seed: u64) -> RigFile {
    let mut rng = Rng::with_seed(seed);
    let mut part = |low: f64, high: f64| low + (high - low) * rng.f64();
    let mut real = *configured;
    for actuator in &mut real.actuators {
        actuator.friction_nm *= part(0.5, 1.5);
        actuator.resistance_ohm *= part(0.8, 1.2);
        actuator.torque_constant_nm_per_a *= part(0.8, 1.2);
        actuator.viscous_nm_s_per_rad *= part(0.5, 1.5);
        actuator.screw_efficiency *= part(0.9, 1.1);
        actuator.backlash_rad *= part(0.5, 2.0);
    }
    real.plant.curve_error = part(-0.03, 0.03);
    let inertia = configured
        .plant
        .transverse_inertia_kg_m2(&configured.parameters);
    real.plant.leg_transverse_inertia_kg_m2 = Some(inertia * part(0.8, 1.2));
    real
}

/// One of the ready rigs, another one for each seed.
fn ready_rig(seed: u64) -> RigFile {
    let ready = READY_RIGS[seed as usize % READY_RIGS.len()];
    RigFile::parse(ready.name, ready.text).unwrap()
}

/// A leg, its host and what cancels that.
fn leg(configured: &RigFile, real: &RigFile, seed: u64) -> (EmulatedLine, Operator, CancelFlag) {
    let leg = EmulatedLeg::unlike(configured, real, Box::new(InProcess::new()), seed).unwrap();
    let line = EmulatedLine::new(leg, "the leg");
    let host = Box::new(line.connect());
    let cancel = CancelFlag::default();
    let operator = Operator::open(host, HostIdentity::FIXED, cancel.clone()).unwrap();
    (line, operator, cancel)
}

fn jog(
    operator: &mut Operator,
    motor: u8,
    seen: &mut dyn FnMut(&Jogged),
) -> Result<MeasuredMotor, OperatorTuneError> {
    let settings = operator.settings().unwrap();
    let supply_v = supply_v(operator, &settings).unwrap();
    let plan = JogPlan::new(motor, &settings, supply_v);
    measure_motor(operator, &plan, &settings, seen)
}

/// How far a row is off what it is compared with, as a part of it; not much farther than its uncertainty.
fn deviation(row: &ComparisonRow) -> f64 {
    let (measured, real) = (row.measured, row.configured.unwrap());
    println!("{row:?}");
    assert!(
        (measured.value - real).abs() < 1.5 * measured.uncertainty,
        "{row:?}"
    );
    (measured.value / real - 1.0).abs()
}

#[test]
fn the_constants_of_a_motor_are_found_within_five_percent() {
    for seed in 1..=6 {
        let configured = ready_rig(seed);
        let real = drawn(&configured, seed);
        let (line, mut operator, _) = leg(&configured, &real, seed);
        let before = line.with_plant(|plant| plant.truth().unstretched_m);
        let motor = 1 + (seed % 3) as u8;
        let mut hardest_n = 0.0_f64;
        let found = jog(&mut operator, motor, &mut |_| {
            let tensions_n = line.with_plant(|plant| plant.truth().tensions_n);
            hardest_n = tensions_n.into_iter().fold(hardest_n, f64::max);
        });
        // Compared with what the leg is, not with what it is configured to.
        let rows = comparison(&found.unwrap(), None, &real);
        for name in [
            "resistance_ohm",
            "torque_constant_nm_per_a",
            "friction, pulling in",
            "friction, paying out",
            "friction_nm",
            "viscous_nm_s_per_rad",
            "screw_efficiency",
            "pull, pulling in",
            "pull, paying out",
        ] {
            let row = rows.iter().find(|row| row.name == name).unwrap();
            assert!(deviation(row) < 0.05, "seed {seed}");
        }
        let after = line.with_plant(|plant| plant.truth().unstretched_m);
        for (before, after) in before.iter().zip(after) {
            assert!((before - after).abs() < 1e-3, "seed {seed}: not put back");
        }
        assert!((5.0..16.0).contains(&hardest_n), "{hardest_n} N");
        let telemetry = operator.telemetry().unwrap().telemetry;
        assert_eq!(telemetry.state, State::Disarmed);
    }
}

/// The frequency of the leg after a push, without any damping, by the times at which its tip passes the vertical, Hz.
fn true_frequency_hz(real: &RigFile, pretension_n: f64) -> f64 {
    let start = Start::Held {
        azimuth_deg: 0.0,
        tilt_deg: 0.0,
        pretension_n,
        payload_kg: 0.0,
    };
    let mut plant = Plant::new(real, &real.plant.undamped(), start, 1).unwrap();
    plant.push([0.5, 0.0, 0.0].into(), 0.01, 0.0);
    let mut passes = Vec::new();
    let mut before = plant.truth();
    while passes.len() < 11 {
        plant.step(&OFF);
        let now = plant.truth();
        if before.tip_m.x < 0.0 && now.tip_m.x >= 0.0 {
            let part = before.tip_m.x / (before.tip_m.x - now.tip_m.x);
            passes.push(before.time_s + part * (now.time_s - before.time_s));
        }
        before = now;
    }
    10.0 / (passes[10] - passes[0])
}

/// The pretension moves all motors together: it tells the mean of their plays.
fn mean_play_m(rig: &RigFile) -> f64 {
    rig.actuators.iter().map(Actuator::play_m).sum::<f64>() / 3.0
}

#[test]
fn the_first_mode_is_found_within_three_percent_and_the_play_within_ten() {
    let mut changed = 0.0_f64;
    for seed in 1..=7 {
        let configured = ready_rig(seed);
        let mut real = drawn(&configured, seed);
        // Motors that differ by more than their play let no leg home before its rig file says so.
        let [first, _, _] = real.actuators;
        for (actuator, part) in real.actuators.iter_mut().zip([1.0, 0.7, 1.2]) {
            *actuator = first;
            actuator.backlash_rad *= part;
        }
        let (line, mut operator, _) = leg(&configured, &real, seed);
        let plan = SwingPlan::new(&configured);
        let mut leaned_deg = 0.0_f64;
        let mut seen = |_: &_| {
            let tip_m = line.with_plant(|plant| plant.truth().tip_m);
            let tilt_deg = tip_m.x.hypot(tip_m.y).atan2(-tip_m.z).to_degrees();
            leaned_deg = leaned_deg.max(tilt_deg);
        };
        let swings = measure_swing(&mut operator, &plan, &configured, &mut seen).unwrap();
        // It is seen where it is held after each swing.
        assert!((2.5..3.5).contains(&leaned_deg), "{leaned_deg}°");
        assert_eq!(swings.all.len(), 3);
        for swing in &swings.all {
            let real_hz = true_frequency_hz(&real, swing.pretension_n);
            let found = swing.frequency_hz;
            println!("{:.1} N: {found:?}, true {real_hz} Hz", swing.pretension_n);
            assert!((found.value / real_hz - 1.0).abs() < 0.03, "seed {seed}");
            changed = changed.max((swing.configured_hz / real_hz - 1.0).abs());
        }
        let travels = swings.travels.unwrap();
        let play_m = travels.play_m;
        let real_m = mean_play_m(&real);
        println!("play {play_m:?}, true {real_m}");
        assert!((play_m.value / real_m - 1.0).abs() < 0.1, "seed {seed}");
        let stretched = travels.stretch_m.value / swings.configured_stretch_m.unwrap();
        let real_stretched = 1.0 + real.plant.curve_error;
        println!("stretch {stretched}, true {real_stretched}");
        assert!((stretched / real_stretched - 1.0).abs() < 0.01);
        // The stiffness of the rig file is wrong by as much as the stretch.
        let inertia = swings.inertia_kg_m2;
        let real_inertia = real.plant.transverse_inertia_kg_m2(&real.parameters);
        println!("inertia {inertia:?}, true {real_inertia}");
        let off = (inertia.value - real_inertia).abs();
        assert!(
            off < (1.5 * inertia.uncertainty).min(0.01 * real_inertia),
            "seed {seed}"
        );
        let telemetry = operator.telemetry().unwrap().telemetry;
        assert_eq!(telemetry.state, State::Held);
    }
    // It is measured, not taken from the rig file.
    assert!(changed > 0.05, "{changed}");
}

/// The section stands in a rig file as it is, and gives what was measured.
#[test]
fn what_is_written_is_a_part_of_a_rig_file() {
    let configured = RigFile::load(None).unwrap();
    let real = drawn(&configured, 1);
    let (_, mut operator, _) = leg(&configured, &real, 1);
    let found = jog(&mut operator, 2, &mut |_| ()).unwrap();
    let plan = SwingPlan::new(&configured);
    let swings = measure_swing(&mut operator, &plan, &configured, &mut |_| ()).unwrap();
    let rows = comparison(&found, Some(&swings), &configured);
    let text = [READY_RIGS[0].text, &section(2, &rows)].concat();
    let file = RigFile::parse("measured", &text).unwrap();
    let written = &file.actuators[1];
    let inertia = |rig: &RigFile| rig.plant.leg_transverse_inertia_kg_m2.unwrap();
    for (written, real) in [
        (written.resistance_ohm, real.actuators[1].resistance_ohm),
        (
            written.torque_constant_nm_per_a,
            real.actuators[1].torque_constant_nm_per_a,
        ),
        (written.friction_nm, real.actuators[1].friction_nm),
        (written.screw_efficiency, real.actuators[1].screw_efficiency),
        (written.play_m(), mean_play_m(&real)),
        (inertia(&file), inertia(&real)),
    ] {
        assert!((written / real - 1.0).abs() < 0.05, "{written} {real}");
    }
}

/// A leg whose tendons stretch by a fifth more or less than its file says finds that as it is tensioned, and is measured. One whose tendons are
/// nothing like it is held; the factor that its user is told lets it be measured, after a disarm, a clear and other settings.
#[test]
fn other_tendons_are_measured() {
    let paper = RigFile::load(None).unwrap();
    let with = |section: &str| {
        let text = [READY_RIGS[0].text, section].concat();
        RigFile::parse("measured", &text).unwrap()
    };
    let swing = |operator: &mut Operator, rig: &RigFile| {
        measure_swing(operator, &SwingPlan::new(rig), rig, &mut |_| ())
    };
    for (curve_error, held) in [(0.2, false), (-0.2, false), (0.5, true), (-0.4, true)] {
        let mut real = paper;
        real.plant.curve_error = curve_error;
        let (_, mut operator, _) = leg(&paper, &real, 1);
        let (known, swings) = match swing(&mut operator, &paper) {
            Ok(swings) => {
                assert!(!held, "{curve_error}");
                (paper, swings)
            }
            Err(error) => {
                let told = error.to_string();
                assert!(held, "{curve_error}: {told}");
                let rough = with(&told_section(&told));
                operator.disarm().unwrap();
                operator.clear().unwrap();
                let settings = control_settings::settings(&rough, &rough.gains, None);
                operator.set_settings(&settings).unwrap();
                let swings = swing(&mut operator, &rough).unwrap();
                (rough, swings)
            }
        };
        operator.disarm().unwrap();
        let motor = jog(&mut operator, 1, &mut |_| ()).unwrap();
        let written = with(&section(1, &comparison(&motor, Some(&swings), &known)));
        println!("{curve_error}: {}", written.elongation_factor);
        let off = (written.elongation_factor / (1.0 + curve_error) - 1.0).abs();
        assert!(off < MEASURED_STRETCH, "{}", written.elongation_factor);
    }
}

/// The section of a rig file with the factor that is told.
fn told_section(told: &str) -> String {
    let (_, after) = told.split_once("its tendons stretch ").unwrap();
    let (factor, _) = after.split_once(" times as much").unwrap();
    format!("[tendon.measured]\nelongation_factor = {factor}\n")
}

/// What else makes the sensors disagree is not called other tendons: one cell that is off, and tendons that are hardly off.
#[test]
fn one_load_cell_that_is_off_is_not_called_other_tendons() {
    let paper = RigFile::load(None).unwrap();
    for cell_gain_error in [[0.75, 0.0, 0.0], [0.0, -0.4, 0.0]] {
        let mut real = paper;
        real.plant.cell_gain_error = cell_gain_error;
        let (_, mut operator, _) = leg(&paper, &real, 1);
        let swing = measure_swing(&mut operator, &SwingPlan::new(&paper), &paper, &mut |_| ());
        let ended = swing.unwrap_err().to_string();
        println!("{ended}");
        assert!(ended.contains("sensors disagree on the pose"), "{ended}");
        assert!(!ended.contains("its tendons stretch"), "{ended}");
    }
}

/// A leg whose motors have another winding than its settings say, so that it does not home.
#[test]
fn what_the_jogs_tell_lets_a_leg_home_that_did_not() {
    let configured = RigFile::load(None).unwrap();
    let mut real = drawn(&configured, 106);
    for actuator in &mut real.actuators {
        actuator.resistance_ohm = 1.8 * configured.actuators[0].resistance_ohm;
    }
    let swing = |operator: &mut Operator, rig: &RigFile| {
        measure_swing(operator, &SwingPlan::new(rig), rig, &mut |_| ())
    };
    let (_, mut operator, _) = leg(&configured, &real, 1);
    let found = [1, 2, 3].map(|motor| jog(&mut operator, motor, &mut |_| ()).unwrap());
    let ended = swing(&mut operator, &configured).unwrap_err();
    println!("{ended}");
    assert!(matches!(
        ended,
        OperatorTuneError::Leg(OperatorError::Failed("home", _))
    ));
    // Each motor has its own section.
    let sections = found.map(|found| {
        let rows = comparison(&found, None, &configured);
        section(found.motor, &rows)
    });
    let text = [READY_RIGS[0].text, &sections.concat()].concat();
    let measured = RigFile::parse("measured", &text).unwrap();
    let (_, mut operator, _) = leg(&measured, &real, 1);
    swing(&mut operator, &measured).unwrap();
}

/// What a rig file would refuse stands in the section as a comment.
#[test]
fn what_a_rig_file_does_not_take_is_a_comment() {
    let configured = RigFile::load(None).unwrap();
    let (_, mut operator, _) = leg(&configured, &configured, 1);
    let found = jog(&mut operator, 1, &mut |_| ()).unwrap();
    let mut rows = comparison(&found, None, &configured);
    for row in &mut rows {
        match row.name.as_str() {
            "screw_efficiency" => row.measured.value = 0.55,
            "viscous_nm_s_per_rad" => row.measured.uncertainty = 1.0,
            "friction_nm" => row.measured.value = -1.0,
            _ => {}
        }
    }
    let text = section(1, &rows);
    println!("{text}");
    for line in [
        "# screw_efficiency is not within 0.01 to 0.499: 0.55",
        "# viscous_nm_s_per_rad is too uncertain: ",
        "# friction_nm is too uncertain: -1",
    ] {
        assert!(text.contains(line), "{line}");
    }
    let text = [READY_RIGS[0].text, &text].concat();
    let written = RigFile::parse("measured", &text).unwrap().actuators[0];
    assert_eq!(
        written.screw_efficiency,
        configured.actuators[0].screw_efficiency
    );
}
