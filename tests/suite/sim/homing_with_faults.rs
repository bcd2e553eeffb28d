//! A leg that was stopped because its sensors contradict each other, and that is homed although nothing was repaired.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::station_stand::{armed, pass};
use leg_bench::stand::{Stand, move_to};
use leg_firmware::command::Command;
use leg_firmware::supervisor::{Fault, FaultSet, State};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::{Defect, Start};

/// The highest tension while homing, N: a bar of the strikes.
const HOMING_N: f64 = 25.0;

/// How far the leg leans when it is struck, degrees, as far as its rig lets it.
const TILT_DEG: f64 = 25.0;

fn tilt_deg(rig: &RigFile) -> f64 {
    TILT_DEG.min(0.9 * rig.tilt_deg)
}

fn rigs() -> impl Iterator<Item = RigFile> {
    READY_RIGS
        .iter()
        .map(|rig| RigFile::load(Some(rig.name.as_ref())).unwrap())
}

fn obey(stand: &mut Stand, command: Command) {
    stand.command(&command).unwrap();
    pass(stand, 0.05);
}

/// Clears the fault, arms in vain, and homes. The faults by which that ends, and the highest true tension on the way, N.
fn home(stand: &mut Stand) -> (FaultSet, f64) {
    obey(stand, Command::Clear);
    assert!(!stand.faults().any(), "{:?}", stand.faults());
    obey(stand, Command::Arm);
    assert_eq!(stand.state(), State::Disarmed);
    stand.command(&Command::Home).unwrap();
    let (mut highest_n, mut homes) = (0.0_f64, false);
    for _ in 0..60 * 8000 {
        stand.tick().unwrap();
        homes |= stand.state() == State::Homing;
        highest_n = stand.truth.tensions_n.into_iter().fold(highest_n, f64::max);
        if homes && stand.state() != State::Homing {
            break;
        }
    }
    assert!(homes);
    (stand.faults(), highest_n)
}

/// From where the leg leans its tendons are paid out: none pulls more than before by more than its swing.
#[test]
fn a_motor_that_turned_the_wrong_way_is_found_again_by_homing() {
    for rig in rigs() {
        for tendon in 0..3 {
            let mut stand = armed(&rig, [40.0, tilt_deg(&rig)], 0.0, 1);
            stand
                .plant()
                .set_defect(Defect::EncoderReversed(tendon), true);
            obey(&mut stand, move_to([220.0, tilt_deg(&rig)]));
            pass(&mut stand, 1.5);
            assert!(
                stand.faults().has(Fault::EncoderReversed),
                "{tendon}: {:?}",
                stand.faults()
            );
            assert_eq!(stand.state(), State::Off);
            let before_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
            let (faults, highest_n) = home(&mut stand);
            assert!(faults.has(Fault::EncoderReversed), "{faults:?}");
            assert!(highest_n < 1.1 * before_n, "{before_n} N, {highest_n} N");
        }
    }
}

#[test]
fn load_cells_that_have_changed_their_places_are_found_by_homing() {
    let mut found = 0;
    for rig in rigs() {
        // The tensions of the first two differ most.
        let mut stand = armed(&rig, [110.0, tilt_deg(&rig)], 1.0, 1);
        stand.plant().set_defect(Defect::CellsSwapped, true);
        pass(&mut stand, 0.5);
        if !stand.faults().has(Fault::TensionJump) {
            // They differ too little where it leans little.
            continue;
        }
        found += 1;
        assert_eq!(stand.state(), State::Held);
        obey(&mut stand, Command::Clear);
        assert!(stand.state() == State::Held && stand.faults().any());
        stand.command(&Command::Disarm).unwrap();
        pass(&mut stand, 5.0);
        assert_eq!(stand.state(), State::Disarmed);
        stand.plant().set_payload(0.0, 0.1);
        pass(&mut stand, 5.0);
        let before_n = stand.truth.tensions_n.into_iter().fold(0.0, f64::max);
        let (faults, highest_n) = home(&mut stand);
        assert!(faults.has(Fault::HomingFailed), "{faults:?}");
        assert!(
            highest_n < HOMING_N.max(1.1 * before_n),
            "{before_n} N, {highest_n} N"
        );
    }
    assert!(found >= 6, "{found} rigs");
}

/// The state in which a homing ends, of a leg whose second cell is off by an offset, N, and by a gain.
fn state_after_homing(offset_n: f64, gain_error: f64) -> State {
    let rig = RigFile::load(None).unwrap();
    let mut plant = rig.plant;
    plant.cell_offset_n[1] = offset_n;
    plant.cell_gain_error[1] = gain_error;
    let start = Start::Slack { slack_mm: 3.0 };
    let mut stand = Stand::new(&rig, &plant, start, 1).unwrap();
    pass(&mut stand, 0.2);
    obey(&mut stand, Command::Home);
    for _ in 0..30 * 8000 {
        if stand.state() != State::Homing {
            break;
        }
        stand.tick().unwrap();
    }
    stand.state()
}

/// An offset is tared, up to what the settings allow; with a gain that is wrong homing finds nothing, and ends as always.
#[test]
fn homing_does_not_find_a_load_cell_that_is_off() {
    let tare_max_n = f64::from(RigFile::load(None).unwrap().gains.homing.tare_max_n);
    for sign in [-1.0, 1.0] {
        let found = |part: f64| state_after_homing(sign * part * tare_max_n, 0.0);
        assert_eq!(found(0.95), State::Active);
        assert_eq!(found(1.05), State::RampingDown);
        assert_eq!(state_after_homing(0.0, sign * 0.2), State::Active);
    }
}

/// Whoever homes a leg that was homed before has reason to: where that is stopped or fails, the earlier zero is not used again.
#[test]
fn a_homing_that_does_not_come_to_its_end_leaves_no_earlier_zero() {
    for defect in [
        None,
        Some(Defect::CellsSwapped),
        Some(Defect::ExcitationLost),
        Some(Defect::TendonCut(0)),
    ] {
        let mut stand = armed(&RigFile::load(None).unwrap(), [0.0, 0.0], 0.0, 1);
        obey(&mut stand, Command::Disarm);
        pass(&mut stand, 8.0);
        assert_eq!(stand.state(), State::Disarmed);
        assert!(stand.telemetry.unwrap().homed);
        if let Some(defect) = defect {
            stand.plant().set_defect(defect, true);
        }
        obey(&mut stand, Command::Home);
        if defect.is_none() {
            pass(&mut stand, 2.0);
            assert_eq!(stand.state(), State::Homing);
            obey(&mut stand, Command::Stop);
        } else {
            pass(&mut stand, 20.0);
        }
        let rest_m = stand.truth.tip_m;
        assert!(!stand.telemetry.unwrap().homed, "{defect:?}");
        for command in [Command::Clear, Command::Arm] {
            obey(&mut stand, command);
            pass(&mut stand, 8.0);
            assert_eq!(stand.state(), State::Disarmed, "{defect:?}, {command:?}");
            let moved_mm = (stand.truth.tip_m - rest_m).norm() * 1e3;
            assert!(moved_mm < 3.0, "{defect:?}, {command:?}: {moved_mm} mm");
        }
    }
}
