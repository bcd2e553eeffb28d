//! A leg whose sensors contradict each other is not armed again as it is.

use super::still_leg::StillLeg;
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::supervisor::{Fault, State};

/// Codes of 30 N, more than `jump_n` within a millisecond.
const JUMP_CODES: u16 = 7_900;

/// Load cells 1 and 2 show the one more and the other less at once, as if their plugs were swapped: the mean stays, and lengths and
/// tensions agree.
fn swap(still: &mut StillLeg, back: bool) {
    let [first, second, _] = &mut still.sensors.cell_codes;
    let (more, less) = if back {
        (second, first)
    } else {
        (first, second)
    };
    *more += JUMP_CODES;
    *less -= JUMP_CODES;
}

/// Held by a jump of two tensions.
fn jumped() -> StillLeg {
    let mut still = StillLeg::armed();
    still.run(2_000);
    swap(&mut still, false);
    still.run(400);
    let telemetry = still.leg.telemetry();
    assert_eq!(telemetry.state, State::Held);
    assert!(telemetry.faults.has(Fault::TensionJump) && !telemetry.faults.has(Fault::Residual));
    still
}

/// An arm would take what two wrong load cells show for a load, and pull by it.
#[test]
fn a_tension_that_stays_where_it_jumped_is_not_cleared() {
    let mut still = jumped();
    assert_eq!(still.obey(Command::Clear), Err(CommandRefusal::Faulted));
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::Held && telemetry.faults.has(Fault::TensionJump));
    // Paid out, it has to be homed.
    assert!(telemetry.homed);
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::RampingDown && !telemetry.homed);
}

/// After a knock a tension is where it was.
#[test]
fn a_tension_that_came_back_from_its_jump_is_cleared() {
    let mut still = jumped();
    swap(&mut still, true);
    still.run(400);
    assert_eq!(still.obey(Command::Clear), Ok(()));
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::Active && telemetry.homed);
    // Another load is no jump, and what had jumped before is no matter any more.
    for _ in 0..100 {
        still.sensors.cell_codes[0] += JUMP_CODES / 100;
        still.sensors.cell_codes[1] -= JUMP_CODES / 100;
        still.run(40);
    }
    assert_eq!(still.obey(Command::Stop), Ok(()));
    still.run(2_000);
    assert_eq!(still.obey(Command::Clear), Ok(()));
    assert!(still.leg.telemetry().homed);
}

/// Held as a load cell drifted.
fn disagreeing() -> StillLeg {
    let mut still = StillLeg::armed();
    still.run(2_000);
    for _ in 0..50 {
        still.sensors.cell_codes[0] -= 30;
        still.run(4);
    }
    still.run(400);
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::Held && telemetry.faults.has(Fault::Residual));
    still
}

/// Sensors that do not agree on the pose end the zero, too, once the tendons are paid out: nothing is compared from then on.
#[test]
fn a_leg_whose_sensors_disagree_has_to_home_once_it_was_paid_out() {
    let mut still = disagreeing();
    assert_eq!(still.obey(Command::Clear), Err(CommandRefusal::Faulted));
    assert!(still.leg.telemetry().homed);
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    assert!(!still.leg.telemetry().homed);
}

/// A wire that breaks for a moment: for as long as the cell shows more than the curve knows, there is no pose, and nothing is compared.
#[test]
fn a_leg_whose_sensors_disagree_is_not_cleared_after_a_tension_beyond_the_curve() {
    let mut still = disagreeing();
    let code = core::mem::replace(&mut still.sensors.cell_codes[2], 65_000);
    still.run(12);
    still.sensors.cell_codes[2] = code;
    still.run(400);
    assert_eq!(still.obey(Command::Clear), Err(CommandRefusal::Faulted));
    assert_eq!(still.leg.state(), State::Held);
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    assert!(!still.leg.telemetry().homed);
}

/// An emergency stop ends what is compared as well: what had jumped before has to be homed all the same.
#[test]
fn a_leg_whose_tension_jumped_has_to_home_after_an_emergency_stop() {
    let mut still = jumped();
    still.sensors.emergency_stop = true;
    still.run(400);
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::Off && !telemetry.homed);
    still.sensors.emergency_stop = false;
    still.run(400);
    assert_eq!(still.obey(Command::Clear), Ok(()));
    assert_eq!(still.leg.telemetry().state, State::Disarmed);
    assert_eq!(still.obey(Command::Arm), Err(CommandRefusal::NotHomed));
}

/// A leg that was stopped keeps its zero.
#[test]
fn a_leg_that_was_stopped_is_paid_out_with_its_zero() {
    let mut still = StillLeg::armed();
    still.run(2_000);
    assert_eq!(still.obey(Command::Stop), Ok(()));
    still.run(400);
    assert_eq!(still.obey(Command::Clear), Ok(()));
    assert!(still.leg.command(0, Command::Disarm));
    still.run(400);
    assert!(still.leg.telemetry().homed);
}
