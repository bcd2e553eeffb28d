//! Settings of the board, and the command timeout among them.

use super::{emulated_line, hanging_leg, host, lean, state};
use crate::operator::{Operator, OperatorError, setting_differences};
use crate::transport::emulated::EmulatedLine;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::settings::{RecordedSignal, SettingsError, SignalSet};
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::InitialState;

#[test]
fn settings_are_read_back_and_refused_by_name() {
    let leg = hanging_leg();
    let mut operator = host(&leg, 1);
    let mut settings = operator.settings().unwrap().unhomed();
    settings.limits.slack_n = 3.0;
    operator.set_settings(&settings).unwrap();
    let found = operator.settings().unwrap();
    assert!(setting_differences(&settings, &found).is_empty());
    settings.motion.speed_rad_per_s = 0.5;
    let differences = setting_differences(&settings, &found);
    let [difference] = differences.as_slice() else {
        panic!("{differences:?}")
    };
    assert_eq!(difference.name, "motion.speed_rad_per_s");
    let mut others = found.clone();
    others.recorded = SignalSet::new(&[RecordedSignal::Currents, RecordedSignal::Board]);
    let [difference] = &setting_differences(&found, &others)[..] else {
        panic!("{others:?}")
    };
    assert_eq!(difference.name, "recorded");
    assert_eq!(difference.ours, Some("tensions, pulled, duties".into()));
    assert_eq!(difference.theirs, Some("currents, board".into()));
    operator.save_settings().unwrap();
    settings.limits.slack_n = -1.0;
    error_of!(
        operator.set_settings(&settings),
        OperatorError::Refused(_, HostRefusal::Settings(SettingsError::OutOfRange(_)))
    );
    assert_eq!(operator.settings().unwrap().limits.slack_n, 3.0);
    // They change the leg's zero, so it has to be homed.
    assert!(!operator.telemetry().unwrap().telemetry.homed);
}

/// A leg with this command timeout.
fn waiting(command_time_s: f32) -> (EmulatedLine, Operator) {
    let mut rig = RigFile::load(None).unwrap();
    rig.gains.limits.command_time_s = command_time_s;
    let leg = emulated_line(&rig, InitialState::Homed);
    let operator = host(&leg, 1);
    (leg, operator)
}

#[test]
fn a_leg_that_waits_less_long_hears_of_its_host_more_often() {
    for (command_time_s, silence_ms) in [(0.02, 5.0), (0.06, 15.0), (0.2, 50.0), (100.0, 50.0)] {
        let (_leg, mut operator) = waiting(command_time_s);
        operator.reach(&lean(10.0)).unwrap();
        assert_eq!(
            state(&mut operator),
            State::KeepingStation,
            "{command_time_s} s"
        );
        let silence_max = operator.silence_max.unwrap();
        let difference_ms = silence_max.as_secs_f64() * 1000.0 - silence_ms;
        assert!(difference_ms.abs() < 1e-3, "{command_time_s} s");
    }
}

#[test]
fn a_leg_that_waits_for_nobody_is_not_driven() {
    let (_leg, mut operator) = waiting(0.01);
    let error = error_of!(
        operator.reach(&lean(10.0)),
        OperatorError::CommandTimeTooShort(_)
    );
    let text = error.failure().render(false);
    assert!(text.contains("command timeout is 0.01 s"), "{text}");
    assert!(text.contains("0.02 or more"), "{text}");
    assert_eq!(state(&mut operator), State::Disarmed);
}
