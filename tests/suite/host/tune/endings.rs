//! `leg tune` that is ended: by what is wrong with the leg, by a fault, and by its user.

use super::{jog, leg};
use crate::common::require_said;
use leg_firmware::jog::{JogDemand, JogDrive};
use leg_firmware::supervisor::{Fault, State};
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::transport::emulated::EmulatedLine;
use leg_host::tune::{OperatorTuneError, measure_motor, measure_swing, supply_v};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_rig::tune::{JogPlan, SwingPlan};
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use leg_sim::plant::Defect;

/// What is wrong from the beginning is named by the first jog that shows it.
#[test]
fn a_mistake_of_the_wires_is_named_and_ends_it() {
    let rig = RigFile::load(None).unwrap();
    for (defect, words) in [
        (Defect::EncoderReversed(0), "counts the wrong way"),
        (Defect::EncodersSwapped, "encoder 2 counted"),
        (Defect::MotorJammed(0), "does not turn"),
        (
            Defect::CellReversed(0),
            "shows less where its tendon pulls more",
        ),
        (
            Defect::CellsSwapped,
            "load cell 2 shows what tendon 1 pulls",
        ),
        (Defect::TendonCut(0), "does not come to pull"),
    ] {
        let (line, mut operator, _) = leg(&rig, &rig, 1);
        line.with_plant(|plant| plant.set_defect(defect, true));
        let failure = jog(&mut operator, 1, &mut |_| ()).unwrap_err().failure();
        println!("{defect:?}: {failure}");
        assert!(failure.to_string().contains(words), "{defect:?}: {failure}");
        let telemetry = operator.telemetry().unwrap().telemetry;
        assert_eq!(telemetry.state, State::Disarmed, "{defect:?}");
    }
}

/// One tendon pays out, so two that pull would take the leg along.
#[test]
fn a_leg_whose_tendons_pull_is_refused() {
    let rig = RigFile::load(None).unwrap();
    let link = Box::new(InProcess::new());
    let homed = EmulatedLeg::new(&rig, InitialState::Homed, link).unwrap();
    let line = EmulatedLine::new(homed, "the leg");
    let host = Box::new(line.connect());
    let mut operator = Operator::open(host, HostIdentity::FIXED, CancelFlag::default()).unwrap();
    let before = line.with_plant(|plant| plant.truth().unstretched_m);
    let failure = jog(&mut operator, 1, &mut |_| ()).unwrap_err().to_string();
    assert!(failure.contains("tendon 1 pulls by 70 N"), "{failure}");
    assert_eq!(line.with_plant(|plant| plant.truth().unstretched_m), before);
}

#[test]
fn motors_without_a_supply_are_named() {
    let rig = RigFile::load(None).unwrap();
    let (_line, mut operator, _) = leg(&rig, &rig, 1);
    let settings = operator.settings().unwrap();
    let plan = JogPlan::new(1, &settings, 0.0);
    let refused = measure_motor(&mut operator, &plan, &settings, &mut |_| ()).unwrap_err();
    assert!(refused.to_string().contains("have no supply"), "{refused}");
}

/// It would not be reeled in again to where it was.
#[test]
fn a_tendon_that_pulls_more_than_a_jog_may_is_refused() {
    let rig = RigFile::load(None).unwrap();
    let (_line, mut operator, _) = leg(&rig, &rig, 1);
    let settings = operator.settings().unwrap();
    let mut plan = JogPlan::new(1, &settings, supply_v(&mut operator, &settings).unwrap());
    let drive = JogDrive::Voltage(plan.loaded_v);
    let reeled_in = JogDemand {
        motor: 1,
        travel_m: 0.01,
        drive,
    };
    operator.jog(&reeled_in).unwrap();
    plan.tension_max_n = 4.0;
    let refused = measure_motor(&mut operator, &plan, &settings, &mut |_| ()).unwrap_err();
    assert!(
        refused.to_string().contains("tendon 1 pulls by"),
        "{refused}"
    );
}

/// Its voltages would be in the wrong order, and the currents nothing.
#[test]
fn a_driver_that_shows_no_current_in_a_jog_is_refused_before_anything_moves() {
    let actuator = "[actuator]\nlead_m = 3e-3\ncurrent_output = \"magnitude_when_driven\"\n";
    let text = [READY_RIGS[0].text, actuator].concat();
    let rig = RigFile::parse("test", &text).unwrap();
    let (line, mut operator, _) = leg(&rig, &rig, 1);
    let before = line.with_plant(|plant| plant.truth().unstretched_m);
    let failure = jog(&mut operator, 1, &mut |_| ()).unwrap_err().to_string();
    assert!(failure.contains("shows a current from"), "{failure}");
    assert_eq!(line.with_plant(|plant| plant.truth().unstretched_m), before);
}

