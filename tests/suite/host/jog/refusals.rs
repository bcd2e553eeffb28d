//! What refuses a jog, and what ends one from outside.

use super::{demand, leg};
use leg_firmware::command::{Command, CommandRefusal};
use leg_firmware::host_link::HostRefusal;
use leg_firmware::jog::{JogDemand, JogDrive, JogRefusal, SINE_PERIOD_TICKS};
use leg_firmware::supervisor::{Fault, State};
use leg_host::operator::{Goal, Operator, OperatorError};
use leg_sim::emulated_leg::InitialState;

#[test]
fn a_jog_is_refused_by_name_in_every_other_state_and_beyond_its_bounds() {
    let (_, mut operator) = leg(InitialState::Homed);
    let refused = |operator: &mut Operator, demand: JogDemand| match operator.jog(&demand) {
        Err(OperatorError::Refused(_, HostRefusal::Command(CommandRefusal::Jog(refusal)))) => {
            refusal
        }
        other => panic!("{other:?}"),
    };
    let good = demand(&mut operator, 2, 1.0);
    let by = JogDrive::Voltage;
    let sine = |speed_m_per_s, amplitude_v, period_ticks| JogDrive::ServoSine {
        speed_m_per_s,
        amplitude_v,
        period_ticks,
    };
    let [shortest, longest] = SINE_PERIOD_TICKS;
    for (motor, travel_m, drive, refusal) in [
        (0, 1e-3, by(1.0), JogRefusal::Motor),
        (4, 1e-3, by(1.0), JogRefusal::Motor),
        (1, 0.0, by(1.0), JogRefusal::Travel),
        (1, f32::NAN, by(1.0), JogRefusal::Travel),
        (1, -0.0101, by(1.0), JogRefusal::Travel),
        (1, 1e-3, by(0.0), JogRefusal::Voltage),
        (1, 1e-3, by(4.7), JogRefusal::Voltage),
        (1, 1e-3, by(f32::NAN), JogRefusal::Voltage),
        (1, 3.1e-4, JogDrive::ServoStep, JogRefusal::Step),
        (1, 1e-6, JogDrive::ServoStep, JogRefusal::Step),
        (1, f32::NAN, JogDrive::ServoStep, JogRefusal::Step),
        (1, 0.0101, sine(2e-3, 0.3, 100), JogRefusal::Travel),
        (1, 1e-3, sine(0.0, 0.3, 100), JogRefusal::Speed),
        (1, 1e-3, sine(-2e-3, 0.3, 100), JogRefusal::Speed),
        (1, 1e-3, sine(f32::NAN, 0.3, 100), JogRefusal::Speed),
        (
            1,
            1e-3,
            sine(f32::INFINITY, 0.3, 100),
            JogRefusal::Amplitude,
        ),
        (1, 1e-3, sine(2e-3, 0.0, 100), JogRefusal::Amplitude),
        (1, 1e-3, sine(2e-3, f32::NAN, 100), JogRefusal::Amplitude),
        (1, 1e-3, sine(2e-3, 4.0, 100), JogRefusal::Amplitude),
        (1, 1e-3, sine(0.02, 0.3, 100), JogRefusal::Amplitude),
        (1, 1e-3, sine(2e-3, 0.3, shortest - 1), JogRefusal::Period),
        (1, 1e-3, sine(2e-3, 0.3, longest + 1), JogRefusal::Period),
    ] {
        let demand = JogDemand {
            motor,
            travel_m,
            drive,
        };
        assert_eq!(refused(&mut operator, demand), refusal, "{demand:?}");
    }
    let state = |operator: &mut Operator| match operator.jog(&good) {
        Err(OperatorError::Refused(
            _,
            HostRefusal::Command(CommandRefusal::NotDisarmed(state)),
        )) => state,
        other => panic!("{other:?}"),
    };
    operator.reach(&Goal::default()).unwrap();
    assert_eq!(state(&mut operator), State::Held);
    operator.command(Command::Clear).unwrap();
    assert_eq!(state(&mut operator), State::Active);
    operator.disarm().unwrap();
    operator.jog(&good).unwrap();
}

/// A host that falls silent, a stop, and a disarm.
#[test]
fn silence_and_a_stop_switch_the_motor_off() {
    for end in [None, Some(Command::Stop), Some(Command::Disarm)] {
        let stops = end.is_some();
        let (line, mut operator) = leg(InitialState::Slack);
        let demand = demand(&mut operator, 1, 2.0);
        operator.command(Command::Jog(demand)).unwrap();
        assert_eq!(
            operator.telemetry().unwrap().telemetry.state,
            State::Jogging
        );
        if let Some(end) = end {
            operator.command(end).unwrap();
        }
        // A motor that stops is off at once; one of a silent host within command_time_s, 0.2 s, from the last message on.
        let time_s = f64::from(operator.settings().unwrap().limits.command_time_s);
        let off_ms = if stops {
            10
        } else {
            (1e3 * time_s) as u64 + 10
        };
        operator
            .pause(std::time::Duration::from_millis(off_ms))
            .unwrap();
        let telemetry = operator.telemetry().unwrap().telemetry;
        let expected = if stops { State::Disarmed } else { State::Off };
        assert_eq!(telemetry.state, expected, "{:?}", telemetry.faults);
        assert_eq!(telemetry.faults.has(Fault::CommandTimeout), !stops);
        operator
            .pause(std::time::Duration::from_millis(100))
            .unwrap();
        let speed = line.with_plant(|plant| plant.truth().speeds_rad_per_s[0]);
        assert_eq!(speed, 0.0);
        assert!(telemetry.pulled_m[0] < 1.2e-3, "{:?}", telemetry.pulled_m);
    }
}
