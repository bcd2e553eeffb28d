//! What the board is asked besides commands.

use super::{Server, driven, leg, rig_text, telemetry};
use crate::live_leg::LiveLeg;
use crate::live_leg::board::Errand;
use crate::live_leg::line::Said;
use leg_firmware::frame::Decoder;
use leg_firmware::host_link::{HostRefusal, HostReply, HostRequest};
use leg_firmware::sensors::{SensorReading, Sensors};
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_rig::control_settings;
use leg_rig::rig_file::RigFile;

fn settings() -> Settings {
    let rig = RigFile::parse("board", &rig_text()).unwrap();
    control_settings::settings(&rig, &rig.gains, None)
}

fn other_settings() -> Settings {
    let mut settings = settings();
    settings.limits.jump_n = 31.0;
    settings.rig.leg_length_m = 0.25;
    settings
}

/// What was asked since, with its number.
fn asked(server: &Server) -> Vec<(u16, HostRequest)> {
    let mut decoder = Decoder::new();
    let mut found = Vec::new();
    for said in server.said.borrow_mut().drain(..) {
        let Said::Bytes(bytes) = said else { continue };
        for byte in bytes {
            if let Some(Ok(frame)) = decoder.push(byte) {
                found.push((frame.sequence, frame.message().unwrap()));
            }
        }
    }
    found
}

fn disarmed() -> (LiveLeg, Server) {
    let (mut leg, server) = driven();
    server.report(telemetry(State::Disarmed, 1));
    leg.advance(1.1);
    asked(&server);
    (leg, server)
}

#[test]
fn settings_are_set_read_back_and_compared() {
    for (found, expected) in [
        (other_settings(), Ok("found the same")),
        (settings(), Err("limits.jump_n")),
    ] {
        let (mut leg, server) = disarmed();
        leg.ask(Errand::Write(Box::new(other_settings())));
        let sent = asked(&server);
        let [(number, HostRequest::SetSettings(given))] = &sent[..] else {
            panic!("{sent:?}");
        };
        assert_eq!(*given, other_settings());
        assert!(leg.board().busy().is_some() && leg.board_locked(true).is_some());
        server.reply(*number, &HostReply::Done);
        leg.advance(1.2);
        let [(number, HostRequest::GetSettings)] = asked(&server)[..] else {
            panic!("not read back");
        };
        server.reply(number, &HostReply::Settings(found));
        leg.advance(1.3);
        match (leg.board().told().unwrap(), expected) {
            (Ok(words), Ok(expected)) | (Err(words), Err(expected)) => {
                assert!(words.contains(expected), "{words}");
            }
            (told, _) => panic!("{told:?}"),
        }
        assert_eq!(leg.board().busy(), None);
    }
}

#[test]
fn the_leg_is_shown_with_what_its_board_has_whoever_asked() {
    let (mut leg, server) = leg();
    assert_eq!(leg.board().settings_seen(), [0, 0]);
    server.reply(9, &HostReply::Settings(other_settings()));
    leg.advance(1.1);
    assert_eq!(leg.board().settings_seen(), [1, 0]);
    assert!((leg.rig().parameters.leg_length_m - 0.25).abs() < 1e-6);
    assert!(leg.source().text.contains("jump_n = 31"));
    assert_eq!(leg.board().told(), None);
}

#[test]
fn a_board_is_asked_only_by_the_page_that_drives_and_changed_only_without_its_drivers() {
    let (mut locked, server) = leg();
    server.report(telemetry(State::Disarmed, 1));
    locked.advance(1.1);
    let (mut active, other) = driven();
    other.report(telemetry(State::Active, 1));
    active.advance(1.1);
    asked(&other);
    for errand in [
        Errand::Write(Box::new(settings())),
        Errand::Save,
        Errand::Read,
    ] {
        locked.ask(errand.clone());
        active.ask(errand);
    }
    assert!(asked(&server).is_empty());
    let sent = asked(&other);
    assert!(
        matches!(&sent[..], [(_, HostRequest::GetSettings)]),
        "{sent:?}"
    );
    assert!(active.board_locked(true).is_some());
}

#[test]
fn a_refusal_and_silence_are_told_with_the_remedy() {
    let (mut leg, server) = disarmed();
    leg.ask(Errand::Save);
    let [(number, HostRequest::SaveSettings)] = asked(&server)[..] else {
        panic!("not asked");
    };
    server.reply(number, &HostReply::Refused(HostRefusal::NotSaved));
    leg.advance(1.2);
    let words = leg.board().told().unwrap().unwrap_err();
    assert!(words.contains("could not keep"), "{words}");
    leg.ask(Errand::Read);
    leg.advance(9.0);
    let words = leg.board().told().unwrap().unwrap_err();
    assert!(
        words.contains("not answered") && words.contains("again"),
        "{words}"
    );
    assert_eq!(leg.board().busy(), None);
}

#[test]
fn the_codes_of_the_sensors_come_once() {
    let (mut leg, server) = disarmed();
    leg.ask(Errand::Sensors);
    let [(number, HostRequest::Sensors)] = asked(&server)[..] else {
        panic!("not asked");
    };
    let sensors = Sensors {
        cell_codes: [1, 2, 3],
        ..Sensors::default()
    };
    let reading = SensorReading {
        codes: sensors,
        ..SensorReading::default()
    };
    server.reply(number, &HostReply::Sensors(reading));
    leg.advance(1.2);
    assert_eq!(leg.board_mut().take_sensors(), Some(sensors));
    assert_eq!(leg.board_mut().take_sensors(), None);
}
