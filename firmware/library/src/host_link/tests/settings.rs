//! Settings that are asked for, replaced and kept.

use super::{Line, ONE, others, refused};
use crate::command::{Command, CommandRefusal};
use crate::host_link::{HostRefusal, HostReply, HostRequest};
use crate::leg::{CommandOutcome, Leg};
use crate::linked_leg::SensingLeg;
use crate::sensors::Sensors;
use crate::settings::{OutOfRange, Settings, SettingsError};
use crate::supervisor::{Fault, FaultSet, State};

const DRIVEN: [State; 5] = [
    State::Homing,
    State::Active,
    State::KeepingStation,
    State::Held,
    State::RampingDown,
];

fn built_in() -> Settings {
    Settings::table_1().unwrap()
}

fn settings_in_use(line: &mut Line) -> Settings {
    match line.ask(&HostRequest::GetSettings) {
        HostReply::Settings(settings) => settings,
        other => panic!("{other:?}"),
    }
}

/// A line that waits for the settings to be kept, and the number of the request.
fn saving() -> (Line, u16) {
    let mut line = Line::identified();
    let number = line.send(&HostRequest::SaveSettings);
    assert_eq!(line.heard(), []);
    (line, number)
}

#[test]
fn the_settings_that_are_told_are_those_in_use() {
    let mut line = Line::identified();
    assert_eq!(settings_in_use(&mut line), built_in());
    let set = HostRequest::SetSettings(others());
    assert_eq!(line.ask(&set), HostReply::Done);
    assert_eq!(line.leg.restarts, [others()]);
    assert_eq!(settings_in_use(&mut line), others());
}

/// The leg starts without its zero, so a zero among new settings is not in use.
#[test]
fn a_zero_among_new_settings_is_not_told_as_in_use() {
    let mut line = Line::identified();
    let mut settings = others();
    for axis in &mut settings.axes {
        axis.unstretched_at_zero_m = Some(0.03);
    }
    assert_eq!(
        line.ask(&HostRequest::SetSettings(settings)),
        HostReply::Done
    );
    assert_eq!(settings_in_use(&mut line), others());
}

#[test]
fn a_driven_leg_keeps_its_settings() {
    for state in DRIVEN {
        let mut line = Line::identified();
        line.leg.state = state;
        for request in [
            HostRequest::SetSettings(others()),
            HostRequest::SaveSettings,
        ] {
            assert_eq!(
                line.ask(&request),
                refused(HostRefusal::Driven),
                "{state:?}"
            );
        }
        assert_eq!(settings_in_use(&mut line), built_in());
        assert_eq!(line.leg.restarts, []);
        assert_eq!(line.link.unsaved_settings(), None);
    }
}

#[test]
fn refused_settings_are_named_and_none_of_them_is_in_use() {
    let mut line = Line::identified();
    let mut settings = others();
    settings.servos[1].duty_max = f32::NAN;
    let error = SettingsError::OutOfRange(OutOfRange {
        section: 1,
        field: 8,
        axis: 2,
    });
    assert_eq!(
        line.ask(&HostRequest::SetSettings(settings)),
        refused(HostRefusal::Settings(error))
    );
    assert_eq!(settings_in_use(&mut line), built_in());
    line.send(&HostRequest::SaveSettings);
    assert_eq!(line.link.unsaved_settings(), Some(&built_in()));
}

/// Settings whose mechanism is refused, which is looked at last, leave the leg as it was: its zero known, on its way.
#[test]
fn a_leg_that_refuses_settings_goes_on_with_the_old_ones() {
    let mut homed = built_in();
    for axis in &mut homed.axes {
        axis.unstretched_at_zero_m = Some(0.0343);
    }
    let mut leg = SensingLeg::<f32>::new(&homed).unwrap();
    (0..20).for_each(|_| {
        leg.tick(&Sensors::default());
    });
    let before = leg.telemetry();
    let mut bad = others();
    bad.rig.leg_mass_kg = -1.0;
    let error = Leg::<f32>::new(&bad).unwrap_err();
    assert!(matches!(error, SettingsError::Model(_)), "{error:?}");
    assert_eq!(leg.restart(&bad), Err(HostRefusal::Settings(error)));
    assert_eq!(leg.telemetry(), before);
    assert!(before.homed && before.tick == 20);
}

/// A slack leg at rest with 24 V.
fn quiet() -> Sensors {
    Sensors::resting(&built_in())
}