/// A fault in the middle: by its name, and the motors are at rest.
#[test]
fn a_fault_in_the_middle_ends_it_by_its_name() {
    let rig = RigFile::load(None).unwrap();
    for after in [1, 12] {
        let (line, mut operator, _) = leg(&rig, &rig, 1);
        let mut count = 0;
        let ended = jog(&mut operator, 1, &mut |_| {
            count += 1;
            if count == after {
                line.with_plant(|plant| plant.set_defect(Defect::SupplySag, true));
            }
        });
        assert_eq!(count, after);
        let (cause, by_m) = cause(ended.unwrap_err());
        let OperatorTuneError::Leg(OperatorError::Failed(_, telemetry)) = cause else {
            panic!("{cause:?}");
        };
        assert!(by_m.abs() > 1e-3, "{by_m}");
        assert!(telemetry.faults.has(Fault::SupplyLow), "{telemetry:?}");
        let truth = line.with_plant(|plant| plant.truth());
        assert_eq!(truth.speeds_rad_per_s, [0.0; 3]);
    }
    let (line, mut operator, _) = leg(&rig, &rig, 1);
    let plan = SwingPlan::new(&rig);
    let mut count = 0;
    let ended = measure_swing(&mut operator, &plan, &rig, &mut |_| {
        count += 1;
        line.with_plant(|plant| plant.set_defect(Defect::CellDead(1), true));
    });
    assert_eq!(count, 1);
    let words = ended.unwrap_err().failure().to_string();
    assert!(words.contains("load cell"), "{words}");
    assert!(!operator.telemetry().unwrap().telemetry.state.follows());
}

/// Why it ended, and how far the tendon is from where it was, m.
fn cause(error: OperatorTuneError) -> (OperatorTuneError, f32) {
    match error {
        OperatorTuneError::Displaced { error, by_m, .. } => (*error, by_m),
        error => (error, 0.0),
    }
}

/// A motor that obeys pays out what a load cell in doubt has let it reel in.
#[test]
fn no_tendon_is_left_loaded_where_a_load_cell_ends_it() {
    let rig = RigFile::load(None).unwrap();
    for defect in [
        Defect::CellExcitationLost(0),
        Defect::CellFollows(0),
        Defect::CellReversed(0),
    ] {
        let (line, mut operator, _) = leg(&rig, &rig, 1);
        line.with_plant(|plant| plant.set_defect(defect, true));
        let ended = jog(&mut operator, 1, &mut |_| ()).unwrap_err();
        let truth = line.with_plant(|plant| plant.truth());
        println!("{defect:?}: {ended}, {:?} N", truth.tensions_n);
        assert!(truth.tensions_n.iter().all(|&n| n < 0.1), "{defect:?}");
        let telemetry = operator.telemetry().unwrap().telemetry;
        assert_eq!(telemetry.state, State::Disarmed, "{defect:?}");
    }
}

/// In the middle of any jog: nothing moves any more, and how far the tendon is from where it was is told.
#[test]
fn a_user_who_interrupts_it_leaves_the_motors_at_rest_and_knows_where() {
    let rig = RigFile::load(None).unwrap();
    for after in [1, 4, 12, 17] {
        let (line, mut operator, cancel) = leg(&rig, &rig, 1);
        let [before_m, ..] = line.with_plant(|plant| plant.truth().unstretched_m);
        let mut count = 0;
        let ended = jog(&mut operator, 1, &mut |_| {
            count += 1;
            if count == after {
                cancel.set();
            }
        });
        assert_eq!(count, after);
        let error = ended.unwrap_err();
        let help = format!("{:?}", error.failure());
        let (cause, by_m) = cause(error);
        assert!(
            matches!(cause, OperatorTuneError::Leg(OperatorError::Cancelled)),
            "{cause:?}"
        );
        let truth = line.with_plant(|plant| plant.truth());
        assert_eq!(truth.speeds_rad_per_s, [0.0; 3]);
        let [after_m, ..] = truth.unstretched_m;
        let real_m = before_m - after_m;
        println!("after {after}: {by_m} m, true {real_m} m");
        // All but the play of the gear.
        assert!((f64::from(by_m) - real_m).abs() < 1e-5, "{by_m} {real_m}");
        let told = format!("`leg jog 1 --travel {:.1}`", -1000.0 * by_m);
        assert!(help.contains(&told), "{help}");
    }
}

#[test]
fn a_user_who_interrupts_the_swing_leaves_the_leg_held() {
    let rig = RigFile::load(None).unwrap();
    let plan = SwingPlan::new(&rig);
    let words = format!("and swing by {}°", plan.tilt_deg);
    require_said("firmware/SAFETY.md", &[words]);
    let (line, mut operator, cancel) = leg(&rig, &rig, 1);
    let ended = measure_swing(&mut operator, &plan, &rig, &mut |_| cancel.set());
    assert!(
        matches!(ended, Err(OperatorTuneError::Leg(OperatorError::Cancelled))),
        "{ended:?}"
    );
    let speeds = line.with_plant(|plant| plant.truth().speeds_rad_per_s);
    assert_eq!(speeds, [0.0; 3]);
    // Another host: all that this one asks is ended.
    drop(operator);
    let host = Box::new(line.connect());
    let mut other = Operator::open(host, HostIdentity::random(), CancelFlag::default()).unwrap();
    assert_eq!(other.telemetry().unwrap().telemetry.state, State::Held);
}
