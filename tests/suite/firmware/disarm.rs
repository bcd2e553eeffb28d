//! A disarm: a leg that knows its pose is led down first, every other one is paid out where it is.

use super::still_leg::StillLeg;
use leg_firmware::command::{Command, CommandRefusal, Compensation};
use leg_firmware::sensors::CODE_MAX;
use leg_firmware::supervisor::{Fault, State};

/// Ticks after which lengths and tensions are watched: 0.15 s.
const WATCHED_TICKS: u16 = 1200;

#[test]
fn a_leg_that_is_led_down_follows_no_other_command_but_a_stop() {
    let mut still = StillLeg::armed();
    still.run(WATCHED_TICKS);
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    let telemetry = still.leg.telemetry();
    assert!(telemetry.state == State::Active && telemetry.moving);
    let refused = Err(CommandRefusal::State(State::RampingDown));
    for command in [
        Command::Move { x: 0.1, y: 0.0 },
        Command::Hold,
        Command::Pretension(100.0),
        Command::Stiffness {
            demand_nm_per_rad: 90.0,
            towards: None,
        },
        Command::Compensation(Compensation::Off),
    ] {
        assert_eq!(still.obey(command), refused, "{command:?}");
    }
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    assert_eq!(still.leg.state(), State::Active);
    assert_eq!(still.obey(Command::Stop), Ok(()));
    assert_eq!(still.leg.state(), State::Held);
}

/// Disarms it, and finds it paid out where it is.
fn is_paid_out(still: &mut StillLeg) {
    assert_eq!(still.obey(Command::Disarm), Ok(()));
    assert_eq!(still.leg.state(), State::RampingDown);
}

/// Its sensors are not watched yet.
#[test]
fn a_leg_that_was_just_armed_is_paid_out_where_it_is() {
    is_paid_out(&mut StillLeg::armed());
}

/// Nor are they from the stop on: it may hang in slack tendons.
#[test]
fn a_leg_that_was_stopped_before_it_was_watched_is_paid_out_where_it_is() {
    let mut still = StillLeg::armed();
    assert_eq!(still.obey(Command::Stop), Ok(()));
    still.run(WATCHED_TICKS);
    assert_eq!(still.leg.state(), State::Held);
    is_paid_out(&mut still);
}

/// A leg with a fault follows nothing any more, not even downwards.
#[test]
fn a_leg_with_a_fault_is_paid_out_where_it_is() {
    let mut still = StillLeg::armed();
    still.run(WATCHED_TICKS);
    // Not a host that falls silent: before that is a fault, motors that are driven and never draw a current are one.
    still.sensors.temperature_code = CODE_MAX;
    still.run(400);
    let telemetry = still.leg.telemetry();
    assert!(telemetry.faults.has(Fault::OverTemperature));
    assert_eq!(telemetry.state, State::Held);
    is_paid_out(&mut still);
}