fn ticked(leg: &mut SensingLeg<f32>, command: Command) -> Option<CommandOutcome> {
    assert!(leg.command(1, command));
    (0..20).for_each(|_| {
        leg.tick(&quiet());
    });
    leg.outcome()
}

/// A cut leg does not come back by new settings, only by a clear.
#[test]
fn new_settings_clear_no_fault() {
    let outcome = |result| Some(CommandOutcome { number: 1, result });
    let mut leg = SensingLeg::<f32>::new(&built_in()).unwrap();
    ticked(&mut leg, Command::KeepAlive);
    leg.tick(&Sensors {
        emergency_stop: true,
        ..quiet()
    });
    assert_eq!(leg.restart(&others()), Ok(()));
    assert_eq!(
        ticked(&mut leg, Command::Home),
        outcome(Err(CommandRefusal::Faulted))
    );
    let latched = FaultSet::single(Fault::EmergencyStop);
    assert_eq!(leg.telemetry().faults, latched);
    assert_eq!(leg.telemetry().state, State::Off);
    assert_eq!(ticked(&mut leg, Command::Clear), outcome(Ok(())));
    assert_eq!(ticked(&mut leg, Command::Home), outcome(Ok(())));
    assert_eq!(leg.telemetry().state, State::Homing);
}

#[test]
fn settings_are_kept_before_the_host_is_told_so() {
    let (mut line, number) = saving();
    assert_eq!(line.link.unsaved_settings(), Some(&built_in()));
    line.tick();
    assert_eq!(line.heard(), []);
    line.link.saved(true);
    assert_eq!(line.heard(), [(number, HostReply::Done)]);
    assert_eq!(line.link.unsaved_settings(), None);
}

#[test]
fn settings_that_could_not_be_kept_are_told_as_that() {
    let (mut line, number) = saving();
    line.link.saved(false);
    assert_eq!(line.heard(), [(number, refused(HostRefusal::NotSaved))]);
    assert_eq!(line.link.unsaved_settings(), None);
}

#[test]
fn a_second_save_has_to_wait_for_the_first() {
    let (mut line, number) = saving();
    assert_eq!(
        line.ask(&HostRequest::SaveSettings),
        refused(HostRefusal::Busy)
    );
    line.link.saved(true);
    assert_eq!(line.heard(), [(number, HostReply::Done)]);
}

/// A leg that is armed in the next tick would be driven while the flash is written.
#[test]
fn settings_are_not_kept_while_a_command_waits_that_begins_something() {
    let mut line = Line::identified();
    let number = line.command(1, Command::Home);
    assert_eq!(
        line.ask(&HostRequest::SaveSettings),
        refused(HostRefusal::Busy)
    );
    line.tick();
    assert!(line.heard().iter().any(|(heard, _)| *heard == number));
    line.send(&HostRequest::SaveSettings);
    assert!(line.link.unsaved_settings().is_some());
}

/// Else it would be told that settings are kept which are no longer those in use.
#[test]
fn settings_do_not_change_while_they_are_being_kept() {
    let (mut line, number) = saving();
    assert_eq!(
        line.ask(&HostRequest::SetSettings(others())),
        refused(HostRefusal::Busy)
    );
    assert_eq!(line.link.unsaved_settings(), Some(&built_in()));
    assert_eq!(line.leg.restarts, []);
    line.link.saved(true);
    assert_eq!(line.heard(), [(number, HostReply::Done)]);
    assert_eq!(
        line.ask(&HostRequest::SetSettings(others())),
        HostReply::Done
    );
}

#[test]
fn settings_that_nobody_asked_to_keep_are_not_told_of() {
    let mut line = Line::identified();
    line.link.saved(true);
    line.link.saved(false);
    assert_eq!(line.heard(), []);
}

#[test]
fn a_leg_is_not_set_in_motion_while_settings_are_being_kept_and_may_be_stopped() {
    let (mut line, _) = saving();
    for command in [Command::Arm, Command::Home, Command::Clear] {
        let request = HostRequest::Command { host: ONE, command };
        assert_eq!(line.ask(&request), refused(HostRefusal::Busy));
    }
    assert_eq!(line.obey(ONE, Command::Stop), HostReply::Done);
    line.link.saved(true);
    line.heard();
    assert_eq!(line.obey(ONE, Command::Arm), HostReply::Done);
}
